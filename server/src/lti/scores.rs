//! Scores for the platform: what it should have follows from the gradebook, what it has is written down, and only what differs
//! is sent. Nothing is sent of results that are held back.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

use axum::http::{HeaderMap, StatusCode, header};
use serde::Deserialize;
use serde_json::json;
use triad_lessons::exercise::Question;
use triad_lessons::{Course, Lesson};
use url::Url;

use super::services::{Asked, LINE_ITEM, SCORE, Unserved};
use super::{Lti, choice, http::Answer};
use crate::analysis::{Class, waiting};
use crate::grades::{Book, possible};
use crate::policy::{Moment, Phase};
use crate::problem::Problem;
use crate::store::{CLASS, Column, Due, Platform, Store, Told, Wanted};

/// Media types of Assignment and Grade Services.
const SCORE_MEDIA: &str = "application/vnd.ims.lis.v1.score+json";
const COLUMN_MEDIA: &str = "application/vnd.ims.lis.v2.lineitem+json";
const COLUMNS_MEDIA: &str = "application/vnd.ims.lis.v2.lineitemcontainer+json";
/// The first wait after a refusal, in milliseconds; each further one is twice as long.
const WAIT: i64 = 30_000;
/// The longest wait of a platform, in milliseconds: an hour.
const PLATFORM_WAIT: i64 = 3_600_000;
/// The longest wait of one score, in milliseconds: six hours.
const SCORE_WAIT: i64 = 6 * 3_600_000;
/// How long a platform is left alone that refuses one score, in milliseconds: some say so that they are asked too often.
const BREATH: i64 = 10_000;
/// Most scores sent before it is looked again what is wanted.
const ROUND: usize = 500;

/// What tells the time: a round takes longer than what it takes is held.
pub type Clock<'a> = &'a (dyn Fn() -> Moment + Sync);

/// What a platform is told of somebody's work in a lesson.
#[derive(Debug, Clone, PartialEq)]
struct Score {
    points: f64,
    possible: f64,
    /// When what counts was handed in.
    submitted: Option<Moment>,
    /// Whether the student can do more about it.
    is_final: bool,
    /// Whether an explanation waits for its points: these are not all yet.
    waits: bool,
}

impl Score {
    /// What is told, as one number: the share of the points, and below zero while more of them are to be given.
    fn state(&self) -> f64 {
        let share = self.points / self.possible;
        if self.waits { -1.0 - share } else { share }
    }
}

/// Whose explanations wait for points, by lesson; each lesson is read once in a round.
#[derive(Default)]
struct Unread(HashMap<String, HashSet<String>>);

impl Unread {
    async fn of(&mut self, store: &Store, lesson: &Lesson) -> Result<&HashSet<String>, Problem> {
        let place = match self.0.entry(lesson.slug.clone()) {
            Entry::Occupied(place) => return Ok(place.into_mut()),
            Entry::Vacant(place) => place,
        };
        let mut found = HashSet::new();
        if lesson.exercise.questions.iter().any(Question::is_judged_by_people) {
            let class = Class::open(store, CLASS, &lesson.slug).await?;
            found = waiting(lesson, &class, &Book::open(store, CLASS, None, Some(&lesson.slug)).await?);
        }
        Ok(place.insert(found))
    }
}

/// What a platform may be told now; nothing where there is nothing yet, or it is held back.
fn score(book: &Book, unread: &HashSet<String>, person: &str, lesson: &Lesson, now: Moment) -> Option<Score> {
    let possible = possible(lesson);
    let entry = book.of(person, &lesson.slug)?;
    let stands = book.standing(person, lesson, now);
    if possible <= 0.0 || !entry.is_graded(lesson, &stands) || !stands.turn.revealed.points {
        return None;
    }
    let is_over = matches!(stands.turn.phase, Phase::Closed | Phase::Practice);
    Some(Score {
        points: stands.score.points,
        possible,
        submitted: stands.last,
        is_final: is_over || stands.turn.attempts_left == Some(0),
        // Whoever decided about all points has decided about these.
        waits: unread.contains(person) && stands.score.decided.is_none(),
    })
}

