//! A mechanism held at one position, with its small motions.

use super::{AnalysisError, MAX_BODIES};
use crate::error::EngineError;
use crate::scene::Scene;
use nalgebra::{DMatrix, DVector, Rotation3, Vector3};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::constraints::{start, tangent};
use triad_dynamics::dynamics::elimination::{Accelerations, ProjectableState};
use triad_dynamics::model::Model;
use triad_dynamics::newton::{project_positions, rules};
use triad_dynamics::state::{AppliedForces, BodyFrame};
use triad_dynamics::system::index::IncidenceId;
use triad_dynamics::system::natural::NaturalCoordinates;

/// A mechanism held at one position.
#[derive(Clone, Debug)]
pub struct Stage {
    /// The mechanism.
    pub mechanism: Mechanism,
    /// Its coordinates.
    pub q: Vec<f64>,
    /// Its velocities.
    pub q_dot: Vec<f64>,
    /// The time at which drivers and loads are taken, s.
    pub time: f64,
    /// What was corrected on the way to a consistent start.
    pub notes: Vec<String>,
}

impl Stage {
    /// Assembles a scene at its start.
    ///
    /// # Errors
    ///
    /// [`AnalysisError`]: a scene that cannot be or cannot be assembled, or one too large for dense matrices.
    pub fn new(scene: &Scene) -> Result<Self, AnalysisError> {
        let model = Model::new(scene).map_err(EngineError::from)?;
        if model.bodies.len() > MAX_BODIES {
            return Err(AnalysisError::TooLarge { bodies: model.bodies.len() });
        }
        Self::from_model(model)
    }

    /// Assembles a model of any size, for what needs no dense matrices.
    ///
    /// # Errors
    ///
    /// [`AnalysisError`]: a scene that cannot be assembled.
    pub(super) fn from_model(model: Model) -> Result<Self, AnalysisError> {
        let (mut mechanism, mut start) = start::mechanism(model);
        let mut notes = mechanism.system.model.notes.clone();
        notes.extend(mechanism.assemble(&mut start)?);
        mechanism.elimination.set_redundant(true);
        let q_dot = start.split_off(mechanism.system.coordinates);
        Ok(Self { mechanism, q: start, q_dot, time: 0.0, notes })
    }

    /// Takes over the held position at rest.
    pub fn rest(&mut self) {
        self.q_dot.fill(0.0);
        let y = [self.q.as_slice(), self.q_dot.as_slice()].concat();
        self.mechanism.set_state(self.time, &y);
    }

