//! Between the numbers of the system, body after body, and those of the series, side by side in lanes.

use super::bundle::{Bundle, Slot};
use super::lanes::{Lifted, zero};
use super::rows::Place;
use super::{Series, horner};
use crate::lift::Lift;
use crate::model::BodyRef;
use crate::system::System;
use nalgebra::Vector3;

impl<const L: usize> Series<L> {
    /// Takes over y = (q, q̇) at time t as the point of expansion.
    pub fn place(&mut self, system: &System, t: f64, y: &[f64]) {
        self.set_time(t);
        let (q, q_dot) = y.split_at(system.coordinates);
        for (bundle, state) in self.bundles.iter().zip(&mut self.state) {
            for (lane, body) in system.bodies[bundle.bodies.clone()].iter().enumerate() {
                let position = body.layout.position(q);
                let velocity = body.layout.velocity(&position, q_dot);
                for (state, lift) in state.iter_mut().zip([position, velocity]) {
                    for (k, vector) in [lift.r, lift.e[0], lift.e[1], lift.e[2]].into_iter().enumerate() {
                        for c in 0..3 {
                            state[k][c][lane] = vector[c];
                        }
                    }
                }
            }
        }
    }

    /// Writes the point of expansion as y = (q, q̇).
    pub fn store(&self, system: &System, y: &mut [f64]) {
        let (q, q_dot) = y.split_at_mut(system.coordinates);
        for (bundle, state) in self.bundles.iter().zip(&self.state) {
            for (lane, body) in system.bodies[bundle.bodies.clone()].iter().enumerate() {
                body.layout.store(&of_lane(&state[0], lane), q);
                body.layout.store(&of_lane(&state[1], lane), q_dot);
            }
        }
    }

    /// Writes the accelerations q̈ of order 0.
    pub fn store_accelerations(&self, system: &System, out: &mut [f64]) {
        for bundle in &self.bundles {
            for (lane, body) in system.bodies[bundle.bodies.clone()].iter().enumerate() {
                body.layout.store(&of_lane(&bundle.solution, lane), out);
            }
        }
    }

    /// Writes (q, q̇) a time τ after the point that the series were last expanded about.
    pub fn interpolate(&self, system: &System, tau: f64, order: usize, y: &mut [f64]) {
        let (q, q_dot) = y.split_at_mut(system.coordinates);
        for (b, bundle) in self.bundles.iter().enumerate() {
            let state = horner(&self.q[b * self.stride..=b * self.stride + order], tau);
            for (lane, body) in system.bodies[bundle.bodies.clone()].iter().enumerate() {
                body.layout.store(&of_lane(&state[0], lane), q);
                body.layout.store(&of_lane(&state[1], lane), q_dot);
            }
        }
    }
}

/// The lifted vector of one body.
fn of_lane<const L: usize>(x: &Lifted<L>, lane: usize) -> Lift {
    let [r, u, v, w] = x.map(|v| Vector3::new(v[0][lane], v[1][lane], v[2][lane]));
    Lift { r, e: [u, v, w] }
}

/// Orthonormal directors for lanes without a body.
pub(super) fn at_rest<const L: usize>() -> Lifted<L> {
    let mut q = zero();
    for k in 0..3 {
        q[1 + k][k] = [1.0; L];
    }
    q
}

/// Bodies in bundles, their features in slots, and where each feature stands.
pub(super) fn bundles<const L: usize>(system: &System) -> (Vec<Bundle<L>>, Vec<Slot<L>>, Vec<Place>) {
    let mut place = vec![Place { slot: 0, lane: 0 }; system.features.len()];
    let mut of_body: Vec<Vec<usize>> = vec![Vec::new(); system.bodies.len()];
    for (index, feature) in system.features.iter().enumerate() {
        if let BodyRef::Moving(body) = feature.body {
            of_body[body].push(index);
        }
    }
    let mut bundles = Vec::new();
    let mut slots: Vec<Slot<L>> = Vec::new();
    for (first, features) in of_body.chunks(L).enumerate().map(|(b, features)| (b * L, features)) {
        let count = features.iter().map(Vec::len).max().unwrap_or(0);
        let begin = slots.len();
        slots.resize(begin + count, Slot { local: [[0.0; L]; 3], point: [0.0; L] });
        let mut bundle = Bundle::new(first..first + features.len(), begin..begin + count);
        for (lane, features) in features.iter().enumerate() {
            let body = &system.bodies[first + lane];
            bundle.inverse_mass[lane] = 1.0 / body.mass;
            bundle.lent[lane] = body.lent;
            for c in 0..3 {
                bundle.ibar[c][lane] = body.ibar[c];
                bundle.weight[c][lane] = body.mass * system.model.gravity[c];
            }
            for (k, &feature) in features.iter().enumerate() {
                place[feature] = Place { slot: begin + k, lane };
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
