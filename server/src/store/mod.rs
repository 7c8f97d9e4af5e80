//! The gradebook: people, what they handed in, what it earned and who decided what, in one SQLite file or in a database of a
//! PostgreSQL server.
//!
//! What is handed in and judged is a record that is added to, never changed. What is acknowledged is on the disk: a submission is
//! written whole or not at all, and through, alone or together with others, before it returns.

mod audit;
mod bell;
mod class;
mod copies;
mod database;
mod error;
mod file;
pub mod hash;
mod identities;
mod judging;
mod kind;
mod location;
mod log;
mod lti;
pub mod names;
mod nodes;
#[cfg(all(test, unix))]
mod on_both;
#[cfg(all(test, unix))]
mod on_both_queue;
#[cfg(all(test, unix))]
mod on_both_rulings;
mod people;
mod predictions;
mod queue;
mod quotas;
mod random;
mod records;
mod rooms;
mod rulings;
mod schema;
mod sql;
mod submissions;
#[cfg(test)]
mod tests;
mod together;
mod transaction;
mod versions;

use std::collections::HashMap;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use sqlx::Any;
use sqlx::pool::PoolConnection;
use tokio::sync::Notify;

use bell::Verdicts;
pub use bell::{Awaited, Bell};
pub use class::{
    Assignment, Decision, DecisionKind, HandedRow, NewRegrade, NewVerdict, RegradeRow, Regraded, Ruled, Said,
    VerdictHistory,
};
pub use copies::{Copied, Imported, OwnEvent, Pieces, restore};
#[cfg(test)]
use copies::{LEFT, OF_COURSE};
use database::{PATIENCE, Pools};
pub use error::StoreError;
use file::Place;
pub use judging::{Judging, NewJudging, Outcome};
use kind::Kind;
pub use location::Location;
pub use lti::{Admission, Arrival, Column, ColumnState, Context, Due, Pause, Platform, Told, Wanted};
pub use nodes::{GONE, HEARD, Whereabouts};
pub use people::{CLASS, CourseRow, LIFE, Member, Return, Role};
pub use predictions::{KeptPrediction, NewPrediction};
pub use queue::{Accept, Accepted, Claim, Job, STARTS, Waiting};
pub use quotas::Quotas;
pub use rooms::Taking;
pub use submissions::{HandIn, Kept, Query, Recorded, StoredSubmission, Whose};
use together::Together;
use transaction::Transaction;

/// The course of those who use the workbench without accounts.
pub const HOME: &str = "home";

/// The gradebook.
#[derive(Debug)]
pub struct Store {
    pools: Pools,
    /// Where it is a file of its own.
    place: Option<Place>,
    quotas: Quotas,
    /// Submissions that wait to be written.
    together: Arc<Together>,
    /// The address of the server that keeps it.
    server: Option<String>,
    /// Wakes graders in this program.
    work: Notify,
    /// Tells students in this program that their verdicts are there.
    verdicts: Verdicts,
    /// What is enough to pass versions of lessons that were asked for, by SHA-256.
    pass_marks: Mutex<HashMap<String, Option<f64>>>,
}

impl Store {
    /// Opens the file, making it if it is not there, looks whether it is whole, and brings its tables up to date.
    ///
    /// Errors if it cannot be opened or written, is no database, is damaged, or is of a later version.
    pub async fn open(path: &Path) -> Result<Self, StoreError> {
        let file = Place::prepare(path)?;
        Self::open_file(&file).await.map_err(|error| error.opening(path))
    }

    async fn open_file(file: &Path) -> Result<Self, StoreError> {
        let pools = Pools::of_file(file)?;
        database::write_ahead(&pools.writer).await?;
        let (whole,): (String,) = sqlx::query_as("PRAGMA quick_check(1)").fetch_one(&pools.writer).await?;
        if whole != "ok" {
            return Err(StoreError::Damaged(whole));
        }
        migrate(&pools).await?;
        Ok(Self { place: Some(Place::remember(file.to_owned())), ..Self::of(pools) })
    }

    /// Opens a file as [`Self::open`] does, or a database of a server.
    ///
    /// Errors if it cannot be opened or written, is no gradebook, or is of a later version.
    pub async fn at(location: &Location) -> Result<Self, StoreError> {
        match location {
            Location::File(path) => Self::open(path).await,
            Location::Server(url) => {
                let pools = Pools::to_server(url)?;
                let connected = pools.writer.acquire().await;
                drop(connected.map_err(|error| StoreError::connecting(&error, location))?);
                migrate(&pools).await.map_err(|error| error.making(location))?;
                Ok(Self { server: Some(url.clone()), ..Self::of(pools) })
            }
        }
    }

