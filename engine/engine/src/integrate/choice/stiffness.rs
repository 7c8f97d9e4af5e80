//! Whether a scene is stiff: whether an explicit method would take its steps from stability instead of accuracy.

use crate::scene::ConstraintMethod;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::ode::OdeSystem;
use triad_dynamics::state;

/// Decays of a load in a run above which an implicit method pays where loops, drivers or dry friction leave multipliers to solve
/// for: the steps of the series grow with their number, those of the implicit method with how far the mechanism moves. Both cost
/// the same at `MANY_DECAYS` and `DECAYS_A_RADIAN` more for each radian of the motion, at tolerances from 1e-3 to 1e-10 alike: at
/// tighter ones the implicit method takes more steps, the series dearer ones.
const MANY_DECAYS: f64 = 1.5e3;
const DECAYS_A_RADIAN: f64 = 200.0;
/// The same on open trees, for each freedom to the power `FREEDOMS_OPEN`, at the tolerance `MIDDLE_TOLERANCE`; at others times the ratio of
/// the two to the power `LOOSER_OPEN`. With the estimate of errors both take the same time at about 100 and 180 decays on three rods in 4 s at
/// 1e-6 and 1e-9, at 130, 400 and 1.5e3 on eight at 1e-3, 1e-6 and 1e-9, and at 180, 600 and 1.9e3 on twelve.
const MANY_DECAYS_OPEN: f64 = 10.0;
const DECAYS_A_RADIAN_OPEN: f64 = 0.7;
const FREEDOMS_OPEN: f64 = 1.35;
const MIDDLE_TOLERANCE: f64 = 1e-6;
const LOOSER_OPEN: f64 = -0.16;
/// Radians of an oscillation that may be left out that are as costly for the series as a decay, and the same on open trees.
const RADIANS_A_DECAY: f64 = 0.4;
const RADIANS_A_DECAY_OPEN: f64 = 1.0;
/// Radians of an oscillation that are some ten steps of the series at most, whatever the mechanism.
const FEW_RADIANS: f64 = 100.0;
/// Freedoms that make an evaluation of the implicit method twice as dear, for its Jacobian matrix, and how much dearer it is
/// where loops must be closed.
const MANY_FREEDOMS: f64 = 16.0;
const CLOSED: f64 = 3.0;
/// Rate of an oscillation's coordinate above which it counts as excited, in tolerances times the length of the mechanism for each
/// second: only what is smaller may be left out.
const EXCITED: f64 = 3.0;
/// Degrees of freedom above which the dense linear algebra of the implicit method costs more than small steps.
const MAX_FREEDOMS: usize = 300;

/// Why a scene is stiff at the state (t, y), or nothing.
pub fn stiffness(mechanism: &mut Mechanism, t: f64, y: &[f64]) -> Option<String> {
    let settings = &mechanism.system.model.settings;
    let (duration, tolerance) = (settings.duration, settings.tolerance);
    let freedoms = (6 * mechanism.system.bodies.len()).saturating_sub(mechanism.system.solver_rows);
    if mechanism.system.loads.is_empty() || freedoms > MAX_FREEDOMS {
        return None;
    }
    let length = mechanism.system.length;
    let [many, many_radians] = many_decays(mechanism, freedoms, y);
    let mut rate = vec![0.0; y.len()];
    mechanism.rhs(t, y, &mut rate);
    let n = mechanism.system.coordinates;
    let Mechanism { system, state, elimination, .. } = mechanism;
    let at = elimination.last_accelerations(system, state).multipliers;
    let dry: Vec<(usize, f64)> = system
        .frictions
        .iter()
        .map(|friction| (friction.load, friction.steepest_damping() * at.pressing(friction)))
        .collect();
    for load in 0..system.loads.len() {
        let name = &system.model.loads[load].name;
        let Some((stiffness, _)) = elimination.set_unit_load(system, state, load) else { continue };
        // Rates of the load's coordinate along the motion and of its rate along the accelerations.
        let along = |velocity: &[f64]| -> f64 {
            let bodies = system.bodies.iter().zip(state.bodies()).zip(elimination.bodies());
            bodies.map(|((body, at), solve)| solve.force.dot(&body.layout.velocity(&at.q, velocity))).sum()
        };
        let (speed, acceleration) = (along(&y[n..]).abs(), along(&rate[n..]).abs());
        let mobility = elimination.mobility(system, state, load).unwrap_or(0.0).max(0.0);
        let dry: f64 = dry.iter().filter(|(of, _)| *of == load).map(|(_, damping)| damping).sum();
        let decay = (system.loads[load].steepest_damping() + dry) * mobility;
        if decay * duration > many {
            return Some(format!("load \"{name}\" makes motions decay within {:.0e} s", 1.0 / decay));
        }
        let omega = (stiffness * mobility).sqrt();
        let excited = (acceleration / omega).max(speed);
        if omega * duration > many_radians && excited <= EXCITED * tolerance * length {
            return Some(format!("spring \"{name}\" could oscillate at {omega:.0e} rad/s, but does not"));
        }
    }
    None
}

/// Decays in the run, and radians of an oscillation that may be left out, above which an implicit method pays.
fn many_decays(mechanism: &Mechanism, freedoms: usize, y: &[f64]) -> [f64; 2] {
    let system = &mechanism.system;
    let (settings, gravity) = (&system.model.settings, system.model.gravity.norm());
    // How far the mechanism moves, by its velocities or as a pendulum of its length would.
    let radians = state::fastest(system, y).max((gravity / system.length).sqrt()) * settings.duration;
    let closed = system.constraints.len() > system.bodies.len();
    let partitioned = settings.constraint_method == ConstraintMethod::Partitioning;
    if closed || partitioned || !system.frictions.is_empty() || system.regularizes_inertia() {
        let dearer = if closed { CLOSED } else { 1.0 };
        let many =
            (MANY_DECAYS + DECAYS_A_RADIAN * radians) * (1.0 + freedoms as f64 / MANY_FREEDOMS) * dearer;
        [many, FEW_RADIANS.max(RADIANS_A_DECAY * many)]
    } else {
        let looser = libm::pow(settings.tolerance / MIDDLE_TOLERANCE, LOOSER_OPEN);
        let dearer = libm::pow(freedoms as f64, FREEDOMS_OPEN) * looser;
        let many = (MANY_DECAYS_OPEN + DECAYS_A_RADIAN_OPEN * radians) * dearer;
        [many, FEW_RADIANS.max(RADIANS_A_DECAY_OPEN * many)]
    }
}
