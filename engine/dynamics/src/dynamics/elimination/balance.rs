//! Whether a solution answers to all moments: what is regularized may have nothing that does.

use super::Elimination;
use crate::system::System;
use nalgebra::Vector3;

/// Part of the moments and forces on a body above which a moment that is left is no rounding.
const LEFT: f64 = 1e-6;
/// Part of the others that the last of equal steps is at least.
const EQUAL: f64 = 0.9;
/// Part of the largest rotation above which a body takes part in one.
const TAKES_PART: f64 = 0.1;

impl Elimination {
    /// The body without inertia about some axis that the last solution leaves most out of balance, and the moment that is left, N m: each step
    /// of the iteration (7.8) adds as much to its acceleration as the one before.
    pub fn out_of_balance(&self, system: &System) -> Option<(usize, Vector3<f64>)> {
        let least = EQUAL * self.proximal.part_of_equal_steps();
        let left = |body: usize| {
            let (solve, regularizing) = (&self.bodies[body], system.bodies[body].regularizing_inertia);
            let added = solve.twist[1] - solve.returned;
            let found = solve.twist[1] - solve.at_zero;
            let goes_on = added.norm_squared() > least * added.dot(&found).abs();
            let left = added * regularizing;
            (regularizing > 0.0 && goes_on && left.norm() > LEFT * self.size_of_loads(system, body))
                .then_some((body, left))
        };
        (0..system.bodies.len()).filter_map(left).max_by(|a, b| a.1.norm().total_cmp(&b.1.norm()))
    }

    /// The bodies that move together in the last solution with next to no inertia, most of all the first: joints lend none there about axes
    /// without some.
    pub fn hardly_inert(&self) -> Vec<usize> {
        if !self.proximal.is_slow() {
            return Vec::new();
        }
        let left = |body: &usize| (self.bodies[*body].twist[1] - self.bodies[*body].returned).norm();
        let most = (0..self.bodies.len()).map(|body| left(&body)).fold(0.0, f64::max);
        let mut bodies: Vec<usize> =
            (0..self.bodies.len()).filter(|body| left(body) > TAKES_PART * most).collect();
        bodies.sort_by(|a, b| left(b).total_cmp(&left(a)));
        bodies
    }

    /// All that acts on a body in the last solution, however much of it cancels, as a moment, N m.
    fn size_of_loads(&self, system: &System, body: usize) -> f64 {
        let of = |force: f64, moment: f64| system.length * force + moment;
        let [force, moment] = &self.bodies[body].wrench;
        let mut size = of(force.norm(), moment.norm());
        for incidence in system.incidences.iter().filter(|incidence| incidence.body == body) {
            let first = system[incidence.constraint].solver.start;
            let block = &self.jacobian.a[incidence.offset..incidence.offset + 6 * incidence.rows];
            for (a, lambda) in block.as_chunks::<6>().0.iter().zip(&self.lambda[first..]) {
                let [force, moment] = [0, 3].map(|k| Vector3::new(a[k], a[k + 1], a[k + 2]).norm());
                size += lambda.abs() * of(force, moment);
            }
        }
        size
    }
}
