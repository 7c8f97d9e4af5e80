//! The multipliers μ of what bodies without inertia share.

use triad_linalg::fma;

/// δ (ω̇ − what the iteration began with) is Dx − Aᵀμ with A x = 0 — eq. (11.18). Each direction p of the iteration is such a sum too, with
/// multipliers that are known when it ends: `count` times all that it has added to λ, less `ahead`.
#[derive(Clone, Debug)]
pub struct SharedMultipliers {
    /// μ, when the iteration has ended.
    pub value: Vec<f64>,
    /// What it has added to λ.
    pub added: Vec<f64>,
    /// What joints answer to the residual, and to the direction.
    pub answer: Vec<f64>,
    along: Vec<f64>,
    ahead: Vec<f64>,
    count: f64,
    total: f64,
}

impl SharedMultipliers {
    pub fn new(rows: usize) -> Self {
        let zeros = || vec![0.0; rows];
        Self {
            value: zeros(),
            added: zeros(),
            answer: zeros(),
            along: zeros(),
            ahead: zeros(),
            count: 0.0,
            total: 0.0,
        }
    }

    #[inline(always)]
    pub fn begin(&mut self) {
        self.value.fill(0.0);
        self.added.fill(0.0);
        self.ahead.fill(0.0);
        self.along.fill(0.0);
        (self.count, self.total) = (0.0, 0.0);
    }

    /// The next direction is the residual, and this part of the last one.
    #[inline(always)]
    pub fn next_direction(&mut self, beta: f64) {
        for (along, answer) in self.along.iter_mut().zip(&self.answer) {
            *along = fma(beta, *along, *answer);
        }
        self.count = fma(beta, self.count, 1.0);
        for (ahead, added) in self.ahead.iter_mut().zip(&self.added) {
            *ahead = fma(beta, *ahead, *added);
        }
    }

    /// A step of this length along it.
    #[inline(always)]
    pub fn step(&mut self, alpha: f64) {
        self.total = fma(alpha, self.count, self.total);
        for (value, ahead) in self.value.iter_mut().zip(&self.ahead) {
            *value = fma(alpha, *ahead, *value);
        }
        for (added, along) in self.added.iter_mut().zip(&self.along) {
            *added = fma(alpha, *along, *added);
        }
    }

    #[inline(always)]
    pub fn end(&mut self) {
        for (value, added) in self.value.iter_mut().zip(&self.added) {
            *value = fma(-self.total, *added, *value);
        }
    }
}
