//! Broyden's updates — eq. (10.7): what successive corrections tell of the matrix with which they were made (Kelley, Iterative Methods for
//! Linear and Nonlinear Equations, section 7.3). Along a long step the true matrix changes, and the corrections of a fixed one
//! shrink slowly; they say where it is wrong.

use super::blocks::{NONE, Pair, plus};
use crate::integrate::wide::MOST_LANES;

/// Part of a correction that the next one may repeat and still teach something: beyond, they do not shrink.
const REPEATED: f64 = 0.7;

/// Corrections of one solution, and the one in the making.
#[derive(Clone, Debug)]
pub struct Updates {
    length: usize,
    steps: Vec<Vec<Pair>>,
    /// Squares of those that are made.
    squares: Vec<f64>,
}

impl Updates {
    /// For corrections of so many rows.
    pub fn new(length: usize) -> Self {
        Self { length, steps: vec![vec![NONE; length]], squares: Vec::new() }
    }

    /// Forgets all.
    pub fn restart(&mut self) {
        self.squares.clear();
    }

    /// The correction in the making, to be filled with that of the fixed matrix.
    pub fn next(&mut self) -> &mut [Pair] {
        let made = self.squares.len();
        if self.steps.len() == made {
            self.steps.push(vec![NONE; self.length]);
        }
        &mut self.steps[made]
    }

    /// The one that was made last.
    pub fn last(&self) -> &[Pair] {
        &self.steps[self.squares.len().saturating_sub(1)]
    }

    /// Makes the correction better by those before it, in the norm of numbers times their `scale`, of which each has so many pairs. Returns its
    /// size.
    #[inline(always)]
    pub fn improve(&mut self, scale: &[f64], groups: usize) -> f64 {
        let made = self.squares.len();
        let (before, rest) = self.steps.split_at_mut(made);
        let Some(step) = rest.first_mut() else { return 0.0 };
        for (pair, square) in before.windows(2).zip(&self.squares) {
            let part = product(scale, groups, &pair[0], step) / square;
            for (x, next) in step.as_flattened_mut().iter_mut().zip(pair[1].as_flattened()) {
                *x = plus(*x, *next, [part; MOST_LANES]);
            }
        }
        if let (Some(last), Some(square)) = (before.last(), self.squares.last()) {
            let part = product(scale, groups, last, step) / square;
            if part.abs() < REPEATED {
                let longer = 1.0 / (1.0 - part);
                for x in step.as_flattened_mut().as_flattened_mut() {
                    *x *= longer;
                }
            }
        }
        let square = product(scale, groups, step, step);
        self.squares.push(square.max(f64::MIN_POSITIVE));
        square.sqrt()
    }
}

/// Product of two corrections.
#[inline(always)]
fn product(scale: &[f64], groups: usize, a: &[Pair], b: &[Pair]) -> f64 {
    let mut sum = [0.0; MOST_LANES];
    for ((a, b), weight) in a.chunks_exact(groups).zip(b.chunks_exact(groups)).zip(scale) {
        let mut part = [0.0; MOST_LANES];
        for (a, b) in a.as_flattened().iter().zip(b.as_flattened()) {
            part = plus(part, *a, *b);
        }
        sum = plus(sum, part, [weight * weight; MOST_LANES]);
    }
    sum[0] + sum[1] + sum[2] + sum[3]
}
