//! The databases that keep a gradebook: SQLite in a file or in memory, or a PostgreSQL server. Everything in which they
//! differ stands here and in `kind.rs`; the statements of `sql.rs` are in words that both understand.

use std::fmt::Write;
use std::path::Path;
use std::str::FromStr;
use std::sync::Once;
use std::time::Duration;

use futures_util::TryStreamExt;
use futures_util::future::BoxFuture;
use sqlx::any::{AnyArguments, AnyConnectOptions, AnyPoolOptions, AnyRow};
use sqlx::query::QueryAs;
use sqlx::{Any, AnyConnection, AnyPool, AssertSqlSafe, ConnectOptions, FromRow};

use super::error::StoreError;
use super::kind::Kind;
use super::transaction;

/// How long a statement waits for another program that writes.
pub(super) const PATIENCE: Duration = Duration::from_secs(5);
/// Connections that read a file; one more writes.
const READERS: u32 = 4;
/// Connections of one program to a server that read, and as many that write: a server allows some hundred in all.
const TO_SERVER: u32 = 8;
/// What every program that makes or changes tables on a server holds meanwhile: a number that nothing else there uses.
const MIGRATING: i64 = 0x7472_6961_6401;

/// Connections to a gradebook.
#[derive(Debug)]
pub(super) struct Pools {
    pub(super) writer: AnyPool,
    pub(super) readers: AnyPool,
}

/// What refuses changes of records on a server, unless somebody is erased within the transaction.
const REFUSE: &str = "CREATE OR REPLACE FUNCTION triad_refuse() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN \
    IF TG_OP = 'UPDATE' AND current_setting('triad.erasing', true) = 'yes' THEN RETURN NEW; END IF; \
    RAISE EXCEPTION '%', TG_ARGV[0]; END $$";

impl Pools {
    /// Connections to a file; none is made before it is needed.
    pub(super) fn of_file(file: &Path) -> Result<Self, StoreError> {
        let writer = kept_open(1).connect_lazy_with(address(&of_file(file, "mode=rw"))?);
        let readers = kept_open(READERS).connect_lazy_with(address(&of_file(file, "mode=ro"))?);
        Ok(Self { writer, readers })
    }

    /// The one connection to a gradebook in memory: each has a database of its own. `make` makes its tables.
    #[allow(clippy::expect_used)] // the address stands here
    pub(super) fn in_memory<F>(make: F) -> Self
    where
        F: for<'c> Fn(&'c mut AnyConnection) -> BoxFuture<'c, Result<(), sqlx::Error>>
            + Send
            + Sync
            + 'static,
    {
        let options = address("sqlite::memory:").expect("an address");
        let writer =
            kept_open(1).after_connect(move |connection, _| make(connection)).connect_lazy_with(options);
        Self { readers: writer.clone(), writer }
    }

    /// Connections to a server; none is made before it is needed.
    pub(super) fn to_server(url: &str) -> Result<Self, StoreError> {
        let options = address(url)?;
        // A server that was started again has ended the connections that were kept.
        let pool = || to_server().connect_lazy_with(options.clone());
        Ok(Self { writer: pool(), readers: pool() })
    }
}

fn address(url: &str) -> Result<AnyConnectOptions, StoreError> {
    static DRIVERS: Once = Once::new();
    DRIVERS.call_once(sqlx::any::install_default_drivers);
    Ok(AnyConnectOptions::from_str(url)?)
}

/// The address of a file that is there, whatever signs its path has.
fn of_file(file: &Path, parameters: &str) -> String {
    let mut url = "sqlite:".to_owned();
    for byte in file.as_os_str().as_encoded_bytes() {
        match byte {
            b'/' | b'\\' | b':' | b'.' | b'-' | b'_' => url.push(char::from(*byte)),
            _ if byte.is_ascii_alphanumeric() => url.push(char::from(*byte)),
            _ => drop(write!(url, "%{byte:02X}")),
        }
    }
    format!("{url}?{parameters}")
}

