//! What all parts of the server share.

use std::path::Path;
use std::sync::Arc;

use triad_lessons::Course;

use crate::limits::Limits;
use crate::reports;
use crate::room::Rooms;
use crate::session::Registry;
use crate::store::Store;
use crate::variants::Variants;

/// The server's state; cheap to clone.
#[derive(Debug, Clone)]
pub struct App {
    /// The lessons, with their answers: they stay in here.
    pub course: Arc<Course>,
    /// The lessons with students' own numbers.
    pub variants: Arc<Variants>,
    /// The gradebook.
    pub store: Arc<Store>,
    /// The live simulations.
    pub sessions: Arc<Registry>,
    /// The lectures.
    pub rooms: Arc<Rooms>,
    /// What this server allows.
    pub limits: Arc<Limits>,
    /// The folder with the reports of commands.
    pub reports: Arc<Path>,
}

impl App {
    /// A server with a course, a gradebook and its bounds; no session yet.
    pub fn new(course: Course, store: Store, limits: Limits) -> Self {
        Self {
            course: Arc::new(course),
            variants: Arc::default(),
            store: Arc::new(store),
            sessions: Arc::default(),
            rooms: Arc::default(),
            limits: Arc::new(limits),
            reports: Path::new(reports::FOLDER).into(),
        }
    }

    /// The same server, with reports in another folder.
    #[must_use]
    pub fn with_reports(self, folder: &Path) -> Self {
        Self { reports: folder.into(), ..self }
    }
}
