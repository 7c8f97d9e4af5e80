//! What all parts of the server share.

use std::sync::Arc;

use triad_lessons::Course;

use crate::limits::Limits;
use crate::session::Registry;
use crate::store::Store;

/// The server's state; cheap to clone.
#[derive(Debug, Clone)]
pub struct App {
    /// The lessons, with their answers: they stay in here.
    pub course: Arc<Course>,
    /// The gradebook.
    pub store: Arc<Store>,
    /// The live simulations.
    pub sessions: Arc<Registry>,
    /// What this server allows.
    pub limits: Arc<Limits>,
}

impl App {
    /// A server with a course, a gradebook and its bounds; no session yet.
    pub fn new(course: Course, store: Store, limits: Limits) -> Self {
        Self {
            course: Arc::new(course),
            store: Arc::new(store),
            sessions: Arc::default(),
            limits: Arc::new(limits),
        }
    }
}
