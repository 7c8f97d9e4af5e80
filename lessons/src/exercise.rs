//! Questions as they are graded: units read, expressions evaluated, references attached.

use std::collections::BTreeMap;

use thiserror::Error;

use crate::expression::Expression;
use crate::files::{ExerciseFile, MeasuredFile, ProvenanceKind, QuestionFile, QuestionKind, ReferenceFile};
use crate::submission::Entry;
use crate::tolerance::{Rule, Shape};
use crate::units::Unit;
use crate::variant::Parameters;

/// The questions of a lesson, with their answers. Never leaves the server.
#[derive(Debug, Clone, PartialEq)]
pub struct Exercise {
    /// Share of the points that passes the lesson.
    pub pass_mark: f64,
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
        }
        texts
    }
}

/// What is graded, by family of kinds.
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
    /// What is wrong.
    pub problem: String,
    /// What to do.
    pub remedy: String,
}

/// Joins questions and references.
pub(crate) fn build(
    file: ExerciseFile,
    mut references: BTreeMap<String, ReferenceFile>,
    parameters: &Parameters,
) -> Result<Exercise, QuestionError> {
    let mut questions: Vec<Question> = Vec::new();
    for question in file.questions {
        let id = question.id.clone();
        let fail = |problem: String, remedy: &str| QuestionError {
            question: id.clone(),
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
            QuestionKind::Number => quantity(&question, &reference, Shape::Number, parameters),
            QuestionKind::Vector => quantity(&question, &reference, Shape::Vector, parameters),
            QuestionKind::Matrix => quantity(&question, &reference, Shape::Matrix, parameters),
            QuestionKind::Choice => choice(&question, &reference),
            QuestionKind::Formula => formula(&question, &reference),
        }
        .map_err(|(problem, remedy)| fail(problem, &remedy))?;
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
    if let Some(id) = references.keys().next() {
        return Err(QuestionError {
            question: id.clone(),
            problem: "it has a reference but is not asked".to_owned(),
            remedy: "remove it from reference/answers.toml or ask it".to_owned(),
        });
    }
    Ok(Exercise { pass_mark: file.pass_mark, questions })
}

type Trouble = (String, String);

fn trouble(problem: impl Into<String>, remedy: impl Into<String>) -> Trouble {
    (problem.into(), remedy.into())
}

fn refuse(present: bool, key: &str, kind: &str) -> Result<(), Trouble> {
    if present { Err(trouble(format!("{key} does not belong to a {kind}"), "remove it")) } else { Ok(()) }
}

fn quantity(
    question: &QuestionFile,
    reference: &ReferenceFile,
    shape: Shape,
    parameters: &Parameters,
) -> Result<Body, Trouble> {
    refuse(!question.options.is_empty(), "an option", "number, vector or matrix")?;
    refuse(!question.symbols.is_empty(), "symbols", "number, vector or matrix")?;
    let unit_text =
        question.unit.as_deref().ok_or_else(|| trouble("it has no unit", "add unit = \"N\", or \"\""))?;
    let unit = Unit::parse(unit_text).map_err(|e| trouble(format!("its unit: {e}"), "correct unit"))?;
    let tolerance = question.tolerance.ok_or_else(|| {
        trouble("it has no tolerance", "add tolerance = { relative = 0.005, absolute = 0 }")
    })?;
    let in_range = |x: f64| (0.0..f64::INFINITY).contains(&x);
    if !in_range(tolerance.relative) || tolerance.relative >= 0.5 || !in_range(tolerance.absolute) {
        return Err(trouble("its tolerance is negative or too large", "keep relative between 0 and 0.5"));
    }
    let rule = Rule { absolute: tolerance.absolute, relative: tolerance.relative };
    if tolerance.exact != rule.is_exact() {
        return Err(trouble(
            "its tolerance is neither exact nor a range",
            "write exact = true, or relative/absolute",
        ));
    }
    if shape != Shape::Number && question.frame.is_none() {
        return Err(trouble("it has no frame", "add frame = \"the ground frame (x, y, z)\""));
    }
    let (values, size) = numbers(&reference.value, shape, parameters)?;
    let misconceptions = question
        .misconceptions
        .iter()
        .map(|m| {
            let (value, own) = numbers(&m.value, shape, parameters)?;
            if own != size {
                return Err(trouble(
                    format!("misconception {} has another size", m.id),
                    "give it the reference's",
                ));
            }
            Ok(Misconception { id: m.id.clone(), value, feedback: parameters.fill(&m.feedback) })
        })
        .collect::<Result<_, _>>()?;
    Ok(Body::Quantity(Quantity {
        shape,
        size,
        unit,
        asks_unit: question.asks_unit,
        frame: question.frame.clone(),
        rule,
        reference: values,
        error: reference.error,
        misconceptions,
    }))
}

/// Numbers of an author: written out or as an expression in the parameters.
fn numbers(entry: &Entry, shape: Shape, parameters: &Parameters) -> Result<(Vec<f64>, [usize; 2]), Trouble> {
    let one = |entry: &Entry| -> Result<f64, Trouble> {
        let value = match entry {
            Entry::Number(x) => *x,
            Entry::Text(text) => parameters
                .eval(text)
                .map_err(|e| trouble(format!("the value \u{201c}{text}\u{201d}: {e}"), "correct it"))?,
            Entry::List(_) => return Err(trouble("a value is nested too deeply", "write one list per row")),
        };
        if value.is_finite() {
            Ok(value)
        } else {
            Err(trouble("a value is not finite", "correct the expression"))
        }
    };
    let row = |entry: &Entry| -> Result<Vec<f64>, Trouble> {
        match entry {
            Entry::List(list) if !list.is_empty() => list.iter().map(one).collect(),
            _ => Err(trouble("a value is not a list", "write value = [1, 2, 3]")),
        }
    };
    match (shape, entry) {
        (Shape::Number, entry) => Ok((vec![one(entry)?], [1, 1])),
        (Shape::Vector, entry) => {
            let values = row(entry)?;
            let size = [values.len(), 1];
            Ok((values, size))
        }
        (Shape::Matrix, Entry::List(rows)) => {
            let rows: Vec<Vec<f64>> = rows.iter().map(row).collect::<Result<_, _>>()?;
            let columns = rows.first().map_or(0, Vec::len);
            if columns == 0 || rows.iter().any(|r| r.len() != columns) {
                return Err(trouble("the rows have different lengths", "write every row in full"));
            }
            Ok((rows.concat(), [rows.len(), columns]))
        }
        (Shape::Matrix, _) => {
            Err(trouble("the value is not a list of rows", "write value = [[1, 0], [0, 1]]"))
        }
    }
}

fn choice(question: &QuestionFile, reference: &ReferenceFile) -> Result<Body, Trouble> {
    refuse(question.unit.is_some(), "a unit", "choice")?;
    refuse(question.tolerance.is_some(), "a tolerance", "choice")?;
    refuse(!question.misconceptions.is_empty(), "a misconception (the options have reasons)", "choice")?;
    let options: Vec<Choice> = question
        .options
        .iter()
        .map(|o| Choice { id: o.id.clone(), text: o.text.clone(), reason: o.reason.clone() })
        .collect();
    if options.len() < 2 || options.iter().enumerate().any(|(k, o)| options[..k].iter().any(|p| p.id == o.id))
    {
        return Err(trouble("it has fewer than two options, or two with the same id", "add options a, b, …"));
    }
    match &reference.value {
        Entry::Text(right) if options.iter().any(|o| o.id == *right) => {
            Ok(Body::Choice { options, right: right.clone() })
        }
        _ => Err(trouble("its reference is not one of its options", "name the right option's id as value")),
    }
}

fn formula(question: &QuestionFile, reference: &ReferenceFile) -> Result<Body, Trouble> {
    refuse(question.unit.is_some(), "a unit", "formula")?;
    refuse(question.tolerance.is_some(), "a tolerance", "formula")?;
    refuse(!question.options.is_empty(), "an option", "formula")?;
    let symbols: Vec<String> = question.symbols.keys().cloned().collect();
    let ranges: Vec<[f64; 2]> = question.symbols.values().copied().collect();
    if symbols.is_empty()
        || ranges.iter().any(|[low, high]| !(low.is_finite() && high.is_finite() && low < high))
    {
        return Err(trouble("it has no symbols, or an empty range", "add symbols = { m = [0.5, 2.0] }"));
    }
    let names: Vec<&str> = symbols.iter().map(String::as_str).collect();
    let read = |entry: &Entry| match entry {
        Entry::Text(text) => Expression::parse(text, &names)
            .map_err(|e| trouble(format!("\u{201c}{text}\u{201d}: {e}"), "correct it")),
        _ => Err(trouble("a formula is not text", "write value = \"m*g\"")),
    };
    let reference_text = match &reference.value {
        Entry::Text(text) => text.clone(),
        _ => String::new(),
    };
    let misconceptions = question
        .misconceptions
        .iter()
        .map(|m| Ok((m.id.clone(), read(&m.value)?, m.feedback.clone())))
        .collect::<Result<_, Trouble>>()?;
    let expression = read(&reference.value)?;
    Ok(Body::Formula(FormulaBody { symbols, ranges, reference: expression, reference_text, misconceptions }))
}
