//! The bounds that keep one server alive for a whole class.
//!
//! Each bound that is hit is a clear [`Problem`](crate::problem::Problem), never an exhausted machine.

use std::time::Duration;

/// What one server allows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Limits {
    /// Live sessions at a time.
    pub sessions: usize,
    /// Live sessions of one student of a class at a time: nobody takes all places.
    pub sessions_each: usize,
    /// Bodies in a scene, checked before anything is built from it.
    pub bodies: usize,
    /// Bodies in a scene that is analysed: equilibria and modes take dense matrices, whose work grows with the cube.
    pub analysed_bodies: usize,
    /// Joints, drivers and loads in a scene together.
    pub connections: usize,
    /// Bytes of a request's body.
    pub request_bytes: usize,
    /// A session that nobody watches or asks for this long is closed.
    pub idle: Duration,
    /// Wall-clock time that one request may keep the engine busy.
    pub command_time: Duration,
    /// Bytes that are kept of what a session has passed: samples, states, and what is sent of them.
    pub recording_bytes: usize,
    /// The same of all sessions together: where there may be many, each keeps less.
    pub recordings_bytes: usize,
    /// A viewer that takes no data for this long is disconnected.
    pub stalled_viewer: Duration,
    /// What cannot be graded within this is graded later, where graders share the gradebook.
    pub at_once: Duration,
    /// Submissions returned by one request.
    pub submissions: usize,
    /// Lectures at a time.
    pub lectures: usize,
    /// Followers of one lecture.
    pub followers: usize,
    /// A lecture whose presenter has not been heard of for this long is closed.
    pub lecture_idle: Duration,
    /// A lecture of this age is closed.
    pub lecture_life: Duration,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            sessions: 64,
            sessions_each: 4,
            bodies: 500,
            analysed_bodies: 60,
            connections: 2000,
            request_bytes: 8 << 20,
            idle: Duration::from_mins(30),
            command_time: Duration::from_mins(1),
            recording_bytes: 16 << 20,
            recordings_bytes: 1 << 30,
            stalled_viewer: Duration::from_secs(30),
            at_once: Duration::from_millis(300),
            submissions: 1000,
            lectures: 16,
            followers: 500,
            lecture_idle: Duration::from_mins(30),
            lecture_life: Duration::from_hours(12),
        }
    }
}

impl Limits {
    /// Bytes that one session keeps of what it has passed, as far as they are given to `part` of sixteen.
    pub(crate) fn kept_bytes(&self, part: usize) -> usize {
        self.recording_bytes.min(self.recordings_bytes / self.sessions.max(1)) / 16 * part
    }
}
