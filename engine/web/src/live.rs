//! One live run of the page: what it is asked, how far it has come with it, and what of it is streamed.

use http::StatusCode;
use serde_json::json as value;
use triad_engine::run::StateView;
use triad_session::change::{Drag, SceneChange};
use triad_session::forces::{MultipliersList, ReactionQuery, ReactionsView};
use triad_session::matrices::{JacobianView, SymmetricView};
use triad_session::picture::{block, joints_told};
use triad_session::refusal::Refusal;
use triad_session::requests::{AtTime, NewCamera, NewDrawing, PlayRequest, StepRequest, Stretch};
use triad_session::{Run, SessionMessage, SessionState, Streamed};

use crate::message::{self, Answer, Request, json};

/// Between two ticks of a run that plays, s: as the server has them.
const TICK: f64 = 0.033;
/// Between two states that are streamed, s: as often as tables can be read.
const STATE_PACE: f64 = 0.1;
/// Between two blocks of frames, s: less than what a page draws behind the newest state.
const TRACK_PACE: f64 = 0.066;

/// A stretch that a request asked for.
struct Task {
    request: u32,
    left: Left,
}

/// What is left of it.
enum Left {
    Steps(u32),
    Until(f64),
}

/// A run with whoever watches it.
pub struct Live {
    id: String,
    run: Run,
    task: Option<Task>,
    /// Where a playing run should be at the end of this tick, and when the tick ends.
    tick: Option<(f64, f64)>,
    /// Somebody watches.
    watched: bool,
    /// The epoch of the samples that were streamed, and how many of them.
    epoch: u64,
    taken: u64,
    state_at: f64,
    block_at: f64,
}

impl Live {
    /// A run at its start.
    pub fn new(id: String, run: Run) -> Self {
        let epoch = run.samples().epoch();
        let never = f64::NEG_INFINITY;
        Self {
            id,
            run,
            task: None,
            tick: None,
            watched: false,
            epoch,
            taken: 0,
            state_at: never,
            block_at: never,
        }
    }

    /// Whether a stretch is under way: what would change the run waits for it.
    pub fn busy(&self) -> bool {
        self.task.is_some()
    }

    /// Whether there is something to do.
    pub fn moving(&self) -> bool {
        self.busy() || self.run.playing()
    }

    /// Its state.
    pub fn state(&self) -> SessionState {
        let streamed = Streamed { frames_encoded: 0, watchers: usize::from(self.watched) };
        self.run.state(streamed, || "in-this-page".to_owned())
    }

    /// Begins to stream the run from its start.
    pub fn watch(&mut self, out: &mut Vec<Vec<u8>>) {
        (self.watched, self.taken) = (true, 0);
        self.stream(out);
    }

    /// Nobody watches any more.
    pub fn unwatch(&mut self) {
        self.watched = false;
    }

    /// The answer to a request; none if a stretch must be computed first, which the answer then comes after.
    pub fn ask(&mut self, request: &Request, word: &str, now: f64) -> Option<Answer> {
        let answer = match (request.method.as_str(), word) {
            ("GET", "") => json(&self.state()),
            ("POST", "step") => match self.begin(request) {
                Ok(()) => return None,
                Err(refusal) => Err(refusal),
            },
            ("POST", "play") => self.play(request, now),
            ("POST", "pause") => {
                self.run.pause();
                json(&self.state())
            }
            ("POST", "reset") => {
                self.run.reset();
                json(&self.state())
            }
            ("POST", "parameters") => self.change(request, now),
            ("PUT", "pull") => {
                let drag = request.body::<Drag>();
                drag.and_then(|drag| self.run.drag(Some(drag), now)).and_then(|()| json(&self.state()))
            }
            ("DELETE", "pull") => self.run.drag(None, now).and_then(|()| json(&self.state())),
            ("PUT", "drawing") => request.body::<NewDrawing>().and_then(|new| {
                self.run.draw(new.arrows, new.fit);
                json(&self.state())
            }),
            ("PUT", "camera") => request.body::<NewCamera>().and_then(|new| {
                self.run.look_from(new.from);
                json(&self.state())
            }),
            ("GET", word) => self.read(request, word),
            _ => Err(unknown(&request.path)),
        };
        Some(answer)
    }

