//! Chosen numbers of a run as the columns of a table: [`Output`] says which.

mod columns;
mod moments;
mod text;

pub use moments::{Moment, RowWriter};
pub use text::append_row;

use super::{ErrorEstimate, Simulation};
use crate::integrate::add_power;
use crate::scene::{Output, OutputKind};
use nalgebra::Vector3;
use std::ops::Range;
use triad_dynamics::model::{BodyRef, DriverKind, ModelJoint};
use triad_dynamics::state::State;

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Element and quantity, such as `rod.omega_z`.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
}

/// Groups of columns, each of one element.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Group {
    Body(usize),
    Frame(usize),
    Acceleration(usize),
    Reaction(usize),
    Driver { constraint: usize, driver: usize },
    Angle(usize),
    Slide(usize),
    Load(usize),
    Marker(usize),
    Energy,
    Balance,
    Violations,
    Errors { reactions: bool },
}

/// The columns that a choice of outputs makes for a scene, and their numbers at the current state of its run.
///
/// ```
/// use triad_engine::prelude::*;
/// use triad_engine::run::Outputs;
///
/// let mut scene = catalogue::scene("simple-pendulum")?;
/// scene.simulation.outputs = vec!["joints".parse().unwrap(), "energy".parse().unwrap()];
/// let mut run = Simulation::new(&scene)?;
/// let outputs = Outputs::new(&run);
/// let names: Vec<&str> = outputs.columns().iter().map(|column| column.name.as_str()).collect();
/// assert_eq!(names, ["pin.angle", "pin.angle_rate", "energy"]);
/// run.advance_to(0.5)?;
/// let mut row = Vec::new();
/// outputs.write(&run, &mut row);
/// assert!(row[0] > 1.0 && row.len() == 3);
/// # Ok::<(), EngineError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Outputs {
    columns: Vec<Column>,
    groups: Vec<Group>,
    conventions: Vec<String>,
    /// Columns of reactions that may not be unique.
    shared: Vec<Range<usize>>,
}

impl Outputs {
    /// For the outputs that the scene of a run chooses.
    pub fn new(run: &Simulation) -> Self {
        let mut outputs =
            Self { columns: Vec::new(), groups: Vec::new(), conventions: Vec::new(), shared: Vec::new() };
        for output in &run.model().settings.outputs {
            for group in groups(run, output) {
                if outputs.groups.contains(&group) {
                    continue;
                }
                let before = outputs.columns.len();
                outputs.add(run, group);
                if run.is_redundant() && matches!(group, Group::Reaction(_) | Group::Driver { .. }) {
                    outputs.shared.push(before..outputs.columns.len());
                }
            }
        }
        outputs.tell_more();
        outputs
    }

    /// Whether a column holds a reaction, or its power, of a mechanism in which not all of them are unique.
    pub fn may_be_shared(&self, column: usize) -> bool {
        let reacts = |unit| ["N", "N m", "W"].contains(&unit);
        self.shared.iter().any(|columns| columns.contains(&column))
            && self.columns.get(column).is_some_and(|column| reacts(column.unit))
    }

    /// That not all reactions among the columns are unique, if that is so.
    pub fn shared_note(&self) -> Option<&'static str> {
        (!self.shared.is_empty()).then_some(columns::SHARED)
    }

    /// The columns, in their order.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// What the columns mean, in sentences: frames, points and signs.
    pub fn conventions(&self) -> &[String] {
        &self.conventions
    }

    /// Appends the numbers of the current state, one for each column. Reactions and accelerations are solved for only if a
    /// column needs them.
    pub fn write(&self, run: &Simulation, row: &mut Vec<f64>) {
        for &group in &self.groups {
            write(run, group, row);
        }
    }
}

