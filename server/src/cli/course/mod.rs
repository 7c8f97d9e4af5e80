//! Commands for lessons and their authors.

pub(in crate::cli) mod autograder;
pub(in crate::cli) mod grade;
pub(in crate::cli) mod grades;
pub(in crate::cli) mod graph;
pub(in crate::cli) mod lesson;
pub(in crate::cli) mod lti;
pub(in crate::cli) mod preview;
pub(in crate::cli) mod records;
pub(in crate::cli) mod regrade;
