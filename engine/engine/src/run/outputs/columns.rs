//! Names, units and conventions of the columns of a table.

use super::{Column, Group, Outputs};
use crate::run::Simulation;
use crate::scene::{GROUND, OutputKind};
use triad_dynamics::model::{BodyRef, DriverKind, LoadKind};

/// Names of the components of a vector.
const AXES: [&str; 3] = ["x", "y", "z"];

/// That not all reactions are determined.
pub(super) const SHARED: &str = "Rows of this mechanism depend on each other, so that its reactions are not all unique: triad reactions \
                                 tells which numbers are; the others may differ here from the smallest ones, which it shows.";

/// The name of an element in its columns: with its kind where columns of one of the `others` have the same name.
fn distinct<'a>(
    run: &Simulation,
    kind: &str,
    name: &str,
    others: [OutputKind; 3],
    mut names: impl Iterator<Item = &'a str>,
) -> String {
    let chosen = run.model().settings.outputs.iter().any(|output| others.contains(&output.kind));
    if chosen && names.any(|other| other == name) { format!("{kind}:{name}") } else { name.to_owned() }
}

impl Outputs {
    /// Adds the columns of a group.
    pub(super) fn add(&mut self, run: &Simulation, group: Group) {
        let (system, model) = (run.system(), run.model());
        self.groups.push(group);
        match group {
            Group::Body(body) => self.vectors(
                &model.bodies[body].name,
                &[("r", "m"), ("u", "1"), ("v", "1"), ("w", "1"), ("v_r", "m/s"), ("omega_", "rad/s")],
                "r: centre of mass; u, v, w: principal axes; omega: angular velocity.",
            ),
            Group::Frame(body) => self.vectors(
                &model.bodies[body].name,
                &[("p", "m"), ("x_", "1"), ("y_", "1"), ("z_", "1"), ("v_p", "m/s")],
                "p: reference point of the body; x_, y_, z_: the axes of its frame, as its author wrote them.",
            ),
            Group::Acceleration(body) => self.vectors(
                &model.bodies[body].name,
                &[("a_r", "m/s^2"), ("alpha_", "rad/s^2")],
                "a_r: acceleration of the centre of mass; alpha: angular acceleration.",
            ),
            Group::Reaction(index) => self.reaction(run, index),
            Group::Driver { constraint, driver } => {
                let name = &system.constraints[constraint].name;
                match model.drivers[driver].kind {
                    DriverKind::Angle { .. } => self.scalars(name, "angle", ["rad", "rad/s"], ("torque", "N m")),
                    DriverKind::Slide { .. } => self.scalars(name, "slide", ["m", "m/s"], ("force", "N")),
                    DriverKind::Point { .. }
                    | DriverKind::Vector { .. }
                    | DriverKind::Cosine { .. }
                    | DriverKind::CosineToWorld { .. } => self.vectors(
                        name,
                        &[("drive_f", "N"), ("drive_m", "N m")],
                        "drive_f, drive_m: what a driver exerts on body j, or on body i where j is the ground.",
                    ),
                }
                self.scalar(name, "power", "W");
            }
            Group::Angle(angle) => {
                let name = system.angle_joints[angle].clone();
                self.scalar(&name, "angle", "rad");
                self.scalar(&name, "angle_rate", "rad/s");
            }
            Group::Slide(joint) => {
                let name = &model.joints[joint].name;
                self.scalar(name, "slide", "m");
                self.scalar(name, "slide_rate", "m/s");
            }
            Group::Load(load) => self.load(run, load),
            Group::Marker(marker) => {
                let others = [OutputKind::Bodies, OutputKind::Frames, OutputKind::Accelerations];
                let bodies = model.bodies.iter().map(|body| body.name.as_str());
                let name = distinct(run, "marker", &model.markers[marker].name, others, bodies);
                self.vectors(&name, &[("p", "m"), ("v_p", "m/s")], "p: position of a marker; v_p: its velocity.");
            }
            Group::Energy => self.column("energy".to_owned(), "J"),
            Group::Balance => self.balance(),
            Group::Violations => {
                self.column("position_violation".to_owned(), "m");
                self.column("velocity_violation".to_owned(), "m/s");
            }
            Group::Errors { reactions } => self.errors(reactions),
        }
    }

    fn errors(&mut self, reactions: bool) {
        let of_state = [
            ("position", "m"),
            ("turn", "rad"),
            ("velocity", "m/s"),
            ("angular_velocity", "rad/s"),
            ("energy", "J"),
        ];
        let of_reactions = [("force", "N"), ("moment", "N m")];
        for (of, unit) in of_state.into_iter().chain(of_reactions.into_iter().filter(|_| reactions)) {
            self.column(format!("{of}_error"), unit);
        }
        let about = if reactions {
            "position_error to moment_error: estimated errors, each the largest of all bodies or joints; NaN where unknown."
        } else {
            "position_error to energy_error: estimated errors, each the largest of all bodies; NaN where unknown."
        };
        self.convention(about.to_owned());
    }

