//! Prescribed functions of time with exact derivatives.

mod expansion;

mod formula;

pub use expansion::{MAX_TERMS, sine_cosine};
pub use formula::{TRIED, TimeFormula, TimeFormulaError, first_where};

use crate::scene::{Motion, VectorMotion};
use nalgebra::{Matrix3, Vector3};

/// A value with its first and second derivative in time.
pub type Jet<T> = [T; 3];

/// A number as a function of time, ready to be evaluated.
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// c₀ + c₁ t + c₂ t² + ….
    Polynomial(Vec<f64>),
    /// mean + amplitude sin(frequency t + phase).
    Harmonic {
        /// Mean.
        mean: f64,
        /// Amplitude.
        amplitude: f64,
        /// Angular frequency, rad/s.
        frequency: f64,
        /// Phase, rad.
        phase: f64,
    },
    /// Polynomial pieces: `pieces[k]` holds in (t − `knots[k]`) from `knots[k]` to the next knot. The first piece also
    /// holds before its knot, the last also after the last knot.
    Pieces {
        /// Times at which pieces begin, s.
        knots: Vec<f64>,
        /// Coefficients of each piece.
        pieces: Vec<[f64; 6]>,
    },
    /// A formula in t.
    Formula(TimeFormula),
}

impl Curve {
    /// Prepares a motion whose numbers the model has checked.
    ///
    /// # Errors
    ///
    /// [`TimeFormulaError`]: a formula that cannot be read, or is not smooth.
    pub fn new(motion: &Motion) -> Result<Self, TimeFormulaError> {
        Ok(match motion {
            Motion::Constant { value } => Self::Polynomial(vec![*value]),
            Motion::Ramp { start, rate } => Self::Polynomial(vec![*start, *rate]),
            Motion::Polynomial { coefficients } => Self::Polynomial(coefficients.clone()),
            &Motion::Harmonic { mean, amplitude, frequency, phase } => {
                Self::Harmonic { mean, amplitude, frequency, phase }
            }
            &Motion::SmoothStep { from, to, start, end } => smooth_step(from, to, start, end),
            Motion::Table { times, values } => natural_spline(times, values),
            Motion::Expression { value } => Self::Formula(TimeFormula::parse(value)?),
        })
    }

    /// A curve that never changes.
    pub fn constant(value: f64) -> Self {
        Self::Polynomial(vec![value])
    }

    /// A curve that stays as this one is at time t.
    #[must_use]
    pub fn held(&self, t: f64) -> Self {
        Self::constant(self.at(t)[0])
    }

    /// Whether it depends on the time.
    pub fn changes(&self) -> bool {
        let some = |coefficients: &[f64]| coefficients.iter().any(|c| *c != 0.0);
        match self {
            Self::Polynomial(coefficients) => coefficients.get(1..).is_some_and(some),
            Self::Harmonic { amplitude, frequency, .. } => amplitude * frequency != 0.0,
            Self::Pieces { pieces, .. } => {
                pieces.iter().any(|piece| some(&piece[1..]) || piece[0] != pieces[0][0])
            }
            Self::Formula(formula) => formula.changes(),
        }
    }

    /// The same curve times a constant.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        match &mut self {
            Self::Polynomial(coefficients) => coefficients.iter_mut().for_each(|c| *c *= factor),
            Self::Harmonic { mean, amplitude, .. } => {
                *mean *= factor;
                *amplitude *= factor;
            }
            Self::Pieces { pieces, .. } => pieces.iter_mut().flatten().for_each(|c| *c *= factor),
            Self::Formula(formula) => formula.scale(factor),
        }
        self
    }

    /// Value, first and second derivative at time t.
    pub fn at(&self, t: f64) -> Jet<f64> {
        let mut series = [0.0; 3];
        self.expand(t, &mut series);
        [series[0], series[1], 2.0 * series[2]]
    }
}

/// 10 x³ − 15 x⁴ + 6 x⁵ between two constants.
fn smooth_step(from: f64, to: f64, start: f64, end: f64) -> Curve {
    let (d, h) = (to - from, end - start);
    let cube = h * h * h;
    let step = [from, 0.0, 0.0, 10.0 * d / cube, -15.0 * d / (cube * h), 6.0 * d / (cube * h * h)];
    let constant = |c| [c, 0.0, 0.0, 0.0, 0.0, 0.0];
    // The first piece is constant: its knot only has to lie before the step.
    Curve::Pieces { knots: vec![start - 1.0, start, end], pieces: vec![constant(from), step, constant(to)] }
}

