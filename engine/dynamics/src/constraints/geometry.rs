//! The rows of the joints in a measure of lengths — eq. (8.2).
//!
//! Whether rows depend on each other is a matter of geometry. Measured by masses, a rod without inertia about its own axis
//! turns so easily that rounding along this turn hides what the other rows say. Here each body has the mass one, and the arm
//! of its joints as radius of gyration about every axis. All that counts rows, freedoms or redundancies asks here.

use crate::constraints::violation;
use crate::dynamics::elimination::{Elimination, ProjectableState};
use crate::newton::{DEPENDENT, move_away, project_positions, rules};
use crate::state::State;
use crate::system::System;
use crate::system::index::{ConstraintId, IncidenceId, SolverRow};
use nalgebra::DMatrix;
use triad_linalg::random::Random;
use triad_linalg::{independent_rows_while, left_null_space};

/// Relative pivot below which rounding could hide that later rows depend on others: it leaves ε over this pivot in theirs. Then the
/// decision is taken anew with pivots in the order of their size.
const UNCLEAR: f64 = 1e-5;
/// Part of a motion by which rows may open that depend on others: rounding.
const EXACT: f64 = 1e-11;
/// Rounds of projecting and orthonormalizing: the first leaves the rounding of columns that were nearly parallel, the second
/// nothing.
const ROUNDS: usize = 2;
/// Projections in a row: each takes away what the one before left beside a position that is nearly singular, where it is up to
/// ε / [`DEPENDENT`].
const PROJECTIONS: usize = 2;
/// Where the columns begin that are projected.
const SEED: u64 = 14;

/// What the pivots say.
#[derive(Clone, Debug, PartialEq)]
pub struct Rank {
    /// Rank of the joint rows that the solver keeps.
    pub rank: usize,
    /// The solver rows that depend on others exactly at the start: more than there are elsewhere where that is a singular position.
    pub dependent_at_start: Vec<SolverRow>,
    /// The solver rows that depend on others.
    pub dependent: Vec<SolverRow>,
    /// The joint that opens most where it holds what others hold but not exactly, and by what part of the motion that they leave free.
    pub inexact: Option<(ConstraintId, f64)>,
}

impl Rank {
    /// How many rows lose their hold at the start, a singular position if some do.
    pub fn lost_at_start(&self) -> usize {
        self.dependent_at_start.len().saturating_sub(self.dependent.len())
    }
}

/// A system measured in lengths, with its rows at one position.
#[derive(Clone, Debug)]
pub struct Geometry {
    system: System,
    elimination: Elimination,
    dependent: Vec<SolverRow>,
    /// The rows, of length one, where the factorization leaves the decision unclear.
    unclear: Option<DMatrix<f64>>,
}

impl Geometry {
    /// Of a system; its rows are taken by [`Geometry::place`].
    pub fn new(system: &System) -> Self {
        let system = system.in_lengths();
        let mut elimination = Elimination::new(&system);
        elimination.set_redundant(true);
        Self { system, elimination, dependent: Vec::new(), unclear: None }
    }

    /// Takes the rows at the positions of a state.
    pub fn place(&mut self, state: &State) {
        self.place_while(state, &|| true);
    }

    /// As [`Geometry::place`], as long as that is wanted.
    fn place_while(&mut self, state: &State, wanted: &dyn Fn() -> bool) {
        if !wanted() {
            return;
        }
        let Self { system, elimination, .. } = self;
        self.unclear = None;
        self.dependent = elimination.dependent_rows(system, state, DEPENDENT);
        if elimination.least_pivot(DEPENDENT) < UNCLEAR {
            let rows = unit_rows(system, elimination);
            let kept = independent_rows_while(&rows, DEPENDENT.sqrt(), wanted);
            let depends = |row: &SolverRow| kept.binary_search(&row.index()).is_err();
            self.dependent = (0..system.solver_rows).map(SolverRow).filter(depends).collect();
            elimination.factor_without(system, &self.dependent);
            self.unclear = Some(rows);
        }
    }

    /// The solver rows that depend on others at the position — eq. (8.1).
    pub fn dependent(&self) -> &[SolverRow] {
        &self.dependent
    }