    /// What a question about a moment of the run is answered.
    #[allow(
        clippy::redundant_closure_for_method_calls,
        reason = "the method itself is not general enough in its lifetime"
    )]
    fn read(&self, request: &Request, word: &str) -> Answer {
        let symmetric = |matrix: fn(&StateView) -> _| {
            json(&SymmetricView::of(&self.run.at(request.query::<AtTime>()?.at)?, matrix)?)
        };
        match word {
            "scene" => json(&self.run.scene()),
            "jacobian" => json(&JacobianView::of(&self.run.at(request.query::<AtTime>()?.at)?)),
            "augmented" => symmetric(|state| state.augmented()),
            "schur" => symmetric(|state| state.schur()),
            "multipliers" => json(&MultipliersList::of(&self.run.at(request.query::<AtTime>()?.at)?)),
            "reactions" => {
                let wanted: ReactionQuery = request.query()?;
                json(&ReactionsView::of(&self.run.at(wanted.at)?, &wanted)?)
            }
            _ => Err(unknown(&request.path)),
        }
    }

    fn begin(&mut self, request: &Request) -> Result<(), Refusal> {
        let stretch = request.body::<StepRequest>()?.asked()?;
        self.run.pause();
        self.run.ready()?;
        let left = match stretch {
            Stretch::Steps(steps) => Left::Steps(steps),
            Stretch::Seconds(seconds) => Left::Until(self.run.ahead(seconds)),
        };
        self.task = Some(Task { request: request.id, left });
        Ok(())
    }

    fn play(&mut self, request: &Request, now: f64) -> Answer {
        let speed = request.body::<PlayRequest>()?.asked()?;
        self.run.ready()?;
        self.run.play(speed, now);
        self.tick = None;
        json(&self.state())
    }

    fn change(&mut self, request: &Request, now: f64) -> Answer {
        self.run.change(&request.body::<SceneChange>()?, now)?;
        json(&self.state())
    }

    /// Ends a stretch that is under way where it stands, and answers it.
    pub fn interrupt(&mut self, out: &mut Vec<Vec<u8>>) {
        if let Some(task) = self.task.take() {
            out.push(message::answer(task.request, json(&self.state())));
        }
    }

    /// Computes for a short while; returns whether there is more to do before the next tick.
    pub fn work(&mut self, now: f64, out: &mut Vec<Vec<u8>>) -> bool {
        if self.task.is_some() { self.go_on(out) } else { self.keep_time(now, out) }
    }

    /// A spell of a stretch.
    fn go_on(&mut self, out: &mut Vec<Vec<u8>>) -> bool {
        let Some(mut task) = self.task.take() else { return false };
        let more = match &mut task.left {
            Left::Steps(0) => Ok(false),
            Left::Steps(left) => {
                *left -= 1;
                self.run.step().map(|stepped| stepped && *left > 0)
            }
            Left::Until(target) => self.run.advance(*target),
        };
        if matches!(more, Ok(true)) {
            self.task = Some(task);
            return true;
        }
        let answer = more.and_then(|_| json(&self.state()));
        if let Err(refusal) = &answer {
            self.run.stop(refusal.clone());
        }
        out.push(message::answer(task.request, answer));
        self.stream(out);
        false
    }

    /// A spell of a run that plays.
    fn keep_time(&mut self, now: f64, out: &mut Vec<Vec<u8>>) -> bool {
        let (target, end) = match self.tick {
            Some(tick) => tick,
            None => match self.run.due(now) {
                Some(target) => (target, now + TICK),
                None => return false,
            },
        };
        let reached = self.run.advance(target);
        if matches!(reached, Ok(true)) && now < end {
            self.tick = Some((target, end));
            return true;
        }
        self.tick = None;
        self.run.played(target, now, reached.map(drop));
        let ends = !self.run.playing();
        if ends || now - self.block_at >= TRACK_PACE {
            self.block_at = now;
            self.stream_frames(out);
        }
        if ends || now - self.state_at >= STATE_PACE {
            self.state_at = now;
            self.stream_state(out);
        }
        false
    }

    /// Streams all that is new.
    pub fn stream(&mut self, out: &mut Vec<Vec<u8>>) {
        self.stream_frames(out);
        self.stream_state(out);
    }

    fn stream_frames(&mut self, out: &mut Vec<Vec<u8>>) {
        if !self.watched {
            return;
        }
        let samples = self.run.samples();
        if samples.epoch() != self.epoch {
            (self.epoch, self.taken) = (samples.epoch(), 0);
            out.push(message::streamed(&self.id, value!({"type": "reset"}).to_string().as_bytes()));
        }
        let new = samples.after(self.taken);
        if !new.is_empty() {
            let joints = joints_told(samples.description().joints.len());
            out.push(message::block(&self.id, &block(new, joints)));
            self.taken = samples.recorded();
        }
    }

    fn stream_state(&mut self, out: &mut Vec<Vec<u8>>) {
        if self.watched
            && let Ok(text) = json(&SessionMessage::State(&self.state()))
        {
            out.push(message::streamed(&self.id, &text));
        }
    }
}

fn unknown(path: &str) -> Refusal {
    Refusal::new(
        StatusCode::NOT_FOUND,
        "not-here",
        format!("the engine in this page has nothing at {path}"),
        "let the run be computed on the server",
    )
}
