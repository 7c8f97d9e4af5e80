//! All live sessions.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use axum::http::StatusCode;
use triad_engine::scene::Scene;
use triad_session::bounds::SceneBounds;
use triad_session::change::SceneChange;
use triad_session::{KeptSession, SceneSource};

use super::Session;
use crate::limits::Limits;
use crate::problem::Problem;

/// The sessions of one server, bounded in number, closed when nobody wants them any more.
#[derive(Debug, Default)]
pub struct Registry {
    sessions: Mutex<Sessions>,
}

#[derive(Debug, Default)]
struct Sessions {
    live: BTreeMap<String, Arc<Session>>,
    /// Being assembled: they take a place already.
    coming: usize,
}

impl Registry {
    /// Starts a session. Blocks until its scene is assembled.
    ///
    /// Errors if there are as many as allowed, or the scene is refused.
    pub fn start(
        &self,
        scene: Scene,
        change: &SceneChange,
        source: SceneSource,
        limits: &Limits,
    ) -> Result<Arc<Session>, Problem> {
        bounded(&scene, limits)?;
        self.expire(limits);
        {
            let mut sessions = self.lock();
            if sessions.live.len() + sessions.coming >= limits.sessions {
                return Err(Problem::new(
                    StatusCode::SERVICE_UNAVAILABLE,
                    "too-many-sessions",
                    format!("all {} sessions of this server are in use", limits.sessions),
                    format!(
                        "delete a session that is no longer needed; idle ones are closed after {} minutes",
                        limits.idle.as_secs() / 60
                    ),
                ));
            }
            sessions.coming += 1;
        }
        let place = Place(self);
        let session = Arc::new(Session::start(scene, change, source, limits)?);
        self.lock().live.insert(session.state().id.clone(), Arc::clone(&session));
        drop(place);
        Ok(session)
    }

    /// Goes on with a session that was kept. Blocks until its scene is assembled.
    ///
    /// Errors if its scene is refused.
    pub fn resume(&self, kept: KeptSession, limits: &Limits) -> Result<Arc<Session>, Problem> {
        let id = kept.id().to_owned();
        let session = Arc::new(Session::resume(kept, limits)?);
        self.lock().live.insert(id, Arc::clone(&session));
        Ok(session)
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
struct Place<'a>(&'a Registry);

impl Drop for Place<'_> {
    fn drop(&mut self) {
        self.0.lock().coming -= 1;
    }
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
