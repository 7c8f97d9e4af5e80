//! Where the energy goes: power of drivers and of loads that have no potential — THEORY section 6.
//!
//! The total energy of a run changes by exactly the work that these do. What is left over is the error of the run.

use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::dynamics::elimination::Multipliers;
use triad_dynamics::equations::{Source, equation};

/// Nodes and weights of Gauss-Legendre quadrature of order 10 on [0, 1].
const NODES: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

/// Power of drivers and of loads without potential, W.
pub fn power(at: &Multipliers) -> f64 {
    let loads: f64 = at.system.loads.iter().map(|load| load.power(at.state)).sum();
    loads + driver_power(at)
}

/// −λᵀ ν: constraints act with −Φ_qᵀ λ, and Φ_q q̇ = ν.
fn driver_power(at: &Multipliers) -> f64 {
    let system = at.system;
    let mut power = 0.0;
    for constraint in system.constraints.iter().filter(|constraint| constraint.driver) {
        for row in constraint.row_ids() {
            for (component, lambda) in at.of_row(row).into_iter().enumerate() {
                power -= lambda * equation(system, at.state, Source::Joint { row, component }).nu;
            }
        }
    }
    power
}

/// Work over a step whose states `state(t)` writes, J.
pub fn work(
    mechanism: &mut Mechanism,
    (start, end): (f64, f64),
    scratch: &mut [f64],
    mut state: impl FnMut(&mut Mechanism, f64, &mut [f64]),
) -> f64 {
    let mut work = 0.0;
    for (node, weight) in NODES {
        let t = start + node * (end - start);
        state(mechanism, t, scratch);
        work += weight * (end - start) * power(&mechanism.accelerations(t, scratch).multipliers);
    }
    work
}
