//! The linear systems of Newton's method: for second-order equations they have the size of η alone.

mod factored;

use super::coefficients::RadauTables;
use factored::Factored;
use nalgebra::{Complex, DMatrix};

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

    /// Whether its change is known.
    pub fn changes(&self) -> bool {
        self.changes
    }

    /// What it is at time t beyond K and C, times x: the accelerations.
    pub fn changed(&self, t: f64, x: &[f64], out: &mut [f64]) {
        let (places, rates) = x.split_at(out.len());
        out.fill(0.0);
        for (change, x) in self.change.iter().zip([places, rates]) {
            add_product(change, x, out);
        }
        for out in out {
            *out *= t - self.at;
        }
    }
}

/// Numbers that are summed beside each other.
pub const TOGETHER: usize = 4;

/// Adds the matrix times x.
fn add_product(matrix: &DMatrix<f64>, x: &[f64], out: &mut [f64]) {
    let length = out.len().max(1);
    let columns = || matrix.as_slice().chunks_exact(length).zip(x);
    let (parts, rest) = out.as_chunks_mut::<TOGETHER>();
    for (place, part) in parts.iter_mut().enumerate() {
        let mut sum = *part;
        for (column, x) in columns() {
            let Some(column) = column[TOGETHER * place..].first_chunk::<TOGETHER>() else { continue };
            sum.iter_mut().zip(column).for_each(|(sum, a)| *sum += a * x);
        }
        *part = sum;
    }
    if rest.is_empty() {
        return;
    }
    let done = length - rest.len();
    for (column, x) in columns() {
        rest.iter_mut().zip(&column[done..]).for_each(|(out, a)| *out += a * x);
    }
}

/// Factors of μ² I − μ C − K for the real μ and one μ of each complex pair, for one step size. With inverses in their place estimates of errors
/// near 1e-12 are worse.
#[derive(Clone, Debug)]
pub struct Factors {
    /// The step size, s; not a number where they belong to no matrix.
    pub h: f64,
    real: Factored<f64>,
    pairs: Vec<Factored<Complex<f64>>>,
    /// Right-hand sides of the halves a of solutions.
    right: Vec<f64>,
    half_pair: Vec<Complex<f64>>,
}

impl Factors {
    /// Room for f coordinates.
    pub fn new(f: usize, tables: &RadauTables) -> Self {
        Self {
            h: f64::NAN,
            real: Factored::new(f, 0.0),
            pairs: vec![Factored::new(f, Complex::new(0.0, 0.0)); tables.pairs.len()],
            right: vec![0.0; 2 * f],
            half_pair: vec![Complex::new(0.0, 0.0); f],
        }
    }

    /// They no longer belong to the matrices in use.
    pub fn forget(&mut self) {
        self.h = f64::NAN;
    }

    /// Finds those for a step of size h. False if a matrix is singular.
    pub fn factor(
        &mut self,
        RateJacobian { stiffness, damping, .. }: &RateJacobian,
        tables: &RadauTables,
        h: f64,
    ) -> bool {
        let f = stiffness.nrows();
        let both = || stiffness.as_slice().iter().zip(damping.as_slice());
        let mu = tables.real / h;
        let entries = both().map(|(k, c)| -mu * c - k);
        let mut regular = self.real.factor(f, entries, mu * mu);
        for (factors, pair) in self.pairs.iter_mut().zip(tables.pairs) {
            let mu = pair / h;
            regular &= factors.factor(f, both().map(|(k, c)| -mu * c - k), mu * mu);
        }
        self.h = if regular { h } else { f64::NAN };
        regular
    }

    /// (μ I − J)⁻¹ r with the real μ, in place. From the halves of (μ I − J)(a, b) = r:
    /// b = μ a − r_a, (μ² − μ C − K) a = r_b + (μ − C) r_a.
    pub fn solve_real(&mut self, jacobian: &RateJacobian, tables: &RadauTables, r: &mut [f64]) {
        let (f, mu) = (r.len() / 2, tables.real / self.h);
        let right = &mut self.right[..f];
        let (a, b) = r.split_at_mut(f);
        right.fill(0.0);
        add_product(&jacobian.damping, a, right);
        for (right, (a, b)) in right.iter_mut().zip(a.iter().zip(&*b)) {
            *right = b + mu * a - *right;
        }
        self.real.solve(right);
        for (half, (a, b)) in right.iter().zip(a.iter_mut().zip(b)) {
            (*a, *b) = (*half, mu * half - *a);
        }
    }

    /// The same with the complex μ of a pair: `r` has the real parts, `i` the imaginary ones.
    pub fn solve_pair(
        &mut self,
        jacobian: &RateJacobian,
        tables: &RadauTables,
        pair: usize,
        [r, i]: [&mut [f64]; 2],
    ) {
        let (f, mu) = (r.len() / 2, tables.pairs[pair] / self.h);
        let Self { half_pair, right, pairs, .. } = self;
        let ((ra, rb), (ia, ib)) = (r.split_at_mut(f), i.split_at_mut(f));
        right.fill(0.0);
        let (rr, ri) = right.split_at_mut(f);
        add_product(&jacobian.damping, ra, rr);
        add_product(&jacobian.damping, ia, ri);
        for (right, ((ra, ia), rb)) in rr.iter_mut().zip(ra.iter().zip(&*ia).zip(&*rb)) {
            *right = rb + mu.re * ra - mu.im * ia - *right;
        }
        for (right, ((ra, ia), ib)) in ri.iter_mut().zip(ra.iter().zip(&*ia).zip(&*ib)) {
            *right = ib + mu.re * ia + mu.im * ra - *right;
        }
        for (half, (re, im)) in half_pair.iter_mut().zip(rr.iter().zip(&*ri)) {
            *half = Complex::new(*re, *im);
        }
        pairs[pair].solve(half_pair);
        for ((half, r), (a, b)) in half_pair.iter().zip(ra.iter_mut().zip(rb)).zip(ia.iter_mut().zip(ib)) {
            let rate = half * mu;
            (*r.0, *r.1) = (half.re, rate.re - *r.0);
            (*a, *b) = (half.im, rate.im - *a);
        }
    }
}
