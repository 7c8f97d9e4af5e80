//! A course that was exported comes into a gradebook.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use sha2::{Digest, Sha256};
use sqlx::{AnyConnection, AssertSqlSafe};

use super::super::audit;
use super::super::error::StoreError;
use super::super::hash::hexadecimal;
use super::super::kind::Kind;
use super::super::log::{self, Event};
use super::super::{Store, now, schema, sql};
use super::tables::OF_COURSE;

/// What came of an import.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Imported {
    /// The course.
    pub course: String,
    /// Rows that came in: none where all of it was there already.
    pub rows: u64,
}

/// The first line of the file.
#[derive(Debug, Deserialize)]
struct Head {
    triad: String,
    format: i64,
    course: String,
}

/// The last line.
#[derive(Debug, Deserialize)]
struct End {
    rows: u64,
    sha256: String,
}

impl Store {
    /// Brings in a course that [`Self::export`] wrote. All of it comes in, or nothing; what is there already is not taken
    /// twice.
    ///
    /// Errors if the file is not whole, of a later version, or of another course than the one that stands here.
    pub async fn import(&self, path: &Path) -> Result<Imported, StoreError> {
        self.place_is_right()?;
        let head = whole(path)?;
        if head.format > schema::FORMAT {
            return Err(StoreError::Newer { found: head.format, known: schema::FORMAT });
        }
        let mut transaction = self.write().await?;
        let mut rows = 0;
        for line in lines(path)?.skip(1) {
            let line = line?;
            let Ok((table, row)) = serde_json::from_str::<(String, Map<String, Value>)>(&line) else { break };
            if table == "course" && !makes_room(&mut transaction, &head.course, &row).await? {
                transaction.rollback().await?;
                return Ok(Imported { course: head.course, rows: 0 });
            }
            add(&mut transaction, &table, &row).await?;
            rows += 1;
        }
        if let Some(fault) = audit::faults(&mut transaction, &head.course).await?.into_iter().next() {
            return Err(StoreError::Damaged(fault));
        }
        let event = Event { actor: "triad", what: "imported", subject: &head.course, detail: "" };
        log::append(&mut transaction, &head.course, now(), &event).await?;
        transaction.commit().await?;
        self.place_is_right()?;
        Ok(Imported { course: head.course, rows })
    }
}

fn lines(path: &Path) -> Result<impl Iterator<Item = Result<String, StoreError>>, StoreError> {
    let refused =
        move |cause: std::io::Error| StoreError::Open { path: path.to_owned(), cause: cause.to_string() };
    let file = File::open(path).map_err(refused)?;
    let unreadable = |cause: std::io::Error| foreign(&format!("not a course that was exported: {cause}"));
    Ok(BufReader::new(file).lines().map(move |line| line.map_err(unreadable)))
}

/// Reads the file once: its first line, if its last says that all is there.
fn whole(path: &Path) -> Result<Head, StoreError> {
    let (mut hash, mut before, mut count) = (Sha256::new(), None::<String>, 0_u64);
    let mut head = None;
    for line in lines(path)? {
        let line = line?;
        if head.is_none() {
            let read: Result<Head, _> = serde_json::from_str(&line);
            head = read.ok().filter(|head| head.triad == "course");
            if head.is_none() {
                return Err(foreign("not a course that was exported: its first line does not say so"));
            }
        }
        if let Some(before) = before.replace(line) {
            hash.update(before.as_bytes());
            hash.update(b"\n");
            count += 1;
        }
    }
    let end = before.and_then(|line| serde_json::from_str::<End>(&line).ok());
    let is_whole =
        end.is_some_and(|end| end.rows + 1 == count && end.sha256 == hexadecimal(&hash.finalize()));
    match head {
        Some(head) if is_whole => Ok(head),
        _ => Err(foreign("the file is not whole: its end is missing, or it was changed")),
    }
}

fn foreign(what: &str) -> StoreError {
    StoreError::Foreign(what.to_owned())
}

