//! Live simulations: each in a thread of its own, as many computing at a time as there are processors, all of them in one
//! bounded registry.

mod command;
mod recording;
mod registry;
mod turns;
mod worker;

pub use registry::{Registry, bounded};

use std::sync::mpsc;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use axum::http::StatusCode;
use serde::Deserialize;
use tokio::runtime::Handle;
use tokio::sync::{oneshot, watch};
use triad_engine::run::StateView;
use triad_engine::scene::Scene;
use triad_session::change::{Drag, SceneChange, SessionScene};
use triad_session::drawing::{Arrows, Camera};
use triad_session::{KeptSession, Run, SceneSource, SessionState};

use crate::aside;
use crate::limits::Limits;
use crate::problem::Problem;
use crate::stream::{Hub, Total, Watcher};
use command::{Command, Reply, ReplySender, Signals};
use recording::Recording;
pub(crate) use turns::Turns;
use worker::{Clock, Worker};

/// Commands that may wait for one session; more are refused.
const QUEUE: usize = 32;

/// Of what a session keeps, in sixteenths: samples take six and states half of that, as many of each; the numbers for the
/// page's drawing one, and three where the older ones are told in brief; recordings for the viewer two, and one likewise.
const OF_SAMPLES: usize = 6;
const OF_TRACK: usize = 1;
const OF_RECORDING: usize = 2;
const OF_BRIEF: usize = 1;

/// What the sessions of a server share.
#[derive(Debug, Clone, Default)]
pub(crate) struct Shared {
    /// Who may compute.
    pub turns: Turns,
    /// Bytes that are kept of what they have passed.
    pub kept: Total,
}

/// In which form a run is watched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Watched {
    /// Numbers, for a drawing of one's own: [`Track`](crate::stream::Track).
    Track,
    /// A recording for the rerun viewer.
    Recording,
}

/// What a watcher asks for in the address of a stream.
#[derive(Debug, Default, Clone, Copy, Deserialize)]
#[serde(default)]
pub struct StreamWish {
    /// The recording for the rerun viewer instead of the numbers for a drawing.
    recording: bool,
}

impl StreamWish {
    /// The form in which the run is watched.
    pub fn watched(self) -> Watched {
        if self.recording { Watched::Recording } else { Watched::Track }
    }
}

/// A handle on a live simulation; dropping the last one ends its thread.
#[derive(Debug)]
pub struct Session {
    commands: Arc<mpsc::SyncSender<Command>>,
    signals: Arc<Signals>,
    state: watch::Receiver<Arc<SessionState>>,
    hub: Arc<Hub>,
    track: Arc<Hub>,
    touched: Mutex<Instant>,
    /// Among whose sessions it counts, if it is somebody's.
    whose: Option<String>,
    asked_first: OnceLock<AskedFirst>,
}

/// Who has to predict something before a run goes on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AskedFirst {
    /// The person's id.
    pub person: String,
    /// Slug of the lesson that asks.
    pub lesson: String,
}

impl Session {
    /// Assembles a scene and starts its thread, under a name that was never used. Blocks until the scene is assembled; needs the
    /// async runtime.
    ///
    /// Errors if the scene or the change of it is refused, or the thread cannot be started.
    pub(crate) fn start(
        id: &str,
        original: Scene,
        change: &SceneChange,
        source: SceneSource,
        whose: Option<String>,
        shared: &Shared,
        limits: &Limits,
    ) -> Result<Self, Problem> {
        let run = Run::start(id.to_owned(), original, change, source, limits.kept_bytes(OF_SAMPLES))?;
        Ok(Self { whose, ..Self::begin(run, id, Clock::start(), shared, limits)? })
    }

    /// Goes on with a session that was kept, at the time and in the state of its run. Its recording begins anew.
    ///
    /// Errors if its scene is refused by this program, or the state is of another.
    pub(crate) fn resume(kept: KeptSession, shared: &Shared, limits: &Limits) -> Result<Self, Problem> {
        let clock = Clock::start();
        let Some(run) = Run::resume(kept, limits.kept_bytes(OF_SAMPLES), clock.now())? else {
            return Err(Problem::internal("a session was kept that is none of this program"));
        };
        // Viewers would join a recording of the same name to the one before.
        let recording = uuid::Uuid::new_v4().simple().to_string();
        Self::begin(run, &recording, clock, shared, limits)
    }

