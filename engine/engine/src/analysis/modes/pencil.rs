//! The eigenvalue problem (λ² M + λ C + K) x = 0 of small motions.
//!
//! M is the identity of the motions with inertia and zero for those without, which C then moves at first order. Slow decays
//! stand beside fast ones: eigenvalues range over many orders, and one QR algorithm has the error of the largest in all of
//! them. The large half is therefore taken from the matrix, the small half from its inverse, and each is put right by
//! Rayleigh's quotient of the quadratic problem itself.

use nalgebra::{Complex, ComplexField, DMatrix, DVector, Schur, SymmetricEigen};
use triad_linalg::left_null_space;

/// Sweeps of the QR algorithm before it is given up.
const SWEEPS: usize = 100_000;
/// Part of the terms of an eigenvalue's equation that is rounding.
const ROUNDED: f64 = f64::EPSILON;
/// Relative distance from an eigenvalue at which its vector is found by inverse iteration.
const BESIDE: f64 = 1e-8;
/// Solutions of one inverse iteration: each takes away all but 1e-8 of what does not belong.
const SOLUTIONS: usize = 3;
/// Rounds of inverse iteration and Rayleigh's quotient for one eigenvalue.
const ROUNDS: usize = 3;
/// Relative distance at which two eigenvalues count as one, with vectors of their own.
const REPEATED: f64 = 1e-7;
/// Ratio of singular values below which equal eigenvalues have fewer vectors than there are of them.
const DEFECTIVE: f64 = 1e-6;
/// Ratio of two eigenvalues' moduli up to which one half must not end between them.
const EQUALLY_LARGE: f64 = 1.001;
/// A correction of an eigenvalue by more than this part of it is a jump to another one, and not taken.
const JUMP: f64 = 1e-2;

type Vector = DVector<Complex<f64>>;
type Matrix = DMatrix<Complex<f64>>;

/// An eigenvalue λ with x and y, (λ² M + λ C + K) x = 0 and yᴴ (λ² M + λ C + K) = 0.
struct Pair {
    value: Complex<f64>,
    x: Vector,
    y: Vector,
}

impl Pair {
    /// Whether a value counts as one with its own.
    fn is_near(&self, value: Complex<f64>) -> bool {
        (self.value - value).modulus() <= REPEATED * value.modulus()
    }
}

/// One solution x e^(λt); of a pair of conjugates, the one with Im λ > 0.
#[derive(Clone, Debug)]
pub struct Eigen {
    /// λ, 1/s.
    pub value: Complex<f64>,
    /// x, its largest entry real.
    pub vector: Vector,
    /// What the rounding of the matrices and what x leaves of the equation may do to λ, 1/s.
    pub rounding: f64,
}

/// λ² M + λ C + K.
pub struct Pencil {
    /// Motions with inertia; they come first.
    pub inertial: usize,
    /// K.
    pub stiffness: DMatrix<f64>,
    /// C, the sum of the next two.
    pub damping: DMatrix<f64>,
    /// d and g of each damper, Σ d g gᵀ. What a strong damper hardly feels would be lost in the rounding of the sum.
    pub dampers: Vec<(f64, DVector<f64>)>,
    /// Gyroscopic part of C.
    pub gyroscopic: DMatrix<f64>,
    /// Orthonormal motions x with K x = 0.
    pub drifts: DMatrix<f64>,
    /// Those among them with xᵀ C x = 0 as well, likewise.
    pub undamped: DMatrix<f64>,
}

