//! When a typed number is taken for a certain wrong one.

use crate::answers::tolerance::{Tolerance, distance, norm};

/// Part of the tolerance within which an answer must meet a wrong value: closer than a right one, since many are tried.
const CLOSER: f64 = 0.5;
/// Least relative width, where a question asks for many digits: students give three or four of a wrong value too.
const LEAST: f64 = 1e-3;
/// Most relative width that digits left out may bring: a whole number for a component is seldom a rounded one.
const MOST_ROUNDED: f64 = 0.02;
/// Relative difference of numbers that are the same.
pub(super) const EXACT: f64 = 1e-9;
/// An answer that is off by no more than so many tolerances is close.
const NEAR: f64 = 3.0;

/// Typed values, with what rounding may have changed.
pub(super) struct Fit<'a> {
    pub values: &'a [f64],
    pub reference: &'a [f64],
    tolerance: Tolerance,
    width: f64,
}

impl<'a> Fit<'a> {
    pub(super) fn new(
        values: &'a [f64],
        rounding: &[f64],
        reference: &'a [f64],
        tolerance: Tolerance,
    ) -> Self {
        let size = norm(values);
        let width = if tolerance.is_exact() {
            EXACT * size
        } else {
            norm(rounding).min(MOST_ROUNDED * size) + (CLOSER * tolerance.allowed(size)).max(LEAST * size)
        };
        Self { values, reference, tolerance, width }
    }

    /// The same for values that stand for themselves: they meet a wrong one to the last digit.
    pub(super) fn exactly(values: &'a [f64], reference: &'a [f64], tolerance: Tolerance) -> Self {
        Self { values, reference, tolerance, width: EXACT * norm(values) }
    }

    /// Whether the answer is this wrong one.
    pub(super) fn is(&self, wrong: &[f64]) -> bool {
        wrong.len() == self.values.len() && distance(self.values, wrong) <= self.width && !self.right(wrong)
    }

    /// Whether one component is this.
    pub(super) fn component_is(&self, k: usize, value: f64) -> bool {
        (self.values[k] - value).abs() <= self.width
    }

    /// Whether one component is right on the scale of the whole.
    pub(super) fn component_right(&self, k: usize) -> bool {
        (self.values[k] - self.reference[k]).abs()
            <= self.tolerance.allowed(norm(self.reference)).max(self.width)
    }

    /// Whether these would be a right answer.
    fn right(&self, values: &[f64]) -> bool {
        self.tolerance.accepts(values, self.reference)
    }

    /// Whether the answer is outside the tolerance by little.
    pub(super) fn is_near(&self) -> bool {
        !self.tolerance.is_exact()
            && distance(self.values, self.reference) <= NEAR * self.tolerance.allowed(norm(self.reference))
    }

    /// The same for the opposite answer.
    pub(super) fn with<'b>(&self, values: &'b [f64]) -> Fit<'b>
    where
        'a: 'b,
    {
        Fit { values, reference: self.reference, tolerance: self.tolerance, width: self.width }
    }
}
