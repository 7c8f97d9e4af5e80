//! What is kept of a session while the server is restarted.

use serde::{Deserialize, Serialize};
use triad_engine::run::Snapshot;
use triad_engine::scene::Scene;

use crate::accuracy::Since;
use crate::change::Drag;
use crate::happened::Happened;
use crate::state::SceneSource;

/// A session at one moment, as it goes on later: its scene and the state of the run, not its recording.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct KeptSession {
    pub(crate) id: String,
    pub(crate) source: SceneSource,
    /// The scene as its author wrote it.
    pub(crate) original: Scene,
    /// The scene that runs.
    pub(crate) scene: Scene,
    pub(crate) changes: u64,
    pub(crate) state: Snapshot,
    pub(crate) playing: bool,
    pub(crate) speed: f64,
    /// What is known of its errors.
    #[serde(default)]
    pub(crate) since: Since,
    /// What has happened.
    #[serde(default)]
    pub(crate) happened: Happened,
    /// The spring by which a body is dragged.
    #[serde(default)]
    pub(crate) drag: Option<Drag>,
}

impl KeptSession {
    /// Its name in addresses.
    pub fn id(&self) -> &str {
        &self.id
    }

    /// The scene that runs.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }
}
