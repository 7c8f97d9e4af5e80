//! One live run: its simulation with all that belongs to it.

use http::StatusCode;
use triad_engine::EngineError;
use triad_engine::model::Model;
use triad_engine::run::{Simulation, StateView};
use triad_engine::scene::{OutputTimes, Scene};

use crate::accuracy::Since;
use crate::change::{AfterChange, Drag, SceneChange, SessionScene, assembled};
use crate::drawing::{Arrows, Camera};
use crate::happened::Happened;
use crate::history::{History, SAME_TIME, unknown};
use crate::kept::KeptSession;
use crate::picture::{Samples, describe};
use crate::refusal::Refusal;
use crate::state::{Drawing, SceneSource, SessionFacts, SessionState, tells_forces};

/// Integrator steps between two looks at the clock and at what others ask.
const STEPS_AT_ONCE: u64 = 32;

/// A run that plays: the simulated time was `from` when the owner's clock was at `since`, both in s.
#[derive(Debug, Clone, Copy)]
struct Play {
    since: f64,
    from: f64,
}

/// What the owner of a run knows of its watchers.
#[derive(Debug, Clone, Copy, Default)]
pub struct Streamed {
    /// Frames that were encoded because somebody watched.
    pub frames_encoded: u64,
    /// How many watch.
    pub watchers: usize,
}

/// A live run of a scene. Times called `now` are those of a clock of its owner, in s, which never runs back.
pub struct Run {
    id: String,
    source: SceneSource,
    title: String,
    /// The scene as its author wrote it.
    original: Scene,
    /// The scene that runs, without the spring of a drag.
    scene: Scene,
    changes: u64,
    /// Since when its estimated errors count.
    since: Since,
    /// What happened before its simulation was started, with other numbers.
    happened: Happened,
    drag: Option<Drag>,
    simulation: Simulation,
    samples: Samples,
    history: History,
    /// Set while time runs.
    play: Option<Play>,
    /// Simulated seconds a second while it plays.
    speed: f64,
    /// Why it cannot go on.
    error: Option<Refusal>,
}

impl Run {
    /// Assembles a scene, with a change before its start; keeps about `bytes` of samples at most and half as many of
    /// states.
    ///
    /// Errors if the scene or the change of it is refused.
    pub fn start(
        id: String,
        original: Scene,
        change: &SceneChange,
        source: SceneSource,
        bytes: usize,
    ) -> Result<Self, Refusal> {
        let model = Model::new(&original).map_err(EngineError::from)?;
        let (scene, simulation) = if change.is_empty() {
            (original.clone(), Simulation::from_model(model)?)
        } else {
            let (scene, _) = change.of(&original)?;
            let simulation = assembled(&scene, None)?;
            (scene, simulation)
        };
        Ok(Self::of(id, source, original, scene, simulation, bytes))
    }

    /// Goes on with a run that was kept, at the time and in the state that it had. Its samples begin anew.
    ///
    /// Errors if its scene is refused by this program; none if the state is of another program.
    pub fn resume(kept: KeptSession, bytes: usize, now: f64) -> Result<Option<Self>, Refusal> {
        let KeptSession {
            id,
            source,
            original,
            scene,
            changes,
            state,
            playing,
            speed,
            since,
            happened,
            drag,
        } = kept;
        let mut simulation = assembled(&scene, drag.as_ref())?;
        if !simulation.resume(&state) {
            return Ok(None);
        }
        let play = playing.then(|| Play { since: now, from: simulation.time() });
        let since = since.or_unknown(simulation.time());
        Ok(Some(Self {
            changes,
            since,
            happened,
            drag,
            play,
            speed,
            ..Self::of(id, source, original, scene, simulation, bytes)
        }))
    }

    fn of(
        id: String,
        source: SceneSource,
        original: Scene,
        scene: Scene,
        simulation: Simulation,
        bytes: usize,
    ) -> Self {
        let mut samples = Samples::new(describe(&scene, &simulation), bytes);
        samples.record(&simulation);
        let mut history = History::new(bytes / 2);
        history.keep(&simulation);
        let title = if scene.title.is_empty() { scene.name.clone() } else { scene.title.clone() };
        Self {
            id,
            source,
            title,
            original,
            scene,
            changes: 0,
            since: Since::default(),
            happened: Happened::default(),
            drag: None,
            simulation,
            samples,
            history,
            play: None,
            speed: 1.0,
            error: None,
        }
    }

