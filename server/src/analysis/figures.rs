//! Each question of a lesson in figures, without names.

use std::collections::HashMap;

use schemars::JsonSchema;
use serde::Serialize;
use triad_lessons::Lesson;
use triad_lessons::exercise::Question;
use triad_lessons::files::QuestionKind;

use super::statistics::{correlation, mean, upper_less_lower};
use super::work::{Class, Try, Work};

/// Students from which a figure is taken for more than chance.
const ENOUGH: usize = 10;
/// Facility above and below which a question is flagged, and discrimination below which.
const EASY: f64 = 0.8;
const HARD: f64 = 0.3;
const WEAK: f64 = 0.1;
/// Answers until right that are counted one by one; the last stands for all more.
const COUNTED: usize = 5;

/// The questions of a lesson in figures.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct LessonFigures {
    /// Slug of the lesson.
    pub slug: String,
    /// Its place in the course.
    pub number: u32,
    /// Its title.
    pub title: String,
    /// Students who handed in.
    pub students: usize,
    /// The questions, in the order of the lesson.
    pub questions: Vec<QuestionFigures>,
}

/// A question in figures.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct QuestionFigures {
    /// The question's id.
    pub id: String,
    /// Its kind.
    pub kind: QuestionKind,
    /// Its points.
    pub points: f64,
    /// Students who handed in and were asked it.
    pub asked: usize,
    /// Of these, those who gave an answer that could be judged, or an explanation.
    pub answered: usize,
    /// Those who earned all points by now.
    pub right: usize,
    /// Mean share of the points of first answers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub facility: Option<f64>,
    /// Mean share of the points of best answers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub facility_best: Option<f64>,
    /// Correlation of first answers with those to all other questions of the lesson.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub discrimination: Option<f64>,
    /// Facility among the 27 % who are best at the other questions, less that among the 27 % who are worst.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub upper_less_lower: Option<f64>,
    /// Students who needed 1, 2, 3, 4, and 5 or more different answers.
    pub until_right: [usize; COUNTED],
    /// Mistakes by the number of students who made them, the most frequent first. An empty name: not recognised.
    pub mistakes: Vec<MistakeCount>,
    /// What to look at; nothing below ten students.
    pub flags: Vec<Flag>,
}

/// A mistake and how many made it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct MistakeCount {
    /// Its name; empty: not recognised.
    pub name: String,
    /// Students who made it at least once.
    pub students: usize,
    /// Students whose last answer still has it.
    pub still: usize,
}

/// What to look at in a question.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Flag {
    /// First answers earn more than 80 %.
    Easy,
    /// First answers earn less than 30 %.
    Hard,
    /// It tells little about who is good at the other questions.
    Weak,
}

impl Flag {
    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Easy => "easy",
            Self::Hard => "hard",
            Self::Weak => "weak",
        }
    }
}

impl LessonFigures {
    /// The figures of a lesson's questions.
    pub fn of(lesson: &Lesson, class: &Class) -> Self {
        let none = Vec::new();
        let figures = |question: &Question| {
            QuestionFigures::of(question, class.questions.get(&question.id).unwrap_or(&none))
        };
        Self {
            slug: lesson.slug.clone(),
            number: lesson.number,
            title: lesson.about.title.clone(),
            students: class.students,
            questions: lesson.exercise.questions.iter().map(figures).collect(),
        }
    }
}

impl QuestionFigures {
    /// The figures of a question.
    pub(super) fn of(question: &Question, works: &[Work]) -> Self {
        let firsts: Vec<f64> = works.iter().filter_map(Work::first).collect();
        let bests: Vec<f64> = works.iter().filter_map(Work::best).collect();
        let beside: Vec<(f64, f64)> =
            works.iter().filter_map(|work| Some((work.first()?, work.rest?))).collect();
        let mut until_right = [0; COUNTED];
        for needed in works.iter().filter_map(Work::until_right) {
            until_right[needed.clamp(1, COUNTED) - 1] += 1;
        }
        let mut figures = Self {
            id: question.id.clone(),
            kind: question.kind,
            points: question.points,
            asked: works.len(),
            answered: works.iter().filter(|work| work.has_answered()).count(),
            right: until_right.iter().sum(),
            facility: mean(&firsts),
            facility_best: mean(&bests),
            discrimination: correlation(&beside),
            upper_less_lower: upper_less_lower(&beside),
            until_right,
            mistakes: mistakes(works),
            flags: Vec::new(),
        };
        figures.flags = figures.flagged();
        figures
    }

    fn flagged(&self) -> Vec<Flag> {
        let is = |flag, value: Option<f64>, wrong: &dyn Fn(f64) -> bool| {
            value.filter(|value| self.answered >= ENOUGH && wrong(*value)).map(|_| flag)
        };
        let flags = [
            is(Flag::Easy, self.facility, &|x| x > EASY),
            is(Flag::Hard, self.facility, &|x| x < HARD),
            is(Flag::Weak, self.discrimination, &|x| x < WEAK),
        ];
        flags.into_iter().flatten().collect()
    }
}

/// The mistakes of wrong answers, by the number of students.
fn mistakes(works: &[Work]) -> Vec<MistakeCount> {
    let mut counts: HashMap<String, MistakeCount> = HashMap::new();
    for work in works {
        let mut own: Vec<&str> = work.judged().filter_map(Try::wrong).collect();
        own.sort_unstable();
        own.dedup();
        let last = work.judged().next_back().and_then(Try::wrong);
        for name in own {
            let count = counts.entry(name.to_owned()).or_insert_with(|| MistakeCount {
                name: name.to_owned(),
                students: 0,
                still: 0,
            });
            count.students += 1;
            count.still += usize::from(last == Some(name));
        }
    }
    let mut sorted: Vec<MistakeCount> = counts.into_values().collect();
    sorted.sort_by(|a, b| (b.students, &a.name).cmp(&(a.students, &b.name)));
    sorted
}
