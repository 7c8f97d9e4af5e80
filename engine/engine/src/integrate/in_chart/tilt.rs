//! How a chart is tilted where a search is — eq. (10.4): of a change Z u the constraints take a part back, so that L p changes by less
//! than u, or by other coordinates than those of u. Successive corrections tell by how much (Broyden's updates), and the next
//! one asks for as much more. Without it corrections shrink by the squared sine of the tilt alone.

use nalgebra::{DMatrix, DVector};

/// Part of what was asked for that must have come about, at least, for a correction to teach something.
const LEAST: f64 = 0.1;
/// Correction below which what comes about is rounding, relative to the size of the coordinates or 1.
const ROUNDING: f64 = 1e-10;

/// H, which must be asked for so that L p changes by one unit each.
#[derive(Clone, Debug)]
pub struct Tilt {
    inverse: DMatrix<f64>,
}

impl Tilt {
    /// None yet, of so many coordinates.
    pub fn new(freedoms: usize) -> Self {
        Self { inverse: DMatrix::identity(freedoms, freedoms) }
    }

    /// Goes back to none.
    pub fn forget(&mut self) {
        self.inverse.fill_with_identity();
    }

    /// Takes over what another one has learnt.
    pub fn copy_from(&mut self, other: &Self) {
        self.inverse.copy_from(&other.inverse);
    }

    /// Largest entry of Z H, what a change of one independent coordinate makes of others.
    pub fn steepness(&self, basis: &DMatrix<f64>) -> f64 {
        (basis * &self.inverse).amax()
    }

    /// Whether more than so much must be asked for.
    pub fn is_steep(&self, most: f64) -> bool {
        self.inverse.iter().any(|x| x.abs() > most)
    }
}

/// A correction of η or η̇ in the making.
#[derive(Clone, Debug)]
pub struct Search {
    /// L p before the last correction.
    pub from: DVector<f64>,
    /// What that asked for.
    pub asked: DVector<f64>,
    /// Whether the next correction takes out more than that has left.
    pub mixed: bool,
    /// What came about, H times that, and Hᵀ times what was asked for.
    come: DVector<f64>,
    learnt: DVector<f64>,
    row: DVector<f64>,
}

impl Search {
    /// Of so many coordinates.
    pub fn new(freedoms: usize) -> Self {
        let zeros = || DVector::zeros(freedoms);
        Self { from: zeros(), asked: zeros(), mixed: false, come: zeros(), learnt: zeros(), row: zeros() }
    }

    /// Asks for as much as closes a gap.
    pub fn ask(&mut self, tilt: &Tilt, gap: &DVector<f64>) {
        self.asked.gemv(1.0, &tilt.inverse, gap, 0.0);
    }

    /// Learns from where L p has come to by the last correction, p measured from p₀. That is where the next one starts.
    pub fn reach(&mut self, functionals: &DMatrix<f64>, p: &DVector<f64>, tilt: &mut Tilt) {
        let Self { from, asked, come, learnt, row, mixed } = self;
        come.copy_from(from);
        from.gemv(1.0, functionals, p, 0.0);
        come.axpy(1.0, from, -1.0);
        learnt.gemv(1.0, &tilt.inverse, come, 0.0);
        let (along, size) = (asked.dot(learnt), asked.norm_squared());
        let known = asked.amax() > ROUNDING * from.amax().max(1.0) && !std::mem::take(mixed);
        let teaches = along > LEAST * size;
        if known && !teaches {
            tilt.forget();
        }
        if known && teaches {
            row.gemv_tr(1.0, &tilt.inverse, asked, 0.0);
            learnt.axpy(1.0, asked, -1.0);
            tilt.inverse.ger(1.0 / along, learnt, row, 1.0);
        }
    }
}
