//! Names of lecture rooms: whose each is, and in which server a lecture was opened under it last.

use std::time::Duration;

use super::error::StoreError;
use super::queue::milliseconds;
use super::{Store, database, sql};

/// Names that one owner may have, and all together: they are never asked for back.
const MOST_OF_ONE: i64 = 20;
const MOST: i64 = 2000;
/// A name under which no lecture was opened for so long is free again: a year and a summer.
const KEPT: Duration = Duration::from_hours(24 * 460);

/// What became of the wish for a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Taking {
    /// It belongs to who asked, from now on or since before.
    Own,
    /// It is somebody else's.
    Taken,
    /// Who asked has too many, or all have.
    TooMany,
}

impl Store {
    /// Takes a room's name for its owner, or opens it again, in the server of that name.
    ///
    /// Errors if it cannot be written.
    pub async fn take_room(&self, name: &str, owner: &str, node: &str) -> Result<Taking, StoreError> {
        let mut transaction = self.write().await?;
        let at = database::clock(&mut transaction).await?;
        let forget = sqlx::query(sql::FORGET_ROOMS).bind(at - milliseconds(KEPT));
        forget.execute(&mut *transaction).await?;
        let count = sqlx::query_as(sql::OTHER_ROOMS).bind(owner).bind(name).fetch_one(&mut *transaction);
        let (all, own): (i64, i64) = count.await?;
        if all >= MOST || own >= MOST_OF_ONE {
            transaction.rollback().await?;
            return Ok(Taking::TooMany);
        }
        let take = sqlx::query(sql::TAKE_ROOM).bind(name).bind(owner).bind(node).bind(at);
        let taken = take.execute(&mut *transaction).await?;
        transaction.commit().await?;
        Ok(if taken.rows_affected() == 1 { Taking::Own } else { Taking::Taken })
    }

    /// The name of the server in which a lecture was opened under a room's name last; `None` where nobody has that name.
    ///
    /// Errors if it cannot be read.
    pub async fn node_of_room(&self, name: &str) -> Result<Option<String>, StoreError> {
        let find = sqlx::query_as(sql::ROOM).bind(name).fetch_optional(&self.pools.readers);
        let found: Option<(String,)> = find.await?;
        Ok(found.map(|(node,)| node))
    }
}
