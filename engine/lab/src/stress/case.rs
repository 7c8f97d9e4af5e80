//! What a case is, how it is run, and what became of it.

use serde::Serialize;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use triad_scene::{ConstraintMethod, IntegratorKind, Scene};

/// The family of the random mechanisms in reports.
pub(super) const RANDOM_FAMILY: &str = "random";

/// What became of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum StressVerdict {
    /// It ran, and agrees with its reference within what its tolerance promises.
    Survived,
    /// It ran, but less precisely than its tolerance promises.
    Degraded,
    /// It was refused, or stopped with an error that says why.
    Refused,
    /// It ran and its result is wrong, but the run says itself that it is to be doubted, and why.
    Warned,
    /// It ran and its result is wrong, or it was refused for a reason that is not the true one.
    Wrong,
}

impl fmt::Display for StressVerdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Survived => "survived",
            Self::Degraded => "degraded",
            Self::Refused => "refused",
            Self::Warned => "warned",
            Self::Wrong => "wrong",
        })
    }
}

/// How the scenes of a case are run, where that differs from what they say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct TrialMethod {
    /// Integrator, if not that of the scene.
    pub integrator: Option<IntegratorKind>,
    /// What keeps the constraints satisfied, if not what the scene says.
    pub constraint_method: Option<ConstraintMethod>,
    /// Steps after which a run is stopped, if fewer than the case allows.
    pub max_steps: Option<u64>,
    /// Bodies above which it is not tried, if its matrices are full.
    pub max_bodies: Option<usize>,
}

impl TrialMethod {
    /// Applies it to a scene.
    pub fn apply(&self, scene: &mut Scene) {
        let settings = &mut scene.simulation;
        settings.integrator = self.integrator.unwrap_or(settings.integrator);
        settings.constraint_method = self.constraint_method.unwrap_or(settings.constraint_method);
    }
}

/// What is measured of a case; what does not apply is left out.
#[derive(Clone, Debug, Serialize)]
pub struct StressOutcome {
    /// The verdict.
    pub verdict: StressVerdict,
    /// Why, in words.
    pub reason: String,
    /// What it was compared with, in words.
    pub reference: String,
    /// Largest deviation from the reference, relative to its size.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
    /// Largest energy drift relative to the largest kinetic energy, where energy is conserved.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy_drift: Option<f64>,
    /// Largest |Φ| relative to the size of its row.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub violation: Option<f64>,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Evaluations of the accelerations.
    pub evaluations: u64,
    /// Time that was reached, s.
    pub reached: f64,
}

/// A case of the suite.
#[derive(Clone, Copy)]
pub struct StressCase {
    /// Unique name.
    pub name: &'static str,
    /// What kind of trouble it makes.
    pub family: &'static str,
    /// What it is, in one line.
    pub summary: &'static str,
    /// What has to become of it.
    pub expected: StressVerdict,
    /// Whether it is part of the quick form.
    pub quick: bool,
    /// Runs it; the flag asks for the quick form.
    pub(super) run: fn(&TrialMethod, bool) -> StressOutcome,
}

/// A case with what became of it.
#[derive(Clone, Debug, Serialize)]
pub struct CaseReport {
    /// Name of the case.
    pub case: String,
    /// Kind of trouble.
    pub family: String,
    /// What it is.
    pub summary: String,
    /// What has to become of it.
    pub expected: StressVerdict,
    /// What became of it.
    #[serde(flatten)]
    pub outcome: StressOutcome,
}

impl CaseReport {
    /// Whether the case went as it has to, or better.
    pub fn as_expected(&self) -> bool {
        match self.expected {
            StressVerdict::Refused if self.family != RANDOM_FAMILY => {
                self.outcome.verdict == StressVerdict::Refused
            }
            expected => self.outcome.verdict <= expected,
        }
    }
}

/// What becomes of a case: a panic is caught and counts as wrong.
pub(super) fn judged(work: impl FnOnce() -> StressOutcome) -> StressOutcome {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
        StressOutcome::nothing(StressVerdict::Wrong, format!("panicked: {text}"))
    })
}

impl StressOutcome {
    /// An outcome without numbers.
    pub(in crate::stress) fn nothing(verdict: StressVerdict, reason: String) -> Self {
        Self {
            verdict,
            reason,
            reference: String::new(),
            error: None,
            energy_drift: None,
            violation: None,
            steps: 0,
            rejected: 0,
            evaluations: 0,
            reached: 0.0,
        }
    }

    /// The worse of two outcomes of one case, work added up.
    pub(in crate::stress) fn and(mut self, other: Self) -> Self {
        let work =
            (self.steps + other.steps, self.rejected + other.rejected, self.evaluations + other.evaluations);
        let worst = |a: Option<f64>, b: Option<f64>| match (a, b) {
            (Some(a), Some(b)) => Some(if a > b { a } else { b }),
            (a, b) => a.or(b),
        };
        let numbers = (
            worst(self.error, other.error),
            worst(self.energy_drift, other.energy_drift),
            worst(self.violation, other.violation),
        );
        let worse =
            other.verdict > self.verdict || (other.verdict == self.verdict && other.error > self.error);
        if worse {
            self = other;
        }
        (self.steps, self.rejected, self.evaluations) = work;
        (self.error, self.energy_drift, self.violation) = numbers;
        self
    }
}