impl Pencil {
    /// Without damping, K symmetric: λ² = −(eigenvalue of K). Of a growing motion and the decaying one that goes with it,
    /// the growing one is told. Drifts are not among them.
    pub fn undamped(&self) -> Vec<Eigen> {
        let across = left_null_space(&self.drifts, BESIDE);
        let stiffness = across.tr_mul(&self.stiffness) * &across;
        if stiffness.is_empty() {
            return Vec::new();
        }
        let eigen = SymmetricEigen::new((&stiffness + stiffness.transpose()) * 0.5);
        let pairs = eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter());
        pairs
            .map(|(&square, column)| {
                let value = if square >= 0.0 {
                    Complex::new(0.0, square.sqrt())
                } else {
                    Complex::new((-square).sqrt(), 0.0)
                };
                let vector = (&across * column).map(|x| Complex::new(x, 0.0));
                Eigen { value, rounding: self.rounding(value, &vector, &vector), vector }
            })
            .collect()
    }

    /// With damping, or where K is not symmetric. Drifts are not among them. `None` where the QR algorithm fails.
    pub fn damped(&self) -> Option<Vec<Eigen>> {
        let mut found: Vec<Pair> = Vec::new();
        for value in
            spectrum(&self.first_order())?.into_iter().map(real_twice).filter(|value| value.im >= 0.0)
        {
            let known: Vec<&Pair> = found.iter().filter(|other| other.is_near(value)).collect();
            let pair = self.refined(value, &known);
            found.push(pair);
        }
        let mut left: Vec<usize> = (0..found.len()).collect();
        while let Some(first) = left.pop() {
            let value = found[first].value;
            let (near, others) = left.into_iter().partition(|&k| found[k].is_near(value));
            left = others;
            let group = [vec![first], near].concat();
            if let Some(pairs) = self.separated(&group.iter().map(|&k| &found[k]).collect::<Vec<_>>()) {
                group.into_iter().zip(pairs).for_each(|(k, pair)| found[k] = pair);
            }
        }
        Some(found.into_iter().map(|pair| self.eigen(pair)).collect())
    }

    /// ẋ = A x of what drifts do not touch: positions across the drifts, then the velocities of motions with inertia.
    fn first_order(&self) -> DMatrix<f64> {
        let (r, n) = (self.inertial, self.stiffness.ncols());
        let c = n - r;
        let across = left_null_space(&self.drifts, BESIDE);
        let rho = across.ncols();
        let stiffness = &self.stiffness * &across;
        // ẋ of motions without inertia: −C_cc⁻¹ (K x + C_cr v).
        let inner = self.damping.view((r, r), (c, c)).into_owned();
        let creep = |right: DMatrix<f64>| -solve(inner.clone(), &right);
        let creep_by_position = creep(stiffness.rows(r, c).into_owned());
        let creep_by_velocity = creep(self.damping.view((r, 0), (c, r)).into_owned());
        let coupling = self.damping.view((0, r), (r, c));
        let mut velocity_of = DMatrix::zeros(n, rho + r);
        velocity_of.view_mut((0, rho), (r, r)).fill_with_identity();
        velocity_of.view_mut((r, 0), (c, rho)).copy_from(&creep_by_position);
        velocity_of.view_mut((r, rho), (c, r)).copy_from(&creep_by_velocity);
        let mut a = DMatrix::zeros(rho + r, rho + r);
        a.rows_mut(0, rho).copy_from(&across.tr_mul(&velocity_of));
        let by_position = -stiffness.rows(0, r) - coupling * creep_by_position;
        let by_velocity = -self.damping.view((0, 0), (r, r)) - coupling * creep_by_velocity;
        a.view_mut((rho, 0), (r, rho)).copy_from(&by_position);
        a.view_mut((rho, rho), (r, r)).copy_from(&by_velocity);
        // A drift that nothing damps keeps its velocity, while the others stand where gyroscopic forces put them: that direction is
        // left out with it.
        let mut steady = DMatrix::zeros(rho + r, self.undamped.ncols());
        if !steady.is_empty() {
            let forces = across.tr_mul(&(&self.damping * &self.undamped));
            steady.rows_mut(0, rho).copy_from(&-solve(across.tr_mul(&stiffness), &forces));
            steady.rows_mut(rho, r).copy_from(&self.undamped.rows(0, r));
            steady = steady.qr().q();
        }
        let keep = left_null_space(&steady, BESIDE);
        keep.tr_mul(&a) * keep
    }

    /// 2 λ M + C.
    fn slope_at(&self, value: Complex<f64>) -> Matrix {
        let mut slope = self.damping.map(real);
        (0..self.inertial).for_each(|i| slope[(i, i)] += value * 2.0);
        slope
    }

    /// λ² M + λ C + K.
    fn at(&self, value: Complex<f64>) -> Matrix {
        DMatrix::from_fn(self.stiffness.nrows(), self.stiffness.ncols(), |i, j| {
            let mass = if i == j && i < self.inertial { value * value } else { Complex::new(0.0, 0.0) };
            mass + value * self.damping[(i, j)] + self.stiffness[(i, j)]
        })
    }

    /// The vectors of an eigenvalue by inverse iteration, across those of equal ones that are known, and the value by Rayleigh's quotient.
    fn refined(&self, guess: Complex<f64>, known: &[&Pair]) -> Pair {
        let n = self.stiffness.ncols();
        let mut value = guess;
        let mut x = Vector::from_fn(n, |i, _| Complex::new(1.0 + 0.3 * i as f64, 0.1));
        let mut y = x.clone();
        for _ in 0..ROUNDS {
            let matrix = self.at(value * Complex::new(1.0 + BESIDE, BESIDE));
            let (lu, adjoint) = (matrix.clone().lu(), matrix.adjoint().lu());
            for _ in 0..SOLUTIONS {
                for other in known {
                    take_away(&mut x, &other.x);
                    take_away(&mut y, &other.y);
                }
                solve_unit(&lu, &mut x);
                solve_unit(&adjoint, &mut y);
            }
            match self.quotient(value, &x, &y) {
                Some(better) if (better - value).modulus() <= JUMP * value.modulus() => value = better,
                _ => break,
            }
        }
        // A real eigenvalue stays real, and a pair a pair.
        if guess.im == 0.0 {
            value.im = 0.0;
        }
        Pair { value, x, y }
    }

    /// Eigenvalues that are nearly equal, of whose vectors inverse iteration finds any that span the same space: from the small pencil in
    /// that space. `None` of one alone, and where there are fewer vectors than eigenvalues.
    fn separated(&self, group: &[&Pair]) -> Option<Vec<Pair>> {
        let count = group.len();
        if count < 2 || count > self.stiffness.ncols() {
            return None;
        }
        let center = group.iter().map(|pair| pair.value).sum::<Complex<f64>>() / real(count as f64);
        let [x, y] = [|pair: &Pair| pair.x.clone(), |pair: &Pair| pair.y.clone()]
            .map(|side| Matrix::from_columns(&group.iter().map(|pair| side(pair)).collect::<Vec<_>>()));
        let slope = y.adjoint() * self.slope_at(center) * &x;
        let sizes = slope.singular_values();
        if sizes.min() <= DEFECTIVE * sizes.max() {
            return None;
        }
        let inverse = slope.try_inverse()?;
        let small = &inverse * (y.adjoint() * self.at(center) * &x) * real(-1.0);
        let (unitary, triangle) = Schur::try_new(small, f64::EPSILON, SWEEPS)?.unpack();
        let vectors = unitary * vectors_of(&triangle);
        let (x, y) = (x * &vectors, y * (vectors.try_inverse()? * inverse).adjoint());
        let pair = |k: usize| {
            let (x, y) = (x.column(k).normalize(), y.column(k).normalize());
            let value = self.quotient(center + triangle[(k, k)], &x, &y)?;
            let value = if center.im == 0.0 { real(value.re) } else { value };
            ((value - center).modulus() <= JUMP * center.modulus()).then_some(Pair { value, x, y })
        };
        (0..count).map(pair).collect()
    }

    fn eigen(&self, Pair { value, x, y }: Pair) -> Eigen {
        let largest = x.iter().copied().fold(real(0.0), |a, b| if b.modulus() > a.modulus() { b } else { a });
        let phase = largest.conj() / largest.modulus().max(f64::MIN_POSITIVE);
        let rounding = self.rounding(value, &x, &y);
        Eigen { value, vector: x * phase, rounding }
    }

    /// How far the root next to λ of yᴴ (λ² M + λ C + K) x = 0 is moved by rounding of its terms, and by what x leaves of the equation: it
    /// grows with the root of them where two eigenvalues meet.
    fn rounding(&self, value: Complex<f64>, x: &Vector, y: &Vector) -> f64 {
        let n = x.len();
        let (mut terms, mut slope) = (0.0, Complex::new(0.0, 0.0));
        for j in 0..n {
            for i in 0..n {
                let both = y[i].conj() * x[j];
                let sizes = value.modulus() * self.damping[(i, j)].abs() + self.stiffness[(i, j)].abs();
                terms += both.modulus() * sizes;
                slope += both * self.damping[(i, j)];
            }
        }
        let mass: Complex<f64> = (0..self.inertial).map(|i| y[i].conj() * x[i]).sum();
        terms += value.norm_sqr() * mass.modulus();
        slope += value * mass * 2.0;
        let left = y.norm() * (self.at(value) * x).norm();
        let moved = ROUNDED * terms + left;
        let (slope, curvature) = (slope.modulus(), mass.modulus());
        let root = (slope * slope + 4.0 * curvature * moved).sqrt();
        2.0 * moved / (slope + root).max(f64::MIN_POSITIVE)
    }

    /// The root next to `value` of yᴴ (λ² M + λ C + K) x = 0 — eq. (10.14).
    fn quotient(&self, value: Complex<f64>, x: &Vector, y: &Vector) -> Option<Complex<f64>> {
        let form = |matrix: &DMatrix<f64>| {
            let mut sum = Complex::new(0.0, 0.0);
            for (j, x) in x.iter().enumerate() {
                for (i, y) in y.iter().enumerate() {
                    sum += y.conj() * x * matrix[(i, j)];
                }
            }
            sum
        };
        let a: Complex<f64> = (0..self.inertial).map(|i| y[i].conj() * x[i]).sum();
        let product =
            |g: &DVector<f64>, z: &Vector| -> Complex<f64> { g.iter().zip(z).map(|(g, z)| z * *g).sum() };
        let damped: Complex<f64> =
            self.dampers.iter().map(|(d, g)| product(g, y).conj() * product(g, x) * *d).sum();
        let (b, c) = (form(&self.gyroscopic) + damped, form(&self.stiffness));
        let root = ComplexField::sqrt(b * b - a * c * 4.0);
        // The sum without cancellation first, the other root from the product of both.
        let sum = if (b.conj() * root).re >= 0.0 { b + root } else { b - root } * -0.5;
        [sum / a, c / sum]
            .into_iter()
            .filter(|root| root.re.is_finite() && root.im.is_finite())
            .min_by(|p, q| (p - value).modulus().total_cmp(&(q - value).modulus()))
    }
}

