//! Constraint rows — THEORY section 4.
//!
//! Every constraint of every joint is one of three forms, each a polynomial of degree at most two in the lifted
//! coordinates of the bodies that it touches. A form is a statement about *features*: points C^P Q and vectors C^s Q
//! with constant local coordinates, or points and vectors of the ground. Φ, Φ_q, ν and γ all follow from that one
//! statement, so they cannot disagree.

use crate::angle::Angle;
use crate::model::BodyRef;
use crate::motion::{Curve, Jet, MOST_TERMS, sine_cosine};
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
    /// One feature.
    pub fn one(plus: FeatureId) -> Self {
        Self { plus, minus: None }
    }

    fn rename(&mut self, place: &[FeatureId]) {
        self.plus = place[self.plus];
        self.minus = self.minus.map(|f| place[f]);
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

/// A prescribed number: a curve, or the cosine of one.
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

    /// Writes the coefficients of the series in τ about time t, at most [`MOST_TERMS`].
    pub fn expand(&self, t: f64, out: &mut [f64]) {
        self.curve.expand(t, out);
        if self.cosine {
            let mut angle = [0.0; MOST_TERMS];
            let (mut sin, terms) = (angle, out.len().min(MOST_TERMS));
            angle[..terms].copy_from_slice(&out[..terms]);
            sine_cosine(&angle[..terms], &mut sin, out);
        }
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
        /// The number c.
        target: Target,
    },
    /// Σ cᵢ θᵢ + d (a · b) − c = 0 between joint angles and a displacement: one equation (gear, screw). The only form
    /// that is not a polynomial — eq. (4.7).
    Relation {
        /// Up to two angles with their factors.
        angles: [Option<(usize, f64)>; 2],
        /// A displacement with its factor.
        slide: Option<(Difference, Difference, f64)>,
        /// The constant c.
        constant: f64,
    },
}

impl Form {
    /// Number of equations as they are written.
    pub fn equations(&self) -> usize {
        match self {
            Self::Coincidence { .. } | Self::CommonVector { .. } => 3,
            Self::Product { .. } | Self::Relation { .. } => 1,
        }
    }

    /// Number of equations that the solver keeps: those of a common vector across it.
    pub fn independent(&self) -> usize {
        match self {
            Self::Coincidence { .. } => 3,
            Self::CommonVector { .. } => 2,
            Self::Product { .. } | Self::Relation { .. } => 1,
        }
    }

    /// The features that the form speaks of, in the order in which their gradients are written.
    pub fn features(&self, angles: &[Angle]) -> Vec<FeatureId> {
        let of = |d: Difference| [Some(d.plus), d.minus].into_iter().flatten();
        match *self {
            Self::Coincidence { a, b } | Self::CommonVector { a, b } => vec![a, b],
            Self::Product { a, b, .. } => of(a).chain(of(b)).collect(),
            Self::Relation { angles: terms, slide, .. } => {
                let turning = terms.into_iter().flatten().flat_map(|(k, _)| angles[k].features());
                let sliding = slide.into_iter().flat_map(|(a, b, _)| of(a).chain(of(b)));
                turning.chain(sliding).collect()
            }
        }
    }

    /// Renames features.
    pub fn rename(&mut self, place: &[FeatureId]) {
        match self {
            Self::Coincidence { a, b } | Self::CommonVector { a, b } => {
                *a = place[*a];
                *b = place[*b];
            }
            Self::Product { a, b, .. } => {
                a.rename(place);
                b.rename(place);
            }
            Self::Relation { slide, .. } => {
                if let Some((a, b, _)) = slide {
                    a.rename(place);
                    b.rename(place);
                }
            }
        }
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