/// Writes down what the platforms should have.
///
/// Errors if the gradebook fails.
pub async fn plan(store: &Store, course: &Course, now: Moment) -> Result<(), Problem> {
    let (mut book, mut unread) = (None, Unread::default());
    for platform in store.platforms(CLASS).await? {
        let mut wanted = Vec::new();
        for column in store.columns(&platform.id).await? {
            let Some(lesson) = course.lesson(&column.lesson).filter(|_| !column.url.is_empty()) else {
                continue;
            };
            let people = store.people_of_context(CLASS, &platform.id, &column.context).await?;
            if book.is_none() {
                book = Some(Book::open(store, CLASS, None, None).await?);
            }
            let Some(book) = &book else { continue };
            let unread = unread.of(store, lesson).await?;
            wanted.extend(people.into_iter().filter_map(|(_, person)| {
                let state = score(book, unread, &person, lesson, now)?.state();
                Some(Wanted { column: column.clone(), person, state })
            }));
        }
        if !wanted.is_empty() {
            store.want(&platform.id, &wanted).await?;
        }
    }
    Ok(())
}

/// Sends what is due to the platforms that can be asked; how many scores they took.
///
/// Errors if the gradebook fails. What a platform refuses waits, and is no error.
pub async fn deliver(lti: &Lti, store: &Store, course: &Course, clock: Clock<'_>) -> Result<usize, Problem> {
    let mut taken = 0;
    for platform in store.platforms(CLASS).await? {
        if store.pause_of(&platform.id).await?.until > clock().0 {
            continue;
        }
        let post = Post { lti, store, course, platform: &platform, clock };
        if post.columns().await? {
            taken += post.scores().await?;
        }
    }
    Ok(taken)
}

/// One round to one platform.
struct Post<'a> {
    lti: &'a Lti,
    store: &'a Store,
    course: &'a Course,
    platform: &'a Platform,
    clock: Clock<'a>,
}

#[derive(Deserialize)]
struct LineItem {
    id: Option<String>,
    #[serde(rename = "resourceId")]
    resource: Option<String>,
}

