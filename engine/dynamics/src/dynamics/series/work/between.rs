//! Work within a step as a polynomial through powers in it, where series of the power do not reach as far as those of the motion.

use std::f64::consts::PI;
use triad_linalg::largest_size;

/// Intervals of Chebyshev's extreme points at first and at most: each doubling keeps those that are known.
const FIRST: usize = 8;
const MOST: usize = 64;
/// Part of the step in which the series have converged, and know small works to more digits.
const EARLY: f64 = 0.125;
/// Part of the largest power below which coefficients are rounding.
const ROUNDING: f64 = 1e-13;

/// Work from the start of a step, in Chebyshev's polynomials over it.
#[derive(Clone, Debug, Default)]
pub struct WorkBetween {
    /// Size of the step, s; zero where the series of the power do.
    h: f64,
    /// Powers in these places, from the end of the step to its start, and the coefficients of the work.
    powers: Vec<f64>,
    coefficients: Vec<f64>,
}

impl WorkBetween {
    /// With room for all that steps may ask for.
    pub fn new() -> Self {
        Self { h: 0.0, powers: Vec::with_capacity(MOST + 1), coefficients: Vec::with_capacity(MOST + 2) }
    }

    /// Nothing is known of the next step.
    pub fn forget(&mut self) {
        self.h = 0.0;
    }

    /// Finds the work of a step of size h from powers within it, as many as the tolerance asks for. Where there is none, nothing is found.
    pub fn find(&mut self, h: f64, tolerance: f64, mut power_at: impl FnMut(f64) -> f64) {
        self.h = 0.0;
        self.powers.clear();
        let mut count = FIRST;
        loop {
            let known = !self.powers.is_empty();
            let place = |i: usize| 0.5 * h * (1.0 + libm::cos(PI * i as f64 / count as f64));
            if known {
                self.powers.resize(count + 1, 0.0);
                for i in (0..=count / 2).rev() {
                    self.powers.swap(i, 2 * i);
                }
                for i in (1..count).step_by(2) {
                    self.powers[i] = power_at(place(i));
                }
            } else {
                self.powers.extend((0..=count).map(|i| power_at(place(i))));
            }
            let size = largest_size(&self.powers);
            if !self.powers.iter().all(|p| p.is_finite()) {
                return;
            }
            self.transform();
            let last = largest_size(&self.coefficients[count - 2..]);
            if count == MOST || last <= tolerance.max(ROUNDING) * size {
                break;
            }
            count *= 2;
        }
        self.integrate(h);
        self.h = h;
    }

    /// Coefficients of the power from its values.
    fn transform(&mut self) {
        let count = self.powers.len() - 1;
        let mut cosines = [0.0; 2 * MOST];
        for (i, cosine) in cosines.iter_mut().enumerate().take(2 * count) {
            *cosine = libm::cos(PI * i as f64 / count as f64);
        }
        let halved = |i: usize| if i == 0 || i == count { 0.5 } else { 1.0 };
        self.coefficients.clear();
        self.coefficients.extend((0..=count).map(|k| {
            let terms = self.powers.iter().enumerate();
            let sum: f64 = terms.map(|(i, p)| halved(i) * p * cosines[i * k % (2 * count)]).sum();
            2.0 * halved(k) * sum / count as f64
        }));
    }

    /// Those of its integral from the start of a step of size h.
    fn integrate(&mut self, h: f64) {
        let a = &mut self.coefficients;
        let count = a.len();
        a.push(0.0);
        let mut before = 2.0 * a[0];
        let (mut sum, mut sign) = (0.0, 1.0);
        for k in 1..=count {
            let next = a.get(k + 1).copied().unwrap_or(0.0);
            let integral = 0.25 * h * (before - next) / k as f64;
            before = a[k];
            a[k] = integral;
            sum += sign * integral;
            sign = -sign;
        }
        a[0] = sum;
    }

    /// The work in a time τ, J, where it is known this way.
    pub fn at(&self, tau: f64) -> Option<f64> {
        if self.h == 0.0 || tau <= EARLY * self.h {
            return None;
        }
        let x = 2.0 * tau / self.h - 1.0;
        let (mut next, mut after) = (0.0, 0.0);
        for c in self.coefficients.iter().skip(1).rev() {
            (next, after) = (c + 2.0 * x * next - after, next);
        }
        Some(self.coefficients.first().map_or(0.0, |c| c + x * next - after))
    }
}
