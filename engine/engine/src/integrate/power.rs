//! Power of what changes the energy of a mechanism — THEORY section 6.

use triad_dynamics::dynamics::elimination::Multipliers;
use triad_dynamics::equations::{Source, equation};
use triad_dynamics::state::State;
use triad_dynamics::system::{Constraint, System};

/// Power of drivers and of loads without potential, W.
pub fn power(at: &Multipliers) -> f64 {
    let friction = |[force, rate]: [f64; 2]| force * rate;
    let frictions: f64 = at.system.frictions.iter().map(|dry| friction(at.dry_friction(dry))).sum();
    load_power(at.system, at.state) + frictions + driver_power(at)
}

/// Power of loads without potential that do not follow from reactions, W.
pub fn load_power(system: &System, state: &State) -> f64 {
    let custom = system.model.custom_loads.iter().map(|load| load.power(system, state));
    system.loads.iter().map(|load| load.power(state)).chain(custom).sum()
}

/// −λᵀ ν: constraints act with −Φ_qᵀ λ, and Φ_q q̇ = ν.
fn driver_power(at: &Multipliers) -> f64 {
    let mut power = 0.0;
    for constraint in at.system.constraints.iter().filter(|constraint| constraint.driver) {
        add_power(at, constraint, &mut power);
    }
    power
}

/// Adds the power of one driver, W.
pub fn add_power(at: &Multipliers, constraint: &Constraint, power: &mut f64) {
    for row in constraint.row_ids() {
        for (component, lambda) in at.of_row(row).into_iter().enumerate() {
            *power -= lambda * equation(at.system, at.state, Source::Joint { row, component }).nu;
        }
    }
}
