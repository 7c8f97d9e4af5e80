//! The files of a course exactly as an author writes them. Unknown keys are refused.
//!
//! [`lesson`] (what a lesson is about), [`prediction`] (what is said before its run), [`exercise`] (its questions), [`tasks`] (questions answered by work),
//! [`explanation`] (questions answered in words),
//! [`mod@reference`] (right and wrong answers), [`measured`] (where a scenario shows a value); [`schema`] describes them
//! for editors and [`skeleton`] begins new ones.

use std::collections::BTreeMap;

pub mod diagram;
pub mod exercise;
pub mod explanation;
pub mod lesson;
pub mod measured;
pub mod prediction;
pub mod reference;
pub mod schema;
pub mod skeleton;
pub mod tasks;

pub use diagram::DiagramFile;
pub use exercise::{
    ExerciseFile, MisconceptionFile, OptionFile, ParameterFile, PatchFile, QuestionFile, QuestionKind,
    ToleranceFile,
};
pub use explanation::ExplanationFile;
pub use lesson::{CourseFile, LessonFile, OpensFile, PartFile, StepFile, StepKind};
pub use measured::{Component, CountKind, MeasuredFile, MotionKind};
pub use prediction::{PredictionFile, PredictionOptionFile};
pub use reference::{AgainFile, ProvenanceKind, ReferenceFile, WrongFile};
pub use tasks::{
    EquationPart, FollowFile, ImplementFile, ModelFile, ScoreBand, TrajectoryFile, TuningFile, WatchFile,
    WrongModel, WrongModelFile, earlier_value,
};

/// The files of one folder: path below it, content.
pub type Files = BTreeMap<String, Vec<u8>>;
