//! One step of the series: expand, choose how far the terms reach, move there, and project.

use super::lanes::largest;
use super::recurrence::real;
use super::work::Taken;
use super::{Bodies, Series};
use crate::newton::{Ending, Projectable, Projected, project_positions, project_velocities, rules};
use crate::system::passing::{met, shortest_step};
use pulp::{Simd, WithSimd};
use triad_linalg::larger;

/// Correction of the positions, in tolerances, above which S is factored again.
const NEGLIGIBLE: f64 = 0.01;
/// Order up to which the series is always expanded.
const MIN_ORDER: usize = 8;
/// Distance of a step's end from its constraints, or of a prescribed function from its series, in tolerances, above which the
/// step is halved.
const MAX_VIOLATION: f64 = 100.0;
/// Part of what a prescribed function does within a step, in terms that the step leaves out, from which on they are looked at: it may
/// begin like a high power of time, and low terms of the motion, which choose the step, know nothing of it.
const GOES_ON: f64 = 0.01;
/// Most halvings of a step.
const MAX_REJECTED: u64 = 12;
/// The most that a joint angle on which something depends turns in a step, rad: less than half a turn, so that whole turns can be counted
/// from the end of a step.
const MAX_TURN: f64 = 3.0;
/// A term of the series at the step's end that is three orders lower must allow a step shorter by 1 + this / (order − 3) for a
/// higher order to pay: the work of a step grows with the power 1.0 to 1.3 of the order (measured, docs/PERFORMANCE.md), and
/// (k/(k − 3))^1.5 is about this.
const ORDER_PAYS: f64 = 4.5;
/// The same for the present order to pay: (k/(k − 3))^1.2.
const ORDER_HOLDS: f64 = 3.6;
/// A step that reaches what is left to the end when stretched by this factor ends there.
const LAST_STEP: f64 = 1.01;

/// What a step is given.
#[derive(Clone, Copy, Debug)]
pub struct StepPlan {
    /// Highest order of the series.
    pub order: usize,
    /// Relative and absolute tolerance.
    pub tolerance: f64,
    /// A length of the mechanism, m.
    pub length: f64,
    /// End of the run, s: no step goes beyond it.
    pub end: f64,
    /// Whether to find only the step that the series allow, regardless of breakpoints, and not to take it.
    pub dry_run: bool,
}

/// A step that was taken.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::struct_excessive_bools, reason = "findings that have nothing to do with each other")]
pub struct SeriesStep {
    /// Its size, s.
    pub h: f64,
    /// The time at its end, s.
    pub time: f64,
    /// Whether it ends at a breakpoint of a prescribed function: its size then says nothing about the convergence of the
    /// series.
    pub at_break: bool,
    /// The order at which the series was cut.
    pub order: usize,
    /// The order that the next step had better have: higher where terms fall so fast that more of them pay.
    pub next_order: usize,
    /// How often it was halved because its end was too far from the constraints, or a prescribed function from its series.
    pub rejected: u64,
    /// Whether its end is too far from the constraints even after all halvings.
    pub far: bool,
    /// Whether the new state is made of finite numbers.
    pub finite: bool,
    /// Whether the projection has proved that the constraints hold: its last correction was negligible, with a factor that
    /// is not regularized.
    pub proven: bool,
}

/// A step, to be compiled for each set of vector instructions.
struct Step<'a, const L: usize, B: Bodies<L>>(&'a mut Series<L, B>, StepPlan);

impl<const L: usize, B: Bodies<L>> WithSimd for Step<'_, L, B> {
    type Output = SeriesStep;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> SeriesStep {
        self.0.step_here(simd, self.1)
    }
}

/// A part of a step, to be compiled likewise.
struct Call<'a, const L: usize, B: Bodies<L>>(&'a mut Series<L, B>, Part);

