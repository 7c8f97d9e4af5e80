//! What the answers of a class say about the questions: which are hard, which tell the strong from the weak, which mistakes
//! are made, and by whom.
//!
//! In reading order: the statistics as pure functions of numbers, one student's work at a question as it is kept, how near wrong answers were, what these
//! say about a question, and what was said in words for people to read.

mod figures;
mod near;
mod question;
mod sheets;
pub mod statistics;
mod words;
mod work;

pub use figures::{Flag, LessonFigures, MistakeCount, QuestionFigures};
pub use near::Near;
pub use question::{ChoiceCount, DrawnNumber, GivenAnswer, MistakeAnswers, QuestionAnalysis};
pub use sheets::{answers_csv, figures_csv};
pub use words::{
    AskedExplanation, AskedPrediction, ClassWords, StudentExplanation, StudentPrediction, StudentWords,
    waiting,
};
pub use work::{Class, Try, Work};
