//! A mechanism held at one position, with its small motions.

mod damping;

use super::flow::Flow;
use super::momenta::{self, Momenta};
use super::{AnalysisError, MAX_FREEDOMS, Wanted, idle};
use crate::error::EngineError;
use crate::scene::Scene;
use nalgebra::{DMatrix, DVector, Rotation3, RowDVector, Vector3};
use std::ops::AddAssign;
use triad_dynamics::constraints::geometry::Geometry;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::constraints::{rank, start};
use triad_dynamics::dynamics::elimination::{Accelerations, ProjectableState};
use triad_dynamics::model::Model;
use triad_dynamics::newton::{project_positions, rules};
use triad_dynamics::state::{AppliedForces, BodyFrame, State};
use triad_dynamics::system::index::IncidenceId;
use triad_dynamics::system::islands;
use triad_dynamics::system::load::SystemLoad;
use triad_dynamics::system::natural::NaturalCoordinates;

/// Step of differences, in lengths of what they differ: of order four, they are then right to about 1e-13.
const STEP: f64 = 1e-3;
/// Way to a position beside, in lengths of the mechanism.
const BESIDE: f64 = 0.05;
/// Part of the mechanism's length below which a spring has no length.
pub const NO_LENGTH: f64 = 1e-6;

/// A mechanism held at one position.
#[derive(Clone, Debug)]
pub struct Stage {
    /// The mechanism.
    pub mechanism: Mechanism,
    /// Its joints in the measure of lengths.
    geometry: Geometry,
    /// Its coordinates.
    pub q: Vec<f64>,
    /// Its velocities.
    pub q_dot: Vec<f64>,
    /// The time at which drivers and loads are taken, s.
    pub time: f64,
    /// The steady motion in which it is held; rest, unless one is looked for.
    pub flow: Flow,
    /// The momenta of which the steady motion follows at each position, while it is looked for.
    pub momenta: Option<Momenta>,
    /// Step of differences, in lengths of what they differ.
    step: f64,
    /// What was corrected on the way to a consistent start.
    pub notes: Vec<String>,
    /// Whether what is computed of it is still wanted.
    pub wanted: Wanted,
}

impl Stage {
    /// Assembles a scene at its start.
    ///
    /// # Errors
    ///
    /// [`AnalysisError`]: a scene that cannot be or cannot be assembled.
    pub fn new(scene: &Scene) -> Result<Self, AnalysisError> {
        let model = Model::new(scene).map_err(EngineError::from)?;
        Self::from_model(model)
    }

