//! What a question's measurement would be if the scene were another one, or were read off elsewhere: the engine computes what
//! usual mistakes lead to, once for each question and only when a wrong answer needs it.

use std::sync::{Arc, OnceLock};

use triad_engine::analysis::check::check as engine_check;
use triad_engine::run::Simulation;
use triad_engine::scene::{Scene, Settings};

use super::measure::{MeasureError, Observation, component, measure, start};
use super::wrong_model::{at_rest, in_body_frame};
use crate::files::{Component, MeasuredFile, MotionKind};
use crate::mistakes::{self, Mistake};

/// Tolerance of these runs: far below that of any answer, and quick.
const TOLERANCE: f64 = 1e-7;
/// Steps after which such a run is given up.
const MAX_STEPS: u64 = 5_000;

/// Values in SI units that mistakes lead to.
type Answers = Vec<(&'static Mistake, Vec<f64>)>;

/// The wrong worlds of one measurement. Copies share what was computed.
#[derive(Debug, Clone, Default)]
pub(crate) struct Worlds {
    of: Option<Arc<(Scene, MeasuredFile)>>,
    answers: Arc<OnceLock<Answers>>,
}

impl PartialEq for Worlds {
    fn eq(&self, other: &Self) -> bool {
        self.of == other.of
    }
}

impl Worlds {
    /// Those of a measurement of a scene.
    pub(crate) fn new(scene: Scene, measured: MeasuredFile) -> Self {
        Self { of: Some(Arc::new((scene, measured))), answers: Arc::default() }
    }

    /// What mistakes lead to, in SI units. What cannot be run is left out.
    pub(crate) fn answers(&self) -> &[(&'static Mistake, Vec<f64>)] {
        let Some(of) = &self.of else { return &[] };
        self.answers.get_or_init(|| answers(&of.0, &of.1))
    }
}

fn answers(scene: &Scene, measured: &MeasuredFile) -> Answers {
    let scene = quick(scene, measured.time);
    if measured.count.is_some() {
        return counts(&scene).unwrap_or_default();
    }
    let mut list = Answers::new();
    if let Ok(run) = run(&scene, measured.time)
        && !measured.energy
    {
        read_elsewhere(&scene, &run, measured, &mut list);
    }
    if scene.gravity != [0.0; 3] {
        let up = scene.gravity.map(|g| -g);
        for (mistake, gravity) in [(mistakes::NO_GRAVITY, [0.0; 3]), (mistakes::GRAVITY_UP, up)] {
            let other = Scene { gravity, ..scene.clone() };
            let found = run(&other, measured.time).and_then(|run| measure(&other, &run, measured));
            list.extend(found.ok().map(|values| (mistake, values)));
        }
    }
    if measured.joint.is_some() {
        list.extend(at_rest(&scene, measured).ok().map(|values| (mistakes::AT_REST, values)));
    }
    if measured.time > 0.0 {
        let found = start(&scene).and_then(|run| measure(&scene, &run, measured));
        list.extend(found.ok().map(|values| (mistakes::AT_START, values)));
        for time in [0.5 * measured.time, 2.0 * measured.time] {
            let found = run(&scene, time).and_then(|run| measure(&scene, &run, measured));
            list.extend(found.ok().map(|values| (mistakes::OTHER_MOMENT, values)));
        }
    }
    list
}

/// The scene with settings that are quick and precise enough.
fn quick(scene: &Scene, time: f64) -> Scene {
    let mut scene = scene.clone();
    scene.parameters.clear();
    let duration = scene.simulation.duration.max(time);
    scene.simulation = Settings { tolerance: TOLERANCE, duration, ..scene.simulation };
    scene
}

fn run(scene: &Scene, time: f64) -> Result<Simulation, MeasureError> {
    let mut simulation = start(scene)?;
    simulation.set_step_limit(MAX_STEPS);
    simulation.advance_to(time)?;
    Ok(simulation)
}

fn counts(scene: &Scene) -> Result<Answers, MeasureError> {
    let report = engine_check(scene)?;
    let list = [report.degrees_of_freedom, report.rank, report.rows, report.coordinates];
    Ok(list.into_iter().map(|n| (mistakes::OTHER_COUNT, vec![n as f64])).collect())
}

/// What the same run shows of other sides, frames, points, bodies, joints and quantities.
fn read_elsewhere(scene: &Scene, run: &Simulation, measured: &MeasuredFile, list: &mut Answers) {
    let seen = Observation::of(run);
    let Ok(vector) = seen.vector(scene, measured) else { return };
    if measured.joint.is_some() && measured.component != Some(Component::Size) {
        let opposite = component(vector.map(|x| -x), measured.component);
        list.push((mistakes::OTHER_SIDE, opposite));
    }
    list.extend(in_body_frame(&seen, scene, measured).ok().map(|values| (mistakes::OTHER_FRAME, values)));
    let mut add = |mistake, other: &MeasuredFile| {
        if let Ok(vector) = seen.vector(scene, other) {
            list.push((mistake, component(vector, other.component)));
        }
    };
    for other in other_points(measured) {
        add(mistakes::OTHER_POINT, &other);
    }
    for body in scene.bodies.iter().filter(|b| measured.body.as_ref().is_some_and(|own| *own != b.name)) {
        add(mistakes::OTHER_BODY, &MeasuredFile { body: Some(body.name.clone()), ..measured.clone() });
    }
    for joint in seen.reactions.iter().filter(|r| measured.joint.as_ref().is_some_and(|own| *own != r.joint))
    {
        for side in [&joint.on, &joint.by] {
            let named = |of: &Option<String>| of.as_ref().map(|_| side.clone());
            let (force_on, moment_on) = (named(&measured.force_on), named(&measured.moment_on));
            let joint = Some(joint.joint.clone());
            add(mistakes::OTHER_JOINT, &MeasuredFile { joint, force_on, moment_on, ..measured.clone() });
        }
    }
    for other in other_quantities(measured) {
        add(mistakes::OTHER_QUANTITY, &other);
    }
    if measured.component.is_some() {
        for one in [Component::X, Component::Y, Component::Z, Component::Size] {
            add(mistakes::OTHER_COMPONENT, &MeasuredFile { component: Some(one), ..measured.clone() });
        }
    }
}

/// The centre of mass and the opposite point in the place of a point.
fn other_points(measured: &MeasuredFile) -> Vec<MeasuredFile> {
    let Some(point) = measured.point else { return Vec::new() };
    let at = |point| MeasuredFile { point, ..measured.clone() };
    vec![at(None), at(Some(point.map(|x| -x)))]
}

/// Force for moment, and one motion for another.
fn other_quantities(measured: &MeasuredFile) -> Vec<MeasuredFile> {
    if measured.joint.is_some() {
        let (force_on, moment_on) = (measured.moment_on.clone(), measured.force_on.clone());
        return vec![MeasuredFile { force_on, moment_on, ..measured.clone() }];
    }
    let motions: &[MotionKind] = match measured.motion {
        Some(MotionKind::Position | MotionKind::Velocity | MotionKind::AngularVelocity) => {
            &[MotionKind::Position, MotionKind::Velocity, MotionKind::AngularVelocity]
        }
        Some(MotionKind::U | MotionKind::V | MotionKind::W) => &[MotionKind::U, MotionKind::V, MotionKind::W],
        None => &[],
    };
    let other = motions.iter().filter(|motion| Some(**motion) != measured.motion);
    other.map(|motion| MeasuredFile { motion: Some(*motion), ..measured.clone() }).collect()
}
