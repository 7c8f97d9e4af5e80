//! What lives, over a restart: sessions and lecture rooms are written beside the gradebook as the server stops, and go on at the
//! same time and state when it is back. Rooms are written now and then besides, so that a lecture survives a crash too.

use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use tokio::time::timeout;
use triad_session::KeptSession;

use crate::lecture::{KeptLecture, Lectures};
use crate::limits::Limits;
use crate::session::{Registry, Session, bounded};

/// How long a session may take to say where it stands: one in the middle of a long step is left behind.
const PATIENCE: Duration = Duration::from_secs(1);

/// What is written.
#[derive(Debug, Default, Serialize, Deserialize)]
struct Kept {
    /// The server's name among several: it stands in those of the sessions.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    node: String,
    sessions: Vec<KeptSession>,
    rooms: Vec<KeptLecture>,
}

/// The file for a gradebook.
pub fn beside(database: &Path) -> PathBuf {
    let mut name = database.to_owned().into_os_string();
    name.push(".live");
    name.into()
}

/// Which sessions are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Which {
    /// All: the server stops.
    All,
    /// Those that lectures show: in case that it crashes.
    Shown,
}

/// Writes what lives; removes the file where nothing does.
///
/// Errors if the file cannot be written.
pub async fn keep(path: &Path, sessions: &Registry, lectures: &Lectures, which: Which) -> io::Result<()> {
    let rooms = lectures.keep();
    let wanted: Vec<Arc<Session>> = match which {
        Which::All => sessions.all(),
        Which::Shown => rooms.iter().filter_map(|room| sessions.get(&room.session).ok()).collect(),
    };
    let asked: Vec<_> = wanted
        .into_iter()
        .map(|session| tokio::spawn(async move { timeout(PATIENCE, session.keep()).await }))
        .collect();
    let mut kept = Kept { node: sessions.node().to_owned(), sessions: Vec::new(), rooms };
    for one in asked {
        if let Ok(Ok(Ok(session))) = one.await {
            kept.sessions.push(session);
        }
    }
    if kept.sessions.is_empty() {
        return fs::remove_file(path).or_else(|error| match error.kind() {
            io::ErrorKind::NotFound => Ok(()),
            _ => Err(error),
        });
    }
    // Who knows the name of a session steers it: the file is its owner's alone.
    let part = path.with_extension("live-part");
    let mut options = OpenOptions::new();
    options.write(true).create(true).truncate(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    options.open(&part)?.write_all(&serde_json::to_vec(&kept)?)?;
    fs::rename(&part, path)
}

/// The name among several servers under which was written what is there.
pub fn name(path: &Path) -> Option<String> {
    let kept: Kept = serde_json::from_slice(&fs::read(path).ok()?).ok()?;
    Some(kept.node).filter(|name| !name.is_empty())
}

/// Goes on with what was written; how many sessions came back. Each counts once: the file is removed before anything is begun,
/// so that what cannot be begun does not keep the server from starting. Needs the async runtime.
pub fn bring_back(path: &Path, sessions: &Registry, lectures: &Lectures, limits: &Limits) -> usize {
    let Ok(bytes) = fs::read(path) else { return 0 };
    drop(fs::remove_file(path));
    // What another version wrote differently is forgotten, as a session is that expires.
    let kept: Kept = serde_json::from_slice(&bytes).unwrap_or_default();
    let fits = |session: &KeptSession| bounded(session.scene(), limits).is_ok();
    for session in kept.sessions.into_iter().filter(fits).take(limits.sessions) {
        drop(sessions.resume(session, limits));
    }
    for room in kept.rooms.into_iter().take(limits.lectures) {
        if let Ok(session) = sessions.get(&room.session) {
            lectures.resume(room, session, limits);
        }
    }
    sessions.len()
}