    /// How many independent motions the joints allow at the position.
    pub fn freedoms(&self) -> usize {
        6 * self.system.bodies.len() + self.dependent.len() - self.system.solver_rows
    }

    /// The rank near the consistent position q, and at it, as long as that is wanted; the state is left elsewhere.
    pub fn analyze(&mut self, state: &mut State, q: &[f64], wanted: &dyn Fn() -> bool) -> Rank {
        state.set_positions(&self.system, q);
        self.place_while(state, wanted);
        let dependent_at_start = self.dependent.clone();
        // Rows that are independent somewhere are so nearly everywhere.
        if !dependent_at_start.is_empty() && wanted() {
            self.look_beside(state, q, wanted);
            self.look_where_drivers_lead(state, q, wanted);
        }
        let (rows, inexact) = (self.system.solver_rows, if wanted() { self.inexact() } else { None });
        Rank {
            rank: rows - self.dependent.len(),
            dependent_at_start,
            dependent: self.dependent.clone(),
            inexact,
        }
    }

    /// Takes the rows a little away from the positions q of a state, along a motion that joints and drivers allow at its time.
    fn look_beside(&mut self, state: &mut State, q: &[f64], wanted: &dyn Fn() -> bool) {
        let Self { system, elimination, .. } = self;
        let (mut q, mut q_dot) = (q.to_vec(), vec![0.0; q.len()]);
        let length = system.length;
        let mut on = ProjectableState { system, state, elimination, q: &mut q, q_dot: &mut q_dot };
        move_away(&mut on, length);
        self.place_while(state, wanted);
    }

    /// The same from where drivers have led the mechanism, if fewer rows depend on others there: what they hold fast at one moment may be
    /// singular at that moment alone.
    fn look_where_drivers_lead(&mut self, state: &mut State, q: &[f64], wanted: &dyn Fn() -> bool) {
        let time = state.time();
        if self.dependent.is_empty() {
            return;
        }
        let Some(later) = self.system.driven_away(time) else { return };
        let mut there = self.clone();
        let Self { system, elimination, .. } = &mut there;
        let (mut q, mut q_dot) = (q.to_vec(), vec![0.0; q.len()]);
        state.set_time(system, later);
        state.set_positions(system, &q);
        let (start, length) = (q.clone(), system.length);
        let mut on = ProjectableState { system, state, elimination, q: &mut q, q_dot: &mut q_dot };
        let found = project_positions(&mut on, &rules::ASSEMBLY_POSITIONS, length);
        if !(found.has_converged() && violation::is_closed(system, on.state)) {
            // From a dead point Newton's method does not know whither: any way aside is one.
            on.q.copy_from_slice(&start);
            on.state.set_positions(system, on.q);
            on.elimination.linearize(system, on.state);
            move_away(&mut on, length);
        }
        if violation::is_closed(system, state) {
            there.place_while(state, wanted);
            there.look_beside(state, &q, wanted);
            if there.dependent.len() < self.dependent.len() {
                *self = there;
            }
        }
        state.set_time(&self.system, time);
    }

    /// The dependent row that opens most in a motion that the others allow, if that is more than rounding.
    fn inexact(&mut self) -> Option<(ConstraintId, f64)> {
        if self.dependent.is_empty() || self.freedoms() == 0 {
            return None;
        }
        let Self { system, elimination, dependent, .. } = self;
        let (mut random, length, sizes) = (Random::new(SEED), system.length, system.row_sizes());
        let unit = |k: usize| if k % 6 < 3 { length } else { 1.0 };
        let mut motion: Vec<f64> =
            (0..6 * system.bodies.len()).map(|k| unit(k) * random.between(-1.0, 1.0)).collect();
        let mut worst = None;
        // One projection is enough where rows are far from depending on others.
        for _ in 0..=PROJECTIONS {
            elimination.allow(system, &mut motion);
            let moved = motion.iter().enumerate().fold(0.0f64, |most, (k, x)| most.max(x.abs() / unit(k)));
            let rates = elimination.row_rates(system, &motion);
            let part = |row: &SolverRow| (*row, rates[row.index()].abs() / (sizes[row.index()] * moved));
            worst = dependent
                .iter()
                .map(part)
                .max_by(|a, b| a.1.total_cmp(&b.1))
                .filter(|(_, part)| *part > EXACT);
            worst?;
        }
        let (row, part) = worst?;
        let joint = system.constraints.iter().position(|own| own.solver.contains(&row.index()))?;
        Some((ConstraintId(joint), part))
    }

