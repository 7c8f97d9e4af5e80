//! Accelerations and multipliers by exact elimination of the rigid-body rows — THEORY section 7.
//!
//! The augmented system M q̈ + Φ_qᵀ λ = g, Φ_q q̈ = γ splits body by body: the rigid-body rows leave the twist
//! ξ = (ṙ, ω) free, so that only the rows of joints remain, A ξ̇ = γ', with the 6 × 6 inertia diag(m I, I_g) of each
//! body. Their multipliers come from S λ = …, S = A diag(m I, I_g)⁻¹ Aᵀ, which is block-sparse. This is exact for any
//! directors, orthonormal or not, and for full and reduced bodies alike.

mod balance;
mod factor;
mod friction;
mod idle;
mod in_plane;
mod increment;
mod part;
mod projectable;
mod right_side;
mod solution;
mod twist_jacobian;

pub use projectable::ProjectableState;
pub use solution::{Accelerations, JointWrench, Multipliers};
pub use twist_jacobian::TwistJacobian;

use crate::dynamics::blocks::{BlockProduct, SchurLayout};
use crate::dynamics::pivots::Pivots;
use crate::dynamics::proximal::{PROXIMAL_STEPS, Proximal};
use crate::model::CustomLoadError;
use crate::state::{AppliedForces, State};
use crate::system::System;
use crate::system::body::RigidBody;
use crate::system::index::{ConstraintId, IncidenceId, SolverRow};
use crate::system::natural::NaturalCoordinates;
use friction::Frictions;
use in_plane::InPlane;
use nalgebra::{Matrix3, Vector3};
use right_side::{gram, stretch, stretching};
use triad_linalg::{BlockCholesky, largest_size};

/// Regularization of S where rows are redundant, relative to its diagonal.
///
/// Large enough that rounding in a nearly singular S stays harmless through singular positions (with 1e-11 the step
/// control stalls there at tolerances of 1e-12), small enough that a few refinements remove its effect elsewhere.
pub const REGULARIZATION: f64 = 1e-9;
/// Steps of iterative refinement where S is regularized.
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

/// What is solved for a body.
#[derive(Clone, Debug, Default)]
pub struct BodySolve {
    /// Particular acceleration Q̈ᵖ that satisfies the rigid-body rows.
    pub particular: NaturalCoordinates,
    /// Generalized applied force G.
    pub force: NaturalCoordinates,
    /// Resultant force and moment (F, T) about the centre of mass, inertial part of Q̈ᵖ included.
    pub wrench: [Vector3<f64>; 2],
    /// Inverse of the inertia used by the factorization.
    pub inverse: Matrix3<f64>,
    /// Solution ξ̇ = (v̇, ω̇).
    pub twist: [Vector3<f64>; 2],
    /// What the joints' part of ω̇ is where ω̇ is zero: two directors turn by their particular accelerations alone, too.
    at_zero: Vector3<f64>,
    /// ω̇ for which the regularizing inertia has been taken out so far.
    returned: Vector3<f64>,
}

/// The linear solve: its matrices at the positions that were linearized last, and its last solution.
#[derive(Clone, Debug)]
#[allow(clippy::struct_excessive_bools)] // each is a fact of its own, in any combination
pub struct Elimination {
    bodies: Vec<BodySolve>,
    /// C Q̈ᵖ of each feature.
    particular: Vec<Vector3<f64>>,
    forces: AppliedForces,
    /// A, and A D⁻¹ block by block.
    jacobian: TwistJacobian,
    b: Vec<f64>,
    factor: BlockCholesky,
    products: Vec<BlockProduct>,
    /// γ' of the solver rows.
    gamma: Vec<f64>,
    /// Multipliers of the solver rows.
    lambda: Vec<f64>,
    residual: Vec<f64>,
    /// Whether S is known to be singular (redundant rows): always regularized.
    redundant: bool,
    /// Whether the current factor is that of a regularized S.
    regularized: bool,
    /// Whether multipliers are found to be shown: those of dependent rows, which move nothing, are then the smallest to the last digit.
    shows: bool,
    /// Whether rows that hardly hold are kept, and dependent ones left out instead of regularized.
    resolving: bool,
    /// Those of the current factor.
    pivots: Pivots,
    regularizes_inertia: bool,
    /// How the effect of that was taken out of the last solution.
    proximal: Proximal,
    /// How many steps of that the bodies ask for that nothing joins to others: they are in no multiplier.
    fewest_steps: usize,
    /// Dry friction, if there is any.
    frictions: Option<Box<Frictions>>,
    /// The solver rows that depend on others at every state.
    dependent: Vec<SolverRow>,
    /// The plane that the motion stays in, if one was looked for and found, and whether the last solution is from there.
    plane: Option<Box<InPlane>>,
    solved_in_plane: bool,
    /// Work done so far.
    pub counters: Counters,
}

