//! L bodies side by side: the part of the equations of motion that concerns each body alone — THEORY sections 7, 11.

use super::lanes::{Lane, Lifted, Triple, add_cross, add_scaled, cross, dot, multiply, scaled, zero};
use nalgebra::Vector3;
use std::ops::Range;

/// A feature of each of L bodies (or of none: all zero).
#[derive(Clone, Copy, Debug)]
pub struct Slot<const L: usize> {
    /// Local coordinates (ξ, η, ζ).
    pub local: Triple<L>,
    /// 1 for a point, 0 for a vector.
    pub point: Lane<L>,
}

impl<const L: usize> Slot<L> {
    /// C x for lifted vectors x.
    #[inline(always)]
    pub fn of(&self, x: &Lifted<L>) -> Triple<L> {
        let mut value = scaled(&self.point, &x[0]);
        for k in 0..3 {
            add_scaled(&mut value, &self.local[k], &x[1 + k]);
        }
        value
    }

    /// sum += Cᵀ f.
    #[inline(always)]
    pub fn pull_back(&self, f: &Triple<L>, sum: &mut Lifted<L>) {
        add_scaled(&mut sum[0], &self.point, f);
        for k in 0..3 {
            add_scaled(&mut sum[1 + k], &self.local[k], f);
        }
    }
}

/// L bodies: what never changes, what belongs to the point of expansion, and the solution at hand.
#[derive(Clone, Debug)]
pub struct Bundle<const L: usize> {
    /// The bodies; fewer than L in the last bundle, whose other lanes hold bodies at rest without joints.
    pub bodies: Range<usize>,
    /// Their features.
    pub slots: Range<usize>,
    /// 1/m.
    pub inverse_mass: Lane<L>,
    /// Ī of u, v, w.
    pub ibar: Triple<L>,
    /// Lent inertia.
    pub lent: Lane<L>,
    /// Constant generalized force: the weight.
    pub weight: Triple<L>,
    /// Half the dual basis of the directors.
    dual: [Triple<L>; 3],
    /// Rows of I_g⁻¹, lent inertia included.
    inverse: [Triple<L>; 3],
    /// Lower triangle (00, 10, 11, 20, 21, 22) of C⁻¹, I_g = C Cᵀ.
    lower: [Lane<L>; 6],
    /// Generalized force that acts, less the known convolutions.
    pub force: Lifted<L>,
    /// Moment about the centre of mass that acts besides.
    pub moment: Triple<L>,
    /// The unknown: κ Q_(n+2), or a correction of Q.
    pub solution: Lifted<L>,
    /// Its twist part ω̇, and the part for which lent inertia has been returned.
    omega: Triple<L>,
    returned: Triple<L>,
}

impl<const L: usize> Bundle<L> {
    /// Bodies of mass 1 and no inertia, to be filled in lane by lane.
    pub fn new(bodies: Range<usize>, slots: Range<usize>) -> Self {
        let zeros = [[0.0; L]; 3];
        Self {
            bodies,
            slots,
            inverse_mass: [1.0; L],
            ibar: [[1.0; L]; 3],
            lent: [0.0; L],
            weight: zeros,
            dual: [zeros; 3],
            inverse: [zeros; 3],
            lower: [[0.0; L]; 6],
            force: zero(),
            moment: zeros,
            solution: zero(),
            omega: zeros,
            returned: zeros,
        }
    }

