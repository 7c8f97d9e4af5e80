//! The assembled system: everything that never changes during a run.

pub mod index;

pub mod natural;

pub mod sharing;

pub mod feature;

pub mod angle;

pub mod row;

pub mod row_builder;

pub mod joint;

pub mod driver;

pub mod load;

mod breaks;

mod driven;

pub mod passing;

pub mod contact;

pub mod event;

pub mod body;

pub mod common_axes;

pub mod islands;

pub mod pivots;

pub mod planar;

use crate::model::motion::VectorCurve;
use crate::model::{BodyRef, Model, ModelBody, wants_joint};
use crate::system::angle::Angle;
use crate::system::body::{RigidBody, least_inertia};
use crate::system::contact::DryFriction;
use crate::system::event::EventFunction;
use crate::system::feature::{Feature, TargetCurve};
use crate::system::index::{ConstraintId, FeatureId, IncidenceId, RowId, SolverRow};
use crate::system::load::SystemLoad;
use crate::system::natural::NaturalCoordinates;
use crate::system::row::Form;
use crate::system::row_builder::{ConstraintBlock, LabelledForm, RowBuilder};
use nalgebra::Vector3;
use std::collections::HashMap;
use std::ops::{Index, Range};
use std::sync::Arc;
use triad_linalg::larger_or_nan;

/// Longest arm, in radii of gyration, below which a mechanism has none: what rounding leaves of a hub in the centre of mass is no
/// length of a wheel.
const NO_ARM: f64 = 1e-3;
/// Distance of points, in their largest coordinate, that is none.
const ROUNDED: f64 = 1e-12;

/// The rows of one joint or driver.
#[derive(Clone, Debug)]
pub struct Constraint {
    /// Name of the joint or driver.
    pub name: String,
    /// Whether it is a driver.
    pub driver: bool,
    /// Bodies i and j.
    pub bodies: [BodyRef; 2],
    /// The point on each body, in its principal frame, about which the reaction is stated.
    pub points: [Vector3<f64>; 2],
    /// Its row forms.
    pub forms: Range<usize>,
    /// Its equations as written, within all equations of joints.
    pub equations: Range<usize>,
    /// Its rows in the solver.
    pub solver: Range<usize>,
    /// Its incidences: one for each moving body that it touches.
    pub incidences: Range<usize>,
}

/// A joint's rows meeting a body: an m × 6 block of the twist Jacobian.
#[derive(Clone, Copy, Debug)]
pub struct Incidence {
    /// The joint.
    pub constraint: ConstraintId,
    /// The body.
    pub body: usize,
    /// Offset of the block (rows are contiguous).
    pub offset: usize,
    /// Number of rows m.
    pub rows: usize,
}

/// A row form with its place among the rows.
#[derive(Clone, Debug)]
pub struct Row {
    /// The statement.
    pub form: Form,
    /// Its name within its joint.
    pub label: &'static str,
    /// Whether shared coordinates satisfy it by themselves: then it is not written, and the solver keeps it only for
    /// its multiplier.
    pub implied: bool,
    /// First equation, within all equations of joints.
    pub equation: usize,
    /// First solver row.
    pub solver: usize,
    /// First solver row within its joint.
    pub local: usize,
    /// For each feature of the form in the order of [`Form::features`], the incidence of its body.
    pub incidence: [usize; 6],
}

/// Marks a feature of the ground, which meets no moving body.
pub const NO_INCIDENCE: usize = usize::MAX;

