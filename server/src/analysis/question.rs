//! One question: the mistakes with the answers behind each, options, drawn numbers, and answers that are almost right.

use std::collections::BTreeSet;

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;
use triad_lessons::answers::Answer;
use triad_lessons::exercise::{Question, QuestionBody};
use triad_lessons::{Lesson, Mark};

use super::figures::QuestionFigures;
use super::near::Near;
use super::statistics::halves;
use super::work::{Try, Work};
use crate::policy::Moment;
use crate::problem::Problem;
use crate::variants::Variants;

/// Difference of two halves of a class from which drawn numbers are not equally hard, in standard errors.
const UNEQUAL: f64 = 3.0;
/// Longest answer that is shown whole, in characters.
const LONGEST: usize = 300;

/// What the answers of a class say about a question.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct QuestionAnalysis {
    /// Slug of the lesson.
    pub lesson: String,
    /// Its place in the course.
    pub number: u32,
    /// Title of the lesson.
    pub title: String,
    /// The question's place in the lesson, from 1.
    pub place: usize,
    /// Ids of the questions of the lesson, in order.
    pub questions: Vec<String>,
    /// What is asked, with the numbers that everybody sees, as safe HTML.
    pub prompt_html: String,
    /// The figures.
    pub figures: QuestionFigures,
    /// Mistakes with the answers behind each, the most frequent first.
    pub mistakes: Vec<MistakeAnswers>,
    /// How often each option was chosen; empty but for choices.
    pub choices: Vec<ChoiceCount>,
    /// Whether the numbers that were drawn are equally hard.
    pub drawn: Vec<DrawnNumber>,
    /// Students with a wrong answer within three tolerances of the right one; absent where there is no tolerance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub almost: Option<usize>,
    /// Students with an answer that was sent back.
    pub sent_back: usize,
}

/// A mistake with the answers behind it.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct MistakeAnswers {
    /// Its name; empty: not recognised.
    pub name: String,
    /// Students who made it at least once.
    pub students: usize,
    /// Students whose last answer still has it.
    pub still: usize,
    /// What the first of them was told, as safe HTML.
    pub told_html: String,
    /// The answers, by name.
    pub answers: Vec<GivenAnswer>,
}

/// An answer that was given.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct GivenAnswer {
    /// The person's id.
    pub person: String,
    /// The name.
    pub name: String,
    /// When.
    pub at: Moment,
    /// The submission.
    pub submission: String,
    /// The answer in one line.
    pub answer: String,
    /// Whether the person has earned all points since.
    pub mended: bool,
}

/// An option and how often it was chosen.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct ChoiceCount {
    /// Id of the option.
    pub id: String,
    /// The option, as safe HTML.
    pub html: String,
    /// Whether it is right.
    pub right: bool,
    /// Students who chose it first.
    pub first: usize,
    /// Students who chose it last.
    pub last: usize,
}

/// Facility of first answers by halves of the class: those who drew a small number, and those who drew a large one.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct DrawnNumber {
    /// Name of the number.
    pub name: String,
    /// The upper half begins here.
    pub border: f64,
    /// Students below, and their facility.
    pub below: (usize, f64),
    /// The others.
    pub above: (usize, f64),
    /// The difference in standard errors; absent where nothing varies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deviations: Option<f64>,
    /// Whether that is more than chance.
    pub unequal: bool,
}

impl QuestionAnalysis {
    /// What the answers say about a question of the lesson, and none where it has no such question.
    ///
    /// Errors if a student's numbers cannot be drawn.
    pub fn of(
        lesson: &Lesson,
        numbers: (&Variants, &Near),
        id: &str,
        works: &[Work],
    ) -> Result<Option<Self>, Problem> {
        let questions = &lesson.exercise.questions;
        let Some(place) = questions.iter().position(|question| question.id == id) else { return Ok(None) };
        let question = &questions[place];
        let figures = QuestionFigures::of(question, works);
        let view = lesson.public_view().exercise.questions.swap_remove(place);
        Ok(Some(Self {
            lesson: lesson.slug.clone(),
            number: lesson.number,
            title: lesson.about.title.clone(),
            place: place + 1,
            questions: questions.iter().map(|question| question.id.clone()).collect(),
            prompt_html: view.prompt_html,
            mistakes: figures
                .mistakes
                .iter()
                .map(|count| {
                    let (told_html, answers) = behind(&count.name, works);
                    MistakeAnswers {
                        name: count.name.clone(),
                        students: count.students,
                        still: count.still,
                        told_html,
                        answers,
                    }
                })
                .collect(),
            choices: view
                .options
                .unwrap_or_default()
                .into_iter()
                .map(|option| choice(question, option.id, option.html, works))
                .collect(),
            drawn: drawn(works),
            almost: almost(lesson, numbers, question, works)?,
            sent_back: works
                .iter()
                .filter(|work| work.tries.iter().any(|one| one.mark == Mark::Invalid))
                .count(),
            figures,
        }))
    }
}

