//! Penalty method: constraints are replaced by stiff, damped masses — eq. (10.9).
//!
//! There are no multipliers: (M + Φ_qᵀ α Φ_q) q̈ = g + Φ_qᵀ α (γ − 2 Ω μ Φ̇ − Ω² Φ), written with all rows, rigid-body
//! rows included, as the literature has it. Redundant rows and singular positions do no harm; the constraints are
//! violated by λ / (α Ω²).

use super::explicit::Explicit;
use super::step::{StepRecord, StopReason};
use super::stepper::{OdeMethod, Stepper};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::equations::augmented::{Normal, RightSides};
use triad_dynamics::ode::OdeSystem;
use triad_dynamics::system::System;

/// Tolerance, for each time that α exceeds the lightest mass, below which the rounding of the accelerations would be taken for
/// motion: measured with bodies of 1 kg.
const ROUNDING: f64 = 2e-15;

/// The parameters of the penalty method.
#[derive(Clone, Copy, Debug)]
pub struct PenaltyParameters {
    /// α, the mass of a row, kg.
    pub alpha: f64,
    /// Ω, the angular frequency of a row, rad/s.
    pub omega: f64,
    /// μ, the damping ratio of a row.
    pub mu: f64,
}

impl PenaltyParameters {
    /// The smallest tolerance that rounding admits: the part of the lightest mass that is lost in it.
    pub fn min_tolerance(&self, system: &System) -> f64 {
        let lightest = system.bodies.iter().fold(f64::INFINITY, |least, body| least.min(body.mass));
        (ROUNDING * self.alpha / lightest).min(1.0)
    }
}

/// The mechanism with penalties instead of multipliers.
struct Penalized<'a> {
    mechanism: &'a mut Mechanism,
    equations: &'a mut Normal,
    parameters: PenaltyParameters,
}

impl OdeSystem for Penalized<'_> {
    fn rhs(&mut self, t: f64, y: &[f64], rate: &mut [f64]) {
        let n = self.mechanism.system.coordinates;
        self.mechanism.set_state(t, y);
        let Mechanism { system, state, elimination, .. } = &mut *self.mechanism;
        elimination.counters.evaluations += 1;
        elimination.counters.factorizations += 1;
        elimination.counters.solves += 1;
        let equations = &mut *self.equations;
        equations.refresh(system, state);
        let sides = RightSides::new(system, state);
        let PenaltyParameters { alpha, omega, mu } = self.parameters;
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

    fn knows_turns(&self) -> bool {
        self.mechanism.knows_turns()
    }

    fn after_step(&mut self, t: f64, y: &mut [f64], _: &mut [f64]) {
        self.mechanism.set_state(t, y);
        self.mechanism.state.commit_motion();
    }
}

/// An explicit method on the penalized equations.
#[derive(Clone, Debug)]
pub struct Penalty {
    method: Explicit,
    equations: Normal,
    parameters: PenaltyParameters,
}

impl Penalty {
    /// Starts at y with the method that `start` makes.
    pub fn new(
        mechanism: &mut Mechanism,
        t: f64,
        y: &[f64],
        parameters: PenaltyParameters,
        start: impl FnOnce(&mut dyn OdeSystem, &[f64]) -> Explicit,
    ) -> Self {
        mechanism.set_state(t, y);
        let mut equations = Normal::new(&mechanism.system, &mechanism.state);
        let method = start(&mut Penalized { mechanism, equations: &mut equations, parameters }, y);
        Self { method, equations, parameters }
    }
}

impl Stepper for Penalty {
    fn last(&self) -> &StepRecord {
        OdeMethod::last(&self.method)
    }
    fn step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), StopReason> {
        let Self { method, equations, parameters } = self;
        OdeMethod::step(method, &mut Penalized { mechanism, equations, parameters: *parameters }, end)
    }
    fn interpolate(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        let Self { method, equations, parameters } = self;
        let mut system = Penalized { mechanism, equations, parameters: *parameters };
        OdeMethod::interpolate(method, &mut system, t, y);
    }
    fn next_size(&self) -> Option<f64> {
        OdeMethod::next_size(&self.method)
    }
    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}