fn real(x: f64) -> Complex<f64> {
    Complex::new(x, 0.0)
}

/// Takes the part across another vector, unless that is none: equal eigenvalues may have one vector.
fn take_away(x: &mut Vector, other: &Vector) {
    let along = other.dotc(x) / real(other.norm_squared());
    let across = &*x - other * along;
    if across.norm() > BESIDE * x.norm() {
        *x = across;
    }
}

/// Eigenvectors of an upper triangle, its diagonal in order, as columns; equal eigenvalues have the vectors of the triangle's own basis.
fn vectors_of(triangle: &Matrix) -> Matrix {
    let count = triangle.nrows();
    let least = f64::EPSILON * triangle.norm();
    let mut vectors = Matrix::identity(count, count);
    for k in 1..count {
        for i in (0..k).rev() {
            let rest: Complex<f64> = (i + 1..=k).map(|j| triangle[(i, j)] * vectors[(j, k)]).sum();
            let apart = triangle[(k, k)] - triangle[(i, i)];
            vectors[(i, k)] = if apart.modulus() > least { rest / apart } else { real(0.0) };
        }
    }
    vectors
}

/// The solution of a system that was chosen regular.
pub fn solve(matrix: DMatrix<f64>, right: &DMatrix<f64>) -> DMatrix<f64> {
    if right.is_empty() {
        return right.clone();
    }
    matrix.lu().solve(right).unwrap_or_else(|| DMatrix::zeros(right.nrows(), right.ncols()))
}

