//! The error of a motion, carried along with it — eqs. (11.10) and (11.11).
//!
//! Beside the motion x goes the motion without its error, z = x − e, written as that difference. The series about z need
//! fewer terms than those about x, because only their difference counts. What a step itself adds is told by its last terms, and by the
//! accelerations at its end, where its polynomials miss those of the equations by a known multiple.

mod differences;

mod energy;
mod tail;

use super::step::Part;
use super::{Bodies, Series};
use crate::newton::Projectable;
use crate::system::System;
use differences::{Between, Differ, Missed, Size, Within, moved, moved_both, value};
use energy::Energy;
use std::mem::swap;
use tail::Tail;
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
/// The series of an error are long enough where two successive terms are below this part of what the last step added to it. What is
/// left out adds up like that: more would be another error, which grows with the time as that does.
const UNFINISHED: f64 = 0.1;
/// Where what the steps add cancels on the whole, what is left out may not: the error of a fast vibration would fade as much as it
/// grows. There series end by what the error has grown in each step so far, but by no less than this part of what the last step added.
const CANCELLED: f64 = 0.1;
/// The fewest terms.
const FEWEST: usize = 3;

/// The error of the motion, and how it changes within the last step.
#[derive(Clone, Debug)]
pub(super) struct Transport<const L: usize, B: Bodies<L>> {
    /// A copy that is expanded about the state without its error.
    twin: Series<L, B>,
    /// Error of positions and velocities at the end of the last step, and its size there and at the start.
    error: Vec<[B::Natural; 2]>,
    size: Size,
    size_before: Size,
    /// Coefficients of what the last step has carried, as many for each bundle as the twin keeps, and their sizes.
    carried: Vec<B::Natural>,
    terms: Vec<f64>,
    /// What that is at the end of the step.
    arrived: Vec<[B::Natural; 2]>,
    /// The highest order of these, and whether more would be asked for than the step has.
    order: usize,
    unfinished: bool,
    /// If so, half the accelerations of the motion without its error at the end of the step.
    beside: Vec<B::Natural>,
    /// How the terms of the last step go on, and what it adds to that at its end besides, before it is moved onto the constraints: states
    /// within the step are not.
    tail: Tail,
    added: Vec<[B::Natural; 2]>,
    /// What that is worth, m, and what the whole error is there, after so many steps.
    worth: f64,
    grown: f64,
    steps: f64,
    /// The order and size, s, of the last step.
    step: (usize, f64),
    /// Positions at which S was factored last, and those at which it was for the last step.
    factored: [Vec<B::Natural>; 2],
    /// Solutions that the evaluation at the end of the step took, as long as the twin has it and the next step can begin with it.
    evaluated: Option<u64>,
    /// What the energy is, where it stays that.
    energy: Option<Energy<L, B>>,
    /// When the error became too large to be carried, s.
    lost: Option<f64>,
}

impl<const L: usize, B: Bodies<L>> Series<L, B> {
    /// From now on carries the error along.
    pub fn carry_errors(&mut self, system: &System) {
        self.transport = Some(Box::new(Transport::new(system, self)));
    }

    /// When the error became too large to be carried, s.
    pub fn error_lost(&self) -> Option<f64> {
        self.transport.as_ref().and_then(|transport| transport.lost)
    }

    /// Adds what the step of size h from `start`, cut at order `order`, does to the error. At a breakpoint of a prescribed
    /// function accelerations jump: those before it tell of the step. `again` is whether it is a part of the step that was taken back.
    pub(super) fn carry_over(
        &mut self,
        start: f64,
        h: f64,
        order: usize,
        length: f64,
        at_break: bool,
        again: bool,
    ) {
        let Some(mut transport) = self.transport.take() else { return };
        if transport.lost.is_none() {
            transport.step = (order, h);
            if again {
                transport.carry_again();
            } else {
                transport.carry(self, start, length);
            }
            transport.add_local(self, length, at_break);
            transport.lost = (!transport.is_small(length)).then_some(start);
            transport.start_here();
        }
        self.transport = Some(transport);
    }

