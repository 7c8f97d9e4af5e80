//! What is kept about everybody's work, together: from it every standing follows.

use std::collections::HashMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use triad_lessons::Lesson;
use triad_lessons::exercise::Question;

use crate::policy::{Case, Decided, Extension, Handed, Moment, Policy, Standing, When, standing};
use crate::problem::Problem;
use crate::store::{Assignment, Decision, DecisionKind, Regraded, Store};

/// What somebody who teaches gave an explanation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Marked {
    /// The question.
    pub question: String,
    /// The points; none where an earlier mark was taken back.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub points: Option<f64>,
    /// What was remarked; may be empty.
    pub remark: String,
    /// By whom.
    pub by: String,
    /// When.
    pub at: Moment,
}

/// What is kept about a person's work in a lesson.
#[derive(Debug, Clone, Default)]
pub struct Entry {
    /// What was handed in.
    pub handed: Vec<Handed>,
    /// What was decided about the points, the first at the beginning.
    pub decided: Vec<Decided>,
    /// What explanations were given, the first at the beginning.
    pub marked: Vec<Marked>,
    /// What was said besides.
    pub said: Vec<Decision>,
    /// What was predicted, by id, and when; what was skipped is left out.
    pub predicted: Vec<(String, Moment)>,
    /// What is allowed to this person.
    pub extension: Option<Extension>,
    /// When the last regrade that holds changed what this person has reached.
    pub regraded: Option<Moment>,
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
    enough(lesson.exercise.pass_mark, lesson.exercise.possible())
}

/// Points that are enough to pass, of those that can be earned.
fn enough(pass_mark: f64, possible: f64) -> f64 {
    // The last digits of a sum of points are rounding.
    pass_mark * possible * (1.0 - 1e-12)
}

impl Entry {
    /// Takes what was decided or said, in the order in which it was.
    fn take(&mut self, one: Decision) {
        let Decision { kind, question, points, reason, by, at, .. } = one;
        match (kind, question) {
            (DecisionKind::Points, _) => self.decided.push(Decided { points, reason, by, at }),
            (DecisionKind::Mark, Some(question)) => {
                self.marked.push(Marked { question, points, remark: reason, by, at });
            }
            (_, question) => self.said.push(Decision { kind, question, points, reason, by, at, ..one }),
        }
    }

    /// The mark of an explanation that holds.
    pub fn mark(&self, question: &str) -> Option<&Marked> {
        self.marked.iter().rfind(|one| one.question == question).filter(|one| one.points.is_some())
    }

    /// The entry with the predictions and the marks that there were at a moment.
    #[must_use]
    pub fn by(mut self, then: Moment) -> Self {
        self.predicted.retain(|(_, at)| *at <= then);
        self.marked.retain(|one| one.at <= then);
        self
    }

    /// Points for having predicted what a run would show. They count besides what the exercise earns, and pass nothing.
    pub fn predicted(&self, lesson: &Lesson) -> f64 {
        let points = self.predicted.iter().filter_map(|(id, _)| lesson.prediction(id)).map(|one| one.points);
        // The sum of nothing has the sign of a minus.
        points.sum::<f64>() + 0.0
    }

    /// Points that people gave for explanations. They count besides what the exercise earns, and pass nothing.
    pub fn explained(&self, lesson: &Lesson) -> f64 {
        let asked = lesson.exercise.questions.iter().filter(|question| question.is_judged_by_people());
        let given = |question: &Question| {
            let points = self.mark(&question.id).and_then(|mark| mark.points).unwrap_or(0.0);
            // A course that was changed since gives no more than it has.
            points.min(question.points)
        };
        asked.map(given).sum::<f64>() + 0.0
    }

    /// Whether there is a grade to tell: without one a cell stays empty, which is not 0.
    pub fn is_graded(&self, lesson: &Lesson, stands: &Standing) -> bool {
        let is_marked = lesson.exercise.questions.iter().any(|question| self.mark(&question.id).is_some());
        stands.last.is_some() || stands.score.decided.is_some() || is_marked || self.predicted(lesson) > 0.0
    }
}

impl Book {
    /// Opens the book of a course; `person` and `lesson` name the part of it that is read, for what is handed in grows.
    ///
    /// Errors if the gradebook cannot be read.
    pub async fn open(
        store: &Store,
        course: &str,
        person: Option<&str>,
        lesson: Option<&str>,
    ) -> Result<Self, Problem> {
        let mut book = Self::default();
        for assignment in store.assignments(course).await? {
            book.assignments.insert(assignment.lesson.clone(), assignment);
        }
        for row in store.handed(course, person, lesson).await? {
            // What was enough when it was graded is enough, however the lesson was edited since.
            let pass = store.pass_mark(&row.lesson_sha256).await?.map(|mark| enough(mark, row.possible));
            book.entry(row.person, row.lesson).handed.push(Handed { pass, ..row.handed });
        }
        for one in store.predictions(course, person, lesson).await? {
            if one.choice.is_some() {
                book.entry(one.person, one.lesson).predicted.push((one.prediction, Moment(one.given_at)));
            }
        }
        for one in store.decisions(course, person, lesson).await? {
            book.entry(one.person.clone(), one.lesson.clone()).take(one);
        }
        let mut regrades: HashMap<String, (String, Moment)> = HashMap::new();
        for one in store.regrades(course).await? {
            if one.undone.is_none() && lesson.is_none_or(|lesson| one.lesson == lesson) {
                regrades.insert(one.id, (one.lesson, one.at));
            }
        }
        let changed = |one: &Regraded| (one.after - one.before).abs() > 0.0;
        for one in store.regraded(course, person).await?.into_iter().filter(changed) {
            if let Some((lesson, at)) = regrades.get(&one.regrade) {
                let entry = book.entry(one.person, lesson.clone());
                entry.regraded = entry.regraded.max(Some(*at));
            }
        }
        for (who, lesson, extension) in store.extensions(course, person, lesson).await? {
            book.entry(who, lesson).extension = Some(extension);
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

    /// Where a person stands in a lesson at a moment.
    pub fn standing(&self, person: &str, lesson: &Lesson, now: Moment) -> Standing {
        let (none, open) = (Entry::default(), Assignment::of(&lesson.slug));
        let entry = self.of(person, &lesson.slug).unwrap_or(&none);
        let assignment = self.assignment(&lesson.slug).unwrap_or(&open);
        stands(assignment, entry, lesson, now)
    }
}

/// Where somebody stands in a lesson at a moment, with what counts besides the exercise.
pub fn stands(assignment: &Assignment, entry: &Entry, lesson: &Lesson, now: Moment) -> Standing {
    let mut stands = standing(&case(assignment, entry, lesson), now);
    if stands.score.decided.is_none() {
        stands.score.points += entry.predicted(lesson) + entry.explained(lesson);
    }
    stands
}

/// What a standing follows from.
fn case<'a>(assignment: &'a Assignment, entry: &'a Entry, lesson: &Lesson) -> Case<'a> {
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
/// question is settled by having been opened; and it knows whether verdicts are held back.
pub fn assigned(lesson: &Lesson, policy: &Policy) -> Lesson {
    let mut own = lesson.clone();
    if policy.reveal.reference != When::AtOnce {
        own.opens = triad_lessons::files::OpensFile::default();
    }
    own.held = policy.reveal.points != When::AtOnce;
    own
}
