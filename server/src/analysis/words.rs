//! What a class said in words in a lesson: what everybody predicted, and what they explained, with what it was given.

use std::collections::{BTreeMap, HashSet};

use schemars::JsonSchema;
use serde::Serialize;
use triad_lessons::exercise::Question;
use triad_lessons::lesson::PredictionView;
use triad_lessons::{Lesson, Mark, right_answer};

use super::work::{Class, Work};
use crate::grades::{Book, Entry, Marked};
use crate::policy::Moment;
use crate::store::KeptPrediction;

/// What a class predicted and explained in a lesson.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ClassWords {
    /// Slug of the lesson.
    pub slug: String,
    /// What was to be predicted.
    pub predictions: Vec<AskedPrediction>,
    /// What was to be explained.
    pub explanations: Vec<AskedExplanation>,
    /// Students who predicted or explained something, by name.
    pub students: Vec<StudentWords>,
}

/// Something to be predicted.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct AskedPrediction {
    /// What was asked.
    #[serde(flatten)]
    pub asked: PredictionView,
    /// Id of the option that comes true.
    pub happens: String,
}

/// Something to be explained.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct AskedExplanation {
    /// Id of the question.
    pub id: String,
    /// Its place in the exercise.
    pub place: usize,
    /// What is asked, as safe HTML.
    pub prompt_html: String,
    /// A good explanation, as safe HTML.
    pub good_html: String,
    /// Points that people can give.
    pub points: f64,
    /// How many explanations wait for their points.
    pub waiting: usize,
}

/// What one student said.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct StudentWords {
    /// The person's id.
    pub person: String,
    /// The name.
    pub name: String,
    /// What they predicted, in the order in which they did.
    pub predicted: Vec<StudentPrediction>,
    /// What they explained: of each question the last.
    pub explained: Vec<StudentExplanation>,
}

/// What one student predicted.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct StudentPrediction {
    /// Id of the prediction.
    pub prediction: String,
    /// Id of the option; absent if it was skipped.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub choice: Option<String>,
    /// Why, in the student's words; may be empty.
    pub why: String,
}

/// What one student explained.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct StudentExplanation {
    /// Id of the question.
    pub question: String,
    /// The submission.
    pub submission: String,
    /// When it came.
    pub at: Moment,
    /// The words.
    pub text: String,
    /// What it was given; absent where it waits.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mark: Option<Marked>,
    /// Whether the words were written after they were given points: they wait once more.
    pub renewed: bool,
}

impl StudentExplanation {
    /// Whether somebody has to read it.
    pub fn waits(&self) -> bool {
        self.mark.is_none() || self.renewed
    }
}

impl ClassWords {
    /// What is kept of it: `class` and `predicted` of students alone.
    pub fn of(lesson: &Lesson, class: &Class, predicted: &[KeptPrediction], book: &Book) -> Self {
        let mut students: BTreeMap<(String, String), StudentWords> = BTreeMap::new();
        let asked: Vec<(usize, &Question)> = (1..)
            .zip(&lesson.exercise.questions)
            .filter(|(_, question)| question.is_judged_by_people())
            .collect();
        for one in predicted {
            student(&mut students, &one.name, &one.person).predicted.push(StudentPrediction {
                prediction: one.prediction.clone(),
                choice: one.choice.clone(),
                why: one.why.clone(),
            });
        }
        for (_, question) in &asked {
            for work in class.questions.get(&question.id).into_iter().flatten() {
                let entry = book.of(&work.person, &lesson.slug);
                if let Some(explained) = explained(question, work, entry) {
                    student(&mut students, &work.name, &work.person).explained.push(explained);
                }
            }
        }
        let students: Vec<StudentWords> = students.into_values().collect();
        let mut views = lesson.public_view().exercise.questions;
        let explanations = asked.into_iter().map(|(place, question)| {
            let all = students.iter().flat_map(|one| &one.explained);
            AskedExplanation {
                id: question.id.clone(),
                place,
                prompt_html: std::mem::take(&mut views[place - 1].prompt_html),
                good_html: right_answer(lesson, &question.id).unwrap_or_default(),
                points: question.points,
                waiting: all.filter(|one| one.question == question.id && one.waits()).count(),
            }
        });
        let explanations = explanations.collect();
        let predictions = lesson.predictions().into_iter().map(|asked| AskedPrediction {
            happens: lesson.outcome(&asked.id).map(|outcome| outcome.happens).unwrap_or_default(),
            asked,
        });
        Self { slug: lesson.slug.clone(), predictions: predictions.collect(), explanations, students }
    }
}

/// Whose explanations in a lesson wait for points.
pub fn waiting(lesson: &Lesson, class: &Class, book: &Book) -> HashSet<String> {
    let asked = lesson.exercise.questions.iter().filter(|question| question.is_judged_by_people());
    let work = asked.flat_map(|question| {
        class.questions.get(&question.id).into_iter().flatten().map(move |work| (question, work))
    });
    work.filter(|(question, work)| {
        explained(question, work, book.of(&work.person, &lesson.slug)).is_some_and(|one| one.waits())
    })
    .map(|(_, work)| work.person.clone())
    .collect()
}

fn student<'a>(
    all: &'a mut BTreeMap<(String, String), StudentWords>,
    name: &str,
    person: &str,
) -> &'a mut StudentWords {
    all.entry((name.to_owned(), person.to_owned())).or_insert_with(|| StudentWords {
        person: person.to_owned(),
        name: name.to_owned(),
        predicted: Vec::new(),
        explained: Vec::new(),
    })
}

/// The last explanation of somebody's work at a question.
fn explained(question: &Question, work: &Work, entry: Option<&Entry>) -> Option<StudentExplanation> {
    let last = work.tries.iter().rfind(|one| one.mark == Mark::Kept)?;
    let text = last.answer["value"].as_str().unwrap_or_default();
    let mark = entry.and_then(|entry| entry.mark(&question.id)).cloned();
    // The same words handed in again, beside other answers, are no new ones.
    let since = work.tries.iter().rev().take_while(|one| one.answer["value"] == text).last();
    let written = since.map_or(last.at, |one| one.at);
    Some(StudentExplanation {
        question: question.id.clone(),
        submission: last.submission.clone(),
        at: written,
        text: text.to_owned(),
        renewed: mark.as_ref().is_some_and(|mark| mark.at < written),
        mark,
    })
}