/// The groups of an output: one for each element that it is wanted of.
fn groups(run: &Simulation, output: &Output) -> Vec<Group> {
    let (system, model) = (run.system(), run.model());
    let wanted = |name: &str| output.of.as_deref().is_none_or(|of| of == name);
    let bodies = |group: fn(usize) -> Group| -> Vec<Group> {
        let chosen = model.bodies.iter().enumerate().filter(|(_, body)| wanted(&body.name));
        chosen.map(|(index, _)| group(index)).collect()
    };
    let constraints =
        system.constraints.iter().enumerate().filter(|(_, constraint)| wanted(&constraint.name));
    match output.kind {
        OutputKind::Bodies => bodies(Group::Body),
        OutputKind::Frames => bodies(Group::Frame),
        OutputKind::Accelerations => bodies(Group::Acceleration),
        OutputKind::Reactions => constraints.map(|(index, _)| Group::Reaction(index)).collect(),
        OutputKind::Drivers => constraints
            .filter(|(_, constraint)| constraint.driver)
            .filter_map(|(index, _)| {
                let driver = index.checked_sub(model.joints.len())?;
                Some(Group::Driver { constraint: index, driver })
            })
            .collect(),
        OutputKind::Joints => {
            let joints = model.joints.iter().enumerate().filter(|(_, joint)| wanted(&joint.name));
            joints
                .flat_map(|(index, joint)| {
                    let angle = system.angle_joints.iter().position(|known| *known == joint.name);
                    let angle = angle.filter(|_| joint.has_angle()).map(Group::Angle);
                    angle.into_iter().chain(joint.has_slide().then_some(Group::Slide(index)))
                })
                .collect()
        }
        OutputKind::Loads => {
            let loads = model.loads.iter().enumerate().filter(|(_, load)| wanted(&load.name));
            loads.map(|(index, _)| Group::Load(index)).collect()
        }
        OutputKind::Markers => {
            let markers = model.markers.iter().enumerate().filter(|(_, marker)| wanted(&marker.name));
            markers.map(|(index, _)| Group::Marker(index)).collect()
        }
        OutputKind::Energy => vec![Group::Energy],
        OutputKind::Balance => vec![Group::Balance],
        OutputKind::Violations => vec![Group::Violations],
        OutputKind::Errors if model.settings.error_estimate => {
            let react = |kind| matches!(kind, OutputKind::Reactions | OutputKind::Drivers);
            let reactions = model.settings.outputs.iter().any(|output| react(output.kind));
            vec![Group::Errors { reactions: reactions && !system.constraints.is_empty() }]
        }
        OutputKind::Errors => Vec::new(),
    }
}

/// Appends the numbers of a group at the current state.
fn write(run: &Simulation, group: Group, row: &mut Vec<f64>) {
    let (system, model) = (run.system(), run.model());
    let state = run.current.state(system);
    match group {
        Group::Body(body) => {
            let frame = triad_dynamics::state::BodyFrame::from(&state.bodies()[body]);
            let vectors = [frame.position, frame.u, frame.v, frame.w, frame.velocity, frame.angular_velocity];
            row.extend(vectors.as_flattened());
        }
        Group::Frame(body) => {
            let (own, q) = (&model.bodies[body], &state.bodies()[body].q);
            let [origin, velocity] =
                state.point(BodyRef::Moving(body), &own.point_to_principal(&Vector3::zeros()));
            let axes =
                [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| q.arm(&own.vector_to_principal(&axis)));
            push(row, &[origin, axes[0], axes[1], axes[2], velocity]);
        }
        Group::Acceleration(body) => {
            let view = run.state();
            let second = view.solved().of_body(body);
            let q = &state.bodies()[body].q;
            // α = ½ Σ e_k × ë_k, as Σ ė_k × ė_k = 0 — eq. (6.4).
            let turning: Vector3<f64> = (0..3).map(|k| q.e[k].cross(&second.e[k])).sum();
            push(row, &[second.r, turning * 0.5]);
        }
        Group::Reaction(constraint) => push(row, &run.current.wrenches(run)[constraint]),
        Group::Driver { constraint, driver } => {
            write_driver(run, constraint, &model.drivers[driver].kind, row);
        }
        Group::Angle(angle) => row.extend([state.angles()[angle].value, state.angles()[angle].rate]),
        Group::Slide(joint) => row.extend(slide(&model.joints[joint], state)),
        Group::Load(load) => write_load(run, load, row),
        Group::Marker(marker) => {
            let marker = &model.markers[marker];
            push(row, &state.point(marker.body, &marker.local));
        }
        Group::Energy => row.push(state.energy(system)),
        Group::Balance => {
            let (energy, kinetic) = (state.energy(system), state.kinetic_energy(system));
            let work = run.work + run.work_up_to_current();
            row.extend([kinetic, energy - kinetic, work, energy - run.start_energy - work]);
        }
        Group::Violations => row.extend([state.position_violation(system), state.velocity_violation(system)]),
        Group::Errors { reactions } => write_errors(run, reactions, row),
    }
}

