//! Penalty method: constraints are replaced by stiff, damped masses — eq. (10.7).
//!
//! There are no multipliers: (M + Φ_qᵀ α Φ_q) q̈ = g + Φ_qᵀ α (γ − 2 Ω μ Φ̇ − Ω² Φ), written with all rows, rigid-body
//! rows included, as the literature has it. Redundant rows and singular positions do no harm; the constraints are
//! violated by λ / (α Ω²).

use super::{Explicit, Plant, Stepper, Steps, Stop};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::equations::augmented::{Normal, RightSides};

/// Rounding of the accelerations grows with α: a tolerance below this part of α would take it for motion.
const ROUNDING: f64 = 2e-15;

/// α, Ω and μ.
#[derive(Clone, Copy, Debug)]
pub struct Strength {
    /// α, kg.
    pub alpha: f64,
    /// Ω, rad/s.
    pub omega: f64,
    /// μ.
    pub mu: f64,
}

impl Strength {
    /// The least tolerance that rounding admits.
    pub fn least_tolerance(&self) -> f64 {
        ROUNDING * self.alpha
    }
}

/// The mechanism with penalties instead of multipliers.
struct Penalized<'a> {
    mechanism: &'a mut Mechanism,
    equations: &'a mut Normal,
    strength: Strength,
}

impl Plant for Penalized<'_> {
    fn rate(&mut self, t: f64, y: &[f64], rate: &mut [f64]) {
        let n = self.mechanism.system.coordinates;
        self.mechanism.set_state(t, y);
        let Mechanism { system, state, elimination, .. } = &mut *self.mechanism;
        elimination.counters.evaluations += 1;
        elimination.counters.factorizations += 1;
        elimination.counters.solves += 1;
        let equations = &mut *self.equations;
        equations.refresh(system, state);
        let sides = RightSides::new(system, state);
        let Strength { alpha, omega, mu } = self.strength;
        let wanted = &sides.gamma
            - (equations.product(&y[n..]) - &sides.nu) * (2.0 * omega * mu)
            - &sides.value * (omega * omega);
        let mut right = sides.force;
        equations.add_transposed(alpha, &wanted, &mut right);
        rate[..n].copy_from_slice(&y[n..]);
        if equations.factor(alpha, &[]) {
            equations.solve(&mut right);
        } else {
            right.fill(f64::NAN);
        }
        rate[n..].copy_from_slice(right.as_slice());
    }

    fn settle(&mut self, t: f64, y: &mut [f64], _: &mut [f64]) {
        self.mechanism.set_state(t, y);
        self.mechanism.state.commit_revolutions();
    }
}

/// An explicit method on the penalized equations.
#[derive(Clone, Debug)]
pub struct Penalty {
    method: Explicit,
    equations: Normal,
    strength: Strength,
}

impl Penalty {
    /// Starts at y with the method that `start` makes.
    pub fn new(
        mechanism: &mut Mechanism,
        t: f64,
        y: &[f64],
        strength: Strength,
        start: impl FnOnce(&mut dyn Plant, &[f64]) -> Explicit,
    ) -> Self {
        mechanism.set_state(t, y);
        let mut equations = Normal::new(&mechanism.system, &mechanism.state);
        let method = start(&mut Penalized { mechanism, equations: &mut equations, strength }, y);
        Self { method, equations, strength }
    }
}

impl Stepper for Penalty {
    fn time(&self) -> f64 {
        self.method.time()
    }
    fn state(&self) -> &[f64] {
        self.method.state()
    }
    fn last_step(&self) -> f64 {
        self.method.last_step()
    }
    fn steps(&self) -> Steps {
        self.method.steps
    }
    fn step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), Stop> {
        let Self { method, equations, strength } = self;
        method.step(&mut Penalized { mechanism, equations, strength: *strength }, end)
    }
    fn interpolate(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        let Self { method, equations, strength } = self;
        method.interpolate(&mut Penalized { mechanism, equations, strength: *strength }, t, y);
    }
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}
