//! What searches in a chart begin from.

use super::tilt::Tilt;
use nalgebra::DVector;
use triad_dynamics::newton::Projected;
use triad_linalg::largest_difference;

/// The state from which the search for the next one begins: the one that was found last.
#[derive(Clone, Debug)]
pub struct Guess {
    /// p.
    pub p: DVector<f64>,
    /// ṗ.
    pub p_dot: DVector<f64>,
    /// η.
    pub eta: DVector<f64>,
    /// The end of the last step, or where the chart was taken: p and η.
    pub taken: (DVector<f64>, DVector<f64>),
    /// Most iterations of a search since the chart was taken.
    pub iterations: usize,
    /// What searches have told of the chart here.
    pub tilt: Tilt,
}

impl Guess {
    /// Takes over all that another one of the same chart has found.
    pub fn copy_from(&mut self, other: &Self) {
        self.p.copy_from(&other.p);
        self.p_dot.copy_from(&other.p_dot);
        self.eta.copy_from(&other.eta);
        self.taken.0.copy_from(&other.taken.0);
        self.taken.1.copy_from(&other.taken.1);
        self.iterations = other.iterations;
        self.tilt.copy_from(&other.tilt);
    }

    /// Is as slow as another one of the same chart.
    pub fn share_slowness(&mut self, other: &Self) {
        self.iterations = self.iterations.max(other.iterations);
    }

    /// Begins the next step where another one of the same chart is.
    pub fn settle(&mut self, end: &Self) {
        self.taken.0.copy_from(&end.p);
        self.taken.1.copy_from(&end.eta);
    }

    /// The same where it is itself.
    pub fn settle_here(&mut self) {
        self.taken.0.copy_from(&self.p);
        self.taken.1.copy_from(&self.eta);
    }

    /// Goes back to the end of the last step: the next search must not begin where this one was lost.
    pub fn go_back(&mut self) {
        self.p.copy_from(&self.taken.0);
        self.eta.copy_from(&self.taken.1);
        self.iterations = usize::MAX;
        self.tilt.forget();
    }

    /// Remembers how many times a search went on.
    pub fn note(&mut self, projected: Projected) {
        self.iterations = self.iterations.max(projected.corrections.saturating_sub(1));
    }

    /// How far its independent coordinates are from given ones.
    pub fn distance(&self, eta: &[f64]) -> f64 {
        largest_difference(self.eta.as_slice(), eta)
    }
}