    /// The held state, to be moved onto the constraints.
    pub fn projectable(&mut self) -> ProjectableState<'_> {
        let Self { mechanism: Mechanism { system, state, elimination, .. }, q, q_dot, .. } = self;
        ProjectableState { system, state, elimination, q, q_dot }
    }

    /// Evaluates accelerations and multipliers at the held state.
    pub fn accelerate(&mut self) -> Accelerations<'_> {
        let Mechanism { system, state, elimination, .. } = &mut self.mechanism;
        state.set(system, self.time, &self.q, &self.q_dot);
        elimination.accelerate(system, state, (0.0, 0.0))
    }

    /// An orthonormal basis of small motions, lengths of arc measured with the mechanism's length: columns of
    /// (v, ω) body by body.
    pub fn tangent(&mut self) -> DMatrix<f64> {
        let Mechanism { system, state, elimination, .. } = &mut self.mechanism;
        state.set_positions(system, &self.q);
        tangent::twists(system, state, elimination)
    }

    /// Resultant force and moment about the centre of mass of all loads, body by body, at the state taken over last.
    pub fn forces(&self) -> DVector<f64> {
        let Mechanism { system, state, .. } = &self.mechanism;
        let forces = AppliedForces::new(system, state).bodies;
        let mut out = DVector::zeros(6 * system.bodies.len());
        for (index, (at, force)) in state.bodies().iter().zip(&forces).enumerate() {
            let moment: Vector3<f64> = (0..3).map(|k| at.q.e[k].cross(&force.e[k])).sum();
            out.fixed_rows_mut::<3>(6 * index).copy_from(&force.r);
            out.fixed_rows_mut::<3>(6 * index + 3).copy_from(&moment);
        }
        out
    }

    /// Aᵀ λ − F: what is left to accelerate the bodies, for given multipliers, at the state taken over last.
    pub fn imbalance(&mut self, multipliers: &[f64]) -> DVector<f64> {
        let mut out = -self.forces();
        let Mechanism { system, state, elimination, .. } = &mut self.mechanism;
        elimination.linearize(system, state);
        for (index, incidence) in system.incidences.iter().enumerate() {
            let first = system[incidence.constraint].solver.start;
            let rows = elimination.jacobian().rows_on(system, IncidenceId(index)).chunks_exact(6);
            for (row, lambda) in rows.zip(&multipliers[first..]) {
                for c in 0..6 {
                    out[6 * incidence.body + c] += row[c] * lambda;
                }
            }
        }
        out
    }

    /// The held position moved by `size` along a twist of each body; bodies stay rigid, joints may open a little.
    pub fn moved(&self, twist: &DVector<f64>, size: f64) -> Vec<f64> {
        let mut q = self.q.clone();
        for (index, body) in self.mechanism.system.bodies.iter().enumerate() {
            let at = body.layout.position(&self.q);
            let part = |k: usize| Vector3::new(twist[k], twist[k + 1], twist[k + 2]) * size;
            let turn = Rotation3::from_scaled_axis(part(6 * index + 3));
            let there = NaturalCoordinates { r: at.r + part(6 * index), e: at.e.map(|e| turn * e) };
            body.layout.store(&there, &mut q);
        }
        q
    }

    /// Generalized velocities of a twist of each body at the held position.
    pub fn velocity(&self, twist: &DVector<f64>) -> Vec<f64> {
        let mut q_dot = vec![0.0; self.q.len()];
        for (index, body) in self.mechanism.system.bodies.iter().enumerate() {
            let at = body.layout.position(&self.q);
            let part = |k: usize| Vector3::new(twist[k], twist[k + 1], twist[k + 2]);
            let omega = part(6 * index + 3);
            let rate = NaturalCoordinates { r: part(6 * index), e: at.e.map(|e| omega.cross(&e)) };
            body.layout.store(&rate, &mut q_dot);
        }
        q_dot
    }

    /// Takes over positions, at rest.
    pub fn place(&mut self, q: &[f64]) {
        let Mechanism { system, state, .. } = &mut self.mechanism;
        state.set(system, self.time, q, &vec![0.0; q.len()]);
    }

    /// Takes over a position after closing the joints. Returns the violation that is left.
    pub fn assemble(&mut self, q: Vec<f64>) -> f64 {
        let (time, length) = (self.time, self.mechanism.system.length);
        self.q = q;
        let mut on = self.projectable();
        on.state.set_time(on.system, time);
        on.state.set_positions(on.system, on.q);
        project_positions(&mut on, &rules::ASSEMBLY_POSITIONS, length);
        let Mechanism { system, state, .. } = &mut self.mechanism;
        state.commit_revolutions();
        state.set_velocities(system, &vec![0.0; self.q.len()]);
        state.position_violation(system)
    }

    /// −∂(generalized force)/∂(motion) along a basis, with multipliers held: the stiffness matrix at rest.
    pub fn stiffness(&mut self, basis: &DMatrix<f64>, multipliers: &[f64]) -> DMatrix<f64> {
        let step = 1e-5 * self.mechanism.system.length;
        let mut out = DMatrix::zeros(basis.ncols(), basis.ncols());
        for k in 0..basis.ncols() {
            let direction = basis.column(k).into_owned();
            let [ahead, behind] = [step, -step].map(|size| {
                let q = self.moved(&direction, size);
                self.place(&q);
                self.imbalance(multipliers)
            });
            out.set_column(k, &(basis.tr_mul(&(ahead - behind)) / (2.0 * step)));
        }
        let q = self.q.clone();
        self.place(&q);
        out
    }

    /// Bodies at the held position.
    pub fn frames(&self) -> Vec<BodyFrame> {
        let bodies = self.mechanism.system.bodies.iter().map(|body| {
            let at = body.layout.position(&self.q);
            let rate = body.layout.velocity(&at, &self.q_dot);
            BodyFrame::new(&at, &rate)
        });
        bodies.collect()
    }

    /// Name of the body on which the largest part of a vector of twists or wrenches lies.
    pub fn foremost(&self, vector: &DVector<f64>) -> String {
        let size = |body: usize| vector.rows(6 * body, 6).amax();
        let bodies = &self.mechanism.system.model.bodies;
        (0..bodies.len())
            .max_by(|a, b| size(*a).total_cmp(&size(*b)))
            .map_or_else(String::new, |body| bodies[body].name.clone())
    }
}