    fn balance(&mut self) {
        for name in ["kinetic_energy", "potential_energy", "work", "energy_drift"] {
            self.column(name.to_owned(), "J");
        }
    }

    fn column(&mut self, name: String, unit: &'static str) {
        self.columns.push(Column { name, unit });
    }

    fn scalar(&mut self, element: &str, quantity: &str, unit: &'static str) {
        self.column(format!("{element}.{quantity}"), unit);
    }

    /// A quantity, its rate, and what acts along it.
    fn scalars(
        &mut self,
        element: &str,
        quantity: &str,
        [unit, rate]: [&'static str; 2],
        (effort, of_effort): (&str, &'static str),
    ) {
        self.scalar(element, quantity, unit);
        self.scalar(element, &format!("{quantity}_rate"), rate);
        self.scalar(element, effort, of_effort);
    }

    fn vectors(&mut self, element: &str, quantities: &[(&str, &'static str)], convention: &str) {
        for (quantity, unit) in quantities {
            for axis in AXES {
                self.scalar(element, &format!("{quantity}{axis}"), unit);
            }
        }
        self.convention(convention.to_owned());
    }

    fn convention(&mut self, sentence: String) {
        if !self.conventions.contains(&sentence) {
            self.conventions.push(sentence);
        }
    }

    /// What is to be known of the columns together.
    pub(super) fn tell_more(&mut self) {
        if let Some(note) = self.shared_note() {
            self.convention(note.to_owned());
        }
        if self.groups.iter().any(|group| matches!(group, Group::Errors { .. })) {
            self.tell_without_errors();
        }
    }

    /// Which columns the estimated errors say nothing of, or not by their own names.
    fn tell_without_errors(&mut self) {
        let has = |wanted: fn(&Group) -> bool| self.groups.iter().any(wanted);
        let kinds = [
            (has(|group| matches!(group, Group::Load(_))), "what loads do"),
            (has(|group| matches!(group, Group::Acceleration(_))), "accelerations"),
            (has(|group| matches!(group, Group::Driver { .. })), "powers of drivers"),
        ];
        let without: Vec<&str> = kinds.into_iter().filter_map(|(has, kind)| has.then_some(kind)).collect();
        let balance = has(|group| matches!(group, Group::Balance));
        let in_joints = has(|group| matches!(group, Group::Angle(_) | Group::Slide(_)));
        if !without.is_empty() {
            self.convention(format!("No errors are estimated of {}.", listed(&without)));
        }
        if in_joints {
            self.convention(
                "Errors of angles and ways of joints are those of directions and positions of both bodies."
                    .to_owned(),
            );
        }
        if balance {
            self.convention(
                "energy_error is that of the sum of kinetic and potential energy, each of which may be off by more; work is off by about \
                 the energy drift."
                    .to_owned(),
            );
        }
    }

    fn reaction(&mut self, run: &Simulation, index: usize) {
        let (system, model) = (run.system(), run.model());
        let constraint = &system.constraints[index];
        let side = usize::from(constraint.bodies[1] != BodyRef::Ground);
        let name = |body: BodyRef| match body {
            BodyRef::Ground => GROUND,
            BodyRef::Moving(body) => &model.bodies[body].name,
        };
        let (on, by) = (name(constraint.bodies[side]), name(constraint.bodies[1 - side]));
        let joint = &constraint.name;
        let sentence = format!("{joint}: force f and moment m on {on} by {by}, m about the joint's point.");
        self.vectors(joint, &[("f", "N"), ("m", "N m")], &sentence);
    }

    fn load(&mut self, run: &Simulation, load: usize) {
        let load = &run.model().loads[load];
        let others = [OutputKind::Joints, OutputKind::Reactions, OutputKind::Drivers];
        let rows = run.system().constraints.iter().map(|constraint| constraint.name.as_str());
        let name = &distinct(run, "load", &load.name, others, rows);
        match load.kind {
            LoadKind::Force { .. } => self.vectors(name, &[("f", "N")], "f of a load: force in the world."),
            LoadKind::Moment { .. } => {
                self.vectors(name, &[("m", "N m")], "m of a load: moment in the world.");
            }
            LoadKind::Spring { .. } => {
                self.scalars(name, "length", ["m", "m/s"], ("force", "N"));
                self.convention("force of a spring: positive where it pushes its ends apart.".to_owned());
            }
            LoadKind::Torsion { .. } => {
                self.scalars(name, "angle", ["rad", "rad/s"], ("torque", "N m"));
                self.convention("torque of a load: on body j, about the joint's axis.".to_owned());
            }
            LoadKind::Slider { .. } => {
                self.scalars(name, "slide", ["m", "m/s"], ("force", "N"));
                self.convention("force of a load in a joint: on body j, along the joint's axis.".to_owned());
            }
        }
        self.scalar(name, "power", "W");
    }
}

/// Words as in a sentence: the last after "and".
fn listed(words: &[&str]) -> String {
    match words {
        [first @ .., last] if !first.is_empty() => format!("{} and {last}", first.join(", ")),
        _ => words.concat(),
    }
}
