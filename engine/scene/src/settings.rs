//! How to run a scene.

use crate::outputs::{Output, OutputKind};
use crate::text::words;
use crate::times::OutputTimes;
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
    #[serde(rename = "stabilization")]
    pub constraint_method: ConstraintMethod,
    /// What is left out because nothing depends on it.
    #[serde(skip_serializing_if = "Skip::is_everything")]
    pub skip: Skip,
    /// Whether the run carries an estimate of the errors of its numbers along.
    #[serde(skip_serializing_if = "is_true")]
    pub error_estimate: bool,
    /// Size of the steps, s: fixed, instead of chosen by the tolerance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step: Option<f64>,
    /// What a table of the run holds besides the time.
    #[serde(skip_serializing_if = "Output::are_usual")]
    pub outputs: Vec<Output>,
}

impl Settings {
    /// When a run is looked at.
    pub fn output_times(&self) -> OutputTimes {
        OutputTimes::new(self.every, self.duration)
    }

    /// Has rigid joints held by projection, and steps of one integrator as long as a tolerance allows, whatever was asked for: for a run that
    /// another one is compared with.
    pub fn compare_by(&mut self, integrator: IntegratorKind, tolerance: f64) {
        self.constraint_method = ConstraintMethod::Projection;
        self.step = None;
        (self.integrator, self.tolerance) = (integrator, tolerance);
    }

    /// Whether its outputs hold estimated errors.
    pub fn tells_errors(&self) -> bool {
        self.outputs.iter().any(|output| output.kind == OutputKind::Errors)
    }

    /// Whether errors were chosen that are not estimated. The usual outputs are no choice: they hold errors where there are some.
    pub fn misses_errors(&self) -> bool {
        !self.error_estimate && self.tells_errors() && !Output::are_usual(&self.outputs)
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            duration: 10.0,
            every: 0.01,
            integrator: IntegratorKind::default(),
            tolerance: 1e-9,
            constraint_method: ConstraintMethod::default(),
            skip: Skip::default(),
            error_estimate: true,
            step: None,
            outputs: Output::usual(),
        }
    }
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
fn is_true(value: &bool) -> bool {
    *value
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
    /// The same with the step control of MATLAB's ode45: relative tolerance as given, absolute tolerance a thousandth of
    /// it, so 1e-3 for MATLAB's defaults.
    Ode45,
    /// Radau IIA of orders 5, 9 and 13 by the tolerance, implicit, in independent coordinates: for stiff springs, dampers and
    /// friction. With steps of one size order 5. Dense output of orders 3, 5 and 7.
    Radau,
    /// RATTLE, composed symmetrically to order 6, with steps of one size: energy and momentum of conservative mechanisms
    /// stay within bounds however long the run. Dense output of order 5.
    Rattle,
    /// Implicit trapezoidal rule of order 2: the partner of the augmented Lagrangian, which brings it along.
    Trapezoidal,
}

words!(
    ///
    /// ```
    /// use triad_scene::IntegratorKind;
    ///
    /// assert_eq!(IntegratorKind::Dop853.to_string(), "dop853");
    /// assert_eq!("radau".parse(), Ok(IntegratorKind::Radau));
    /// assert!("euler".parse::<IntegratorKind>().is_err());
    /// ```
    IntegratorKind {
        Auto => "auto",
        Taylor => "taylor",
        Dop853 => "dop853",
        Dopri5 => "dopri5",
        Ode45 => "ode45",
        Radau => "radau",
        Rattle => "rattle",
        Trapezoidal => "trapezoidal",
    }
);

