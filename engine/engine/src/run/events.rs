//! Events of a run: the times at which quantities that the scene names pass given values, found on the dense output of
//! the integrator — THEORY section 10.
//!
//! A step is searched in parts. A part over which the difference from the value changes sign contains a root; one over
//! which the quantity turns back towards the value may contain two. Roots are found by Newton's method, safeguarded by
//! bisection. A quantity that is nearer to the value than rounding tells is still on the side from which it came: one that rests on
//! the value passes nothing.

use super::Simulation;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use triad_dynamics::state::{BodyFrame, State};
use triad_dynamics::system::event::EventFunction;

/// Number of equal parts of a step that are searched for roots, and of each half turn of a body that turns farther in the step.
const PARTS: u32 = 12;
/// Greatest number of parts of a step.
const MAX_PARTS: u32 = 20_000;
/// A quantity that is nearer to the value than this, relative to the value's size, counts as being on it.
const AT_VALUE: f64 = 1e-10;
/// Events that are nearer to each other than this part of the time happen at once.
const AT_ONCE: f64 = 4.0 * f64::EPSILON;
/// Greatest number of iterations for a root: bisection alone would need 60.
const MAX_ITERATIONS: u32 = 80;

/// An event that has happened.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EventOccurrence {
    /// Name of the event.
    pub name: String,
    /// Time, s.
    pub time: f64,
    /// How far the time may be off by the estimate of the run, s: none where that is not known, and where the quantity hardly changes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
    /// Rate of the quantity there, m/s or rad/s.
    pub rate: f64,
    /// Whether the run ends there.
    pub stop: bool,
}

impl Simulation {
    /// Events up to the current time, in the order of time.
    pub fn events(&self) -> &[EventOccurrence] {
        let count = self.occurrences.partition_point(|event| event.time <= self.time());
        &self.occurrences[..count]
    }

    /// Forgets all events and begins again at the current state, where the integrator has just been started.
    pub(super) fn restart_events(&mut self) {
        self.occurrences.clear();
        self.judged_events = 0;
        self.end = self.duration();
        let Self { mechanism, current, last_numbers, .. } = self;
        last_numbers.clear();
        last_numbers.extend(mechanism.system.event_functions.iter().map(|function| {
            let mut number = function.evaluate(current.state(&mechanism.system));
            if is_at_value(number, function) {
                number[0] = 0.0;
            }
            number
        }));
    }

    /// Estimates how far the times of events in the last step up to time t are off: by what quantities are off there, at least by rounding, over
    /// their rates.
    pub(super) fn judge_events(&mut self, t: f64) {
        let Self { mechanism, integrator, companion, occurrences, judged_events, .. } = self;
        while let Some(event) = occurrences.get_mut(*judged_events).filter(|event| event.time <= t) {
            *judged_events += 1;
            let functions = Arc::clone(&mechanism.system.event_functions);
            let Some(function) = functions.iter().find(|function| function.name == event.name) else {
                continue;
            };
            let (time, mut y) = (event.time, integrator.last().y.clone());
            let mut error = vec![0.0; y.len()];
            integrator.interpolate(mechanism, time, &mut y);
            let known = match companion {
                Some(companion) => {
                    companion.compare(time, &y, integrator);
                    companion.error(time, &y, &mut error)
                }
                None => integrator.error(&mechanism.system, time, &mut error),
            };
            if !known {
                continue;
            }
            let mut quantity = |y: &[f64]| {
                mechanism.set_state(time, y);
                function.evaluate(&mechanism.state)[0]
            };
            let here = quantity(&y);
            y.iter_mut().zip(&error).for_each(|(y, error)| *y -= error);
            let there = quantity(&y);
            let rounding = function.rounding(mechanism.system.length);
            let off = (here - there).abs().max(rounding) / event.rate.abs();
            event.error = Some(off.max(f64::EPSILON * time)).filter(|off| off.is_finite());
        }
    }

    /// Finds the events of the last step.
    pub(super) fn find_events(&mut self) {
        if self.mechanism.system.event_functions.is_empty() {
            return;
        }
        let Self { mechanism, integrator, scratch, occurrences, last_numbers, .. } = self;
        let (before, end) = (occurrences.len(), integrator.last().t);
        let step = (end - integrator.last().h, end);
        let whole = end >= mechanism.system.model.settings.duration;
        let functions = Arc::clone(&mechanism.system.event_functions);
        let y = &mut scratch[..integrator.last().y.len()];
        let mut fastest = 0.0_f64;
        for t in [step.0, step.1] {
            integrator.interpolate(mechanism, t, y);
            mechanism.set_state(t, y);
            fastest = fastest.max(fastest_turning(&mechanism.state));
        }
        let evaluate = |t: f64, function: &EventFunction| {
            integrator.interpolate(mechanism, t, y);
            mechanism.set_state(t, y);
            function.evaluate(&mechanism.state)
        };
        let parts = parts_of(fastest * (step.1 - step.0));
        find(&functions, last_numbers, (step, parts), evaluate, occurrences);
        if whole {
            find_at_end(&functions, last_numbers, step, occurrences);
        }
        if let Some(end) = occurrences[before..].iter().find(|event| event.stop).map(|event| event.time) {
            let found = &mut occurrences[before..];
            let kept = found.partition_point(|event| event.time <= end + AT_ONCE * end.abs());
            found[..kept].iter_mut().for_each(|event| event.time = event.time.min(end));
            occurrences.truncate(before + kept);
            self.end = end;
        }
    }
}