/// The assembled system.
#[derive(Clone, Debug)]
pub struct System {
    /// The model it was assembled from.
    pub model: Model,
    /// The moving bodies.
    pub bodies: Vec<RigidBody>,
    /// All features: first those fixed in moving bodies, then those that move as prescribed, then those fixed in
    /// the ground.
    pub features: Vec<Feature>,
    /// How many features are fixed in moving bodies.
    pub moving: usize,
    /// How many features are not fixed in the ground.
    pub changing: usize,
    /// Curves of the features that move as prescribed.
    pub curves: Vec<VectorCurve>,
    /// Prescribed numbers.
    pub targets: Vec<TargetCurve>,
    /// Angles of joints.
    pub angles: Vec<Angle>,
    /// The joint of each angle.
    pub angle_joints: Vec<String>,
    /// How many of them rows, loads or events depend on. The others are only written: no step may depend on these.
    pub needed_angles: usize,
    /// Loads besides gravity.
    pub loads: Vec<SystemLoad>,
    /// Friction of loads that the reaction of their joint loads.
    pub frictions: Vec<DryFriction>,
    /// Numbers whose passing of a value is an event.
    pub event_functions: Arc<[EventFunction]>,
    /// The rows.
    pub rows: Vec<Row>,
    /// The joints.
    pub constraints: Vec<Constraint>,
    /// Where joints meet bodies.
    pub incidences: Vec<Incidence>,
    /// For each body, the incidences that touch it.
    pub incidences_of_body: Vec<Vec<usize>>,
    /// Number of generalized coordinates.
    pub coordinates: usize,
    /// Number of rigid-body rows.
    pub rigid_rows: usize,
    /// Number of joint equations as written.
    pub equations: usize,
    /// Number of joint rows in the solver.
    pub solver_rows: usize,
    /// Numbers in all incidence blocks.
    pub block_entries: usize,
    /// A length of the mechanism, m: the longest arm of a joint or load, or what stands for it — THEORY section 8.
    pub length: f64,
}

impl System {
    /// Assembles a model.
    pub fn new(model: Model) -> Self {
        let mut builder = RowBuilder::default();
        for joint in &model.joints {
            joint::build(&model, joint, &mut builder);
        }
        for driver in &model.drivers {
            driver::build(&model, driver, &mut builder);
        }
        let mut loads: Vec<SystemLoad> =
            model.loads.iter().map(|l| SystemLoad::new(&model, l, &mut builder)).collect();
        let event_functions =
            model.events.iter().map(|event| EventFunction::new(&model, event, &mut builder)).collect();
        let needed_angles = builder.angles.len();
        for joint in model.joints.iter().filter(|joint| wants_joint(&model.settings.outputs, &joint.name)) {
            if joint.has_angle() {
                builder.angle(joint);
            }
        }
        let place = builder.sort_features();
        for load in &mut loads {
            load.rename(&place);
        }
        let RowBuilder { features, curves, targets, angles, angle_joints, constraints, .. } = builder;
        let mut system = Self {
            bodies: Vec::with_capacity(model.bodies.len()),
            moving: features.iter().filter(|f| !f.is_fixed() && f.curve.is_none()).count(),
            changing: features.iter().filter(|f| !f.is_fixed()).count(),
            features,
            curves,
            targets,
            angles,
            angle_joints,
            needed_angles,
            loads,
            frictions: DryFriction::all(&model),
            event_functions,
            rows: Vec::new(),
            constraints: Vec::with_capacity(constraints.len()),
            incidences: Vec::new(),
            incidences_of_body: vec![Vec::new(); model.bodies.len()],
            coordinates: 0,
            rigid_rows: 0,
            equations: 0,
            solver_rows: 0,
            block_entries: 0,
            length: 1.0,
            model,
        };
        system.length = system.characteristic_length();
        system.add_bodies();
        for constraint in constraints {
            system.add_constraint(constraint);
        }
        system
    }

    /// The longest arm; of a mechanism without arms, or with such as rounding leaves, the largest radius of gyration or, if that is
    /// less, distance between points of joints and loads at the start.
    fn characteristic_length(&self) -> f64 {
        let arm = self.arms(Vector3::norm).into_iter().fold(0.0, f64::max);
        let radius = |body: &ModelBody| (body.principal.max() / body.mass).sqrt();
        let radius = self.model.bodies.iter().map(radius).fold(0.0, f64::max);
        if arm > 0.0 && arm >= NO_ARM * radius {
            return arm;
        }
        let points: Vec<_> = self.features.iter().filter(|f| f.point).map(|f| self.at_start(f)).collect();
        let apart = |p: &Vector3<f64>| points.first().map_or(0.0, |first| (p - first).norm());
        let (apart, far) =
            points.iter().fold((0.0f64, 0.0f64), |most, p| (most.0.max(apart(p)), most.1.max(p.amax())));
        let spread = if apart > ROUNDED * far { apart } else { 0.0 };
        let largest = radius.max(spread);
        if largest > 0.0 { largest } else { 1.0 }
    }

