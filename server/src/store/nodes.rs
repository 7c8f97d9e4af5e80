//! The servers that share a gradebook: how each is reached by the others, and when it was heard of last.

use std::time::Duration;

use super::error::StoreError;
use super::queue::milliseconds;
use super::{Store, database, sql};

/// A server that was not heard of for so long is gone.
pub const GONE: Duration = Duration::from_secs(20);
/// How often a server lets itself be heard.
pub const HEARD: Duration = Duration::from_secs(5);
/// Names of servers that are gone for longer are forgotten.
const KEPT: Duration = Duration::from_hours(24);

/// Where a server is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Whereabouts {
    /// It was heard of, and is reached at this host and port.
    At(String),
    /// It has gone, or was not heard of for [`GONE`].
    Gone,
}

impl Store {
    /// Takes a name for the server that is reached at `address`; false where another has it.
    ///
    /// Errors if it cannot be written.
    pub async fn take_node(&self, name: &str, address: &str) -> Result<bool, StoreError> {
        let mut transaction = self.write().await?;
        let at = database::clock(&mut transaction).await?;
        let forget = sqlx::query(sql::FORGET_NODES).bind(at - milliseconds(KEPT));
        forget.execute(&mut *transaction).await?;
        let take = sqlx::query(sql::TAKE_NODE).bind(name).bind(address).bind(at);
        let taken = take.bind(at - milliseconds(GONE)).execute(&mut *transaction).await?;
        transaction.commit().await?;
        Ok(taken.rows_affected() == 1)
    }

    /// Where the server of that name is; `None` where none has had it.
    ///
    /// Errors if it cannot be read.
    pub async fn node(&self, name: &str) -> Result<Option<Whereabouts>, StoreError> {
        let mut connection = self.pools.readers.acquire().await?;
        let at = database::clock(&mut connection).await?;
        let find = sqlx::query_as(sql::NODE).bind(name).fetch_optional(&mut *connection);
        let found: Option<(String, i64)> = find.await?;
        Ok(found.map(|(address, heard)| {
            if heard < at - milliseconds(GONE) { Whereabouts::Gone } else { Whereabouts::At(address) }
        }))
    }

    /// Says that a server goes. Its name waits for it: it may come back with what lived in it.
    ///
    /// Errors if it cannot be written.
    pub async fn leave_node(&self, name: &str, address: &str) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        let leave = sqlx::query(sql::LEAVE_NODE).bind(name).bind(address);
        leave.execute(&mut *transaction).await?;
        transaction.commit().await
    }
}
