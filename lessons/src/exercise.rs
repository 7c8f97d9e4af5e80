//! Questions as they are graded: units read, expressions evaluated, references attached.

use std::collections::BTreeMap;

use thiserror::Error;

mod tasks;
mod written;

use serde_json::Value;
use triad_engine::scene::Scene;

pub(crate) use written::numbers;

pub use tasks::{Implement, ModelTask, Trajectory, Tuning};

use crate::expression::Expression;
use crate::files::{
    ExerciseFile, FollowFile, MeasuredFile, OpensFile, ProvenanceKind, QuestionFile, QuestionKind,
    ReferenceFile,
};
use crate::lesson::Files;
use crate::tolerance::{Rule, Shape};
use crate::units::Unit;
use crate::variant::Parameters;

/// The questions of a lesson, with their answers. Never leaves the server.
#[derive(Debug, Clone, PartialEq)]
pub struct Exercise {
    /// Share of the points that passes the lesson.
    pub pass_mark: f64,
    /// When the right answers are told.
    pub opens: OpensFile,
    /// The questions in order.
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
    /// Hints (Markdown), one at a time.
    pub hints: Vec<String>,
    /// Said when the answer is right (Markdown).
    pub right: String,
    /// What is graded.
    pub body: Body,
    /// The reference's kind of source.
    pub provenance: ProvenanceKind,
    /// The reference's source in words.
    pub source: String,
    /// Where the scenario shows the same value.
    pub measured: Option<MeasuredFile>,
}

impl Question {
    /// Every text of the question that a student can come to see.
    pub fn texts(&self) -> Vec<&str> {
        let mut texts = vec![self.prompt.as_str(), self.right.as_str()];
        texts.extend(self.hints.iter().map(String::as_str));
        match &self.body {
            Body::Quantity(q) => texts.extend(q.misconceptions.iter().map(|m| m.feedback.as_str())),
            Body::Choice { options, .. } => {
                texts.extend(options.iter().flat_map(|o| [o.text.as_str(), o.reason.as_str()]));
            }
            Body::Formula(f) => texts.extend(f.misconceptions.iter().map(|(.., feedback)| feedback.as_str())),
            Body::Model(m) => texts.extend(m.watches().iter().map(|w| w.feedback.as_str())),
            Body::Implement(_) | Body::Trajectory(_) | Body::Tuning(_) => {}
        }
        texts
    }
}

/// What is graded, by family of kinds.
// A lesson has a handful of these, and each is made once.
#[allow(clippy::large_enum_variant)]
#[derive(Debug, Clone, PartialEq)]
pub enum Body {
    /// A number, a vector or a matrix.
    Quantity(Quantity),
    /// One of several options.
    Choice {
        /// Options in the order they are shown.
        options: Vec<Choice>,
        /// Id of the right one.
        right: String,
    },
    /// An expression in named symbols.
    Formula(FormulaBody),
    /// The equations at dealt states.
    Implement(Implement),
    /// A table of a motion.
    Trajectory(Trajectory),
    /// A scene of the student's own.
    Model(ModelTask),
    /// Settings under a budget.
    Tuning(Tuning),
}

/// Numbers with a unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// Number, vector or matrix.
    pub shape: Shape,
    /// Rows and columns; a number is 1 × 1, a vector n × 1.
    pub size: [usize; 2],
    /// Unit of the reference and of the rule.
    pub unit: Unit,
    /// The unit is part of what is asked.
    pub asks_unit: bool,
    /// Frame of the components.
    pub frame: Option<String>,
    /// What counts as right.
    pub rule: Rule,
    /// The reference, row by row, in the question's unit.
    pub reference: Vec<f64>,
    /// Bound on the reference's own error, in the question's unit.
    pub error: f64,
    /// Wrong answers that are recognised.
    pub misconceptions: Vec<Misconception>,
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
pub struct Choice {
    /// Id.
    pub id: String,
    /// The option (Markdown).
    pub text: String,
    /// Why it is right or wrong (Markdown).
    pub reason: String,
}

/// A formula and its wrong readings.
#[derive(Debug, Clone, PartialEq)]
pub struct FormulaBody {
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

/// What is wrong with a question, and what to do.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("question {question}: {problem}; {remedy}")]
pub struct QuestionError {
    /// The question's id.
    pub question: String,
    /// Whether it is wrong in `reference/answers.toml` rather than in `exercise.toml`.
    pub in_reference: bool,
    /// What is wrong.
    pub problem: String,
    /// What to do.
    pub remedy: String,
}

/// What questions are built on: the numbers of the variant, its scenario, and the files of the lesson.
pub(crate) struct Ground<'a> {
    pub(crate) parameters: &'a Parameters,
    pub(crate) scene: &'a Value,
    pub(crate) files: &'a Files,
}

impl Ground<'_> {
    /// The scenario, or the scene in another file of the lesson.
    fn scene_of(&self, file: Option<&str>) -> Result<Scene, Trouble> {
        let text = match file {
            None => self.scene.to_string(),
            Some(name) => {
                let bytes = self.files.get(name);
                let bytes = bytes.ok_or_else(|| trouble(format!("there is no file {name}"), "add it"))?;
                String::from_utf8_lossy(bytes).into_owned()
            }
        };
        let name = file.unwrap_or("scene.json");
        Scene::from_json(&text).map_err(|e| trouble(format!("{name}: {e}"), "correct the key it names"))
    }
}