impl Post<'_> {
    /// Finds or makes the columns that are still to be; false if the platform is not to be asked any more.
    async fn columns(&self) -> Result<bool, Problem> {
        for column in self.store.columns(&self.platform.id).await? {
            let Some(lesson) = self.course.lesson(&column.lesson).filter(|_| column.url.is_empty()) else {
                continue;
            };
            match self.place(&column, lesson).await? {
                Ok(url) => {
                    self.store.move_column(&self.platform.id, &column, &url).await?;
                    // What it should have was not known before.
                    plan(self.store, self.course, (self.clock)()).await?;
                }
                Err(refused) if refused.is_of_all => {
                    self.pause(&refused).await?;
                    return Ok(false);
                }
                Err(refused) => {
                    // Asked for again when the lesson is opened from there the next time.
                    self.store.forget_column(&self.platform.id, &column).await?;
                    let why = format!("no column for {}: {}", column.lesson, refused.why);
                    self.store.pause(&self.platform.id, Some(((self.clock)().0, &why))).await?;
                }
            }
        }
        Ok(true)
    }

    /// The address of the column of a lesson.
    async fn place(&self, column: &Column, lesson: &Lesson) -> Result<Result<String, Refused>, Problem> {
        let contexts = self.store.contexts(&self.platform.id).await?;
        let all = contexts.into_iter().find(|one| one.id == column.context).map(|one| one.line_items);
        let Some(mut url) = all.and_then(|url| Url::parse(&url).ok()) else {
            return Ok(Err(Refused::one("the platform does not say where its columns are")));
        };
        let made_at = url.to_string();
        url.query_pairs_mut().append_pair("resource_id", &lesson.slug);
        let asked = Asked { scope: LINE_ITEM, url: url.as_str(), media: COLUMNS_MEDIA, body: None };
        let listed = match self.asked(asked).await {
            Ok(answer) => answer,
            Err(refused) => return Ok(Err(refused)),
        };
        let listed: Vec<LineItem> = serde_json::from_slice(&listed.body).unwrap_or_default();
        let known = listed.into_iter().find(|one| one.resource.as_deref() == Some(&lesson.slug));
        if let Some(url) = known.and_then(|one| one.id) {
            return Ok(Ok(url));
        }
        let body = choice::column(lesson).to_string();
        let asked = Asked { scope: LINE_ITEM, url: &made_at, media: COLUMN_MEDIA, body: Some(&body) };
        Ok(match self.asked(asked).await {
            Ok(answer) => serde_json::from_slice::<LineItem>(&answer.body)
                .ok()
                .and_then(|made| made.id)
                .ok_or_else(|| Refused::one("the platform made a column and does not say where")),
            Err(refused) => Err(refused),
        })
    }

    /// Sends what is due; how many were taken.
    async fn scores(&self) -> Result<usize, Problem> {
        let (mut taken, mut unread) = (0, Unread::default());
        for _ in 0..ROUND {
            let Some(due) = self.store.claim_score(&self.platform.id, (self.clock)()).await? else { break };
            let (told, refused) = self.tell(&due, &mut unread).await?;
            taken += usize::from(matches!(told, Told::Sent(_)));
            self.store.told(&self.platform.id, &due, &told).await?;
            match refused {
                Some(refused) if refused.wait.is_some() || refused.is_of_all => {
                    self.pause(&refused).await?;
                    break;
                }
                None if matches!(told, Told::Sent(_)) => self.store.pause(&self.platform.id, None).await?,
                _ => {}
            }
        }
        Ok(taken)
    }

    /// Tells the platform a score as it is now, not as it was when it was found to be due.
    async fn tell(&self, due: &Due, unread: &mut Unread) -> Result<(Told, Option<Refused>), Problem> {
        let subject = self.store.subject_of(&self.platform.id, &due.column.context, &due.person).await?;
        let book = Book::open(self.store, CLASS, Some(&due.person), Some(&due.column.lesson)).await?;
        let score = match self.course.lesson(&due.column.lesson) {
            Some(lesson) => {
                let unread = unread.of(self.store, lesson).await?;
                score(&book, unread, &due.person, lesson, (self.clock)())
            }
            None => None,
        };
        let (Some(subject), Some(score)) = (subject, score) else { return Ok((Told::Held, None)) };
        let mut body = json!({
            "userId": subject, "scoreGiven": score.points, "scoreMaximum": score.possible,
            "activityProgress": if score.is_final { "Completed" } else { "Submitted" },
            "gradingProgress": if score.waits { "PendingManual" } else { "FullyGraded" }, "timestamp": due.stamp,
        });
        if let Some(at) = score.submitted {
            // What comes late by the platform's own rule is judged by when it was handed in.
            body["submission"] = json!({"submittedAt": at});
        }
        let Some(url) = scores_of(&due.column.url) else {
            return Ok(self.refused(due, Refused::one("the platform's column has no address")));
        };
        let body = body.to_string();
        let asked = Asked { scope: SCORE, url: &url, media: SCORE_MEDIA, body: Some(&body) };
        Ok(match self.asked(asked).await {
            Ok(_) => (Told::Sent(score.state()), None),
            Err(refused) => self.refused(due, refused),
        })
    }

    fn refused(&self, due: &Due, refused: Refused) -> (Told, Option<Refused>) {
        let told = if refused.is_untried {
            Told::Untried
        } else {
            Told::Refused((self.clock)().after(doubled(due.tries, SCORE_WAIT)), refused.why.clone())
        };
        (told, Some(refused))
    }

    async fn asked(&self, asked: Asked<'_>) -> Result<Answer, Refused> {
        match self.lti.ask(self.store, self.platform, asked, (self.clock)()).await {
            Ok(answer) if answer.status.is_success() => Ok(answer),
            Ok(answer) => Err(Refused::by(answer.status, &answer.headers)),
            Err(unserved) => Err(Refused::of(&unserved)),
        }
    }

    /// Leaves the platform alone for a while.
    async fn pause(&self, refused: &Refused) -> Result<(), Problem> {
        let failures = self.store.pause_of(&self.platform.id).await?.failures;
        let wait = if refused.is_of_all { doubled(failures, PLATFORM_WAIT) } else { 0 };
        let until = (self.clock)().after(wait.max(refused.wait.unwrap_or(0)).min(PLATFORM_WAIT));
        Ok(self.store.pause(&self.platform.id, Some((until.0, &refused.why))).await?)
    }
}

