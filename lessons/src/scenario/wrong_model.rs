//! Systematically wrong models, run by the same engine: the answers that misconceptions lead to.

use thiserror::Error;
use triad_engine::EngineError;
use triad_engine::constraints::mechanism::Mechanism;
use triad_engine::model::Model;
use triad_engine::model::motion::{Curve, VectorCurve};
use triad_engine::reactions;
use triad_engine::scene::{Coordinates, Driver, GROUND, Motion, Scene, VectorMotion};
use triad_engine::system::System;

use super::equations::{augmented_at, in_degrees, with_velocity_term};
use super::measure::{MeasureError, Observation, component, measure, run_to};
use crate::answers::tolerance::norm;
use crate::files::{Component, MeasuredFile, WrongModel, WrongModelFile};

/// Why a wrong model gives no answer.
#[derive(Debug, Clone, PartialEq, Error)]
pub(crate) enum WrongModelError {
    #[error(transparent)]
    Measure(#[from] MeasureError),
    #[error("a size has no sides; choose another misconception")]
    SizeHasNoSides,
    #[error("wrong-end needs a measured point, or joint = the other joint")]
    NoOtherEnd,
    #[error("other-frame needs a body or a joint")]
    NoFrame,
    #[error("reduced-sign is for the motion of a body")]
    NoMotion,
    #[error("reduced-sign needs a body with \"coordinates\": \"reduced\"")]
    NoReducedBody,
    #[error("the wrong model cannot be solved")]
    Singular,
}

impl From<EngineError> for WrongModelError {
    fn from(error: EngineError) -> Self {
        Self::Measure(error.into())
    }
}

/// Steps of a run with a wrong term, for each second of motion: RK4 then errs by far less than any tolerance.
const STEPS_PER_SECOND: f64 = 500.0;
/// Most steps of such a run.
const MAX_STEPS: f64 = 5000.0;

/// What the question's measurement would be in the wrong model, in SI units.
pub(crate) fn value(
    scene: &Scene,
    measured: &MeasuredFile,
    wrong: &WrongModelFile,
) -> Result<Vec<f64>, WrongModelError> {
    let of = |scene: &Scene, measured: &MeasuredFile| {
        let simulation = run_to(scene, measured.time)?;
        measure(scene, &simulation, measured).map_err(WrongModelError::from)
    };
    match wrong.kind {
        WrongModel::OtherSide if measured.component == Some(Component::Size) => {
            Err(WrongModelError::SizeHasNoSides)
        }
        WrongModel::OtherSide => Ok(of(scene, measured)?.into_iter().map(|x| -x).collect()),
        WrongModel::OtherFrame => {
            let seen = Observation::of(&run_to(scene, measured.time)?);
            in_body_frame(&seen, scene, measured)
        }
        WrongModel::Degrees => of(&in_degrees(scene), measured),
        WrongModel::NoGravity => of(&Scene { gravity: [0.0; 3], ..scene.clone() }, measured),
        WrongModel::MassForWeight => {
            let size = norm(&scene.gravity);
            of(&Scene { gravity: scene.gravity.map(|g| g / size), ..scene.clone() }, measured)
        }
        WrongModel::Static => at_rest(scene, measured),
        WrongModel::ReducedSign => with_wrong_sign(scene, measured),
        WrongModel::WrongEnd => {
            let mut other = measured.clone();
            match (&wrong.joint, other.point) {
                (Some(joint), _) => other.joint = Some(joint.clone()),
                (None, Some(point)) => other.point = Some(point.map(|x| -x)),
                _ => return Err(WrongModelError::NoOtherEnd),
            }
            of(scene, &other)
        }
    }
}

/// The vector's components along the directors of the body that it belongs to.
pub(super) fn in_body_frame(
    seen: &Observation,
    scene: &Scene,
    measured: &MeasuredFile,
) -> Result<Vec<f64>, WrongModelError> {
    let vector = seen.vector(scene, measured)?;
    let name = match (&measured.body, &measured.joint) {
        (Some(body), _) => body.clone(),
        (None, Some(joint)) => {
            let reaction = seen.reactions.iter().find(|r| r.joint == *joint);
            let reaction = reaction.ok_or_else(|| MeasureError::NoJoint(joint.clone()))?;
            if reaction.on == GROUND { reaction.by.clone() } else { reaction.on.clone() }
        }
        _ => return Err(WrongModelError::NoFrame),
    };
    let body = seen.body(scene, &name)?;
    let along = [body.u, body.v, body.w].map(|axis| (0..3).map(|k| axis[k] * vector[k]).sum::<f64>());
    Ok(component(along, measured.component))
}

/// The position of the moment, at rest, with drivers that stand still.
pub(super) fn at_rest(scene: &Scene, measured: &MeasuredFile) -> Result<Vec<f64>, WrongModelError> {
    let run = run_to(scene, measured.time)?;
    let still = stopped(scene, measured.time);
    // The start of the scene that stands still is that of the scene itself, so its drivers do not fit there; the
    // state of the moment is put in at once.
    let model = Model::new(&still).map_err(EngineError::from)?;
    let mut mechanism = Mechanism::new(System::new(model));
    mechanism.elimination.set_redundant(!run.rank().dependent.is_empty());
    let n = mechanism.system.coordinates;
    let mut y = run.q().to_vec();
    y.resize(2 * n, 0.0);
    let reactions = reactions::multipliers(&mechanism.accelerations(0.0, &y).multipliers);
    let mut frame = run.frame();
    for body in &mut frame.bodies {
        (body.velocity, body.angular_velocity) = ([0.0; 3], [0.0; 3]);
    }
    let seen = Observation { bodies: frame.bodies, reactions };
    Ok(component(seen.vector(scene, measured)?, measured.component))
}

/// The scene with its drivers held where they are at time t.
fn stopped(scene: &Scene, t: f64) -> Scene {
    let mut scene = scene.clone();
    let hold = |motion: &mut Motion| {
        if let Ok(curve) = Curve::new(motion) {
            *motion = Motion::Constant { value: curve.at(t)[0] };
        }
    };
    let hold_vector = |motion: &mut VectorMotion| {
        if let Ok(curve) = VectorCurve::new(motion) {
            *motion = VectorMotion::Fixed { vector: curve.at(t)[0].into() };
        }
    };
    for driver in &mut scene.drivers {
        match driver {
            Driver::Angle { motion, .. }
            | Driver::AngleCosine { motion, .. }
            | Driver::Slide { motion, .. } => {
                hold(motion);
            }
            Driver::AngleToWorld { motion, reference, .. } => {
                hold(motion);
                hold_vector(reference);
            }
            Driver::Vector { motion, .. } | Driver::Point { motion, .. } => hold_vector(motion),
        }
    }
    scene
}

/// A motion of reduced bodies with the wrong sign of their velocity term, by the classical Runge-Kutta method.
fn with_wrong_sign(scene: &Scene, measured: &MeasuredFile) -> Result<Vec<f64>, WrongModelError> {
    if measured.joint.is_some() || measured.energy || measured.count.is_some() {
        return Err(WrongModelError::NoMotion);
    }
    let run = run_to(scene, 0.0)?;
    let mut mechanism = Mechanism::new(run.system().clone());
    if mechanism.system.bodies.iter().all(|b| b.coordinates == Coordinates::Full) {
        return Err(WrongModelError::NoReducedBody);
    }
    let n = mechanism.system.coordinates;
    let mut y = [run.q(), run.q_dot()].concat();
    let steps = (measured.time * STEPS_PER_SECOND).ceil().clamp(1.0, MAX_STEPS);
    let h = measured.time / steps;
    let mut rate = |t: f64, y: &[f64]| -> Result<Vec<f64>, WrongModelError> {
        let augmented = augmented_at(&mut mechanism, t, y);
        let augmented = with_velocity_term(&mechanism, augmented, -1.0);
        let solution = augmented.solve().ok_or(WrongModelError::Singular)?;
        Ok([&y[n..], solution.acceleration.as_slice()].concat())
    };
    let along = |y: &[f64], k: &[f64], h: f64| y.iter().zip(k).map(|(y, k)| y + h * k).collect::<Vec<f64>>();
    let mut t = 0.0;
    while t < measured.time - 0.5 * h {
        let k1 = rate(t, &y)?;
        let k2 = rate(t + 0.5 * h, &along(&y, &k1, 0.5 * h))?;
        let k3 = rate(t + 0.5 * h, &along(&y, &k2, 0.5 * h))?;
        let k4 = rate(t + h, &along(&y, &k3, h))?;
        for (at, y) in y.iter_mut().enumerate() {
            *y += h / 6.0 * (k1[at] + 2.0 * k2[at] + 2.0 * k3[at] + k4[at]);
        }
        t += h;
    }
    mechanism.set_state(measured.time, &y);
    let seen = Observation {
        bodies: mechanism.state.bodies().iter().map(Into::into).collect(),
        reactions: Vec::new(),
    };
    Ok(component(seen.vector(scene, measured)?, measured.component))
}
