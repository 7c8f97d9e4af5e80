//! Questions as they are graded: units read, expressions evaluated, references attached.

use std::collections::BTreeMap;

use triad_engine::scene::{IntegratorKind, Scene};

use super::derivation::Derivation;
use super::diagram::Diagram;
use crate::answers::RunSettings;
use crate::answers::tolerance::{Tolerance, ValueShape};
use crate::answers::units::Unit;
use crate::files::{
    EquationPart, FollowFile, MeasuredFile, ModelFile, ProvenanceKind, QuestionKind, ScoreBand, WatchFile,
};
use triad_engine::scene::expression::Expression;

/// The questions of a lesson, with their answers. Never leaves the server.
#[derive(Debug, Clone, PartialEq)]
pub struct Exercise {
    /// Share of the points that passes the lesson.
    pub pass_mark: f64,
    /// How many questions of each pool a student gets.
    pub draw: BTreeMap<String, usize>,
    /// The questions in order: of a lesson all, of a student's own those that were drawn.
    pub questions: Vec<Question>,
}

/// One question with everything needed to grade it.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// Name, unique in the lesson.
    pub id: String,
    /// Kind as the author wrote it.
    pub kind: QuestionKind,
    /// What is asked (Markdown).
    pub prompt: String,
    /// Points.
    pub points: f64,
    /// The pool that it is drawn from.
    pub pool: Option<String>,
    /// Hints (Markdown), one at a time.
    pub hints: Vec<String>,
    /// Said when the answer is right (Markdown).
    pub right: String,
    /// What is graded.
    pub body: QuestionBody,
    /// The reference's kind of source.
    pub provenance: ProvenanceKind,
    /// The reference's source in words.
    pub source: String,
    /// Where the scenario shows the same value.
    pub measured: Option<MeasuredFile>,
}

impl Question {
    /// Whether people judge the answer: no program gives its points.
    pub fn is_judged_by_people(&self) -> bool {
        matches!(self.body, QuestionBody::Explanation(_))
    }

    /// Every text of the question that a student can come to see.
    pub fn texts(&self) -> Vec<&str> {
        let mut texts = vec![self.prompt.as_str(), self.right.as_str()];
        texts.extend(self.hints.iter().map(String::as_str));
        match &self.body {
            QuestionBody::Quantity(q) => texts.extend(q.misconceptions.iter().map(|m| m.feedback.as_str())),
            QuestionBody::Choice { options, .. } => {
                texts.extend(options.iter().flat_map(|o| [o.text.as_str(), o.reason.as_str()]));
            }
            QuestionBody::Formula(f) => {
                texts.extend(f.misconceptions.iter().map(|(.., feedback)| feedback.as_str()));
            }
            QuestionBody::Explanation(e) => texts.extend([e.purpose.as_str(), e.example.as_str()]),
            QuestionBody::Model(m) => texts.extend(m.watches().iter().map(|w| w.feedback.as_str())),
            QuestionBody::Diagram(_)
            | QuestionBody::Implement(_)
            | QuestionBody::Trajectory(_)
            | QuestionBody::Tuning(_) => {}
        }
        texts
    }
}

/// What is graded, by family of kinds.
// A lesson has a handful of these, and each is made once.
#[allow(clippy::large_enum_variant)]
#[derive(Debug, Clone, PartialEq)]
pub enum QuestionBody {
    /// A number, a vector or a matrix.
    Quantity(QuantityQuestion),
    /// One of several options.
    Choice {
        /// Options in the order they are shown.
        options: Vec<ChoiceOption>,
        /// Id of the right one.
        right: String,
    },
    /// An expression in named symbols.
    Formula(Formula),
    /// A free-body diagram.
    Diagram(Diagram),
    /// The equations at given states.
    Implement(Implement),
    /// A table of a motion.
    Trajectory(Trajectory),
    /// A scene of the student's own.
    Model(ModelTask),
    /// Settings under a budget.
    Tuning(Tuning),
    /// Words that people judge.
    Explanation(Explanation),
}

