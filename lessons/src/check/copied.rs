//! Whether answers of others pass: those that a public course gives for another name, handed in by a student of a class.
//!
//! What is the same for everybody is right in every copy: choices, formulas, counts that are not drawn. Numbers of others are
//! right where they lie within the tolerance of one's own, and where a wrong one is carried on they earn the share of a right step.

use std::collections::BTreeSet;

use super::findings::Findings;
use crate::answers::tolerance::norm;
use crate::exercise::{Exercise, Parameters, QuantityQuestion, Question, QuestionBody, numbers};
use crate::files::{EquationPart, earlier_value};
use crate::lesson::Lesson;

/// Share of the points that what is the same for everybody may have: whoever copies stays far from the seven tenths that pass.
const MOST_COMMON: f64 = 0.5;
/// Share of the points that a copy may earn on the average, with what is carried on and what fits by chance.
pub(crate) const MOST_EARNED: f64 = 0.5;
/// Copies that are tried one after the other, keeping what was right: so many answers open a question of the built-in course.
const TRIES: usize = 6;
/// How often each student tries that, with other copies, to count rare luck.
const AGAIN: usize = 5;
/// Share of the students who may pass with a copy, by chance. A number with a tolerance of half a percent in a range of one to eight
/// fits in 0.6 % of the copies, however finely it is drawn.
pub(crate) const LUCKY_AT_ONCE: f64 = 0.01;
/// The same of those who try so many copies.
pub(crate) const LUCKY_IN_ALL: f64 = 0.05;
/// Questions from which a lesson must not be passed with one number that somebody has by luck: a single number is the lesson.
const SEVERAL: usize = 2;

/// The questions of one student, with the numbers that they were made from.
pub(crate) struct Hand {
    exercise: Exercise,
    parameters: Parameters,
}

/// What copies earn in a lesson, as shares of its points.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Copied {
    /// By one copy, on the average.
    pub(crate) earned: f64,
    /// Share of the students who pass with one.
    pub(crate) at_once: f64,
    /// Share of the students who pass with what was right in several.
    pub(crate) in_all: f64,
}

impl Hand {
    /// The hand of whom this lesson belongs to.
    pub(crate) fn of(lesson: Lesson) -> Self {
        Self { exercise: lesson.exercise, parameters: lesson.parameters }
    }

    fn question(&self, id: &str) -> Option<&Question> {
        self.exercise.questions.iter().find(|q| q.id == id)
    }

    /// The share of each question that the right answers of another hand earn in this one.
    fn shares(&self, other: &Self) -> Vec<f64> {
        let share = |own: &Question| {
            let copy = other.question(&own.id).filter(|_| !own.is_judged_by_people())?;
            if is_same(own, copy) { Some(1.0) } else { self.carried_on(own, copy, other) }
        };
        self.exercise.questions.iter().map(|own| share(own).unwrap_or_default()).collect()
    }

    /// What a wrong number earns as a right step from wrong numbers before it.
    fn carried_on(&self, own: &Question, copy: &Question, other: &Self) -> Option<f64> {
        let (QuestionBody::Quantity(q), QuestionBody::Quantity(given)) = (&own.body, &copy.body) else {
            return None;
        };
        let follows = q.follows.as_ref()?;
        let mut parameters = self.parameters.clone();
        for (symbol, name) in &follows.from {
            let (id, component) = earlier_value(name);
            let (own, theirs) = (quantity(self.question(id)?)?, quantity(other.question(id)?)?);
            let is_right = own.tolerance.accepts(&theirs.reference, &own.reference);
            let values = if is_right { &own.reference } else { &theirs.reference };
            parameters.add(symbol, *values.get(component.unwrap_or(0))?);
        }
        let carried = numbers(&follows.value, q.shape, &parameters).ok()?.values;
        let is = |wanted: &[f64]| q.tolerance.accepts(&given.reference, wanted);
        let earns = norm(&carried) > 0.0 && is(&carried) && !q.misconceptions.iter().any(|m| is(&m.value));
        earns.then_some(follows.share)
    }

    /// The share of all points that these shares of the questions are.
    fn earned(&self, shares: &[f64]) -> f64 {
        let points = self.exercise.questions.iter().zip(shares).map(|(q, share)| q.points * share);
        points.sum::<f64>() / self.exercise.possible()
    }
}

fn quantity(question: &Question) -> Option<&QuantityQuestion> {
    match &question.body {
        QuestionBody::Quantity(q) => Some(q),
        _ => None,
    }
}

