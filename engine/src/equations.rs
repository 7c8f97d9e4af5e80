//! The equations as a student writes them: Φ, Φ_q and γ in the generalized coordinates, rigid-body rows first.
//!
//! Not used by the solver, which works in twist form; both speak of the same row forms, and tests hold them together.

use crate::elimination::Elimination;
use crate::lift::{self, Lift};
use crate::model::BodyRef;
use crate::reaction::equation_labels;
use crate::row::{Difference, FeatureId, Form};
use crate::scene::Coordinates;
use crate::system::System;
use nalgebra::Vector3;
use serde::Serialize;

/// One number of the Jacobian that can be other than zero.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Entry {
    /// Row.
    pub row: usize,
    /// Column.
    pub column: usize,
    /// Value at this state.
    pub value: f64,
    /// Whether it is the same at every state.
    pub constant: bool,
}

/// The sparse Jacobian Φ_q with the names of its rows and columns.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Jacobian {
    /// Names of the rows, such as `link: uu` or `pin: CP.x`.
    pub rows: Vec<String>,
    /// Names of the columns, such as `link.ux`.
    pub columns: Vec<String>,
    /// Entries in the order of rows, then columns.
    pub entries: Vec<Entry>,
}

/// Directors (k, l) of the six rigid-body rows, in their order, and the rows' labels.
const RIGID: [(usize, usize, &str); 6] =
    [(0, 0, "uu"), (1, 1, "vv"), (2, 2, "ww"), (0, 1, "uv"), (0, 2, "uw"), (1, 2, "vw")];

/// Rigid-body rows of a body: six, or those of u and v.
fn rigid_rows(coordinates: Coordinates) -> impl Iterator<Item = (usize, usize, &'static str)> {
    RIGID.into_iter().filter(move |&(k, l, _)| coordinates == Coordinates::Full || (k < 2 && l < 2))
}

/// Names of the generalized coordinates.
pub fn column_names(system: &System) -> Vec<String> {
    let mut names = Vec::with_capacity(system.coordinates);
    for (body, model) in system.bodies.iter().zip(&system.model.bodies) {
        for vector in ["r", "u", "v", "w"].iter().take(lift::size(body.coordinates) / 3) {
            names.extend(["x", "y", "z"].iter().map(|axis| format!("{}.{vector}{axis}", model.name)));
        }
    }
    names
}

/// Names of all rows.
pub fn row_names(system: &System) -> Vec<String> {
    let mut names = Vec::with_capacity(system.rigid_rows + system.equations);
    for (body, model) in system.bodies.iter().zip(&system.model.bodies) {
        names.extend(rigid_rows(body.coordinates).map(|(_, _, label)| format!("{}: {label}", model.name)));
    }
    for group in &system.groups {
        for row in &system.rows[group.forms.clone()] {
            let labels = equation_labels(row.label, row.form.equations());
            names.extend(labels.into_iter().map(|label| format!("{}: {label}", group.name)));
        }
    }
    names
}

/// One equation: its value, its γ, and its gradient with respect to the lifted coordinates of bodies.
struct Equation {
    value: f64,
    /// ν, the rate that drivers prescribe: Φ̇ = Φ_q q̇ − ν.
    nu: f64,
    /// γ before the term of reduced bodies.
    gamma: f64,
    /// (body, gradient, constant in Q).
    gradient: Vec<(usize, Lift, bool)>,
}

