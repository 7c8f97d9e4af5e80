//! Velocities at a singular position: those of a branch of the motion.
//!
//! Where rows lose their hold, Φ_q q̇ = −Φ_t allows velocities with which no motion goes on: accelerations exist only if
//! χᵀ γ'(q̇) = 0 for each χ with Aᵀ χ = 0 — eq. (8.3).

use super::geometry::Geometry;
use crate::state::{self, State};
use crate::system::System;
use crate::system::natural::NaturalCoordinates;
use nalgebra::{DMatrix, DVector, Vector3};

/// Part of the accelerations that rows ask for which is none of (8.3): rounding.
const MET: f64 = 1e-9;
/// Steps of Newton's method; next to a branch each squares what is left.
const STEPS: usize = 40;
/// Part of the largest slope of (8.3) below which one is none.
const FLAT: f64 = 1e-8;
/// Where the search begins anew if it does not end: parts of how fast the fastest body turns.
const BESIDE: [f64; 3] = [0.0, 0.3, -0.3];
/// Rows with which dense matrices take some seconds.
const MOST_ROWS: usize = 600;

/// Whether the velocities at a singular position are those of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Branch {
    /// They are, or nothing moves.
    Given,
    /// They were not: they have been changed to the nearest that are, by up to so much, m/s or, of directors, 1/s.
    Chosen(f64),
    /// They are not, and none were found that are.
    None,
}

/// Changes velocities that satisfy the rows at a singular position q, at the time of the state, to those of a branch of the motion; the
/// state is left there.
pub fn take(system: &System, state: &mut State, q: &[f64], q_dot: &mut [f64]) -> Branch {
    if system.solver_rows > MOST_ROWS {
        return Branch::Given;
    }
    state.set_positions(system, q);
    let mut search = Search::new(system, state, q);
    let given = q_dot.to_vec();
    let left = search.left(&given);
    if left.is_met() {
        return Branch::Given;
    }
    // Where drivers alone set bodies at rest in motion, what they ask for says how fast.
    let pace = state::fastest(system, &[q, &given].concat()).max((left.size / system.length).sqrt());
    for part in BESIDE {
        let mut there = given.clone();
        if part != 0.0 {
            let aside = part * pace * system.length;
            there = search
                .moved(&there, &DVector::from_fn(search.motions.ncols(), |k, _| aside / (k + 1) as f64));
        }
        if search.find(&mut there) {
            let changed = there.iter().zip(&given).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
            q_dot.copy_from_slice(&there);
            return Branch::Chosen(changed);
        }
    }
    Branch::None
}

/// χᵀ γ' for each χ, and the size of γ'.
struct Left {
    along: DVector<f64>,
    size: f64,
}

impl Left {
    fn is_met(&self) -> bool {
        self.along.amax() <= MET * self.size
    }
}

struct Search<'a> {
    system: &'a System,
    state: &'a mut State,
    geometry: Geometry,
    q: &'a [f64],
    /// Twists that the rows allow, columns.
    motions: DMatrix<f64>,
    /// χ, columns.
    idle: DMatrix<f64>,
}

impl<'a> Search<'a> {
    fn new(system: &'a System, state: &'a mut State, q: &'a [f64]) -> Self {
        let mut geometry = Geometry::new(system);
        geometry.place(state);
        let (motions, mut idle) = (geometry.twists(), geometry.idle_multipliers());
        for mut column in idle.column_iter_mut() {
            column.normalize_mut();
        }
        Self { system, state, geometry, q, motions, idle }
    }

    fn left(&mut self, q_dot: &[f64]) -> Left {
        self.state.set_velocities(self.system, q_dot);
        let needed = DVector::from_column_slice(self.geometry.needed_accelerations(self.state));
        Left { along: self.idle.tr_mul(&needed), size: needed.norm() }
    }

    /// Velocities changed by a combination of the motions.
    fn moved(&self, q_dot: &[f64], by: &DVector<f64>) -> Vec<f64> {
        let twists = &self.motions * by;
        let mut out = q_dot.to_vec();
        for (index, body) in self.system.bodies.iter().enumerate() {
            let at = body.layout.position(self.q);
            let rate = body.layout.velocity(&at, q_dot);
            let part = |k: usize| Vector3::new(twists[k], twists[k + 1], twists[k + 2]);
            let (v, omega) = (part(6 * index), part(6 * index + 3));
            let changed =
                NaturalCoordinates { r: rate.r + v, e: [0, 1, 2].map(|k| rate.e[k] + omega.cross(&at.e[k])) };
            body.layout.store(&changed, &mut out);
        }
        out
    }

    /// Newton's method to the nearest velocities that meet (8.3), and a step beyond: it squares what is left.
    fn find(&mut self, q_dot: &mut Vec<f64>) -> bool {
        for _ in 0..STEPS {
            let left = self.left(q_dot);
            let Some(better) = self.step(q_dot, &left) else { return left.is_met() };
            *q_dot = better;
            if left.is_met() {
                return true;
            }
        }
        false
    }

    /// One step, `None` where it leads nowhere.
    fn step(&mut self, q_dot: &[f64], left: &Left) -> Option<Vec<f64>> {
        // (8.3) is of second degree: differences of any size are exact.
        let size = state::fastest(self.system, &[self.q, q_dot].concat()) * self.system.length;
        let count = self.motions.ncols();
        let mut slopes = DMatrix::zeros(self.idle.ncols(), count);
        for k in 0..count {
            let mut at = |by: f64| {
                let there = self.moved(q_dot, &DVector::from_fn(count, |i, _| if i == k { by } else { 0.0 }));
                self.left(&there).along
            };
            let slope = (at(size) - at(-size)) / (2.0 * size);
            slopes.set_column(k, &slope);
        }
        // At rest there is no size; and of what is not finite no decomposition ends.
        if !slopes.iter().all(|slope| slope.is_finite()) {
            return None;
        }
        let svd = slopes.svd(true, true);
        let step = svd.solve(&left.along, FLAT * svd.singular_values.amax()).ok()?;
        let better = self.moved(q_dot, &-step);
        better.iter().all(|x| x.is_finite()).then_some(better)
    }
}