/// Rounding makes a pair of conjugates of two real eigenvalues that are equal: both are told as real.
fn real_twice(value: Complex<f64>) -> Complex<f64> {
    if value.im.abs() <= REPEATED * value.re.abs() { Complex::new(value.re, 0.0) } else { value }
}

fn solve_unit(lu: &nalgebra::LU<Complex<f64>, nalgebra::Dyn, nalgebra::Dyn>, x: &mut Vector) {
    if let Some(next) = lu.solve(x) {
        let norm = next.norm();
        if norm.is_finite() && norm > 0.0 {
            *x = next.unscale(norm);
        }
    }
}

/// Eigenvalues, smallest first: the small half of them from the inverse.
fn spectrum(a: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    if a.is_empty() {
        return Some(Vec::new());
    }
    let of = |matrix: DMatrix<f64>| {
        let schur = Schur::try_new(matrix, f64::EPSILON, SWEEPS)?;
        Some(schur.complex_eigenvalues().iter().copied().collect::<Vec<_>>())
    };
    let by_size = |values: &mut Vec<Complex<f64>>| {
        values.sort_by(|p, q| p.modulus().total_cmp(&q.modulus()).then(p.im.total_cmp(&q.im)));
    };
    let mut large = of(a.clone())?;
    by_size(&mut large);
    let Some(mut small) = a.clone().try_inverse().and_then(of) else { return Some(large) };
    for value in &mut small {
        *value = value.inv();
    }
    by_size(&mut small);
    let (least, most) = (small.first()?.modulus(), large.last()?.modulus());
    let middle = (least * most).sqrt();
    let mut count = small.iter().take_while(|value| value.modulus() < middle).count();
    // What is equally large, such as a pair of conjugates, is not cut: rounding puts it in another order in the other list, and some
    // would come twice and others not at all.
    while (1..small.len()).contains(&count)
        && [&small, &large]
            .iter()
            .any(|list| list[count].modulus() <= EQUALLY_LARGE * list[count - 1].modulus())
    {
        count += 1;
    }
    if small[..count].iter().all(|value| value.modulus().is_finite()) {
        large.splice(..count, small.drain(..count));
    }
    Some(large)
}
