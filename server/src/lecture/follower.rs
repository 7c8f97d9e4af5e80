//! One follower of a lecture.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use axum::extract::ws::Utf8Bytes;
use axum::http::StatusCode;
use tokio::sync::watch;

use super::{Lecture, LiveView, Presence};
use crate::problem::Problem;

/// What a follower receives: the newest state, the newest public state, and the session whose recording is watched.
#[derive(Debug)]
pub struct Follower {
    /// What is shown.
    pub live: watch::Receiver<LiveView>,
    /// The newest state as it is sent.
    pub state: watch::Receiver<Utf8Bytes>,
    /// The newest public state as it is sent.
    pub public: watch::Receiver<Utf8Bytes>,
    pub(super) lecture: Arc<Lecture>,
    pub(super) presence: Presence,
}

impl Lecture {
    /// Joins as a follower. Errors if the lecture is full.
    pub fn join(self: &Arc<Self>) -> Result<Follower, Problem> {
        let before = self.followers.fetch_add(1, Ordering::Relaxed);
        let follower = Follower {
            live: self.live.subscribe(),
            state: self.state.subscribe(),
            public: self.public.subscribe(),
            lecture: Arc::clone(self),
            presence: Presence::default(),
        };
        if before >= self.max_followers {
            return Err(Problem::new(
                StatusCode::SERVICE_UNAVAILABLE,
                "room-full",
                format!("{} already follow this lecture, as many as this server takes", self.max_followers),
                "look on with a neighbour; the instructor can start the server with a larger --max-followers",
            ));
        }
        Ok(follower)
    }
}

impl Follower {
    /// What the follower lets the presenter know from now on.
    pub fn tell(&mut self, presence: Presence) {
        self.lecture.audience.change(self.presence, presence);
        self.presence = presence;
    }
}

impl Drop for Follower {
    fn drop(&mut self) {
        self.tell(Presence::default());
        self.lecture.followers.fetch_sub(1, Ordering::Relaxed);
    }
}
