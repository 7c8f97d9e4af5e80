//! What students of a class answer, each at every run the same: what is right with their own numbers, and the mistakes that
//! lessons know.

use serde_json::{Map, Value, json};
use triad_lessons::answers::tolerance::ValueShape;
use triad_lessons::exercise::{QuantityQuestion, Question, QuestionBody};
use triad_lessons::{Lesson, reference_submission};

use super::FAULTY;

/// What a student does with a lesson.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Habit {
    Never,
    Right,
    /// So many wrong attempts, then a right one.
    Learns(u32),
    Wrong,
}

/// A number for each student and lesson (SplitMix64).
fn drawn(student: usize, lesson: &Lesson) -> u64 {
    let mut z = (student as u64 * 64 + u64::from(lesson.number)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Habit {
    pub(super) fn of(student: usize, lesson: &Lesson) -> Self {
        // The lesson that is graded again has more attempts: 300 students make a thousand.
        let wrong = if lesson.slug == FAULTY { 5 } else { 1 };
        match drawn(student, lesson) % 10 {
            0 => Self::Never,
            1..=3 => Self::Right,
            4..=8 => Self::Learns(wrong),
            _ => Self::Wrong,
        }
    }

    /// Wrong attempts.
    fn wrong(self) -> u32 {
        match self {
            Self::Never | Self::Right => 0,
            Self::Learns(wrong) => wrong,
            Self::Wrong => 1,
        }
    }

    pub(super) fn is_right(self) -> bool {
        matches!(self, Self::Right | Self::Learns(_))
    }
}

/// All that a student hands in to a lesson with their own numbers, one after the other.
pub(super) fn attempts(student: usize, habit: Habit, own: &Lesson) -> Vec<Value> {
    let right = serde_json::to_value(reference_submission(own).answers).expect("JSON");
    // Each falls for another mistake first; some share it.
    let first = usize::try_from(drawn(student, own) >> 40).expect("24 bits");
    let mut all: Vec<Value> = Vec::new();
    for attempt in 0..habit.wrong() {
        let wrong = wrong(own, &right, first, attempt);
        // Where a lesson asks for files alone there is nothing to mistype.
        if wrong.as_object().is_some_and(|answers| !answers.is_empty()) {
            all.push(wrong);
        }
    }
    all.extend(habit.is_right().then_some(right));
    all
}

/// Wrong answers to what is judged by its value: no attempt repeats one of before.
fn wrong(own: &Lesson, right: &Value, first: usize, attempt: u32) -> Value {
    let mut answers = Map::new();
    for question in &own.exercise.questions {
        let mut answer = right[&question.id].clone();
        match mistaken(question, first, attempt) {
            Some((key, value)) => answer[key] = value,
            None if answer["value"].is_string() && !question.is_judged_by_people() => {
                answer["value"] = json!(format!("0.{}23", attempt + 1));
            }
            None => continue,
        }
        answers.insert(question.id.clone(), answer);
    }
    Value::Object(answers)
}

/// A mistake that the question knows, and which part of the answer has it.
fn mistaken(question: &Question, first: usize, attempt: u32) -> Option<(&'static str, Value)> {
    let attempt = attempt as usize;
    match &question.body {
        // After that it is of no known kind.
        QuestionBody::Quantity(q) if attempt < q.misconceptions.len() => {
            let known = &q.misconceptions[(first + attempt) % q.misconceptions.len()];
            Some(("value", typed(q, &known.value)))
        }
        // A second wrong option would open the right one.
        QuestionBody::Choice { options, right } if attempt == 0 => {
            let wrong: Vec<&str> =
                options.iter().map(|option| option.id.as_str()).filter(|id| id != right).collect();
            Some(("choice", json!(wrong[first % wrong.len()])))
        }
        _ => None,
    }
}

/// Numbers as a student types them.
fn typed(question: &QuantityQuestion, values: &[f64]) -> Value {
    // Six digits, without a power of ten where none is needed.
    let number = |x: &f64| json!(format!("{x:.5e}").parse::<f64>().expect("a number").to_string());
    match question.shape {
        ValueShape::Number => number(&values[0]),
        ValueShape::Vector => values.iter().map(number).collect(),
        ValueShape::Matrix => {
            values.chunks(question.size[1]).map(|row| row.iter().map(number).collect::<Value>()).collect()
        }
    }
}
