//! Whether a position of rest is left at a touch.
//!
//! Where forces have a potential, the stiffness K is symmetric, and a position is stable if no motion meets a negative one. Forces that
//! turn with bodies, and moments that do not, have none: then K is not symmetric, and small motions M ẍ + K x = 0 may grow although
//! its symmetric part is positive (flutter), or not although it is not.

use super::Stage;
use super::inertia::Inertia;
use nalgebra::{ComplexField, DMatrix, DVector, Schur};

/// Stiffness of a motion that neither holds nor drives away: relative to the largest, and to the forces that take part in it over the
/// mechanism's length.
const UNDECIDED: [f64; 2] = [1e-9, 1e-7];
/// Part of the largest stiffness by which K may differ from its transpose: what differences leave.
const SYMMETRIC: f64 = 1e-7;
/// Parts of the largest λ² below which its imaginary part is the rounding of a double one, and above which it is none.
const IN_PHASE: [f64; 2] = [1e-9, 1e-6];
/// Sweeps of the QR algorithm before it is given up.
const SWEEPS: usize = 100_000;

/// What small motions do about a position of rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Stability {
    /// Whether every small displacement is driven back; undecided where some motion meets no stiffness, or where that is not
    /// decided here.
    pub stable: Option<bool>,
    /// What has to be known of it.
    pub note: Option<String>,
}

/// Stiffness along a basis of small motions.
pub struct Stiffness {
    /// K.
    pub matrix: DMatrix<f64>,
    /// Eigenvalues of its symmetric part, N/m.
    pub along: DVector<f64>,
    /// The motion of each, a column.
    pub motions: DMatrix<f64>,
}

impl Stiffness {
    /// Which motions are held (true) or driven away (false), where that is decided; `carried` are the forces that take part in each, N.
    fn holds(&self, carried: &[f64], length: f64) -> Vec<Option<bool>> {
        let [of_stiffness, of_forces] = UNDECIDED;
        let stiffest = of_stiffness * self.along.amax();
        let none = carried.iter().map(|force| stiffest.max(of_forces * force / length));
        self.along.iter().zip(none).map(|(k, none)| (k.abs() > none).then_some(*k > 0.0)).collect()
    }

    /// The same without motions that meet no stiffness and have no inertia: a point mass that turns about itself moves nothing.
    pub fn of_what_moves(self, stage: &Stage, basis: &DMatrix<f64>, carried: &[f64]) -> Self {
        let held = self.holds(carried, stage.mechanism.system.length);
        let (felt, idle): (Vec<usize>, Vec<usize>) = (0..held.len()).partition(|k| held[*k].is_some());
        let moves =
            || !Inertia::new(stage, &(basis * self.motions.select_columns(&idle))).inertial.is_empty();
        if idle.is_empty() || moves() {
            return self;
        }
        let along = self.along.select_rows(&felt);
        Self { along, motions: self.motions.select_columns(&felt), matrix: self.matrix }
    }
}

/// Judges the position of a stage at rest; `carried` are the forces that take part in each of the motions, N.
pub fn judge(stage: &mut Stage, basis: &DMatrix<f64>, stiffness: &Stiffness, carried: &[f64]) -> Stability {
    let Stiffness { matrix, along, .. } = stiffness;
    let length = stage.mechanism.system.length;
    let largest = along.amax().max(stage.largest_force() / length);
    if (matrix - matrix.transpose()).amax() > SYMMETRIC * largest {
        let note = "some forces have no potential, such as those that turn with a body: whether the position is stable is decided by the \
                    growth of its small motions";
        let stable = if stage.dampers(basis).is_empty() { grows_nowhere(stage, basis) } else { None };
        let more = if stable.is_some() { "" } else { "; undecided here: its modes tell" };
        return Stability { stable, note: Some(format!("{note}{more}")) };
    }
    let held = stiffness.holds(carried, length);
    let leaves = held.contains(&Some(false));
    let undecided = !leaves && held.contains(&None);
    Stability {
        stable: (!undecided).then_some(!leaves),
        note: undecided.then(|| "some motion meets no stiffness".to_owned()),
    }
}

/// Whether no solution of M ẍ + K x = 0 grows, λ² = −(eigenvalue of K) in motions in which M is one; `None` where that is too near to
/// tell, or where motions have no inertia.
fn grows_nowhere(stage: &mut Stage, basis: &DMatrix<f64>) -> Option<bool> {
    stage.rest();
    let Inertia { inertial, massless } = Inertia::new(stage, basis);
    if !massless.is_empty() {
        return None;
    }
    let multipliers = stage.accelerate().multipliers.solver_rows().to_vec();
    let stiffness = stage.stiffness(&inertial, &multipliers);
    stage.rest();
    let values = Schur::try_new(stiffness, f64::EPSILON, SWEEPS)?.complex_eigenvalues();
    let largest = values.iter().fold(0.0f64, |a, x| a.max(x.modulus()));
    let [double, apart] = IN_PHASE.map(|part| part * largest);
    let none = UNDECIDED[0] * largest;
    if values.iter().any(|x| x.im.abs() > apart || x.re < -none) {
        return Some(false);
    }
    (values.iter().all(|x| x.im.abs() <= double && x.re > none)).then_some(true)
}
