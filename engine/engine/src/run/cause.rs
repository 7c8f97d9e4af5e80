//! Why a run cannot go on from its last good state, as far as the mechanism itself can tell.

use super::Simulation;
use crate::error::Cause;
use crate::scene::{ConstraintMethod, IntegratorKind};
use triad_dynamics::constraints::ConstraintError;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::state::{self, State};
use triad_dynamics::system::islands;

/// How far ahead a position is looked for, rad of the body that turns fastest.
const AHEAD: [f64; 2] = [0.1, 0.01];
/// Pivot product of a joint, relative to that at the start, below which the joint is named as the cause.
const LOSING: f64 = 1e-4;
/// Pivot product of a joint at the start below which the joint is named as the cause.
const WEAK: f64 = 1e-7;
/// Tolerance below which rounding near a singular position may be what a run stops at: a hundred windows in a row stop at
/// 1e-12 and go through at 3e-12.
const TIGHT: f64 = 1e-11;

impl Simulation {
    /// Why the motion cannot continue from the current state, if that can be found.
    pub(super) fn cause(&self) -> Option<Cause> {
        self.locked()
            .or_else(|| self.without_inertia())
            .or_else(|| self.out_of_reach())
            .or_else(|| self.nearly_dependent())
    }

    /// Whether friction and the reaction that loads it have grown together without bounds.
    fn locked(&self) -> Option<Cause> {
        let load = self.mechanism.elimination.locked_friction(self.system())?;
        Some(Cause::Locked { load: self.model().loads[load].name.clone() })
    }

    /// Whether bodies have come to move together with next to no inertia.
    pub(super) fn without_inertia(&self) -> Option<Cause> {
        let (time, bodies) = self.lent_inertia.hardly_inert.as_ref()?;
        let named = |body: &usize| self.model().bodies[*body].name.clone();
        Some(Cause::WithoutInertia { time: *time, bodies: bodies.iter().map(named).collect() })
    }

    /// Whether drivers ask for positions that the joints do not allow: then none is found a little ahead.
    fn out_of_reach(&self) -> Option<Cause> {
        let system = &self.mechanism.system;
        let drivers: Vec<String> = system
            .constraints
            .iter()
            .filter(|constraint| constraint.driver)
            .map(|constraint| constraint.name.clone())
            .collect();
        if drivers.is_empty() {
            return None;
        }
        // Where nothing moves yet, the run's own time must do.
        let pace = state::fastest(system, self.current.y()).max(self.duration().recip());
        let mut found = None;
        for ahead in AHEAD {
            let h = ahead / pace;
            let time = self.time() + h;
            if h.is_nan() || time > self.duration() {
                continue;
            }
            let mut y = self.current.y().to_vec();
            let (q, q_dot) = y.split_at_mut(system.coordinates);
            q.iter_mut().zip(q_dot).for_each(|(q, v)| *q += h * *v);
            let open = match self.mechanism.clone().assemble_at(time, &mut y) {
                Err(ConstraintError::Assembly { joint, with, .. }) => [vec![joint], with].concat(),
                Err(ConstraintError::MotionImpossible { driver, with, .. }) => [vec![driver], with].concat(),
                _ => return None,
            };
            found = Some((time, open));
        }
        let (time, mut open) = found?;
        open.retain(|name| !name.is_empty());
        let driver = drivers.iter().find(|driver| open.contains(driver)).cloned();
        Some(Cause::OutOfReach { drivers: driver.map_or(drivers, |driver| vec![driver]), time, open })
    }

    /// The joint whose rows are nearest to depending on others. Those of a tree never are, whatever their pivots say.
    fn nearly_dependent(&self) -> Option<Cause> {
        if !islands::has_loops(self.model()) {
            return None;
        }
        let start = self.pivot_products_at(0.0, &self.start);
        let here = self.pivot_products_at(self.time(), self.current.y());
        let constraints = &self.mechanism.system.constraints;
        let named = |index: usize| constraints[index].name.clone();
        let least = |products: &[f64]| {
            products.iter().copied().enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 1.0))
        };
        let left: Vec<f64> = here.iter().zip(&start).map(|(here, start)| here / start).collect();
        let (lost, weak) = (least(&left), least(&start));
        if weak.1 < WEAK {
            return Some(Cause::Weak { joint: named(weak.0), pivot_product: weak.1.max(0.0) });
        }
        let settings = &self.model().settings;
        let best_way = matches!(self.kind, IntegratorKind::Taylor | IntegratorKind::Dop853)
            && settings.constraint_method == ConstraintMethod::Projection
            && settings.tolerance < TIGHT;
        let pivot_product = lost.1.max(0.0);
        (lost.1 < LOSING).then(|| Cause::Losing { joint: named(lost.0), pivot_product, best_way })
    }

    fn pivot_products_at(&self, time: f64, y: &[f64]) -> Vec<f64> {
        let Mechanism { system, elimination, .. } = &self.mechanism;
        let (q, q_dot) = y.split_at(system.coordinates);
        let mut solver = elimination.clone();
        solver.keep_pivot_products();
        solver.pivot_products_at(system, &State::at(system, time, q, q_dot)).to_vec()
    }
}
