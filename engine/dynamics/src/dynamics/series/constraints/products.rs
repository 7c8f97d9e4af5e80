//! Rows x · y = c in bundles, and those of them that are linear: two rows t₁ · s = t₂ · s = 0 that keep a vector s along the axis
//! a = t₁ × t₂ of another body say what t₁ · (s − a) = t₂ · (s − a) = 0 do, with the t₁ and t₂ of one moment — eq. (11.17).

use crate::model::BodyRef;
use crate::system::System;
use crate::system::feature::Target;
use crate::system::index::FeatureId;
use crate::system::row::Form;
use nalgebra::Vector3;

/// What unit vectors and right angles may be off by.
const ALIKE: f64 = 1e-12;

/// Two rows that keep s along an axis of another body.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    /// The first of the rows; the other is the next one.
    pub row: usize,
    /// t₁ and t₂, and the body that they are on.
    pub across: [FeatureId; 2],
    pub body: BodyRef,
    pub s: FeatureId,
    /// t₁ × t₂ in the coordinates of that body.
    pub along: Vector3<f64>,
}

/// How a row x · y = c is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// With convolutions.
    Curved,
    /// With convolutions, and with features that move as prescribed.
    Driven,
    /// As a linear row of an axis.
    Linear,
}

/// Where the rows x · y = c stand, L beside each other.
#[derive(Clone, Debug)]
pub struct Products {
    /// Of each row of the system that is such a row: which it is, its bundle and lane.
    pub places: Vec<Option<(Kind, usize, usize)>>,
    /// Bundles of each kind.
    pub counts: [usize; 3],
    /// The axes.
    pub axes: Vec<Axis>,
}

impl Products {
    /// Those of a system, with `lanes` rows in a bundle.
    pub fn new(system: &System, lanes: usize) -> Self {
        let axes = axes(system);
        let mut kinds: Vec<Option<Kind>> = system
            .rows
            .iter()
            .map(|row| match row.form {
                Form::Product { .. } => {
                    let features = row.form.features(&system.angles);
                    let moves = features.into_iter().any(|f| system[f].curve.is_some());
                    Some(if moves { Kind::Driven } else { Kind::Curved })
                }
                _ => None,
            })
            .collect();
        for row in axes.iter().flat_map(|axis| [axis.row, axis.row + 1]) {
            kinds[row] = Some(Kind::Linear);
        }
        let mut places = vec![None; kinds.len()];
        let mut first = 0;
        let counts = [Kind::Curved, Kind::Driven, Kind::Linear].map(|kind| {
            let rows = (0..kinds.len()).filter(|&row| kinds[row] == Some(kind));
            let mut count = 0;
            for (k, row) in rows.enumerate() {
                places[row] = Some((kind, first + k / lanes, k % lanes));
                count = k / lanes + 1;
            }
            first += count;
            count
        });
        Self { places, counts, axes }
    }

    /// Where the first number of a side of a product stands among the numbers of [`super::Rows`], which keep L products of `stride`
    /// orders beside each other.
    pub fn first_number<const L: usize>(&self, row: usize, side: usize, stride: usize) -> usize {
        let (_, bundle, lane) = self.places[row].unwrap_or((Kind::Curved, 0, 0));
        (bundle * stride * 2 + side) * 3 * L + lane
    }
}

/// All pairs of rows that keep a vector along an axis.
fn axes(system: &System) -> Vec<Axis> {
    let mut axes: Vec<Axis> = Vec::new();
    for constraint in &system.constraints {
        for row in constraint.forms.clone().skip(1) {
            if axes.last().is_some_and(|axis| axis.row + 2 > row) {
                continue;
            }
            axes.extend(axis(system, row - 1));
        }
    }
    axes
}

/// The axis that a row and the next one keep, if they do.
fn axis(system: &System, row: usize) -> Option<Axis> {
    let factors = |row: usize| match system.rows[row].form {
        Form::Product { a, b, target: Target::Constant(0.0) } if a.minus.is_none() && b.minus.is_none() => {
            Some([a.plus, b.plus])
        }
        _ => None,
    };
    let ([t1, s], [t2, other]) = (factors(row)?, factors(row + 1)?);
    let fixed = |f: FeatureId| !system[f].point && system[f].curve.is_none();
    let is_one = s == other && system[t1].body == system[t2].body && [t1, t2, s].into_iter().all(fixed);
    let [first, second, third] = [t1, t2, s].map(|f| system[f].local);
    let unit = |v: &Vector3<f64>| (v.norm_squared() - 1.0).abs() < ALIKE;
    let square = first.dot(&second).abs() < ALIKE && unit(&first) && unit(&second) && unit(&third);
    (is_one && square).then(|| Axis {
        row,
        across: [t1, t2],
        body: system[t1].body,
        s,
        along: first.cross(&second),
    })
}
