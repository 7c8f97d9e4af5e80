//! The thread that owns a session's simulation: it serves commands, and advances time while the session plays.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use axum::http::StatusCode;
use tokio::sync::watch;
use triad_engine::run::Simulation;
use triad_engine::scene::Scene;

use super::change::{AfterChange, Drag, SceneChange, SessionScene, as_it_runs};
use super::command::{Command, Signals};
use super::history::History;
use super::kept::KeptSession;
use super::recording::{Recording, TICK, describe};
use super::state::{Drawing, SceneSource, SessionFacts, SessionState};
use crate::problem::Problem;

/// Integrator steps between two checks of the clock and of the signals of callers.
const STEPS_PER_CHECK: u64 = 32;

/// A session's simulation with all that belongs to it.
pub(super) struct Worker {
    pub id: String,
    pub source: SceneSource,
    pub title: String,
    /// The scene as its author wrote it.
    pub original: Scene,
    /// The scene that runs, without the spring of a drag.
    pub scene: Scene,
    pub changes: u64,
    pub drag: Option<Drag>,
    pub simulation: Simulation,
    pub recording: Recording,
    pub history: History,
    pub signals: Arc<Signals>,
    pub state: watch::Sender<Arc<SessionState>>,
    pub command_time: Duration,
    /// Set while time runs.
    pub play: Option<Play>,
    pub speed: f64,
    pub error: Option<Problem>,
}

/// A session that plays: the simulated time was `from`, in s, when the wall clock was at `since`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Play {
    since: Instant,
    from: f64,
}

impl Play {
    /// From this simulated time on.
    pub(super) fn from(time: f64) -> Self {
        Self { since: Instant::now(), from: time }
    }
}

