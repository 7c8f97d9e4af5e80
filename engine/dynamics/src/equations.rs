//! The equations as a student writes them: Φ, ν, γ and the names of rows and columns, in the generalized coordinates, rigid-body rows first.
//!
//! The solver does not use them: it works in twist form. Both are derived from the same row forms, and tests compare them.

pub mod augmented;
pub mod jacobian;

use crate::model::BodyRef;
use crate::scene::Coordinates;
use crate::state::{ScalarState, State};
use crate::system::System;
use crate::system::feature::{Difference, Target};
use crate::system::index::{FeatureId, RowId};
use crate::system::natural::NaturalCoordinates;
use crate::system::row::{Form, equation_labels};
use nalgebra::Vector3;

/// Names of the generalized coordinates.
pub fn column_names(system: &System) -> Vec<String> {
    let mut names = Vec::with_capacity(system.coordinates);
    for (body, model) in system.bodies.iter().zip(&system.model.bodies) {
        let directors = ["u", "v", "w"].into_iter().zip(body.layout.directors);
        let own = directors.filter(|(_, director)| director.is_own()).map(|(name, _)| name);
        for vector in std::iter::once("r").chain(own) {
            names.extend(["x", "y", "z"].iter().map(|axis| format!("{}.{vector}{axis}", model.name)));
        }
    }
    names
}

/// Names of all rows.
pub fn row_names(system: &System) -> Vec<String> {
    let mut names = Vec::with_capacity(system.rigid_rows + system.equations);
    for (body, model) in system.bodies.iter().zip(&system.model.bodies) {
        names.extend(body.layout.rigid_rows().map(|(_, _, label)| format!("{}: {label}", model.name)));
    }
    for constraint in &system.constraints {
        for row in system.rows[constraint.forms.clone()].iter().filter(|row| !row.implied) {
            let labels = equation_labels(row.label, row.form.equations());
            names.extend(labels.into_iter().map(|label| format!("{}: {label}", constraint.name)));
        }
    }
    names
}

/// Where an equation comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The product of two directors of a body.
    Rigid {
        /// The body.
        body: usize,
        /// The first director.
        k: usize,
        /// The second director.
        l: usize,
    },
    /// A component of a row of a joint or driver.
    Joint {
        /// The row.
        row: RowId,
        /// The component.
        component: usize,
    },
}

/// The gradient of an equation with respect to the natural coordinates of one body.
#[derive(Clone, Debug)]
pub struct BodyGradient {
    /// The body.
    pub body: usize,
    /// The gradient.
    pub gradient: NaturalCoordinates,
    /// Which of r, u, v, w can be other than zero.
    pub touched: [bool; 4],
    /// Whether it is the same at every Q.
    pub constant: bool,
}

/// One equation at one state.
#[derive(Clone, Debug)]
pub struct Equation {
    /// Φ.
    pub value: f64,
    /// ν, the rate that drivers prescribe: Φ̇ = Φ_q q̇ − ν.
    pub nu: f64,
    /// γ before the term of reduced bodies.
    pub gamma: f64,
    /// Its gradient, body by body.
    pub gradients: Vec<BodyGradient>,
}

/// Where all equations come from, in their order: rigid-body rows first.
pub fn sources(system: &System) -> Vec<Source> {
    let mut list = Vec::with_capacity(system.rigid_rows + system.equations);
    for (body, data) in system.bodies.iter().enumerate() {
        list.extend(data.layout.rigid_rows().map(|(k, l, _)| Source::Rigid { body, k, l }));
    }
    for (row, data) in system.rows.iter().enumerate().filter(|(_, data)| !data.implied) {
        let row = RowId(row);
        list.extend((0..data.form.equations()).map(|component| Source::Joint { row, component }));
    }
    list
}

/// One equation. Its ν of a relation and its γ are those of the velocities of the state.
pub fn equation(system: &System, at: &State, source: Source) -> Equation {
    match source {
        Source::Rigid { body, k, l } => rigid_equation(at, body, k, l),
        Source::Joint { row, component } => match system[row].form {
            Form::Coincidence { a, b } | Form::CommonVector { a, b } => {
                let g = Vector3::ith(component, 1.0);
                let difference = |of: &dyn Fn(FeatureId) -> Vector3<f64>| (of(a) - of(b))[component];
                Equation {
                    value: difference(&|f| at.feature_value(f)),
                    nu: -difference(&|f| at.driven_rate(system, f)),
                    gamma: -difference(&|f| at.driven_acceleration(system, f)),
                    gradients: gradients(system, at, &[(a, g, true), (b, -g, true)]),
                }
            }
            Form::Product { a, b, target } => product_equation(system, at, a, b, target),
            Form::Relation { .. } => relation_equation(system, at, &system[row].form),
        },
    }
}

fn rigid_equation(at: &State, body: usize, k: usize, l: usize) -> Equation {
    let state = &at.bodies()[body];
    let unit = if k == l { 1.0 } else { 0.0 };
    let mut gradient = NaturalCoordinates::default();
    gradient.e[k] += state.q.e[l];
    gradient.e[l] += state.q.e[k];
    let touched = [0, 1, 2, 3].map(|block| block == k + 1 || block == l + 1);
    Equation {
        value: state.q.e[k].dot(&state.q.e[l]) - unit,
        nu: 0.0,
        gamma: -2.0 * state.q_dot.e[k].dot(&state.q_dot.e[l]),
        gradients: vec![BodyGradient { body, gradient, touched, constant: false }],
    }
}

