//! Features: the points C^P Q and vectors C^s Q of bodies from which rows and loads are built, and prescribed numbers.

use crate::model::BodyRef;
use crate::model::motion::{Curve, Jet, MAX_TERMS, sine_cosine};
use crate::system::index::FeatureId;
use nalgebra::Vector3;

/// A point (`point`) or a vector that is fixed in a body or in the ground, or moves in it as prescribed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feature {
    /// Where it is fixed.
    pub body: BodyRef,
    /// A point, which moves with r, or a vector, which only turns.
    pub point: bool,
    /// Local coordinates (ξ, η, ζ) in the principal frame; for the ground, world components.
    pub local: Vector3<f64>,
    /// Which curve gives the local coordinates instead, if they are functions of time.
    pub curve: Option<usize>,
}

impl Feature {
    /// Whether it is fixed in the ground: then nothing about it ever changes.
    pub fn is_fixed(&self) -> bool {
        self.body == BodyRef::Ground && self.curve.is_none()
    }
}

/// Difference of two features, or one feature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Feature that counts positive.
    pub plus: FeatureId,
    /// Feature that counts negative.
    pub minus: Option<FeatureId>,
}

impl Difference {
    /// One feature.
    pub fn one(plus: FeatureId) -> Self {
        Self { plus, minus: None }
    }

    /// Renames features.
    pub fn rename(&mut self, place: &[FeatureId]) {
        self.plus = place[self.plus.index()];
        self.minus = self.minus.map(|f| place[f.index()]);
    }

    /// The difference of some quantity of the two features.
    pub fn of(self, quantity: impl Fn(FeatureId) -> Vector3<f64>) -> Vector3<f64> {
        let plus = quantity(self.plus);
        self.minus.map_or(plus, |minus| plus - quantity(minus))
    }
}

/// The number that a product must have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// Always the same.
    Constant(f64),
    /// The value of a target curve.
    Driven(usize),
}

/// A prescribed number: a curve, or the cosine of one, whose derivatives are the terms in θ* of eq. (4.8).
#[derive(Clone, Debug, PartialEq)]
pub struct TargetCurve {
    /// The curve.
    pub curve: Curve,
    /// Whether the number is the curve's cosine.
    pub cosine: bool,
}

impl TargetCurve {
    /// Value, first and second derivative at time t.
    pub fn at(&self, t: f64) -> Jet<f64> {
        let mut series = [0.0; 3];
        self.expand(t, &mut series);
        [series[0], series[1], 2.0 * series[2]]
    }

    /// Writes the coefficients of the series in τ about time t, at most [`MAX_TERMS`].
    pub fn expand(&self, t: f64, out: &mut [f64]) {
        self.curve.expand(t, out);
        if self.cosine {
            let mut angle = [0.0; MAX_TERMS];
            let (mut sin, terms) = (angle, out.len().min(MAX_TERMS));
            angle[..terms].copy_from_slice(&out[..terms]);
            sine_cosine(&angle[..terms], &mut sin, out);
        }
    }
}