/// A connection to a file that is only read; with `whole` nobody else writes it.
pub(super) async fn reading(file: &Path, whole: bool) -> Result<AnyConnection, StoreError> {
    Ok(address(&of_file(file, &format!("mode=ro&immutable={whole}")))?.connect().await?)
}

/// Connections that stay: a store in memory lives in one, and opening a file again costs more than keeping it. What a
/// request that was given up left half-done is undone.
fn kept_open(most: u32) -> AnyPoolOptions {
    const SETTINGS: [&str; 4] = [
        "PRAGMA busy_timeout = 5000",
        "PRAGMA synchronous = FULL",
        "PRAGMA foreign_keys = ON",
        // What is erased is overwritten, not only forgotten.
        "PRAGMA secure_delete = ON",
    ];
    let stays = AnyPoolOptions::new().max_connections(most).idle_timeout(None).max_lifetime(None);
    set_up(stays.test_before_acquire(false), &SETTINGS)
}

fn to_server() -> AnyPoolOptions {
    const SETTINGS: [&str; 2] = [
        "SET lock_timeout = '5s'",
        // A program that was stopped in the middle of a transaction does not hold up the others for ever.
        "SET idle_in_transaction_session_timeout = '30s'",
    ];
    let patient = AnyPoolOptions::new().max_connections(TO_SERVER).acquire_timeout(PATIENCE);
    set_up(patient, &SETTINGS)
}

fn set_up(options: AnyPoolOptions, settings: &'static [&'static str]) -> AnyPoolOptions {
    let begun = options.after_connect(move |connection, _| {
        Box::pin(async move {
            for setting in settings {
                let set = sqlx::query(*setting).execute(&mut *connection).await.map_err(StoreError::from);
                match set {
                    Ok(_) => {}
                    // No database, or a damaged one: the first statement says so. What is refused here is tried again for half a
                    // minute.
                    Err(StoreError::Damaged(_)) => return Ok(()),
                    Err(other) => return Err(sqlx::Error::Protocol(other.to_string())),
                }
            }
            Ok(())
        })
    });
    begun.after_release(|connection, _| {
        Box::pin(async move {
            transaction::undo(connection).await;
            Ok(true)
        })
    })
}

/// Changes go to a log beside the file, so that readers do not wait. Several programs that open a new file at once get in
/// each other's way here, where SQLite does not wait by itself.
pub(super) async fn write_ahead(writer: &AnyPool) -> Result<(), StoreError> {
    let mut tries = 0;
    loop {
        match sqlx::query("PRAGMA journal_mode = WAL").execute(writer).await.map_err(StoreError::from) {
            Err(StoreError::Busy) if tries < 50 => tries += 1,
            other => return other.map(drop),
        }
        tokio::time::sleep(PATIENCE / 50).await;
    }
}

/// The format of the tables that are there; 0 where there are none. On a server it holds everybody else who asks, until the end
/// of the transaction.
pub(super) async fn format(connection: &mut AnyConnection) -> Result<i64, StoreError> {
    let text = match Kind::of(connection) {
        Kind::Sqlite => "PRAGMA user_version",
        Kind::Postgres => {
            let hold = sqlx::query("SELECT pg_advisory_xact_lock($1)").bind(MIGRATING);
            hold.execute(&mut *connection).await?;
            let encoding = sqlx::query_as("SELECT current_setting('server_encoding')");
            let (encoding,): (String,) = encoding.fetch_one(&mut *connection).await?;
            if encoding != "UTF8" {
                return Err(StoreError::Sql(format!(
                    "its letters are {encoding}: make another with createdb --encoding=UTF8 --template=template0"
                )));
            }
            let make = "CREATE TABLE IF NOT EXISTS triad_format (version BIGINT NOT NULL)";
            sqlx::query(make).execute(&mut *connection).await?;
            "SELECT COALESCE(MAX(version), 0) FROM triad_format"
        }
    };
    let (found,): (i64,) = sqlx::query_as(text).fetch_one(&mut *connection).await?;
    Ok(found)
}

