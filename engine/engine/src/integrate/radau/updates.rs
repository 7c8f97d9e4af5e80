//! Broyden's updates — eq. (10.7): what successive corrections tell of the matrix with which they were made (Kelley, Iterative Methods for
//! Linear and Nonlinear Equations, section 7.3). Along a long step the true matrix changes, and the corrections of a fixed one
//! shrink slowly; they say where it is wrong.

/// Part of a correction that the next one may repeat and still teach something: beyond, they do not shrink.
const REPEATED: f64 = 0.7;

/// Corrections of one solution, and the one in the making.
#[derive(Clone, Debug)]
pub struct Updates {
    length: usize,
    steps: Vec<Vec<f64>>,
    /// Squares of those that are made.
    squares: Vec<f64>,
}

impl Updates {
    /// For corrections of so many numbers.
    pub fn new(length: usize) -> Self {
        Self { length, steps: vec![vec![0.0; length]], squares: Vec::new() }
    }

    /// Forgets all.
    pub fn restart(&mut self) {
        self.squares.clear();
    }

    /// The correction in the making, to be filled with that of the fixed matrix.
    pub fn next(&mut self) -> &mut [f64] {
        let made = self.squares.len();
        if self.steps.len() == made {
            self.steps.push(vec![0.0; self.length]);
        }
        &mut self.steps[made]
    }

    /// The one that was made last.
    pub fn last(&self) -> &[f64] {
        &self.steps[self.squares.len().saturating_sub(1)]
    }

    /// Makes the correction better by those before it, in the norm of numbers times `scale`, which repeats. Returns its size.
    pub fn improve(&mut self, scale: &[f64]) -> f64 {
        let product = |a: &[f64], b: &[f64]| -> f64 {
            let parts = a.chunks_exact(scale.len().max(1)).zip(b.chunks_exact(scale.len().max(1)));
            let terms = parts.flat_map(|(a, b)| a.iter().zip(b).zip(scale));
            terms.fold(0.0, |sum, ((a, b), weight)| sum + a * weight * (b * weight))
        };
        let made = self.squares.len();
        let (before, rest) = self.steps.split_at_mut(made);
        let Some(step) = rest.first_mut() else { return 0.0 };
        for (pair, square) in before.windows(2).zip(&self.squares) {
            let part = product(&pair[0], step) / square;
            step.iter_mut().zip(&pair[1]).for_each(|(x, next)| *x += part * next);
        }
        if let (Some(last), Some(square)) = (before.last(), self.squares.last()) {
            let part = product(last, step) / square;
            if part.abs() < REPEATED {
                for x in step.iter_mut() {
                    *x /= 1.0 - part;
                }
            }
        }
        let square = product(step, step);
        self.squares.push(square.max(f64::MIN_POSITIVE));
        square.sqrt()
    }
}
