//! What a student's program is given: the mechanism in numbers, the names of rows and columns, and the states.

use schemars::JsonSchema;
use serde::Serialize;
use triad_engine::equations::{column_names, row_names};
use triad_engine::feature::{Difference, FeatureId, Target};
use triad_engine::lift::Director;
use triad_engine::model::BodyRef;
use triad_engine::row::Form;
use triad_engine::scene::GROUND;
use triad_engine::system::System;

use super::{Deal, State, seed, task};
use crate::files::Part;
use crate::lesson::Lesson;

/// The states that are dealt to a student, with everything that is needed to write the equations.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "Instances")]
pub struct DealView {
    /// `triad-states-1`.
    pub format: &'static str,
    /// Slug of the lesson.
    pub lesson: String,
    /// The question.
    pub question: String,
    /// Whose states these are.
    pub seed: String,
    /// What is to be returned for each state.
    pub asks: Vec<Part>,
    /// Acceleration of gravity, m/s².
    pub gravity: [f64; 3],
    /// The bodies.
    pub bodies: Vec<DealBody>,
    /// The rows of joints and drivers, in their order after the rigid-body rows.
    pub joint_rows: Vec<DealRow>,
    /// Names of all rows of Φ, in order.
    pub rows: Vec<String>,
    /// Names of all coordinates, in order.
    pub columns: Vec<String>,
    /// The states.
    pub states: Vec<DealState>,
}

/// A body.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "InstanceBody")]
pub struct DealBody {
    /// Name.
    pub name: String,
    /// `full`: r, u, v, w; `reduced`: r, u, v and w = u × v.
    pub coordinates: &'static str,
    /// First of its columns, from 0.
    pub first_column: usize,
    /// Mass, kg.
    pub mass: f64,
    /// Moments of inertia about u, v, w, kg m².
    pub inertia: [f64; 3],
}

/// A row of a joint: one or three equations.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "InstanceRow")]
pub struct DealRow {
    /// The joint and the label of the row.
    pub name: String,
    /// `difference`: a − b = 0, three equations (CP, TP, CV, OV). `product`: a · b − c = 0, one equation.
    pub form: &'static str,
    /// First of its rows of Φ, from 0.
    pub first_row: usize,
    /// Point or vector a.
    pub a: DealFeature,
    /// Point or vector b.
    pub b: DealFeature,
    /// The number c of a product.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub c: Option<DealNumber>,
}

/// A point or a vector of a body, less another one if there is one.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "InstanceFeature")]
pub struct DealFeature {
    /// The body, or `ground`.
    pub body: String,
    /// `point` (moves with r) or `vector` (only turns).
    pub kind: &'static str,
    /// ξ, η, ζ along u, v, w of the body; of the ground along x, y, z.
    pub local: [f64; 3],
    /// What is taken off it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub minus: Option<Box<DealFeature>>,
}

/// A number, or a prescribed one: its value and two derivatives at each state.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "InstanceNumber")]
pub enum DealNumber {
    /// Always the same.
    Constant(f64),
    /// A prescribed one.
    Driven {
        /// Whether c is the cosine of what is prescribed, an angle in rad.
        cosine_of_angle: bool,
        /// What is prescribed: value, rate and second derivative at each state.
        states: Vec<[f64; 3]>,
    },
}

/// A state.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "InstanceState")]
pub struct DealState {
    /// Time, s.
    pub t: f64,
    /// q, in the order of the columns.
    pub q: Vec<f64>,
    /// q̇.
    pub qd: Vec<f64>,
}

impl Lesson {
    /// The states of an implement question for this lesson's seed; `None` if the question is of another kind.
    pub fn deal(&self, question: &str) -> Option<Result<DealView, String>> {
        let task = task(self, question)?;
        Some(Deal::new(task, &seed(self, question)).and_then(|deal| {
            let joint_rows = joint_rows(&deal)?;
            let system = &deal.mechanism.system;
            Ok(DealView {
                format: "triad-states-1",
                lesson: self.slug.clone(),
                question: question.to_owned(),
                seed: self.seed.clone(),
                asks: task.asks.clone(),
                gravity: system.model.gravity.into(),
                bodies: bodies(system),
                joint_rows,
                rows: row_names(system),
                columns: column_names(system),
                states: deal.states.iter().map(DealState::new).collect(),
            })
        }))
    }
}

impl DealState {
    fn new(state: &State) -> Self {
        Self { t: state.t, q: state.q.clone(), qd: state.q_dot.clone() }
    }
}

fn bodies(system: &System) -> Vec<DealBody> {
    let body = |(body, model): (&triad_engine::body::Body, &triad_engine::model::ModelBody)| DealBody {
        name: model.name.clone(),
        coordinates: if body.layout.directors.contains(&Director::Product) { "reduced" } else { "full" },
        first_column: body.layout.first,
        mass: body.mass,
        inertia: body.principal.into(),
    };
    system.bodies.iter().zip(&system.model.bodies).map(body).collect()
}

fn joint_rows(deal: &Deal) -> Result<Vec<DealRow>, String> {
    let mut list = Vec::new();
    let system = &deal.mechanism.system;
    for group in &system.groups {
        for row in system.rows[group.forms.clone()].iter().filter(|row| !row.implied) {
            let (form, a, b, c) = match row.form {
                Form::Coincidence { a, b } | Form::CommonVector { a, b } => {
                    ("difference", feature(system, a)?, feature(system, b)?, None)
                }
                Form::Product { a, b, target } => {
                    let number = number(deal, target);
                    ("product", difference(system, a)?, difference(system, b)?, Some(number))
                }
                Form::Relation { .. } => return Err("a relation of angles cannot be dealt".to_owned()),
            };
            let name = format!("{}: {}", group.name, row.label);
            list.push(DealRow { name, form, first_row: system.rigid_rows + row.equation, a, b, c });
        }
    }
    Ok(list)
}

fn number(deal: &Deal, target: Target) -> DealNumber {
    match target {
        Target::Constant(c) => DealNumber::Constant(c),
        Target::Driven(k) => {
            let target = &deal.mechanism.system.targets[k];
            let states = deal.states.iter().map(|state| target.curve.at(state.t)).collect();
            DealNumber::Driven { cosine_of_angle: target.cosine, states }
        }
    }
}

fn difference(system: &System, d: Difference) -> Result<DealFeature, String> {
    let mut plus = feature(system, d.plus)?;
    plus.minus = d.minus.map(|minus| feature(system, minus).map(Box::new)).transpose()?;
    Ok(plus)
}

fn feature(system: &System, id: FeatureId) -> Result<DealFeature, String> {
    let feature = &system.features[id];
    if feature.curve.is_some() {
        return Err("a point or vector that moves as prescribed cannot be dealt; use an angle".to_owned());
    }
    let body = match feature.body {
        BodyRef::Ground => GROUND.to_owned(),
        BodyRef::Moving(k) => system.model.bodies[k].name.clone(),
    };
    let kind = if feature.point { "point" } else { "vector" };
    Ok(DealFeature { body, kind, local: feature.local.into(), minus: None })
}