/// The time, in milliseconds since 1970: on a server its own, for all who ask it.
pub(super) async fn clock(connection: &mut AnyConnection) -> Result<i64, StoreError> {
    if Kind::of(connection) == Kind::Sqlite {
        return Ok(jiff::Timestamp::now().as_millisecond());
    }
    let time = sqlx::query_as("SELECT CAST(EXTRACT(EPOCH FROM clock_timestamp()) * 1000 AS BIGINT)");
    let (now,): (i64,) = time.fetch_one(connection).await?;
    Ok(now)
}

/// Writes down the format. Each time: a file that cannot be written is found out before anybody hands in.
pub(super) async fn set_format(connection: &mut AnyConnection, format: i64) -> Result<(), StoreError> {
    match Kind::of(connection) {
        Kind::Sqlite => {
            let text = format!("PRAGMA user_version = {format}");
            sqlx::query(AssertSqlSafe(text)).execute(connection).await?;
        }
        Kind::Postgres => {
            sqlx::query("DELETE FROM triad_format").execute(&mut *connection).await?;
            let set = sqlx::query("INSERT INTO triad_format (version) VALUES ($1)").bind(format);
            set.execute(connection).await?;
        }
    }
    Ok(())
}

/// Makes what the tables need on a server. What changes them there gives way, until the end of the transaction, to those who work
/// on them: where two wait for each other the server would end either of them after a second.
pub(super) async fn prepare(connection: &mut AnyConnection) -> Result<(), StoreError> {
    if Kind::of(connection) == Kind::Postgres {
        sqlx::query("SET LOCAL lock_timeout = '200ms'").execute(&mut *connection).await?;
        sqlx::query(REFUSE).execute(connection).await?;
    }
    Ok(())
}

/// Lets the triggers that keep records stand aside, within this transaction; `begin` false: they keep them again.
pub(super) async fn stand_aside(connection: &mut AnyConnection, begin: bool) -> Result<(), StoreError> {
    const ASIDE: [&str; 4] =
        ["submission_is_immutable", "verdict_is_immutable", "seed_is_immutable", "prediction_is_immutable"];
    if Kind::of(connection) == Kind::Postgres {
        let word = if begin { "yes" } else { "" };
        let set = sqlx::query("SELECT set_config('triad.erasing', $1, true)").bind(word);
        set.execute(connection).await?;
        return Ok(());
    }
    if begin {
        for trigger in ASIDE {
            sqlx::query(AssertSqlSafe(format!("DROP TRIGGER {trigger}"))).execute(&mut *connection).await?;
        }
        return Ok(());
    }
    let makes = |text: &&&str| ASIDE.iter().any(|trigger| text.contains(trigger));
    for statement in super::sql::RECORDS.iter().chain(super::sql::ADDED_4).filter(makes) {
        sqlx::query(*statement).execute(&mut *connection).await?;
    }
    Ok(())
}

/// The rows that can be read: text that a damaged disk made none is left out, and told in the server's log.
///
/// Errors if the database does not answer.
pub(super) async fn readable<T>(
    list: QueryAs<'_, Any, T, AnyArguments>,
    readers: &AnyPool,
) -> Result<Vec<T>, StoreError>
where
    T: for<'r> FromRow<'r, AnyRow> + Send + Unpin,
{
    // A pool's own list ends at the first row that cannot be read.
    let mut connection = readers.acquire().await?;
    let mut rows = list.fetch(&mut *connection);
    let mut found = Vec::new();
    loop {
        match rows.try_next().await {
            Ok(Some(row)) => found.push(row),
            Ok(None) => return Ok(found),
            Err(cause @ (sqlx::Error::ColumnDecode { .. } | sqlx::Error::Decode(_))) => {
                tracing::error!(target: "triad", %cause, "a row is damaged: restore the database from a copy");
            }
            Err(other) => return Err(other.into()),
        }
    }
}
