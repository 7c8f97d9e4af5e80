//! Lessons and courses: read from their folders, with other numbers for each student, shown without their answers.

mod blank;
mod bundle;
mod content;
mod conventions;
pub mod course;
mod dealing;
mod diagram_view;
mod notions;
mod numbering;
mod personal;
mod prediction;
mod reader;
mod rules;
mod variant;
mod view;

pub use content::Lesson;
pub use course::{Course, CourseError};
pub use diagram_view::{CutBodyView, DiagramView, PlaceView};
pub(crate) use notions::need;
pub use notions::{Need, NotionGraph, NotionNode};
pub use prediction::{OptionView, OutcomeView, PredictionView};
pub use reader::LessonError;
pub(crate) use reader::line_of;
pub use variant::VariantError;
pub use view::{ColumnView, ExerciseView, LessonSummary, LessonView, QuestionView, StepView, TuningView};
