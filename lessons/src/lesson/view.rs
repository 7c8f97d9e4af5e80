//! What a student may see of a lesson. Pages are built from this alone.

use schemars::JsonSchema;
use serde::Serialize;
use triad_engine::scene::{IntegratorKind, Scene};

use super::Lesson;
use crate::exercise::{Body, Choice, Question, Trajectory, Tuning};
use crate::files::{MeasuredFile, MotionKind, Part, QuestionKind, StepFile, StepKind};
use crate::markdown;
use crate::tolerance::{Shape, plain};
use crate::variant::Parameters;

impl Lesson {
    /// The entry for the list of lessons.
    pub fn summary(&self) -> LessonSummary {
        LessonSummary {
            slug: self.slug.clone(),
            number: self.number,
            title: self.about.title.clone(),
            summary: self.about.summary.clone(),
            minutes: self.about.minutes,
            objectives: self.about.objectives.clone(),
        }
    }

    /// What a student may see: the text, the scenario and the questions, but no answer.
    pub fn public_view(&self) -> LessonView {
        LessonView {
            summary: self.summary(),
            prerequisites: self.about.prerequisites.clone(),
            html: self.text.html.clone(),
            scene: self.scene.clone(),
            steps: self.about.steps.iter().map(|step| StepView::new(step, &self.parameters)).collect(),
            has_variants: self.has_variants(),
            seed: self.seed.clone(),
            exercise: ExerciseView {
                pass_mark: self.exercise.pass_mark,
                questions: self.exercise.questions.iter().map(QuestionView::new).collect(),
            },
        }
    }
}

/// A lesson in the list of lessons.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct LessonSummary {
    /// Stable name for addresses.
    pub slug: String,
    /// Place in the course, from 1.
    pub number: u32,
    /// Title.
    pub title: String,
    /// One sentence.
    pub summary: String,
    /// Time a student needs.
    pub minutes: u32,
    /// What the student can do afterwards.
    pub objectives: Vec<String>,
}

/// A lesson as a student sees it.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "Lesson")]
pub struct LessonView {
    /// Title, summary and so on.
    #[serde(flatten)]
    pub summary: LessonSummary,
    /// Slugs of the lessons that come before.
    pub prerequisites: Vec<String>,
    /// The text as safe HTML.
    pub html: String,
    /// The scenario.
    #[schemars(with = "Scene")]
    pub scene: serde_json::Value,
    /// Predict, run, check, explain; may be empty.
    pub steps: Vec<StepView>,
    /// Whether each student gets numbers, or states, of their own.
    pub has_variants: bool,
    /// Whose numbers these are; empty for those that everybody sees without a name.
    pub seed: String,
    /// The questions.
    pub exercise: ExerciseView,
}

/// A step as a student sees it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
#[schemars(rename = "LessonStep")]
pub struct StepView {
    /// What to do here.
    pub kind: StepKind,
    /// The step as safe HTML.
    pub html: String,
}

/// The questions as a student sees them.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "Exercise")]
pub struct ExerciseView {
    /// Share of the points that passes.
    pub pass_mark: f64,
    /// The questions in order.
    pub questions: Vec<QuestionView>,
}

/// A question as a student sees it.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "Question")]
pub struct QuestionView {
    /// Id under which the answer is sent.
    pub id: String,
    /// Kind.
    pub kind: QuestionKind,
    /// What is asked, as safe HTML.
    pub prompt_html: String,
    /// Unit that is assumed unless another is given; absent for choices and where the unit is asked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// True if the student has to give the unit.
    pub asks_unit: bool,
    /// Rows and columns to fill in.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size: Option<[usize; 2]>,
    /// Symbols that a formula may use.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub symbols: Vec<String>,
    /// What counts as right, in words.
    pub rule: String,
    /// Points.
    pub points: f64,
    /// Options of a choice.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub options: Option<Vec<OptionView>>,
    /// What a program returns for each state (implement).
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub asks: Vec<Part>,
    /// Columns of the table besides `t` (trajectory).
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub columns: Vec<ColumnView>,
    /// What may be chosen (tuning).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tuning: Option<TuningView>,
    /// Earlier questions whose answer is carried through, right or wrong.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub follows: Vec<String>,
    /// How many hints there are.
    pub hints_available: usize,
}