    /// Dual basis and inertia at the position q.
    #[inline(always)]
    pub fn linearize(&mut self, q: &Lifted<L>) {
        let [_, u, v, w] = q;
        let dual = [cross(v, w), cross(w, u), cross(u, v)];
        let mut half = dot(u, &dual[0]);
        for l in 0..L {
            half[l] = 0.5 / half[l];
        }
        self.dual = dual.map(|d| scaled(&half, &d));
        // I_g = Σ Ī_k (|e_k|² 1 − e_k e_kᵀ), lower triangle.
        let mut inertia = [[0.0; L]; 6];
        for k in 0..3 {
            let e = &q[1 + k];
            for l in 0..L {
                let i = self.ibar[k][l];
                let (x, y, z) = (e[0][l], e[1][l], e[2][l]);
                inertia[0][l] += i * (y * y + z * z);
                inertia[1][l] -= i * (x * y);
                inertia[2][l] += i * (x * x + z * z);
                inertia[3][l] -= i * (x * z);
                inertia[4][l] -= i * (y * z);
                inertia[5][l] += i * (x * x + y * y);
            }
        }
        for l in 0..L {
            let lent = self.lent[l];
            let (a, b, c) = (inertia[0][l] + lent, inertia[2][l] + lent, inertia[5][l] + lent);
            let p0 = 1.0 / a.sqrt();
            let l10 = inertia[1][l] * p0;
            let l20 = inertia[3][l] * p0;
            let p1 = 1.0 / (b - l10 * l10).sqrt();
            let l21 = (inertia[4][l] - l20 * l10) * p1;
            let p2 = 1.0 / (c - l20 * l20 - l21 * l21).sqrt();
            let m10 = -l10 * p0 * p1;
            let m21 = -l21 * p1 * p2;
            let m20 = -(l20 * p0 + l21 * m10) * p2;
            let m = [p0, m10, p1, m20, m21, p2];
            for (lower, m) in self.lower.iter_mut().zip(m) {
                lower[l] = m;
            }
            let rows = [
                [p0 * p0 + m10 * m10 + m20 * m20, m10 * p1 + m20 * m21, m20 * p2],
                [m10 * p1 + m20 * m21, p1 * p1 + m21 * m21, m21 * p2],
                [m20 * p2, m21 * p2, p2 * p2],
            ];
            for (inverse, row) in self.inverse.iter_mut().zip(rows) {
                for (inverse, x) in inverse.iter_mut().zip(row) {
                    inverse[l] = x;
                }
            }
        }
    }

    /// C⁻¹ s̃ of a feature's arm s: three rows.
    #[inline(always)]
    pub fn half_mobility(&self, slot: &Slot<L>, q: &Lifted<L>) -> [Triple<L>; 3] {
        let mut arm = [[0.0; L]; 3];
        for k in 0..3 {
            add_scaled(&mut arm, &slot.local[k], &q[1 + k]);
        }
        let mut z = [[[0.0; L]; 3]; 3];
        let m = &self.lower;
        for l in 0..L {
            let (x, y, w) = (arm[0][l], arm[1][l], arm[2][l]);
            // s̃ = [[0, −w, y], [w, 0, −x], [−y, x, 0]].
            z[0][1][l] = -m[0][l] * w;
            z[0][2][l] = m[0][l] * y;
            z[1][0][l] = m[2][l] * w;
            z[1][1][l] = -m[1][l] * w;
            z[1][2][l] = m[1][l] * y - m[2][l] * x;
            z[2][0][l] = m[4][l] * w - m[5][l] * y;
            z[2][1][l] = m[5][l] * x - m[3][l] * w;
            z[2][2][l] = m[3][l] * y - m[4][l] * x;
        }
        z
    }

    /// Adds a force at a point of the body in a lane.
    pub fn add_force(&mut self, lane: usize, at: &Vector3<f64>, force: &Vector3<f64>) {
        for c in 0..3 {
            self.force[0][c][lane] += force[c];
            for k in 0..3 {
                self.force[1 + k][c][lane] += at[k] * force[c];
            }
        }
    }

    /// Adds a moment on the body in a lane.
    pub fn add_moment(&mut self, lane: usize, moment: &Vector3<f64>) {
        for c in 0..3 {
            self.moment[c][lane] += moment[c];
        }
    }

    /// Solution without the joints' forces, for right-hand sides Γ of the rigid-body rows and a known moment.
    #[inline(always)]
    pub fn begin(&mut self, q: &Lifted<L>, gamma: &[Lane<L>; 6], known: Triple<L>) {
        let mut moment = known;
        for c in 0..3 {
            for l in 0..L {
                moment[c][l] += self.moment[c][l];
            }
        }
        let [uu, vv, ww, uv, uw, vw] = gamma;
        let d = &self.dual;
        let mut particular = [[[0.0; L]; 3]; 3];
        for (out, row) in particular.iter_mut().zip([[uu, uv, uw], [uv, vv, vw], [uw, vw, ww]]) {
            for k in 0..3 {
                add_scaled(out, row[k], &d[k]);
            }
        }
        for k in 0..3 {
            let mut p = self.force[1 + k];
            for c in 0..3 {
                for l in 0..L {
                    p[c][l] -= self.ibar[k][l] * particular[k][c][l];
                }
            }
            add_cross(&mut moment, &q[1 + k], &p);
        }
        self.omega = multiply(&self.inverse, &moment);
        self.returned = [[0.0; L]; 3];
        self.solution[0] = scaled(&self.inverse_mass, &self.force[0]);
        for k in 0..3 {
            self.solution[1 + k] = particular[k];
            add_cross(&mut self.solution[1 + k], &self.omega, &q[1 + k]);
        }
    }