impl Elimination {
    /// Allocates for a system.
    pub fn new(system: &System) -> Self {
        let SchurLayout { factor, products } = SchurLayout::new(system);
        let rows = system.solver_rows;
        Self {
            bodies: vec![BodySolve::default(); system.bodies.len()],
            particular: vec![Vector3::zeros(); system.features.len()],
            forces: AppliedForces::none(system),
            jacobian: TwistJacobian::new(system),
            b: vec![0.0; system.block_entries],
            factor,
            products,
            gamma: vec![0.0; rows],
            lambda: vec![0.0; rows],
            residual: vec![0.0; rows],
            redundant: false,
            regularized: false,
            shows: false,
            resolving: false,
            pivots: Pivots::new(system),
            regularizes_inertia: system.regularizes_inertia(),
            proximal: Proximal::begin(0.0, 0),
            fewest_steps: fewest_steps(system),
            frictions: (!system.frictions.is_empty()).then(|| Box::new(Frictions::new(system))),
            dependent: Vec::new(),
            plane: None,
            solved_in_plane: false,
            counters: Counters::default(),
        }
    }

    /// Says that S is singular at every state, so that the regularization is not tried for first.
    pub fn set_redundant(&mut self, redundant: bool) {
        self.redundant = redundant;
    }

    /// Whether from now on rows that hardly hold are kept: near a position where branches of motion almost meet, they alone
    /// decide which one is followed, and regularization would hide them.
    pub fn set_resolving(&mut self, resolving: bool) {
        self.resolving = resolving;
    }

    /// Says which solver rows depend on others at every state, so that S is singular there.
    pub fn set_dependent(&mut self, rows: &[SolverRow]) {
        self.redundant = !rows.is_empty();
        self.dependent = rows.to_vec();
        self.factor.leave_out(rows.iter().map(|row| row.index()));
    }

    /// The pivot products of the joints at the positions that were factored last: see [`BlockCholesky::pivot_products`].
    pub fn pivot_products(&self) -> &[f64] {
        self.factor.pivot_products()
    }

    /// Whether S is regularized at every state.
    pub fn is_redundant(&self) -> bool {
        self.redundant
    }