/// Numbers with a unit.
#[derive(Debug, Clone, PartialEq)]
pub struct QuantityQuestion {
    /// Number, vector or matrix.
    pub shape: ValueShape,
    /// Rows and columns; a number is 1 × 1, a vector n × 1.
    pub size: [usize; 2],
    /// Unit of the reference and of the rule.
    pub unit: Unit,
    /// The unit is part of what is asked.
    pub asks_unit: bool,
    /// Frame of the components.
    pub frame: Option<String>,
    /// What counts as right.
    pub tolerance: Tolerance,
    /// The reference, row by row, in the question's unit.
    pub reference: Vec<f64>,
    /// Bound on the reference's own error, in the question's unit.
    pub error: f64,
    /// Wrong answers that are recognised.
    pub misconceptions: Vec<Misconception>,
    /// Where the reference comes from.
    pub derivation: Derivation,
    /// How a wrong earlier answer is carried through.
    pub follows: Option<FollowFile>,
}

/// A wrong answer that is recognised.
#[derive(Debug, Clone, PartialEq)]
pub struct Misconception {
    /// Name.
    pub id: String,
    /// The answer it leads to, row by row, in the question's unit.
    pub value: Vec<f64>,
    /// What to tell the student (Markdown).
    pub feedback: String,
    /// Computed by running a wrong model.
    pub computed: bool,
}

/// An option of a choice.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ChoiceOption {
    /// Id.
    pub id: String,
    /// The option (Markdown).
    pub text: String,
    /// Why it is right or wrong (Markdown).
    pub reason: String,
}

/// A formula and its wrong readings.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula {
    /// Names of the symbols, sorted.
    pub symbols: Vec<String>,
    /// The range of each symbol.
    pub ranges: Vec<[f64; 2]>,
    /// The reference.
    pub reference: Expression,
    /// The reference as it was written.
    pub reference_text: String,
    /// Wrong formulas that are recognised: name, formula, feedback.
    pub misconceptions: Vec<(String, Expression, String)>,
}

/// An explanation that people judge.
#[derive(Debug, Clone, PartialEq)]
pub struct Explanation {
    /// What it is to show (Markdown).
    pub purpose: String,
    /// Words from which it is taken.
    pub min_words: usize,
    /// A good one (Markdown).
    pub example: String,
}

/// The equations of a mechanism at given states.
#[derive(Debug, Clone, PartialEq)]
pub struct Implement {
    /// The mechanism.
    pub scene: Scene,
    /// What is returned for each state, in a fixed order.
    pub asks: Vec<EquationPart>,
    /// How many states.
    pub states: usize,
    /// States satisfy the constraints.
    pub consistent: bool,
    /// Largest difference, relative to the largest entry of the part (at least 1).
    pub tolerance: f64,
}

/// A table of a motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    /// The mechanism.
    pub scene: Scene,
    /// The table covers 0 to this time, s.
    pub end: f64,
    /// The columns besides `t`.
    pub columns: BTreeMap<String, MeasuredFile>,
    /// Errors and the share of the points that each still earns, the best first.
    pub bands: Vec<ScoreBand>,
}

/// A scene of the student's own.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelTask {
    /// The author's scene.
    pub reference: Scene,
    /// What is demanded.
    pub demands: ModelFile,
}

impl ModelTask {
    /// What is watched.
    pub fn watches(&self) -> &[WatchFile] {
        &self.demands.watches
    }
}

/// Settings under a budget.
#[derive(Debug, Clone, PartialEq)]
pub struct Tuning {
    /// The mechanism.
    pub scene: Scene,
    /// Evaluations that may be spent.
    pub budget: u64,
    /// Error to reach, SI.
    pub error: f64,
    /// How far the constraints may be violated at the end, SI.
    pub violation: Option<f64>,
    /// What is watched, with the end of the run as its time.
    pub watch: MeasuredFile,
    /// Integrators to choose from.
    pub integrators: Vec<IntegratorKind>,
    /// Whether Baumgarte's stabilization may be chosen.
    pub baumgarte: bool,
    /// Settings that meet the demand.
    pub reference: RunSettings,
}
