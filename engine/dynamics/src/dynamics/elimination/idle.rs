//! What rows and motions do to each other without forces: projections with the factor of S at hand.
//!
//! Both take the factor that [`Elimination::dependent_rows`] leaves, without the rows that depend on others.

use super::Elimination;
use crate::system::System;
use nalgebra::Vector3;

impl Elimination {
    /// ξ ← ξ − D⁻¹ Aᵀ S⁻¹ A ξ: what the rows allow of twists (v, ω), body by body.
    pub fn allow(&mut self, system: &System, twists: &mut [f64]) {
        self.set_row_rates(system, twists);
        self.factor.solve(&mut self.residual);
        self.apply_multipliers(system);
        for (body, twist) in self.bodies.iter().zip(twists.chunks_exact_mut(6)) {
            twist[..3].copy_from_slice(body.twist[0].as_slice());
            twist[3..].copy_from_slice(body.twist[1].as_slice());
        }
    }

    /// A ξ: how fast the solver rows open in a motion with these twists.
    pub fn row_rates(&mut self, system: &System, twists: &[f64]) -> &[f64] {
        self.set_row_rates(system, twists);
        &self.residual
    }

    fn set_row_rates(&mut self, system: &System, twists: &[f64]) {
        for (body, twist) in self.bodies.iter_mut().zip(twists.chunks_exact(6)) {
            body.twist =
                [Vector3::new(twist[0], twist[1], twist[2]), Vector3::new(twist[3], twist[4], twist[5])];
        }
        self.gamma.fill(0.0);
        self.row_residual(system);
    }

    /// n ← n − S⁻¹ A D⁻¹ Aᵀ n: multipliers of independent rows are changed until as little as can be moves the bodies.
    pub fn relieve(&mut self, system: &System, multipliers: &mut [f64]) {
        self.bodies.iter_mut().for_each(|body| body.twist = [Vector3::zeros(); 2]);
        self.residual.copy_from_slice(multipliers);
        self.apply_multipliers(system);
        self.gamma.fill(0.0);
        self.row_residual(system);
        self.factor.solve(&mut self.residual);
        for (multiplier, change) in multipliers.iter_mut().zip(&self.residual) {
            *multiplier += change;
        }
    }
}
