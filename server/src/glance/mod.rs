//! A class at a glance, while it works: who is where, who is stuck, and what was handed in a moment ago.

mod presence;

use std::collections::{BTreeMap, BTreeSet, HashMap};

use schemars::JsonSchema;
use serde::Serialize;
use triad_lessons::{Course, Mark, Verdict};

use crate::policy::Moment;
use crate::store::{Member, Recorded, Role};

pub use presence::{Presence, Seen, lesson_of};

/// Who asked for something within so many milliseconds is here: five minutes.
pub const HERE: i64 = 5 * 60_000;
/// What was handed in within so many milliseconds is looked at: twenty minutes.
pub const OF_LATE: i64 = 20 * 60_000;
/// Different answers that failed of late, from which somebody is stuck.
const STUCK: usize = 3;
/// Most submissions that are told.
const MOST: usize = 50;

/// A class at a glance.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Glance {
    /// When.
    pub at: Moment,
    /// Students of the class.
    pub students: usize,
    /// How many were here within the last five minutes.
    pub here: usize,
    /// The lessons in which somebody is, in the order of the course.
    pub lessons: Vec<BusyLesson>,
    /// Who has tried one question at least three times of late, and not got it: the most tries first.
    pub stuck: Vec<Stuck>,
    /// What was handed in within the last twenty minutes, the newest first: at most fifty.
    pub handed: Vec<JustHanded>,
    /// How many that are in all.
    pub handed_in_all: usize,
}

/// A lesson in which somebody is.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct BusyLesson {
    /// Slug of the lesson.
    pub slug: String,
    /// Its place in the course.
    pub number: u32,
    /// Its title.
    pub title: String,
    /// Who, by name.
    pub people: Vec<Present>,
}

/// Somebody who is here.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Present {
    /// The person's id.
    pub person: String,
    /// The name.
    pub name: String,
    /// When they last did something.
    pub at: Moment,
    /// Whether they are stuck in this lesson.
    pub stuck: bool,
}

/// Somebody who is stuck.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Stuck {
    /// The person's id.
    pub person: String,
    /// The name.
    pub name: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// Title of the lesson.
    pub title: String,
    /// Id of the question.
    pub question: String,
    /// Different wrong answers of late, and answers that were sent back.
    pub tries: usize,
    /// The mistake of the last one, if it was recognised.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mistake: Option<String>,
    /// When the last one came.
    pub at: Moment,
}

/// Something that was just handed in.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct JustHanded {
    /// The submission.
    pub id: String,
    /// The person's id.
    pub person: String,
    /// The name.
    pub name: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// Title of the lesson.
    pub title: String,
    /// When.
    pub at: Moment,
    /// Whether it could be judged.
    pub gradable: bool,
    /// Points that it earned.
    pub earned: f64,
    /// Points that can be earned.
    pub possible: f64,
}

/// What somebody did at one question of late.
#[derive(Debug, Default)]
struct Tries {
    /// The number of different answers after each wrong one.
    wrong: BTreeSet<usize>,
    sent_back: usize,
    mistake: Option<String>,
    at: Option<Moment>,
}

/// The class at a glance; `recent` has what was handed in of late, the oldest first, with the verdicts in force.
#[allow(clippy::implicit_hasher, reason = "there is one such map")]
pub fn glance(
    people: &[Member],
    seen: &HashMap<String, Seen>,
    recent: &[(Recorded, Verdict)],
    course: &Course,
    now: Moment,
) -> Glance {
    let students: HashMap<&str, &str> = people
        .iter()
        .filter(|one| one.role == Role::Student)
        .map(|one| (one.id.as_str(), one.name.as_str()))
        .collect();
    let recent: Vec<&(Recorded, Verdict)> =
        recent.iter().filter(|(one, _)| students.contains_key(one.person.as_str())).collect();
    let stuck = stuck(&students, &recent, course);
    let seen: Vec<(&str, &Seen)> = seen
        .iter()
        .filter(|(person, seen)| students.contains_key(person.as_str()) && seen.at.after(HERE) >= now)
        .map(|(person, seen)| (person.as_str(), seen))
        .collect();
    let handed = recent.iter().rev().take(MOST).map(|(one, verdict)| JustHanded {
        id: one.id.clone(),
        person: one.person.clone(),
        name: students[one.person.as_str()].to_owned(),
        lesson: one.lesson.clone(),
        title: title(course, &one.lesson),
        at: one.at,
        gradable: verdict.gradable,
        earned: verdict.earned,
        possible: verdict.possible,
    });
    Glance {
        at: now,
        students: students.len(),
        here: seen.len(),
        lessons: busy(&students, &seen, &stuck, course),
        handed: handed.collect(),
        handed_in_all: recent.len(),
        stuck,
    }
}

