//! Moments at which a number of the mechanism passes a value, found on the dense output of the integrator — THEORY
//! section 10.
//!
//! A step is looked at in parts. A part in which the number changes sides holds a root; one in which it turns back
//! towards the value may hold two. Roots are found by Newton's method, kept within the part by bisection.

use crate::elimination::Elimination;
use crate::model::{BodyRef, EventQuantity, Model, ModelEvent};
use crate::scene::Passing;
use crate::writer::Writer;
use nalgebra::Vector3;
use serde::Serialize;

/// Parts in which a step is looked at.
const PARTS: u32 = 12;
/// A start nearer to the value than this, relative to its size, does not pass it by leaving.
const AT_VALUE: f64 = 1e-10;
/// Iterations of a root: bisection alone would need 60.
const MOST_ITERATIONS: u32 = 80;

/// An event that has happened.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Happening {
    /// Name of the event.
    pub name: String,
    /// When, s.
    pub time: f64,
    /// Rate of the number there, m/s or rad/s.
    pub rate: f64,
    /// Whether the run ends there.
    pub stop: bool,
}

/// What an event looks at, in terms of the system.
#[derive(Clone, Debug)]
enum Number {
    Coordinate { point: Spot, direction: Vector3<f64> },
    Distance([Spot; 2]),
    Angle(usize),
    Slide { axis: Spot, points: [Spot; 2] },
}

/// A point or vector of a body or of the ground.
#[derive(Clone, Copy, Debug)]
struct Spot {
    body: BodyRef,
    local: Vector3<f64>,
}

impl Spot {
    /// Position and velocity of the point.
    fn point(&self, at: &Elimination) -> [Vector3<f64>; 2] {
        match self.body {
            BodyRef::Ground => [self.local, Vector3::zeros()],
            BodyRef::Moving(body) => {
                let body = &at.bodies[body];
                [body.q.r + body.q.arm(&self.local), body.q_dot.r + body.q_dot.arm(&self.local)]
            }
        }
    }

    /// The vector and its rate.
    fn vector(&self, at: &Elimination) -> [Vector3<f64>; 2] {
        match self.body {
            BodyRef::Ground => [self.local, Vector3::zeros()],
            BodyRef::Moving(body) => {
                let body = &at.bodies[body];
                [body.q.arm(&self.local), body.q_dot.arm(&self.local)]
            }
        }
    }
}

/// An event with the last number seen.
#[derive(Clone, Debug)]
pub struct Watch {
    name: String,
    number: Number,
    value: f64,
    passing: Passing,
    stop: bool,
    /// Number less value, and its rate, where the last part ended.
    last: [f64; 2],
}

impl Watch {
    /// Of a checked event; angles are written into the system.
    pub fn new(model: &Model, event: &ModelEvent, writer: &mut Writer) -> Self {
        let spot = |body, local| Spot { body, local };
        let number = match &event.of {
            EventQuantity::Coordinate { body, local, direction } => {
                Number::Coordinate { point: spot(*body, *local), direction: *direction }
            }
            EventQuantity::Distance { bodies, locals } => {
                Number::Distance([0, 1].map(|side| spot(bodies[side], locals[side])))
            }
            EventQuantity::Angle { joint } => Number::Angle(writer.angle(&model.joints[*joint])),
            EventQuantity::Slide { joint } => {
                let joint = &model.joints[*joint];
                let points = [0, 1].map(|side| spot(joint.bodies[side], joint.points[side]));
                Number::Slide { axis: spot(joint.bodies[0], joint.axes[0]), points }
            }
        };
        Self {
            name: event.name.clone(),
            number,
            value: event.value,
            passing: event.passing,
            stop: event.stop,
            last: [0.0; 2],
        }
    }

    /// Number less value, and its rate; positions and velocities must be in place.
    pub fn look(&self, at: &Elimination) -> [f64; 2] {
        let between = |[i, j]: &[Spot; 2]| {
            let ([a, a_rate], [b, b_rate]) = (i.point(at), j.point(at));
            [b - a, b_rate - a_rate]
        };
        let [number, rate] = match &self.number {
            Number::Coordinate { point, direction } => point.point(at).map(|x| x.dot(direction)),
            Number::Distance(spots) => {
                let [d, d_rate] = between(spots);
                let length = d.norm();
                [length, if length > 0.0 { d.dot(&d_rate) / length } else { d_rate.norm() }]
            }
            Number::Angle(k) => [at.angles[*k].value, at.angles[*k].rate],
            Number::Slide { axis, points } => {
                let ([d, d_rate], [s, s_rate]) = (between(points), axis.vector(at));
                [s.dot(&d), s.dot(&d_rate) + s_rate.dot(&d)]
            }
        };
        [number - self.value, rate]
    }

    /// Takes over the number at the start of a run.
    pub fn begin(&mut self, at: &Elimination) {
        self.last = self.look(at);
        if self.last[0].abs() < AT_VALUE * (1.0 + self.value.abs()) {
            self.last[0] = 0.0;
        }
    }

    fn wants(&self, rising: bool) -> bool {
        match self.passing {
            Passing::Either => true,
            Passing::Upwards => rising,
            Passing::Downwards => !rising,
        }
    }
}

/// Finds what happens in the step from `start` to `end`, in the order of time. `see(t, watch)` puts the state of time t in
/// place and looks.
pub fn find(
    watches: &mut [Watch],
    (start, end): (f64, f64),
    mut see: impl FnMut(f64, &Watch) -> [f64; 2],
    happened: &mut Vec<Happening>,
) {
    let first = happened.len();
    let mut from = start;
    for part in 1..=PARTS {
        let to = if part == PARTS { end } else { start + (end - start) * f64::from(part) / f64::from(PARTS) };
        for watch in &mut *watches {
            let now = see(to, watch);
            let before = std::mem::replace(&mut watch.last, now);
            passages(watch, (from, before), (to, now), &mut see, happened);
        }
        from = to;
    }
    happened[first..].sort_by(|a, b| a.time.total_cmp(&b.time));
}

/// Adds the passages of one event within a part of a step.
fn passages(
    watch: &Watch,
    (from, before): (f64, [f64; 2]),
    (to, now): (f64, [f64; 2]),
    see: &mut impl FnMut(f64, &Watch) -> [f64; 2],
    happened: &mut Vec<Happening>,
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
        let turn = root((from, to, before[1]), |t| [see(t, watch)[1], f64::NAN]);
        let there = see(turn, watch)[0];
        if side * there > 0.0 {
            return;
        }
        ends = [Some((from, turn, side)), Some((turn, to, there))];
    }
    for (from, to, side) in ends.into_iter().flatten() {
        let rising = side < 0.0;
        if side == 0.0 || !watch.wants(rising) {
            continue;
        }
        let time = root((from, to, side), |t| see(t, watch));
        let rate = see(time, watch)[1];
        happened.push(Happening { name: watch.name.clone(), time, rate, stop: watch.stop });
    }
}

/// The zero between two times of a function with its slope (or NaN), of the given sign at the first.
fn root((mut low, mut high, side): (f64, f64, f64), mut of: impl FnMut(f64) -> [f64; 2]) -> f64 {
    let mut t = 0.5 * (low + high);
    for _ in 0..MOST_ITERATIONS {
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