fn write_load(run: &Simulation, load: usize, row: &mut Vec<f64>) {
    let system = run.system();
    let state = run.current.state(system);
    let dry = system.frictions.iter().find(|dry| dry.load == load);
    let load = &system.loads[load];
    if let Some(vector) = load.given(state) {
        push(row, &[vector]);
        row.push(load.power(state));
    } else {
        // A spring of no length has no direction to act in.
        let [x, rate, mut value] = load.acting(state).unwrap_or_default();
        if let Some(dry) = dry {
            value += run.state().solved().multipliers.dry_friction(dry)[0];
        }
        row.extend([x, rate, value, value * rate]);
    }
}

fn write_errors(run: &Simulation, reactions: bool, row: &mut Vec<f64>) {
    let of = |error: ErrorEstimate| {
        [error.position, error.turn, error.velocity, error.angular_velocity, error.energy]
    };
    row.extend(run.error_estimate().map_or([f64::NAN; 5], of));
    if reactions {
        row.extend(run.reaction_errors().map_or([f64::NAN; 2], |error| [error.force, error.moment]));
    }
}

fn push(row: &mut Vec<f64>, vectors: &[Vector3<f64>]) {
    for vector in vectors {
        row.extend(vector.as_slice());
    }
}

/// Of a driven angle or slide its value, its rate and the effort along it, of another driver force and moment; and the power.
fn write_driver(run: &Simulation, constraint: usize, kind: &DriverKind, row: &mut Vec<f64>) {
    let (view, [force, moment]) = (run.state(), run.current.wrenches(run)[constraint]);
    let at = &view.solved().multipliers;
    match kind {
        DriverKind::Angle { joint, motion } | DriverKind::Slide { joint, motion } => {
            let joint = &at.system.model.joints[*joint];
            let [value, rate, _] = motion.at(at.state.time());
            let [axis, _] = direction(joint, at.state);
            // The reaction is that on body j, or on body i where j is the ground.
            let sign = if joint.bodies[1] == BodyRef::Ground { -1.0 } else { 1.0 };
            let along = if matches!(kind, DriverKind::Angle { .. }) { moment } else { force };
            row.extend([value, rate, sign * axis.dot(&along)]);
        }
        DriverKind::Point { .. }
        | DriverKind::Vector { .. }
        | DriverKind::Cosine { .. }
        | DriverKind::CosineToWorld { .. } => push(row, &[force, moment]),
    }
    let mut power = 0.0;
    add_power(at, &at.system.constraints[constraint], &mut power);
    row.push(power);
}

/// The axis of a joint on body i in the world, and its rate.
fn direction(joint: &ModelJoint, at: &State) -> [Vector3<f64>; 2] {
    match joint.bodies[0] {
        BodyRef::Ground => [joint.axes[0], Vector3::zeros()],
        BodyRef::Moving(body) => {
            let body = &at.bodies()[body];
            [body.q.arm(&joint.axes[0]), body.q_dot.arm(&joint.axes[0])]
        }
    }
}

/// The displacement of a joint along its axis, and its rate.
fn slide(joint: &ModelJoint, at: &State) -> [f64; 2] {
    let [i, j] = [0, 1].map(|side| at.point(joint.bodies[side], &joint.points[side]));
    let [axis, turning] = direction(joint, at);
    let (between, rate) = (j[0] - i[0], j[1] - i[1]);
    [axis.dot(&between), axis.dot(&rate) + turning.dot(&between)]
}