    /// Accelerations and multipliers at a state. α and β are those of Baumgarte's stabilization, or zero — eq. (10.3).
    pub fn accelerate<'a>(
        &'a mut self,
        system: &'a System,
        state: &'a State,
        baumgarte: (f64, f64),
    ) -> Accelerations<'a> {
        self.linearize(system, state);
        self.accelerate_here(system, state, baumgarte)
    }

    /// The same where the positions were linearized before.
    pub fn accelerate_here<'a>(
        &'a mut self,
        system: &'a System,
        state: &'a State,
        baumgarte: (f64, f64),
    ) -> Accelerations<'a> {
        state.require_velocities();
        self.set_forces(system, state);
        if self.frictions.is_some() {
            self.add_friction(system, state, |own| own.solve_motion(system, state, baumgarte));
        }
        self.solve_motion(system, state, baumgarte);
        self.counters.evaluations += 1;
        self.last_accelerations(system, state)
    }

    /// Solves the equations of motion with the applied forces in place.
    fn solve_motion(&mut self, system: &System, state: &State, baumgarte: (f64, f64)) {
        self.set_right_side(system, state, baumgarte);
        self.solve(system);
    }

    /// Sets wrenches and γ' of the equations of motion, with the applied forces in place.
    fn set_right_side(&mut self, system: &System, state: &State, baumgarte: (f64, f64)) {
        if baumgarte == (0.0, 0.0) {
            // Nothing to measure.
            return self.set_right_side_with(system, state, |_, _| 0.0);
        }
        let (damping, stiffness) = (2.0 * baumgarte.0, baumgarte.1 * baumgarte.1);
        self.set_right_side_with(system, state, |value, rate| -damping * rate - stiffness * value);
    }

    fn set_right_side_with(&mut self, system: &System, state: &State, correction: impl Fn(f64, f64) -> f64) {
        self.set_particular(system, state, true, |q, q_dot| {
            gram(|k, l| {
                let value = q.e[k].dot(&q.e[l]) - if k == l { 1.0 } else { 0.0 };
                let rate = q.e[k].dot(&q_dot.e[l]) + q.e[l].dot(&q_dot.e[k]);
                -2.0 * q_dot.e[k].dot(&q_dot.e[l]) + correction(value, rate)
            })
        });
        self.set_gamma(system, state, true, &correction);
    }

    /// γ' of the solver rows at a state: what A ξ̇ has to be there.
    pub fn needed_accelerations(&mut self, system: &System, state: &State) -> &[f64] {
        self.clear_forces();
        self.linearize(system, state);
        self.set_right_side(system, state, (0.0, 0.0));
        &self.gamma
    }

    /// What [`Elimination::accelerate`] has found last, at the state that it was given.
    pub fn last_accelerations<'a>(&'a self, system: &'a System, state: &'a State) -> Accelerations<'a> {
        Accelerations::new(self.multipliers(system, state), &self.bodies)
    }

    /// The multipliers of the last solution, at the state that it was given.
    fn multipliers<'a>(&'a self, system: &'a System, state: &'a State) -> Multipliers<'a> {
        Multipliers::new(system, state, &self.jacobian, &self.lambda)
    }

    /// One mass-orthogonal Newton step of the positions q towards Φ = 0, with the factor at hand. Returns the size
    /// of the step.
    pub fn correct_positions(&mut self, system: &System, state: &State, q: &mut [f64]) -> f64 {
        self.clear_forces();
        self.set_particular(system, state, false, |q, _| stretch(q));
        self.set_gamma(system, state, false, |value, _| -value);
        self.apply_correction(system, state, q)
    }

    /// One mass-orthogonal Newton step of the velocities q̇ towards Φ̇ = 0, with the factor at hand.
    pub fn correct_velocities(&mut self, system: &System, state: &State, q_dot: &mut [f64]) -> f64 {
        state.require_velocities();
        self.clear_forces();
        self.set_particular(system, state, false, stretching);
        self.set_gamma(system, state, false, |_, rate| -rate);
        self.apply_correction(system, state, q_dot)
    }

    fn apply_correction(&mut self, system: &System, state: &State, target: &mut [f64]) -> f64 {
        self.solve(system);
        let mut largest: f64 = 0.0;
        for (index, body) in system.bodies.iter().enumerate() {
            let solution = self.solution(state, index);
            body.layout.own_numbers(&solution, |column, dx| {
                target[column] += dx;
                largest = largest.max(dx.abs());
            });
        }
        largest
    }

    /// Solves for ξ̇ and λ with the wrenches and γ' in place, refined where S is regularized — eq. (7.7).
    fn solve(&mut self, system: &System) {
        self.set_free_twists(system);
        // λ = S⁻¹ (A ξ₀ − γ'), ξ = ξ₀ − D⁻¹ Aᵀ λ.
        self.row_residual(system);
        self.solve_rows();
        self.lambda.copy_from_slice(&self.residual);
        self.apply_multipliers(system);
        let steps = match (self.regularizes_inertia, self.regularized || self.resolving || self.pivots.small)
        {
            (true, _) => PROXIMAL_STEPS,
            (false, true) => REFINEMENTS,
            (false, false) => 0,
        };
        self.proximal = Proximal::begin(largest_size(&self.residual), self.fewest_steps);
        for _ in 0..steps {
            self.remove_regularization(system);
            self.row_residual(system);
            self.solve_rows();
            for (lambda, correction) in self.lambda.iter_mut().zip(&self.residual) {
                *lambda += correction;
            }
            self.apply_multipliers(system);
            if self.regularizes_inertia && self.proximal.ends(largest_size(&self.residual)) {
                break;
            }
        }
    }

    /// residual ← S⁻¹ residual.
    fn solve_rows(&mut self) {
        self.factor.solve(&mut self.residual);
        self.counters.solves += 1;
        if self.regularized && self.shows {
            self.factor.clean(REGULARIZATION, &mut self.residual);
            self.counters.solves += 1;
        }
    }

    /// ξ ← ξ₀, the accelerations without joints.
    fn set_free_twists(&mut self, system: &System) {
        for (state, body) in self.bodies.iter_mut().zip(&system.bodies) {
            let moment = state.wrench[1] + state.at_zero * body.regularizing_inertia;
            state.twist = [state.wrench[0] / body.mass, state.inverse * moment];
            state.returned = state.at_zero;
        }
    }

    /// residual ← A ξ − γ'.
    fn row_residual(&mut self, system: &System) {
        for (residual, gamma) in self.residual.iter_mut().zip(&self.gamma) {
            *residual = -gamma;
        }
        for incidence in &system.incidences {
            let [v, w] = self.bodies[incidence.body].twist;
            let first = system[incidence.constraint].solver.start;
            let block = &self.jacobian.a[incidence.offset..incidence.offset + 6 * incidence.rows];
            for (a, residual) in block.as_chunks::<6>().0.iter().zip(&mut self.residual[first..]) {
                *residual +=
                    a[0] * v[0] + a[1] * v[1] + a[2] * v[2] + a[3] * w[0] + a[4] * w[1] + a[5] * w[2];
            }
        }
    }

    /// ξ ← ξ − D⁻¹ Aᵀ (residual as multipliers).
    fn apply_multipliers(&mut self, system: &System) {
        for incidence in &system.incidences {
            let [v, w] = &mut self.bodies[incidence.body].twist;
            let first = system[incidence.constraint].solver.start;
            let block = &self.b[incidence.offset..incidence.offset + 6 * incidence.rows];
            for (b, lambda) in block.as_chunks::<6>().0.iter().zip(&self.residual[first..]) {
                for c in 0..3 {
                    v[c] -= b[c] * lambda;
                    w[c] -= b[3 + c] * lambda;
                }
            }
        }
    }

    /// One proximal step for bodies whose inertia is regularized: D_δ ξ_(k+1) = D_δ ξ_k + δ (ω̇_k − ω̇_(k−1)) — eq. (7.8).
    fn remove_regularization(&mut self, system: &System) {
        if !self.regularizes_inertia {
            return;
        }
        for (state, body) in self.bodies.iter_mut().zip(&system.bodies) {
            if body.regularizing_inertia > 0.0 {
                let current = state.twist[1];
                state.twist[1] += state.inverse * ((current - state.returned) * body.regularizing_inertia);
                state.returned = current;
            }
        }
    }

    /// Q̈ = Q̈ᵖ + N ξ̇ (or a correction of Q) of a body from the last solution, which belongs to this state — eq. (7.2).
    pub fn solution(&self, state: &State, body: usize) -> NaturalCoordinates {
        natural_acceleration(&self.bodies[body], &state.bodies()[body].q)
    }

    /// What was solved for each body.
    pub fn bodies(&self) -> &[BodySolve] {
        &self.bodies
    }

    /// Why a load that a program gives could not act at the last state where one could not.
    pub fn load_failure(&self) -> Option<&CustomLoadError> {
        self.forces.failure()
    }

    /// A at the positions that were linearized last.
    pub fn jacobian(&self) -> &TwistJacobian {
        &self.jacobian
    }

    /// The rows A_b D_b⁻¹ of an incidence, six numbers each.
    pub fn weighted_rows_on(&self, system: &System, incidence: IncidenceId) -> &[f64] {
        let incidence = &system[incidence];
        &self.b[incidence.offset..incidence.offset + 6 * incidence.rows]
    }

    /// The joints in the order in which S is eliminated.
    pub fn elimination_order(&self) -> Vec<ConstraintId> {
        self.factor.order().into_iter().map(ConstraintId).collect()
    }
}

/// See [`Elimination::fewest_steps`].
fn fewest_steps(system: &System) -> usize {
    let joined = |body: usize| system.incidences.iter().any(|incidence| incidence.body == body);
    let steps = |(index, body): (usize, &RigidBody)| {
        let delta = body.regularizing_inertia;
        let own = body.principal.iter().copied().filter(|own| *own > delta).fold(f64::INFINITY, f64::min);
        if delta == 0.0 || own.is_infinite() || joined(index) {
            0
        } else {
            Proximal::steps_for(delta / (delta + own))
        }
    };
    system.bodies.iter().enumerate().map(steps).max().unwrap_or(0)
}

/// Q̈ = Q̈ᵖ + (v̇, ω̇ × e_k) of a body at position q.
fn natural_acceleration(body: &BodySolve, q: &NaturalCoordinates) -> NaturalCoordinates {
    let e = [0, 1, 2].map(|k| body.particular.e[k] + body.twist[1].cross(&q.e[k]));
    NaturalCoordinates { r: body.twist[0], e }
}
