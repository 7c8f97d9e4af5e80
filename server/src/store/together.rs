//! Submissions that come while others are written through are written together: the disk is flushed once for all that wait.
//!
//! A disk takes milliseconds to flush, and a slow one tens: two hundred that hand in at the bell would stand in line for as many
//! flushes. Each is still told only after the flush that keeps it, and what is refused of one keeps back none of the others.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use sqlx::{AnyConnection, AnyPool};
use tokio::sync::oneshot;

use super::error::StoreError;
use super::quotas::Quotas;
use super::submissions::{HandIn, Kept, keep};
use super::transaction::Transaction;

/// Submissions in one transaction: beyond these the first would wait for the last.
const MOST: usize = 64;

/// What waits to be written.
#[derive(Debug, Default)]
pub(super) struct Together(Mutex<VecDeque<Entry>>);

#[derive(Debug)]
struct Entry {
    new: HandIn,
    tell: oneshot::Sender<Result<Kept, StoreError>>,
}

impl Together {
    /// Keeps it with all that wait when its turn to write comes.
    pub(super) async fn keep(
        self: &Arc<Self>,
        writer: &AnyPool,
        quotas: Quotas,
        new: HandIn,
    ) -> Result<Kept, StoreError> {
        let (tell, told) = oneshot::channel();
        self.lock().push_back(Entry { new, tell });
        let (all, writer) = (Arc::clone(self), writer.clone());
        // A task of its own: whoever writes for others does not stop as its own caller leaves.
        tokio::spawn(async move { all.write(&writer, &quotas).await });
        told.await.unwrap_or_else(|_| Err(StoreError::Gone("the server is being stopped".to_owned())))
    }

    /// Writes what waits, if nobody else has: there is one of these for each entry.
    async fn write(&self, writer: &AnyPool, quotas: &Quotas) {
        let begun = match writer.acquire().await {
            Ok(_) if self.lock().is_empty() => return,
            Ok(connection) => Transaction::on(connection).await,
            Err(error) => Err(error.into()),
        };
        let mut transaction = match begun {
            Ok(transaction) => transaction,
            Err(error) => {
                // Others may be luckier.
                let first = self.lock().pop_front();
                return first.into_iter().for_each(|entry| drop(entry.tell.send(Err(error.clone()))));
            }
        };
        let entries: Vec<Entry> = {
            let mut waiting = self.lock();
            let most = waiting.len().min(MOST);
            waiting.drain(..most).collect()
        };
        let outcomes = match keep_all(&mut transaction, &entries, quotas).await {
            Ok((outcomes, true)) => transaction.commit().await.map(|()| outcomes),
            Ok((outcomes, false)) => transaction.rollback().await.map(|()| outcomes),
            Err(error) => Err(error),
        };
        match outcomes {
            Ok(outcomes) => {
                for (entry, outcome) in entries.into_iter().zip(outcomes) {
                    // Kept, whether its sender still listens or not.
                    drop(entry.tell.send(outcome));
                }
            }
            Err(error) => entries.into_iter().for_each(|entry| drop(entry.tell.send(Err(error.clone())))),
        }
    }

    /// How many wait.
    #[cfg(test)]
    pub(super) fn waiting(&self) -> usize {
        self.lock().len()
    }

    fn lock(&self) -> MutexGuard<'_, VecDeque<Entry>> {
        // Every change is a single push or removal.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What became of each within one transaction, and whether there is anything to commit.
///
/// Errors if the transaction itself is lost, as on a full disk: then nothing of it is kept.
async fn keep_all(
    connection: &mut AnyConnection,
    entries: &[Entry],
    quotas: &Quotas,
) -> Result<(Vec<Result<Kept, StoreError>>, bool), StoreError> {
    let (mut outcomes, mut any) = (Vec::with_capacity(entries.len()), false);
    for entry in entries {
        sqlx::query("SAVEPOINT one").execute(&mut *connection).await?;
        let outcome = keep(connection, &entry.new, quotas).await;
        if let Err(error) = &outcome {
            // Where the database has undone everything by itself there is nothing to go back to, and the reason is this one.
            let back = sqlx::query("ROLLBACK TO SAVEPOINT one").execute(&mut *connection).await;
            back.map_err(|_| error.clone())?;
        }
        sqlx::query("RELEASE SAVEPOINT one").execute(&mut *connection).await?;
        any |= matches!(outcome, Ok((_, true)));
        outcomes.push(outcome.map(|(kept, _)| kept));
    }
    Ok((outcomes, any))
}