    /// Takes over accelerations and multipliers at the state as terms of order 0, if the error of the last step took them.
    #[inline(always)]
    pub(super) fn recall_evaluation(&mut self) -> bool {
        let Some(transport) = &mut self.transport else { return false };
        let Some(solves) = transport.evaluated.take() else { return false };
        let twin = &transport.twin;
        for b in 0..self.bundles.len() {
            self.q[b * self.stride + 2] = twin.q[b * self.stride + 2];
            self.p[b * self.stride] = twin.p[b * self.stride];
        }
        if let (Some(regularization), Some(of_twin)) = (&mut self.regularization, &twin.regularization) {
            regularization.recall(of_twin, self.stride);
        }
        self.sizes[2] = twin.sizes[2];
        let rows = self.correction.len();
        self.lambda[..rows].copy_from_slice(&twin.lambda[..rows]);
        self.counters.solves += solves;
        true
    }

    /// Writes the error of (q, q̇) a time τ after the start of the last step, if it is known.
    pub fn error(&self, system: &System, tau: f64, out: &mut [f64]) -> bool {
        let Some(transport) = self.transport.as_ref().filter(|transport| transport.lost.is_none()) else {
            return false;
        };
        let (order, h) = transport.step;
        let part: f64 = if h > 0.0 { (tau / h).clamp(0.0, 1.0) } else { 1.0 };
        let weight = (0..order).fold(1.0, |power, _| power * part);
        let left_out = transport.tail.after(part);
        for b in 0..self.bundles.len() {
            let state = if part < 1.0 {
                let at = b * self.stride + order;
                self.instructions.dispatch(Within {
                    transport,
                    b,
                    tau,
                    weights: [weight * part, weight],
                    last: [&self.q[at], &self.q[at - 1]],
                    left_out,
                })
            } else {
                transport.error[b]
            };
            self.store_error(system, b, &state, out);
        }
        true
    }
}

impl<const L: usize, B: Bodies<L>> Transport<L, B> {
    fn new(system: &System, series: &Series<L, B>) -> Self {
        let count = series.bundles.len();
        let nothing = vec![[B::ZERO; 2]; count];
        let positions: Vec<B::Natural> = series.state.iter().map(|state| state[0]).collect();
        let mut twin = Series { probe: None, ..series.clone() };
        let energy = Energy::of(system, &mut twin);
        Self {
            twin,
            error: nothing.clone(),
            size: Size::default(),
            size_before: Size::default(),
            carried: vec![B::ZERO; count * series.stride],
            terms: vec![0.0; series.stride],
            arrived: nothing.clone(),
            order: 0,
            unfinished: false,
            beside: vec![B::ZERO; count],
            tail: Tail::default(),
            added: nothing,
            worth: 0.0,
            grown: 0.0,
            steps: 0.0,
            step: (0, 0.0),
            factored: [positions.clone(), positions],
            evaluated: None,
            energy,
            lost: None,
        }
    }

    /// Goes back to the start t of the last step, with the error that the motion had there.
    pub fn go_back(&mut self, t: f64) {
        for b in 0..self.error.len() {
            self.error[b] = self.at(b, 0.0);
            self.added[b] = [B::ZERO; 2];
        }
        self.size = self.size_before;
        self.step.1 = 0.0;
        self.evaluated = None;
        self.lost = self.lost.filter(|lost| *lost < t);
    }

    /// What the last two terms of the error are to be below, m.
    fn enough(&self) -> f64 {
        UNFINISHED * (self.grown / self.steps).min(self.worth).max(CANCELLED * self.worth)
    }

    /// Whether rows that hardly hold are kept.
    pub fn set_resolving(&mut self, resolving: bool) {
        self.twin.set_resolving(resolving);
        self.evaluated = None;
    }

    /// Takes note of that the next step begins with S as it was factored last.
    pub fn start_here(&mut self) {
        let [last, used] = &mut self.factored;
        used.copy_from_slice(last);
    }

    /// Takes note of where S is factored.
    pub fn note_factored(&mut self, state: &[[B::Natural; 2]]) {
        for (own, state) in self.factored[0].iter_mut().zip(state) {
            *own = state[0];
        }
        self.evaluated = None;
    }

    fn is_small(&self, length: f64) -> bool {
        self.size.after(self.step.1, length) < LOST * length
    }

    /// What the last step has carried up to τ, of bundle b.
    #[inline(always)]
    fn at(&self, b: usize, tau: f64) -> [B::Natural; 2] {
        let first = b * self.twin.stride;
        value::<L, B>(&self.carried[first..=first + self.order], tau)
    }

