//! The gradebook: people, what they handed in, what it earned and who decided what, in one SQLite file.
//!
//! What is handed in and judged is a record that is added to, never changed. What is acknowledged is on the disk: each
//! submission is one transaction, written through before it returns.

mod class;
mod copies;
mod error;
mod file;
pub mod hash;
mod log;
pub mod names;
mod people;
mod predictions;
mod quotas;
mod random;
mod records;
mod schema;
mod sql;
mod submissions;
#[cfg(test)]
mod tests;
mod transaction;

use std::path::Path;
use std::time::Duration;

use sqlx::SqlitePool;
use sqlx::sqlite::{SqliteConnectOptions, SqlitePoolOptions, SqliteSynchronous};

pub use class::{
    Assignment, Decision, DecisionKind, HandedRow, NewRegrade, NewVerdict, RegradeRow, Regraded,
    VerdictHistory,
};
pub use copies::{Copied, Imported, OwnEvent, Pieces, restore};
#[cfg(test)]
use copies::{LEFT, OF_COURSE};
pub use error::StoreError;
use file::Place;
pub use people::{CLASS, CourseRow, LIFE, Member, Return, Role};
pub use predictions::{KeptPrediction, NewPrediction};
pub use quotas::Quotas;
pub use submissions::{HandIn, Kept, Query, Recorded, StoredSubmission, Whose};
use transaction::Transaction;

/// The course of those who use the workbench without accounts.
pub const HOME: &str = "home";
/// How long a statement waits for another program that writes.
const PATIENCE: Duration = Duration::from_secs(5);
/// Connections that read; one more writes.
const READERS: u32 = 4;

/// The gradebook.
#[derive(Debug)]
pub struct Store {
    writer: SqlitePool,
    readers: SqlitePool,
    place: Option<Place>,
    quotas: Quotas,
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
        let options = SqliteConnectOptions::new()
            .filename(file)
            .busy_timeout(PATIENCE)
            .synchronous(SqliteSynchronous::Full)
            .foreign_keys(true)
            // What is erased is overwritten, not only forgotten.
            .pragma("secure_delete", "ON");
        let writer = pool(1).connect_lazy_with(options.clone());
        write_ahead(&writer).await?;
        let (whole,): (String,) = sqlx::query_as("PRAGMA quick_check(1)").fetch_one(&writer).await?;
        if whole != "ok" {
            return Err(StoreError::Damaged(whole));
        }
        let mut transaction = Transaction::begin(&writer).await?;
        schema::migrate(&mut transaction).await?;
        transaction.commit().await?;
        let readers = pool(READERS).connect_lazy_with(options.read_only(true));
        Ok(Self { writer, readers, place: Some(Place::remember(file.to_owned())), quotas: Quotas::default() })
    }

    /// A gradebook that is forgotten when it is dropped.
    pub fn in_memory() -> Self {
        // Each connection to memory has a database of its own: there is one, for as long as the store.
        let options = SqliteConnectOptions::new().in_memory(true).foreign_keys(true);
        let first = pool(1).after_connect(|connection, _| {
            Box::pin(async move {
                schema::migrate(connection).await.map_err(|error| sqlx::Error::Protocol(error.to_string()))
            })
        });
        let writer = first.connect_lazy_with(options);
        Self { readers: writer.clone(), writer, place: None, quotas: Quotas::default() }
    }

    /// The same gradebook, keeping so much.
    #[must_use]
    pub fn with_quotas(self, quotas: Quotas) -> Self {
        Self { quotas, ..self }
    }

    /// Begins a transaction that writes.
    async fn write(&self) -> Result<Transaction, StoreError> {
        Transaction::begin(&self.writer).await
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
        let courses: Vec<(String,)> = sqlx::query_as(sql::COURSES).fetch_all(&self.readers).await?;
        let mut found = Vec::new();
        let mut connection = self.readers.acquire().await?;
        for (course,) in courses {
            found.extend(log::faults(&mut connection, &course).await?);
        }
        Ok(found)
    }

    /// Finishes what is being written and lets go of the file.
    pub async fn close(&self) {
        self.readers.close().await;
        self.writer.close().await;
    }
}

/// Connections that stay: a store in memory lives in one, and opening a file again costs more than keeping it. What a
/// request that was given up left half-done is undone.
fn pool(most: u32) -> SqlitePoolOptions {
    let stays = SqlitePoolOptions::new().max_connections(most).idle_timeout(None).max_lifetime(None);
    stays.test_before_acquire(false).after_release(|connection, _| {
        Box::pin(async move {
            transaction::undo(connection).await;
            Ok(true)
        })
    })
}

/// Changes go to a log beside the file, so that readers do not wait. Several programs that open a new file at once get in
/// each other's way here, where SQLite does not wait by itself.
async fn write_ahead(writer: &SqlitePool) -> Result<(), StoreError> {
    let mut tries = 0;
    loop {
        match sqlx::query("PRAGMA journal_mode = WAL").execute(writer).await.map_err(StoreError::from) {
            Err(StoreError::Busy) if tries < 50 => tries += 1,
            other => return other.map(drop),
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
