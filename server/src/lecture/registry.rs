//! All lectures, bounded in number, closed when their presenter is gone.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use axum::http::StatusCode;

use super::{KeptLecture, Lecture, named};
use crate::limits::Limits;
use crate::nodes::Node;
use crate::problem::Problem;
use crate::session::Session;

/// The lectures of one server.
#[derive(Debug, Default)]
pub struct Lectures {
    /// The server, whose name is in the codes.
    node: Node,
    open: Mutex<BTreeMap<String, Arc<Lecture>>>,
}

impl Lectures {
    /// No lecture yet, in that server.
    pub fn of(node: Node) -> Self {
        Self { node, ..Self::default() }
    }

    /// Opens a lecture for a session, under a new code or under the name that its presenter chose: where a lecture is open under
    /// that, it goes on with the session. Needs the async runtime. Errors if there are as many lectures as allowed.
    pub fn open(
        &self,
        session: Arc<Session>,
        named: Option<String>,
        limits: &Limits,
    ) -> Result<Arc<Lecture>, Problem> {
        self.expire(limits);
        let mut open = self.lock();
        if let Some(lecture) = named.as_ref().and_then(|name| open.get(name)) {
            lecture.take_up(session);
            return Ok(Arc::clone(lecture));
        }
        if open.len() >= limits.lectures {
            return Err(Problem::new(
                StatusCode::SERVICE_UNAVAILABLE,
                "too-many-rooms",
                format!("all {} lecture rooms of this server are in use", limits.lectures),
                "close a room that is no longer needed, or start the server with a larger --max-rooms",
            ));
        }
        let mut codes = std::iter::repeat_with(|| self.node.code());
        let code = named.or_else(|| codes.find(|code| !open.contains_key(code))).unwrap_or_default();
        let lecture = Lecture::open(code.clone(), session, limits.followers);
        open.insert(code, Arc::clone(&lecture));
        Ok(lecture)
    }

    /// Goes on with a lecture that was kept. Needs the async runtime.
    pub fn resume(&self, kept: KeptLecture, session: Arc<Session>, limits: &Limits) {
        let lecture = Lecture::resume(kept, session, limits.followers);
        self.lock().insert(lecture.code.clone(), lecture);
    }

    /// What is needed to go on with all of them after a restart.
    pub fn keep(&self) -> Vec<KeptLecture> {
        self.lock().values().filter_map(|lecture| lecture.keep()).collect()
    }

    /// Lets go of all followers, who may come back after a restart.
    pub fn leave(&self) {
        self.lock().values().for_each(|lecture| lecture.leave());
    }

    /// The lecture with that code or name, in capitals or not. Errors if there is none.
    pub fn get(&self, code: &str) -> Result<Arc<Lecture>, Problem> {
        let code = named::written(code);
        self.lock().get(&code).cloned().ok_or_else(|| {
            Problem::new(
                StatusCode::NOT_FOUND,
                "unknown-room",
                format!("there is no lecture room {code}"),
                "check the code; the lecture may be over",
            )
        })
    }

    /// Closes a lecture.
    pub fn close(&self, code: &str) {
        if let Some(lecture) = self.lock().remove(code) {
            lecture.close();
        }
    }

    /// Closes lectures whose presenter has not been heard of for long, and those that are too old.
    pub fn expire(&self, limits: &Limits) {
        self.lock().retain(|_, lecture| {
            let (silent, age) = lecture.ages();
            let keep = silent < limits.lecture_idle && age < limits.lecture_life;
            if !keep {
                lecture.close();
            }
            keep
        });
    }

    /// Closes all lectures.
    pub fn clear(&self) {
        for lecture in std::mem::take(&mut *self.lock()).into_values() {
            lecture.close();
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.lock().len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn lock(&self) -> MutexGuard<'_, BTreeMap<String, Arc<Lecture>>> {
        self.open.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
