//! Inverse dynamics: the multipliers that go with accelerations that are known — eq. (6.6).

use crate::analysis::Stage;
use crate::error::EngineError;
use crate::scene::Scene;
use nalgebra::Vector3;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::dynamics::elimination::Multipliers;
use triad_dynamics::model::Model;
use triad_dynamics::state::{AppliedForces, Residual, State};
use triad_dynamics::system::System;
use triad_dynamics::system::natural::NaturalCoordinates;

/// The scene with its masses and loads.
#[derive(Debug)]
pub(super) struct Masses {
    system: System,
    state: State,
    /// P = G − M Q̈ of each body: what joints and drivers have to hold.
    left: Vec<NaturalCoordinates>,
}

impl Masses {
    pub(super) fn new(scene: &Scene) -> Result<Self, EngineError> {
        let system = System::new(Model::new(scene)?);
        let state = State::new(&system);
        Ok(Self { system, state, left: Vec::new() })
    }

    /// That friction is left out which follows from the reactions that are looked for, if there is any.
    pub(super) fn without_friction(&self) -> Option<String> {
        let note =
            "friction with a coefficient is left out of the forces; a run of the driven mechanism has it";
        (!self.system.frictions.is_empty()).then(|| note.to_owned())
    }

    /// Takes loads and inertia at the state that is held.
    pub(super) fn take(&mut self, stage: &Stage, accelerations: &[NaturalCoordinates]) {
        let Self { system, state, left } = self;
        state.copy_revolutions(&stage.mechanism.state);
        state.set(system, stage.time, &stage.q, &stage.q_dot);
        *left = AppliedForces::new(system, state).bodies;
        for ((left, body), second) in left.iter_mut().zip(&system.bodies).zip(accelerations) {
            left.r -= second.r * body.mass;
            for k in 0..3 {
                left.e[k] -= second.e[k] * body.ibar[k];
            }
        }
    }

    /// Force and moment about the centre of mass that a body is left with.
    pub(super) fn on(&self, body: usize) -> [Vector3<f64>; 2] {
        let (left, at) = (&self.left[body], &self.state.bodies()[body].q);
        [left.r, (0..3).map(|k| at.e[k].cross(&left.e[k])).sum()]
    }

    /// Φ_qᵀ λ = P. The masses of the stage are of no account where the rows leave no freedom.
    pub(super) fn multipliers<'a>(&self, stage: &'a mut Stage) -> Multipliers<'a> {
        let Mechanism { system, state, elimination, .. } = &mut stage.mechanism;
        let closed = vec![Residual::zeros(); system.rows.len()];
        elimination.increment(system, state, &self.left, state, false, &closed);
        elimination.last_accelerations(system, state).multipliers
    }
}