    fn of(pools: Pools) -> Self {
        Self {
            pools,
            place: None,
            quotas: Quotas::default(),
            together: Arc::default(),
            server: None,
            work: Notify::new(),
            verdicts: Verdicts::default(),
            pass_marks: Mutex::default(),
        }
    }

    /// A gradebook that is forgotten when it is dropped.
    pub fn in_memory() -> Self {
        Self::of(Pools::in_memory(|connection| {
            Box::pin(async move {
                let made = schema::migrate(connection).await;
                made.map_err(|error| sqlx::Error::Protocol(error.to_string()))
            })
        }))
    }

    /// A gradebook of a server whose tables are as this program makes them: nothing is asked before it is used.
    ///
    /// Errors if that is no address.
    pub fn of_server(url: &str) -> Result<Self, StoreError> {
        Ok(Self { server: Some(url.to_owned()), ..Self::of(Pools::to_server(url)?) })
    }

    /// Whether other programs keep it too: then graders elsewhere take over what is too much here.
    pub fn is_shared(&self) -> bool {
        self.server.is_some()
    }

    /// The same gradebook, keeping so much.
    #[must_use]
    pub fn with_quotas(self, quotas: Quotas) -> Self {
        Self { quotas, ..self }
    }

    /// Begins a transaction that writes.
    async fn write(&self) -> Result<Transaction, StoreError> {
        Transaction::begin(&self.pools.writer).await
    }

    /// A connection that reads everything as of one moment; that ends as it goes back.
    async fn snapshot(&self) -> Result<PoolConnection<Any>, StoreError> {
        let mut connection = self.pools.readers.acquire().await?;
        let begin = Kind::of(&connection).snapshot();
        sqlx::query(begin).execute(&mut *connection).await?;
        Ok(connection)
    }

    /// Errors if the file is no longer where it was opened.
    fn place_is_right(&self) -> Result<(), StoreError> {
        self.place.as_ref().map_or(Ok(()), Place::check)
    }

    /// Whether something could be handed in now.
    ///
    /// Errors with what is in the way.
    pub async fn ready(&self) -> Result<(), StoreError> {
        self.place_is_right()?;
        self.write().await?.rollback().await
    }

    /// The time by which everybody is measured, in milliseconds since 1970: that of the database.
    ///
    /// Errors if it cannot be asked.
    pub async fn clock(&self) -> Result<i64, StoreError> {
        database::clock(&mut *self.pools.readers.acquire().await?).await
    }

    /// Writes into the log of a course what somebody did that changed nothing: that they looked, or took a copy.
    ///
    /// Errors if it cannot be written.
    pub async fn note(&self, course: &str, actor: &str, what: &str, subject: &str) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        log::append(&mut transaction, course, now(), &log::Event { actor, what, subject, detail: "" })
            .await?;
        transaction.commit().await
    }

    /// Faults of the records of all courses, as sentences; empty if everything is as it was written.
    ///
    /// Errors if the file cannot be read.
    pub async fn faults(&self) -> Result<Vec<String>, StoreError> {
        let mut connection = self.snapshot().await?;
        let courses: Vec<(String,)> = sqlx::query_as(sql::COURSES).fetch_all(&mut *connection).await?;
        let mut found = Vec::new();
        for (course,) in courses {
            found.extend(audit::faults(&mut connection, &course).await?);
        }
        Ok(found)
    }

    /// Finishes what is being written and lets go of the database.
    pub async fn close(&self) {
        self.pools.readers.close().await;
        self.pools.writer.close().await;
    }
}

/// Brings the tables up to date, in one transaction. While others work on them it begins anew as often as it has to give way.
async fn migrate(pools: &Pools) -> Result<(), StoreError> {
    const MOST: Duration = Duration::from_mins(1);
    let began = Instant::now();
    loop {
        let mut transaction = Transaction::begin(&pools.writer).await?;
        match schema::migrate(&mut transaction).await {
            Err(StoreError::Busy) if began.elapsed() < MOST => transaction.rollback().await?,
            made => {
                made?;
                return transaction.commit().await;
            }
        }
        tokio::time::sleep(PATIENCE / 50).await;
    }
}

/// Now, in milliseconds since 1970.
fn now() -> i64 {
    jiff::Timestamp::now().as_millisecond()
}

/// A name that was never used before.
pub fn identifier() -> String {
    uuid::Uuid::new_v4().simple().to_string()
}

/// What nobody guesses: 244 random bits.
pub fn secret() -> String {
    format!("{}{}", identifier(), identifier())
}
