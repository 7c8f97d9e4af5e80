//! Questions ready to grade: [`question`] (what they are), [`parameters`] (numbers drawn for a student), and how both
//! are made from an author's files.

mod build;
mod closed;
mod context;
pub(crate) mod cut;
pub mod derivation;
mod diagram;
mod explanation;
pub(crate) mod named;
pub mod parameters;
mod pools;
mod quantity;
pub mod question;
mod tasks;

pub(crate) use build::build;
pub use context::QuestionError;
pub(crate) use context::{BuildContext, put_numbers};
pub use diagram::Diagram;
pub use parameters::Parameters;
pub(crate) use quantity::numbers;
pub use question::{
    ChoiceOption, Exercise, Explanation, Formula, Implement, Misconception, ModelTask, QuantityQuestion,
    Question, QuestionBody, Trajectory, Tuning,
};
