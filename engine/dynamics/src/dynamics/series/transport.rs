//! The error of a motion, carried along with it — eqs. (11.10) and (11.11).
//!
//! Beside the motion x goes the motion without its error, z = x − e, written as that difference. The series about z need
//! fewer terms than those about x, because only their difference counts. What a step itself adds is read off the
//! accelerations at its end, where its polynomials miss those of the equations by a known multiple.

mod differences;

use super::lanes::largest;
use super::step::Part;
use super::{Bodies, Series};
use crate::newton::Projectable;
use crate::system::System;
use differences::{Differ, find_missed, moved, moved_both, size, value};
use pulp::Arch;
use triad_linalg::larger;

/// Part of the length of the mechanism beyond which an error is no longer carried: it would no longer be small.
const LOST: f64 = 0.05;
/// Part of that length by which the state is disturbed where only small disturbances behave: near singular positions.
const DISTURBANCE: f64 = 1e-5;
/// Part of that length below which an error is hardly more than rounding.
const NEAR: f64 = 1e-6;
/// Part of an error that its next correction may leave: a correction c of a mechanism of length l leaves about c²/l.
const LEFT_OVER: f64 = 1e-3;
/// Part of a correction below which the next one shows that Newton's method converges.
const CONVERGES: f64 = 0.25;
/// Growth of an error in one step from which on its series are looked at.
const GROWTH: f64 = 4.0;
/// Part of the error that the last terms make from which on its series do not converge.
const DIVERGES: f64 = 0.1;
/// The same from which on more terms are wanted, how many more, and the fewest.
const UNFINISHED: f64 = 3e-3;
const MORE: usize = 2;
const FEWEST: usize = 3;

/// The error of the motion, and how it changes within the last step.
#[derive(Clone, Debug)]
pub(super) struct Transport<const L: usize, B: Bodies<L>> {
    /// A copy that is expanded about the state without its error.
    twin: Series<L, B>,
    /// Error of positions and velocities at the end of the last step.
    error: Vec<[B::Natural; 2]>,
    /// Coefficients of what the last step has carried, as many for each bundle as the twin keeps.
    carried: Vec<B::Natural>,
    /// What that is at the end of the step.
    arrived: Vec<[B::Natural; 2]>,
    /// The highest order of these.
    order: usize,
    /// What the last step adds to that at its end, before it is moved onto the constraints: states within the step are not.
    added: Vec<[B::Natural; 2]>,
    /// The order and size, s, of the last step.
    step: (usize, f64),
    /// Positions at which S was factored last, and those at which it was for the last step.
    factored: [Vec<B::Natural>; 2],
    /// When the error became too large to be carried, s.
    lost: Option<f64>,
    kept: Kept<L, B>,
}

/// What an evaluation at the end of a step must leave as it was, and scratch.
#[derive(Clone, Debug)]
struct Kept<const L: usize, B: Bodies<L>> {
    state: Vec<[B::Natural; 2]>,
    changed: Vec<[B::Natural; 2]>,
    first: Vec<([B::Natural; 3], B::Directors)>,
    multipliers: Vec<f64>,
    /// Directions across common vectors, in which their multipliers are expanded.
    across: Vec<[[f64; 3]; 2]>,
}

impl<const L: usize, B: Bodies<L>> Series<L, B> {
    /// From now on carries the error along.
    pub fn carry_errors(&mut self) {
        self.transport = Some(Box::new(Transport::new(self)));
    }

    /// When the error became too large to be carried, s.
    pub fn error_lost(&self) -> Option<f64> {
        self.transport.as_ref().and_then(|transport| transport.lost)
    }

    /// Adds what the step of size h from `start`, cut at order `order`, does to the error. At a breakpoint of a prescribed
    /// function accelerations jump: those before it tell of the step.
    pub(super) fn carry_over(&mut self, start: f64, h: f64, order: usize, length: f64, at_break: bool) {
        let Some(mut transport) = self.transport.take() else { return };
        if transport.lost.is_none() {
            let counters = self.counters;
            transport.step = (order, h);
            transport.carry(self, start, length);
            let time = self.time;
            if at_break {
                self.set_time(time.next_down());
            }
            transport.add_local(self);
            if at_break {
                self.set_time(time);
            }
            transport.project(self, length);
            transport.lost = (!transport.is_small(h, length)).then_some(start);
            let [last, used] = &mut transport.factored;
            used.copy_from_slice(last);
            self.counters = counters;
        }
        self.transport = Some(transport);
    }