    /// Carries the error over the step: the difference of the series about x and about x − e, with as many terms as it asks for: of
    /// stiff mechanisms the motion may be smooth and its error not.
    fn carry(&mut self, series: &Series<L, B>, start: f64, length: f64) {
        self.size_before = self.size;
        let before = self.size.after(self.step.1, length);
        if self.twin.time.to_bits() != start.to_bits() {
            self.twin.set_time(start);
        }
        self.place(series, 1.0);
        self.twin.linearize();
        if let Some(time) = self.go_beyond(series) {
            self.turn_round(series, time);
        }
        let after = self.differ(series, 1.0, length);
        self.twin.loads.stay();
        let grows = after.is_nan() || after > GROWTH * before.max(NEAR * length);
        if grows && before > DISTURBANCE * length && (self.last_terms() > DIVERGES * after || after.is_nan())
        {
            self.carry_part(series, DISTURBANCE * length / before, length);
            self.unfinished = false;
        }
    }

    /// When points of springs pass each other in the motion without its error, within the step, s.
    fn go_beyond(&mut self, series: &Series<L, B>) -> Option<f64> {
        let Series { loads, values, .. } = &mut self.twin;
        loads.go_beyond(&series.loads, self.step.1, values)
    }

    /// Lets points of springs pass each other in the motion without its error at the start of the step, and not a little later: what the
    /// forces do until they turn round, it does at once.
    fn turn_round(&mut self, series: &Series<L, B>, later: f64) {
        self.twin.evaluate_here();
        for (beyond, q) in self.beside.iter_mut().zip(self.twin.q.chunks(self.twin.stride)) {
            *beyond = q[2];
        }
        self.twin.loads.stay();
        self.twin.evaluate_here();
        let here = self.twin.q.chunks(self.twin.stride);
        for ((error, q), beyond) in self.error.iter_mut().zip(here).zip(&self.beside) {
            // Coefficients of order two are halves of accelerations.
            let less = moved::<L, B>(&error[1], -2.0 * later, &q[2]);
            error[1] = moved::<L, B>(&less, 2.0 * later, beyond);
        }
        self.place(series, 1.0);
        self.twin.linearize();
        self.go_beyond(series);
    }

    /// Carries it over a part of the last step, by what was found of it.
    fn carry_again(&mut self) {
        for b in 0..self.arrived.len() {
            self.arrived[b] = self.at(b, self.step.1);
        }
        self.unfinished &= self.last_terms() > self.enough();
    }

    /// Carries a part of the error. The whole error sees that S is not factored exactly at x; for a part of it S is disturbed likewise,
    /// and that effect stays out.
    fn carry_part(&mut self, series: &Series<L, B>, s: f64, length: f64) {
        let Self { twin, error, .. } = self;
        for ((state, error), factored) in twin.state.iter_mut().zip(&*error).zip(&self.factored[1]) {
            state[0] = moved::<L, B>(factored, -s, &error[0]);
        }
        twin.linearize();
        self.place(series, s);
        self.twin.call(Part::Settle);
        self.differ(series, s, length);
    }

    /// Size of the last two terms of what is carried, at the end of the step.
    fn last_terms(&self) -> f64 {
        let power = (1..self.order).fold(1.0, |power, _| power * self.step.1);
        power * larger(self.step.1 * self.terms[self.order], self.terms[self.order - 1])
    }

    /// Puts the twin at x − s e, at the start of the step.
    fn place(&mut self, series: &Series<L, B>, s: f64) {
        let Self { twin, error, .. } = self;
        let stride = twin.stride;
        for (own, angle) in twin.angles.list.iter_mut().zip(&series.angles.list) {
            own.state.reference = angle.theta[0];
        }
        for (b, (state, error)) in twin.state.iter_mut().zip(&*error).enumerate() {
            *state = moved_both::<L, B>(&[series.q[b * stride], series.q[b * stride + 1]], -s, error);
        }
    }

    /// Expands the twin where it is, and takes the s-th part of the difference of the series. Returns what it is worth at the end of the
    /// step. It is looked at from one order less on than in the step before.
    fn differ(&mut self, series: &Series<L, B>, s: f64, length: f64) -> f64 {
        let (most, h) = self.step;
        let enough = self.enough();
        let Self { twin, carried, arrived, terms, order, .. } = self;
        let fewest = order.saturating_sub(1).max(FEWEST).min(most);
        let orders = [fewest, most];
        let differ =
            Differ::<L, B> { of: &series.q, twin, orders, s, h, length, enough, carried, terms, arrived };
        let after;
        (*order, after, self.unfinished) = series.instructions.dispatch(differ);
        after
    }

