//! The equations as misconceptions have them, so that these can be recognised in what a student's program sends.

use triad_engine::EngineError;
use triad_engine::constraints::mechanism::Mechanism;
use triad_engine::equations::augmented::AugmentedSystem;
use triad_engine::model::Model;
use triad_engine::scene::Scene;
use triad_engine::system::System;

use super::grid::Grid;
use super::instances::{InstanceError, Instances};
use super::wrong_parts::table;
use crate::exercise::Implement;
use crate::files::EquationPart;
use crate::scenario::equations::in_degrees;

/// What a misconception makes of a part, at every instance.
pub(crate) struct ProgramMisconception {
    pub id: &'static str,
    pub feedback: &'static str,
    pub grids: Vec<Grid>,
}

/// The misconception, if what was sent is one of these.
pub(crate) fn recognise<'a>(
    given: &[Grid],
    right: &[Grid],
    known: &'a [ProgramMisconception],
    tolerance: f64,
) -> Option<&'a ProgramMisconception> {
    known.iter().find(|one| all_agree(given, &one.grids, right, tolerance))
}

/// Whether two answers agree at every instance, on the scale of the right one.
pub(crate) fn all_agree(given: &[Grid], wanted: &[Grid], right: &[Grid], tolerance: f64) -> bool {
    given.iter().zip(wanted).zip(right).all(|((a, b), r)| a.agrees(b, tolerance, r.scale()))
}

/// What one misconception makes of the equations at one instance.
type Make<'a> = &'a dyn Fn(&Mechanism, &AugmentedSystem) -> Result<Grid, InstanceError>;

/// Every misconception of a part that differs from the right answer on this mechanism.
pub(crate) fn misconceptions(
    task: &Implement,
    instances: &mut Instances,
    part: EquationPart,
) -> Result<Vec<ProgramMisconception>, InstanceError> {
    let right = instances.answers(part)?;
    let mut list: Vec<ProgramMisconception> = Vec::new();
    let add = |id, feedback, grids: Vec<Grid>, list: &mut Vec<ProgramMisconception>| {
        let same = |a: &[Grid], b: &[Grid]| {
            a.iter().zip(b).all(|(a, b)| a.agrees(b, 10.0 * task.tolerance, b.scale()))
        };
        if !same(&grids, &right) && !list.iter().any(|other| same(&grids, &other.grids)) {
            list.push(ProgramMisconception { id, feedback, grids });
        }
    };
    let each = |instances: &mut Instances, make: Make| -> Result<Vec<Grid>, InstanceError> {
        (0..instances.states.len())
            .map(|k| {
                let (mechanism, augmented) = instances.placed(k);
                make(mechanism, augmented)
            })
            .collect()
    };
    for (id, feedback, make) in table(part) {
        add(id, feedback, each(instances, &make)?, &mut list);
    }
    for (id, feedback, scene) in other_scenes(task, part) {
        // The wrong mechanism need not close at its start: it is only put into the instances.
        let model = Model::new(&scene).map_err(EngineError::from)?;
        let other = Instances::at_states(Mechanism::new(System::new(model)), instances.states.clone());
        add(id, feedback, other.answers(part)?, &mut list);
    }
    Ok(list)
}

/// The same states in a mechanism that was read wrongly.
fn other_scenes(task: &Implement, part: EquationPart) -> Vec<(&'static str, &'static str, Scene)> {
    let scene = &task.scene;
    let mut list = Vec::new();
    if part == EquationPart::Acceleration && scene.gravity != [0.0; 3] {
        let scene = Scene { gravity: [0.0; 3], ..scene.clone() };
        list.push(("no-gravity", "The weight is missing in the forces g.", scene));
        let up = Scene { gravity: task.scene.gravity.map(|g| -g), ..task.scene.clone() };
        list.push(("gravity-up", "The weight acts upwards in the forces g.", up));
        let size = task.scene.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
        let mass = Scene { gravity: task.scene.gravity.map(|g| g / size), ..task.scene.clone() };
        list.push(("mass-for-weight", "A mass stands in the forces where its weight belongs.", mass));
    }
    if !scene.drivers.is_empty()
        && matches!(part, EquationPart::Phi | EquationPart::Gamma | EquationPart::Acceleration)
    {
        let feedback = "An angle was taken for degrees: sine and cosine want radians.";
        list.push(("degrees", feedback, in_degrees(scene)));
    }
    list
}
