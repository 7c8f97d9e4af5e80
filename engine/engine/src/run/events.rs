//! Events of a run: when the numbers that its scene names pass their values, found on the dense output of the
//! integrator — THEORY section 10.
//!
//! A step is looked at in parts. A part in which the number changes sides holds a root; one in which it turns back
//! towards the value may hold two. Roots are found by Newton's method, kept within the part by bisection.

use super::Simulation;
use serde::Serialize;
use std::sync::Arc;
use triad_dynamics::system::event::EventFunction;

/// Number of equal parts of a step that are searched for a passing.
const PARTS: u32 = 12;
/// A start nearer to the value than this, relative to its size, does not pass it by leaving.
const AT_VALUE: f64 = 1e-10;
/// Greatest number of iterations for a root: bisection alone would need 60.
const MAX_ITERATIONS: u32 = 80;

/// An event that has happened.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EventOccurrence {
    /// Name of the event.
    pub name: String,
    /// When, s.
    pub time: f64,
    /// Rate of the number there, m/s or rad/s.
    pub rate: f64,
    /// Whether the run ends there.
    pub stop: bool,
}

impl Simulation {
    /// Events up to the shown time, in the order of time.
    pub fn events(&self) -> &[EventOccurrence] {
        let count = self.happened.partition_point(|event| event.time <= self.time());
        &self.happened[..count]
    }

    /// Forgets what has happened, and counts from the start of the integrator, at which the current state is, on.
    pub(super) fn restart_events(&mut self) {
        self.happened.clear();
        self.end = self.duration();
        let Self { mechanism, shown, last_numbers, .. } = self;
        last_numbers.clear();
        last_numbers.extend(mechanism.system.event_functions.iter().map(|function| {
            let mut number = function.evaluate(shown.state());
            if number[0].abs() < AT_VALUE * (1.0 + function.value.abs()) {
                number[0] = 0.0;
            }
            number
        }));
    }

    /// Finds what has happened in the last step.
    pub(super) fn look_for_events(&mut self) {
        if self.mechanism.system.event_functions.is_empty() {
            return;
        }
        let Self { mechanism, integrator, scratch, happened, last_numbers, .. } = self;
        let (before, end) = (happened.len(), integrator.last().t);
        let step = (end - integrator.last().h, end);
        let functions = Arc::clone(&mechanism.system.event_functions);
        let y = &mut scratch[..integrator.last().y.len()];
        let see = |t: f64, function: &EventFunction| {
            integrator.interpolate(mechanism, t, y);
            mechanism.set_state(t, y);
            function.evaluate(&mechanism.state)
        };
        find(&functions, last_numbers, step, see, happened);
        if let Some(last) = happened[before..].iter().position(|event| event.stop) {
            happened.truncate(before + last + 1);
            self.end = happened[before + last].time;
        }
    }
}

/// Finds what happens in the step from `start` to `end`, in the order of time. `see(t, function)` puts the state of time t in
/// place and looks.
fn find(
    functions: &[EventFunction],
    last: &mut [[f64; 2]],
    (start, end): (f64, f64),
    mut see: impl FnMut(f64, &EventFunction) -> [f64; 2],
    happened: &mut Vec<EventOccurrence>,
) {
    let first = happened.len();
    let mut from = start;
    for part in 1..=PARTS {
        let to = if part == PARTS { end } else { start + (end - start) * f64::from(part) / f64::from(PARTS) };
        for (function, last) in functions.iter().zip(&mut *last) {
            let now = see(to, function);
            let before = std::mem::replace(last, now);
            passings(function, (from, before), (to, now), &mut see, happened);
        }
        from = to;
    }
    happened[first..].sort_by(|a, b| a.time.total_cmp(&b.time));
}

/// Adds the passings of one event within a part of a step.
fn passings(
    function: &EventFunction,
    (from, before): (f64, [f64; 2]),
    (to, now): (f64, [f64; 2]),
    see: &mut impl FnMut(f64, &EventFunction) -> [f64; 2],
    happened: &mut Vec<EventOccurrence>,
) {
    let (side, other) = (before[0], now[0]);
    // A number that starts on the value has not passed it.
    if side == 0.0 {
        return;
    }
    let mut ends = [Some((from, to, side)), None];
    if side * other > 0.0 {
        // Towards the value and back again: it may have been passed twice.
        if side * before[1] >= 0.0 || side * now[1] <= 0.0 {
            return;
        }
        let turn = root((from, to, before[1]), |t| [see(t, function)[1], f64::NAN]);
        let there = see(turn, function)[0];
        if side * there > 0.0 {
            return;
        }
        ends = [Some((from, turn, side)), Some((turn, to, there))];
    }
    for (from, to, side) in ends.into_iter().flatten() {
        let rising = side < 0.0;
        if side == 0.0 || !function.wants(rising) {
            continue;
        }
        let time = root((from, to, side), |t| see(t, function));
        let rate = see(time, function)[1];
        happened.push(EventOccurrence { name: function.name.clone(), time, rate, stop: function.stop });
    }
}

/// The zero between two times of a function with its slope (or NaN), of the given sign at the first.
fn root((mut low, mut high, side): (f64, f64, f64), mut of: impl FnMut(f64) -> [f64; 2]) -> f64 {
    let mut t = 0.5 * (low + high);
    for _ in 0..MAX_ITERATIONS {
        let [value, slope] = of(t);
        if value * side > 0.0 {
            low = t;
        } else {
            high = t;
        }
        let newton = t - value / slope;
        // A comparison that is false for NaN as well.
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if value == 0.0 || (next - t).abs() <= f64::EPSILON * t.abs() {
            break;
        }
        t = next;
    }
    t
}
