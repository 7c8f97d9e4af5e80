//! The iteration that takes the effect of inertia regularization out again — eq. (7.8).

/// Most steps of it.
pub const PROXIMAL_STEPS: usize = 300;
/// The fewest where it does not end by itself before.
const FEWEST: usize = 3;
/// Part of the last correction above which the next one is no smaller, and part of the multipliers below which both are then rounding.
const STALLED: f64 = 0.95;
const NEAR_ROUNDING: f64 = 1e-11;
/// Part of the multipliers below which a correction is rounding.
const ROUNDING: f64 = 1e-15;

/// How far the iteration has come.
#[derive(Clone, Copy, Debug)]
pub struct Proximal {
    first: f64,
    last: f64,
    steps: usize,
}

impl Proximal {
    /// Begins with a solution of this size.
    pub fn begin(first: f64) -> Self {
        Self { first, last: first, steps: 0 }
    }

    /// Part of what it has found that the last step has added, if nothing but steps as large as the first has led there.
    pub fn part_of_equal_steps(&self) -> f64 {
        1.0 / (self.steps + 1) as f64
    }

    /// Whether it ends with a correction of this size; `early` is whether it may before it has made some steps.
    pub fn ends(&mut self, size: f64, early: bool) -> bool {
        self.steps += 1;
        let enough = self.steps >= FEWEST;
        // Corrections shrink by the same factor each time: the next one would be size²/last.
        let small = self.first > 0.0 && size * size <= ROUNDING * self.first * self.last;
        let stalled = size >= STALLED * self.last && size <= NEAR_ROUNDING * self.first;
        let ends = small && (enough || early) || enough && stalled;
        self.last = size;
        ends
    }
}
