//! All live sessions.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use axum::http::StatusCode;
use triad_engine::scene::Scene;
use triad_session::bounds::SceneBounds;
use triad_session::change::SceneChange;
use triad_session::{KeptSession, SceneSource};

use super::{Session, Shared};
use crate::limits::Limits;
use crate::nodes::Node;
use crate::problem::Problem;

/// The sessions of one server, bounded in number, closed when nobody wants them any more.
#[derive(Debug, Default)]
pub struct Registry {
    /// The server, whose name is in the ids.
    node: Node,
    sessions: Mutex<Sessions>,
    shared: Shared,
}

#[derive(Debug, Default)]
struct Sessions {
    live: BTreeMap<String, Arc<Session>>,
    /// Being assembled, by whose they are: they take a place already.
    coming: Vec<Option<String>>,
}

impl Sessions {
    /// Closes what somebody who has all their sessions used longest ago and does not look at.
    ///
    /// Errors if they look at all of them.
    fn make_room(&mut self, whose: &str, limits: &Limits) -> Result<(), Problem> {
        let is_theirs = |other: Option<&str>| other == Some(whose);
        let coming = self.coming.iter().filter(|other| is_theirs(other.as_deref())).count();
        let theirs = self.live.iter().filter(|(_, session)| is_theirs(session.whose()));
        if coming + theirs.clone().count() < limits.sessions_each {
            return Ok(());
        }
        let unseen = theirs.filter(|(_, session)| !session.is_watched());
        let Some((id, _)) = unseen.max_by_key(|(_, session)| session.untouched()) else {
            let all =
                format!("you look at {} runs already, as many as one may have here", limits.sessions_each);
            return Err(too_many(all, limits));
        };
        let id = id.clone();
        if let Some(session) = self.live.remove(&id) {
            session.close();
        }
        Ok(())
    }
}

impl Registry {
    /// No session yet, in that server.
    pub fn of(node: Node) -> Self {
        Self { node, ..Self::default() }
    }

    /// Starts a session, for somebody of a class whose sessions are counted (`whose`) or for anybody. Blocks until its scene is
    /// assembled.
    ///
    /// Errors if there are as many as allowed, of everybody or of this one, or the scene is refused.
    pub fn start(
        &self,
        scene: Scene,
        change: &SceneChange,
        source: SceneSource,
        whose: Option<String>,
        limits: &Limits,
    ) -> Result<Arc<Session>, Problem> {
        bounded(&scene, limits)?;
        self.expire(limits);
        {
            let mut sessions = self.lock();
            if let Some(whose) = &whose {
                sessions.make_room(whose, limits)?;
            }
            if sessions.live.len() + sessions.coming.len() >= limits.sessions {
                return Err(too_many(
                    format!("all {} sessions of this server are in use", limits.sessions),
                    limits,
                ));
            }
            sessions.coming.push(whose.clone());
        }
        let place = Place(self, whose.clone());
        let id = self.node.identifier();
        let session = Arc::new(Session::start(&id, scene, change, source, whose, &self.shared, limits)?);
        self.lock().live.insert(session.state().id.clone(), Arc::clone(&session));
        drop(place);
        Ok(session)
    }

    /// Goes on with a session that was kept. Blocks until its scene is assembled.
    ///
    /// Errors if its scene is refused.
    pub fn resume(&self, kept: KeptSession, limits: &Limits) -> Result<Arc<Session>, Problem> {
        let id = kept.id().to_owned();
        let session = Arc::new(Session::resume(kept, &self.shared, limits)?);
        self.lock().live.insert(id, Arc::clone(&session));
        Ok(session)
    }

    /// The name of the server; empty where it is alone.
    pub fn node(&self) -> &str {
        self.node.name()
    }

    /// All of them.
    pub fn all(&self) -> Vec<Arc<Session>> {
        self.lock().live.values().cloned().collect()
    }

    /// The session called `id`.
    ///
    /// Errors if there is none.
    pub fn get(&self, id: &str) -> Result<Arc<Session>, Problem> {
        self.lock().live.get(id).cloned().ok_or_else(|| unknown(id))
    }

