//! The iteration that takes the effect of inertia regularization out again — eq. (7.8).

/// Most steps of it.
pub const PROXIMAL_STEPS: usize = 300;
/// The fewest where it does not end by itself before.
const FEWEST: usize = 3;
/// Part of the last correction above which the next one is no smaller, and part of the multipliers below which both are then rounding.
const STALLED: f64 = 0.95;
const NEAR_ROUNDING: f64 = 1e-11;
/// Part of δ below which the inertia that joints lend is next to none.
const WEAK: f64 = 0.03;
/// Part of the multipliers below which a correction is rounding.
const ROUNDING: f64 = 1e-15;

/// How far the iteration has come.
#[derive(Clone, Copy, Debug)]
pub struct Proximal {
    first: f64,
    last: f64,
    before: f64,
    steps: usize,
    fewest: usize,
}

impl Proximal {
    /// Begins with a solution of this size; `fewest` is how many steps it takes at least.
    pub fn begin(first: f64, fewest: usize) -> Self {
        Self { first, last: first, before: first, steps: 0, fewest: fewest.max(FEWEST) }
    }

    /// How many steps leave nothing but rounding where each leaves this part of the last one.
    pub fn steps_for(part: f64) -> usize {
        std::iter::successors(Some(1.0), |left| Some(left * part))
            .take(PROXIMAL_STEPS)
            .take_while(|left| *left > ROUNDING)
            .count()
    }

    /// Part of what it has found that the last step has added, if nothing but steps as large as the first has led there.
    pub fn part_of_equal_steps(&self) -> f64 {
        1.0 / (self.steps + 1) as f64
    }

    /// Whether it has hardly got on: the last step leaves δ/(δ + I) of the one before.
    pub fn is_slow(&self) -> bool {
        self.steps == PROXIMAL_STEPS
            && self.last > NEAR_ROUNDING * self.first
            && self.last * (1.0 + WEAK) > self.before
    }

    /// Whether it ends with a correction of this size.
    pub fn ends(&mut self, size: f64) -> bool {
        self.steps += 1;
        // Corrections shrink by the same factor each time: the next one would be size²/last.
        let small = self.first > 0.0 && size * size <= ROUNDING * self.first * self.last;
        let stalled = size >= STALLED * self.last && size <= NEAR_ROUNDING * self.first;
        let ends = self.steps >= self.fewest && (small || stalled);
        (self.before, self.last) = (self.last, size);
        ends
    }
}
