//! One person's data: what the log knows of them, and erasing what no grade needs.

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Value, json};
use sqlx::AnyConnection;

use super::super::class::members::known;
use super::super::database;
use super::super::error::StoreError;
use super::super::log::{self, ERASED, Event};
use super::super::{Store, now, sql};

/// An entry of the log that somebody made, or that is about them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct OwnEvent {
    /// When, in milliseconds since 1970.
    pub at: i64,
    /// A verb in the past tense.
    pub what: String,
    /// Whether they did it themselves.
    pub own: bool,
}

impl Store {
    /// What the log of a course knows of a person, the oldest first.
    ///
    /// Errors if the file cannot be read.
    pub async fn events_of(&self, course: &str, person: &str) -> Result<Vec<OwnEvent>, StoreError> {
        let rows: Vec<(i64, String, String)> =
            sqlx::query_as(sql::EVENTS_OF).bind(course).bind(person).fetch_all(&self.pools.readers).await?;
        Ok(rows.into_iter().map(|(at, actor, what)| OwnEvent { at, what, own: actor == person }).collect())
    }

    /// Erases a person: the name, the ways in, the sessions, and, unless `answers_stay`, what was handed in and the words of the
    /// verdicts. Points, dates, decisions and the log stay, under a number: they are what a grade is proved with.
    ///
    /// Errors if there is no such person, or the class would be without an owner.
    pub async fn erase(
        &self,
        course: &str,
        actor: &str,
        person: &str,
        reason: &str,
        answers_stay: bool,
    ) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        let kept = if answers_stay { "answers stay" } else { "answers erased" };
        let detail = json!([reason, kept]).to_string();
        let event = Event { actor, what: ERASED, subject: person, detail: &detail };
        log::append(&mut transaction, course, now(), &event).await?;
        known(&mut transaction, course, person).await?;
        let all = sqlx::query_as(sql::OWNERS).bind(course).fetch_one(&mut *transaction).await?;
        let others = sqlx::query_as(sql::OTHER_OWNERS).bind(course).bind(person);
        let (all, others): ((i64,), (i64,)) = (all, others.fetch_one(&mut *transaction).await?);
        if all != others && others == (0,) {
            return Err(StoreError::LastOwner);
        }
        forget(&mut transaction, course, person).await?;
        strip(&mut transaction, course, person, answers_stay).await?;
        transaction.commit().await?;
        self.place_is_right()
    }
}

/// Takes the name and the ways in away.
async fn forget(connection: &mut AnyConnection, course: &str, person: &str) -> Result<(), StoreError> {
    // What waits has no grade yet: nothing is to be proved with it.
    let traces = [
        sql::REMOVE_IDENTITIES,
        sql::REMOVE_SESSIONS,
        sql::REMOVE_GRADINGS,
        sql::REMOVE_JUDGINGS,
        sql::REMOVE_ROOMS,
        sql::lti::FORGET_SUBJECT,
        sql::lti::FORGET_SCORES,
    ];
    for statement in traces {
        sqlx::query(statement).bind(person).execute(&mut *connection).await?;
    }
    let number = person.get(..6).unwrap_or(person);
    sqlx::query(sql::RENAME_PERSON)
        .bind(person)
        .bind(format!("Erased {number}"))
        .execute(&mut *connection)
        .await?;
    let key = sqlx::query(sql::SET_NAME_KEY).bind(course).bind(person).bind(format!("erased {person}"));
    key.execute(connection).await?;
    Ok(())
}

/// Takes names, and what was handed in, out of the records. The only change that records ever see: the triggers that keep
/// them stand aside within this transaction, and the log says that it was done.
async fn strip(
    connection: &mut AnyConnection,
    course: &str,
    person: &str,
    answers_stay: bool,
) -> Result<(), StoreError> {
    database::stand_aside(connection, true).await?;
    // At home the seed is the name.
    if course == super::super::HOME {
        sqlx::query(sql::UNSEED).bind(course).bind(person).execute(&mut *connection).await?;
    }
    sqlx::query(sql::UNNAME_SUBMISSIONS).bind(person).execute(&mut *connection).await?;
    if !answers_stay {
        sqlx::query(sql::EMPTY_SUBMISSIONS).bind(person).execute(&mut *connection).await?;
        sqlx::query(sql::EMPTY_PREDICTIONS).bind(person).execute(&mut *connection).await?;
    }
    let verdicts: Vec<(String, i64, String, String)> =
        sqlx::query_as(sql::VERDICTS_OF).bind(person).fetch_all(&mut *connection).await?;
    for (submission, run, body, seed) in verdicts {
        let mut told: Value = serde_json::from_str(&body).unwrap_or_default();
        without_person(&mut told, answers_stay);
        let seed = if course == super::super::HOME { "" } else { seed.as_str() };
        let set =
            sqlx::query(sql::REPLACE_VERDICT).bind(&submission).bind(run).bind(told.to_string()).bind(seed);
        set.execute(&mut *connection).await?;
    }
    database::stand_aside(connection, false).await
}

/// The verdict without who it is about and, unless the answers stay, without what it says of them.
fn without_person(told: &mut Value, answers_stay: bool) {
    if let Some(told) = told.as_object_mut() {
        told.remove("student");
    }
    if let Some(about) = told.get_mut("provenance").and_then(Value::as_object_mut) {
        about.insert("seed".into(), "".into());
    }
    if answers_stay {
        return;
    }
    for question in told["questions"].as_array_mut().into_iter().flatten() {
        let Some(question) = question.as_object_mut() else { continue };
        question.retain(|name, _| matches!(name.as_str(), "id" | "earned" | "possible" | "verdict"));
        question.insert("message_html".into(), "".into());
    }
}
