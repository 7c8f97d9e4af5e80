//! Feedback on answers. Grading gives it as data (`feedback`, or `invalid` where an answer cannot be judged);
//! `html` alone turns it into HTML. [`sent`] is the verdict that leaves the server, [`mod@reference`] adds the right
//! answers where the author opens them.

pub(crate) mod diagram;
pub(crate) mod feedback;
pub(crate) mod html;
pub(crate) mod invalid;
pub mod reference;
pub mod sent;

pub use sent::{Mark, Provenance, QuestionStanding, QuestionVerdict, Verdict};