fn title(course: &Course, slug: &str) -> String {
    course.lesson(slug).map_or_else(|| slug.to_owned(), |lesson| lesson.about.title.clone())
}

/// The lessons in which somebody is.
fn busy(
    students: &HashMap<&str, &str>,
    seen: &[(&str, &Seen)],
    stuck: &[Stuck],
    course: &Course,
) -> Vec<BusyLesson> {
    let of = |slug: &str| {
        let is_here = |(person, seen): &(&str, &Seen)| {
            let is_stuck = stuck.iter().any(|one| one.person == *person && one.lesson == slug);
            (seen.lesson.as_deref() == Some(slug)).then(|| Present {
                person: (*person).to_owned(),
                name: students[person].to_owned(),
                at: seen.at,
                stuck: is_stuck,
            })
        };
        let mut people: Vec<Present> = seen.iter().filter_map(is_here).collect();
        people.sort_by(|a, b| a.name.cmp(&b.name));
        people
    };
    let lesson = |lesson: &triad_lessons::Lesson| BusyLesson {
        slug: lesson.slug.clone(),
        number: lesson.number,
        title: lesson.about.title.clone(),
        people: of(&lesson.slug),
    };
    course.lessons().iter().map(lesson).filter(|lesson| !lesson.people.is_empty()).collect()
}

/// Who has failed at a question several times and not got it since.
fn stuck(students: &HashMap<&str, &str>, recent: &[&(Recorded, Verdict)], course: &Course) -> Vec<Stuck> {
    let mut all: BTreeMap<(&str, &str, &str), Tries> = BTreeMap::new();
    for (one, verdict) in recent {
        for question in &verdict.questions {
            let key = (one.person.as_str(), one.lesson.as_str(), question.id.as_str());
            let settled = question.standing.is_some_and(|standing| standing.open);
            match question.verdict {
                Mark::Right => drop(all.remove(&key)),
                Mark::Wrong if settled => drop(all.remove(&key)),
                Mark::Wrong => {
                    let tries = all.entry(key).or_default();
                    let before = tries.wrong.len();
                    tries.wrong.insert(question.standing.map_or(before + 1, |standing| standing.attempts));
                    tries.mistake.clone_from(&question.misconception);
                    tries.at = Some(one.at);
                }
                Mark::Invalid => {
                    let tries = all.entry(key).or_default();
                    tries.sent_back += 1;
                    tries.at = Some(one.at);
                }
                Mark::Blank | Mark::Kept | Mark::Waiting => {}
            }
        }
    }
    let found = all.into_iter().filter_map(|((person, lesson, question), tries)| {
        let count = tries.wrong.len() + tries.sent_back;
        (count >= STUCK).then_some(Stuck {
            person: person.to_owned(),
            name: (*students.get(person)?).to_owned(),
            lesson: lesson.to_owned(),
            title: title(course, lesson),
            question: question.to_owned(),
            tries: count,
            mistake: tries.mistake,
            at: tries.at?,
        })
    });
    let mut found: Vec<Stuck> = found.collect();
    found.sort_by(|a, b| (b.tries, &a.name).cmp(&(a.tries, &b.name)));
    found
}