/// Whether the right answer to another student's question is right here.
fn is_same(own: &Question, other: &Question) -> bool {
    match (&own.body, &other.body) {
        (QuestionBody::Quantity(own), QuestionBody::Quantity(other)) => {
            own.tolerance.accepts(&other.reference, &own.reference)
        }
        (QuestionBody::Model(own), QuestionBody::Model(other)) => own.reference == other.reference,
        (QuestionBody::Trajectory(own), QuestionBody::Trajectory(other)) => own.scene == other.scene,
        // The states are one's own; the mass matrix of full bodies is the same in all of them.
        (QuestionBody::Implement(own), QuestionBody::Implement(other)) => {
            own.scene == other.scene && own.asks.iter().all(|part| *part == EquationPart::Mass)
        }
        _ => true,
    }
}

/// What copies earn: each student takes those of the next ones.
pub(crate) fn measured(hands: &[Hand]) -> Copied {
    let (mut sum, mut copies, mut at_once, mut in_all) = (0.0, 0usize, 0usize, 0usize);
    let students = hands.iter().enumerate().flat_map(|student| (0..AGAIN).map(move |time| (student, time)));
    for ((k, own), time) in students {
        let mut best: Vec<f64> = vec![0.0; own.exercise.questions.len()];
        let others = (1..=TRIES).map(|step| (k + time * TRIES + step) % hands.len());
        for other in others.filter_map(|at| hands.get(at)) {
            let shares = own.shares(other);
            let earned = own.earned(&shares);
            (sum, copies) = (sum + earned, copies + 1);
            at_once += usize::from(earned >= own.exercise.pass_mark);
            best.iter_mut().zip(&shares).for_each(|(best, share)| *best = best.max(*share));
        }
        in_all += usize::from(own.earned(&best) >= own.exercise.pass_mark);
    }
    let share = |n: usize, of: usize| n as f64 / of.max(1) as f64;
    Copied {
        earned: sum / copies.max(1) as f64,
        at_once: share(at_once, copies),
        in_all: share(in_all, AGAIN * hands.len()),
    }
}

/// What everybody answers alike can be handed on, and stands in a public course: it must not come near to passing, not with what
/// fits by chance either.
pub(super) fn pass_nothing(hands: &[Hand], found: &mut Findings) {
    let remedy = "let more numbers be drawn, or finer, draw questions from a pool, or give what is common fewer points";
    for what in complaints(&found.lesson.exercise, hands) {
        found.add("exercise.toml", 0, what, remedy);
    }
}

/// The points of what is the same for everybody, and of the drawn number that is worth most.
fn common_and_lucky(exercise: &Exercise, hands: &[Hand]) -> (f64, f64) {
    let own = |hand: &Hand| {
        let differs =
            |q: &&Question| exercise.questions.iter().any(|common| common.id == q.id && !is_same(q, common));
        hand.exercise.questions.iter().filter(differs).map(|q| q.id.clone()).collect::<Vec<_>>()
    };
    let personal: BTreeSet<String> = hands.iter().flat_map(own).collect();
    let common = exercise.at_most(|q| !q.is_judged_by_people() && !personal.contains(&q.id));
    let drawn = exercise.questions.iter().filter(|q| quantity(q).is_some() && personal.contains(&q.id));
    (common, drawn.map(|q| q.points).fold(0.0, f64::max))
}

/// What of a lesson could be passed with what others know.
fn complaints(exercise: &Exercise, hands: &[Hand]) -> Vec<String> {
    let (common, lucky) = common_and_lucky(exercise, hands);
    let all = exercise.possible();
    let alike = format!("answers that are the same for everybody have {common} of {all} points");
    let mut found = Vec::new();
    if common > MOST_COMMON * all {
        found.push(alike.clone());
    }
    if exercise.questions.len() >= SEVERAL && common + lucky >= exercise.pass_mark * all {
        found.push(format!("{alike}, one number more {lucky}: together they pass"));
    }
    let copied = measured(hands);
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    if copied.earned > MOST_EARNED {
        found.push(format!("another student's answers earn {} of the points", percent(copied.earned)));
    }
    if copied.at_once > LUCKY_AT_ONCE {
        found.push(format!("another student's answers pass for {} of the students", percent(copied.at_once)));
    }
    if copied.in_all > LUCKY_IN_ALL {
        let share = percent(copied.in_all);
        found.push(format!(
            "what is right in the answers of {TRIES} others passes for {share} of the students"
        ));
    }
    found
}
