//! What the energy tells of an error, where it stays what it is — eq. (11.12).
//!
//! The motion without its error has the energy of the start. What an error has of it otherwise is an error of the estimate, and the
//! one that grows: it changes the pace.

use crate::dynamics::series::lanes::{Lane, sum};
use crate::dynamics::series::step::Part;
use crate::dynamics::series::{Bodies, Series};
use crate::system::System;
use pulp::{Simd, WithSimd};

/// Part of the velocities above which a change of them is not made: the energy tells nothing of mechanisms that hardly move.
const SMALL: f64 = 0.05;

/// The energy that the motion has.
#[derive(Clone, Debug)]
pub(super) struct Energy<const L: usize, B: Bodies<L>> {
    /// Where bodies were at the start: heights are measured from there.
    start: Vec<B::Natural>,
    /// That at the start, J.
    kept: f64,
}

impl<const L: usize, B: Bodies<L>> Energy<L, B> {
    /// That of the state of a twin, of a system in which only weight and springs do work.
    pub fn of(system: &System, twin: &mut Series<L, B>) -> Option<Self> {
        system.is_conservative().then(|| {
            let start = twin.state.iter().map(|state| state[0]).collect();
            let mut energy = Self { start, kept: 0.0 };
            (energy.kept, _) = energy.measure(twin);
            energy
        })
    }

    /// Gives the velocities of the twin the energy that the motion without the s-th part of its error has; `h` is the last step, and
    /// `scratch` as large as the state. They keep their direction, and with it what joints demand. Of all states with that energy the
    /// nearest differs in its position too, by the accelerations at hand in the time h: that part is left.
    pub fn give(
        &self,
        twin: &mut Series<L, B>,
        here: &[[B::Natural; 2]],
        s: f64,
        h: f64,
        scratch: &mut [[B::Natural; 2]],
    ) {
        let mut wanted = self.kept;
        if s < 1.0 {
            scratch.copy_from_slice(&twin.state);
            twin.state.copy_from_slice(here);
            let (energy, _) = self.measure(twin);
            twin.state.copy_from_slice(scratch);
            wanted = s * wanted + (1.0 - s) * energy;
        }
        let (energy, [twice, accelerations]) = self.measure(twin);
        let part = (energy - wanted) / (twice + h * h * accelerations);
        if part.abs() < SMALL * s {
            for [_, rate] in &mut twin.state {
                for x in B::lanes_mut(rate).as_flattened_mut() {
                    *x -= part * *x;
                }
            }
        }
    }

    /// The energy of the twin's state, J, and twice the kinetic energies of its velocities and of its accelerations in place of them.
    fn measure(&self, twin: &mut Series<L, B>) -> (f64, [f64; 2]) {
        let instructions = twin.instructions;
        let [twice, accelerations, fallen] =
            instructions.dispatch(Measured { series: twin, start: &self.start });
        let mut springs = 0.0;
        if !twin.loads.is_empty() {
            twin.call(Part::Settle);
            springs = twin.loads.potential(&twin.values, &twin.angles.list);
        }
        (0.5 * twice - fallen + springs, [twice, accelerations])
    }
}

/// Twice the kinetic energy of the state, the same of the accelerations at hand in place of its velocities, and the work of the weight
/// since the start, J, to be compiled for each set of vector instructions.
struct Measured<'a, const L: usize, B: Bodies<L>> {
    series: &'a Series<L, B>,
    start: &'a [B::Natural],
}

impl<const L: usize, B: Bodies<L>> WithSimd for Measured<'_, L, B> {
    type Output = [f64; 3];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> [f64; 3] {
        let Self { series, start } = self;
        let mut sums = [[0.0; L]; 3];
        for (b, (bundle, [position, rate])) in series.bundles.iter().zip(&series.state).enumerate() {
            // Coefficients of order two are halves of accelerations.
            let half = bundle.twice_kinetic(&series.q[b * series.stride + 2]);
            let found: [Lane<L>; 3] =
                [bundle.twice_kinetic(rate), half, bundle.work_of_weight(&start[b], position)];
            for (all, found) in sums.iter_mut().zip(&found) {
                *all = sum(all, found);
            }
        }
        let [twice, half, fallen] = sums.map(|lanes| lanes.into_iter().sum::<f64>());
        [twice, 4.0 * half, fallen]
    }
}