    /// Starts the thread of a session.
    fn begin(
        run: Run,
        recording: &str,
        clock: Clock,
        shared: &Shared,
        limits: &Limits,
    ) -> Result<Self, Problem> {
        let [hub, track] = [OF_RECORDING, OF_TRACK]
            .map(|part| Arc::new(Hub::new(limits.kept_bytes(part), shared.kept.part())));
        let [hub_of_recording, hub_of_track] = [&hub, &track].map(Arc::clone);
        let brief = limits.kept_bytes(OF_BRIEF);
        let recording = Recording::new(recording, run.samples(), hub_of_recording, hub_of_track, brief);
        let signals = Arc::new(Signals::default());
        let (sender, state) =
            watch::channel(Arc::new(run.state(recording.streamed(), crate::problem::trace_id)));
        let (commands, received) = mpsc::sync_channel(QUEUE);
        let commands = Arc::new(commands);
        let worker = Worker {
            run,
            recording,
            clock,
            signals: Arc::clone(&signals),
            state: sender,
            command_time: limits.command_time,
            commands: Arc::downgrade(&commands),
            turns: shared.turns.clone(),
            kept: shared.kept.part(),
            runtime: Handle::try_current().map_err(Problem::internal)?,
            in_line: false,
            next_tick: Instant::now(),
        };
        std::thread::Builder::new()
            .name("triad-session".into())
            .spawn(move || {
                aside::step_back();
                worker.run(&received);
            })
            .map_err(Problem::internal)?;
        Ok(Self {
            commands,
            signals,
            state,
            hub,
            track,
            touched: Mutex::new(Instant::now()),
            whose: None,
            asked_first: OnceLock::new(),
        })
    }

    /// The state now.
    pub fn state(&self) -> Arc<SessionState> {
        self.touch();
        let state = Arc::clone(&self.state.borrow());
        // A run that stands still tells nothing new when somebody leaves.
        let watchers = self.watchers();
        if state.watchers == watchers {
            state
        } else {
            Arc::new(SessionState { watchers, ..(*state).clone() })
        }
    }

    /// From now on the run waits for the predictions of who opened it.
    pub fn ask_first(&self, asked: AskedFirst) {
        self.asked_first.get_or_init(|| asked);
    }

    /// For whose predictions the run waits.
    pub fn asked_first(&self) -> Option<&AskedFirst> {
        self.asked_first.get()
    }

    /// Follows the state as it changes.
    pub fn states(&self) -> watch::Receiver<Arc<SessionState>> {
        self.state.clone()
    }

    /// Takes integrator steps.
    ///
    /// Errors if the engine cannot go on, the time budget is spent, or the session is busy or closed.
    pub async fn steps(&self, count: u32) -> Result<Arc<SessionState>, Problem> {
        self.ask(|reply| Command::Steps(count, reply)).await
    }

    /// Lets simulated seconds pass.
    ///
    /// Errors as [`Self::steps`] does.
    pub async fn seconds(&self, seconds: f64) -> Result<Arc<SessionState>, Problem> {
        self.ask(|reply| Command::Seconds(seconds, reply)).await
    }

    /// Lets time run, `speed` simulated seconds a second.
    ///
    /// Errors if the run has stopped, or the session is busy or closed.
    pub async fn play(&self, speed: f64) -> Result<Arc<SessionState>, Problem> {
        self.ask(|reply| Command::Play(speed, reply)).await
    }

    /// Stops time, also in the middle of a long step.
    ///
    /// Errors if the session is busy or closed.
    pub async fn pause(&self) -> Result<Arc<SessionState>, Problem> {
        self.ask_urgently(Command::Pause).await
    }

    /// Goes back to the start and begins another recording.
    ///
    /// Errors if the scene cannot be assembled again, or the session is busy or closed.
    pub async fn reset(&self) -> Result<Arc<SessionState>, Problem> {
        self.ask_urgently(Command::Reset).await
    }

    /// Changes numbers of the scene; the run starts over or goes on.
    ///
    /// Errors if a change is refused, the run cannot go on with it, or the session is busy or closed.
    pub async fn change(&self, change: SceneChange) -> Result<Arc<SessionState>, Problem> {
        self.ask(|reply| Command::Change(change, reply)).await
    }

    /// Drags a body by a spring, or lets it go.
    ///
    /// Errors as [`Self::change`] does.
    pub async fn drag(&self, drag: Option<Drag>) -> Result<Arc<SessionState>, Problem> {
        self.ask(|reply| Command::Drag(drag, reply)).await
    }

    /// The scene as it is now.
    ///
    /// Errors if the session is busy or closed.
    pub async fn scene(&self) -> Result<SessionScene, Problem> {
        self.ask(Command::Scene).await
    }

