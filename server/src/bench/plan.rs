//! What is measured.

use triad_engine::scene::IntegratorKind;

/// A scene to be measured and how its error is known.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Name of the built-in scene.
    pub scene: &'static str,
    /// Length of the run, s.
    pub duration: f64,
    /// Where its reference comes from.
    pub truth: Truth,
}

/// The source of a reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Truth {
    /// One degree of freedom: the angle's own equation φ̈ = κ sin φ, solved by itself; compared is the centre of mass
    /// of the first body, `arm` (sin φ, cos φ).
    Angle {
        /// κ, 1/s².
        kappa: f64,
        /// φ from the upward vertical at the start, rad.
        start: f64,
        /// φ̇ at the start, rad/s.
        rate: f64,
        /// Distance of the centre of mass from the pivot, m.
        arm: f64,
    },
    /// The same scene at the tightest tolerance; compared are the positions of all bodies.
    Converged,
}

/// Everything that is measured.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The scenes.
    pub cases: Vec<Case>,
    /// The integrators.
    pub integrators: Vec<IntegratorKind>,
    /// The tolerances.
    pub tolerances: Vec<f64>,
    /// Time for all repeats together, s.
    pub seconds: f64,
    /// Most repeats of one run.
    pub repeats: usize,
}

const GRAVITY: f64 = 9.81;

/// κ of the N-four-bar mechanism.
fn four_bar(windows: f64) -> f64 {
    GRAVITY * 3.0 * (3.0 * windows + 1.0) / (2.0 * (4.0 * windows + 1.0))
}

fn windows(scene: &'static str, count: f64) -> Case {
    let truth = Truth::Angle { kappa: four_bar(count), start: 0.0, rate: 1.0, arm: 0.5 };
    Case { scene, duration: 10.0, truth }
}

impl Plan {
    /// The whole sweep.
    pub fn full() -> Self {
        let pendulum =
            Truth::Angle { kappa: GRAVITY, start: -std::f64::consts::FRAC_PI_2, rate: 0.0, arm: 1.0 };
        Self {
            cases: vec![
                Case { scene: "simple-pendulum", duration: 10.0, truth: pendulum },
                windows("n-four-bar:2", 2.0),
                windows("n-four-bar:40", 40.0),
                Case { scene: "spatial-double-pendulum", duration: 10.0, truth: Truth::Converged },
                Case { scene: "spatial-chain:10", duration: 2.0, truth: Truth::Converged },
                Case { scene: "spatial-chain:100", duration: 2.0, truth: Truth::Converged },
            ],
            integrators: vec![IntegratorKind::Taylor, IntegratorKind::Dop853, IntegratorKind::Dopri5],
            tolerances: vec![1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11],
            seconds: 240.0,
            repeats: 21,
        }
    }

    /// A sweep that takes less than a minute.
    pub fn quick() -> Self {
        let mut plan = Self::full();
        plan.cases.retain(|case| case.scene != "spatial-chain:100" && case.scene != "n-four-bar:40");
        plan.tolerances = vec![1e-4, 1e-6, 1e-8, 1e-10];
        plan.seconds = 20.0;
        plan.repeats = 9;
        plan
    }

    /// Whether an integrator is worth its time at a tolerance: a method of order 5 is not at tight ones.
    pub fn worth(integrator: IntegratorKind, tolerance: f64) -> bool {
        integrator != IntegratorKind::Dopri5 || tolerance > 1e-8
    }
}