/// A wait that doubles, in milliseconds.
fn doubled(times: u32, most: i64) -> i64 {
    WAIT.saturating_mul(1 << times.min(20)).min(most)
}

/// Where the scores of a column are written: a path below it, before what follows a question mark.
fn scores_of(column: &str) -> Option<String> {
    let mut url = Url::parse(column).ok()?;
    let path = format!("{}/scores", url.path().trim_end_matches('/'));
    url.set_path(&path);
    Some(url.into())
}

/// That a platform did not take something.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Refused {
    why: String,
    /// Whether it would take nothing else either.
    is_of_all: bool,
    /// Whether it has nothing to do with what was sent.
    is_untried: bool,
    /// How long it wants to be left alone, in milliseconds.
    wait: Option<i64>,
}

impl Refused {
    fn one(why: &str) -> Self {
        Self { why: why.to_owned(), is_of_all: false, is_untried: false, wait: None }
    }

    fn by(status: StatusCode, headers: &HeaderMap) -> Self {
        let after =
            headers.get(header::RETRY_AFTER).and_then(|value| value.to_str().ok()?.parse::<i64>().ok());
        let after = after.map(|seconds| seconds.clamp(1, PLATFORM_WAIT / 1000) * 1000);
        let why = format!("the platform answers {}", status.as_u16());
        match status {
            StatusCode::TOO_MANY_REQUESTS => {
                Self { why, is_of_all: true, is_untried: true, wait: Some(after.unwrap_or(BREATH)) }
            }
            StatusCode::FORBIDDEN => Self { why, is_of_all: false, is_untried: false, wait: Some(BREATH) },
            // Not the score's fault, but another one is tried first the next time.
            _ if status.is_server_error() || status == StatusCode::UNAUTHORIZED => {
                Self { why, is_of_all: true, is_untried: false, wait: after }
            }
            _ => Self { why, is_of_all: false, is_untried: false, wait: None },
        }
    }

    fn of(unserved: &Unserved) -> Self {
        let why = unserved.to_string();
        match unserved {
            Unserved::Foreign(_) => Self { why, is_of_all: false, is_untried: false, wait: None },
            Unserved::NoToken { .. } | Unserved::Ours(_) => {
                Self { why, is_of_all: true, is_untried: true, wait: None }
            }
            Unserved::Silent(_) => Self { why, is_of_all: true, is_untried: false, wait: None },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scores_are_written_below_the_column() {
        let of = |url: &str| scores_of(url).expect("an address");
        assert_eq!(of("https://a.example/items/7"), "https://a.example/items/7/scores");
        assert_eq!(
            of("https://a.example/items/7/lineitem?type_id=3"),
            "https://a.example/items/7/lineitem/scores?type_id=3"
        );
        assert_eq!(of("https://a.example/items/7/"), "https://a.example/items/7/scores");
        assert_eq!(scores_of("items/7"), None);
    }

    #[test]
    fn waits_double_up_to_a_bound() {
        assert_eq!(
            (doubled(0, SCORE_WAIT), doubled(1, SCORE_WAIT), doubled(3, SCORE_WAIT)),
            (30_000, 60_000, 240_000)
        );
        assert_eq!((doubled(u32::MAX, SCORE_WAIT), doubled(30, PLATFORM_WAIT)), (SCORE_WAIT, PLATFORM_WAIT));
    }
}
