//! Lessons: reading a course, proving it, showing it without its answers, grading what students hand in.
//!
//! Content is data. `lessons/course/NN-slug/` holds `lesson.toml` (title, objectives, steps), `lesson.md` (text),
//! `figures/`, `scene.json` (the scenario), `exercise.toml` (questions), `reference/answers.toml` (answers and
//! their sources) and `wrong/*.toml` (wrong answers that must be recognised). The last three never leave the
//! server: pages are built from [`Lesson::public_view`] only.
//!
//! The modules stand in reading order, and each uses only what stands before it: [`rendering`] (Markdown and figures as
//! safe HTML), [`answers`] (what a student types), [`files`] (what an author writes), [`exercise`] (questions ready to
//! grade), [`lesson`] (lessons, courses and their variants), [`tasks`] (questions answered by work), `recognition` (usual
//! mistakes behind wrong numbers and formulas), [`verdict`] (what is said about an answer, and its HTML), [`grading`],
//! [`mod@standing`] (what earlier submissions decide), and [`check`] (proving a course). [`mod@seed`] tells what a student's
//! numbers are drawn from.

#![allow(clippy::missing_errors_doc)] // said in a sentence: the crate is no library for others

mod text;

mod mistakes;

pub mod rendering;

pub mod answers;

pub mod files;

mod random;

pub mod seed;

mod scenario;

pub mod exercise;

pub mod lesson;

pub mod tasks;

mod recognition;

pub mod verdict;

pub mod grading;

pub mod standing;

pub mod check;

#[cfg(test)]
mod tests;

pub use answers::{Answer, Submission, SubmissionError};
pub use check::{
    Fault, check_course, check_course_files, check_lesson, check_lessons, reference_submission,
    wrong_submission,
};
pub use exercise::Parameters;
pub use grading::closed::chosen;
pub use grading::{Computed, GradeError, Known, Understood, asked, grade, grade_while, near, understand};
pub use lesson::{
    Course, CourseError, Lesson, LessonError, LessonSummary, LessonView, NotionGraph, VariantError,
};
pub use seed::seed;
pub use standing::{Attempt, open, right_answer, settle, standing};
pub use tasks::InstancesView;
pub use verdict::{Mark, QuestionVerdict, Verdict};
