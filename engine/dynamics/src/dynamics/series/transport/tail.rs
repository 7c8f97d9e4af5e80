//! What the terms that a step leaves out are, as far as its last ones tell — eq. (11.11).
//!
//! Far from its start a series is that of its nearest singularities, a pair of conjugate times, which all coordinates of a mechanism have in
//! common: bₖ₊₁ ≈ c₁ bₖ + c₂ bₖ₋₁ for bₖ = Qₖ hᵏ, with the same two numbers for all of them.

use crate::dynamics::series::Bodies;
use triad_linalg::fma;

/// Terms that are looked at.
const LOOKED_AT: usize = 4;
/// What each term must be of the one before at most, on the whole, to go on like that.
const FALLS: f64 = 0.85;
/// Part of the squares of the last terms that may be left by the fit.
const MISFIT: f64 = 0.3;

/// How the terms of a step, cut at order p, go on.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tail {
    p: usize,
    h: f64,
    /// The size to the powers of p and p − 1.
    powers: [f64; 2],
    /// c₁ and c₂: zeros where the last terms do not tell.
    recurrence: [f64; 2],
}

impl Tail {
    /// Of a step of this order and size, whose terms are those of the motion alone or not.
    #[inline(always)]
    pub fn of<const L: usize, B: Bodies<L>>(
        series: &[B::Natural],
        stride: usize,
        order: usize,
        h: f64,
        is_own: bool,
    ) -> Self {
        let before = (1..order).fold(1.0, |power, _| power * h);
        let enough = is_own && order > LOOKED_AT;
        let products = if enough { products::<L, B>(series, stride, order, h) } else { Products::default() };
        let recurrence = recurrence(&products).unwrap_or_default();
        Self { p: order, h, powers: [before * h, before], recurrence }
    }

    /// What the coefficients of order p and p − 1 have to be multiplied with for what is left out after a part x of the step, of positions
    /// and rates.
    #[inline(always)]
    pub fn after(&self, x: f64) -> [[f64; 2]; 2] {
        let [positions, rates, _] = self.sums(x);
        self.in_time([positions, rates])
    }

    /// The same at the end of the step, and of accelerations there, beyond hᵖ⁻² and hᵖ⁻³.
    #[inline(always)]
    pub fn at_end(&self) -> ([[f64; 2]; 2], [f64; 2]) {
        let [positions, rates, accelerations] = self.sums(1.0);
        (self.in_time([positions, rates]), accelerations)
    }

    #[inline(always)]
    fn in_time(&self, [positions, rates]: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
        let by = |sums: [f64; 2], steps: f64| [0, 1].map(|k| sums[k] * self.powers[k] / steps);
        [by(positions, 1.0), by(rates, self.h)]
    }

    /// Sums of the terms that are left out and of those of their derivatives with respect to x, in parts of the last two terms. Those of one
    /// pair of times have a sum, xᵖ G(x) with G = N/D.
    #[inline(always)]
    fn sums(&self, x: f64) -> [[f64; 2]; 3] {
        let Self { recurrence: [c1, c2], .. } = *self;
        let p = self.p as f64;
        let power = (2..self.p).fold(1.0, |power, _| power * x);
        let d = [1.0 - x * fma(c2, x, c1), -fma(2.0 * c2, x, c1), -2.0 * c2];
        let numerators = [[x * fma(c2, x, c1), fma(2.0 * c2, x, c1), 2.0 * c2], [c2 * x, c2, 0.0]];
        let mut sums = [[0.0; 2]; 3];
        for (k, n) in numerators.iter().enumerate() {
            let g = n[0] / d[0];
            let g1 = fma(-g, d[1], n[1]) / d[0];
            let g2 = fma(-2.0 * g1, d[1], fma(-g, d[2], n[2])) / d[0];
            sums[0][k] = power * x * x * g;
            sums[1][k] = power * x * fma(x, g1, p * g);
            sums[2][k] = power * fma(x, fma(x, g2, 2.0 * p * g1), p * (p - 1.0) * g);
        }
        sums
    }
}

/// Sums of products of the last terms of all coordinates, the last first, in units of hᵖ.
type Products = [[f64; LOOKED_AT]; LOOKED_AT];

#[inline(always)]
fn products<const L: usize, B: Bodies<L>>(
    series: &[B::Natural],
    stride: usize,
    order: usize,
    h: f64,
) -> Products {
    let mut sums = [[[0.0; 4]; LOOKED_AT]; LOOKED_AT];
    for terms in series.chunks(stride) {
        let last = [0, 1, 2, 3].map(|back| B::fours(&terms[order - back]));
        for at in 0..last[0].len() {
            let last = last.map(|term| term[at]);
            for i in 0..LOOKED_AT {
                for j in i..LOOKED_AT.min(i + 3) {
                    for l in 0..4 {
                        sums[i][j][l] = fma(last[i][l], last[j][l], sums[i][j][l]);
                    }
                }
            }
        }
    }
    let mut products = Products::default();
    for i in 0..LOOKED_AT {
        for j in i..LOOKED_AT.min(i + 3) {
            let [a, b, c, d] = sums[i][j];
            products[i][j] = ((a + b) + (c + d)) / (0..i + j).fold(1.0, |power, _| power * h);
            products[j][i] = products[i][j];
        }
    }
    products
}

/// c₁ and c₂ by least squares: of the last term, and of the one before, each in parts of the one that it follows.
fn recurrence(products: &Products) -> Option<[f64; 2]> {
    let sum = |i: usize, j: usize| products[i][j] / products[1][1] + products[i + 1][j + 1] / products[2][2];
    let (b00, b01, b02) = (sum(0, 0), sum(0, 1), sum(0, 2));
    let (b11, b12, b22) = (sum(1, 1), sum(1, 2), sum(2, 2));
    let determinant = fma(b11, b22, -b12 * b12);
    let c1 = fma(b01, b22, -b02 * b12) / determinant;
    let c2 = fma(b11, b02, -b12 * b01) / determinant;
    let left = b00 - c1 * b01 - c2 * b02;
    // Jury's conditions for both roots of x² = c₁ x + c₂ to be below FALLS.
    let (d1, d2) = (c1 / FALLS, c2 / (FALLS * FALLS));
    (-d2 < 1.0 && d1.abs() < 1.0 - d2 && left <= MISFIT * b00).then_some([c1, c2])
}
