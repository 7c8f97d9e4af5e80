//! Constraint rows — THEORY section 4.
//!
//! Every constraint of every joint is one of three forms, each a polynomial of degree at most two in the lifted
//! coordinates of the bodies that it touches. A form is a statement about *features*: points C^P Q and vectors C^s Q
//! with constant local coordinates, or points and vectors of the ground. Φ, Φ_q, ν and γ all follow from that one
//! statement, so they cannot disagree.

use crate::model::BodyRef;
use nalgebra::Vector3;

/// A point (`point`) or a vector that is fixed in a body or in the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feature {
    /// Where it is fixed.
    pub body: BodyRef,
    /// A point, which moves with r, or a vector, which only turns.
    pub point: bool,
    /// Local coordinates (ξ, η, ζ) in the principal frame; for the ground, world components.
    pub local: Vector3<f64>,
}

/// Place of a feature in the system's list.
pub type FeatureId = usize;

/// Difference of two features, or one feature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Feature that counts positive.
    pub plus: FeatureId,
    /// Feature that counts negative.
    pub minus: Option<FeatureId>,
}

impl Difference {
    /// The difference of some quantity of the two features.
    pub fn of(self, quantity: impl Fn(FeatureId) -> Vector3<f64>) -> Vector3<f64> {
        let plus = quantity(self.plus);
        self.minus.map_or(plus, |minus| plus - quantity(minus))
    }
}

/// One form of constraint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// a − b = 0 for two points: three independent equations (CP, TP) — eq. (4.3).
    Coincidence {
        /// Point on body i.
        a: FeatureId,
        /// Point on body j.
        b: FeatureId,
    },
    /// a − b = 0 for two unit vectors: three equations of which two are independent (CV, OV) — eq. (4.4).
    CommonVector {
        /// Vector on body i.
        a: FeatureId,
        /// Vector on body j.
        b: FeatureId,
    },
    /// a · b − c = 0: one equation (CAR, AR, line and plane rows, distance) — eq. (4.5).
    Product {
        /// First factor.
        a: Difference,
        /// Second factor.
        b: Difference,
        /// The constant c.
        constant: f64,
    },
}

impl Form {
    /// Number of equations as they are written.
    pub fn equations(&self) -> usize {
        match self {
            Self::Coincidence { .. } | Self::CommonVector { .. } => 3,
            Self::Product { .. } => 1,
        }
    }

    /// Number of equations that the solver keeps: those of a common vector across it.
    pub fn independent(&self) -> usize {
        match self {
            Self::Coincidence { .. } => 3,
            Self::CommonVector { .. } => 2,
            Self::Product { .. } => 1,
        }
    }

    /// The features that the form speaks of.
    pub fn features(&self) -> impl Iterator<Item = FeatureId> {
        let list = match *self {
            Self::Coincidence { a, b } | Self::CommonVector { a, b } => [Some(a), Some(b), None, None],
            Self::Product { a, b, .. } => [Some(a.plus), a.minus, Some(b.plus), b.minus],
        };
        list.into_iter().flatten()
    }
}

/// Two unit vectors that make a right-handed frame with the unit vector s.
///
/// Duff et al., Building an orthonormal basis, revisited, JCGT 6 (2017): no branch that could jump except at
/// s = −e₃, and none is needed to be smooth.
pub fn across(s: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let sign = 1f64.copysign(s.z);
    let a = -1.0 / (sign + s.z);
    let b = s.x * s.y * a;
    [
        Vector3::new(1.0 + sign * s.x * s.x * a, sign * b, -sign * s.x),
        Vector3::new(b, sign + s.y * s.y * a, -s.y),
    ]
}
