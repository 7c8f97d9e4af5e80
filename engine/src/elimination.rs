//! Accelerations and multipliers by exact elimination of the rigid-body rows — THEORY section 7.
//!
//! The augmented system M q̈ + Φ_qᵀ λ = g, Φ_q q̈ = γ splits body by body: the rigid-body rows leave the twist
//! ξ = (ṙ, ω) free, so that only the rows of joints remain, A ξ̇ = γ', with the 6 × 6 inertia diag(m I, I_g) of each
//! body. Their multipliers come from S λ = …, S = A diag(m I, I_g)⁻¹ Aᵀ, which is block-sparse. This is exact for any
//! directors, orthonormal or not, and for full and reduced bodies alike.

mod factor;
mod increment;
mod right_side;
mod state;

pub use increment::Residual;
pub use state::BodyState;

use crate::angle::AngleState;
use crate::feature::FeatureId;
use crate::lift::Lift;
use crate::load::Forces;
use crate::motion::Jet;
use crate::row::Form;
use crate::system::{Row, System};
use nalgebra::Vector3;
use right_side::gram;
use state::FeatureState;
use triad_linalg::BlockCholesky;
use triad_linalg::block_cholesky::Slot;

/// Regularization of S where rows are redundant, relative to its diagonal.
///
/// Large enough that rounding in a nearly singular S stays harmless through singular positions (with 1e-11 the step
/// control stalls there at tolerances of 1e-12), small enough that two refinements remove its effect elsewhere.
pub const REGULARIZATION: f64 = 1e-9;
/// A relative pivot below this calls for the regularization.
const NEAR_SINGULAR: f64 = 1e-9;
/// Refinement steps where the factor is that of a regularized or lent system.
const REFINEMENTS: usize = 3;

/// Work done so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Counters {
    /// Evaluations of the accelerations.
    pub evaluations: u64,
    /// Factorizations of S.
    pub factorizations: u64,
    /// Back-solves with its factor.
    pub solves: u64,
}

/// A product A_p D⁻¹ A_qᵀ that is added to a block of S.
#[derive(Clone, Copy, Debug)]
struct Contribution {
    slot: Slot,
    left: usize,
    right: usize,
}

/// Everything that changes with the state.
#[derive(Clone, Debug)]
pub struct Elimination {
    /// Bodies at the current state.
    pub bodies: Vec<BodyState>,
    features: Vec<FeatureState>,
    /// Angles at the current state.
    pub angles: Vec<AngleState>,
    angle_axes: Vec<FeatureId>,
    /// Prescribed vectors and numbers at the current time.
    curves: Vec<Jet<Vector3<f64>>>,
    targets: Vec<Jet<f64>>,
    time: f64,
    forces: Forces,
    /// For each row of form `CommonVector`, the two directions across the vector.
    transverse: Vec<[Vector3<f64>; 2]>,
    /// A and A D⁻¹, block by block.
    a: Vec<f64>,
    b: Vec<f64>,
    factor: BlockCholesky,
    contributions: Vec<Contribution>,
    /// γ' of the solver rows.
    gamma: Vec<f64>,
    /// Multipliers of the solver rows.
    lambda: Vec<f64>,
    residual: Vec<f64>,
    /// Whether S is known to be singular (redundant rows): always regularized.
    redundant: bool,
    /// Whether the current factor is that of a regularized S.
    regularized: bool,
    lends: bool,
    /// Work done so far.
    pub counters: Counters,
}

impl Elimination {
    /// Allocates for a system.
    pub fn new(system: &System) -> Self {
        let sizes: Vec<usize> = system.groups.iter().map(|g| g.solver.len()).collect();
        let edges = system.touching.iter().flat_map(|incidences| {
            incidences.iter().enumerate().flat_map(move |(k, &p)| {
                incidences[k + 1..]
                    .iter()
                    .map(move |&q| (system.incidences[p].group, system.incidences[q].group))
            })
        });
        let factor = BlockCholesky::new(&sizes, edges);
        let mut contributions = Vec::new();
        for incidences in &system.touching {
            for (k, &p) in incidences.iter().enumerate() {
                for &q in &incidences[k..] {
                    let slot = factor.slot(system.incidences[p].group, system.incidences[q].group);
                    let (left, right) = if slot.transposed { (q, p) } else { (p, q) };
                    contributions.push(Contribution { slot, left, right });
                }
            }
        }
        let mut features = vec![FeatureState::default(); system.features.len()];
        for (state, feature) in features.iter_mut().zip(&system.features) {
            if feature.is_fixed() {
                state.value = feature.local;
            }
        }
        let rows = system.solver_rows;
        let mut elimination = Self {
            bodies: vec![BodyState::default(); system.bodies.len()],
            forces: Forces::new(system.bodies.len(), &system.features),
            features,
            angles: vec![AngleState::default(); system.angles.len()],
            angle_axes: system.angles.iter().map(|a| a.axis).collect(),
            curves: vec![[Vector3::zeros(); 3]; system.curves.len()],
            targets: vec![[0.0; 3]; system.targets.len()],
            time: 0.0,
            transverse: vec![[Vector3::zeros(); 2]; system.rows.len()],
            a: vec![0.0; system.block_numbers],
            b: vec![0.0; system.block_numbers],
            factor,
            contributions,
            gamma: vec![0.0; rows],
            lambda: vec![0.0; rows],
            residual: vec![0.0; rows],
            redundant: false,
            regularized: false,
            lends: system.lends_inertia(),
            counters: Counters::default(),
        };
        elimination.set_time(system, 0.0);
        elimination
    }

