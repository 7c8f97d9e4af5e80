//! What is kept about everybody's work, together: from it every standing follows.

use std::collections::HashMap;

use triad_lessons::Lesson;

use crate::policy::{Case, Decided, Extension, Handed, Moment, Policy, Standing, When, standing};
use crate::problem::Problem;
use crate::store::{Assignment, Decision, DecisionKind, Store};

/// What is kept about a person's work in a lesson.
#[derive(Debug, Clone, Default)]
pub struct Entry {
    /// What was handed in.
    pub handed: Vec<Handed>,
    /// What was decided about the points, the first at the beginning.
    pub decided: Vec<Decided>,
    /// What was said besides.
    pub said: Vec<Decision>,
    /// What was predicted, by id; what was skipped is left out.
    pub predicted: Vec<String>,
    /// What is allowed to this person.
    pub extension: Option<Extension>,
}

/// What is kept about everybody's work.
#[derive(Debug, Clone, Default)]
pub struct Book {
    assignments: HashMap<String, Assignment>,
    entries: HashMap<String, HashMap<String, Entry>>,
}

/// Points that can be earned in a lesson.
pub fn possible(lesson: &Lesson) -> f64 {
    lesson.points()
}

/// Points that are enough to pass a lesson.
pub fn pass_points(lesson: &Lesson) -> f64 {
    // The last digits of a sum of points are rounding.
    lesson.exercise.pass_mark * lesson.exercise.possible() * (1.0 - 1e-12)
}

impl Book {
    /// Opens the book of a course, or of one person in it.
    ///
    /// Errors if the gradebook cannot be read.
    pub async fn open(store: &Store, course: &str, person: Option<&str>) -> Result<Self, Problem> {
        let mut book = Self::default();
        for assignment in store.assignments(course).await? {
            book.assignments.insert(assignment.lesson.clone(), assignment);
        }
        for row in store.handed(course, person, None).await? {
            book.entry(row.person, row.lesson).handed.push(row.handed);
        }
        for one in store.predictions(course, person, None).await? {
            if one.choice.is_some() {
                book.entry(one.person, one.lesson).predicted.push(one.prediction);
            }
        }
        let is_wanted = |other: &str| person.is_none_or(|person| person == other);
        for one in store.decisions(course).await?.into_iter().filter(|one| is_wanted(&one.person)) {
            let entry = book.entry(one.person.clone(), one.lesson.clone());
            if one.kind == DecisionKind::Points {
                let Decision { points, reason, by, at, .. } = one;
                entry.decided.push(Decided { points, reason, by, at });
            } else {
                entry.said.push(one);
            }
        }
        for (who, lesson, extension) in store.extensions(course).await? {
            if is_wanted(&who) {
                book.entry(who, lesson).extension = Some(extension);
            }
        }
        Ok(book)
    }

    fn entry(&mut self, person: String, lesson: String) -> &mut Entry {
        self.entries.entry(person).or_default().entry(lesson).or_default()
    }

    /// How a lesson is assigned, if anything was ever set or handed in.
    pub fn assignment(&self, lesson: &str) -> Option<&Assignment> {
        self.assignments.get(lesson)
    }

    /// What is kept about a person's work in a lesson.
    pub fn of(&self, person: &str, lesson: &str) -> Option<&Entry> {
        self.entries.get(person)?.get(lesson)
    }

    /// Everybody's work in a lesson, in no order.
    pub fn in_lesson<'a>(&'a self, lesson: &'a str) -> impl Iterator<Item = (&'a str, &'a Entry)> {
        self.entries.iter().filter_map(move |(person, of)| Some((person.as_str(), of.get(lesson)?)))
    }

    /// Points for having predicted what a run would show. They count besides what the exercise earns, and pass nothing.
    pub fn predicted(&self, person: &str, lesson: &Lesson) -> f64 {
        let made = self.of(person, &lesson.slug).map_or(&[][..], |entry| &entry.predicted);
        made.iter().filter_map(|id| lesson.prediction(id)).map(|one| one.points).sum()
    }

    /// Where a person stands in a lesson at a moment.
    pub fn standing(&self, person: &str, lesson: &Lesson, now: Moment) -> Standing {
        let (none, open) = (Entry::default(), Assignment::of(&lesson.slug));
        let entry = self.of(person, &lesson.slug).unwrap_or(&none);
        let assignment = self.assignment(&lesson.slug).unwrap_or(&open);
        let mut stands = standing(&case(assignment, entry, lesson), now);
        if stands.score.decided.is_none() {
            stands.score.points += self.predicted(person, lesson);
        }
        stands
    }
}

/// What a standing follows from.
pub fn case<'a>(assignment: &'a Assignment, entry: &'a Entry, lesson: &Lesson) -> Case<'a> {
    Case {
        policy: &assignment.policy,
        released: assignment.released,
        extension: entry.extension.as_ref(),
        handed: &entry.handed,
        decided: &entry.decided,
        pass: pass_points(lesson),
    }
}

/// A lesson as its policy has it graded: where right answers are not told as the course opens them, none opens, and so no
/// question is settled by having been opened.
pub fn assigned(lesson: &Lesson, policy: &Policy) -> Lesson {
    let mut own = lesson.clone();
    if policy.reveal.reference != When::AtOnce {
        own.opens = triad_lessons::files::OpensFile::default();
    }
    own
}
