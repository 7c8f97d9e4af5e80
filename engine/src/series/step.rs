//! One step of the series: expand, choose how far the terms reach, move there, and project.

use super::Series;
use pulp::{Arch, Simd, WithSimd};

/// A correction of positions above this part of the tolerance calls for a new factor.
const NEGLIGIBLE: f64 = 0.01;
/// A Newton step of this size, relative to the mechanism, leaves an error of its square.
const CONSISTENT: f64 = 1e-7;

/// What a step has to do.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Highest order of the series.
    pub order: usize,
    /// Relative and absolute tolerance.
    pub tolerance: f64,
    /// A length of the mechanism, m.
    pub length: f64,
    /// Time left to the end, s: no step is longer.
    pub left: f64,
}

/// What a step was.
#[derive(Clone, Copy, Debug)]
pub struct Taken {
    /// Its size, s.
    pub h: f64,
    /// The order at which the series was cut.
    pub order: usize,
    /// Whether the new state is made of finite numbers.
    pub finite: bool,
}

/// A step, to be compiled for each set of vector instructions.
struct Step<'a, const L: usize>(&'a mut Series<L>, Plan);

impl<const L: usize> WithSimd for Step<'_, L> {
    type Output = Taken;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Taken {
        self.0.step_here(self.1)
    }
}

/// A factorization, likewise.
struct Linearize<'a, const L: usize>(&'a mut Series<L>);

impl<const L: usize> WithSimd for Linearize<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.0.linearize_here();
    }
}

/// An evaluation of the accelerations, likewise.
struct Evaluate<'a, const L: usize>(&'a mut Series<L>);

impl<const L: usize> WithSimd for Evaluate<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.0.linearize_here();
        self.0.expand(2);
    }
}

impl<const L: usize> Series<L> {
    /// Accelerations and multipliers at the state: builds and factors S, then order 0.
    pub fn evaluate(&mut self) {
        Arch::new().dispatch(Evaluate(self));
    }

    /// Builds and factors S at the point of expansion.
    pub fn linearize(&mut self) {
        Arch::new().dispatch(Linearize(self));
    }

    /// Takes a step from the state, at which S must be factored, and factors S at its end.
    pub fn step(&mut self, plan: Plan) -> Taken {
        Arch::new().dispatch(Step(self, plan))
    }

    #[inline(always)]
    fn step_here(&mut self, plan: Plan) -> Taken {
        self.expand(plan.order);
        let (h, order) = self.reach(plan.order, plan.tolerance);
        let h = if 1.01 * h >= plan.left { plan.left } else { h };
        self.advance(h, order);
        self.linearize_here();
        let mut moved = 0.0;
        for _ in 0..3 {
            let step = self.correct_positions();
            moved += step;
            if step <= CONSISTENT * plan.length {
                break;
            }
        }
        if moved > NEGLIGIBLE * plan.tolerance {
            self.linearize_here();
        }
        self.correct_velocities();
        Taken { h, order, finite: self.is_finite() }
    }

    /// The step and the order at which the series is cut: the longest step that two successive terms of positions and
    /// velocities allow. Near singular positions high terms are noise, and lower ones decide.
    #[inline(always)]
    fn reach(&self, order: usize, tolerance: f64) -> (f64, usize) {
        let position = tolerance * (1.0 + self.size_of(0));
        let velocity = tolerance * (1.0 + self.size_of(1));
        let allowed = |k: usize| {
            let term = self.size_of(k);
            let by_position = (position / term).powf(1.0 / k as f64);
            let by_velocity = (velocity / (k as f64 * term)).powf(1.0 / (k - 1) as f64);
            by_position.min(by_velocity)
        };
        let mut best = (0.0, order);
        let mut previous = allowed(2);
        for k in 3..=order {
            let next = allowed(k);
            let h = previous.min(next);
            if h >= best.0 {
                best = (h, k);
            }
            previous = next;
        }
        best
    }
}
