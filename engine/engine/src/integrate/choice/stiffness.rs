//! Whether a scene is stiff: whether an explicit method would take its steps from stability instead of accuracy.

use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::ode::OdeSystem;

/// Decay rate of a load times the length of the run above which an implicit method pays: measured, the series take half of its
/// time on three rods with 6.5e4 of them, and one and a half times its time on the flyball governor with 8.1e4; their steps grow
/// with this number.
const MANY_DECAYS: f64 = 7e4;
/// The tolerance at which [`MANY_DECAYS`] and [`MANY_OSCILLATIONS`] hold. At a tighter one the implicit method needs more
/// steps, the series do not.
const AT_TOLERANCE: f64 = 1e-6;
/// Powers with which the bounds then grow: the governor takes the implicit method twice as long at 1e-10; oscillations that it
/// leaves out at a loose tolerance are resolved at a tight one.
const GROWTH: [f64; 2] = [1.0 / 12.0, 0.25];
/// Angular frequency of a load times the length of the run above which an implicit method pays, provided that the
/// oscillations are not excited: only then may it leave them out.
const MANY_OSCILLATIONS: f64 = 3e5;
/// Amplitude above which an oscillation counts as excited, in tolerances times the length of the mechanism.
const EXCITED: f64 = 1e3;
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
    let [cost_of_decays, cost_of_oscillations] =
        GROWTH.map(|power| libm::pow(AT_TOLERANCE / tolerance, power).max(1.0));
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
        if decay * duration > MANY_DECAYS * cost_of_decays {
            return Some(format!("load \"{name}\" makes motions decay within {:.0e} s", 1.0 / decay));
        }
        let omega = (stiffness * mobility).sqrt();
        let amplitude = (acceleration / (omega * omega)).max(speed / omega);
        if omega * duration > MANY_OSCILLATIONS * cost_of_oscillations
            && amplitude <= EXCITED * tolerance * length
        {
            return Some(format!("spring \"{name}\" could oscillate at {omega:.0e} rad/s, but does not"));
        }
    }
    None
}
