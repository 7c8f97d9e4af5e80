//! Rows at one state: values, rates and what is left of them — eqs. (4.3) to (4.7).

use super::{FeatureState, Stage, State};
use crate::system::System;
use crate::system::feature::Difference;
use crate::system::row::Form;
use nalgebra::Vector3;
use triad_linalg::larger;

/// What is left of a row's Φ or Φ̇; rows of one equation use the first component.
pub type Residual = Vector3<f64>;

/// A scalar function of features at one state.
#[derive(Clone, Copy, Debug, Default)]
pub struct ScalarState {
    /// Its value.
    pub value: f64,
    /// Its rate.
    pub rate: f64,
    /// The part of its second derivative that is quadratic in the velocities.
    pub curvature: f64,
}

impl State {
    /// a · b and what its derivatives are made of.
    pub fn product(&self, a: Difference, b: Difference) -> ScalarState {
        let (x, y) = (self.difference(a, |f| f.value), self.difference(b, |f| f.value));
        let (xr, yr) = (self.difference(a, |f| f.rate), self.difference(b, |f| f.rate));
        ScalarState { value: x.dot(&y), rate: x.dot(&yr) + xr.dot(&y), curvature: 2.0 * xr.dot(&yr) }
    }

    /// The left side of a relation between angles and a displacement.
    pub fn relation(&self, form: &Form) -> ScalarState {
        let mut sum = ScalarState::default();
        let Form::Relation { angles, slide, constant } = *form else { return sum };
        sum.value = -constant;
        for (angle, factor) in angles.into_iter().flatten() {
            let state = &self.angles[angle];
            sum.value += factor * state.value;
            sum.rate += factor * state.rate;
            sum.curvature += factor * state.curvature;
        }
        if let Some((a, b, factor)) = slide {
            let product = self.product(a, b);
            sum.value += factor * product.value;
            sum.rate += factor * product.rate;
            sum.curvature += factor * product.curvature;
        }
        sum
    }

    fn difference(&self, difference: Difference, of: impl Fn(&FeatureState) -> Vector3<f64>) -> Vector3<f64> {
        difference.of(|feature| of(&self.features[feature.index()]))
    }

    /// −Φ of each row, or −Φ̇.
    pub fn residuals(&self, system: &System, of_rates: bool, out: &mut [Residual]) {
        self.require(if of_rates { Stage::Velocities } else { Stage::Positions });
        let pick = |value: f64, rate: f64| Vector3::new(-if of_rates { rate } else { value }, 0.0, 0.0);
        for (out, row) in out.iter_mut().zip(&system.rows) {
            *out = match row.form {
                Form::Coincidence { a, b } | Form::CommonVector { a, b } => {
                    let (a, b) = (&self.features[a.index()], &self.features[b.index()]);
                    if of_rates { b.rate - a.rate } else { b.value - a.value }
                }
                Form::Product { a, b, target } => {
                    let product = self.product(a, b);
                    let [c, c_rate, _] = self.target(target);
                    pick(product.value - c, product.rate - c_rate)
                }
                Form::Relation { .. } => {
                    let relation = self.relation(&row.form);
                    pick(relation.value, relation.rate)
                }
            };
        }
    }

    /// Largest |Φ| of one row form.
    pub fn row_violation(&self, form: &Form) -> f64 {
        match *form {
            Form::Coincidence { a, b } | Form::CommonVector { a, b } => {
                size(&(self.features[a.index()].value - self.features[b.index()].value))
            }
            Form::Product { a, b, target } => (self.product(a, b).value - self.target(target)[0]).abs(),
            Form::Relation { .. } => self.relation(form).value.abs(),
        }
    }

    /// Largest |Φ̇| of one row form.
    pub fn row_rate_violation(&self, form: &Form) -> f64 {
        self.require(Stage::Velocities);
        match *form {
            Form::Coincidence { a, b } | Form::CommonVector { a, b } => {
                size(&(self.features[a.index()].rate - self.features[b.index()].rate))
            }
            Form::Product { a, b, target } => (self.product(a, b).rate - self.target(target)[1]).abs(),
            Form::Relation { .. } => self.relation(form).rate.abs(),
        }
    }

    /// Largest |Φ| over all rows, rigid-body rows included.
    pub fn position_violation(&self, system: &System) -> f64 {
        self.require(Stage::Positions);
        let mut largest = 0.0f64;
        for state in &self.bodies {
            for k in 0..3 {
                for l in 0..=k {
                    let unit = if k == l { 1.0 } else { 0.0 };
                    largest = larger(largest, (state.q.e[k].dot(&state.q.e[l]) - unit).abs());
                }
            }
        }
        system.rows.iter().fold(largest, |largest, row| larger(largest, self.row_violation(&row.form)))
    }

    /// Largest |Φ̇| over all rows, rigid-body rows included.
    pub fn velocity_violation(&self, system: &System) -> f64 {
        self.require(Stage::Velocities);
        let mut largest = 0.0f64;
        for state in &self.bodies {
            let (q, q_dot) = (&state.q, &state.q_dot);
            for k in 0..3 {
                for l in 0..=k {
                    largest = larger(largest, (q.e[k].dot(&q_dot.e[l]) + q.e[l].dot(&q_dot.e[k])).abs());
                }
            }
        }
        system.rows.iter().fold(largest, |largest, row| larger(largest, self.row_rate_violation(&row.form)))
    }
}

/// The largest component.
#[inline(always)]
fn size(x: &Vector3<f64>) -> f64 {
    larger(larger(x[0].abs(), x[1].abs()), x[2].abs())
}
