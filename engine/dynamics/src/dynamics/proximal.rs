//! The iteration that takes the effect of inertia regularization out again — eq. (7.8).

/// Most steps of it.
pub const PROXIMAL_STEPS: usize = 30;
/// The fewest where it does not end by itself before.
const FEWEST: usize = 3;
/// Part of the last correction above which the next one is no smaller: both are rounding.
const STALLED: f64 = 0.95;
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

    /// Whether it ends with a correction of this size; `early` is whether it may before it has made some steps.
    pub fn ends(&mut self, size: f64, early: bool) -> bool {
        self.steps += 1;
        let enough = self.steps >= FEWEST;
        // Corrections shrink by the same factor each time: the next one would be size²/last.
        let small = self.first > 0.0 && size * size <= ROUNDING * self.first * self.last;
        let ends = small && (enough || early) || enough && size >= STALLED * self.last;
        self.last = size;
        ends
    }
}