/// An option as a student sees it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
#[schemars(rename = "ChoiceOption")]
pub struct OptionView {
    /// Id to send.
    pub id: String,
    /// The option as safe HTML.
    pub html: String,
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
#[schemars(rename = "TableColumn")]
pub struct ColumnView {
    /// Its name in the first line.
    pub name: String,
    /// What it holds.
    pub what: String,
}

/// What may be chosen for a run.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "TuningChoices")]
pub struct TuningView {
    /// Integrators.
    pub integrators: Vec<IntegratorKind>,
    /// Whether Baumgarte's stabilization may be chosen.
    pub baumgarte: bool,
    /// Evaluations that may be spent.
    pub budget: u64,
    /// The error to reach.
    pub error: f64,
}

impl StepView {
    fn new(step: &StepFile, parameters: &Parameters) -> Self {
        Self { kind: step.kind, html: markdown::render_short(&parameters.fill(&step.text)) }
    }
}

impl QuestionView {
    fn new(question: &Question) -> Self {
        let mut view = Self {
            id: question.id.clone(),
            kind: question.kind,
            prompt_html: markdown::render_short(&question.prompt),
            unit: None,
            asks_unit: false,
            size: None,
            symbols: Vec::new(),
            rule: rule(question),
            points: question.points,
            options: None,
            asks: Vec::new(),
            columns: Vec::new(),
            tuning: None,
            follows: Vec::new(),
            hints_available: question.hints.len(),
        };
        match &question.body {
            Body::Quantity(q) => {
                view.asks_unit = q.asks_unit;
                view.unit = (!q.asks_unit).then(|| q.unit.text().to_owned());
                view.size = (q.shape != Shape::Number).then_some(q.size);
                view.follows = q.follows.iter().flat_map(|f| f.from.values().cloned()).collect();
            }
            Body::Choice { options, .. } => {
                let shown =
                    |o: &Choice| OptionView { id: o.id.clone(), html: markdown::render_short(&o.text) };
                view.options = Some(options.iter().map(shown).collect());
            }
            Body::Formula(f) => view.symbols.clone_from(&f.symbols),
            Body::Implement(i) => view.asks.clone_from(&i.asks),
            Body::Trajectory(t) => {
                let column =
                    |(name, m): (&String, &MeasuredFile)| ColumnView { name: name.clone(), what: what(m) };
                view.columns = t.columns.iter().map(column).collect();
            }
            Body::Model(_) => {}
            Body::Tuning(t) => {
                let (integrators, baumgarte, budget, error) =
                    (t.integrators.clone(), t.baumgarte, t.budget, t.error);
                view.tuning = Some(TuningView { integrators, baumgarte, budget, error });
            }
        }
        view
    }
}

/// What counts as right, from what grades.
fn rule(question: &Question) -> String {
    match &question.body {
        Body::Quantity(q) => {
            let shown = if q.asks_unit { "" } else { q.unit.text() };
            let mut rule = q.rule.sentence(q.shape, shown, q.frame.as_deref());
            if q.follows.is_some() {
                rule.push_str(" If your earlier answer was wrong, this one is judged with it.");
            }
            rule
        }
        Body::Choice { .. } => "Choose one option.".to_owned(),
        Body::Formula(f) => format!(
            "Any form of the right formula counts; it is compared with ours at many points. Symbols: {}.",
            f.symbols.join(", ")
        ),
        Body::Implement(i) => {
            let parts = i.asks.iter().map(|p| p.symbol()).collect::<Vec<_>>().join(", ");
            format!(
                "For each of {} states: {parts}. An entry is right if it differs from ours by at most {} of the \
                 largest entry of its part (at least 1). Each part counts the same. JSON or CSV.",
                i.states,
                plain(i.tolerance)
            )
        }
        Body::Trajectory(t) => trajectory_rule(t),
        Body::Model(m) => {
            let checks = if m.demands.degrees_of_freedom { "degrees of freedom, " } else { "" };
            format!(
                "The scene is run, up to {} bodies, and judged by what it does: {checks}joints, motion. Any scene \
                 that does the same is right.",
                m.demands.most_bodies
            )
        }
        Body::Tuning(t) => tuning_rule(t),
    }
}

fn trajectory_rule(t: &Trajectory) -> String {
    let bands = t
        .bands
        .iter()
        .map(|b| format!("{} % up to an error of {} %", plain(b.share * 100.0), plain(b.error * 100.0)));
    format!(
        "A table (CSV) from 0 to {} s with a first line of names: t, {}. The error is the root mean square of the \
         difference, relative to that of the motion. Points: {}.",
        plain(t.end),
        t.columns.keys().cloned().collect::<Vec<_>>().join(", "),
        bands.collect::<Vec<_>>().join(", ")
    )
}

fn tuning_rule(t: &Tuning) -> String {
    format!(
        "Right if at {} s the error is at most {} and at most {} evaluations were used; half the points for one of \
         the two.",
        plain(t.watch.time),
        plain(t.error),
        t.budget
    )
}

/// A measurement in words.
fn what(measured: &MeasuredFile) -> String {
    let component = measured.component.map_or(String::new(), |c| format!("{c:?}").to_lowercase());
    match (&measured.body, &measured.joint) {
        (Some(body), _) => {
            let point = measured.point.map_or(String::new(), |p| {
                format!(" of the point ({}, {}, {}) m", plain(p[0]), plain(p[1]), plain(p[2]))
            });
            let (motion, unit) = match measured.motion {
                Some(MotionKind::Position) => ("position", "m"),
                Some(MotionKind::Velocity) => ("velocity", "m/s"),
                Some(MotionKind::AngularVelocity) => ("angular velocity", "rad/s"),
                Some(MotionKind::U) => ("vector u", "no unit"),
                Some(MotionKind::V) => ("vector v", "no unit"),
                Some(MotionKind::W) => ("vector w", "no unit"),
                None => ("motion", ""),
            };
            format!("{component} of the {motion}{point} of {body}, {unit}")
        }
        (None, Some(joint)) => {
            let side = measured.force_on.as_ref().or(measured.moment_on.as_ref()).map_or("", String::as_str);
            let (what, unit) = if measured.force_on.is_some() { ("force", "N") } else { ("moment", "N m") };
            format!("{component} of the {what} of {joint} on {side}, {unit}")
        }
        _ => "energy, J".to_owned(),
    }
}