    /// Adds what further generalized forces do.
    #[inline(always)]
    pub fn apply(&mut self, q: &Lifted<L>, force: &Lifted<L>) {
        let mut moment = [[0.0; L]; 3];
        for k in 0..3 {
            add_cross(&mut moment, &q[1 + k], &force[1 + k]);
        }
        add_scaled(&mut self.solution[0], &self.inverse_mass, &force[0]);
        self.turn(q, &moment);
        for (sum, force) in self.force.as_flattened_mut().iter_mut().zip(force.as_flattened()) {
            for l in 0..L {
                sum[l] += force[l];
            }
        }
    }

    #[inline(always)]
    fn turn(&mut self, q: &Lifted<L>, moment: &Triple<L>) {
        let omega = multiply(&self.inverse, moment);
        for c in 0..3 {
            for l in 0..L {
                self.omega[c][l] += omega[c][l];
            }
        }
        for k in 0..3 {
            add_cross(&mut self.solution[1 + k], &omega, &q[1 + k]);
        }
    }

    /// One proximal step for bodies whose inertia was lent.
    #[inline(always)]
    pub fn return_lent(&mut self, q: &Lifted<L>) {
        let mut moment = [[0.0; L]; 3];
        for c in 0..3 {
            for l in 0..L {
                moment[c][l] = self.lent[l] * (self.omega[c][l] - self.returned[c][l]);
            }
        }
        self.returned = self.omega;
        self.turn(q, &moment);
    }

    /// p_k = P_k − Ī_k ë_k of the solution: what the directors' moments are made of.
    #[inline(always)]
    pub fn director_forces(&self) -> [Triple<L>; 3] {
        let mut p = [self.force[1], self.force[2], self.force[3]];
        for k in 0..3 {
            for c in 0..3 {
                for l in 0..L {
                    p[k][c][l] -= self.ibar[k][l] * self.solution[1 + k][c][l];
                }
            }
        }
        p
    }
}

/// −Σ e_k(i) · e_l(n−i) over 0 < i < n for the six rigid-body rows, from the series q.
#[inline(always)]
pub fn gram<const L: usize>(q: &[Lifted<L>], n: usize) -> [Lane<L>; 6] {
    let mut sums = [[0.0; L]; 6];
    let (heads, tails) = (q[1..n].iter(), q[1..n].iter().rev());
    for (a, b) in heads.zip(tails).take((n - 1) / 2) {
        add_symmetric(&mut sums, a, b);
    }
    if n.is_multiple_of(2) {
        let middle = &q[n / 2];
        let mut square = [[0.0; L]; 6];
        add_symmetric(&mut square, middle, middle);
        for k in 0..6 {
            for l in 0..L {
                sums[k][l] += 0.5 * square[k][l];
            }
        }
    }
    sums.map(|sum| sum.map(|x| -x))
}

/// Adds e_k · f_l + e_l · f_k for the six rigid-body rows uu, vv, ww, uv, uw, vw.
#[inline(always)]
fn add_symmetric<const L: usize>(sums: &mut [Lane<L>; 6], e: &Lifted<L>, f: &Lifted<L>) {
    for c in 0..3 {
        for l in 0..L {
            let [u, v, w] = [e[1][c][l], e[2][c][l], e[3][c][l]];
            let [x, y, z] = [f[1][c][l], f[2][c][l], f[3][c][l]];
            sums[0][l] += 2.0 * (u * x);
            sums[1][l] += 2.0 * (v * y);
            sums[2][l] += 2.0 * (w * z);
            sums[3][l] += u * y + v * x;
            sums[4][l] += u * z + w * x;
            sums[5][l] += v * z + w * y;
        }
    }
}

/// Σ_k Σ e_k(i) × p_k(n−i) over 0 < i ≤ n: the part of the moment that lower orders make.
#[inline(always)]
pub fn moment<const L: usize>(q: &[Lifted<L>], p: &[[Triple<L>; 3]], n: usize) -> Triple<L> {
    let mut sum = [[0.0; L]; 3];
    for (e, p) in q[1..=n].iter().zip(p[..n].iter().rev()) {
        for k in 0..3 {
            add_cross(&mut sum, &e[1 + k], &p[k]);
        }
    }
    sum
}

/// Entries e_k · f_l + e_l · f_k for the six rigid-body rows.
#[inline(always)]
pub fn symmetric<const L: usize>(e: &Lifted<L>, f: &Lifted<L>) -> [Lane<L>; 6] {
    let mut sums = [[0.0; L]; 6];
    add_symmetric(&mut sums, e, f);
    sums
}
