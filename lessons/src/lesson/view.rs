//! What a student may see of a lesson. Pages are built from this alone.

use schemars::JsonSchema;
use serde::Serialize;
use triad_engine::scene::{IntegratorKind, Scene};

use super::content::Lesson;
use super::conventions::conventions;
use super::diagram_view::DiagramView;
use super::prediction::{OptionView, PredictionView};
use super::rules::{measurement, opens, rule};
use crate::answers::tolerance::ValueShape;
use crate::exercise::{ChoiceOption, Parameters, Question, QuestionBody};
use crate::files::{EquationPart, MeasuredFile, QuestionKind, StepFile, StepKind, earlier_value};
use crate::rendering::markdown;

impl Lesson {
    /// The entry for the list of lessons.
    pub fn summary(&self) -> LessonSummary {
        LessonSummary {
            slug: self.slug.clone(),
            number: self.number,
            part: self.part.clone(),
            title: self.about.title.clone(),
            summary: self.about.summary.clone(),
            minutes: self.about.minutes,
            objectives: self.about.objectives.clone(),
            introduces: self.about.introduces.keys().cloned().collect(),
            needs: self.about.needs.clone(),
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
            predictions: self.predictions(),
            has_variants: self.has_variants(),
            seed: self.seed.clone(),
            exercise: ExerciseView {
                pass_mark: self.exercise.pass_mark,
                // A scene that cannot be read is reported where the lesson is read.
                conventions_html: Scene::from_json(&self.scene.to_string())
                    .map(|scene| markdown::render_short(&conventions(&scene)))
                    .unwrap_or_default(),
                opens: opens(self.opens, self.held),
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
    /// Title of the part of the course that it stands in.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// Title.
    pub title: String,
    /// One sentence.
    pub summary: String,
    /// Time a student needs.
    pub minutes: u32,
    /// What the student can do afterwards.
    pub objectives: Vec<String>,
    /// Notions that it introduces.
    pub introduces: Vec<String>,
    /// Notions that it builds on.
    pub needs: Vec<String>,
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
    /// What is predicted before the scenario runs; may be empty.
    pub predictions: Vec<PredictionView>,
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
    /// What the scene takes for granted, as safe HTML: axes, gravity, masses, inertias, positive senses.
    pub conventions_html: String,
    /// When a right answer is shown, in words; absent if never.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub opens: Option<String>,
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
    /// Names of a vector's components in the frame that is asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub components: Vec<String>,
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
    pub asks: Vec<EquationPart>,
    /// Columns of the table besides `t` (trajectory).
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub columns: Vec<ColumnView>,
    /// What may be chosen (tuning).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tuning: Option<TuningView>,
    /// What is cut free (diagram).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub diagram: Option<DiagramView>,
    /// Words from which an explanation is taken (explanation).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_words: Option<usize>,
    /// Earlier questions whose answer is carried through, right or wrong.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub follows: Vec<String>,
    /// How many hints there are.
    pub hints_available: usize,
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

/// The names in the brackets of a frame such as `the body frame (u, v, w)`, if a vector has as many components.
fn components(frame: &str, [rows, columns]: [usize; 2]) -> Vec<String> {
    let inside = frame.rsplit_once('(').and_then(|(_, rest)| rest.split_once(')'));
    let names =
        inside.map(|(names, _)| names.split(',').map(|name| name.trim().to_owned()).collect::<Vec<_>>());
    names.filter(|names| names.len() == rows && columns == 1).unwrap_or_default()
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
            components: Vec::new(),
            symbols: Vec::new(),
            rule: rule(question),
            points: question.points,
            options: None,
            asks: Vec::new(),
            columns: Vec::new(),
            tuning: None,
            diagram: None,
            min_words: None,
            follows: Vec::new(),
            hints_available: question.hints.len(),
        };
        match &question.body {
            QuestionBody::Quantity(q) => {
                view.asks_unit = q.asks_unit;
                view.unit = (!q.asks_unit).then(|| q.unit.text().to_owned());
                view.size = (q.shape != ValueShape::Number).then_some(q.size);
                view.components = components(q.frame.as_deref().unwrap_or_default(), q.size);
                view.follows = q
                    .follows
                    .iter()
                    .flat_map(|f| f.from.values().map(|name| earlier_value(name).0.to_owned()))
                    .collect();
            }
            QuestionBody::Choice { options, .. } => {
                let shown =
                    |o: &ChoiceOption| OptionView { id: o.id.clone(), html: markdown::render_short(&o.text) };
                view.options = Some(options.iter().map(shown).collect());
            }
            QuestionBody::Formula(f) => view.symbols.clone_from(&f.symbols),
            QuestionBody::Diagram(d) => view.diagram = Some(DiagramView::new(d)),
            QuestionBody::Implement(i) => view.asks.clone_from(&i.asks),
            QuestionBody::Trajectory(t) => {
                let column = |(name, m): (&String, &MeasuredFile)| ColumnView {
                    name: name.clone(),
                    what: measurement(m),
                };
                view.columns = t.columns.iter().map(column).collect();
            }
            QuestionBody::Model(_) => {}
            QuestionBody::Explanation(e) => view.min_words = Some(e.min_words),
            QuestionBody::Tuning(t) => {
                let (integrators, baumgarte, budget, error) =
                    (t.integrators.clone(), t.baumgarte, t.budget, t.error);
                view.tuning = Some(TuningView { integrators, baumgarte, budget, error });
            }
        }
        view
    }
}