/// The largest angular velocity of a body, rad/s.
fn fastest_turning(state: &State) -> f64 {
    let turning = state.bodies().iter().map(|body| {
        let frame = BodyFrame::from(body);
        Vector3::from(frame.angular_velocity).norm()
    });
    turning.fold(0.0, f64::max)
}

/// Into how many parts a step is divided in which a body turns by `angle`: a method in coordinates of joints takes many turns at once.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "it is clamped; NaN, of a run that is lost, gives none"
)]
fn parts_of(angle: f64) -> u32 {
    let wanted = f64::from(PARTS) * (angle / std::f64::consts::PI).ceil().max(1.0);
    wanted.clamp(f64::from(PARTS), f64::from(MAX_PARTS)) as u32
}

/// Finds the events of the step from `start` to `end`, in the order of time, in so many parts. `evaluate(t, function)` gives the value and the
/// rate of a function at time t.
fn find(
    functions: &[EventFunction],
    last: &mut [[f64; 2]],
    ((start, end), parts): ((f64, f64), u32),
    mut evaluate: impl FnMut(f64, &EventFunction) -> [f64; 2],
    occurrences: &mut Vec<EventOccurrence>,
) {
    let first = occurrences.len();
    let mut from = start;
    for part in 1..=parts {
        let to = if part == parts { end } else { start + (end - start) * f64::from(part) / f64::from(parts) };
        for (function, last) in functions.iter().zip(&mut *last) {
            let mut now = evaluate(to, function);
            if is_at_value(now, function) {
                now[0] = nearly(last[0], function);
            }
            let before = std::mem::replace(last, now);
            find_in_part(function, (from, before), (to, now), &mut evaluate, occurrences);
        }
        from = to;
    }
    occurrences[first..].sort_by(|a, b| a.time.total_cmp(&b.time));
}

/// Distance from the value below which a quantity is on it.
fn band(function: &EventFunction) -> f64 {
    AT_VALUE * (1.0 + function.value.abs())
}

fn is_at_value(number: [f64; 2], function: &EventFunction) -> bool {
    number[0].abs() < band(function)
}

/// The difference that stands for a quantity on the value which came from this side; zero if it has been there since the start.
fn nearly(side: f64, function: &EventFunction) -> f64 {
    if side == 0.0 { 0.0 } else { band(function).copysign(side) }
}

/// Adds what arrives at its value, and would pass it, as the run ends.
fn find_at_end(
    functions: &[EventFunction],
    last: &mut [[f64; 2]],
    (start, end): (f64, f64),
    occurrences: &mut Vec<EventOccurrence>,
) {
    for (function, [side, rate]) in functions.iter().zip(last) {
        let passes = *side * *rate < 0.0 && rate.abs() * (end - start) > band(function);
        if *side == nearly(*side, function) && passes && function.wants(*side < 0.0) {
            *side = -*side;
            occurrences.push(EventOccurrence {
                name: function.name.clone(),
                time: end,
                error: None,
                rate: *rate,
                stop: function.stop,
            });
        }
    }
}

/// Adds the occurrences of one event within a part of a step.
fn find_in_part(
    function: &EventFunction,
    (from, before): (f64, [f64; 2]),
    (to, now): (f64, [f64; 2]),
    evaluate: &mut impl FnMut(f64, &EventFunction) -> [f64; 2],
    occurrences: &mut Vec<EventOccurrence>,
) {
    let (side, other) = (before[0], now[0]);
    // A quantity that starts on the value does not pass it by leaving.
    if side == 0.0 {
        return;
    }
    let mut ends = [Some((from, to, side)), None];
    if side * other > 0.0 {
        // Towards the value and back again: it may have been passed twice.
        if side * before[1] >= 0.0 || side * now[1] <= 0.0 {
            return;
        }
        let turn = root((from, to, before[1]), |t| [evaluate(t, function)[1], f64::NAN]);
        let there = evaluate(turn, function)[0];
        // One that only touches it has not.
        if side.signum() * there > -band(function) {
            return;
        }
        ends = [Some((from, turn, side)), Some((turn, to, there))];
    }
    for (from, to, side) in ends.into_iter().flatten() {
        let rising = side < 0.0;
        if side == 0.0 || !function.wants(rising) {
            continue;
        }
        let time = root((from, to, side), |t| evaluate(t, function));
        let rate = evaluate(time, function)[1];
        let (name, stop) = (function.name.clone(), function.stop);
        occurrences.push(EventOccurrence { name, time, error: None, rate, stop });
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