/// Joins questions and references.
pub(crate) fn build(
    file: ExerciseFile,
    mut references: BTreeMap<String, ReferenceFile>,
    ground: &Ground,
) -> Result<Exercise, QuestionError> {
    let parameters = ground.parameters;
    let mut questions: Vec<Question> = Vec::new();
    for question in file.questions {
        let id = question.id.clone();
        let fail = |problem: String, remedy: &str| QuestionError {
            question: id.clone(),
            in_reference: false,
            problem,
            remedy: remedy.to_owned(),
        };
        if id.is_empty() || !id.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-') {
            return Err(fail(
                "its id is not made of small letters, digits and dashes".to_owned(),
                "rename it",
            ));
        }
        if questions.iter().any(|q| q.id == id) {
            return Err(fail("its id is used twice".to_owned(), "rename one of them"));
        }
        if !(question.points > 0.0 && question.points.is_finite()) {
            return Err(fail("its points are not positive".to_owned(), "give it at least 1 point"));
        }
        let Some(reference) = references.remove(&id) else {
            let remedy =
                format!("add [{id}] with value, error, provenance and source to reference/answers.toml");
            return Err(fail("it has no reference".to_owned(), &remedy));
        };
        let body = match question.kind {
            QuestionKind::Number => written::quantity(&question, &reference, Shape::Number, ground),
            QuestionKind::Vector => written::quantity(&question, &reference, Shape::Vector, ground),
            QuestionKind::Matrix => written::quantity(&question, &reference, Shape::Matrix, ground),
            QuestionKind::Choice => written::choice(&question, &reference),
            QuestionKind::Formula => written::formula(&question, &reference),
            QuestionKind::Implement => tasks::implement(&question, ground),
            QuestionKind::Trajectory => tasks::trajectory(&question, ground),
            QuestionKind::Model => tasks::model(&question, ground),
            QuestionKind::Tuning => tasks::tuning(&question, &reference, ground),
        }
        .and_then(|body| foreign_tables(&question).map(|()| body))
        .map_err(|e| QuestionError { in_reference: e.in_reference, ..fail(e.problem, &e.remedy) })?;
        questions.push(Question {
            id,
            kind: question.kind,
            prompt: parameters.fill(&question.prompt),
            points: question.points,
            hints: question.hints.iter().map(|h| parameters.fill(h)).collect(),
            right: parameters.fill(&question.right),
            body,
            provenance: reference.provenance,
            source: reference.source,
            measured: reference.measured,
        });
    }
    follows_earlier(&questions)?;
    if let Some(id) = references.keys().next() {
        return Err(QuestionError {
            question: id.clone(),
            in_reference: true,
            problem: "it has a reference but is not asked".to_owned(),
            remedy: "remove it from reference/answers.toml or ask it".to_owned(),
        });
    }
    Ok(Exercise { pass_mark: file.pass_mark, opens: file.opens, questions })
}

/// What is carried through comes from an earlier number.
fn follows_earlier(questions: &[Question]) -> Result<(), QuestionError> {
    for (at, question) in questions.iter().enumerate() {
        let Body::Quantity(Quantity { follows: Some(follows), .. }) = &question.body else { continue };
        for earlier in follows.from.values() {
            if !questions[..at].iter().any(|q| q.id == *earlier && q.kind == QuestionKind::Number) {
                return Err(QuestionError {
                    question: question.id.clone(),
                    in_reference: false,
                    problem: format!("it follows {earlier}, which is no earlier number"),
                    remedy: "name an earlier question of kind number".to_owned(),
                });
            }
        }
    }
    Ok(())
}

/// Tables of one kind of question do not belong to another.
fn foreign_tables(question: &QuestionFile) -> Result<(), Trouble> {
    use QuestionKind as Kind;
    let kind = question.kind;
    let name = format!("{kind:?}").to_lowercase();
    let quantity = matches!(kind, Kind::Number | Kind::Vector | Kind::Matrix);
    refuse(question.implement.is_some() && kind != Kind::Implement, "the table implement", &name)?;
    refuse(question.trajectory.is_some() && kind != Kind::Trajectory, "the table trajectory", &name)?;
    refuse(question.model.is_some() && kind != Kind::Model, "the table model", &name)?;
    refuse(question.tuning.is_some() && kind != Kind::Tuning, "the table tuning", &name)?;
    refuse(question.follows.is_some() && !quantity, "the table follows", &name)
}

/// What is wrong and what to do, before it is known with which question.
pub(crate) struct Trouble {
    problem: String,
    remedy: String,
    in_reference: bool,
}

impl Trouble {
    /// The same trouble, found in the file of the references.
    fn in_reference(self) -> Self {
        Self { in_reference: true, ..self }
    }
}

fn trouble(problem: impl Into<String>, remedy: impl Into<String>) -> Trouble {
    Trouble { problem: problem.into(), remedy: remedy.into(), in_reference: false }
}

fn refuse(present: bool, key: &str, kind: &str) -> Result<(), Trouble> {
    if present { Err(trouble(format!("{key} does not belong to a {kind}"), "remove it")) } else { Ok(()) }
}
