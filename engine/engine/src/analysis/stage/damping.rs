//! Forces that depend on the velocities of small motions: those of dampers, and gyroscopic ones of a steady motion.

use super::{Stage, resultants};
use nalgebra::{DMatrix, DVector, RowDVector, Vector3};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::state::AppliedForces;

impl Stage {
    /// −∂(generalized force)/∂(velocity) along a basis, at the state taken over last: Σ d g gᵀ over the loads, with d = −∂f/∂ẋ and g
    /// the generalized force of a unit force along x, and the gyroscopic matrix of the steady motion.
    pub fn damping(&self, basis: &DMatrix<f64>) -> DMatrix<f64> {
        let mut out = self.gyroscopic(basis);
        for (damping, along) in self.dampers(basis) {
            out.ger(damping, &along, &along, 1.0);
        }
        out
    }

    /// d of each damped load, and its g along a basis.
    pub fn dampers(&self, basis: &DMatrix<f64>) -> Vec<(f64, DVector<f64>)> {
        let mut out = Vec::new();
        self.for_damped(|damping, unit| out.push((damping, basis.tr_mul(unit))));
        out
    }

    /// What resists motions along a basis at any speed, as rows: of each damped load its unit force, of length one where moments are
    /// taken over the mechanism's length, and the
    /// gyroscopic matrix relative to what its entries are made of, since that cancels where nothing resists. What none of them feels
    /// goes on for ever, however strong the others are.
    pub fn resistance(&self, basis: &DMatrix<f64>) -> DMatrix<f64> {
        let mut rows: Vec<RowDVector<f64>> = Vec::new();
        let length = self.mechanism.system.length;
        let part = |(k, x): (usize, &f64)| if k % 6 >= 3 { x / length } else { *x };
        self.for_damped(|_, unit| {
            let size = unit.iter().enumerate().map(part).fold(0.0, libm::hypot);
            rows.push((basis.tr_mul(unit) / size).transpose());
        });
        let largest = self.gyroscopic_parts(basis);
        if largest > 0.0 {
            rows.extend(self.gyroscopic(basis).row_iter().map(|row| row / largest));
        }
        if rows.is_empty() { DMatrix::zeros(0, basis.ncols()) } else { DMatrix::from_rows(&rows) }
    }

    /// Calls `take` with d and the wrenches of a unit force of each damped load.
    fn for_damped(&self, mut take: impl FnMut(f64, &DVector<f64>)) {
        let Mechanism { system, state, .. } = &self.mechanism;
        for load in &system.loads {
            let mut unit = AppliedForces::none(system);
            if let Some((_, damping)) = load.linearized(system, state, &mut unit)
                && damping != 0.0
            {
                let unit = resultants(state, &unit);
                if unit.norm() > 0.0 {
                    take(damping, &unit);
                }
            }
        }
    }

    /// −∂(forces of inertia of the steady motion)/∂(velocity) along a basis.
    pub fn gyroscopic(&self, basis: &DMatrix<f64>) -> DMatrix<f64> {
        basis.tr_mul(&self.gyroscopic_wrenches(basis))
    }

    /// The largest sum of the parts of an entry, N s/m: m 2 |Ω| |v| |v'| and J (|Ω| + |n|) |w| |w'| of each body, J its greatest moment of
    /// inertia and n the rate of its spin. Those of a body that turns about a principal axis cancel within its wrench already.
    fn gyroscopic_parts(&self, basis: &DMatrix<f64>) -> f64 {
        let sizes = lengths(basis);
        let mut parts = sizes.clone();
        let turning = self.flow.turning.norm();
        for (index, body) in self.mechanism.system.bodies.iter().enumerate() {
            let spin = self.flow.spins.get(index).map_or(0.0, |spin| spin.rate.abs());
            parts.row_mut(2 * index).scale_mut(2.0 * body.mass * turning);
            parts.row_mut(2 * index + 1).scale_mut(body.principal.max() * (turning + spin));
        }
        sizes.tr_mul(&parts).amax()
    }

    /// The gyroscopic forces as wrenches body by body, a column for each motion: they are quadratic, so that differences are exact.
    fn gyroscopic_wrenches(&self, basis: &DMatrix<f64>) -> DMatrix<f64> {
        let mut out = DMatrix::zeros(basis.nrows(), basis.ncols());
        for k in 0..basis.ncols() {
            for sign in [1.0, -1.0] {
                let part = |at: usize| Vector3::from_fn(|c, _| sign * basis[(at + c, k)]);
                self.for_inertial(
                    |body| [part(6 * body), part(6 * body + 3)],
                    |body, wrench| {
                        for (c, part) in wrench.iter().flat_map(|part| part.iter()).enumerate() {
                            out[(6 * body + c, k)] -= 0.5 * sign * part;
                        }
                    },
                );
            }
        }
        out
    }
}

/// Length of each velocity and angular velocity.
fn lengths(columns: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(columns.nrows() / 3, columns.ncols(), |i, j| columns.fixed_view::<3, 1>(3 * i, j).norm())
}
