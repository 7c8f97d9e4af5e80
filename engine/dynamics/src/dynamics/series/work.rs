//! The power of what drivers and loads bring in, and its work — eq. (11.8).
//!
//! A power follows from accelerations. Its series are shorter by two orders than those of the motion, and its terms larger, so that at the
//! end of a step that the motion allows it may be off by a thousand tolerances. One power within the step, of the equations themselves,
//! tells the terms that are left out.

use super::expand::Value;
use super::recurrence::value;
use super::{Bodies, Series};
use crate::newton::Projectable;
use crate::system::System;
use crate::system::index::SolverRow;
use triad_linalg::larger;

mod between;

pub(super) use between::WorkBetween;

/// Order of the series at a single state: that of the accelerations.
const ACCELERATIONS: usize = 2;
/// Part of the tolerance below which the last terms of the power, beside the power itself, show that there is nothing more to find.
const COMPLETE: f64 = 0.1;
/// Part of the terms before it below which a term may be small by chance, and part of the power above which what is left out is not foreseen
/// from the terms before it.
const CHANCE: f64 = 0.1;
const SEEN: f64 = 0.01;
/// The power is looked at in so many places of a step.
const PLACES: usize = 4;

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
        self.work_between = WorkBetween::new();
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

    /// Finds one more term of the power in a step that was taken, unless its series tell it to the tolerance as they are; where that is not
    /// enough, as where a mass is shaken along a line, or beside a singular position, the polynomial through powers within the step.
    pub(super) fn complete_power(&mut self, taken: Taken, tolerance: f64) {
        let Taken { h, terms, .. } = taken;
        self.work_between.forget();
        if self.meter.is_none() || self.power.len() <= terms {
            return;
        }
        let [size, last] = self.sizes_of_power(taken);
        if last <= COMPLETE * tolerance * size {
            return;
        }
        // Gauss's point for the weight τ^n of what is left out: its work is exact for two of its terms.
        let tau = h * (terms + 1) as f64 / (terms + 2) as f64;
        let power = self.power_at(taken, tau);
        let known = value(&self.power[..terms], tau);
        let (mut missing, mut at_end) = (power - known, power - known);
        for _ in 0..terms {
            (missing, at_end) = (missing / tau, at_end * h / tau);
        }
        // The next one, if they go on falling as fast as this one does beside those before it; one alone may be small by chance.
        let fallen = at_end.abs().max(CHANCE * last);
        let next = fallen * fallen / last;
        // Of n terms and this one, it does to the work the n²-th part of what it does to the power at the end, at most.
        if next <= ((terms * terms) as f64 * tolerance).min(SEEN) * size {
            self.power[terms] = missing;
        } else {
            self.interpolate_power(taken, tolerance);
        }
    }

    /// Finds the polynomial through powers within the step.
    fn interpolate_power(&mut self, taken: Taken, tolerance: f64) {
        let mut between = std::mem::take(&mut self.work_between);
        between.find(taken.h, tolerance, |tau| self.power_at(taken, tau));
        self.work_between = between;
    }

    /// Sizes at a step: of the power in some places of it, and of the larger of its last two terms at the end.
    fn sizes_of_power(&self, Taken { h, terms, .. }: Taken) -> [f64; 2] {
        let known = &self.power[..terms];
        let (mut size, mut last, mut power) = (known.first().map_or(0.0, |p| p.abs()), 0.0, 1.0);
        for place in 1..=PLACES {
            size = larger(size, value(known, h * place as f64 / PLACES as f64).abs());
        }
        for (n, p) in known.iter().enumerate() {
            if n + 2 >= terms {
                last = larger(last, (p * power).abs());
            }
            power *= h;
        }
        [size, last]
    }

    /// The power by the equations a time τ after the start of a step.
    fn power_at(&mut self, Taken { start, order, .. }: Taken, tau: f64) -> f64 {
        let Self { instructions, q, stride, angles, meter, .. } = self;
        let Some(meter) = meter.as_deref_mut() else { return f64::NAN };
        for (own, given) in meter.angles.list.iter_mut().zip(&angles.list) {
            own.state.reference = given.state.reference;
        }
        meter.set_time(start + tau);
        for (b, state) in meter.state.iter_mut().enumerate() {
            let coefficients = &q[b * *stride..=b * *stride + order];
            *state = instructions.dispatch(Value::<L, B> { coefficients, tau });
        }
        meter.linearize();
        meter.evaluate_here();
        meter.find_power(ACCELERATIONS);
        meter.power.first().copied().unwrap_or(f64::NAN)
    }

    /// Work of drivers and of loads without potential in a time τ after the point of the last expansion, J.
    pub fn work(&self, tau: f64) -> f64 {
        self.work_between.at(tau).unwrap_or_else(|| {
            self.power.iter().enumerate().rev().fold(0.0, |sum, (n, p)| (sum + p / (n + 1) as f64) * tau)
        })
    }
}
