//! What a student's program is given: the mechanism in numbers, the names of rows and columns, and the states.

use schemars::JsonSchema;
use serde::Serialize;
use triad_engine::equations::{column_names, row_names};
use triad_engine::model::BodyRef;
use triad_engine::scene::GROUND;
use triad_engine::system::System;
use triad_engine::system::feature::{Difference, Target};
use triad_engine::system::index::FeatureId;
use triad_engine::system::natural::Director;
use triad_engine::system::row::Form;

use super::instances::{Instance, InstanceError, Instances, seed, task};
use crate::files::EquationPart;
use crate::lesson::Lesson;

/// The instances of a student, with everything that is needed to write the equations.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "Instances")]
pub struct InstancesView {
    /// `triad-states-1`.
    pub format: &'static str,
    /// Slug of the lesson.
    pub lesson: String,
    /// The question.
    pub question: String,
    /// Whose states these are.
    pub seed: String,
    /// What is to be returned for each state.
    pub asks: Vec<EquationPart>,
    /// Acceleration of gravity, m/s².
    pub gravity: [f64; 3],
    /// The bodies.
    pub bodies: Vec<InstanceBody>,
    /// The rows of joints and drivers, in their order after the rigid-body rows.
    pub joint_rows: Vec<InstanceRow>,
    /// Names of all rows of Φ, in order.
    pub rows: Vec<String>,
    /// Names of all coordinates, in order.
    pub columns: Vec<String>,
    /// The states.
    pub states: Vec<InstanceState>,
}

/// A body.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct InstanceBody {
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
pub struct InstanceRow {
    /// The joint and the label of the row.
    pub name: String,
    /// `difference`: a − b = 0, three equations (CP, TP, CV, OV). `product`: a · b − c = 0, one equation.
    pub form: &'static str,
    /// First of its rows of Φ, from 0.
    pub first_row: usize,
    /// Point or vector a.
    pub a: InstanceFeature,
    /// Point or vector b.
    pub b: InstanceFeature,
    /// The number c of a product.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub c: Option<InstanceNumber>,
}

/// A point or a vector of a body, less another one if there is one.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct InstanceFeature {
    /// The body, or `ground`.
    pub body: String,
    /// `point` (moves with r) or `vector` (only turns).
    pub kind: &'static str,
    /// ξ, η, ζ along u, v, w of the body; of the ground along x, y, z.
    pub local: [f64; 3],
    /// What is taken off it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub minus: Option<Box<InstanceFeature>>,
}

/// A number, or a prescribed one: its value and two derivatives at each state.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum InstanceNumber {
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
pub struct InstanceState {
    /// Time, s.
    pub t: f64,
    /// q, in the order of the columns.
    pub q: Vec<f64>,
    /// q̇.
    pub qd: Vec<f64>,
}

impl Lesson {
    /// The instances of a question for this lesson's seed; `None` if the question is of another kind.
    ///
    /// Errors if a state cannot be drawn.
    pub fn instances(&self, question: &str) -> Option<Result<InstancesView, InstanceError>> {
        let task = task(self, question)?;
        Some(Instances::new(task, &seed(self, question)).and_then(|instances| {
            let joint_rows = joint_rows(&instances)?;
            let system = &instances.mechanism.system;
            Ok(InstancesView {
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
                states: instances.states.iter().map(InstanceState::new).collect(),
            })
        }))
    }
}

impl InstanceState {
    fn new(state: &Instance) -> Self {
        Self { t: state.t, q: state.q.clone(), qd: state.q_dot.clone() }
    }
}

fn bodies(system: &System) -> Vec<InstanceBody> {
    let body = |(body, model): (&triad_engine::system::body::RigidBody, &triad_engine::model::ModelBody)| {
        InstanceBody {
            name: model.name.clone(),
            coordinates: if body.layout.directors.contains(&Director::Product) { "reduced" } else { "full" },
            first_column: body.layout.first,
            mass: body.mass,
            inertia: body.principal.into(),
        }
    };
    system.bodies.iter().zip(&system.model.bodies).map(body).collect()
}

fn joint_rows(instances: &Instances) -> Result<Vec<InstanceRow>, InstanceError> {
    let mut list = Vec::new();
    let system = &instances.mechanism.system;
    for constraint in &system.constraints {
        for row in system.rows[constraint.forms.clone()].iter().filter(|row| !row.implied) {
            let (form, a, b, c) = match row.form {
                Form::Coincidence { a, b } | Form::CommonVector { a, b } => {
                    ("difference", feature(system, a)?, feature(system, b)?, None)
                }
                Form::Product { a, b, target } => {
                    let number = number(instances, target);
                    ("product", difference(system, a)?, difference(system, b)?, Some(number))
                }
                Form::Relation { .. } => return Err(InstanceError::Relation),
            };
            let name = format!("{}: {}", constraint.name, row.label);
            list.push(InstanceRow { name, form, first_row: system.rigid_rows + row.equation, a, b, c });
        }
    }
    Ok(list)
}

fn number(instances: &Instances, target: Target) -> InstanceNumber {
    match target {
        Target::Constant(c) => InstanceNumber::Constant(c),
        Target::Driven(k) => {
            let target = &instances.mechanism.system.targets[k];
            let states = instances.states.iter().map(|state| target.curve.at(state.t)).collect();
            InstanceNumber::Driven { cosine_of_angle: target.cosine, states }
        }
    }
}

fn difference(system: &System, d: Difference) -> Result<InstanceFeature, InstanceError> {
    let mut plus = feature(system, d.plus)?;
    plus.minus = d.minus.map(|minus| feature(system, minus).map(Box::new)).transpose()?;
    Ok(plus)
}

fn feature(system: &System, id: FeatureId) -> Result<InstanceFeature, InstanceError> {
    let feature = &system[id];
    if feature.curve.is_some() {
        return Err(InstanceError::MovingFeature);
    }
    let body = match feature.body {
        BodyRef::Ground => GROUND.to_owned(),
        BodyRef::Moving(k) => system.model.bodies[k].name.clone(),
    };
    let kind = if feature.point { "point" } else { "vector" };
    Ok(InstanceFeature { body, kind, local: feature.local.into(), minus: None })
}