    /// Says that S is singular at every state, so that the regularization is not tried for first.
    pub fn set_redundant(&mut self, redundant: bool) {
        self.redundant = redundant;
    }

    /// Says which solver rows depend on others at every state, so that S is singular there.
    pub fn set_dependent(&mut self, rows: &[usize]) {
        self.redundant = !rows.is_empty();
        self.factor.set_dependent(rows);
    }

    /// How firmly each joint holds at the positions that were factored last: see [`BlockCholesky::holds`].
    pub fn holds(&self) -> &[f64] {
        self.factor.pivot_products()
    }

    /// Whether S is regularized at every state.
    pub fn is_redundant(&self) -> bool {
        self.redundant
    }

    /// Accelerations at (q, q̇): writes q̈, keeps λ. α and β are those of Baumgarte's stabilization, or zero.
    pub fn accelerate(
        &mut self,
        system: &System,
        q: &[f64],
        q_dot: &[f64],
        baumgarte: (f64, f64),
        out: &mut [f64],
    ) {
        self.place(system, q);
        self.set_velocity(system, q_dot);
        self.linearize(system);
        self.set_forces(system);
        let (damping, stiffness) = (2.0 * baumgarte.0, baumgarte.1 * baumgarte.1);
        let correction = move |value: f64, rate: f64| -damping * rate - stiffness * value;
        self.set_particular(system, true, |q, q_dot| {
            gram(|k, l| {
                let value = q.e[k].dot(&q.e[l]) - if k == l { 1.0 } else { 0.0 };
                let rate = q.e[k].dot(&q_dot.e[l]) + q.e[l].dot(&q_dot.e[k]);
                -2.0 * q_dot.e[k].dot(&q_dot.e[l]) + correction(value, rate)
            })
        });
        self.set_gamma(system, true, correction);
        self.solve(system);
        self.counters.evaluations += 1;
        for (index, body) in system.bodies.iter().enumerate() {
            body.layout.store(&self.lifted_solution(index), out);
        }
    }

    /// One mass-orthogonal Newton step of the positions q towards Φ = 0, with the factor at hand. Returns the size
    /// of the step.
    pub fn correct_positions(&mut self, system: &System, q: &mut [f64]) -> f64 {
        self.clear_forces();
        self.set_particular(system, false, |q, _| {
            gram(|k, l| if k == l { 1.0 } else { 0.0 } - q.e[k].dot(&q.e[l]))
        });
        self.set_gamma(system, false, |value, _| -value);
        self.apply_correction(system, q)
    }

    /// One mass-orthogonal Newton step of the velocities q̇ towards Φ̇ = 0, with the factor at hand.
    pub fn correct_velocities(&mut self, system: &System, q_dot: &mut [f64]) -> f64 {
        self.clear_forces();
        self.set_particular(system, false, |q, q_dot| {
            gram(|k, l| -(q.e[k].dot(&q_dot.e[l]) + q.e[l].dot(&q_dot.e[k])))
        });
        self.set_gamma(system, false, |_, rate| -rate);
        self.apply_correction(system, q_dot)
    }

    fn apply_correction(&mut self, system: &System, target: &mut [f64]) -> f64 {
        self.solve(system);
        let mut largest: f64 = 0.0;
        for (index, body) in system.bodies.iter().enumerate() {
            let solution = self.lifted_solution(index);
            body.layout.own_numbers(&solution, |column, dx| {
                target[column] += dx;
                largest = largest.max(dx.abs());
            });
        }
        largest
    }

    /// Solves for ξ̇ and λ with the wrenches and γ' in place.
    fn solve(&mut self, system: &System) {
        for (state, body) in self.bodies.iter_mut().zip(&system.bodies) {
            state.twist = [state.wrench[0] / body.mass, state.inverse * state.wrench[1]];
            state.returned = Vector3::zeros();
        }
        // λ = S⁻¹ (A ξ₀ − γ'), ξ = ξ₀ − D⁻¹ Aᵀ λ.
        self.row_residual(system);
        self.factor.solve(&mut self.residual);
        self.counters.solves += 1;
        self.lambda.copy_from_slice(&self.residual);
        self.apply_multipliers(system);
        if self.regularized || self.lends {
            for _ in 0..REFINEMENTS {
                self.return_lent(system);
                self.row_residual(system);
                self.factor.solve(&mut self.residual);
                self.counters.solves += 1;
                for (lambda, correction) in self.lambda.iter_mut().zip(&self.residual) {
                    *lambda += correction;
                }
                self.apply_multipliers(system);
            }
        }
    }

