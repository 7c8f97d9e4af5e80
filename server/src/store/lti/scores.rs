//! What a platform is to be told of scores, and what it was told: an outbox that outlives the program.

use super::sql;
use crate::policy::Moment;
use crate::store::error::StoreError;
use crate::store::sql as common;
use crate::store::{Store, now};

/// How often a score is tried before somebody who teaches is to look: with waits that double, three days.
const TRIES: i64 = 20;
/// How long one who took a score to send may keep it, in milliseconds: longer than any answer is waited for.
const LEASE: i64 = 60_000;

/// Where the scores of a lesson go.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Column {
    /// The course of the platform.
    pub context: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// The address; empty where the platform is still to be asked for one.
    pub url: String,
}

/// A score that a column should have.
#[derive(Debug, Clone, PartialEq)]
pub struct Wanted {
    /// The column.
    pub column: Column,
    /// The person.
    pub person: String,
    /// What is told, as one number: another one where something else is told.
    pub state: f64,
}

/// A score that is to be sent, taken by one who sends.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Due {
    /// The column.
    pub column: Column,
    /// The person.
    pub person: String,
    /// The time that is told with it, later than any before.
    pub stamp: Moment,
    /// How often it was tried.
    pub tries: u32,
}

/// What became of one that was to be sent.
#[derive(Debug, Clone, PartialEq)]
pub enum Told {
    /// The platform was told this, as [`Wanted::state`].
    Sent(f64),
    /// The results are held back: nothing is told.
    Held,
    /// It was refused: not before this moment again, and why.
    Refused(Moment, String),
    /// Nothing was asked, or nothing answered.
    Untried,
}

/// How it stands with a column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ColumnState {
    /// The column.
    pub column: Column,
    /// Scores that belong there.
    pub scores: u32,
    /// Those that the platform has.
    pub sent: u32,
    /// Those that are tried no more until somebody asks for it.
    pub given_up: u32,
    /// Why the last one that waits was refused; empty if none was.
    pub problem: String,
    /// When one was sent last.
    pub last: Option<Moment>,
}

impl Store {
    /// The columns of a platform.
    ///
    /// Errors if the file cannot be read.
    pub async fn columns(&self, platform: &str) -> Result<Vec<Column>, StoreError> {
        let rows: Vec<(String, String, String)> =
            sqlx::query_as(sql::COLUMNS).bind(platform).fetch_all(&self.pools.readers).await?;
        Ok(rows.into_iter().map(|(context, lesson, url)| Column { context, lesson, url }).collect())
    }