/// Makes room for the course of the file; false if all of it is here already.
///
/// Errors if another course stands there, or the same one went another way.
async fn makes_room(
    connection: &mut AnyConnection,
    course: &str,
    row: &Map<String, Value>,
) -> Result<bool, StoreError> {
    let found = sqlx::query_as(sql::COURSE).bind(course).fetch_optional(&mut *connection).await?;
    let Some((title, _, _, secret)): Option<(String, String, i64, String)> = found else { return Ok(true) };
    let (events, chain): (i64, String) =
        sqlx::query_as(sql::END_OF_CHAIN).bind(course).fetch_one(&mut *connection).await?;
    if events == 0 {
        sqlx::query(sql::REMOVE_COURSE).bind(course).execute(connection).await?;
        return Ok(true);
    }
    let (Some(their_events), Some(their_chain)) = (row["events"].as_i64(), row["chain"].as_str()) else {
        return Err(foreign("the file does not say how long the log of its course is"));
    };
    let here: Option<(String,)> =
        sqlx::query_as(sql::HASH_OF_EVENT).bind(course).bind(their_events).fetch_optional(connection).await?;
    if row["secret"] == secret && here.is_some_and(|(hash,)| hash == their_chain) {
        return Ok(false);
    }
    let same = if row["secret"] == secret { "the same course in another state" } else { "another course" };
    Err(foreign(&format!(
        "here stands {same}, \"{title}\" with {events} entries in its log up to {}: import into a new gradebook",
        chain.get(..8).unwrap_or_default()
    )))
}

/// A value of a column, or that there is none there; `None` if it is of another type.
#[allow(clippy::option_option, reason = "no value and a wrong one are different")]
fn read<'a, T>(value: &'a Value, as_type: impl Fn(&'a Value) -> Option<T>) -> Option<Option<T>> {
    if value.is_null() { Some(None) } else { as_type(value).map(Some) }
}

/// Adds a row, if all its columns are ours.
async fn add(
    connection: &mut AnyConnection,
    table: &str,
    row: &Map<String, Value>,
) -> Result<(), StoreError> {
    if !OF_COURSE.iter().any(|(known, _)| *known == table) {
        return Err(foreign(&format!("there is no table {table} in a course")));
    }
    let columns = sqlx::query_as(Kind::of(connection).columns()).bind(table);
    let columns: BTreeMap<String, String> = columns.fetch_all(&mut *connection).await?.into_iter().collect();
    if let Some(unknown) = row.keys().find(|name| !columns.contains_key(name.as_str())) {
        return Err(foreign(&format!("there is no column {unknown} in {table}")));
    }
    let names: Vec<&str> = row.keys().map(String::as_str).collect();
    let places: Vec<String> = (1..=names.len()).map(|k| format!("${k}")).collect();
    // Lessons are named by what they say: one that is there is the same.
    let again = if table == "lesson_version" { " ON CONFLICT (sha256) DO NOTHING" } else { "" };
    // Made of names of our own tables and columns alone: compared with them above.
    let text = format!("INSERT INTO {table} ({}) VALUES ({}){again}", names.join(", "), places.join(", "));
    let mut insert = sqlx::query(AssertSqlSafe(text));
    for (name, value) in row {
        let wrong = || foreign(&format!("a row of {table} has what its column {name} does not hold"));
        // Each value with the type of its column, also where there is none: PostgreSQL takes no other.
        insert = match columns.get(name).map(String::as_str) {
            Some("BIGINT") => insert.bind(read(value, Value::as_i64).ok_or_else(wrong)?),
            Some("DOUBLE PRECISION") => insert.bind(read(value, Value::as_f64).ok_or_else(wrong)?),
            _ => insert.bind(read(value, |value| value.as_str().map(str::to_owned)).ok_or_else(wrong)?),
        };
    }
    insert.execute(connection).await?;
    Ok(())
}
