//! Between the numbers of the system, body after body, and those of the series, side by side in lanes.

use super::Series;
use super::bodies::{Bodies, FeatureSlot, LanePlace};
use super::expand::Value;
use crate::model::BodyRef;
use crate::system::System;
use crate::system::load::SystemLoad;

impl<const L: usize, B: Bodies<L>> Series<L, B> {
    /// Takes over y = (q, q̇) at time t as the point of expansion.
    pub fn place(&mut self, system: &System, t: f64, y: &[f64]) {
        self.set_time(t);
        let (q, q_dot) = y.split_at(system.coordinates);
        for (bundle, state) in self.bundles.iter().zip(&mut self.state) {
            for (lane, body) in system.bodies[bundle.bodies()].iter().enumerate() {
                for (state, lift) in state.iter_mut().zip(body.motion(q, q_dot)) {
                    bundle.read(lane, &lift, state);
                }
            }
        }
    }

    /// Writes the point of expansion as y = (q, q̇).
    pub fn store(&self, system: &System, y: &mut [f64]) {
        for (b, state) in self.state.iter().enumerate() {
            self.store_bundle(system, b, state, y);
        }
    }

    fn store_bundle(&self, system: &System, b: usize, state: &[B::Natural; 2], y: &mut [f64]) {
        let bundle = &self.bundles[b];
        let (q, q_dot) = y.split_at_mut(system.coordinates);
        for (lane, body) in system.bodies[bundle.bodies()].iter().enumerate() {
            body.store(&bundle.write(lane, &state[0], false), q);
            body.store(&bundle.write(lane, &state[1], true), q_dot);
        }
    }

    /// Writes an error of (q, q̇) of the bodies of bundle b.
    pub(super) fn store_error(&self, system: &System, b: usize, state: &[B::Natural; 2], y: &mut [f64]) {
        let bundle = &self.bundles[b];
        let (q, q_dot) = y.split_at_mut(system.coordinates);
        for (lane, body) in system.bodies[bundle.bodies()].iter().enumerate() {
            body.store(&bundle.write(lane, &state[0], true), q);
            body.store(&bundle.write(lane, &state[1], true), q_dot);
        }
    }

    /// Writes the accelerations q̈ of order 0.
    pub fn store_accelerations(&self, system: &System, out: &mut [f64]) {
        for (bundle, q) in self.bundles.iter().zip(self.q.chunks(self.stride)) {
            let mut accelerations = q[2];
            B::fours_mut(&mut accelerations).as_flattened_mut().iter_mut().for_each(|x| *x *= 2.0);
            for (lane, body) in system.bodies[bundle.bodies()].iter().enumerate() {
                body.store(&bundle.write(lane, &accelerations, true), out);
            }
        }
    }

    /// Writes (q, q̇) a time τ after the point that the series were last expanded about.
    pub fn interpolate(&self, system: &System, tau: f64, order: usize, y: &mut [f64]) {
        for b in 0..self.bundles.len() {
            let coefficients = &self.q[b * self.stride..=b * self.stride + order];
            self.store_bundle(system, b, &self.instructions.dispatch(Value::<L, B> { coefficients, tau }), y);
        }
    }
}

/// The features that rows, loads and angles are made of, and those that move as prescribed. Those that only angles use are the last:
/// angles that somebody wants to see change no order of sums.
fn used(system: &System) -> Vec<usize> {
    let mut rank: Vec<usize> =
        system.features.iter().map(|feature| if feature.curve.is_some() { 0 } else { 2 }).collect();
    for feature in system.angles.iter().flat_map(|angle| angle.features().into_iter().chain([angle.axis])) {
        rank[feature.index()] = rank[feature.index()].min(1);
    }
    let of_rows = system.rows.iter().flat_map(|row| row.form.features(&system.angles));
    for feature in of_rows.chain(system.loads.iter().flat_map(SystemLoad::features)) {
        rank[feature.index()] = 0;
    }
    let mut used: Vec<usize> = (0..rank.len()).filter(|&feature| rank[feature] < 2).collect();
    used.sort_by_key(|&feature| rank[feature]);
    used
}

/// Bodies in bundles, their features in slots, and where each feature stands that is used.
pub(super) fn bundles<const L: usize, B: Bodies<L>>(
    system: &System,
) -> (Vec<B>, Vec<FeatureSlot<L>>, Vec<LanePlace>) {
    let mut place = vec![LanePlace { slot: 0, lane: 0 }; system.features.len()];
    let mut of_body: Vec<Vec<usize>> = vec![Vec::new(); system.bodies.len()];
    for index in used(system) {
        if let BodyRef::Moving(body) = system.features[index].body {
            of_body[body].push(index);
        }
    }
    let mut bundles = Vec::new();
    let mut slots: Vec<FeatureSlot<L>> = Vec::new();
    for (first, features) in of_body.chunks(L).enumerate().map(|(b, features)| (b * L, features)) {
        let count = features.iter().map(Vec::len).max().unwrap_or(0);
        let begin = slots.len();
        slots.resize(begin + count, FeatureSlot::NOTHING);
        let mut bundle = B::empty(first..first + features.len(), begin..begin + count);
        for (lane, features) in features.iter().enumerate() {
            bundle.set_body(lane, system, &system.bodies[first + lane]);
            for (k, &feature) in features.iter().enumerate() {
                place[feature] = LanePlace { slot: begin + k, lane };
                let slot = &mut slots[begin + k];
                slot.point[lane] = if system.features[feature].point { 1.0 } else { 0.0 };
                for c in 0..3 {
                    slot.local[c][lane] = system.features[feature].local[c];
                }
            }
        }
        bundles.push(bundle);
    }
    (bundles, slots, place)
}