/// What keeps the constraints satisfied during a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(rename = "Stabilization")]
pub enum ConstraintMethod {
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
    /// Coordinate partitioning: only as many coordinates as there are degrees of freedom are integrated, chosen by
    /// pivoting; the others follow from the constraints at every stage.
    Partitioning,
    /// Penalty: instead of multipliers, each row has a mass, a damper and a spring against its violation,
    /// λ = α (Φ̈ + 2 Ω μ Φ̇ + Ω² Φ).
    Penalty {
        /// α, kg: the mass that each row has against its violation, an absolute number and not one relative to the mechanism.
        /// Violations shrink with 1/α; for mechanisms of grams choose it a thousand times smaller.
        #[serde(default = "penalty_alpha")]
        alpha: f64,
        /// Ω, rad/s.
        #[serde(default = "penalty_omega")]
        omega: f64,
        /// μ, 1 for critical damping.
        #[serde(default = "penalty_mu")]
        mu: f64,
    },
    /// Augmented Lagrangian of index 3 with projections of velocity and acceleration; it is integrated by the implicit
    /// trapezoidal rule.
    AugmentedLagrangian {
        /// α, N/m: the penalty with which the multipliers are augmented.
        #[serde(default = "augmented_alpha")]
        alpha: f64,
    },
}

const fn penalty_alpha() -> f64 {
    1e7
}

const fn penalty_omega() -> f64 {
    10.0
}

const fn penalty_mu() -> f64 {
    1.0
}

const fn augmented_alpha() -> f64 {
    1e9
}

words!(
    ///
    /// ```
    /// use triad_scene::ConstraintMethod;
    ///
    /// assert_eq!("baumgarte".parse(), Ok(ConstraintMethod::Baumgarte { alpha: 10.0, beta: 10.0 }));
    /// ```
    ConstraintMethod {
        Projection => "projection",
        Baumgarte { alpha: 10.0, beta: 10.0 } => "baumgarte",
        Partitioning => "partitioning",
        Penalty { alpha: penalty_alpha(), omega: penalty_omega(), mu: penalty_mu() } => "penalty",
        AugmentedLagrangian { alpha: augmented_alpha() } => "augmented-lagrangian",
    }
);

/// What is left out because nothing depends on it. Every word is true unless it is switched off; then the run takes
/// longer and gives the same motion. `triad run --explain` tells what each word saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[allow(clippy::struct_excessive_bools)]
pub struct Skip {
    /// Coordinates and rows out of the plane, where joints hold all bodies in a plane (integrator `taylor`).
    pub planar: bool,
    /// Steps that bodies need not take with others that nothing connects them with (integrator `taylor`).
    pub islands: bool,
    /// Bodies that rigid connections tie to the ground, or to another body that then moves for both, and rows that hold a body in a
    /// point of the ground (integrator `taylor`).
    pub fixed: bool,
    /// Entries of the matrix that never change: they are written once (integrator `taylor`).
    pub constants: bool,
    /// Products of series in rows that keep a vector along an axis, which are solved as those of a common vector (integrator `taylor`).
    pub axes: bool,
    /// Measuring the constraints after a step whose projection has just shown that they hold (integrator `taylor`).
    pub checks: bool,
    /// Energy, reactions and the Jacobian of every step: they are found when somebody asks.
    pub reports: bool,
    /// Steps that end at each output: outputs are read off the polynomials of the steps.
    pub outputs: bool,
}

impl Skip {
    /// The words.
    pub const WORDS: [&'static str; 8] =
        ["planar", "islands", "fixed", "constants", "axes", "checks", "reports", "outputs"];

    /// Whether everything is left out that can be.
    #[allow(clippy::trivially_copy_pass_by_ref)]
    pub fn is_everything(&self) -> bool {
        *self == Self::default()
    }

    /// Nothing is left out.
    pub fn nothing() -> Self {
        let mut skip = Self::default();
        for word in Self::WORDS {
            if let Some(on) = skip.word_mut(word) {
                *on = false;
            }
        }
        skip
    }

    /// The switch of a word.
    pub fn word_mut(&mut self, word: &str) -> Option<&mut bool> {
        match word {
            "planar" => Some(&mut self.planar),
            "islands" => Some(&mut self.islands),
            "fixed" => Some(&mut self.fixed),
            "constants" => Some(&mut self.constants),
            "axes" => Some(&mut self.axes),
            "checks" => Some(&mut self.checks),
            "reports" => Some(&mut self.reports),
            "outputs" => Some(&mut self.outputs),
            _ => None,
        }
    }
}

impl Default for Skip {
    fn default() -> Self {
        Self {
            planar: true,
            islands: true,
            fixed: true,
            constants: true,
            axes: true,
            checks: true,
            reports: true,
            outputs: true,
        }
    }
}