/// The natural cubic spline: second derivatives zero at both ends, straight beyond them.
fn natural_spline(x: &[f64], y: &[f64]) -> Curve {
    let n = x.len();
    let h: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
    let slope: Vec<f64> = (0..n - 1).map(|k| (y[k + 1] - y[k]) / h[k]).collect();
    // Second derivatives m by the tridiagonal system of the inner points.
    let mut m = vec![0.0; n];
    let (mut diagonal, mut right) = (vec![1.0; n], vec![0.0; n]);
    for k in 1..n - 1 {
        let factor = if k == 1 { 0.0 } else { h[k - 1] / diagonal[k - 1] };
        diagonal[k] = 2.0 * (h[k - 1] + h[k]) - factor * h[k - 1];
        right[k] = 6.0 * (slope[k] - slope[k - 1]) - factor * right[k - 1];
    }
    for k in (1..n - 1).rev() {
        m[k] = (right[k] - h[k] * m[k + 1]) / diagonal[k];
    }
    let first = slope[0] - h[0] * (2.0 * m[0] + m[1]) / 6.0;
    let mut knots = vec![x[0] - 1.0];
    let mut pieces = vec![[y[0] - first, first, 0.0, 0.0, 0.0, 0.0]];
    for k in 0..n - 1 {
        let rate = slope[k] - h[k] * (2.0 * m[k] + m[k + 1]) / 6.0;
        knots.push(x[k]);
        pieces.push([y[k], rate, 0.5 * m[k], (m[k + 1] - m[k]) / (6.0 * h[k]), 0.0, 0.0]);
    }
    let last = slope[n - 2] + h[n - 2] * (m[n - 2] + 2.0 * m[n - 1]) / 6.0;
    knots.push(x[n - 1]);
    pieces.push([y[n - 1], last, 0.0, 0.0, 0.0, 0.0]);
    Curve::Pieces { knots, pieces }
}

/// A vector as a function of time, ready to be evaluated.
#[derive(Clone, Debug, PartialEq)]
pub enum VectorCurve {
    /// Each component by itself.
    Components([Curve; 3]),
    /// Components along three fixed directions (the columns) that are not those of the frame.
    Rotated(Matrix3<f64>, [Curve; 3]),
    /// Turning about a unit axis: along + cos θ across + sin θ (axis × across).
    Turning {
        /// Part along the axis.
        along: Vector3<f64>,
        /// Part across the axis, at θ = 0.
        across: Vector3<f64>,
        /// axis × across.
        turned: Vector3<f64>,
        /// θ, rad.
        angle: Curve,
    },
}

impl VectorCurve {
    /// Prepares a motion whose numbers the model has checked.
    ///
    /// # Errors
    ///
    /// [`TimeFormulaError`]: a formula that cannot be read, or is not smooth.
    pub fn new(motion: &VectorMotion) -> Result<Self, TimeFormulaError> {
        Self::made_of(motion, |_, motion| Curve::new(motion))
    }

    /// The same from the functions of its components or its angle, each made for its name.
    ///
    /// # Errors
    ///
    /// Those of making them.
    pub fn made_of<E>(
        motion: &VectorMotion,
        curve: impl Fn(&str, &Motion) -> Result<Curve, E>,
    ) -> Result<Self, E> {
        Ok(match motion {
            VectorMotion::Fixed { vector } => Self::Components(vector.map(Curve::constant)),
            VectorMotion::Components { x, y, z } => {
                Self::Components([curve("x", x)?, curve("y", y)?, curve("z", z)?])
            }
            VectorMotion::Turning { start, axis, angle } => {
                let axis = Vector3::from(*axis).normalize();
                Self::turning(&Vector3::from(*start), &axis, curve("angle", angle)?)
            }
        })
    }

    /// A vector that stays as this one is at time t.
    #[must_use]
    pub fn held(&self, t: f64) -> Self {
        let [x, y, z] = self.at(t)[0].into();
        Self::Components([x, y, z].map(Curve::constant))
    }

    /// Whether it depends on the time.
    pub fn changes(&self) -> bool {
        match self {
            Self::Components(components) | Self::Rotated(_, components) => {
                components.iter().any(Curve::changes)
            }
            Self::Turning { across, angle, .. } => *across != Vector3::zeros() && angle.changes(),
        }
    }

    /// The same vector with its components in another frame, v' = rotation · v.
    #[must_use]
    pub fn rotated(self, rotation: &Matrix3<f64>) -> Self {
        match self {
            Self::Components(components) => Self::Rotated(*rotation, components),
            Self::Rotated(first, components) => Self::Rotated(rotation * first, components),
            Self::Turning { along, across, turned, angle } => Self::Turning {
                along: rotation * along,
                across: rotation * across,
                turned: rotation * turned,
                angle,
            },
        }
    }

    /// `start` turned about the unit vector `axis`.
    pub fn turning(start: &Vector3<f64>, axis: &Vector3<f64>, angle: Curve) -> Self {
        let along = axis * axis.dot(start);
        Self::Turning { along, across: start - along, turned: axis.cross(start), angle }
    }

    /// Value, first and second derivative at time t.
    pub fn at(&self, t: f64) -> Jet<Vector3<f64>> {
        let mut series = [Vector3::zeros(); 3];
        self.expand(t, &mut series);
        [series[0], series[1], series[2] * 2.0]
    }
}