    /// Where a point is at the start, m; of one that moves as prescribed, where its curve has its zero.
    fn at_start(&self, point: &Feature) -> Vector3<f64> {
        match point.body {
            BodyRef::Ground => point.local,
            BodyRef::Moving(body) => {
                let body = &self.model.bodies[body];
                body.position + body.directors * point.local
            }
        }
    }

    /// Longest arm of each body's joints and loads, m, each of this length for where its point is from the centre of mass.
    fn arms(&self, length: impl Fn(&Vector3<f64>) -> f64) -> Vec<f64> {
        let mut arms = vec![0.0f64; self.model.bodies.len()];
        for feature in self.features.iter().filter(|f| f.point) {
            if let BodyRef::Moving(body) = feature.body {
                arms[body] = arms[body].max(length(&feature.local));
            }
        }
        arms
    }

    fn add_bodies(&mut self) {
        let layouts = sharing::layouts(&self.model);
        let arms = self.arms(Vector3::norm);
        let least = least_inertia(self.model.bodies.iter().map(|body| &body.principal));
        for ((body, layout), arm) in self.model.bodies.iter().zip(layouts).zip(arms) {
            self.bodies.push(RigidBody::new(body, layout, arm, self.length, least));
            self.coordinates += layout.size();
            self.rigid_rows += layout.rigid_rows().count();
        }
    }

    /// The same joints with bodies of mass one, and the arm of their joints as radius of gyration about every axis: a measure of
    /// lengths in which rank is decided — eq. (8.2).
    #[must_use]
    pub fn in_lengths(&self) -> Self {
        let mut system = self.clone();
        for (body, arm) in system.bodies.iter_mut().zip(self.arms(Vector3::norm)) {
            body.measure_lengths(arm, self.length);
        }
        system
    }

    fn add_constraint(&mut self, written: ConstraintBlock) {
        let ConstraintBlock { name, forms, bodies: pair, points, driver } = written;
        let index = ConstraintId(self.constraints.len());
        let size: usize = forms.iter().map(|row| row.form.independent()).sum();
        let first = self.incidences.len();
        let mut bodies: Vec<usize> = forms
            .iter()
            .flat_map(|row| row.form.features(&self.angles))
            .filter_map(|f| match self[f].body {
                BodyRef::Ground => None,
                BodyRef::Moving(body) => Some(body),
            })
            .collect();
        bodies.sort_unstable();
        bodies.dedup();
        for body in bodies {
            self.incidences_of_body[body].push(self.incidences.len());
            self.incidences.push(Incidence {
                constraint: index,
                body,
                offset: self.block_entries,
                rows: size,
            });
            self.block_entries += 6 * size;
        }
        let (first_form, first_equation) = (self.rows.len(), self.equations);
        let mut local = 0;
        for LabelledForm { label, form, implied } in forms {
            let mut incidence = [NO_INCIDENCE; 6];
            for (k, f) in form.features(&self.angles).into_iter().enumerate() {
                if let BodyRef::Moving(body) = self[f].body {
                    let found = (first..self.incidences.len()).find(|&i| self.incidences[i].body == body);
                    incidence[k] = found.unwrap_or(NO_INCIDENCE);
                }
            }
            self.rows.push(Row {
                form,
                label,
                implied,
                equation: self.equations,
                solver: self.solver_rows + local,
                local,
                incidence,
            });
            self.equations += if implied { 0 } else { form.equations() };
            local += form.independent();
        }
        self.constraints.push(Constraint {
            name,
            driver,
            bodies: pair,
            points,
            forms: first_form..self.rows.len(),
            equations: first_equation..self.equations,
            solver: self.solver_rows..self.solver_rows + size,
            incidences: first..self.incidences.len(),
        });
        self.solver_rows += size;
    }

