//! ẏ = f(y) of an example, with one of three kinds of linear algebra.

use super::{PaperCase, PaperError, scene};
use nalgebra::{DMatrix, DVector};
use triad_engine::EngineError;
use triad_engine::dynamics::elimination::Elimination;
use triad_engine::equations;
use triad_engine::equations::augmented::{AugmentedSystem, DEPENDENT, for_mass_entries, force};
use triad_engine::equations::jacobian::Jacobian;
use triad_engine::model::Model;
use triad_engine::ode::OdeSystem;
use triad_engine::state::State;
use triad_engine::system::System;
use triad_linalg::{Columns, SparseLu, independent_rows};
use triad_scene::Coordinates;

/// How the accelerations are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinearAlgebra {
    /// LU factorization of the whole augmented matrix, stored as a full square.
    Dense,
    /// LU factorization of the same matrix, zeros left out.
    Sparse,
    /// The engine's own way: rigid-body rows eliminated in closed form.
    Elimination,
}

/// The equations of an example, ready to be evaluated again and again.
#[derive(Clone, Debug)]
pub struct PaperSystem {
    system: System,
    state: State,
    elimination: Elimination,
    algebra: LinearAlgebra,
    damping: f64,
    stiffness: f64,
    start: Vec<f64>,
    /// Place of each row among those that are kept.
    place: Vec<Option<usize>>,
    kept: usize,
    jacobian: Jacobian,
    lu: SparseLu,
    matrix: Columns,
    entries: Vec<(usize, usize, f64)>,
}

impl PaperSystem {
    /// Prepares an example: chooses its rows and the order of elimination.
    ///
    /// # Errors
    ///
    /// [`PaperError`]: the scene cannot be assembled, or its matrix is singular.
    pub fn new(
        case: &PaperCase,
        coordinates: Coordinates,
        algebra: LinearAlgebra,
    ) -> Result<Self, PaperError> {
        let scene = scene(case, coordinates)?;
        let system = System::new(Model::new(&scene).map_err(EngineError::from)?);
        let mut elimination = Elimination::new(&system);
        let n = system.coordinates;
        let mut start = vec![0.0; 2 * n];
        let (q, q_dot) = start.split_at_mut(n);
        system.start(q, q_dot);
        let state = State::at(&system, 0.0, q, q_dot);
        let jacobian = Jacobian::new(&system, &state);
        let kept = independent_rows(&AugmentedSystem::new(&system, &state).jacobian, DEPENDENT);
        elimination.set_redundant(kept.len() < system.rigid_rows + system.equations);
        let mut place = vec![None; system.rigid_rows + system.equations];
        for (k, &row) in kept.iter().enumerate() {
            place[row] = Some(k);
        }
        Ok(Self {
            state,
            elimination,
            algebra,
            damping: 2.0 * case.alpha,
            stiffness: case.beta * case.beta,
            start,
            place,
            kept: kept.len(),
            jacobian,
            lu: SparseLu::new(n + kept.len()),
            matrix: Columns::default(),
            entries: Vec::new(),
            system,
        })
    }

    /// The state (q, q̇) at the start.
    pub fn start(&self) -> &[f64] {
        &self.start
    }

    /// Rows that were left out.
    pub fn dropped(&self) -> usize {
        self.place.len() - self.kept
    }

    /// Place in q of a component of a body's centre of mass.
    pub(super) fn coordinate(&self, body: usize, axis: usize) -> usize {
        self.system.bodies[body].layout.first + axis
    }

    /// Energy and largest |Φ| at a state.
    pub(super) fn observe(&mut self, y: &[f64]) -> (f64, f64) {
        let (q, q_dot) = y.split_at(self.system.coordinates);
        self.state.set(&self.system, 0.0, q, q_dot);
        (self.state.energy(&self.system), self.state.position_violation(&self.system))
    }

    /// Writes ẏ. False if the equations are singular.
    pub fn rate(&mut self, y: &[f64], rate: &mut [f64]) -> bool {
        let n = self.system.coordinates;
        let (q, q_dot) = y.split_at(n);
        rate[..n].copy_from_slice(q_dot);
        self.state.set(&self.system, 0.0, q, q_dot);
        if self.algebra == LinearAlgebra::Elimination {
            let baumgarte = (0.5 * self.damping, self.stiffness.sqrt());
            self.elimination.accelerate(&self.system, &self.state, baumgarte).write(&mut rate[n..]);
            return rate.iter().all(|x| x.is_finite());
        }
        let mut right = self.write(q_dot);
        let solved = if self.algebra == LinearAlgebra::Dense {
            let size = n + self.kept;
            let mut matrix = DMatrix::zeros(size, size);
            for &(row, column, value) in &self.entries {
                matrix[(row, column)] = value;
            }
            matrix.lu().solve_mut(&mut right)
        } else {
            self.matrix.fill(n + self.kept, &self.entries);
            let regular = self.lu.factor(&self.matrix);
            if regular {
                self.lu.solve(right.as_mut_slice());
            }
            regular
        };
        rate[n..].copy_from_slice(&right.as_slice()[..n]);
        solved && rate.iter().all(|x| x.is_finite())
    }

    /// Writes the augmented matrix as entries; returns the right-hand side (g, γ − 2αΦ̇ − β²Φ).
    fn write(&mut self, q_dot: &[f64]) -> DVector<f64> {
        let n = self.system.coordinates;
        self.jacobian.refresh(&self.system, &self.state);
        let mut right = DVector::zeros(n + self.kept);
        right.rows_mut(0, n).copy_from(&force(&self.system, &self.state));
        let entries = &mut self.entries;
        entries.clear();
        for_mass_entries(&self.system, &self.state, |row, column, value| {
            if value != 0.0 {
                entries.push((row, column, value));
            }
        });
        let mut rates = vec![0.0; self.place.len()];
        for entry in &self.jacobian.entries {
            rates[entry.row] += entry.value * q_dot[entry.column];
            if entry.value != 0.0
                && let Some(k) = self.place[entry.row]
            {
                entries.push((n + k, entry.column, entry.value));
                entries.push((entry.column, n + k, entry.value));
            }
        }
        let values = equations::constraints(&self.system, &self.state);
        let gamma = equations::gamma(&self.system, &self.state);
        for (row, place) in self.place.iter().enumerate() {
            if let Some(k) = place {
                right[n + k] = gamma[row] - self.damping * rates[row] - self.stiffness * values[row];
            }
        }
        right
    }
}

impl OdeSystem for PaperSystem {
    fn rhs(&mut self, _: f64, y: &[f64], rate: &mut [f64]) {
        if !Self::rate(self, y, rate) {
            rate.fill(f64::NAN);
        }
    }

    fn after_step(&mut self, _: f64, _: &mut [f64], _: &mut [f64]) {}
}
