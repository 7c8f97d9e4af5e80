//! The linear systems of Newton's method: for second-order equations they have the size of η alone.

use super::coefficients::RadauTables;
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

/// Factors of μ² I − μ C − K for the real μ and one μ of each complex pair, for one step size.
#[derive(Clone, Debug)]
pub struct Factors {
    /// The step size, s.
    pub h: f64,
    real: RealLu,
    pairs: Vec<ComplexLu>,
    /// The halves a of solutions.
    half: DVector<f64>,
    half_pair: DVector<Complex<f64>>,
}

impl Factors {
    /// For a step of size h. `None` if a matrix is singular.
    pub fn new(
        RateJacobian { stiffness, damping, .. }: &RateJacobian,
        tables: &RadauTables,
        h: f64,
    ) -> Option<Self> {
        let f = stiffness.nrows();
        let mu = tables.real / h;
        let real = (DMatrix::from_diagonal_element(f, f, mu * mu) - damping * mu - stiffness).lu();
        let pairs = tables.pairs.iter().map(|pair| {
            let mu = pair / h;
            let matrix = DMatrix::from_fn(f, f, |i, j| {
                let unit = if i == j { mu * mu } else { Complex::new(0.0, 0.0) };
                unit - mu * damping[(i, j)] - stiffness[(i, j)]
            });
            matrix.lu()
        });
        let pairs: Vec<ComplexLu> = pairs.collect();
        let regular = real.is_invertible() && pairs.iter().all(ComplexLu::is_invertible);
        regular.then(|| Self { h, real, pairs, half: DVector::zeros(f), half_pair: DVector::zeros(f) })
    }

    /// (μ I − J)⁻¹ r with the real μ, in place. From the halves of (μ I − J)(a, b) = r:
    /// b = μ a − r_a, (μ² − μ C − K) a = r_b + (μ − C) r_a.
    pub fn solve_real(&mut self, jacobian: &RateJacobian, tables: &RadauTables, r: &mut DVector<f64>) {
        let (f, mu, a) = (r.len() / 2, tables.real / self.h, &mut self.half);
        for i in 0..f {
            a[i] = r[f + i] + r[i] * mu;
        }
        a.gemv(-1.0, &jacobian.damping, &r.rows(0, f), 1.0);
        self.real.solve_mut(a);
        for i in 0..f {
            (r[i], r[f + i]) = (a[i], a[i] * mu - r[i]);
        }
    }

    /// The same with the complex μ of a pair.
    pub fn solve_pair(
        &mut self,
        jacobian: &RateJacobian,
        tables: &RadauTables,
        pair: usize,
        r: &mut DVector<Complex<f64>>,
    ) {
        let (f, mu, a) = (r.len() / 2, tables.pairs[pair] / self.h, &mut self.half_pair);
        for i in 0..f {
            a[i] = r[f + i] + r[i] * mu;
            for j in 0..f {
                a[i] -= r[j] * jacobian.damping[(i, j)];
            }
        }
        self.pairs[pair].solve_mut(a);
        for i in 0..f {
            (r[i], r[f + i]) = (a[i], a[i] * mu - r[i]);
        }
    }
}