/// Every equation of every row, rigid-body rows first; positions and velocities must be in place.
fn equations(system: &System, at: &Elimination) -> Vec<Equation> {
    let mut list = Vec::with_capacity(system.rigid_rows + system.equations);
    for (index, (body, state)) in system.bodies.iter().zip(&at.bodies).enumerate() {
        for (k, l, _) in rigid_rows(body.coordinates) {
            let unit = if k == l { 1.0 } else { 0.0 };
            let mut gradient = Lift::default();
            gradient.e[k] += state.q.e[l];
            gradient.e[l] += state.q.e[k];
            list.push(Equation {
                value: state.q.e[k].dot(&state.q.e[l]) - unit,
                nu: 0.0,
                gamma: -2.0 * state.q_dot.e[k].dot(&state.q_dot.e[l]),
                gradient: vec![(index, gradient, false)],
            });
        }
    }
    for row in &system.rows {
        match row.form {
            Form::Coincidence { a, b } | Form::CommonVector { a, b } => {
                let (x, y) = (at.feature_value(a), at.feature_value(b));
                for k in 0..3 {
                    let g = Vector3::ith(k, 1.0);
                    let gradient = [(a, g, true), (b, -g, true)];
                    let driven = at.driven_acceleration(system, b)[k] - at.driven_acceleration(system, a)[k];
                    let rate = at.driven_rate(system, b)[k] - at.driven_rate(system, a)[k];
                    list.push(Equation {
                        value: x[k] - y[k],
                        nu: rate,
                        gamma: driven,
                        gradient: lifted(system, at, &gradient),
                    });
                }
            }
            Form::Product { a, b, target } => {
                let value = |d: Difference| d.of(|f| at.feature_value(f));
                let rate = |d: Difference| d.of(|f| at.feature_rate(f));
                let fixed =
                    |d: Difference| [Some(d.plus), d.minus].into_iter().flatten().all(|f| f >= system.moving);
                let mut gradient = Vec::with_capacity(4);
                for (own, other) in [(a, b), (b, a)] {
                    let g = value(other);
                    gradient.push((own.plus, g, fixed(other)));
                    gradient.extend(own.minus.map(|minus| (minus, -g, fixed(other))));
                }
                let [c, c_rate, c_acceleration] = at.target(target);
                let driven = |d: Difference| d.of(|f| at.driven_acceleration(system, f));
                let driven_rate = |d: Difference| d.of(|f| at.driven_rate(system, f));
                let (x, y) = (value(a), value(b));
                list.push(Equation {
                    value: x.dot(&y) - c,
                    nu: c_rate - driven_rate(a).dot(&y) - x.dot(&driven_rate(b)),
                    gamma: c_acceleration
                        - 2.0 * rate(a).dot(&rate(b))
                        - driven(a).dot(&y)
                        - x.dot(&driven(b)),
                    gradient: lifted(system, at, &gradient),
                });
            }
            Form::Relation { angles, slide, .. } => {
                let (value, rate, curvature) = at.relation_terms(system, &row.form);
                let mut gradient = Vec::with_capacity(6);
                for (angle, factor) in angles.into_iter().flatten() {
                    let features = system.angles[angle].features();
                    let g = at.angles[angle].gradient;
                    gradient.extend(features.into_iter().zip(g).map(|(f, g)| (f, g * factor, false)));
                }
                if let Some((a, b, factor)) = slide {
                    for (own, other) in [(a, b), (b, a)] {
                        let g = other.of(|f| at.feature_value(f)) * factor;
                        gradient.push((own.plus, g, false));
                        gradient.extend(own.minus.map(|minus| (minus, -g, false)));
                    }
                }
                let gradient = lifted(system, at, &gradient);
                // A relation does not depend on time, so that its whole rate is Φ_q q̇.
                let along: f64 = gradient.iter().map(|(b, g, _)| g.dot(&at.bodies[*b].q_dot)).sum();
                list.push(Equation { value, nu: along - rate, gamma: -curvature, gradient });
            }
        }
    }
    list
}

/// Cᵀ g of each feature, summed by body.
fn lifted(
    system: &System,
    at: &Elimination,
    parts: &[(FeatureId, Vector3<f64>, bool)],
) -> Vec<(usize, Lift, bool)> {
    let mut list: Vec<(usize, Lift, bool)> = Vec::with_capacity(2);
    for &(feature, g, constant) in parts {
        let local = at.feature_local(system, feature);
        let feature = &system.features[feature];
        let BodyRef::Moving(body) = feature.body else { continue };
        let at = list.iter().position(|(b, ..)| *b == body).unwrap_or_else(|| {
            list.push((body, Lift::default(), true));
            list.len() - 1
        });
        let (_, sum, all_constant) = &mut list[at];
        if feature.point {
            sum.r += g;
        }
        for k in 0..3 {
            sum.e[k] += g * local[k];
        }
        *all_constant &= constant && feature.curve.is_none();
    }
    list
}

/// Φ of all rows.
pub fn constraints(system: &System, at: &Elimination) -> Vec<f64> {
    equations(system, at).into_iter().map(|e| e.value).collect()
}

/// ν of all rows, Φ_q q̇ = ν — eq. (4.1).
pub fn nu(system: &System, at: &Elimination) -> Vec<f64> {
    equations(system, at).into_iter().map(|e| e.nu).collect()
}

/// γ of all rows, Φ_q q̈ = γ — eq. (4.2).
pub fn gamma(system: &System, at: &Elimination) -> Vec<f64> {
    equations(system, at)
        .into_iter()
        .map(|equation| {
            let reduced: f64 = equation
                .gradient
                .iter()
                .filter(|(body, ..)| system.bodies[*body].coordinates == Coordinates::Reduced)
                .map(|(body, gradient, _)| {
                    let rate = &at.bodies[*body].q_dot;
                    gradient.e[2].dot(&(2.0 * rate.e[0].cross(&rate.e[1])))
                })
                .sum();
            equation.gamma - reduced
        })
        .collect()
}

/// Φ_q of all rows.
pub fn jacobian(system: &System, at: &Elimination) -> Jacobian {
    let mut entries = Vec::new();
    for (row, equation) in equations(system, at).into_iter().enumerate() {
        let mut gradient = equation.gradient;
        gradient.sort_by_key(|(body, ..)| *body);
        for (index, lifted, constant) in gradient {
            let body = &system.bodies[index];
            let reduced = body.coordinates == Coordinates::Reduced;
            let own = lift::pull_back(body.coordinates, &at.bodies[index].q, &lifted);
            let depends_on_w = reduced && lifted.e[2] != Vector3::zeros();
            let mut numbers = [0.0; 12];
            let size = lift::size(body.coordinates);
            lift::store(body.coordinates, &own, &mut numbers[..size]);
            for (k, &value) in numbers[..size].iter().enumerate() {
                let constant = constant && !(depends_on_w && k >= 3);
                if value != 0.0 {
                    entries.push(Entry { row, column: body.first + k, value, constant });
                }
            }
        }
    }
    Jacobian { rows: row_names(system), columns: column_names(system), entries }
}