    /// Remembers where the scores of a lesson go: `url` in place of what `column` says.
    ///
    /// Errors if it cannot be written.
    pub async fn move_column(&self, platform: &str, column: &Column, url: &str) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        let remove = sqlx::query(sql::REMOVE_COLUMN).bind(platform).bind(&column.context);
        remove.bind(&column.lesson).bind(&column.url).execute(&mut *transaction).await?;
        let scores = sqlx::query(sql::REMOVE_SCORES_AT).bind(platform).bind(&column.url);
        scores.execute(&mut *transaction).await?;
        let add = sqlx::query(sql::ADD_COLUMN).bind(platform).bind(&column.context).bind(&column.lesson);
        add.bind(url).execute(&mut *transaction).await?;
        transaction.commit().await
    }

    /// Forgets where the scores of a lesson go.
    ///
    /// Errors if it cannot be written.
    pub async fn forget_column(&self, platform: &str, column: &Column) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        let remove = sqlx::query(sql::REMOVE_COLUMN).bind(platform).bind(&column.context);
        remove.bind(&column.lesson).bind(&column.url).execute(&mut *transaction).await?;
        transaction.commit().await
    }

    /// The students of a course of the platform: what it calls them, and who they are here.
    ///
    /// Errors if the file cannot be read.
    pub async fn people_of_context(
        &self,
        course: &str,
        platform: &str,
        context: &str,
    ) -> Result<Vec<(String, String)>, StoreError> {
        let list = sqlx::query_as(sql::PEOPLE_OF_CONTEXT).bind(platform).bind(context).bind(course);
        Ok(list.fetch_all(&self.pools.readers).await?)
    }

    /// What a platform calls a person in one of its courses.
    ///
    /// Errors if the file cannot be read.
    pub async fn subject_of(
        &self,
        platform: &str,
        context: &str,
        person: &str,
    ) -> Result<Option<String>, StoreError> {
        let find = sqlx::query_as(sql::SUBJECT_OF).bind(platform).bind(context).bind(person);
        let found: Option<(String,)> = find.fetch_optional(&self.pools.readers).await?;
        Ok(found.map(|(subject,)| subject))
    }

    /// What platforms call a person: platform and name there.
    ///
    /// Errors if the file cannot be read.
    pub async fn subjects(&self, person: &str) -> Result<Vec<(String, String)>, StoreError> {
        Ok(sqlx::query_as(sql::SUBJECTS).bind(person).fetch_all(&self.pools.readers).await?)
    }

    /// Writes down what columns should have. What they have already is not due.
    ///
    /// Errors if it cannot be written.
    pub async fn want(&self, platform: &str, wanted: &[Wanted]) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        for Wanted { column, person, state } in wanted {
            let want = sqlx::query(sql::WANT).bind(platform).bind(&column.url).bind(person);
            let want = want.bind(&column.context).bind(&column.lesson).bind(state);
            want.execute(&mut *transaction).await?;
        }
        transaction.commit().await
    }

    /// Takes a score that is due, so that nobody else sends it meanwhile.
    ///
    /// Errors if it cannot be written.
    pub async fn claim_score(&self, platform: &str, at: Moment) -> Result<Option<Due>, StoreError> {
        type Row = (String, String, String, String, i64, i64);
        let mut transaction = self.write().await?;
        let claim = sqlx::query_as(sql::CLAIM).bind(platform).bind(at.0).bind(at.0 + LEASE).bind(TRIES);
        let row: Option<Row> = claim.fetch_optional(&mut *transaction).await?;
        transaction.commit().await?;
        Ok(row.map(|(url, person, context, lesson, stamp, tries)| Due {
            column: Column { context, lesson, url },
            person,
            stamp: Moment(stamp),
            tries: u32::try_from(tries).unwrap_or(u32::MAX),
        }))
    }

    /// Writes down what became of a score that was taken.
    ///
    /// Errors if it cannot be written.
    pub async fn told(&self, platform: &str, due: &Due, told: &Told) -> Result<(), StoreError> {
        let statements: &[&'static str] = match told {
            Told::Sent(_) => &[sql::TOLD],
            Told::Held => &[sql::HOLD_FIRST, sql::HOLD],
            Told::Refused(..) => &[sql::FAILED],
            Told::Untried => &[sql::GIVE_BACK],
        };
        let mut transaction = self.write().await?;
        for statement in statements {
            let set = sqlx::query(*statement).bind(platform).bind(&due.column.url).bind(&due.person);
            let set = match told {
                Told::Sent(state) => set.bind(state).bind(now()),
                Told::Refused(not_before, why) => set.bind(not_before.0).bind(why),
                Told::Held | Told::Untried => set,
            };
            set.execute(&mut *transaction).await?;
        }
        transaction.commit().await
    }

    /// The number of the last entry in the log of a course: whether anything happened.
    ///
    /// Errors if the file cannot be read.
    pub async fn last_event(&self, course: &str) -> Result<i64, StoreError> {
        let find =
            sqlx::query_as(common::END_OF_CHAIN).bind(course).fetch_optional(&self.pools.readers).await?;
        Ok(find.map_or(0, |(n, _): (i64, String)| n))
    }

    /// Has all scores that a platform does not have tried at once.
    ///
    /// Errors if it cannot be written.
    pub async fn send_again(&self, platform: &str) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        for statement in [sql::AGAIN, sql::END_PAUSE] {
            sqlx::query(statement).bind(platform).execute(&mut *transaction).await?;
        }
        transaction.commit().await
    }

    /// How it stands with the columns of a platform.
    ///
    /// Errors if the file cannot be read.
    pub async fn column_states(&self, platform: &str) -> Result<Vec<ColumnState>, StoreError> {
        type Row = (String, String, String, i64, i64, i64, String, Option<i64>);
        let list = sqlx::query_as(sql::PLACES).bind(platform).bind(TRIES);
        let rows: Vec<Row> = list.fetch_all(&self.pools.readers).await?;
        let count = |n: i64| u32::try_from(n).unwrap_or_default();
        let read = |(context, lesson, url, scores, sent, given_up, problem, last): Row| ColumnState {
            column: Column { context, lesson, url },
            scores: count(scores),
            sent: count(sent),
            given_up: count(given_up),
            problem,
            last: last.map(Moment),
        };
        Ok(rows.into_iter().map(read).collect())
    }
}