/// The parts of a step that are called, not inlined. One type for all, so that each is compiled once.
#[derive(Clone, Copy, Debug)]
pub(super) enum Part {
    /// Builds S.
    Assemble,
    /// Builds S and factors it.
    Linearize,
    /// Corrects the positions (0) or the velocities (1).
    Correct(usize),
    /// Takes over the values of features at the state.
    Settle,
}

impl<const L: usize, B: Bodies<L>> WithSimd for Call<'_, L, B> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        match self.1 {
            Part::Assemble => self.0.assemble_here(simd),
            Part::Linearize => self.0.linearize_here(simd),
            Part::Correct(which) => return self.0.correct_here(simd, which),
            Part::Settle => self.0.settle(),
        }
        0.0
    }
}

/// Accelerations, likewise.
struct Evaluate<'a, const L: usize, B: Bodies<L>>(&'a mut Series<L, B>);

impl<const L: usize, B: Bodies<L>> WithSimd for Evaluate<'_, L, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.0.begin_expansion(simd);
        self.0.solve_order(simd, 0);
    }
}

impl<const L: usize, B: Bodies<L>> Series<L, B> {
    /// Accelerations and multipliers at the state: builds and factors S, then order 0.
    pub fn evaluate(&mut self) {
        self.linearize();
        self.evaluate_here();
    }

    /// The same where S is factored.
    pub(super) fn evaluate_here(&mut self) {
        self.instructions.dispatch(Evaluate(self));
    }

    /// Parts are called, not inlined: a step would otherwise contain several copies of each.
    #[inline(never)]
    pub(super) fn call(&mut self, part: Part) -> f64 {
        self.instructions.dispatch(Call(self, part))
    }

    /// Takes a step from the state, at which S must be factored, and factors S at its end.
    pub fn step(&mut self, plan: StepPlan) -> SeriesStep {
        self.instructions.dispatch(Step(self, plan))
    }

    /// The step that the series at the state allow, at which S must be factored, if no breakpoint were in the way, s.
    pub fn natural_step(&mut self, order: usize, tolerance: f64) -> f64 {
        self.step(StepPlan { order, tolerance, length: 0.0, end: f64::INFINITY, dry_run: true }).h
    }

    #[inline(always)]
    fn step_here<S: Simd>(&mut self, simd: S, plan: StepPlan) -> SeriesStep {
        // Prescribed functions are smooth only between their breakpoints: a step ends exactly at the next one.
        let end = plan.end.min(self.next_break);
        let (start, left) = (self.time, end - self.time);
        let allowance = self.allowance(plan.tolerance);
        let again = self.expand_unless_known(simd, plan, allowance, left, end < plan.end);
        let expanded = self.expansion.order;
        self.find_power(expanded);
        let (natural, order) = self.reach_unless_driven(expanded, allowance, left);
        if plan.dry_run {
            return SeriesStep {
                h: natural,
                time: start,
                at_break: false,
                order,
                next_order: plan.order,
                rejected: 0,
                far: false,
                finite: true,
                proven: false,
            };
        }
        let turned = self.angles.limit(natural.min(left), order, MAX_TURN);
        let most = self.loads.limit(turned, order, plan.tolerance);
        let beside = self.loads.limit_passing(most, order, met(plan.tolerance, plan.length));
        let mut h = beside.max(shortest_step(start, plan.end)).min(most);
        // A longer series would not make a step longer that something else keeps short.
        let next_order =
            if h < natural { plan.order } else { self.next_order(plan.order, expanded, order, h, allowance) };
        let mut rejected = 0;
        loop {
            let mut time = start + h;
            if LAST_STEP * h >= left {
                (h, time) = (left, end);
            }
            let met =
                rejected == MAX_REJECTED || self.meets_prescribed(h, time, MAX_VIOLATION * plan.tolerance);
            if met {
                let most = (rejected < MAX_REJECTED).then_some(MAX_VIOLATION * plan.tolerance);
                if let Some((moved, closed)) = self.arrive(h, time, order, plan, most) {
                    // The projection says nothing about rows that are left out of it.
                    let proven = closed && !self.regularized && !self.rows_left_out;
                    let finite = self.is_finite();
                    self.complete_power(Taken { start, h, order, terms: expanded - 1 }, plan.tolerance);
                    self.carry_over(start, h, order, plan.length, time == end && end < plan.end, again);
                    let far = moved.is_nan() || moved > MAX_VIOLATION * plan.tolerance;
                    return SeriesStep {
                        h,
                        time,
                        at_break: time == end,
                        order,
                        next_order,
                        rejected,
                        far,
                        finite,
                        proven,
                    };
                }
            }
            // The end may have been tried, with what is prescribed there.
            self.set_time(start);
            rejected += 1;
            h *= 0.5;
        }
    }

