//! The commands of a session's thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use tokio::sync::{Notify, OwnedSemaphorePermit, oneshot};
use triad_engine::run::StateView;
use triad_session::change::{Drag, SceneChange, SessionScene};
use triad_session::drawing::{Arrows, Camera};
use triad_session::{KeptSession, SessionState};

use crate::problem::Problem;

/// What a caller may ask for; the answer comes back through the sender.
pub(super) enum Command {
    /// Take integrator steps.
    Steps(u32, ReplySender<Arc<SessionState>>),
    /// Let simulated seconds pass.
    Seconds(f64, ReplySender<Arc<SessionState>>),
    /// Let time run at so many simulated seconds a second.
    Play(f64, ReplySender<Arc<SessionState>>),
    /// Stop time.
    Pause(ReplySender<Arc<SessionState>>),
    /// Go back to the start.
    Reset(ReplySender<Arc<SessionState>>),
    /// Change numbers of the scene.
    Change(SceneChange, ReplySender<Arc<SessionState>>),
    /// Drag a body by a spring, or let it go.
    Drag(Option<Drag>, ReplySender<Arc<SessionState>>),
    /// Give what is needed to go on after a restart.
    Keep(ReplySender<KeptSession>),
    /// Give the scene.
    Scene(ReplySender<SessionScene>),
    /// Read something from the run as it is, or as it was at a time.
    Query(Option<f64>, Query),
    /// Draw forces in another way; take their scale from the recording.
    Draw(Option<Arrows>, bool, ReplySender<Arc<SessionState>>),
    /// Look at the mechanism from another side.
    LookFrom(Camera, ReplySender<Arc<SessionState>>),
    /// Somebody has come to watch.
    Watched,
    /// It is the run's turn to go on.
    Turn(Turn),
}

/// The right to compute a run, until it is dropped.
#[derive(Debug)]
pub(super) struct Turn(
    #[allow(dead_code, reason = "held, and given back as it is dropped")] pub(super) OwnedSemaphorePermit,
);

/// Where an answer goes; the caller may have left.
pub(super) type ReplySender<T> = oneshot::Sender<Result<T, Problem>>;

/// Where an answer comes from.
pub(super) type Reply<T> = oneshot::Receiver<Result<T, Problem>>;

/// Reads from the state of the time that was asked for, or learns why it cannot.
pub(super) type Query = Box<dyn FnOnce(Result<StateView<'_>, Problem>) + Send>;

/// What reaches a worker while it is busy.
#[derive(Debug, Default)]
pub(super) struct Signals {
    /// Commands that wait and are urgent: what is under way ends, and what waits before them is not begun.
    urgent: AtomicUsize,
    /// The session is closed.
    closed: AtomicBool,
    /// A word that somebody has come to watch waits already.
    announced: AtomicBool,
    /// Wakes a worker that waits for its turn.
    changed: Notify,
}

impl Signals {
    /// An urgent command is on its way.
    pub(super) fn hurry(&self) {
        self.urgent.fetch_add(1, Ordering::Relaxed);
        self.changed.notify_one();
    }

    /// An urgent command is begun, or could not be sent.
    pub(super) fn obeyed(&self) {
        self.urgent.fetch_sub(1, Ordering::Relaxed);
    }

    /// Ends the session.
    pub(super) fn close(&self) {
        self.closed.store(true, Ordering::Relaxed);
        self.changed.notify_one();
    }

    /// Waits until somebody hurries or closes it: for its one worker.
    pub(super) async fn changed(&self) {
        self.changed.notified().await;
    }

    /// Whether the session has ended.
    pub(super) fn closed(&self) -> bool {
        self.closed.load(Ordering::Relaxed)
    }

    /// Somebody has come to watch; whether the worker must still be told. A whole lecture hall that comes at once
    /// takes one place in the queue.
    pub(super) fn announce(&self) -> bool {
        !self.announced.swap(true, Ordering::AcqRel)
    }

    /// The worker looks at who watches now, or could not be told.
    pub(super) fn looked(&self) {
        self.announced.store(false, Ordering::Release);
    }

    /// Whether what is under way is to end.
    pub(super) fn interrupted(&self) -> bool {
        self.closed() || self.urgent.load(Ordering::Relaxed) > 0
    }
}
