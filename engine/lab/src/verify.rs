//! An error estimate of a run from a second solution of the same scene, by another method or at another tolerance.

use serde::Serialize;
use triad_engine::EngineError;
use triad_engine::run::Simulation;
use triad_scene::{IntegratorKind, Scene};

/// Tolerance of the second solution over that of the first.
const TIGHTER: f64 = 1e-3;
/// The least tolerance of a second solution: rounding is near.
const TIGHTEST: f64 = 1e-13;
/// How many times tighter or looser a second solution by the same method is at least: at the same tolerance it would be the same run.
const APART: f64 = 10.0;

/// Largest difference of a body between the two solutions so far.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BodyError {
    /// Its name.
    pub body: String,
    /// Of its centre of mass, m.
    pub position: f64,
    /// Of its directors: an angle for small ones, rad.
    pub turn: f64,
}

/// Where a second solution contradicts the errors that both tell: one of them is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Contradiction {
    /// When, s.
    pub time: f64,
    /// How far apart they are, m.
    pub apart: f64,
    /// The sum of the errors that are told, m.
    pub told: f64,
}

/// What a second solution says about a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verification {
    /// Integrator of the second solution.
    pub integrator: IntegratorKind,
    /// Its tolerance.
    pub tolerance: f64,
    /// At how many times the two were compared.
    pub compared: u64,
    /// Largest difference of a centre of mass, m.
    pub position: f64,
    /// Largest difference of a director, rad.
    pub turn: f64,
    /// Largest differences body by body.
    pub bodies: Vec<BodyError>,
    /// Where the two are much farther apart than the errors that they tell of themselves.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contradiction: Option<Contradiction>,
    /// Places at which the second solution may have followed another branch of the motion than the right one, in words.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub branching: Vec<String>,
    /// Why it could not go on, if so: what comes after is not compared.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stopped: Option<String>,
}

/// Part of the length of the mechanism that two solutions may be apart before the result is doubted: as for the estimate that a
/// run makes itself.
const DOUBTFUL: f64 = 0.01;
/// Errors that are told, in the distance of two solutions, from which on the distance contradicts them: what estimates promise. And the
/// distance, in lengths of the mechanism, that is rounding.
const CONTRADICTED: f64 = 10.0;
const ROUNDING: f64 = 1e-12;

impl Verification {
    /// What the second solution speaks against in a run of the scene.
    pub fn doubts(&self, run: &Simulation) -> Vec<String> {
        let length = run.system().length;
        let second = format!("a second solution, by {} at {:.0e},", self.integrator, self.tolerance);
        let mut doubts = Vec::new();
        if self.position > DOUBTFUL * length {
            doubts.push(format!(
                "{second} is {:.1e} m away, more than a hundredth of the mechanism's length of {length:.3} m; tighten the \
                 tolerance, or look at a shorter time",
                self.position
            ));
        }
        if let Some(Contradiction { time, apart, told }) = self.contradiction {
            doubts.push(format!(
                "{second} is {apart:.1e} m away at t = {time:.6} s, where both together tell errors of {told:.1e} m: one of them is wrong; \
                 tighten the tolerance"
            ));
        }
        if let Some(place) = self.branching.first() {
            doubts.push(format!("{second} does not verify the branch: there, too, {place}"));
        }
        if let Some(why) = &self.stopped {
            doubts.push(format!("{second} could not go on, and what comes after is not verified: {why}"));
        }
        doubts
    }
}

/// The method of a second solution beside a first one, of a scene that has a series or has none.
fn another(first: IntegratorKind, has_series: bool) -> IntegratorKind {
    match first {
        IntegratorKind::Taylor => IntegratorKind::Dop853,
        IntegratorKind::Radau => IntegratorKind::Radau,
        _ if has_series => IntegratorKind::Taylor,
        _ => IntegratorKind::Radau,
    }
}

/// A second solution that runs beside a first one.
#[derive(Clone, Debug)]
pub struct Verifier {
    second: Simulation,
    found: Verification,
}

impl Verifier {
    /// Starts the second solution of the scene that `first` runs: by dop853 if that is a Taylor series, by radau if
    /// it is stiff, else by a series, or by radau where dry friction leaves none; a thousand times tighter, always with projection.
    ///
    /// # Errors
    ///
    /// [`EngineError`]: the second solution cannot start.
    pub fn new(scene: &Scene, first: &Simulation) -> Result<Self, EngineError> {
        let mut scene = scene.clone();
        let settings = &mut scene.simulation;
        let by_first = first.summary().integrator;
        let has_series = first.system().frictions.is_empty();
        let asked = settings.tolerance;
        settings.compare_by(another(by_first, has_series), (asked * TIGHTER).max(TIGHTEST));
        settings.error_estimate = true;
        let mut second = Simulation::new(&scene)?;
        if second.summary().integrator == by_first && scene.simulation.tolerance * APART > asked {
            scene.simulation.tolerance = asked * APART;
            second = Simulation::new(&scene)?;
        }
        let bodies =
            scene.bodies.iter().map(|b| BodyError { body: b.name.clone(), position: 0.0, turn: 0.0 });
        let found = Verification {
            integrator: second.summary().integrator,
            tolerance: scene.simulation.tolerance,
            compared: 0,
            position: 0.0,
            turn: 0.0,
            bodies: bodies.collect(),
            contradiction: None,
            branching: Vec::new(),
            stopped: None,
        };
        Ok(Self { second, found })
    }

    /// Brings the second solution to the time that the first one shows, by at most `most_steps` steps, and compares. False
    /// if it did not get there: call it again. Where it cannot go on, nothing more is compared.
    pub fn compare(&mut self, first: &Simulation, most_steps: u64) -> bool {
        if self.found.stopped.is_some() {
            return true;
        }
        match self.second.advance_towards(first.time(), most_steps) {
            Ok(true) => {}
            Ok(false) => return false,
            Err(error) => {
                self.found.stopped = Some(error.to_string());
                return true;
            }
        }
        let (here, there) = (first.frame(), self.second.frame());
        let apart = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] - b[k]).map(|d| d * d).sum::<f64>().sqrt();
        let mut farthest = 0.0f64;
        for (error, (a, b)) in self.found.bodies.iter_mut().zip(here.bodies.iter().zip(&there.bodies)) {
            farthest = farthest.max(apart(a.position, b.position));
            error.position = error.position.max(apart(a.position, b.position));
            let turn = apart(a.u, b.u).max(apart(a.v, b.v)).max(apart(a.w, b.w));
            error.turn = error.turn.max(turn);
            self.found.position = self.found.position.max(error.position);
            self.found.turn = self.found.turn.max(error.turn);
        }
        self.weigh(first, farthest);
        self.found.branching = self.second.branching();
        self.found.compared += 1;
        true
    }

    /// Compares a distance of the two with the errors that they tell, where both do.
    fn weigh(&mut self, first: &Simulation, apart: f64) {
        let [here, there] = [first, &self.second].map(|run| run.error_estimate().map(|error| error.position));
        let Some(told) = here.zip(there).map(|(here, there)| here + there) else { return };
        let known = self.found.contradiction.map_or(0.0, |known| known.apart / known.told);
        if apart > CONTRADICTED.max(known) * told && apart > ROUNDING * first.system().length {
            self.found.contradiction = Some(Contradiction { time: first.time(), apart, told });
        }
    }

    /// What was found so far.
    pub fn found(&self) -> &Verification {
        &self.found
    }
}