impl Worker {
    /// Serves commands until the session is closed.
    pub(super) fn run(mut self, commands: &Receiver<Command>) {
        self.publish();
        let mut next_tick = Instant::now();
        while !self.signals.closed() {
            let received = if self.play.is_some() {
                commands.recv_timeout(next_tick.saturating_duration_since(Instant::now()))
            } else {
                commands.recv().map_err(|_| RecvTimeoutError::Disconnected)
            };
            match received {
                Ok(command) => self.handle(command),
                Err(RecvTimeoutError::Timeout) => {
                    next_tick = Instant::now() + TICK;
                    self.tick();
                }
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    }

    fn handle(&mut self, command: Command) {
        // A caller that has gone away no longer wants the answer: nothing is lost if it cannot be delivered.
        match command {
            Command::Steps(count, reply) => {
                let result = self.ready().and_then(|()| self.steps(count));
                drop(reply.send(self.answer(result)));
            }
            Command::Seconds(seconds, reply) => {
                let result = self.ready().and_then(|()| self.seconds(seconds));
                drop(reply.send(self.answer(result)));
            }
            Command::Play(speed, reply) => {
                let result = self.ready().map(|()| {
                    self.speed = speed;
                    self.play = Some(Play { since: Instant::now(), from: self.simulation.time() });
                });
                drop(reply.send(self.answer(result)));
            }
            Command::Pause(reply) => {
                self.signals.obeyed();
                self.play = None;
                drop(reply.send(self.answer(Ok(()))));
            }
            Command::Reset(reply) => {
                self.signals.obeyed();
                let result = self.reset();
                drop(reply.send(self.answer(result)));
            }
            Command::Change(change, reply) => {
                let result = self.change(&change);
                drop(reply.send(self.answer_to_change(result)));
            }
            Command::Drag(drag, reply) => {
                let result = self.drag(drag);
                drop(reply.send(self.answer_to_change(result)));
            }
            Command::Keep(reply) => drop(reply.send(Ok(self.kept()))),
            Command::Scene(reply) => drop(reply.send(Ok(SessionScene::new(&self.scene, &self.original)))),
            Command::Query(at, read) => match at.filter(|at| *at < self.simulation.time()) {
                None => read(Ok(self.simulation.state())),
                Some(time) => read(self.history.at(time, &self.simulation)),
            },
            Command::Draw(arrows, fit, reply) => {
                let drawn = arrows.map_or(Ok(()), |arrows| self.recording.draw(arrows));
                let result = drawn.and_then(|()| if fit { self.recording.fit(true) } else { Ok(()) });
                drop(reply.send(self.answer(result)));
            }
            Command::LookFrom(camera, reply) => {
                let result = self.recording.look_from(camera);
                drop(reply.send(self.answer(result)));
            }
            Command::Watched => {
                self.signals.looked();
                let encoded = self.recording.encode();
                self.note(encoded);
                self.publish();
            }
        }
    }

    fn kept(&self) -> KeptSession {
        KeptSession {
            id: self.id.clone(),
            source: self.source.clone(),
            original: self.original.clone(),
            scene: self.scene.clone(),
            changes: self.changes,
            state: self.simulation.snapshot(),
            playing: self.play.is_some(),
            speed: self.speed,
        }
    }

    /// Goes back to the start; a new recording begins.
    fn reset(&mut self) -> Result<(), Problem> {
        self.play = None;
        self.error = None;
        self.simulation.reset();
        self.recording.restart();
        self.history.clear();
        self.record()
    }

    /// Runs the scene with other numbers. If they are refused, the run goes on with the old ones.
    fn change(&mut self, change: &SceneChange) -> Result<(), Problem> {
        let (scene, then) = change.of(&self.scene)?;
        if then == AfterChange::Restart {
            self.drag = None;
        }
        let mut next = self.assembled(&scene, self.drag.as_ref())?;
        let description = describe(&scene, &next);
        match then {
            AfterChange::Restart => self.error = None,
            AfterChange::Continue => self.transfer_state(&mut next)?,
        }
        let before = std::mem::replace(&mut self.simulation, next);
        self.scene = scene;
        self.changes += 1;
        match then {
            AfterChange::Restart => {
                self.recording.restart_with(description);
                self.history.clear();
            }
            AfterChange::Continue => {
                self.recording.follow(description);
                self.history.start_segment(before);
            }
        }
        self.run_on();
        self.record()
    }

    /// Keeps the present, if it is one of the moments that are kept.
    fn record(&mut self) -> Result<(), Problem> {
        if self.recording.record(&self.simulation)? {
            self.history.keep(&self.simulation);
        }
        Ok(())
    }

    fn drag(&mut self, drag: Option<Drag>) -> Result<(), Problem> {
        let mut next = self.assembled(&self.scene, drag.as_ref())?;
        self.transfer_state(&mut next)?;
        self.history.start_segment(std::mem::replace(&mut self.simulation, next));
        self.drag = drag;
        self.run_on();
        Ok(())
    }

    fn assembled(&self, scene: &Scene, drag: Option<&Drag>) -> Result<Simulation, Problem> {
        Ok(match drag {
            None => Simulation::new(&as_it_runs(scene))?,
            Some(drag) => Simulation::new(&as_it_runs(&drag.added_to(scene, self.simulation.model())?))?,
        })
    }

    /// Lets another simulation go on from the state of the current one.
    fn transfer_state(&mut self, next: &mut Simulation) -> Result<(), Problem> {
        self.ready_to_change()?;
        next.continue_from(&self.simulation).map(drop).map_err(|error| {
            let problem = Problem::from(error);
            Problem::new(
                StatusCode::UNPROCESSABLE_ENTITY,
                "cannot-continue",
                format!("the run cannot go on with these numbers: {problem}"),
                "start it over with them: add \"then\": \"restart\"",
            )
        })
    }

    /// Simulated time goes on from the present, if it was running.
    fn run_on(&mut self) {
        if self.play.is_some() {
            self.play = Some(Play { since: Instant::now(), from: self.simulation.time() });
        }
    }

    /// Refuses to go on from a state that the engine could not leave.
    fn ready(&mut self) -> Result<(), Problem> {
        if self.signals.interrupted() {
            return Err(Problem::new(
                StatusCode::CONFLICT,
                "interrupted",
                "the session was paused before this was begun",
                "ask again if it is still wanted",
            ));
        }
        self.play = None;
        self.ready_to_change()
    }

    fn ready_to_change(&self) -> Result<(), Problem> {
        match &self.error {
            None => Ok(()),
            Some(error) => Err(Problem::new(
                StatusCode::CONFLICT,
                "session-stopped",
                format!("the simulation stopped at {:.6} s: {error}", self.simulation.time()),
                "reset the session to start over; its last good state can still be read",
            )),
        }
    }

    fn steps(&mut self, count: u32) -> Result<(), Problem> {
        let deadline = Instant::now() + self.command_time;
        for _ in 0..count {
            if self.simulation.time() >= self.simulation.duration() || self.signals.interrupted() {
                break;
            }
            self.simulation.step()?;
            self.record()?;
            self.in_time(deadline)?;
        }
        Ok(())
    }

    fn seconds(&mut self, seconds: f64) -> Result<(), Problem> {
        let target = self.simulation.time() + seconds;
        self.advance(target, Instant::now() + self.command_time)
    }

    /// Goes to simulated time `target`, or to the end of the run, unless it is interrupted.
    fn advance(&mut self, target: f64, deadline: Instant) -> Result<(), Problem> {
        let every = self.simulation.model().settings.every;
        let target = target.min(self.simulation.duration());
        while self.simulation.time() < target && !self.signals.interrupted() {
            // The next of the scene's output times; the slack keeps rounding from making one twice.
            let next = ((self.simulation.time() / every + 1e-6).floor() + 1.0) * every;
            if self.simulation.advance_towards(next.min(target), STEPS_PER_CHECK)? {
                self.record()?;
            }
            self.in_time(deadline)?;
        }
        Ok(())
    }

    fn in_time(&self, deadline: Instant) -> Result<(), Problem> {
        if Instant::now() < deadline {
            return Ok(());
        }
        Err(Problem::new(
            StatusCode::SERVICE_UNAVAILABLE,
            "time-budget-exceeded",
            format!(
                "after {} s of computing the simulation has reached {:.6} s",
                self.command_time.as_secs(),
                self.simulation.time()
            ),
            "what was computed is kept: ask for smaller steps, or play",
        ))
    }

    /// One tick of a playing session. Simulated time follows the wall clock; where the engine cannot keep up,
    /// the session runs slower rather than in leaps.
    fn tick(&mut self) {
        let Some(play) = self.play else { return };
        let now = Instant::now();
        let every = self.simulation.model().settings.every;
        let due = play.from + (now - play.since).as_secs_f64() * self.speed;
        // Frames fall on the scene's own output times, so that two runs record the same ones.
        let target =
            if due < self.simulation.duration() { (due / every + 1e-6).floor() * every } else { due };
        let reached = self.advance_within(target, now + TICK);
        if self.simulation.time() + every < target {
            self.play = Some(Play { since: Instant::now(), from: self.simulation.time() });
        }
        if reached.is_err() || self.simulation.time() >= self.simulation.duration() {
            self.play = None;
        }
        self.note(reached);
        if self.simulation.finished() {
            // The whole run is known: its scale is that of all of it.
            let fitted = self.recording.fit(false);
            self.note(fitted);
        }
        let encoded =
            if self.play.is_some() { self.recording.encode_in_turn() } else { self.recording.encode() };
        self.note(encoded);
        self.publish();
    }

    /// Like `advance`, but running out of wall time is no error.
    fn advance_within(&mut self, target: f64, deadline: Instant) -> Result<(), Problem> {
        match self.advance(target, deadline) {
            Err(problem) if problem.code() == "time-budget-exceeded" => Ok(()),
            other => other,
        }
    }

    /// Keeps the first error that stopped the simulation.
    fn note(&mut self, result: Result<(), Problem>) {
        if let Err(problem) = result {
            self.play = None;
            self.error.get_or_insert(problem);
        }
    }

    /// The answer to a command: the state after it, or what went wrong.
    fn answer(&mut self, result: Result<(), Problem>) -> Result<Arc<SessionState>, Problem> {
        let encoded = self.recording.encode();
        if let Err(problem) = &result {
            // Asking too much at once stops nothing; an engine that cannot go on does.
            if !matches!(problem.code(), "time-budget-exceeded" | "session-stopped" | "interrupted") {
                self.note(result.clone());
            }
        }
        self.note(encoded);
        self.publish();
        result.map(|()| Arc::clone(&self.state.borrow()))
    }

    /// A change that is refused stops nothing: the run goes on as it was.
    fn answer_to_change(&mut self, result: Result<(), Problem>) -> Result<Arc<SessionState>, Problem> {
        result.and_then(|()| self.answer(Ok(())))
    }

    fn publish(&mut self) {
        let (frames, frames_encoded) = self.recording.counts();
        let facts = SessionFacts {
            id: self.id.clone(),
            source: self.source.clone(),
            title: self.title.clone(),
            playing: self.play.is_some(),
            speed: self.speed,
            frames,
            frames_encoded,
            watchers: self.recording.watchers(),
            drawing: Drawing::of(&self.recording),
            changes: self.changes,
            drag: self.drag.clone(),
            error: self.error.clone(),
        };
        self.state.send_replace(Arc::new(SessionState::of(&self.simulation, &facts)));
    }
}