fn product_equation(system: &System, at: &State, a: Difference, b: Difference, target: Target) -> Equation {
    let value = |d: Difference| d.of(|f| at.feature_value(f));
    let rate = |d: Difference| d.of(|f| at.feature_rate(f));
    let driven_rate = |d: Difference| d.of(|f| at.driven_rate(system, f));
    let driven = |d: Difference| d.of(|f| at.driven_acceleration(system, f));
    let fixed =
        |d: Difference| [Some(d.plus), d.minus].into_iter().flatten().all(|f| f.index() >= system.changing);
    let (x, y) = (value(a), value(b));
    let mut gradient = Vec::with_capacity(4);
    for (own, g, constant) in [(a, y, fixed(b)), (b, x, fixed(a))] {
        gradient.push((own.plus, g, constant));
        gradient.extend(own.minus.map(|minus| (minus, -g, constant)));
    }
    let [c, c_rate, c_acceleration] = at.target(target);
    Equation {
        value: x.dot(&y) - c,
        nu: c_rate - driven_rate(a).dot(&y) - x.dot(&driven_rate(b)),
        gamma: c_acceleration - 2.0 * rate(a).dot(&rate(b)) - driven(a).dot(&y) - x.dot(&driven(b)),
        gradients: gradients(system, at, &gradient),
    }
}

fn relation_equation(system: &System, at: &State, form: &Form) -> Equation {
    let ScalarState { value, rate, curvature } = at.relation(form);
    let mut gradient = Vec::with_capacity(6);
    if let Form::Relation { angles, slide, .. } = *form {
        for (angle, factor) in angles.into_iter().flatten() {
            let features = system.angles[angle].features();
            let g = at.angles()[angle].gradient;
            gradient.extend(features.into_iter().zip(g).map(|(f, g)| (f, g * factor, false)));
        }
        if let Some((a, b, factor)) = slide {
            for (own, other) in [(a, b), (b, a)] {
                let g = other.of(|f| at.feature_value(f)) * factor;
                gradient.push((own.plus, g, false));
                gradient.extend(own.minus.map(|minus| (minus, -g, false)));
            }
        }
    }
    let gradients = gradients(system, at, &gradient);
    // A relation does not depend on time itself; what its rate has beyond Φ_q q̇ is that of driven features.
    let along: f64 = gradients.iter().map(|p| p.gradient.dot(&at.bodies()[p.body].q_dot)).sum();
    Equation { value, nu: along - rate, gamma: -curvature, gradients }
}

/// Cᵀ g of each feature, summed by body, bodies in their order.
fn gradients(system: &System, at: &State, gradient: &[(FeatureId, Vector3<f64>, bool)]) -> Vec<BodyGradient> {
    let mut list: Vec<BodyGradient> = Vec::with_capacity(2);
    for &(feature, g, constant) in gradient {
        let local = at.feature_local(system, feature);
        let feature = &system[feature];
        let BodyRef::Moving(body) = feature.body else { continue };
        let place = list.iter().position(|p| p.body == body).unwrap_or_else(|| {
            list.push(BodyGradient {
                body,
                gradient: NaturalCoordinates::default(),
                touched: [false; 4],
                constant: true,
            });
            list.len() - 1
        });
        let own = &mut list[place];
        if feature.point {
            own.gradient.r += g;
            own.touched[0] = true;
        }
        for k in 0..3 {
            own.gradient.e[k] += g * local[k];
            own.touched[k + 1] |= local[k] != 0.0 || feature.curve.is_some();
        }
        own.constant &= constant && feature.curve.is_none();
    }
    list.sort_by_key(|own| own.body);
    list
}

fn all(system: &System, at: &State) -> impl Iterator<Item = Equation> {
    sources(system).into_iter().map(move |source| equation(system, at, source))
}

/// Φ of all rows.
pub fn constraints(system: &System, at: &State) -> Vec<f64> {
    all(system, at).map(|e| e.value).collect()
}

/// ν of all rows, Φ_q q̇ = ν — eq. (4.1).
pub fn nu(system: &System, at: &State) -> Vec<f64> {
    at.require_velocities();
    all(system, at).map(|e| e.nu).collect()
}

/// γ of all rows, Φ_q q̈ = γ — eq. (4.2).
pub fn gamma(system: &System, at: &State) -> Vec<f64> {
    gamma_parts(system, at).into_iter().map(|[natural, reduced]| natural + reduced).collect()
}

/// γ of all rows in its two parts: that of the natural coordinates, and −Φ_Q V̇ q̇ of reduced bodies — eq. (3.3).
pub fn gamma_parts(system: &System, at: &State) -> Vec<[f64; 2]> {
    at.require_velocities();
    // For a reduced body V̇ q̇ = (0, 0, 0, 2 u̇ × v̇).
    let reduced = |own: &BodyGradient| match system.bodies[own.body].coordinates {
        Coordinates::Full | Coordinates::Shared => 0.0,
        Coordinates::Reduced => {
            let rate = &at.bodies()[own.body].q_dot;
            own.gradient.e[2].dot(&(2.0 * rate.e[0].cross(&rate.e[1])))
        }
    };
    all(system, at).map(|e| [e.gamma, -e.gradients.iter().map(reduced).sum::<f64>()]).collect()
}
