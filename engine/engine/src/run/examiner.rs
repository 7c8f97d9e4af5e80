//! Solvers for states that are looked at, and not gone on from.

use std::sync::OnceLock;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::dynamics::elimination::Elimination;
use triad_dynamics::system::planar;

/// What such solvers know of a run: the plane that it starts in.
///
/// It is found when the first solver is asked for, but always at the start: what is computed of a state does not depend on which
/// others were looked at, nor by which thread.
#[derive(Clone, Debug, Default)]
pub(super) struct Examiner {
    /// One that knows the plane; none where there is no plane that helps.
    in_plane: OnceLock<Option<Box<Elimination>>>,
}

impl Examiner {
    /// A solver for the states of a run that starts at (q, q̇).
    pub fn solver(&self, mechanism: &Mechanism, start: &[f64]) -> Elimination {
        let mut solver = mechanism.elimination.clone();
        let in_plane = self.in_plane.get_or_init(|| find(mechanism, start).map(Box::new));
        if let Some(in_plane) = in_plane {
            solver.stay_in_plane_of(in_plane);
        }
        solver
    }
}

fn find(mechanism: &Mechanism, start: &[f64]) -> Option<Elimination> {
    let Mechanism { system, state, elimination, .. } = mechanism;
    if !system.model.settings.skip.planar {
        return None;
    }
    let (q, q_dot) = start.split_at(system.coordinates);
    let plane = planar::recognize(system, q).ok()?;
    let (mut state, mut solver) = (state.clone(), elimination.clone());
    state.set(system, 0.0, q, q_dot);
    solver.find_plane(system, &state, &plane, mechanism.baumgarte()).then_some(solver)
}
