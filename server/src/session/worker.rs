//! The thread that owns a session's run: it serves commands, and advances time while the session plays.

use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender};
use std::sync::{Arc, Weak};
use std::time::{Duration, Instant};

use axum::http::StatusCode;
use tokio::runtime::Handle;
use tokio::sync::watch;
use triad_session::{Run, SessionState};

use super::command::{Command, Signals, Turn};
use super::recording::{Recording, TICK};
use super::turns::Turns;
use crate::problem::{Problem, trace_id};
use crate::stream::Part;

/// Seconds since a session's thread was made, as its run counts them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Clock(Instant);

impl Clock {
    /// At zero.
    pub(super) fn start() -> Self {
        Self(Instant::now())
    }

    /// The time now, s.
    pub(super) fn now(self) -> f64 {
        self.0.elapsed().as_secs_f64()
    }
}

/// A session's run, and what is sent of it.
pub(super) struct Worker {
    pub run: Run,
    pub recording: Recording,
    pub clock: Clock,
    pub signals: Arc<Signals>,
    pub state: watch::Sender<Arc<SessionState>>,
    pub command_time: Duration,
    /// Where it is told of its turn, as long as anybody holds the session.
    pub commands: Weak<SyncSender<Command>>,
    pub turns: Turns,
    /// What the run keeps, among what all do.
    pub kept: Part,
    pub runtime: Handle,
    /// Whether it stands in line for a turn to play on.
    pub in_line: bool,
    /// When a playing run goes on.
    pub next_tick: Instant,
}

impl Worker {
    /// Serves commands until the session is closed.
    pub(super) fn run(mut self, commands: &Receiver<Command>) {
        self.publish();
        while !self.signals.closed() {
            let received = if self.run.playing() && !self.in_line {
                commands.recv_timeout(self.next_tick.saturating_duration_since(Instant::now()))
            } else {
                commands.recv().map_err(|_| RecvTimeoutError::Disconnected)
            };
            match received {
                Ok(command) => self.handle(command),
                Err(RecvTimeoutError::Timeout) => {
                    if let Some(turn) = self.turns.now() {
                        self.tick(turn);
                    } else {
                        self.in_line = true;
                        self.turns.stand_in_line(&self.runtime, Weak::clone(&self.commands));
                    }
                }
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    }

    fn handle(&mut self, command: Command) {
        // A caller that has gone away no longer wants the answer: nothing is lost if it cannot be delivered.
        match command {
            Command::Steps(count, reply) => {
                let result = self.ready().and_then(|()| self.steps(count, &|| reply.is_closed()));
                drop(reply.send(self.answer(result)));
            }
            Command::Seconds(seconds, reply) => {
                let result = self.ready().and_then(|()| self.seconds(seconds, &|| reply.is_closed()));
                drop(reply.send(self.answer(result)));
            }
            Command::Play(speed, reply) => {
                let result = self.ready().map(|()| self.run.play(speed, self.clock.now()));
                drop(reply.send(self.answer(result)));
            }
            Command::Pause(reply) => {
                self.signals.obeyed();
                self.run.pause();
                drop(reply.send(self.answer(Ok(()))));
            }
            Command::Reset(reply) => {
                self.signals.obeyed();
                self.run.reset();
                drop(reply.send(self.answer(Ok(()))));
            }
            Command::Change(change, reply) => {
                let result = self.run.change(&change, self.clock.now());
                drop(reply.send(self.answer_to_change(result.map_err(Problem::from))));
            }
            Command::Drag(drag, reply) => {
                let result = self.run.drag(drag, self.clock.now());
                drop(reply.send(self.answer_to_change(result.map_err(Problem::from))));
            }
            Command::Keep(reply) => drop(reply.send(Ok(self.run.kept()))),
            Command::Scene(reply) => drop(reply.send(Ok(self.run.scene()))),
            Command::Query(at, read) => read(self.run.at(at).map_err(Problem::from)),
            Command::Draw(arrows, fit, reply) => {
                self.run.draw(arrows, fit);
                drop(reply.send(self.answer(Ok(()))));
            }
            Command::LookFrom(camera, reply) => {
                self.run.look_from(camera);
                drop(reply.send(self.answer(Ok(()))));
            }
            Command::Turn(turn) => {
                self.in_line = false;
                self.tick(turn);
            }
            Command::Watched => {
                self.signals.looked();
                let encoded = self.recording.encode(self.run.samples());
                self.note(encoded);
                self.publish();
            }
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
        self.run.pause();
        Ok(self.run.ready()?)
    }

    /// Takes steps, unless it is interrupted or who asked for them has `left`.
    fn steps(&mut self, count: u32, left: &dyn Fn() -> bool) -> Result<(), Problem> {
        let deadline = Instant::now() + self.command_time;
        let mut slice = self.slice();
        for _ in 0..count {
            if self.signals.interrupted() || left() || !self.run.step()? {
                break;
            }
            self.in_time(deadline)?;
            slice = self.go_on(slice);
        }
        Ok(())
    }

    /// Lets simulated seconds pass, up to the end of the run, unless it is interrupted or who asked for them has `left`.
    fn seconds(&mut self, seconds: f64, left: &dyn Fn() -> bool) -> Result<(), Problem> {
        let (target, deadline) = (self.run.ahead(seconds), Instant::now() + self.command_time);
        let mut slice = self.slice();
        while !self.signals.interrupted() && !left() && self.run.advance(target)? {
            self.in_time(deadline)?;
            slice = self.go_on(slice);
        }
        Ok(())
    }

    /// A turn for what a caller waits for, and until when it holds; none where that is interrupted meanwhile.
    fn slice(&self) -> Option<(Turn, Instant)> {
        let turn = self.turns.wait(&self.runtime, &self.signals)?;
        Some((turn, Instant::now() + TICK))
    }

    /// The same turn, or after a while another: whoever waits comes between.
    fn go_on(&self, slice: Option<(Turn, Instant)>) -> Option<(Turn, Instant)> {
        let slice = slice.filter(|(_, until)| Instant::now() < *until);
        slice.or_else(|| self.slice())
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
                self.run.time()
            ),
            "what was computed is kept: ask for smaller steps, or play",
        ))
    }

    /// One tick of a playing session, in its turn.
    fn tick(&mut self, _turn: Turn) {
        self.next_tick = Instant::now() + TICK;
        let Some(target) = self.run.due(self.clock.now()) else { return };
        let deadline = Instant::now() + TICK;
        let mut reached = Ok(true);
        // Running out of wall time is no error here.
        while matches!(reached, Ok(true)) && !self.signals.interrupted() && Instant::now() < deadline {
            reached = self.run.advance(target);
        }
        self.run.played(target, self.clock.now(), reached.map(drop));
        let samples = self.run.samples();
        let encoded = if self.run.playing() {
            self.recording.encode_in_turn(samples)
        } else {
            self.recording.encode(samples)
        };
        self.note(encoded);
        self.publish();
    }

    /// Keeps the first error that stopped the simulation.
    fn note(&mut self, result: Result<(), Problem>) {
        if let Err(problem) = result {
            self.run.stop(problem.into());
        }
    }

    /// The answer to a command: the state after it, or what went wrong.
    fn answer(&mut self, result: Result<(), Problem>) -> Result<Arc<SessionState>, Problem> {
        let encoded = self.recording.encode(self.run.samples());
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
        self.kept.set(self.run.bytes());
        self.state.send_replace(Arc::new(self.run.state(self.recording.streamed(), trace_id)));
    }
}
