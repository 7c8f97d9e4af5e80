//! Springs whose two ends coincide: the direction of their force is what rounding makes it.

use crate::analysis::stage::NO_LENGTH;
use crate::analysis::{AnalysisError, Stage};
use triad_dynamics::model::ForceLaw;
use triad_dynamics::system::load::SystemLoad;

/// Positions beside that tell whether the ends stay together.
const POSITIONS: usize = 3;

/// Takes the laws of springs whose ends joints and drivers keep together: no motion does work on them.
pub fn leave_out_held(stage: &mut Stage) -> Result<(), AnalysisError> {
    let q = stage.q.clone();
    stage.mechanism.state.set_positions(&stage.mechanism.system, &q);
    let mut held = without_length(stage);
    if held.is_empty() {
        return Ok(());
    }
    let (turns, q_dot) = (stage.turns(), stage.q_dot.clone());
    for position in 1..=POSITIONS {
        stage.move_beside(position)?;
        let there = without_length(stage);
        held.retain(|load| there.contains(load));
        stage.put_back(&q, &turns);
    }
    stage.q_dot = q_dot;
    for load in held {
        if let Some(law) = law(stage, load) {
            *law = ForceLaw { stiffness: 0.0, free: 0.0, damping: 0.0, drive: None, friction: None };
        }
    }
    Ok(())
}

/// Takes the laws of springs that have no length at the held position and are not linear there, and tells them.
pub fn leave_out_jumping(stage: &mut Stage, notes: &mut Vec<String>) {
    for load in without_length(stage) {
        let name = stage.mechanism.system.model.loads[load].name.clone();
        let Some(law) = law(stage, load) else { continue };
        if law.stiffness * law.free != 0.0 || law.drive.is_some() {
            law.stiffness = 0.0;
            law.drive = None;
            notes.push(format!(
                "spring \"{name}\" has no length at this position and a force all the same, whose direction jumps there: it has no \
                 linear law and is left out; modes about a position where its ends are apart have it"
            ));
        } else if law.damping != 0.0 || law.friction.is_some() {
            notes.push(format!(
                "the damping of spring \"{name}\" is left out: the spring has no length at this position, and so no direction"
            ));
        }
        law.damping = 0.0;
        law.friction = None;
    }
}

/// Springs that have no length at the state taken over last.
fn without_length(stage: &Stage) -> Vec<usize> {
    let (system, state) = (&stage.mechanism.system, &stage.mechanism.state);
    let none = |load: &SystemLoad| match load {
        SystemLoad::Spring { .. } => {
            load.acting(state).is_none_or(|[length, ..]| length <= NO_LENGTH * system.length)
        }
        _ => false,
    };
    (0..system.loads.len()).filter(|&load| none(&system.loads[load])).collect()
}

fn law(stage: &mut Stage, load: usize) -> Option<&mut ForceLaw> {
    match &mut stage.mechanism.system.loads[load] {
        SystemLoad::Spring { law, .. } => Some(law),
        _ => None,
    }
}