    /// Writes the error of (q, q̇) a time τ after the start of the last step, if it is known.
    pub fn error(&self, system: &System, tau: f64, out: &mut [f64]) -> bool {
        let Some(transport) = self.transport.as_ref().filter(|transport| transport.lost.is_none()) else {
            return false;
        };
        let (order, h) = transport.step;
        let part: f64 = if h > 0.0 { (tau / h).clamp(0.0, 1.0) } else { 1.0 };
        let weight = (0..order).fold(1.0, |power, _| power * part);
        for b in 0..self.bundles.len() {
            let state = if part < 1.0 {
                moved_both::<L, B>(&transport.at(b, tau), weight, &transport.added[b])
            } else {
                transport.error[b]
            };
            self.store_error(system, b, &state, out);
        }
        true
    }
}

impl<const L: usize, B: Bodies<L>> Transport<L, B> {
    fn new(series: &Series<L, B>) -> Self {
        let count = series.bundles.len();
        let nothing = vec![[B::zero(); 2]; count];
        let positions: Vec<B::Natural> = series.state.iter().map(|state| state[0]).collect();
        let kept = Kept {
            state: nothing.clone(),
            changed: nothing.clone(),
            first: vec![([B::zero(); 3], B::no_directors()); count],
            multipliers: vec![0.0; series.correction.len()],
            across: series.rows.commons.iter().map(|common| common.expanded).collect(),
        };
        let twin = Series { probe: None, ..series.clone() };
        Self {
            twin,
            error: nothing.clone(),
            carried: vec![B::zero(); count * series.stride],
            arrived: nothing.clone(),
            order: 0,
            added: nothing,
            step: (0, 0.0),
            factored: [positions.clone(), positions],
            lost: None,
            kept,
        }
    }

    /// Goes back to the start t of the last step, where S is factored again, with the error that the motion had there.
    pub fn go_back(&mut self, t: f64) {
        for b in 0..self.error.len() {
            self.error[b] = self.at(b, 0.0);
            self.added[b] = [B::zero(); 2];
        }
        self.step.1 = 0.0;
        let [last, used] = &mut self.factored;
        used.copy_from_slice(last);
        self.lost = self.lost.filter(|lost| *lost < t);
    }

    /// Whether rows that hardly hold are kept.
    pub fn set_resolving(&mut self, resolving: bool) {
        self.twin.set_resolving(resolving);
    }

    /// Takes note of where S is factored.
    pub fn note_factored(&mut self, state: &[[B::Natural; 2]]) {
        for (own, state) in self.factored[0].iter_mut().zip(state) {
            *own = state[0];
        }
    }

    fn is_small(&self, h: f64, length: f64) -> bool {
        size::<L, B>(&self.error, h, length) < LOST * length
    }

    /// What the last step has carried up to τ, of bundle b.
    fn at(&self, b: usize, tau: f64) -> [B::Natural; 2] {
        let first = b * self.twin.stride;
        value::<L, B>(&self.carried[first..=first + self.order], tau)
    }

    /// Carries the error over the step: the difference of the series about x and about x − e. It needs one term fewer than in the step
    /// before, or as many more as its last ones show: of stiff mechanisms the motion may be smooth and its error not.
    fn carry(&mut self, series: &Series<L, B>, start: f64, length: f64) {
        let h = self.step.1;
        let most = self.step.0;
        self.order = self.order.saturating_sub(1).max(FEWEST).min(most);
        let before = size::<L, B>(&self.error, h, length);
        self.expand(series, start, 1.0);
        let mut after = size::<L, B>(&self.arrived, h, length);
        while self.order < most && (after.is_nan() || self.last_terms() > UNFINISHED * after) {
            let known = self.order;
            self.order = (known + MORE).min(most);
            self.twin.expand_further(known, self.order);
            self.differ(series, 1.0);
            after = size::<L, B>(&self.arrived, h, length);
        }
        let grows = after.is_nan() || after > GROWTH * before.max(NEAR * length);
        if grows && before > DISTURBANCE * length && (self.last_terms() > DIVERGES * after || after.is_nan())
        {
            self.expand(series, start, DISTURBANCE * length / before);
        }
    }

    /// Size of the last two terms of what is carried, at the end of the step.
    fn last_terms(&self) -> f64 {
        let power = |k: usize| (0..k).fold(1.0, |power, _| power * self.step.1);
        let term = |k: usize| {
            let all = self.carried.iter().skip(k).step_by(self.twin.stride);
            power(k) * all.map(|c| largest(B::lanes(c))).fold(0.0, larger)
        };
        term(self.order).max(term(self.order - 1))
    }