    /// Finds the series of a step, as far as what is left up to a breakpoint asks for, unless those of the step that was taken back still
    /// hold. Returns whether they do.
    #[inline(always)]
    fn expand_unless_known<S: Simd>(
        &mut self,
        simd: S,
        plan: StepPlan,
        allowance: [f64; 2],
        left: f64,
        breaks: bool,
    ) -> bool {
        match self.expansion.back.take() {
            Some(true) => return true,
            Some(false) => {
                self.linearize();
                self.transport.iter_mut().for_each(|transport| transport.start_here());
            }
            None => {}
        }
        // Between breakpoints, prescribed functions are polynomials of degree five: only terms of higher order than those of
        // their accelerations show how well the series converge.
        self.expansion.order = self.expand(simd, plan.order, |s, k| {
            breaks
                && !plan.dry_run
                && k > MIN_ORDER
                && s.reached(k - 1, allowance).min(s.reached(k, allowance)) >= left
                && !s.prescribed_goes_on(left, k, GOES_ON)
        });
        self.expansion.resolving = self.resolving;
        false
    }

    /// Moves to the end of a step, factors S there and projects positions and velocities. Returns how far the positions were
    /// moved, which is what the terms that were left out would have added, and whether Newton's method has converged; `None`
    /// if it moved them by more than `most`.
    #[inline(always)]
    fn arrive(
        &mut self,
        h: f64,
        time: f64,
        order: usize,
        plan: StepPlan,
        most: Option<f64>,
    ) -> Option<(f64, bool)> {
        self.advance(h, order);
        self.set_time(time);
        let Projected { moved, ending, .. } = project_positions(self, &rules::SERIES_POSITIONS, plan.length);
        if most.is_some_and(|most| moved.is_nan() || moved > most) {
            return None;
        }
        if self.magnified(h) * moved > NEGLIGIBLE * plan.tolerance {
            self.linearize();
        }
        project_velocities(self, &rules::SERIES_VELOCITIES, plan.length);
        Some((moved, ending == Ending::Consistent))
    }

    /// How many times what S is off by, as it was factored at the start of a correction, the positions may be off by after a step of size h.
    /// Reactions that are large for what they act on, as those of a light link that carries heavy ones, are so in other directions.
    #[inline(always)]
    pub(super) fn magnified(&self, h: f64) -> f64 {
        let multipliers = &self.lambda[..self.correction.len()];
        larger(1.0, 0.5 * h * h * self.schur.factor.largest_alone(multipliers, &self.row_sizes))
    }

    /// The largest terms of positions and velocities that a tolerance allows.
    #[inline(always)]
    fn allowance(&self, tolerance: f64) -> [f64; 2] {
        // No closures: they would not be compiled for the vectors in use.
        let mut sizes = [0.0, 0.0];
        for [position, velocity] in &self.state {
            sizes[0] = larger(sizes[0], largest(B::lanes(position)));
            sizes[1] = larger(sizes[1], largest(B::lanes(velocity)));
        }
        [tolerance * (1.0 + sizes[0]), tolerance * (1.0 + sizes[1])]
    }

    /// Whether the term of order k allows only steps shorter than h, of which hᵏ⁻¹ is given: found without roots and divisions.
    #[inline(always)]
    fn falls_short(&self, k: usize, [position, velocity]: [f64; 2], h: f64, power: f64) -> bool {
        let most = self.sizes[k] * power;
        velocity < real(k) * most || position < h * most
    }

