//! Who waits for something in the gradebook is woken when it comes: graders when something is handed in, students when their verdict
//! is there. What counts stands in the rows; a bell that is not heard costs a moment.

use std::time::Duration;

use sqlx::AnyConnection;
use sqlx::postgres::PgListener;
use tokio::sync::broadcast;
use tokio::time::{sleep, timeout};

use super::Store;
use super::error::StoreError;
use super::kind::Kind;

/// Graders that heard nothing look all the same after this.
const LOOK: Duration = Duration::from_secs(2);
/// Verdicts that somebody who waits may be behind; then they look for themselves.
const BEHIND: usize = 256;
/// Where a server of PostgreSQL tells of verdicts.
const VERDICTS: &str = "triad_verdict";

/// Tells those who wait in this program which verdicts are there.
#[derive(Debug)]
pub(super) struct Verdicts(broadcast::Sender<String>);

impl Default for Verdicts {
    fn default() -> Self {
        Self(broadcast::Sender::new(BEHIND))
    }
}

impl Verdicts {
    pub(super) fn tell(&self, id: &str) {
        // Nobody need wait.
        drop(self.0.send(id.to_owned()));
    }
}

impl Store {
    /// Wakes graders elsewhere as the transaction is committed.
    pub(super) async fn wake(&self, connection: &mut AnyConnection) -> Result<(), StoreError> {
        if Kind::of(connection) == Kind::Postgres {
            sqlx::query("SELECT pg_notify('triad_grading', '')").execute(connection).await?;
        }
        Ok(())
    }

    /// Tells other servers, as the transaction is committed, that a submission has its verdict.
    pub(super) async fn tell_verdict(
        &self,
        connection: &mut AnyConnection,
        id: &str,
    ) -> Result<(), StoreError> {
        if Kind::of(connection) == Kind::Postgres {
            sqlx::query("SELECT pg_notify('triad_verdict', $1)").bind(id).execute(connection).await?;
        }
        Ok(())
    }

    /// What wakes graders of this gradebook.
    ///
    /// Errors if the server cannot be reached.
    pub async fn bell(&self) -> Result<Bell<'_>, StoreError> {
        let mut listener = None;
        if let Some(url) = &self.server {
            let mut one = PgListener::connect(url).await?;
            one.listen("triad_grading").await?;
            listener = Some(one);
        }
        Ok(Bell { store: self, listener })
    }

    /// Hears for ever which verdicts graders of other programs give, for those who wait here.
    pub async fn hear_verdicts(&self) {
        let Some(url) = &self.server else { return };
        loop {
            if let Ok(mut listener) = PgListener::connect(url).await
                && listener.listen(VERDICTS).await.is_ok()
            {
                while let Ok(verdict) = listener.recv().await {
                    self.verdicts.tell(verdict.payload());
                }
            }
            sleep(LOOK).await;
        }
    }

    /// Begins to wait for a verdict: to be called before one looks whether it is there.
    pub fn await_verdict(&self, id: &str) -> Awaited {
        Awaited { id: id.to_owned(), told: self.verdicts.0.subscribe() }
    }
}

/// A verdict that somebody waits for.
#[derive(Debug)]
pub struct Awaited {
    id: String,
    told: broadcast::Receiver<String>,
}

impl Awaited {
    /// Waits until it is there, or may be, or so much time has passed.
    pub async fn within(mut self, time: Duration) {
        let comes = async {
            // Who has missed some looks.
            while let Ok(told) = self.told.recv().await {
                if told == self.id {
                    return;
                }
            }
        };
        drop(timeout(time, comes).await);
    }
}

/// Wakes a grader when something comes, and now and then without that: a bell that is not heard costs two seconds.
#[derive(Debug)]
pub struct Bell<'a> {
    store: &'a Store,
    listener: Option<PgListener>,
}

impl Bell<'_> {
    /// Waits until there may be work.
    pub async fn rings(&mut self) {
        let Some(listener) = &mut self.listener else {
            drop(timeout(LOOK, self.store.work.notified()).await);
            return;
        };
        // Where the connection is gone it is made again; until then the clock alone wakes.
        if let Ok(Err(_)) = timeout(LOOK, listener.recv()).await {
            sleep(LOOK).await;
        }
    }
}
