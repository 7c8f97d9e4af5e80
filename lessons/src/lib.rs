//! Lessons: reading a course, proving it, showing it without its answers, grading what students hand in.
//!
//! Content is data. `lessons/course/NN-slug/` holds `lesson.toml` (title, objectives, steps), `lesson.md` (text),
//! `figures/`, `scene.json` (the scenario), `exercise.toml` (questions), `reference/answers.toml` (answers and
//! their sources) and `wrong/*.toml` (wrong answers that must be recognised). The last three never leave the
//! server: pages are built from [`Lesson::public_view`] only.
//!
//! Reading order: [`files`] (what an author writes), [`course`] and [`lesson`] (reading it), [`exercise`]
//! (questions ready to grade), [`variant`] (the same questions with other numbers), [`tolerance`], [`units`], [`number`], [`expression`] (the parts of an answer),
//! [`submission`], [`grade`], [`verdict`], and [`check`] (proving a course).

pub mod check;
pub mod course;
pub mod exercise;
pub mod expression;
pub mod figure;
pub mod files;
mod grade;
mod implement;
pub mod lesson;
pub mod markdown;
mod measure;
pub mod number;
mod opened;
mod random;
pub mod schema;
pub mod skeleton;
mod slip;
pub mod starter;
pub mod submission;
mod table;
pub mod tolerance;
mod trajectory;
pub mod units;
pub mod variant;
pub mod verdict;

#[cfg(test)]
mod tests;

pub use check::{Problem, check_course, check_course_files, check_lesson, reference_submission};
pub use course::{Course, CourseError};
pub use grade::{GradeError, grade};
pub use implement::DealView;
pub use lesson::{Lesson, LessonError, LessonSummary, LessonView};
pub use opened::open;
pub use submission::{Submission, SubmissionError};
pub use variant::{Parameters, VariantError};
pub use verdict::{Mark, QuestionVerdict, Verdict};