    /// Finds the error that the step itself makes, and makes the error at its end one that the constraints allow. With terms up to order
    /// p, the accelerations there are off by p (p + 1) / h² times the error of the positions. At a breakpoint of a prescribed function
    /// accelerations jump: those before it tell of the step.
    fn add_local(&mut self, series: &mut Series<L, B>, length: f64, at_break: bool) {
        let twin = &mut self.twin;
        twin.set_time(if at_break { series.time.next_down() } else { series.time });
        for (own, angle) in twin.angles.list.iter_mut().zip(&series.angles.list) {
            own.state.reference = angle.state.reference;
        }
        if self.unfinished {
            self.evaluate_beside(series);
        }
        self.share(series);
        let twin = &mut self.twin;
        twin.state.copy_from_slice(&series.state);
        let solves = twin.counters.solves;
        twin.evaluate_here();
        // Rows that are not linear, loads, and bodies alone keep more of it than that.
        self.evaluated =
            (!at_break && !twin.needs_values && !twin.is_bare()).then_some(twin.counters.solves - solves);
        let (step, arrived) = (self.step, &self.arrived);
        // Prescribed functions are mostly entire, and their terms fall otherwise.
        let is_own = !series.prescribed_goes_on(step.1, FEWEST, 0.0);
        let missed = Missed::<L, B> {
            series: &series.q,
            is_own,
            twin,
            step,
            arrived,
            beside: self.unfinished.then_some([&self.carried[..], &self.beside]),
            added: &mut self.added,
            error: &mut self.error,
        };
        let (tail, [size, added]) = series.instructions.dispatch(missed);
        self.tail = tail;
        self.worth = added.after(step.1, length);
        self.grown = size.after(step.1, length);
        self.steps += 1.0;
        if at_break {
            self.twin.set_time(series.time);
        }
        self.project(series, size.after(step.1, length), length);
        self.share(series);
    }

    /// Accelerations of the motion without its error at the end of the step: what its series miss there tells of all terms that are left
    /// out, those of the error with them.
    fn evaluate_beside(&mut self, series: &Series<L, B>) {
        let Self { twin, arrived, beside, .. } = self;
        for ((state, here), arrived) in twin.state.iter_mut().zip(&series.state).zip(&*arrived) {
            *state = moved_both::<L, B>(here, -1.0, arrived);
        }
        twin.linearize();
        twin.evaluate_here();
        for (beside, q) in beside.iter_mut().zip(twin.q.chunks(twin.stride)) {
            *beside = q[2];
        }
    }

    /// Lends the twin what belongs to the end of the step, or gives it back.
    fn share(&mut self, series: &mut Series<L, B>) {
        let twin = &mut self.twin;
        swap(&mut twin.bundles, &mut series.bundles);
        swap(&mut twin.schur, &mut series.schur);
        swap(&mut twin.regularized, &mut series.regularized);
        swap(&mut twin.pivots, &mut series.pivots);
        for (own, common) in twin.rows.commons.iter_mut().zip(&mut series.rows.commons) {
            swap(&mut own.across, &mut common.across);
        }
    }

    /// Moves x − e onto the constraints, where e is worth `whole`.
    fn project(&mut self, series: &Series<L, B>, whole: f64, length: f64) {
        let mut s = 1.0;
        // What is left is magnified likewise.
        let negligible =
            (LEFT_OVER * whole * length).sqrt().max(NEAR * length) / series.magnified(self.step.1).sqrt();
        if !self.close(series, s, negligible) && DISTURBANCE * length < whole {
            s = DISTURBANCE * length / whole;
            self.close(series, s, NEAR * length);
        }
        self.twin.call(Part::Correct(1));
        let Self { twin, error, energy, .. } = self;
        if let Some(energy) = energy {
            energy.give(twin, &series.state, s, self.step.1, error);
        }
        self.size = series.instructions.dispatch(Between::<L, B> {
            here: &series.state,
            there: &twin.state,
            s,
            out: error,
        });
    }

    /// Moves to x − s e and corrects the positions there. Returns whether Newton's method converges, or need not: a correction is
    /// negligible, m.
    fn close(&mut self, series: &Series<L, B>, s: f64, negligible: f64) -> bool {
        let Self { twin, error, .. } = self;
        for ((state, here), error) in twin.state.iter_mut().zip(&series.state).zip(&*error) {
            *state = moved_both::<L, B>(here, -s, error);
        }
        let first = twin.call(Part::Correct(0));
        first < negligible || twin.call(Part::Correct(0)) < CONVERGES * first
    }
}