    /// What is needed to go on later.
    pub fn kept(&self) -> KeptSession {
        KeptSession {
            id: self.id.clone(),
            source: self.source.clone(),
            original: self.original.clone(),
            scene: self.scene.clone(),
            changes: self.changes,
            state: self.simulation.snapshot(),
            playing: self.play.is_some(),
            speed: self.speed,
            since: self.since.taken_up(&self.simulation, tells_forces(&self.simulation)),
            happened: self.happened(),
            drag: self.drag.clone(),
        }
    }

    /// The scene as it is now, and before any change.
    pub fn scene(&self) -> SessionScene {
        SessionScene::new(&self.scene, &self.original)
    }

    /// The samples.
    pub fn samples(&self) -> &Samples {
        &self.samples
    }

    /// Bytes that are kept of what it has passed: samples and states.
    pub fn bytes(&self) -> usize {
        self.samples.bytes() + self.history.bytes()
    }

    /// Simulated time, s.
    pub fn time(&self) -> f64 {
        self.simulation.time()
    }

    /// The state of a moment that the run has passed, or the present's.
    ///
    /// Errors if that moment is not kept, or not reached.
    pub fn at(&self, time: Option<f64>) -> Result<StateView<'_>, Refusal> {
        let now = self.simulation.time();
        match time {
            None => Ok(self.simulation.state()),
            Some(time) if time < now => self.history.at(time, &self.simulation),
            Some(time) if time <= now + SAME_TIME => Ok(self.simulation.state()),
            Some(time) => Err(unknown(time)),
        }
    }

    /// Goes back to the start; the samples begin anew.
    pub fn reset(&mut self) {
        self.play = None;
        self.error = None;
        self.simulation.reset();
        self.since = Since::default();
        self.happened = Happened::default();
        self.samples.restart();
        self.history.clear();
        self.record();
    }

    /// Runs the scene with other numbers. If they are refused, the run goes on with the old ones.
    ///
    /// Errors if they are refused, or the run cannot go on with them.
    pub fn change(&mut self, change: &SceneChange, now: f64) -> Result<(), Refusal> {
        let (scene, then) = change.of(&self.scene)?;
        let drag = match (then, &self.drag) {
            (AfterChange::Continue, Some(drag)) => {
                let scene = Scene { parameters: Vec::new(), ..scene.clone() };
                Some(drag.carried_on(self.simulation.model(), &scene)?)
            }
            _ => None,
        };
        let mut next = assembled(&scene, drag.as_ref())?;
        let description = describe(&scene, &next);
        match then {
            AfterChange::Restart => self.error = None,
            AfterChange::Continue => self.transfer_state(&mut next)?,
        }
        let happened = self.happened();
        let before = std::mem::replace(&mut self.simulation, next);
        self.scene = scene;
        self.drag = drag;
        self.changes += 1;
        match then {
            AfterChange::Restart => {
                self.since = Since::default();
                self.happened = Happened::default();
                self.samples.restart_with(description);
                self.history.clear();
            }
            AfterChange::Continue => {
                self.happened = happened;
                self.samples.follow(description);
                self.since = self.since.change(&before, tells_forces(&before));
                self.history.start_segment(before);
            }
        }
        self.run_on(now);
        self.record();
        Ok(())
    }

    /// Drags a body by a spring, or lets it go.
    ///
    /// Errors if there is no such body, or the run cannot go on.
    pub fn drag(&mut self, drag: Option<Drag>, now: f64) -> Result<(), Refusal> {
        let mut next = assembled(&self.scene, drag.as_ref())?;
        self.transfer_state(&mut next)?;
        self.happened = self.happened();
        self.since = self.since.change(&self.simulation, tells_forces(&self.simulation));
        self.history.start_segment(std::mem::replace(&mut self.simulation, next));
        self.drag = drag;
        self.run_on(now);
        Ok(())
    }

    /// What has happened since its start.
    fn happened(&self) -> Happened {
        let passed = self.simulation.singular_configurations();
        self.happened.and(&self.simulation, &passed, self.since.is_start())
    }

    /// Lets another simulation go on from the state of the current one.
    fn transfer_state(&mut self, next: &mut Simulation) -> Result<(), Refusal> {
        self.ready()?;
        next.continue_from(&self.simulation).map(drop).map_err(|error| {
            let refusal = Refusal::from(error);
            Refusal::new(
                StatusCode::UNPROCESSABLE_ENTITY,
                "cannot-continue",
                format!("the run cannot go on with these numbers: {refusal}"),
                "start it over with them: add \"then\": \"restart\"",
            )
        })
    }

    /// Simulated time goes on from the present, if it was running.
    fn run_on(&mut self, now: f64) {
        if self.play.is_some() {
            self.play = Some(Play { since: now, from: self.simulation.time() });
        }
    }

    /// Errors if the engine could not leave this state.
    pub fn ready(&self) -> Result<(), Refusal> {
        match &self.error {
            None => Ok(()),
            Some(error) => Err(Refusal::new(
                StatusCode::CONFLICT,
                "session-stopped",
                format!("the simulation stopped at {:.6} s: {error}", self.simulation.time()),
                "reset the session to start over; its last good state can still be read",
            )),
        }
    }

    /// Lets time run, `speed` simulated seconds a second.
    pub fn play(&mut self, speed: f64, now: f64) {
        self.speed = speed;
        self.play = Some(Play { since: now, from: self.simulation.time() });
    }

    /// Stops time.
    pub fn pause(&mut self) {
        self.play = None;
    }

    /// Whether time runs.
    pub fn playing(&self) -> bool {
        self.play.is_some()
    }

    /// Takes one step of the integrator; returns whether there was one to take before the end.
    ///
    /// Errors if the engine cannot go on.
    pub fn step(&mut self) -> Result<bool, Refusal> {
        if self.simulation.finished() {
            return Ok(false);
        }
        self.simulation.step()?;
        self.record();
        Ok(true)
    }

    /// The scene's output times.
    fn output_times(&self) -> OutputTimes {
        self.simulation.model().settings.output_times()
    }

    /// The time so many seconds ahead, s.
    pub fn ahead(&self, seconds: f64) -> f64 {
        self.output_times().meant(self.simulation.time() + seconds)
    }

    /// Goes on towards simulated time `target`, or the end of the run, an event that stops it included, by a few steps or to the next of the scene's output
    /// times; returns whether there is more to do.
    ///
    /// Errors if the engine cannot go on.
    pub fn advance(&mut self, target: f64) -> Result<bool, Refusal> {
        let target = target.min(self.simulation.duration());
        if self.simulation.finished() || self.simulation.time() >= target {
            return Ok(false);
        }
        let next = self.output_times().after(self.simulation.time());
        if self.simulation.advance_towards(next.min(target), STEPS_AT_ONCE)? {
            self.record();
        }
        Ok(!self.simulation.finished() && self.simulation.time() < target)
    }

    /// The simulated time that a playing run should have reached. Simulated time follows the owner's clock; frames fall on
    /// the scene's own output times, so that two runs record the same ones.
    pub fn due(&self, now: f64) -> Option<f64> {
        let play = self.play?;
        let due = play.from + (now - play.since) * self.speed;
        Some(self.output_times().reached(due))
    }

    /// The owner has let a playing run come as near to `target` as it could. Where the engine cannot keep up, the run
    /// plays slower rather than in leaps; at its end, or after an error, it stops.
    pub fn played(&mut self, target: f64, now: f64, reached: Result<(), Refusal>) {
        if self.simulation.time() + self.simulation.model().settings.every < target {
            self.play = Some(Play { since: now, from: self.simulation.time() });
        }
        if let Err(refusal) = reached {
            self.stop(refusal);
        }
        if self.simulation.finished() {
            self.play = None;
            // The whole run is known: its scale is that of all of it.
            self.samples.fit(false);
        }
    }

    /// The engine cannot go on; the first reason is kept.
    pub fn stop(&mut self, refusal: Refusal) {
        self.play = None;
        self.error.get_or_insert(refusal);
    }

    /// Keeps the present, if it is one of the moments that are kept.
    fn record(&mut self) {
        if self.samples.record(&self.simulation) {
            self.history.keep(&self.simulation);
        }
    }

    /// Draws forces in another way, where `arrows` are given; `fit` takes their scale from the samples.
    pub fn draw(&mut self, arrows: Option<Arrows>, fit: bool) {
        if let Some(arrows) = arrows {
            self.samples.draw(arrows);
        }
        if fit {
            self.samples.fit(true);
        }
    }

    /// Looks at the mechanism from another side.
    pub fn look_from(&mut self, camera: Camera) {
        self.samples.look_from(camera);
    }

    /// What the run tells of itself; `trace_id` names the occurrence of its error, if it has one.
    pub fn state(&self, streamed: Streamed, trace_id: impl FnOnce() -> String) -> SessionState {
        let facts = SessionFacts {
            id: self.id.clone(),
            source: self.source.clone(),
            title: self.title.clone(),
            playing: self.play.is_some(),
            speed: self.speed,
            frames: self.samples.recorded(),
            frames_encoded: streamed.frames_encoded,
            watchers: streamed.watchers,
            drawing: Drawing::of(&self.samples),
            changes: self.changes,
            drag: self.drag.clone(),
            since: self.since.clone(),
            happened: self.happened.clone(),
            error: self.error.as_ref().map(|error| error.document(trace_id())),
        };
        SessionState::of(&self.simulation, facts)
    }
}

#[cfg(test)]
mod tests;