    /// residual ← A ξ − γ'.
    fn row_residual(&mut self, system: &System) {
        for (residual, gamma) in self.residual.iter_mut().zip(&self.gamma) {
            *residual = -gamma;
        }
        for incidence in &system.incidences {
            let [v, w] = self.bodies[incidence.body].twist;
            let first = system.groups[incidence.group].solver.start;
            let block = &self.a[incidence.offset..incidence.offset + 6 * incidence.rows];
            for (a, residual) in block.chunks_exact(6).zip(&mut self.residual[first..]) {
                *residual +=
                    a[0] * v[0] + a[1] * v[1] + a[2] * v[2] + a[3] * w[0] + a[4] * w[1] + a[5] * w[2];
            }
        }
    }

    /// ξ ← ξ − D⁻¹ Aᵀ (residual as multipliers).
    fn apply_multipliers(&mut self, system: &System) {
        for incidence in &system.incidences {
            let [v, w] = &mut self.bodies[incidence.body].twist;
            let first = system.groups[incidence.group].solver.start;
            let block = &self.b[incidence.offset..incidence.offset + 6 * incidence.rows];
            for (b, lambda) in block.chunks_exact(6).zip(&self.residual[first..]) {
                for c in 0..3 {
                    v[c] -= b[c] * lambda;
                    w[c] -= b[3 + c] * lambda;
                }
            }
        }
    }

    /// One proximal step for bodies whose inertia was lent: D_δ ξ_(k+1) = D_δ ξ_k + δ (ω̇_k − ω̇_(k−1)).
    fn return_lent(&mut self, system: &System) {
        if !self.lends {
            return;
        }
        for (state, body) in self.bodies.iter_mut().zip(&system.bodies) {
            if body.lent > 0.0 {
                let current = state.twist[1];
                state.twist[1] += state.inverse * ((current - state.returned) * body.lent);
                state.returned = current;
            }
        }
    }

    /// Q̈ (or a correction of Q) of a body from the solution.
    pub fn lifted_solution(&self, body: usize) -> Lift {
        let state = &self.bodies[body];
        let e = [0, 1, 2].map(|k| state.particular.e[k] + state.twist[1].cross(&state.q.e[k]));
        Lift { r: state.twist[0], e }
    }

    /// Multipliers of the equations of a joint's row, as written: those of a common vector are μ₁ t₁ + μ₂ t₂.
    pub fn multipliers(&self, index: usize, row: &Row) -> Vec<f64> {
        match row.form {
            Form::Coincidence { .. } => self.lambda[row.solver..row.solver + 3].to_vec(),
            Form::CommonVector { .. } => {
                let [t1, t2] = self.transverse[index];
                let sum = t1 * self.lambda[row.solver] + t2 * self.lambda[row.solver + 1];
                sum.as_slice().to_vec()
            }
            Form::Product { .. } | Form::Relation { .. } => vec![self.lambda[row.solver]],
        }
    }

    /// Takes over multipliers that were found elsewhere, by solver row; positions must be in place.
    pub fn take_multipliers(&mut self, system: &System, multiplier: impl Fn(usize) -> f64) {
        self.fill_blocks(system);
        for (row, lambda) in self.lambda.iter_mut().enumerate() {
            *lambda = multiplier(row);
        }
    }

    /// Rewrites the multipliers of a common vector, given along two other directions across it.
    pub fn turn_multipliers(&mut self, system: &System, index: usize, [t1, t2]: [Vector3<f64>; 2]) {
        let first = system.rows[index].solver;
        let sum = t1 * self.lambda[first] + t2 * self.lambda[first + 1];
        for k in 0..2 {
            self.lambda[first + k] = self.transverse[index][k].dot(&sum);
        }
    }

    /// The rows A_b of an incidence, six numbers each: translation, then rotation.
    pub fn rows_on(&self, system: &System, incidence: usize) -> &[f64] {
        let incidence = &system.incidences[incidence];
        &self.a[incidence.offset..incidence.offset + 6 * incidence.rows]
    }

    /// The rows A_b D_b⁻¹ of an incidence, six numbers each.
    pub fn weighted_rows_on(&self, system: &System, incidence: usize) -> &[f64] {
        let incidence = &system.incidences[incidence];
        &self.b[incidence.offset..incidence.offset + 6 * incidence.rows]
    }

    /// The joints in the order in which S is eliminated.
    pub fn elimination_order(&self) -> Vec<usize> {
        self.factor.order()
    }

    /// Multipliers of the solver rows.
    pub fn solver_multipliers(&self) -> &[f64] {
        &self.lambda
    }

    /// Force and moment about the centre of mass, −A_bᵀ λ, of a joint on a body.
    pub fn wrench_on(&self, system: &System, incidence: usize) -> [Vector3<f64>; 2] {
        let incidence = &system.incidences[incidence];
        let lambda = &self.lambda[system.groups[incidence.group].solver.clone()];
        let mut wrench = [Vector3::zeros(); 2];
        for (a, lambda) in self.a[incidence.offset..].chunks_exact(6).zip(lambda) {
            wrench[0] -= Vector3::new(a[0], a[1], a[2]) * *lambda;
            wrench[1] -= Vector3::new(a[3], a[4], a[5]) * *lambda;
        }
        wrench
    }
}