    /// Closes the session called `id`.
    ///
    /// Errors if there is none.
    pub fn remove(&self, id: &str) -> Result<(), Problem> {
        let session = self.lock().live.remove(id).ok_or_else(|| unknown(id))?;
        session.close();
        Ok(())
    }

    /// Closes sessions that have been idle too long.
    pub fn expire(&self, limits: &Limits) {
        self.lock().live.retain(|_, session| {
            let keep = session.idle() < limits.idle;
            if !keep {
                session.close();
            }
            keep
        });
    }

    /// Closes all sessions.
    pub fn clear(&self) {
        let live = std::mem::take(&mut self.lock().live);
        for session in live.values() {
            session.close();
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.lock().live.len()
    }

    /// How many of them wait for their turn to go on.
    pub fn waiting(&self) -> usize {
        self.shared.turns.waiting()
    }

    /// Bytes that are kept of what they have passed, also of those that were closed and are still watched.
    pub fn bytes(&self) -> usize {
        self.shared.kept.bytes()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn lock(&self) -> MutexGuard<'_, Sessions> {
        // Counts and map are changed together under one lock, each in a single statement.
        self.sessions.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A place held for a session that is being assembled; given back however that ends.
struct Place<'a>(&'a Registry, Option<String>);

impl Drop for Place<'_> {
    fn drop(&mut self) {
        let mut sessions = self.0.lock();
        if let Some(place) = sessions.coming.iter().position(|whose| *whose == self.1) {
            sessions.coming.swap_remove(place);
        }
    }
}

fn too_many(detail: String, limits: &Limits) -> Problem {
    Problem::new(
        StatusCode::SERVICE_UNAVAILABLE,
        "too-many-sessions",
        detail,
        format!(
            "delete a session that is no longer needed; idle ones are closed after {} minutes",
            limits.idle.as_secs() / 60
        ),
    )
}

/// Refuses a scene that is too large for this server before anything is built from it.
pub fn bounded(scene: &Scene, limits: &Limits) -> Result<(), Problem> {
    let bounds = SceneBounds { bodies: limits.bodies, connections: limits.connections };
    Ok(bounds.hold(scene, "this server")?)
}

fn unknown(id: &str) -> Problem {
    Problem::new(
        StatusCode::NOT_FOUND,
        "unknown-session",
        format!("there is no session {id}"),
        "it may have been deleted, or closed because nobody used it; start another with POST /api/v1/sessions",
    )
}

#[cfg(test)]
mod tests {
    use triad_engine::scene::catalogue;

    use super::super::Turns;
    use super::*;

    #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
    async fn a_run_that_waits_for_its_turn_stands_still_and_answers_and_goes_on_in_its_turn() {
        let shared = Shared { turns: Turns::of(1), ..Shared::default() };
        let registry = Registry { shared, ..Registry::default() };
        let busy = registry.shared.turns.now().expect("free");
        let scene = catalogue::scene("simple-pendulum").expect("built in");
        let source = SceneSource::Builtin("simple-pendulum".into());
        let start = registry.start(scene, &SceneChange::default(), source, None, &Limits::default());
        let session = start.expect("a pendulum");
        session.play(1.0).await.expect("plays");
        while registry.waiting() == 0 {
            tokio::task::yield_now().await;
        }
        let asked = session.query(None, |run| Ok(run.time())).await.expect("answers");
        assert_eq!((asked, session.state().time, session.state().playing), (0.0, 0.0, true));
        let step = session.seconds(0.1);
        tokio::pin!(step);
        while registry.waiting() < 2 {
            tokio::select! {
                biased;
                _ = &mut step => panic!("two compute at a time"),
                () = tokio::task::yield_now() => {}
            }
        }
        let (stepped, paused) = tokio::join!(step, session.pause());
        assert!(!paused.expect("at once").playing);
        assert_eq!(stepped.expect("ended by the pause").time, 0.0);
        session.play(1.0).await.expect("plays");
        drop(busy);
        let mut states = session.states();
        states.wait_for(|state| state.time > 0.0).await.expect("goes on");
        session.pause().await.expect("pauses");
        while registry.waiting() > 0 {
            tokio::task::yield_now().await;
        }
        assert!(registry.shared.turns.now().is_some(), "given back");
    }
}
