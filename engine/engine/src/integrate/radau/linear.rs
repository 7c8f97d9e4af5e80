//! The Jacobian matrix of Newton's method: for second-order equations two matrices of the size of η alone.

use nalgebra::DMatrix;

/// Step over the time between two matrices above which the change from the one to the other says nothing about the step.
const REACH: f64 = 3.0;

/// K = ∂η̈/∂η and C = ∂η̈/∂η̇: the lower half of the Jacobian matrix J of (η̇, η̈) by (η, η̇), which changes along a step.
#[derive(Clone, Debug)]
pub struct RateJacobian {
    /// K and C at the time `at`.
    pub stiffness: DMatrix<f64>,
    /// C.
    pub damping: DMatrix<f64>,
    /// The time, s.
    at: f64,
    /// K' and C', if the change is known.
    change: [DMatrix<f64>; 2],
    changes: bool,
    /// The matrices that were taken last and before, with their times.
    samples: [(f64, DMatrix<f64>, DMatrix<f64>); 2],
    /// Whether it was taken at the start of the present step.
    pub fresh: bool,
    /// Whether it belongs to the coordinates in use.
    pub valid: bool,
}

impl RateJacobian {
    /// Allocates for f coordinates η.
    pub fn new(f: usize) -> Self {
        let zeros = || DMatrix::zeros(f, f);
        let sample = || (f64::INFINITY, zeros(), zeros());
        Self {
            stiffness: zeros(),
            damping: zeros(),
            at: 0.0,
            change: [zeros(), zeros()],
            changes: false,
            samples: [sample(), sample()],
            fresh: false,
            valid: false,
        }
    }

    /// Takes what stands in K and C for those at time t, and finds those in the middle of a step of size h and their change from what
    /// was taken before.
    pub fn take_at(&mut self, t: f64, middle: f64, h: f64) {
        let [(latest, ..), (before, ..)] = &mut self.samples;
        if !self.valid {
            (*latest, *before) = (f64::INFINITY, f64::INFINITY);
        }
        // Not so where a step is tried again.
        if *latest < t {
            self.samples.swap(0, 1);
        }
        let [(latest, stiffness, damping), (before, stiffness_before, damping_before)] = &mut self.samples;
        *latest = t;
        stiffness.copy_from(&self.stiffness);
        damping.copy_from(&self.damping);
        let span = t - *before;
        self.changes = h <= REACH * span;
        self.at = t;
        if self.changes {
            let [by_places, by_rates] = &mut self.change;
            stiffness.sub_to(stiffness_before, by_places);
            damping.sub_to(damping_before, by_rates);
            *by_places /= span;
            *by_rates /= span;
            self.at = middle;
            self.stiffness.zip_apply(by_places, |x, change| *x += (middle - t) * change);
            self.damping.zip_apply(by_rates, |x, change| *x += (middle - t) * change);
        }
    }

    /// Takes those of another run. Returns whether K and C were the same.
    pub fn copy_from(&mut self, other: &Self) -> bool {
        let same = self.stiffness == other.stiffness && self.damping == other.damping;
        if !same {
            self.stiffness.copy_from(&other.stiffness);
            self.damping.copy_from(&other.damping);
        }
        for (change, other) in self.change.iter_mut().zip(&other.change) {
            change.copy_from(other);
        }
        (self.at, self.changes) = (other.at, other.changes);
        same
    }

    /// K' and C' with the time from which on they count, if they are known: what the matrix at another time has beyond K and C.
    pub fn change(&self) -> Option<(f64, &[DMatrix<f64>; 2])> {
        self.changes.then_some((self.at, &self.change))
    }
}