/// What was told about a mistake, and everybody's last answer that has it.
fn behind(name: &str, works: &[Work]) -> (String, Vec<GivenAnswer>) {
    let mut told = String::new();
    let mut answers = Vec::new();
    for work in works {
        let Some(last) = work.judged().rfind(|one| one.wrong() == Some(name)) else { continue };
        if told.is_empty() {
            told.clone_from(&last.message_html);
        }
        answers.push(GivenAnswer {
            person: work.person.clone(),
            name: work.name.clone(),
            at: last.at,
            submission: last.submission.clone(),
            answer: in_a_line(&last.answer),
            mended: work.until_right().is_some(),
        });
    }
    (told, answers)
}

fn choice(question: &Question, id: String, html: String, works: &[Work]) -> ChoiceCount {
    let chose = |one: Option<&Try>| {
        let answer = one.and_then(|one| serde_json::from_value::<Answer>(one.answer.clone()).ok());
        answer
            .and_then(|answer| triad_lessons::chosen(&answer))
            .is_some_and(|chosen| chosen == id.to_lowercase())
    };
    let first = works.iter().filter(|work| chose(work.judged().next())).count();
    let last = works.iter().filter(|work| chose(work.judged().next_back())).count();
    let right = matches!(&question.body, QuestionBody::Choice { right, .. } if *right == id);
    ChoiceCount { id, html, right, first, last }
}

/// Facility by halves, for each number that was drawn.
fn drawn(works: &[Work]) -> Vec<DrawnNumber> {
    let names: BTreeSet<&String> = works.iter().flat_map(|work| work.numbers.keys()).collect();
    let number = |name: &String| {
        let pairs: Vec<(f64, f64)> =
            works.iter().filter_map(|work| Some((work.first()?, *work.numbers.get(name)?))).collect();
        let halves = halves(&pairs)?;
        Some(DrawnNumber {
            name: name.clone(),
            border: halves.border,
            below: halves.below,
            above: halves.above,
            deviations: halves.deviations,
            unequal: halves.deviations.is_some_and(|x| x.abs() >= UNEQUAL),
        })
    };
    names.into_iter().filter_map(number).collect()
}

/// How many students gave a wrong answer that is almost right.
fn almost(
    lesson: &Lesson,
    (variants, near): (&Variants, &Near),
    question: &Question,
    works: &[Work],
) -> Result<Option<usize>, Problem> {
    let has_tolerance = matches!(&question.body, QuestionBody::Quantity(body) if !body.tolerance.is_exact());
    if !has_tolerance {
        return Ok(None);
    }
    let mut count = 0;
    for work in works {
        count += usize::from(near.almost(lesson, variants, &question.id, work)?);
    }
    Ok(Some(count))
}

/// An answer in one line: as it was typed, or how long it is.
pub(super) fn in_a_line(answer: &Value) -> String {
    let text = |value: &Value| match value {
        Value::String(text) => text.clone(),
        Value::Null => String::new(),
        other => other.to_string(),
    };
    let parts: Vec<String> = match answer.as_object() {
        None => Vec::new(),
        Some(answer) => ["choice", "value", "unit", "text", "settings", "diagram", "file"]
            .into_iter()
            .filter_map(|key| Some((key, answer.get(key)?)))
            .map(|(key, value)| match (key, value.as_str()) {
                ("file", Some(file)) => format!("a file of {} bytes", file.len()),
                _ => text(value),
            })
            .filter(|part| !part.is_empty())
            .collect(),
    };
    let line = parts.join(" ");
    if line.chars().count() <= LONGEST {
        return line;
    }
    line.chars().take(LONGEST).chain(['…']).collect()
}
