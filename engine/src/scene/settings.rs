//! How to run a scene.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How to run a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Settings {
    /// End of the run, s.
    pub duration: f64,
    /// Interval of output, s.
    pub every: f64,
    /// Integrator.
    pub integrator: IntegratorKind,
    /// Relative and absolute tolerance of the step control.
    pub tolerance: f64,
    /// What keeps the constraints satisfied.
    pub stabilization: Stabilization,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            duration: 10.0,
            every: 0.01,
            integrator: IntegratorKind::default(),
            tolerance: 1e-9,
            stabilization: Stabilization::default(),
        }
    }
}

/// Integrators by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum IntegratorKind {
    /// The best one for the scene and the tolerance; the summary of a run says which one and why.
    #[default]
    Auto,
    /// Taylor series of the constrained motion, of an order that suits the tolerance; the polynomials are the output
    /// between steps.
    Taylor,
    /// Explicit Runge-Kutta of order 8 by Dormand and Prince, with dense output of order 7.
    Dop853,
    /// Explicit Runge-Kutta of order 5 by Dormand and Prince, with dense output of order 4.
    Dopri5,
}

/// What keeps the constraints satisfied during a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", deny_unknown_fields, rename_all = "kebab-case")]
pub enum Stabilization {
    /// After each step the state is projected onto the position and velocity constraints.
    #[default]
    Projection,
    /// Baumgarte: γ is replaced by γ − 2α(Φ_q q̇ − ν) − β²Φ.
    Baumgarte {
        /// α, 1/s.
        alpha: f64,
        /// β, 1/s.
        beta: f64,
    },
}
