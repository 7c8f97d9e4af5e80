//! Starts that are given by joints: loops are closed with the given angles, displacements and rates held.

use crate::constraints::changed;
use crate::constraints::given::{driver_of, place, take_over};
use crate::constraints::mechanism::{MAX_MOVE, Mechanism};
use crate::constraints::rough;
use crate::constraints::violation;
use crate::model::motion::Curve;
use crate::model::{BodyRef, DriverKind, Model, ModelDriver, ModelStart};
use crate::newton::{project_velocities, rules};
use crate::system::{System, islands};

/// A checked model as a mechanism, and its start y = (q, q̇) as the author gives it by bodies and joints. Where joints give it,
/// loops are closed as far as that can be done with what is given held; what remains open is left to the assembly.
pub fn mechanism(model: Model) -> (Mechanism, Vec<f64>) {
    mechanism_while(model, &|| true)
}

/// As [`mechanism`], as long as that is wanted: otherwise somewhere on the way.
pub fn mechanism_while(mut model: Model, wanted: &dyn Fn() -> bool) -> (Mechanism, Vec<f64>) {
    if model.starts.is_empty() {
        model.follow_drivers();
    } else {
        close_positions(&mut model, wanted);
        fit_velocities(&mut model);
    }
    Mechanism::from_model(model)
}

/// The bodies with their joints alone, and with drivers that hold what is given of a joint: (angle or displacement, rate).
fn held(model: &Model, of: impl Fn(&ModelStart, [f64; 2]) -> [Option<Curve>; 2]) -> Model {
    let mut held = model.clone();
    held.loads.clear();
    held.custom_loads.clear();
    held.events.clear();
    for start in &model.starts {
        let joint = start.joint;
        let [angle, slide] = of(start, place(model, &model.joints[joint]));
        let mut hold = |turning: bool, kind: DriverKind| {
            if driver_of(model, joint, turning).is_none() {
                held.drivers.push(ModelDriver { name: model.joints[joint].name.clone(), kind });
            }
        };
        if let Some(motion) = angle {
            hold(true, DriverKind::Angle { joint, motion });
        }
        if let Some(motion) = slide {
            hold(false, DriverKind::Slide { joint, motion });
        }
    }
    held
}

/// Moves the bodies onto the joints, with the given angles and displacements held.
fn close_positions(model: &mut Model, wanted: &dyn Fn() -> bool) {
    let constant = |value: Option<f64>| value.map(Curve::constant);
    let held = held(model, |start, _| [constant(start.angle), constant(start.slide)]);
    let (mut mechanism, mut y) = Mechanism::from_model(held);
    // A screw goes on from one turn to the next.
    mechanism.state.set_revolutions(mechanism.system.start_angles());
    mechanism.set_state(0.0, &y);
    if violation::relative(&mechanism.system, &mechanism.state) <= f64::EPSILON {
        return;
    }
    let stated = y.clone();
    rough::close(&mut mechanism, &mut y, wanted);
    if !violation::is_closed(&mechanism.system, &mechanism.state) {
        return;
    }
    // Where no place is given of a joint, bodies stay near where they are stated, and it is said how far they were moved.
    let given = given_parts(&mechanism.system.model, model);
    let open = mixed(&mechanism.system, &stated, &y, |body| given[body] != Given::Rates);
    mechanism.set_state(0.0, &open);
    let violated = mechanism.state.position_violation(&mechanism.system);
    let (n, length) = (mechanism.system.coordinates, mechanism.system.length);
    let moved = mechanism.system.longest_way(&open[..n], &y[..n]);
    let is_near = moved <= MAX_MOVE * length;
    let taken = |body: usize| given[body] == Given::Places || (given[body] == Given::Rates && is_near);
    let start = mixed(&mechanism.system, &stated, &y, taken);
    take_over(model, &mechanism.system, &start, false);
    model.notes.extend(changed::position_note(&mechanism.system, violated, moved).filter(|_| is_near));
}

/// What is given for the start of the joints between bodies that joints and drivers connect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Given {
    Nothing,
    Rates,
    Places,
}

/// What is given of the part of a mechanism to which each body belongs.
fn given_parts(held: &Model, model: &Model) -> Vec<Given> {
    let parts = islands::parts(held);
    let mut given = vec![Given::Nothing; parts.len()];
    for start in &model.starts {
        let of = if start.angle.is_some() || start.slide.is_some() { Given::Places } else { Given::Rates };
        for body in model.joints[start.joint].bodies {
            if let BodyRef::Moving(body) = body {
                given[parts[body]] = given[parts[body]].max(of);
            }
        }
    }
    parts.into_iter().map(|part| given[part]).collect()
}

/// y with the places of some bodies from one state and those of the others from another.
fn mixed(system: &System, others: &[f64], some: &[f64], of_some: impl Fn(usize) -> bool) -> Vec<f64> {
    let mut y = others.to_vec();
    for body in (0..system.bodies.len()).filter(|body| of_some(*body)) {
        let described = &system.bodies[body];
        let at = described.layout.position(&some[..system.coordinates]);
        described.layout.store(&at, &mut y[..system.coordinates]);
    }
    y
}

/// Makes the velocities fit the joints, with the given rates and those of drivers held.
fn fit_velocities(model: &mut Model) {
    let follows = model.follow_drivers();
    let given = model.starts.iter().any(|start| start.rate.is_some() || start.speed.is_some());
    if !(follows || given) {
        return;
    }
    let moving = |at: f64, rate: Option<f64>| rate.map(|rate| Curve::Polynomial(vec![at, rate]));
    let held = held(model, |start, [angle, slide]| [moving(angle, start.rate), moving(slide, start.speed)]);
    let (mut mechanism, mut y) = Mechanism::from_model(held);
    mechanism.set_state(0.0, &y);
    mechanism.elimination.set_redundant(true);
    let length = mechanism.system.length;
    let (rate, asked) = (mechanism.state.velocity_violation(&mechanism.system), y.clone());
    project_velocities(&mut mechanism.projectable(&mut y), &rules::ROUGH_VELOCITIES, length);
    if y.iter().all(|number| number.is_finite()) {
        // What drivers of points do is no rate of a joint that could be given.
        if follows || model.drivers.iter().any(|driver| pulls(&driver.kind)) {
            model.notes.extend(changed::velocity_note(&mechanism.system, rate, &asked, &y));
        }
        take_over(model, &mechanism.system, &y, true);
    }
}

/// Whether a driver that is none of a joint moves at the start.
fn pulls(kind: &DriverKind) -> bool {
    match kind {
        DriverKind::Angle { .. } | DriverKind::Slide { .. } => false,
        DriverKind::Point { motion, .. } | DriverKind::Vector { motion, .. } => {
            motion.at(0.0)[1].norm() > 0.0
        }
        DriverKind::Cosine { motion, .. } => motion.at(0.0)[1] != 0.0,
        DriverKind::CosineToWorld { reference, motion, .. } => {
            motion.at(0.0)[1] != 0.0 || reference.at(0.0)[1].norm() > 0.0
        }
    }
}
