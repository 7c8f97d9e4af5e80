//! Whether what stands in a course's tables is what its log says.

use std::collections::{BTreeMap, BTreeSet};

use sqlx::AnyConnection;

use super::error::StoreError;
use super::hash::sha256;
use super::log::{ERASED, Event, link};
use super::records::{self, PredictionRow, SubmissionRow, VerdictRow};
use super::rulings::Rulings;
use super::sql;

/// A row of the log.
type Row = (i64, i64, String, String, String, String, String);

/// What a log says of the tables.
#[derive(Debug, Default)]
struct Logged {
    /// Submissions, by id, with a hash of each and of one of its verdicts.
    sealed: BTreeSet<(String, String)>,
    /// Predictions, by who made them, place and hash.
    predicted: BTreeSet<(String, String, String)>,
    /// Those who were erased.
    erased: BTreeSet<String>,
    /// What people set, allowed and decided.
    rulings: Rulings,
}

impl Logged {
    /// Takes the next entry.
    fn take(&mut self, n: i64, at: i64, event: &Event<'_>) {
        let Event { actor, what, subject, detail } = *event;
        match what {
            "submitted" | "regraded" => drop(self.sealed.insert((subject.to_owned(), detail.to_owned()))),
            "predicted" => {
                self.predicted.insert((actor.to_owned(), subject.to_owned(), detail.to_owned()));
            }
            ERASED => drop(self.erased.insert(subject.to_owned())),
            _ => self.rulings.take(n, at, event),
        }
    }
}

/// Faults of a course's records: entries that do not follow from those before, submissions, verdicts, predictions, policies,
/// extensions and decisions that are not those that were logged. Empty if everything is as it was written.
///
/// Errors if the file cannot be read.
pub(super) async fn faults(connection: &mut AnyConnection, course: &str) -> Result<Vec<String>, StoreError> {
    let mut found = Vec::new();
    let mut before = String::new();
    let mut logged = Logged::default();
    let rows: Vec<Row> = sqlx::query_as(sql::EVENTS).bind(course).fetch_all(&mut *connection).await?;
    for ((n, at, actor, what, subject, detail, hash), place) in rows.iter().zip(1..) {
        let event = Event { actor, what, subject, detail };
        if *n != place || link(&before, course, *n, *at, &event) != *hash {
            found.push(format!("entry {n} of the log does not follow from the one before"));
        }
        before.clone_from(hash);
        logged.take(*n, *at, &event);
    }
    let end: (i64, String) =
        sqlx::query_as(sql::END_OF_CHAIN).bind(course).fetch_one(&mut *connection).await?;
    if end != (rows.last().map_or(0, |row| row.0), before) {
        found.push(format!("entries are missing at the end of the log: {} are known", end.0));
    }
    found.extend(logged.rulings.faults(connection, course).await?);
    found.extend(wrong_lessons(connection).await?);
    let Logged { mut sealed, predicted, erased, .. } = logged;
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

/// Versions of lessons that are not those of their names: what is enough to pass follows from them.
async fn wrong_lessons(connection: &mut AnyConnection) -> Result<Vec<String>, StoreError> {
    let rows: Vec<(String, String, String)> =
        sqlx::query_as(sql::LESSON_BUNDLES).fetch_all(connection).await?;
    let other = rows.iter().filter(|(name, _, bundle)| sha256(bundle) != *name);
    Ok(other.map(|(name, slug, _)| format!("the version {name} of {slug} is not what graded")).collect())
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
