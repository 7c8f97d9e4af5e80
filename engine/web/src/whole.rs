//! A whole run as arrays: for tables, comparisons and tests.

use http::StatusCode;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use triad_engine::run::Simulation;
use triad_engine::scene::Scene;
use triad_session::refusal::Refusal;
use triad_session::requests::Overrides;

/// Numbers that a run may answer with.
const MAX_NUMBERS: f64 = 3e6;

/// What to run.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WholeRun {
    /// The scene.
    scene: Value,
    /// Settings that replace those of the scene.
    #[serde(default)]
    overrides: Overrides,
}

/// A body through a run.
#[derive(Debug, Serialize)]
struct BodyMotion {
    name: String,
    /// Centres of mass, m.
    position: Vec<[f64; 3]>,
    /// First and second principal axis.
    u: Vec<[f64; 3]>,
    v: Vec<[f64; 3]>,
    /// m/s.
    velocity: Vec<[f64; 3]>,
}

/// A joint through a run.
#[derive(Debug, Serialize)]
struct JointMotion {
    joint: String,
    /// N.
    force: Vec<[f64; 3]>,
    /// N m.
    moment: Vec<[f64; 3]>,
}

/// What a run was, at equal intervals.
#[derive(Debug, Default, Serialize)]
pub struct Arrays {
    /// s.
    time: Vec<f64>,
    bodies: Vec<BodyMotion>,
    joints: Vec<JointMotion>,
    /// J.
    energy: Vec<f64>,
    /// The estimated error of positions at each time, m; absent where it is not known.
    position_error: Vec<Option<f64>>,
    /// Of forces, N.
    force_error: Vec<Option<f64>>,
    /// Integrator steps.
    steps: u64,
}

impl Arrays {
    /// Runs a scene to its end.
    ///
    /// Errors if it is refused, cannot be run to its end, or has too many numbers.
    pub fn of(asked: WholeRun) -> Result<Self, Refusal> {
        let mut scene = Scene::from_json(&asked.scene.to_string())?;
        asked.overrides.apply(&mut scene);
        let times = scene.simulation.output_times();
        let mut run = Simulation::new(&scene)?;
        let frames = times.intervals() + 1.0;
        #[allow(clippy::cast_precision_loss, reason = "a count of bodies and joints")]
        let numbers = frames * 12.0 * (scene.bodies.len() + scene.joints.len()) as f64;
        if numbers > MAX_NUMBERS {
            let detail = format!("the arrays would have {numbers:.0} numbers, more than {MAX_NUMBERS}");
            return Err(Refusal::new(
                StatusCode::UNPROCESSABLE_ENTITY,
                "run-too-long",
                detail,
                "ask for a longer interval or an earlier end",
            ));
        }
        let mut arrays = Self::default();
        arrays.add(&run);
        let mut frame = 0;
        while !run.finished() {
            frame += 1;
            run.advance_to(times.at(frame))?;
            arrays.add(&run);
        }
        arrays.steps = run.summary().steps;
        Ok(arrays)
    }

    fn add(&mut self, run: &Simulation) {
        let (frame, joints, summary) = (run.frame(), run.multipliers(), run.summary());
        if self.time.is_empty() {
            let names = run.model().bodies.iter().map(|body| body.name.clone());
            let still = |name| BodyMotion {
                name,
                position: Vec::new(),
                u: Vec::new(),
                v: Vec::new(),
                velocity: Vec::new(),
            };
            self.bodies = names.map(still).collect();
            let joints = joints.iter();
            let idle = |joint: String| JointMotion { joint, force: Vec::new(), moment: Vec::new() };
            self.joints = joints.map(|joint| idle(joint.joint.clone())).collect();
        }
        self.time.push(run.time());
        for (body, pose) in self.bodies.iter_mut().zip(&frame.bodies) {
            body.position.push(pose.position);
            body.u.push(pose.u);
            body.v.push(pose.v);
            body.velocity.push(pose.velocity);
        }
        for (joint, found) in self.joints.iter_mut().zip(&joints) {
            joint.force.push(found.force);
            joint.moment.push(found.moment);
        }
        self.energy.push(summary.energy);
        self.position_error.push(summary.error.map(|error| error.position));
        self.force_error.push(run.reaction_errors().map(|error| error.force));
    }
}

/// Runs a scene as fast as it goes, without looking at it: how many steps it took.
///
/// Errors as [`Arrays::of`] does.
pub fn steps(asked: WholeRun) -> Result<u64, Refusal> {
    let mut scene = Scene::from_json(&asked.scene.to_string())?;
    asked.overrides.apply(&mut scene);
    let mut run = Simulation::new(&scene)?;
    run.advance_to(run.duration())?;
    Ok(run.summary().steps)
}
