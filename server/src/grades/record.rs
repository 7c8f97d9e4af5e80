//! One person's work: where they stand in each lesson, what was decided, said and regraded, and why.

use schemars::JsonSchema;
use serde::Serialize;
use triad_lessons::{Course, Lesson};

use crate::policy::{Extension, LateStep, Moment, Policy, Score, Standing, Turn};
use crate::problem::Problem;
use crate::store::{Assignment, Decision, DecisionKind, Member, RegradeRow, Regraded, Store};

use super::book::{Book, Entry, possible};

/// One person's work.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Record {
    /// The person's id.
    pub id: String,
    /// The name.
    pub name: String,
    /// The lessons in which something was handed in, decided or set, in the order of the course.
    pub lessons: Vec<LessonRecord>,
}

/// One person's work in one lesson.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct LessonRecord {
    /// Slug of the lesson.
    pub slug: String,
    /// Its place in the course.
    pub number: u32,
    /// Its title.
    pub title: String,
    /// Points that can be earned.
    pub possible: f64,
    /// From when it can be handed in.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub opens: Option<Moment>,
    /// What it counts after the due date, for this person.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub late: Vec<LateStep>,
    /// Where the person stands.
    pub standing: ToldStanding,
    /// What is allowed beyond the others.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub extension: Option<Extension>,
    /// What was decided and said, the first at the beginning.
    pub remarks: Vec<Remark>,
    /// Whether the student's request for a look again waits for an answer.
    pub asked: bool,
    /// Regrades that changed something here, the latest first.
    pub regrades: Vec<RegradeNote>,
}

/// Where a person stands, without what is held back from them.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ToldStanding {
    /// Whether and until when it can be handed in.
    #[serde(flatten)]
    pub turn: Turn,
    /// The points; left out while they are held back.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<Score>,
}

/// Something that was decided or said.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Remark {
    /// `points`, `mark` of an explanation, `comment`, or `request` by the student.
    pub kind: &'static str,
    /// The explanation that a mark is about.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub question: Option<String>,
    /// The points that count from then on, if it is about points and does not take a decision back.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<f64>,
    /// Why, or what was said.
    pub text: String,
    /// By whom.
    pub by: String,
    /// When.
    pub at: Moment,
}

/// What a regrade changed.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct RegradeNote {
    /// The regrade.
    pub id: String,
    /// When.
    pub at: Moment,
    /// By whom.
    pub by: String,
    /// Why.
    pub reason: String,
    /// When it was taken back.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub undone: Option<Moment>,
    /// Points before and after; left out while they are held back.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<[f64; 2]>,
}

/// A standing as it is told; `all`: to those who teach.
pub fn told(standing: Standing, all: bool) -> ToldStanding {
    let Standing { turn, score, .. } = standing;
    let points = (all || turn.revealed.points).then_some(score);
    ToldStanding { turn, points }
}

/// A person's work in all lessons; `all`: with what is held back from students.
///
/// Errors if the gradebook cannot be read.
pub async fn record(
    store: &Store,
    id: &str,
    course: &Course,
    person: &Member,
    all: bool,
    now: Moment,
) -> Result<Record, Problem> {
    let book = Book::open(store, id, Some(&person.id), None).await?;
    let regrades = store.regrades(id).await?;
    let regraded = store.regraded(id, Some(&person.id)).await?;
    let is_touched = |lesson: &&Lesson| {
        let assignment = book.assignment(&lesson.slug);
        let is_set = assignment.is_some_and(|assignment| assignment.policy != Policy::default());
        is_set || book.of(&person.id, &lesson.slug).is_some()
    };
    let of = |lesson| of_lesson(&book, person, lesson, (&regrades, &regraded), all, now);
    let lessons = course.lessons().iter().filter(is_touched).map(of).collect();
    Ok(Record { id: person.id.clone(), name: person.name.clone(), lessons })
}

fn of_lesson(
    book: &Book,
    person: &Member,
    lesson: &Lesson,
    (regrades, regraded): (&[RegradeRow], &[Regraded]),
    all: bool,
    now: Moment,
) -> LessonRecord {
    let (none, open) = (Entry::default(), Assignment::of(&lesson.slug));
    let entry = book.of(&person.id, &lesson.slug).unwrap_or(&none);
    let assignment = book.assignment(&lesson.slug).unwrap_or(&open);
    let times = assignment.policy.times(entry.extension.as_ref());
    let standing = told(book.standing(&person.id, lesson, now), all);
    let sees_points = standing.points.is_some();
    let note = |row: &RegradeRow| {
        let changed = regraded.iter().find(|one| one.regrade == row.id)?;
        let points = sees_points.then_some([changed.before, changed.after]);
        let RegradeRow { id, at, by, reason, undone, .. } = row.clone();
        (row.lesson == lesson.slug).then_some(RegradeNote { id, at, by, reason, undone, points })
    };
    LessonRecord {
        slug: lesson.slug.clone(),
        number: lesson.number,
        title: lesson.about.title.clone(),
        possible: possible(lesson),
        opens: times.opens,
        late: times.late,
        extension: entry.extension.clone(),
        remarks: remarks(entry, sees_points),
        asked: super::asks(entry),
        regrades: regrades.iter().filter_map(note).collect(),
        standing,
    }
}

fn remarks(entry: &Entry, sees_points: bool) -> Vec<Remark> {
    let decided = entry.decided.iter().filter(|_| sees_points).map(|one| Remark {
        kind: DecisionKind::Points.name(),
        question: None,
        points: one.points,
        text: one.reason.clone(),
        by: one.by.clone(),
        at: one.at,
    });
    let marked = entry.marked.iter().filter(|_| sees_points).map(|one| Remark {
        kind: DecisionKind::Mark.name(),
        question: Some(one.question.clone()),
        points: one.points,
        text: one.remark.clone(),
        by: one.by.clone(),
        at: one.at,
    });
    let said = entry.said.iter().map(|one: &Decision| Remark {
        kind: one.kind.name(),
        question: None,
        points: None,
        text: one.reason.clone(),
        by: one.by.clone(),
        at: one.at,
    });
    let mut all: Vec<Remark> = decided.chain(marked).chain(said).collect();
    all.sort_by_key(|one| one.at);
    all
}
