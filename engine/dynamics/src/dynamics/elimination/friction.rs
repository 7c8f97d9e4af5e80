//! Dry friction and the reactions that load it, which depend on each other — eq. (7.12).
//!
//! For given friction the multipliers are linear in it: one solution without it and one for each unit of it, all with one factor,
//! leave as many scalar equations as there are such loads. Each has a concave left side, so that Newton's method comes to the
//! least friction that satisfies it from below; they are solved in turns.

mod least;

use super::{Elimination, Multipliers};
use crate::state::State;
use crate::system::System;
use crate::system::contact::DryFriction;
use crate::system::natural::NaturalCoordinates;
use least::least_friction;
use nalgebra::{Matrix3, Vector3};

/// Rounds after which frictions that load each other count as locked.
const MAX_ROUNDS: usize = 200;
/// Change of a friction in a round, relative to the largest of them, below which they are found.
const SETTLED: f64 = 1e-15;

/// Frictions at a state, and what they are found from.
#[derive(Clone, Debug)]
pub(super) struct Frictions {
    /// For each friction what one newton of pressing makes of it.
    factors: Vec<f64>,
    /// For each friction the forces at its ends without any friction.
    base: Vec<[Vector3<f64>; 2]>,
    /// The same for a unit of each friction: those of one are together.
    response: Vec<[Vector3<f64>; 2]>,
    /// The frictions.
    values: Vec<f64>,
    /// Generalized forces of all other loads.
    others: Vec<NaturalCoordinates>,
    /// One that had no solution at the last state of finite numbers.
    pub locked: Option<usize>,
}

impl Frictions {
    /// Room for those of a system.
    pub fn new(system: &System) -> Self {
        let count = system.frictions.len();
        let bodies = if count == 0 { 0 } else { system.bodies.len() };
        Self {
            factors: vec![0.0; count],
            base: vec![Default::default(); count],
            response: vec![Default::default(); count * count],
            values: vec![0.0; count],
            others: vec![NaturalCoordinates::default(); bodies],
            locked: None,
        }
    }

    /// Solves f_k = c_k N_k(λ₀ + Σ Λ_j f_j); not a number where there is no solution.
    fn settle(&mut self) {
        let count = self.values.len();
        let given = self.base.iter().flatten().chain(self.response.iter().flatten()).flat_map(|v| v.iter());
        if !given.chain(&self.factors).all(|x| x.is_finite()) {
            // The state is to blame, and what was found before it.
            self.values.fill(f64::NAN);
            return;
        }
        self.values.fill(0.0);
        self.locked = None;
        for _ in 0..MAX_ROUNDS {
            let (mut change, mut largest) = (0.0f64, 0.0f64);
            for k in 0..count {
                let mut ends = self.base[k];
                for j in (0..count).filter(|&j| j != k) {
                    for (end, unit) in ends.iter_mut().zip(&self.response[j * count + k]) {
                        *end += unit * self.values[j];
                    }
                }
                let Some(found) = least_friction(self.factors[k], &ends, &self.response[k * count + k])
                else {
                    self.locked = Some(k);
                    self.values.fill(f64::NAN);
                    return;
                };
                change = change.max((found - self.values[k]).abs());
                largest = largest.max(found.abs());
                self.values[k] = found;
            }
            if count == 1 || change <= SETTLED * largest {
                return;
            }
        }
        self.locked = Some(0);
        self.values.fill(f64::NAN);
    }
}

/// The rate of the load's coordinate, m/s or rad/s.
fn rate(system: &System, state: &State, friction: &DryFriction) -> f64 {
    system.loads[friction.load].coordinate(state).map_or(0.0, |(_, rate)| rate)
}

impl Elimination {
    /// Adds dry friction to the applied forces, with the terms of velocities and of Baumgarte's stabilization that
    /// `solve_others` puts in place before it solves.
    pub(super) fn add_friction(
        &mut self,
        system: &System,
        state: &State,
        solve_others: impl FnOnce(&mut Self),
    ) {
        let mut frictions = std::mem::take(&mut self.frictions);
        let Some(found) = frictions.as_deref_mut() else { return };
        let count = system.frictions.len();
        found.others.copy_from_slice(&self.forces.bodies);
        solve_others(self);
        for (k, friction) in system.frictions.iter().enumerate() {
            found.factors[k] = friction.factor(rate(system, state, friction));
            found.base[k] = self.multipliers(system, state).friction_ends(friction);
        }
        for (j, friction) in system.frictions.iter().enumerate() {
            self.set_unit_load(system, state, friction.load);
            self.set_particular(system, state, false, |_, _| Matrix3::zeros());
            self.gamma.fill(0.0);
            self.solve(system);
            let units = &mut found.response[j * count..(j + 1) * count];
            for (unit, other) in units.iter_mut().zip(&system.frictions) {
                *unit = self.multipliers(system, state).friction_ends(other);
            }
        }
        found.settle();
        self.forces.bodies.copy_from_slice(&found.others);
        for (friction, value) in system.frictions.iter().zip(&found.values) {
            system.loads[friction.load].push(system, state, *value, &mut self.forces);
        }
        self.take_forces();
        self.frictions = frictions;
    }

    /// A load whose friction had no solution at the last state: the reaction grows faster with it than it with the reaction.
    pub fn locked_friction(&self, system: &System) -> Option<usize> {
        let locked = self.frictions.as_ref()?.locked?;
        Some(system.frictions[locked].load)
    }
}

impl Multipliers<'_> {
    fn friction_ends(&self, friction: &DryFriction) -> [Vector3<f64>; 2] {
        let axis = self.system.loads[friction.load].axis(self.state);
        let reaction = self.joint_wrench(&self.system[friction.joint]);
        reaction.map_or_else(Default::default, |on| friction.ends(&axis, [on.force, on.moment]))
    }

    /// With how much force the reaction of its joint presses the parts together that rub, N — eq. (6.11).
    pub fn pressing(&self, friction: &DryFriction) -> f64 {
        self.friction_ends(friction).iter().map(Vector3::norm).sum()
    }

    /// Dry friction along its load's coordinate, N or N m, and the rate of that coordinate — eq. (6.11).
    pub fn dry_friction(&self, friction: &DryFriction) -> [f64; 2] {
        let rate = rate(self.system, self.state, friction);
        [friction.factor(rate) * self.pressing(friction), rate]
    }
}