    /// What is needed to go on with it after a restart.
    ///
    /// Errors if the session is busy or closed.
    pub async fn keep(&self) -> Result<KeptSession, Problem> {
        // Nobody has used it by this: it gets no younger.
        let (reply, answer) = oneshot::channel();
        self.commands.try_send(Command::Keep(reply)).map_err(|_| gone())?;
        answer.await.map_err(|_| gone())?
    }

    /// Reads something from the run as it is, or as it was at a time that it has passed. Errors if that time is not
    /// kept, and as `read` does.
    pub async fn query<T: Send + 'static>(
        &self,
        at: Option<f64>,
        read: impl FnOnce(&StateView<'_>) -> Result<T, Problem> + Send + 'static,
    ) -> Result<T, Problem> {
        self.ask(|reply| {
            Command::Query(at, Box::new(move |state| drop(reply.send(state.and_then(|state| read(&state))))))
        })
        .await
    }

    /// Draws forces in another way, in every picture; `fit` takes their scale from the recording.
    ///
    /// Errors if the recording is full, or the session is busy or closed.
    pub async fn draw(&self, arrows: Option<Arrows>, fit: bool) -> Result<Arc<SessionState>, Problem> {
        self.ask(|reply| Command::Draw(arrows, fit, reply)).await
    }

    /// Looks at the mechanism from another side.
    ///
    /// Errors as [`Self::draw`] does.
    pub async fn look_from(&self, camera: Camera) -> Result<Arc<SessionState>, Problem> {
        self.ask(|reply| Command::LookFrom(camera, reply)).await
    }

    /// Watches the run from its beginning.
    pub fn watch(&self, what: Watched) -> Watcher {
        self.touch();
        let hub = match what {
            Watched::Track => &self.track,
            Watched::Recording => &self.hub,
        };
        let watcher = hub.watch();
        // A queue that is full has a worker that is busy, and it looks for watchers when it is done.
        if self.signals.announce() && self.commands.try_send(Command::Watched).is_err() {
            self.signals.looked();
        }
        watcher
    }

    async fn ask<T>(&self, command: impl FnOnce(ReplySender<T>) -> Command) -> Result<T, Problem> {
        self.send(command)?.await.map_err(|_| gone())?
    }

    /// Asks for what must not wait: it ends what is under way.
    async fn ask_urgently<T>(&self, command: impl FnOnce(ReplySender<T>) -> Command) -> Result<T, Problem> {
        self.signals.hurry();
        let answer = self.send(command).inspect_err(|_| self.signals.obeyed())?;
        answer.await.map_err(|_| gone())?
    }

    fn send<T>(&self, command: impl FnOnce(ReplySender<T>) -> Command) -> Result<Reply<T>, Problem> {
        self.touch();
        let (reply, answer) = oneshot::channel();
        self.commands.try_send(command(reply)).map_err(|refused| match refused {
            mpsc::TrySendError::Full(_) => Problem::new(
                StatusCode::SERVICE_UNAVAILABLE,
                "session-busy",
                "the session has too many requests waiting",
                "wait until the earlier ones are answered, or pause the session",
            ),
            mpsc::TrySendError::Disconnected(_) => gone(),
        })?;
        Ok(answer)
    }

    fn touch(&self) {
        *self.touched.lock().unwrap_or_else(PoisonError::into_inner) = Instant::now();
    }

    /// How long nobody has asked for it or watched it.
    fn idle(&self) -> Duration {
        if self.is_watched() { Duration::ZERO } else { self.untouched() }
    }

    /// Whether somebody watches it now.
    fn is_watched(&self) -> bool {
        self.watchers() > 0
    }

    /// How many watch it now.
    fn watchers(&self) -> usize {
        self.hub.watchers() + self.track.watchers()
    }

    /// How long nobody has asked for it.
    fn untouched(&self) -> Duration {
        self.touched.lock().unwrap_or_else(PoisonError::into_inner).elapsed()
    }

    /// Among whose sessions it counts.
    fn whose(&self) -> Option<&str> {
        self.whose.as_deref()
    }

    /// Stops the thread as soon as it can leave its step.
    fn close(&self) {
        self.signals.close();
        // Wakes a thread that waits; one that is busy sees the flag.
        drop(self.commands.try_send(Command::Watched));
    }
}

fn gone() -> Problem {
    Problem::new(
        StatusCode::GONE,
        "session-closed",
        "the session was closed while it was asked",
        "start another session",
    )
}
