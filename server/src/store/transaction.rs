//! Transactions that write.
//!
//! SQLite ends some by itself, as on a full disk. sqlx counts them, would count such a one for ever, and refuse to begin
//! another on its connection; so they are begun and ended here.

use std::ops::{Deref, DerefMut};

use sqlx::pool::PoolConnection;
use sqlx::{Any, AnyConnection, AnyPool};

use super::error::StoreError;
use super::kind::Kind;

/// A transaction. Dropped before it is committed, it is undone as its connection goes back.
#[derive(Debug)]
pub(super) struct Transaction(PoolConnection<Any>);

impl Transaction {
    /// Begins one, and waits for others here and not at the first change.
    pub(super) async fn begin(writer: &AnyPool) -> Result<Self, StoreError> {
        Self::on(writer.acquire().await?).await
    }

    /// Begins one on a connection that writes.
    pub(super) async fn on(mut connection: PoolConnection<Any>) -> Result<Self, StoreError> {
        let begin = Kind::of(&connection).begin();
        sqlx::query(begin).execute(&mut *connection).await?;
        Ok(Self(connection))
    }

    /// Keeps what was done: it is on the disk when this returns.
    pub(super) async fn commit(mut self) -> Result<(), StoreError> {
        sqlx::query("COMMIT").execute(&mut *self.0).await?;
        Ok(())
    }

    /// Undoes what was done.
    pub(super) async fn rollback(mut self) -> Result<(), StoreError> {
        undo(&mut self.0).await;
        Ok(())
    }
}

/// Undoes what was begun on a connection, if anything was.
pub(super) async fn undo(connection: &mut AnyConnection) {
    // Without a transaction there is nothing to undo, and the database says so.
    drop(sqlx::query("ROLLBACK").execute(connection).await);
}

impl Deref for Transaction {
    type Target = AnyConnection;

    fn deref(&self) -> &AnyConnection {
        &self.0
    }
}

impl DerefMut for Transaction {
    fn deref_mut(&mut self) -> &mut AnyConnection {
        &mut self.0
    }
}
