//! The linear systems of Newton's method: for second-order equations they have the size of η alone.

use super::coefficients::{PAIR, REAL};
use nalgebra::{Complex, DMatrix, DVector, Dyn, LU};

type RealLu = LU<f64, Dyn, Dyn>;
type ComplexLu = LU<Complex<f64>, Dyn, Dyn>;

/// K = ∂η̈/∂η and C = ∂η̈/∂η̇: the lower half of the Jacobian matrix J of (η̇, η̈) by (η, η̇).
#[derive(Clone, Debug)]
pub struct RateJacobian {
    /// K.
    pub stiffness: DMatrix<f64>,
    /// C.
    pub damping: DMatrix<f64>,
    /// Whether it was taken at the start of the present step.
    pub fresh: bool,
    /// Whether it belongs to the coordinates in use.
    pub valid: bool,
}

impl RateJacobian {
    /// Allocates for f coordinates η.
    pub fn new(f: usize) -> Self {
        Self { stiffness: DMatrix::zeros(f, f), damping: DMatrix::zeros(f, f), fresh: false, valid: false }
    }
}

/// Factors of μ² I − μ C − K for the real and the complex μ of one step size.
#[derive(Clone, Debug)]
pub struct Factors {
    /// The step size, s.
    pub h: f64,
    real: RealLu,
    pair: ComplexLu,
}

impl Factors {
    /// For a step of size h. `None` if a matrix is singular.
    pub fn new(RateJacobian { stiffness, damping, .. }: &RateJacobian, h: f64) -> Option<Self> {
        let f = stiffness.nrows();
        let mu = REAL / h;
        let real = DMatrix::from_diagonal_element(f, f, mu * mu) - damping * mu - stiffness;
        let mu = PAIR / h;
        let pair = DMatrix::from_fn(f, f, |i, j| {
            let unit = if i == j { mu * mu } else { Complex::new(0.0, 0.0) };
            unit - mu * damping[(i, j)] - stiffness[(i, j)]
        });
        let (real, pair) = (real.lu(), pair.lu());
        (real.is_invertible() && pair.is_invertible()).then_some(Self { h, real, pair })
    }

    /// (μ I − J)⁻¹ r with the real μ, as its two halves. From those of (μ I − J)(a, b) = r:
    /// b = μ a − r_a, (μ² − μ C − K) a = r_b + (μ − C) r_a.
    pub fn solve_real(&self, jacobian: &RateJacobian, r: &DVector<f64>) -> Option<[DVector<f64>; 2]> {
        let f = r.len() / 2;
        let mu = REAL / self.h;
        let top = r.rows(0, f).into_owned();
        let a = self.real.solve(&(r.rows(f, f) + &top * mu - &jacobian.damping * &top))?;
        let b = &a * mu - top;
        Some([a, b])
    }

    /// The same with the complex μ.
    pub fn solve_pair(
        &self,
        jacobian: &RateJacobian,
        r: &DVector<Complex<f64>>,
    ) -> Option<[DVector<Complex<f64>>; 2]> {
        let f = r.len() / 2;
        let mu = PAIR / self.h;
        let top = r.rows(0, f).into_owned();
        let damped = jacobian.damping.map(|x| Complex::new(x, 0.0)) * &top;
        let a = self.pair.solve(&(r.rows(f, f) + &top * mu - damped))?;
        let b = &a * mu - top;
        Some([a, b])
    }
}