    /// Expands the motion about x − s e and takes the s-th part of the difference. The whole error (s = 1) sees that S is not
    /// factored exactly at x; for a part of it S is disturbed likewise, and that effect stays out.
    fn expand(&mut self, series: &Series<L, B>, start: f64, s: f64) {
        let Self { twin, error, .. } = self;
        let stride = twin.stride;
        twin.set_time(start);
        for (own, angle) in twin.angles.list.iter_mut().zip(&series.angles.list) {
            own.state.reference = angle.theta[0];
        }
        let whole = s >= 1.0;
        if !whole {
            for ((state, error), factored) in twin.state.iter_mut().zip(&*error).zip(&self.factored[1]) {
                state[0] = moved::<L, B>(factored, -s, &error[0]);
            }
            twin.linearize();
        }
        for (b, (state, error)) in twin.state.iter_mut().zip(&*error).enumerate() {
            *state = moved_both::<L, B>(&[series.q[b * stride], series.q[b * stride + 1]], -s, error);
        }
        if whole {
            twin.linearize();
        } else {
            twin.call(Part::Settle);
        }
        twin.expand_to(self.order);
        self.differ(series, s);
    }

    /// The s-th part of the difference of the series.
    fn differ(&mut self, series: &Series<L, B>, s: f64) {
        let (order, h) = (self.order, self.step.1);
        let Self { twin, carried, arrived, .. } = self;
        let stride = twin.stride;
        Arch::new().dispatch(Differ::<L, B> {
            of: [&series.q, &twin.q],
            stride,
            order,
            s,
            h,
            carried,
            arrived,
        });
    }

    /// Finds the error that the step itself makes: with terms up to order p, the accelerations at its end are off by
    /// p (p + 1) / h² times the error of the positions.
    fn add_local(&mut self, series: &mut Series<L, B>) {
        let (order, h) = self.step;
        let p = order as f64;
        let stride = series.stride;
        find_missed::<L, B>(&series.q, stride, (order, h), &mut self.added);
        self.keep(series);
        series.expand_to(2);
        for (b, added) in self.added.iter_mut().enumerate() {
            let missed = moved::<L, B>(&added[0], -2.0, &series.q[b * stride + 2]);
            *added = [h * h / (p * (p + 1.0)), h / p].map(|s| moved::<L, B>(&B::zero(), s, &missed));
        }
        self.restore(series);
    }

    /// Keeps what an evaluation at the end of a step writes over.
    fn keep(&mut self, series: &Series<L, B>) {
        for (b, kept) in self.kept.first.iter_mut().enumerate() {
            let at = b * series.stride;
            *kept = ([series.q[at], series.q[at + 1], series.q[at + 2]], series.p[at]);
        }
        let rows = self.kept.multipliers.len();
        self.kept.multipliers.copy_from_slice(&series.lambda[..rows]);
        for (kept, common) in self.kept.across.iter_mut().zip(&series.rows.commons) {
            *kept = common.expanded;
        }
    }

    fn restore(&self, series: &mut Series<L, B>) {
        for (b, (q, p)) in self.kept.first.iter().enumerate() {
            let at = b * series.stride;
            series.q[at..at + 3].copy_from_slice(q);
            series.p[at] = *p;
        }
        series.lambda[..self.kept.multipliers.len()].copy_from_slice(&self.kept.multipliers);
        for (common, kept) in series.rows.commons.iter_mut().zip(&self.kept.across) {
            common.expanded = *kept;
        }
    }

    /// Makes the error at the end of the step one that the constraints allow: x − e is moved onto them.
    fn project(&mut self, series: &mut Series<L, B>, length: f64) {
        let h = self.step.1;
        for ((error, arrived), added) in self.error.iter_mut().zip(&self.arrived).zip(&self.added) {
            *error = moved_both::<L, B>(arrived, 1.0, added);
        }
        let whole = size::<L, B>(&self.error, h, length);
        self.kept.state.copy_from_slice(&series.state);
        let mut s = 1.0;
        let negligible = (LEFT_OVER * whole * length).sqrt().max(NEAR * length);
        if !self.close(series, s, negligible) && DISTURBANCE * length < whole {
            s = DISTURBANCE * length / whole;
            self.close(series, s, NEAR * length);
        }
        series.call(Part::Correct(1));
        self.kept.changed.copy_from_slice(&series.state);
        series.state.copy_from_slice(&self.kept.state);
        series.call(Part::Settle);
        for (b, (here, there)) in self.kept.state.iter().zip(&self.kept.changed).enumerate() {
            let difference = moved_both::<L, B>(here, -1.0, there);
            self.error[b] = moved_both::<L, B>(&[B::zero(); 2], 1.0 / s, &difference);
        }
    }

    /// Moves to x − s e and corrects the positions there. Returns whether Newton's method converges, or need not: a correction is
    /// negligible, m.
    fn close(&self, series: &mut Series<L, B>, s: f64, negligible: f64) -> bool {
        for ((state, here), error) in series.state.iter_mut().zip(&self.kept.state).zip(&self.error) {
            *state = moved_both::<L, B>(here, -s, error);
        }
        let first = series.call(Part::Correct(0));
        first < negligible || series.call(Part::Correct(0)) < CONVERGES * first
    }
}
