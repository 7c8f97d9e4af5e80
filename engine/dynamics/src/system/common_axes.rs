//! Axes as common vectors: the same joints in rows that are linear — THEORY section 11, eq. (11.17).
//!
//! Two rows t₁ · s = 0 and t₂ · s = 0 keep a vector s of one body along the axis a = t₁ × t₂ of another, and so does a − s = 0 (or
//! a + s = 0), whose two rows across it ask for no convolutions. Multipliers are those of t₁ and t₂ again in the directions of these.

use crate::model::BodyRef;
use crate::system::feature::{Feature, Target};
use crate::system::index::{FeatureId, RowId};
use crate::system::row::Form;
use crate::system::{Row, System};
use nalgebra::Vector3;
use std::convert::Infallible;

/// What unit vectors, right angles and common directions may be off by.
const ALIKE: f64 = 1e-9;

/// What the two rows of a common vector were in the system as it is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The rows across a common vector.
    CommonVector(RowId),
    /// Those of an axis, with the two vectors across it.
    Axis([FeatureId; 2]),
}

/// A system whose axes are common vectors.
#[derive(Clone, Debug)]
pub struct WithCommonAxes {
    /// It, with the same numbers of solver rows.
    pub system: System,
    /// What each of its common vectors was.
    pub origins: Vec<Origin>,
}

/// Two rows that keep a vector along an axis of another body, which is a feature of its own.
struct Axis {
    row: usize,
    across: [FeatureId; 2],
    feature: Feature,
    s: FeatureId,
}

impl WithCommonAxes {
    /// Of a system at consistent positions q, if it has such axes.
    pub fn new(system: &System, q: &[f64]) -> Option<Self> {
        let pairs = system.constraints.iter().filter(|constraint| !constraint.driver);
        let axes: Vec<Axis> =
            pairs.filter_map(|c| c.forms.clone().skip(1).find_map(|row| axis(system, row - 1, q))).collect();
        if axes.is_empty() {
            return None;
        }
        let mut system = system.clone();
        let mut origins = Vec::new();
        let mut next = 0;
        let mut axes = axes.into_iter().peekable();
        let mut features = Vec::new();
        let first = system.features.len();
        let choose = |_: &System, rows: &[Row], _: &str| -> Result<Vec<Row>, Infallible> {
            let mut kept: Vec<Row> = Vec::with_capacity(rows.len());
            let mut skips = false;
            for row in rows {
                let index = next;
                next += 1;
                if std::mem::take(&mut skips) {
                    continue;
                }
                let mut row = row.clone();
                if let Form::CommonVector { .. } = row.form {
                    origins.push(Origin::CommonVector(RowId(index)));
                }
                if let Some(axis) = axes.next_if(|axis| axis.row == index) {
                    row.form = Form::CommonVector { a: FeatureId(first + features.len()), b: axis.s };
                    features.push(axis.feature);
                    origins.push(Origin::Axis(axis.across));
                    skips = true;
                }
                kept.push(row);
            }
            Ok(kept)
        };
        let Ok(()) = system.keep_rows(choose, Form::independent);
        system.features.extend(features);
        Some(Self { system, origins })
    }
}

/// Of a system as it stands.
pub fn origins(system: &System) -> Vec<Origin> {
    let rows = system.rows.iter().enumerate();
    let commons = rows.filter(|(_, row)| matches!(row.form, Form::CommonVector { .. }));
    commons.map(|(row, _)| Origin::CommonVector(RowId(row))).collect()
}

/// The axis that a row and the next one keep at positions q, if they do.
fn axis(system: &System, row: usize, q: &[f64]) -> Option<Axis> {
    let factors = |row: usize| match system.rows[row].form {
        Form::Product { a, b, target: Target::Constant(0.0) } if a.minus.is_none() && b.minus.is_none() => {
            Some([a.plus, b.plus])
        }
        _ => None,
    };
    let ([t1, s], [t2, other]) = (factors(row)?, factors(row + 1)?);
    let fixed = |f: FeatureId| !system[f].point && system[f].curve.is_none();
    if s != other || system[t1].body != system[t2].body || ![t1, t2, s].into_iter().all(fixed) {
        return None;
    }
    let [first, second, third] = [t1, t2, s].map(|f| system[f].local);
    let is_unit = |v: &Vector3<f64>| (v.norm_squared() - 1.0).abs() < ALIKE;
    if first.dot(&second).abs() > ALIKE || ![first, second, third].iter().all(is_unit) {
        return None;
    }
    let mut feature = Feature { local: first.cross(&second), ..system[t1] };
    let [a, s_here] = [feature, system[s]].map(|feature| direction(system, &feature, q));
    if a.dot(&s_here) < 0.0 {
        feature.local = -feature.local;
    }
    (a.cross(&s_here).amax() < ALIKE).then_some(Axis { row, across: [t1, t2], feature, s })
}

fn direction(system: &System, feature: &Feature, q: &[f64]) -> Vector3<f64> {
    match feature.body {
        BodyRef::Ground => feature.local,
        BodyRef::Moving(body) => system.bodies[body].position(q).arm(&feature.local),
    }
}