    /// All joints and drivers.
    pub fn constraint_ids(&self) -> impl Iterator<Item = ConstraintId> + use<> {
        (0..self.constraints.len()).map(ConstraintId)
    }

    /// Whether nothing but weight and springs acts: then the energy stays what it is.
    pub fn is_conservative(&self) -> bool {
        !self.constraints.iter().any(|constraint| constraint.driver)
            && self.loads.iter().all(SystemLoad::is_conservative)
            && self.model.custom_loads.is_empty()
    }

    /// Whether any body has no inertia about some axis.
    pub fn regularizes_inertia(&self) -> bool {
        self.bodies.iter().any(|b| b.regularizing_inertia > 0.0)
    }

    /// The angles of joints that whole turns are counted from at the start: those that the author gives, or those where the
    /// bodies are stated.
    pub fn start_angles(&self) -> impl Iterator<Item = f64> + use<'_> {
        let model = &self.model;
        let mut known: HashMap<&str, f64> = HashMap::new();
        let stated = model.joints.iter().filter(|joint| joint.stated != 0.0);
        known.extend(stated.map(|joint| (joint.name.as_str(), joint.stated)));
        let given = model.starts.iter().filter_map(|start| Some((start.joint, start.angle?)));
        known.extend(given.map(|(joint, angle)| (model.joints[joint].name.as_str(), angle)));
        self.angle_joints.iter().map(move |name| known.get(name.as_str()).copied().unwrap_or(0.0))
    }

    /// Writes the start of the model as (q, q̇), each of [`System::coordinates`] numbers.
    pub fn start(&self, q: &mut [f64], q_dot: &mut [f64]) {
        self.start_of(&self.model.bodies, q, q_dot);
    }

    /// Writes (q, q̇) of the system's bodies where others of the same coordinates start.
    pub fn start_of(&self, bodies: &[ModelBody], q: &mut [f64], q_dot: &mut [f64]) {
        for (body, model) in self.bodies.iter().zip(bodies) {
            let e = [0, 1, 2].map(|k| model.directors.column(k).into_owned());
            body.layout.store(&NaturalCoordinates { r: model.position, e }, q);
            let e_dot = e.map(|e| model.angular_velocity.cross(&e));
            body.layout.store(&NaturalCoordinates { r: model.velocity, e: e_dot }, q_dot);
        }
    }

    /// The longest way of a body from one position q to another, m, arcs at the mechanism's length. Not a number if one of q is none.
    pub fn longest_way(&self, from: &[f64], to: &[f64]) -> f64 {
        let ways = self.bodies.iter().map(|body| {
            let [a, b] = [from, to].map(|q| body.position(q));
            let turned = (0..3).map(|k| (a.e[k] - b.e[k]).norm()).fold(0.0, f64::max);
            (a.r - b.r).norm().max(self.length * turned)
        });
        ways.fold(0.0, larger_or_nan)
    }
}

impl Constraint {
    /// Its row forms.
    pub fn row_ids(&self) -> impl Iterator<Item = RowId> + use<> {
        self.forms.clone().map(RowId)
    }

    /// Its rows in the solver.
    pub fn solver_rows(&self) -> impl Iterator<Item = SolverRow> + use<> {
        self.solver.clone().map(SolverRow)
    }

    /// Where it meets moving bodies.
    pub fn incidence_ids(&self) -> impl Iterator<Item = IncidenceId> + use<> {
        self.incidences.clone().map(IncidenceId)
    }
}

macro_rules! indexed {
    ($($id:ident: $list:ident of $item:ident;)*) => {$(
        impl Index<$id> for System {
            type Output = $item;

            #[inline]
            fn index(&self, id: $id) -> &$item {
                &self.$list[id.index()]
            }
        }
    )*};
}

indexed! {
    FeatureId: features of Feature;
    ConstraintId: constraints of Constraint;
    RowId: rows of Row;
    IncidenceId: incidences of Incidence;
}