    /// The step that the term of order k allows.
    #[inline(always)]
    fn reached(&self, k: usize, [position, velocity]: [f64; 2]) -> f64 {
        let term = self.sizes[k];
        let [by_position, by_velocity] = [position / term, velocity / (k as f64 * term)];
        // The smaller of two roots.
        libm::exp((libm::log(by_position) / k as f64).min(libm::log(by_velocity) / (k - 1) as f64))
    }

    /// The order that pays for the next step, where h is what the series allow: that of motions that are fast but smooth, like the
    /// spinning of a top, get longer steps with each order, others hardly. `order` was planned, `expanded` computed, and the
    /// step uses terms up to `cut`.
    #[inline(always)]
    fn next_order(&self, order: usize, expanded: usize, cut: usize, h: f64, allowance: [f64; 2]) -> usize {
        if expanded < order {
            return order;
        }
        if cut < order {
            return order - 1;
        }
        if self.is_short(order - 3, allowance, h, ORDER_PAYS) {
            order + 2
        } else if self.is_short(order - 3, allowance, h, ORDER_HOLDS) {
            order
        } else {
            order - 1
        }
    }

    /// Whether the terms of order k and k − 1 allow only steps shorter than h divided by 1 + `factor`/k.
    #[inline(always)]
    fn is_short(&self, k: usize, allowance: [f64; 2], h: f64, factor: f64) -> bool {
        let least = h / (1.0 + factor / k as f64);
        let power = power(least, k - 2);
        self.falls_short(k, allowance, least, power * least)
            || self.falls_short(k - 1, allowance, least, power)
    }

    /// The step and the order at which the series is cut: the longest step that two successive terms of positions and
    /// velocities allow. Near singular positions high terms are noise, and lower ones decide.
    #[inline(always)]
    fn reach(&self, order: usize, allowance: [f64; 2]) -> (f64, usize) {
        let mut best = (0.0, order);
        let mut next = self.reached(order, allowance);
        // The best h to the power of k − 1, so that most terms are seen to fall short without their roots.
        let mut power = 0.0;
        for k in (2..order).rev() {
            let short = self.falls_short(k, allowance, best.0, power);
            let previous = if short { 0.0 } else { self.reached(k, allowance) };
            let h = previous.min(next);
            if h > best.0 {
                best = (h, k + 1);
                power = self::power(h, k - 2);
            } else if power.is_finite() && best.0 > 0.0 {
                power /= best.0;
            } else {
                power = 0.0;
            }
            next = previous;
        }
        best
    }

    /// The same where prescribed functions go on in terms that would be left out: then none of these may be larger than the
    /// tolerance allows.
    #[inline(always)]
    fn reach_unless_driven(&self, order: usize, allowance: [f64; 2], left: f64) -> (f64, usize) {
        let (h, cut) = self.reach(order, allowance);
        if cut == order || !self.prescribed_goes_on(h.min(left), cut, GOES_ON) {
            return (h, cut);
        }
        self.reach_with_all(order, allowance)
    }

    /// The longest step that two successive terms allow and for which no term above them is too large.
    fn reach_with_all(&self, order: usize, allowance: [f64; 2]) -> (f64, usize) {
        let (mut best, mut all) = ((0.0, order), f64::INFINITY);
        for k in (2..order).rev() {
            let h = self.reached(k, allowance).min(self.reached(k + 1, allowance)).min(all);
            if h > best.0 {
                best = (h, k + 1);
            }
            all = all.min(self.reached(k + 1, allowance));
        }
        best
    }
}

/// xⁿ, by squares.
#[inline(always)]
fn power(x: f64, n: usize) -> f64 {
    let (mut all, mut square, mut left) = (1.0, x, n);
    while left > 0 {
        if left % 2 == 1 {
            all *= square;
        }
        square *= square;
        left /= 2;
    }
    all
}
