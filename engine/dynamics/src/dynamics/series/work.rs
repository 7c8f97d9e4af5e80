//! The power of what drivers and loads bring in, and its work — eq. (11.8).
//!
//! A power follows from accelerations. Its series are shorter by two orders than those of the motion, and its terms larger, so that at the
//! end of a step that the motion allows it may be off by a thousand tolerances. One power within the step, of the equations themselves,
//! tells the terms that are left out.

use super::expand::Value;
use super::{Bodies, Series};
use crate::newton::Projectable;
use crate::system::System;
use crate::system::index::SolverRow;
use pulp::Arch;
use std::f64::consts::PI;
use triad_linalg::larger;

/// Order of the series at a single state: that of the accelerations.
const ACCELERATIONS: usize = 2;
/// Part of the tolerance below which the last terms of the power, beside all of them, show that there is nothing more to find.
const COMPLETE: f64 = 0.1;
/// Part of all terms above which the last ones show that the series of the power hardly converge, as about a state beside a singular
/// position: it is then a polynomial through powers within the step. And the same in tolerances: loose ones leave terms that are as large.
const ROUGH: (f64, f64) = (1e-4, 100.0);
/// The powers that this goes through.
const NODES: usize = 12;
/// Greatest size of the term that is found, in the last ones known: near a singular position the power of a single state is noise.
const PLAUSIBLE: f64 = 10.0;
/// A step: its start and size, s, the order at which it was cut, and the terms of its power.
#[derive(Clone, Copy)]
pub(super) struct Taken {
    pub start: f64,
    pub h: f64,
    pub order: usize,
    pub terms: usize,
}

impl<const L: usize, B: Bodies<L>> Series<L, B> {
    /// From now on knows the power within steps as well as the motion, if there is any; `turns` are the angles of joints at the start,
    /// `left_out` the rows that are.
    pub fn measure_power(&mut self, system: &System, turns: &[f64], left_out: &[SolverRow]) {
        if self.power.is_empty() {
            return;
        }
        let mut meter = Self::of(system, ACCELERATIONS, turns);
        meter.keep_constants(self.schur.keep_constants);
        meter.leave_out(left_out);
        self.meter = Some(Box::new(meter));
    }

    /// Finds the power of drivers and of loads without potential, from the series up to order `order`.
    #[inline(always)]
    pub(super) fn find_power(&mut self, order: usize) {
        let (q, stride, lambda, rows) = (&self.q, self.stride, &self.lambda, self.correction.len());
        let coefficient = |b: usize, i: usize| &q[b * stride + i];
        let multiplier = |i: usize, row: usize| lambda[i * rows + row];
        self.power.fill(0.0);
        for (n, power) in self.power.iter_mut().enumerate().take(order.saturating_sub(1)) {
            *power = self.loads.power::<L, B>(n, coefficient)
                + self.prescribed.power::<L, B>(n, coefficient, multiplier);
        }
    }

    /// Finds one more term of the power in a step that was taken, unless its series tell it to the tolerance as they are.
    pub(super) fn complete_power(&mut self, taken: Taken, tolerance: f64) {
        let Taken { h, terms, .. } = taken;
        if self.meter.is_none() || self.power.len() <= terms {
            return;
        }
        let [all, last] = self.sizes_of_power(taken);
        if last <= COMPLETE * tolerance * all {
            return;
        }
        if last > ROUGH.0.max(ROUGH.1 * tolerance) * all {
            self.interpolate_power(taken);
            return;
        }
        // Gauss's point for the weight τ^n of what is left out: its work is exact for two of its terms.
        let tau = h * (terms + 1) as f64 / (terms + 2) as f64;
        let power = self.power_at(taken, tau);
        let known = self.power[..terms].iter().rev().fold(0.0, |sum, p| sum * tau + p);
        let (mut missing, mut at_end) = (power - known, power - known);
        for _ in 0..terms {
            (missing, at_end) = (missing / tau, at_end * h / tau);
        }
        if at_end.abs() <= PLAUSIBLE * last {
            self.power[terms] = missing;
        }
    }

    /// Replaces the series of the power by the polynomial through powers at Chebyshev's points of the step.
    fn interpolate_power(&mut self, taken: Taken) {
        let count = NODES.min(self.power.len());
        let (mut places, mut differences) = ([0.0; NODES], [0.0; NODES]);
        for (i, (place, value)) in places.iter_mut().zip(&mut differences).enumerate().take(count) {
            *place = 0.5 - 0.5 * libm::cos((i as f64 + 0.5) * PI / count as f64);
            *value = self.power_at(taken, *place * taken.h);
        }
        for order in 1..count {
            for i in (order..count).rev() {
                differences[i] = (differences[i] - differences[i - 1]) / (places[i] - places[i - order]);
            }
        }
        // From Newton's form to coefficients of powers of τ/h.
        let mut coefficients = [0.0; NODES];
        for i in (0..count).rev() {
            for k in (1..count).rev() {
                coefficients[k] = coefficients[k - 1] - places[i] * coefficients[k];
            }
            coefficients[0] = differences[i] - places[i] * coefficients[0];
        }
        if coefficients.iter().all(|c| c.is_finite()) {
            self.power.fill(0.0);
            let mut scale = 1.0;
            for (power, c) in self.power.iter_mut().zip(&coefficients[..count]) {
                *power = c * scale;
                scale /= taken.h;
            }
        }
    }

    /// Sizes of the terms of the power at the end of a step: all together, and the larger of the last two.
    fn sizes_of_power(&self, Taken { h, terms, .. }: Taken) -> [f64; 2] {
        let ([mut all, mut last], mut power) = ([0.0, 0.0], 1.0);
        for (n, p) in self.power[..terms].iter().enumerate() {
            let term = (p * power).abs();
            all += term;
            if n + 2 >= terms {
                last = larger(last, term);
            }
            power *= h;
        }
        [all, last]
    }

    /// The power by the equations a time τ after the start of a step.
    fn power_at(&mut self, Taken { start, order, .. }: Taken, tau: f64) -> f64 {
        let Self { q, stride, angles, meter, .. } = self;
        let Some(meter) = meter.as_deref_mut() else { return f64::NAN };
        for (own, given) in meter.angles.list.iter_mut().zip(&angles.list) {
            own.state.reference = given.state.reference;
        }
        meter.set_time(start + tau);
        for (b, state) in meter.state.iter_mut().enumerate() {
            let coefficients = &q[b * *stride..=b * *stride + order];
            *state = Arch::new().dispatch(Value::<L, B> { coefficients, tau });
        }
        meter.linearize();
        meter.evaluate_here();
        meter.find_power(ACCELERATIONS);
        meter.power.first().copied().unwrap_or(f64::NAN)
    }

    /// Work of drivers and of loads without potential in a time τ after the point of the last expansion, J.
    pub fn work(&self, tau: f64) -> f64 {
        self.power.iter().enumerate().rev().fold(0.0, |sum, (n, p)| (sum + p / (n + 1) as f64) * tau)
    }
}
