//! A mechanism held at a state, and what can be read off it there.

use nalgebra::{DMatrix, DVector};
use triad_engine::Scene;
use triad_engine::constraints::mechanism::Mechanism;
use triad_engine::constraints::rank;
use triad_engine::equations;
use triad_engine::equations::jacobian::Jacobian;
use triad_engine::model::Model;
use triad_engine::ode::OdeSystem;
use triad_engine::scene::Coordinates;
use triad_engine::system::System;

/// A mechanism and the state y = (q, q̇) given in its scene, not yet moved onto the constraints.
pub struct TestMechanism {
    /// The mechanism.
    pub mechanism: Mechanism,
    /// The state.
    pub y: Vec<f64>,
}

impl TestMechanism {
    /// Reads a scene and takes its start as it stands.
    pub fn new(scene: &Scene) -> Self {
        let system = System::new(Model::new(scene).unwrap());
        let n = system.coordinates;
        let mut y = vec![0.0; 2 * n];
        let (q, q_dot) = y.split_at_mut(n);
        system.start(q, q_dot);
        Self { mechanism: Mechanism::new(system), y }
    }

    /// Moves the state onto the constraints and finds redundant rows, as a run does before it starts.
    #[must_use]
    pub fn assembled(mut self) -> Self {
        self.mechanism.assemble(&mut self.y).unwrap();
        let n = self.n();
        let Mechanism { system, state, .. } = &mut self.mechanism;
        let rank = rank::analyze(system, state, &self.y[..n]).dependent;
        self.mechanism.elimination.set_redundant(!rank.is_empty());
        self
    }

    /// Number of rows of joints that depend on others. The state is left elsewhere.
    pub fn dependent_rows(&mut self) -> usize {
        let n = self.n();
        let Mechanism { system, state, .. } = &mut self.mechanism;
        rank::analyze(system, state, &self.y[..n]).dependent.len()
    }

    /// Number of generalized coordinates.
    pub fn n(&self) -> usize {
        self.mechanism.system.coordinates
    }

    /// q̇.
    pub fn velocity(&self) -> DVector<f64> {
        DVector::from_column_slice(&self.y[self.n()..])
    }

    /// y + h d.
    pub fn along(&self, d: &[f64], h: f64) -> Vec<f64> {
        self.y.iter().zip(d).map(|(y, d)| y + h * d).collect()
    }

    /// Φ at y.
    pub fn phi(&mut self, y: &[f64]) -> DVector<f64> {
        self.mechanism.set_state(0.0, y);
        equations::constraints(&self.mechanism.system, &self.mechanism.state).into()
    }

    /// γ at y.
    pub fn gamma(&mut self, y: &[f64]) -> DVector<f64> {
        self.mechanism.set_state(0.0, y);
        equations::gamma(&self.mechanism.system, &self.mechanism.state).into()
    }

    /// Φ_q at y, as a full matrix.
    pub fn jacobian(&mut self, y: &[f64]) -> DMatrix<f64> {
        self.mechanism.set_state(0.0, y);
        let sparse = Jacobian::new(&self.mechanism.system, &self.mechanism.state);
        let mut dense = DMatrix::zeros(sparse.rows.len(), sparse.columns.len());
        for entry in sparse.entries {
            dense[(entry.row, entry.column)] += entry.value;
        }
        dense
    }

    /// Accelerations q̈ at y by the engine.
    pub fn accelerations(&mut self, y: &[f64]) -> DVector<f64> {
        let mut rate = vec![0.0; y.len()];
        self.mechanism.rhs(0.0, y, &mut rate);
        DVector::from_column_slice(&rate[self.n()..])
    }

    /// Energy at y, J.
    pub fn energy(&mut self, y: &[f64]) -> f64 {
        self.mechanism.set_state(0.0, y);
        self.mechanism.state.energy(&self.mechanism.system)
    }

    /// Accelerations q̈ at y by the augmented system, written down as eqs. (6.3), (6.5) and (6.6) say and solved densely with
    /// least squares: shares nothing with the engine's elimination. Also the condition number of that system.
    pub fn augmented(&mut self, y: &[f64]) -> (DVector<f64>, f64) {
        let (phi_q, gamma) = (self.jacobian(y), self.gamma(y));
        let (mass, force) = self.mass_and_force(y);
        let (n, m) = (self.n(), gamma.len());
        let mut matrix = DMatrix::zeros(n + m, n + m);
        matrix.view_mut((0, 0), (n, n)).copy_from(&mass);
        matrix.view_mut((n, 0), (m, n)).copy_from(&phi_q);
        matrix.view_mut((0, n), (n, m)).copy_from(&phi_q.transpose());
        let mut right = DVector::zeros(n + m);
        right.rows_mut(0, n).copy_from(&force);
        right.rows_mut(n, m).copy_from(&gamma);
        // Least norm by eigenvalues (the matrix is symmetric), then refinement.
        let eigen = matrix.clone().symmetric_eigen();
        let largest = eigen.eigenvalues.amax();
        let inverse = eigen.eigenvalues.map(|e| if e.abs() > 1e-11 * largest { 1.0 / e } else { 0.0 });
        let solve = |right: &DVector<f64>| {
            &eigen.eigenvectors * inverse.component_mul(&eigen.eigenvectors.tr_mul(right))
        };
        let mut solution = solve(&right);
        for _ in 0..2 {
            solution += solve(&(&right - &matrix * &solution));
        }
        (solution.rows(0, n).into_owned(), largest * inverse.amax())
    }

    /// Vᵀ M V and Vᵀ (G − M V̇ q̇) with G the weight.
    fn mass_and_force(&self, y: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
        let n = self.n();
        let system = &self.mechanism.system;
        let mut mass = DMatrix::zeros(n, n);
        let mut force = DVector::zeros(n);
        for body in &system.bodies {
            let size = body.layout.size();
            let at = |k: usize| nalgebra::Vector3::from_column_slice(&y[k..k + 3]);
            let mut v = DMatrix::zeros(12, size);
            v.view_mut((0, 0), (size, size)).fill_with_identity();
            let mut v_dot_q_dot = DVector::zeros(12);
            if body.coordinates == Coordinates::Reduced {
                let (u, w) = (at(body.layout.first + 3), at(body.layout.first + 6));
                v.view_mut((9, 3), (3, 3)).copy_from(&-w.cross_matrix());
                v.view_mut((9, 6), (3, 3)).copy_from(&u.cross_matrix());
                let (u_dot, v_dot) = (at(n + body.layout.first + 3), at(n + body.layout.first + 6));
                v_dot_q_dot.rows_mut(9, 3).copy_from(&(2.0 * u_dot.cross(&v_dot)));
            }
            let i = body.principal;
            let diagonal = [
                body.mass,
                0.5 * (i[1] + i[2] - i[0]),
                0.5 * (i[2] + i[0] - i[1]),
                0.5 * (i[0] + i[1] - i[2]),
            ];
            let full = DMatrix::from_fn(12, 12, |a, b| if a == b { diagonal[a / 3] } else { 0.0 });
            let mut applied = DVector::zeros(12);
            applied.rows_mut(0, 3).copy_from(&(system.model.gravity * body.mass));
            let first = body.layout.first;
            mass.view_mut((first, first), (size, size)).copy_from(&(v.transpose() * &full * &v));
            force.rows_mut(first, size).copy_from(&(v.transpose() * (applied - full * v_dot_q_dot)));
        }
        (mass, force)
    }
}