    /// Assembles a model.
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
        let geometry = Geometry::new(&mechanism.system);
        let (flow, momenta, wanted) = (Flow::default(), None, Wanted::default());
        let (time, step) = (0.0, STEP);
        Ok(Self { mechanism, geometry, q: start, q_dot, time, flow, momenta, step, notes, wanted })
    }

    /// Has drivers stay as they are: a position of rest knows nothing of how they go on.
    pub(super) fn hold_drivers(&mut self) {
        let (turns, mut model) = (self.turns(), self.mechanism.system.model.clone());
        model.drivers.iter_mut().for_each(|driver| driver.kind.hold(self.time));
        (self.mechanism, _) = Mechanism::from_model(model);
        self.mechanism.elimination.set_redundant(true);
        self.geometry = Geometry::new(&self.mechanism.system);
        let at = self.q.clone();
        self.put_back(&at, &turns);
    }

    /// That loads depend on the time, if some do: here they are as they are at one moment.
    pub(super) fn varying_loads_note(&self) -> Option<String> {
        let loads = &self.mechanism.system.model.loads;
        let varying: Vec<String> =
            loads.iter().filter(|load| load.changes()).map(|load| load.name.clone()).collect();
        (!varying.is_empty()).then(|| {
            format!(
                "loads that change with time are taken as they are at t = {} s: {}",
                self.time,
                triad_dynamics::constraints::quoted(&varying)
            )
        })
    }

    /// Takes over the held position at rest, or in the steady motion.
    pub fn rest(&mut self) {
        let q = self.q.clone();
        self.q_dot = self.velocities(&q);
        let y = [self.q.as_slice(), self.q_dot.as_slice()].concat();
        self.mechanism.set_state(self.time, &y);
    }

    /// Places of the bodies at positions q.
    pub fn places(&self, q: &[f64]) -> Vec<NaturalCoordinates> {
        self.mechanism.system.bodies.iter().map(|body| body.layout.position(q)).collect()
    }

    /// Velocities q̇ of the steady motion, or zero, at positions q.
    pub fn velocities(&mut self, q: &[f64]) -> Vec<f64> {
        if let Some(momenta) = &self.momenta {
            self.flow = momenta.flow(&self.mechanism.system.bodies, &self.places(q));
        }
        let mut q_dot = vec![0.0; q.len()];
        if !self.flow.is_rest() {
            for (index, body) in self.mechanism.system.bodies.iter().enumerate() {
                body.layout.store(&self.flow.rate(index, &body.layout.position(q)), &mut q_dot);
            }
        }
        q_dot
    }

    /// Twists (v, ω) body by body of the held velocities.
    pub fn twists(&self) -> DVector<f64> {
        let mut out = DVector::zeros(6 * self.mechanism.system.bodies.len());
        for (index, body) in self.mechanism.system.bodies.iter().enumerate() {
            let at = body.layout.position(&self.q);
            let rate = body.layout.velocity(&at, &self.q_dot);
            // ω = ½ Σ e_k × ė_k — eq. (6.4).
            let omega = (0..3).map(|k| at.e[k].cross(&rate.e[k])).sum::<Vector3<f64>>() * 0.5;
            out.fixed_rows_mut::<3>(6 * index).copy_from(&rate.r);
            out.fixed_rows_mut::<3>(6 * index + 3).copy_from(&omega);
        }
        out
    }

    /// A times twists, columns of (v, ω) body by body, at the held position.
    pub fn rows_times(&mut self, twists: &DMatrix<f64>) -> DMatrix<f64> {
        let Mechanism { system, state, elimination, .. } = &mut self.mechanism;
        state.set_positions(system, &self.q);
        elimination.fill_rows(system, state);
        let mut out = DMatrix::zeros(system.solver_rows, twists.ncols());
        for (index, incidence) in system.incidences.iter().enumerate() {
            let first = system[incidence.constraint].solver.start;
            let rows = elimination.jacobian().rows_on(system, IncidenceId(index)).chunks_exact(6);
            for (k, row) in rows.enumerate() {
                let product = RowDVector::from_row_slice(row) * twists.rows(6 * incidence.body, 6);
                out.row_mut(first + k).add_assign(&product);
            }
        }
        out
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

    /// How many independent small motions the joints and drivers allow at the held position.
    pub fn freedoms(&mut self) -> usize {
        let Mechanism { system, state, .. } = &mut self.mechanism;
        state.set_positions(system, &self.q);
        self.geometry.place(state);
        self.geometry.freedoms()
    }

    /// That rows lose their hold at the held position, if some do: more motions seem to be allowed there than are.
    pub fn singular_note(&mut self) -> Option<String> {
        let Mechanism { system, state, .. } = &mut self.mechanism;
        if islands::is_tree(&system.model) {
            return None;
        }
        let rank = rank::analyze_while(system, state, &self.q, &|| self.wanted.is_still());
        self.rest();
        let lost = rank.lost_at_start();
        (lost > 0).then(|| {
            format!(
                "the position is singular: {lost} rows lose their hold there, and branches of motion meet. The linear equations allow all that \
                 these rows let through: some of the modes are motions of no branch"
            )
        })
    }

    /// An orthonormal basis of small motions, lengths of arc measured with the mechanism's length: columns of
    /// (v, ω) body by body.
    ///
    /// # Errors
    ///
    /// [`AnalysisError::TooLarge`]: more of them than dense matrices are good for.
    pub fn tangent(&mut self) -> Result<DMatrix<f64>, AnalysisError> {
        let freedoms = self.freedoms();
        if freedoms > MAX_FREEDOMS {
            return Err(AnalysisError::TooLarge { freedoms, idle: idle::turns(&mut self.mechanism) });
        }
        Ok(self.geometry.twists())
    }

    /// The same without translations of the whole that nothing resists, while a steady motion is looked for: it is the same everywhere
    /// along them.
    ///
    /// # Errors
    ///
    /// As [`Stage::tangent`].
    pub fn displacements(&mut self) -> Result<DMatrix<f64>, AnalysisError> {
        let basis = self.tangent()?;
        Ok(match &self.momenta {
            Some(momenta) => {
                let at = self.places(&self.q);
                let translations = momenta.fields.twists(&at) * &momenta.translations;
                momenta::across(&self.mechanism.system.bodies, &at, translations, basis)
            }
            None => basis,
        })
    }

    /// Resultant force and moment about the centre of mass of all loads, body by body, at the state taken over last.
    pub fn loads(&self) -> DVector<f64> {
        let Mechanism { system, state, .. } = &self.mechanism;
        resultants(state, &AppliedForces::new(system, state))
    }

    /// The same with the forces of inertia of the steady motion.
    pub fn forces(&self) -> DVector<f64> {
        let mut out = self.loads();
        self.for_inertial(
            |_| [Vector3::zeros(); 2],
            |index, wrench| {
                for (c, part) in wrench.iter().flat_map(|part| part.iter()).enumerate() {
                    out[6 * index + c] += part;
                }
            },
        );
        out
    }

    /// The largest of them on a body, N.
    pub fn largest_force(&self) -> f64 {
        self.largest(&self.forces())
    }

    /// The largest of forces and moments, body by body, N: moments over the mechanism's length.
    pub fn largest(&self, wrenches: &DVector<f64>) -> f64 {
        let length = self.mechanism.system.length;
        let along = |(k, x): (usize, &f64)| if k % 6 >= 3 { x.abs() / length } else { x.abs() };
        wrenches.iter().enumerate().map(along).fold(0.0, f64::max)
    }

    /// Calls `take` with the force and moment of inertia on each body, whose velocities in the frame of the steady motion are
    /// given; at rest there are none.
    fn for_inertial(
        &self,
        velocities: impl Fn(usize) -> [Vector3<f64>; 2],
        mut take: impl FnMut(usize, [Vector3<f64>; 2]),
    ) {
        let Mechanism { system, state, .. } = &self.mechanism;
        if self.flow.is_rest() {
            return;
        }
        for (index, (body, at)) in system.bodies.iter().zip(state.bodies()).enumerate() {
            take(index, self.flow.inertial(index, body, &at.q, velocities(index)));
        }
    }

    /// Aᵀ λ − F: what is left to accelerate the bodies, for given multipliers, at the state taken over last.
    pub fn imbalance(&mut self, multipliers: &[f64]) -> DVector<f64> {
        let mut out = -self.forces();
        let Mechanism { system, state, elimination, .. } = &mut self.mechanism;
        elimination.fill_rows(system, state);
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

    /// Takes over positions, at rest or in the steady motion.
    pub fn place(&mut self, q: &[f64]) {
        let q_dot = self.velocities(q);
        let Mechanism { system, state, .. } = &mut self.mechanism;
        state.set(system, self.time, q, &q_dot);
    }

    /// Takes over a position after closing the joints. Returns the violation that is left.
    pub fn assemble(&mut self, q: Vec<f64>) -> f64 {
        let (time, length) = (self.time, self.mechanism.system.length);
        self.q = q;
        let mut on = self.projectable();
        on.state.set_time(on.system, time);
        on.state.set_positions(on.system, on.q);
        project_positions(&mut on, &rules::ASSEMBLY_POSITIONS, length);
        let q = self.q.clone();
        let q_dot = self.velocities(&q);
        let Mechanism { system, state, .. } = &mut self.mechanism;
        state.commit_revolutions();
        state.set_velocities(system, &q_dot);
        state.position_violation(system)
    }

    /// Moves to another position that joints and drivers allow, one that is nothing special; the first stays as it is.
    ///
    /// # Errors
    ///
    /// As [`Stage::tangent`].
    pub fn move_beside(&mut self, position: usize) -> Result<(), AnalysisError> {
        if position > 0 {
            let basis = self.tangent()?;
            let along = DVector::from_fn(basis.ncols(), |k, _| libm::sin((3 * k + position) as f64));
            let size = BESIDE * self.mechanism.system.length / along.norm().max(1.0);
            self.assemble(self.moved(&(basis * along), size));
        }
        Ok(())
    }

    /// Angles of joints at the held position, whole turns among them.
    pub fn turns(&self) -> Vec<f64> {
        self.mechanism.state.angles().iter().map(|angle| angle.value).collect()
    }

    /// Goes back to a position, with the angles of joints that it had.
    pub fn put_back(&mut self, q: &[f64], turns: &[f64]) {
        self.q.copy_from_slice(q);
        self.mechanism.state.set_revolutions(turns.iter().copied());
        self.place(q);
        self.mechanism.state.commit_revolutions();
    }

    /// −∂(generalized force)/∂(motion) along a basis, with multipliers held: the stiffness matrix at rest.
    pub fn stiffness(&mut self, basis: &DMatrix<f64>, multipliers: &[f64]) -> DMatrix<f64> {
        let mut out = DMatrix::zeros(basis.ncols(), basis.ncols());
        for k in 0..basis.ncols() {
            let slope = self.slope(&basis.column(k).into_owned(), |stage| stage.imbalance(multipliers));
            out.set_column(k, &basis.tr_mul(&slope));
        }
        let q = self.q.clone();
        self.place(&q);
        out
    }

    /// The length that differences take small parts of, m: the mechanism's, or twice that of the shortest spring whose pull is no
    /// polynomial in the positions.
    pub fn fineness(&self) -> f64 {
        let Mechanism { system, state, .. } = &self.mechanism;
        let bends = system.loads.iter().filter(|load| match load {
            SystemLoad::Spring { law, .. } => law.drive.is_some() || law.stiffness * law.free != 0.0,
            _ => false,
        });
        let lengths = bends.filter_map(|spring| spring.acting(state)).map(|[length, ..]| 2.0 * length);
        lengths.filter(|length| *length > NO_LENGTH * system.length).fold(system.length, f64::min)
    }

    /// Moves by a small twist, and takes differences by other steps from then on: what changes by that is the error of what is computed.
    pub fn disturb(&mut self, twist: &DVector<f64>) {
        self.step = 0.5 * STEP;
        self.assemble(self.moved(twist, 1.0));
    }

    /// Change of something by a small motion, a twist of each body of any length; the stage is left beside its position.
    pub fn slope(
        &mut self,
        direction: &DVector<f64>,
        of: impl Fn(&mut Self) -> DVector<f64>,
    ) -> DVector<f64> {
        let length = self.mechanism.system.length;
        // The step is one of the motion.
        let reach = (0..direction.len()).fold(0.0f64, |a, i| {
            a.max(if i % 6 >= 3 { length * direction[i].abs() } else { direction[i].abs() })
        });
        let step = self.step * self.fineness() / reach.max(f64::MIN_POSITIVE);
        let mut at = |size: f64| {
            let q = self.moved(direction, size);
            self.place(&q);
            of(self)
        };
        let (near, far) = (at(step) - at(-step), at(2.0 * step) - at(-2.0 * step));
        (near * 8.0 - far) / (12.0 * step)
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

/// Resultant force and moment about the centre of mass, body by body.
fn resultants(state: &State, forces: &AppliedForces) -> DVector<f64> {
    let mut out = DVector::zeros(6 * forces.bodies.len());
    for (index, (at, force)) in state.bodies().iter().zip(&forces.bodies).enumerate() {
        let moment: Vector3<f64> = (0..3).map(|k| at.q.e[k].cross(&force.e[k])).sum();
        out.fixed_rows_mut::<3>(6 * index).copy_from(&force.r);
        out.fixed_rows_mut::<3>(6 * index + 3).copy_from(&moment);
    }
    out
}
