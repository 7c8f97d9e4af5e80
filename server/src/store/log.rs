//! The log of a course: who did what, each entry with a hash over itself and the entry before.

use std::collections::{BTreeMap, BTreeSet};

use sqlx::AnyConnection;

use super::error::StoreError;
use super::hash::sha256;
use super::records::{self, PredictionRow, SubmissionRow, VerdictRow};
use super::sql;

/// What the log says where somebody's data were erased.
pub(super) const ERASED: &str = "erased";

/// Something that somebody did.
#[derive(Debug, Clone, Copy)]
pub(super) struct Event<'a> {
    /// Who: a person's id, or `triad` for the program itself.
    pub(super) actor: &'a str,
    /// A verb in the past tense.
    pub(super) what: &'a str,
    /// The id of what it was done to.
    pub(super) subject: &'a str,
    /// What is worth knowing later.
    pub(super) detail: &'a str,
}

/// Holds the course until the end of the transaction: what looks before it writes finds what others wrote at the same time.
pub(super) async fn hold(connection: &mut AnyConnection, course: &str) -> Result<(), StoreError> {
    sqlx::query(sql::HOLD_COURSE).bind(course).execute(connection).await?;
    Ok(())
}

/// Adds an entry; its number. The course is held until the end of the transaction, so that whatever follows in it is done
/// by one at a time.
pub(super) async fn append(
    connection: &mut AnyConnection,
    course: &str,
    at: i64,
    event: &Event<'_>,
) -> Result<i64, StoreError> {
    let next = sqlx::query_as(sql::NEXT_EVENT).bind(course).fetch_optional(&mut *connection).await?;
    let (n, before): (i64, String) = next.ok_or(StoreError::Unknown("course"))?;
    let hash = link(&before, course, n, at, event);
    let add = sqlx::query(sql::ADD_EVENT).bind(course).bind(n).bind(at).bind(event.actor).bind(event.what);
    add.bind(event.subject).bind(event.detail).bind(&hash).execute(&mut *connection).await?;
    sqlx::query(sql::SET_CHAIN).bind(course).bind(&hash).execute(&mut *connection).await?;
    Ok(n)
}

fn link(before: &str, course: &str, n: i64, at: i64, event: &Event<'_>) -> String {
    let Event { actor, what, subject, detail } = event;
    // As JSON no two entries have the same text.
    sha256(&serde_json::json!([before, course, n, at, actor, what, subject, detail]).to_string())
}

/// A row of the log.
type Row = (i64, i64, String, String, String, String, String);

/// Faults of a course's records: entries that do not follow from those before, submissions and verdicts that are not
/// those that were logged. Empty if everything is as it was written.
///
/// Errors if the file cannot be read.
pub(super) async fn faults(connection: &mut AnyConnection, course: &str) -> Result<Vec<String>, StoreError> {
    let mut found = Vec::new();
    let mut before = String::new();
    let (mut sealed, mut predicted, mut erased) = (BTreeSet::new(), BTreeSet::new(), BTreeSet::new());
    let rows: Vec<Row> = sqlx::query_as(sql::EVENTS).bind(course).fetch_all(&mut *connection).await?;
    for ((n, at, actor, what, subject, detail, hash), place) in rows.iter().zip(1..) {
        let event = Event { actor, what, subject, detail };
        if *n != place || link(&before, course, *n, *at, &event) != *hash {
            found.push(format!("entry {n} of the log does not follow from the one before"));
        }
        before.clone_from(hash);
        if matches!(what.as_str(), "submitted" | "regraded") {
            sealed.insert((subject.clone(), detail.clone()));
        }
        if what == "predicted" {
            predicted.insert((actor.clone(), subject.clone(), detail.clone()));
        }
        if what == ERASED {
            erased.insert(subject.clone());
        }
    }
    let end: (i64, String) =
        sqlx::query_as(sql::END_OF_CHAIN).bind(course).fetch_one(&mut *connection).await?;
    if end != (rows.last().map_or(0, |row| row.0), before) {
        found.push(format!("entries are missing at the end of the log: {} are known", end.0));
    }
    let submissions: Vec<SubmissionRow> =
        sqlx::query_as(sql::RECORDED).bind(course).fetch_all(&mut *connection).await?;
    let verdicts: Vec<VerdictRow> =
        sqlx::query_as(sql::VERDICTS).bind(course).fetch_all(&mut *connection).await?;
    let by_id: BTreeMap<&str, &SubmissionRow> =
        submissions.iter().map(|row| (row.id.as_str(), row)).collect();
    // Of whom was erased only what a grade needs is left, and nobody's name.
    for gone in submissions.iter().filter(|row| erased.contains(&row.person)) {
        sealed.retain(|(id, _)| *id != gone.id);
        if !gone.student.is_empty() {
            found.push(format!("submission {}: a name stands there again", gone.id));
        }
    }
    let is_erased = |row: &&SubmissionRow| erased.contains(&row.person);
    found.extend(wrong_predictions(connection, course, predicted, &erased).await?);
    for verdict in &verdicts {
        let id = &verdict.submission;
        if by_id.get(id.as_str()).is_some_and(is_erased) {
            continue;
        }
        let seal = by_id.get(id.as_str()).map(|submission| (id.clone(), records::seal(submission, verdict)));
        if !seal.is_some_and(|seal| sealed.remove(&seal)) {
            found.push(format!(
                "submission {id}: answers or verdict {} are not those that were logged",
                verdict.run
            ));
        }
    }
    found.extend(
        sealed.iter().map(|(id, _)| format!("submission {id}: it is logged, and is missing or changed")),
    );
    Ok(found)
}

/// Predictions that are not those that were logged, by who made them, place and hash; of whom was erased nothing is asked.
async fn wrong_predictions(
    connection: &mut AnyConnection,
    course: &str,
    mut logged: BTreeSet<(String, String, String)>,
    erased: &BTreeSet<String>,
) -> Result<Vec<String>, StoreError> {
    let rows: Vec<PredictionRow> =
        sqlx::query_as(sql::PREDICTION_ROWS).bind(course).fetch_all(connection).await?;
    logged.retain(|(person, ..)| !erased.contains(person));
    let mut found = Vec::new();
    for row in rows.iter().filter(|row| !erased.contains(&row.person)) {
        if !logged.remove(&(row.person.clone(), row.subject(), row.hash())) {
            found.push(format!(
                "the prediction {} of {} is not the one that was logged",
                row.subject(),
                row.person
            ));
        }
    }
    let missing = |(person, at, _): &(String, String, String)| {
        format!("the prediction {at} of {person} is logged, and is missing or changed")
    };
    found.extend(logged.iter().map(missing));
    Ok(found)
}