    /// An orthonormal basis of the twists that the joints allow at the position — eq. (10.11), lengths of arc measured with the
    /// mechanism's length: columns of (v, ω) body by body.
    pub fn twists(&mut self) -> DMatrix<f64> {
        let Self { system, elimination, .. } = self;
        let length = system.length;
        let mut random = Random::new(SEED);
        let size = 6 * system.bodies.len();
        let freedoms = size + self.dependent.len() - system.solver_rows;
        // As many columns as there are freedoms stay independent where all that is not allowed is taken away from them.
        let mut basis = DMatrix::from_fn(size, freedoms, |_, _| random.between(-1.0, 1.0));
        if freedoms == 0 {
            return basis;
        }
        if let Some(rows) = &self.unclear {
            let exact = left_null_space(&rows.transpose(), DEPENDENT.sqrt());
            if exact.ncols() == freedoms {
                return from_unit_rows(system, exact);
            }
        }
        scale_turns(&mut basis, 1.0 / length);
        for _ in 0..ROUNDS {
            for mut column in basis.column_iter_mut() {
                (0..PROJECTIONS).for_each(|_| elimination.allow(system, column.as_mut_slice()));
            }
            scale_turns(&mut basis, length);
            basis = basis.qr().q();
            scale_turns(&mut basis, 1.0 / length);
        }
        basis
    }

    /// γ' of the solver rows at a state: what A ξ̇ has to be there.
    pub fn needed_accelerations(&mut self, state: &State) -> &[f64] {
        let Self { system, elimination, .. } = self;
        elimination.needed_accelerations(system, state)
    }

    /// Multipliers n of the solver rows that do nothing, Aᵀ n = 0, as columns: one for each dependent row.
    pub fn idle_multipliers(&mut self) -> DMatrix<f64> {
        let Self { system, elimination, dependent, .. } = self;
        let mut idle = DMatrix::zeros(system.solver_rows, dependent.len());
        for (row, mut column) in dependent.iter().zip(idle.column_iter_mut()) {
            column[row.index()] = 1.0;
            (0..=PROJECTIONS).for_each(|_| elimination.relieve(system, column.as_mut_slice()));
        }
        idle
    }
}

/// A of the position in lengths, each row of length one.
fn unit_rows(system: &System, elimination: &Elimination) -> DMatrix<f64> {
    let mut a = DMatrix::zeros(system.solver_rows, 6 * system.bodies.len());
    for (index, incidence) in system.incidences.iter().enumerate() {
        let first = system[incidence.constraint].solver.start;
        let radius = system.bodies[incidence.body].principal[0].sqrt();
        let rows = elimination.jacobian().rows_on(system, IncidenceId(index)).chunks_exact(6);
        for (k, row) in rows.enumerate() {
            for (c, x) in row.iter().enumerate() {
                a[(first + k, 6 * incidence.body + c)] += if c < 3 { *x } else { x / radius };
            }
        }
    }
    for mut row in a.row_iter_mut() {
        let norm = row.norm();
        if norm > 0.0 {
            row /= norm;
        }
    }
    a
}

/// An orthonormal basis in the mechanism's length from one with rotations measured by the arms of bodies.
fn from_unit_rows(system: &System, mut basis: DMatrix<f64>) -> DMatrix<f64> {
    for (index, body) in system.bodies.iter().enumerate() {
        let mut turns = basis.rows_mut(6 * index + 3, 3);
        turns *= system.length / body.principal[0].sqrt();
    }
    let mut basis = basis.qr().q();
    scale_turns(&mut basis, 1.0 / system.length);
    basis
}

/// Multiplies the rotations in columns of (v, ω).
fn scale_turns(basis: &mut DMatrix<f64>, factor: f64) {
    for (row, mut values) in basis.row_iter_mut().enumerate() {
        if row % 6 >= 3 {
            values *= factor;
        }
    }
}
