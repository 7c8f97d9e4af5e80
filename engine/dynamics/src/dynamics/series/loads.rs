//! Loads as series — eq. (11.4), (11.5): forces, moments, and elements along a length, an angle or a displacement.

mod passing;
mod potential;

use super::bodies::{Bodies, LanePlace};
use super::constraints::AngleSeries;
use super::lanes::LaneVector;
use super::recurrence::{
    Quads, Vectors, dot, kept_and_left, product_with_rate, quad, quotient, rate, root, scaled, scaled_quads,
    square, value, vector_value,
};
use crate::model::motion::VectorCurve;
use crate::model::{BodyRef, ForceLaw};
use crate::scene::LoadFrame;
use crate::system::System;
use crate::system::index::FeatureId;
use crate::system::load::SystemLoad;
use nalgebra::Vector3;
use pulp::Simd;

/// Coulomb friction has its full value where the velocity is this many times its smoothing.
const SATURATED: f64 = 20.0;
/// Part of the distance to the nearest pole of tanh that a step may go.
const NEAR_POLE: f64 = 0.4;
/// Part of the distance to the nearest singularity of a prescribed force, in complex time, that a step may go where that matters: farther
/// on, terms that are left out hardly fall, and the first of them says little of their sum.
const NEAR_SINGULAR: f64 = 0.55;
/// Part of the tolerance below which the last terms of a force do not matter.
const SETTLED: f64 = 0.01;
/// Terms over which they are seen to fall.
const FALLING: usize = 4;

/// Bundle and lane of a body.
type Seat = [usize; 2];

/// A load on series.
#[derive(Clone, Debug)]
enum Load {
    /// A force at a point of a body, or a moment on it.
    Given {
        seat: Seat,
        at: Option<Vector3<f64>>,
        curve: VectorCurve,
        body_frame: bool,
        /// It as given, it in the world, and the velocity of its point or the angular velocity.
        local: Vectors,
        world: Vectors,
        speed: Vectors,
    },
    /// Along the line between two points.
    Spring {
        from: LanePlace,
        to: LanePlace,
        between: Vectors,
        square: Vec<f64>,
        over_length: Vec<f64>,
        law: LawSeries,
    },
    /// About the axis of a joint.
    Torsion { angle: usize, axis: LanePlace, seats: [Option<Seat>; 2], direction: Quads, law: LawSeries },
    /// Along the axis of a joint.
    Slider {
        axis: LanePlace,
        ends: [Option<LanePlace>; 2],
        direction: Vectors,
        between: Vectors,
        law: LawSeries,
    },
}

/// −k (x − x₀) − d ẋ + f*(t) − friction, as a series of x.
#[derive(Clone, Debug)]
struct LawSeries {
    law: ForceLaw,
    x: Vec<f64>,
    drive: Vec<f64>,
    /// ẋ over the smoothing of friction, its tanh and 1 − tanh².
    slip: Vec<f64>,
    tanh: Vec<f64>,
    rest: Vec<f64>,
    /// The force, and what of it is not the spring's.
    force: Vec<f64>,
    other: Vec<f64>,
    /// Whether x is a length that has become negative: beyond the moment at which the spring's points pass each other.
    beyond: bool,
}

impl LawSeries {
    fn new(law: &ForceLaw, stride: usize) -> Self {
        let zeros = || vec![0.0; stride];
        Self {
            law: law.clone(),
            x: zeros(),
            drive: zeros(),
            slip: zeros(),
            tanh: zeros(),
            rest: zeros(),
            force: zeros(),
            other: zeros(),
            beyond: false,
        }
    }

    /// The force of order n; x must be known to order n + 1.
    #[inline(always)]
    fn find(&mut self, n: usize) {
        let ForceLaw { stiffness, free, damping, friction, .. } = self.law;
        let speed = rate(&self.x, n);
        let mut other = self.drive[n] - damping * speed;
        if let Some(friction) = friction {
            other -= friction.viscous * speed;
            if friction.coulomb != 0.0 {
                self.slip[n] = speed / friction.smoothing;
                self.set_tanh(n);
                other -= friction.coulomb * self.tanh[n];
            }
        }
        let stretch = if n == 0 { self.x[0] - free } else { self.x[n] };
        self.other[n] = other;
        self.force[n] = other - stiffness * stretch;
    }

    #[inline(always)]
    fn set_tanh(&mut self, n: usize) {
        if n == 0 {
            self.tanh[0] = libm::tanh(self.slip[0]);
            // 1 − tanh² would be rounded to zero too early.
            let cosh = libm::cosh(self.slip[0]);
            self.rest[0] = 1.0 / (cosh * cosh);
            return;
        }
        self.tanh[n] = (1..=n).map(|j| j as f64 * self.slip[j] * self.rest[n - j]).sum::<f64>() / n as f64;
        self.rest[n] = -square(&self.tanh, n);
    }

    /// Whether x is the length of nothing, or of no consequence.
    fn without_direction(&self) -> bool {
        self.x[0].abs() < f64::MIN_POSITIVE || !self.law.is_directed()
    }

    fn expand(&mut self, t: f64) {
        if let Some(drive) = &self.law.drive {
            drive.expand(t, &mut self.drive);
        }
    }

    /// The part of h within which friction is near its series. Far from rest tanh is constant to rounding
    /// and its series cannot foresee that it turns: there a step ends where the velocity comes near rest; within that
    /// range it keeps away from the poles of tanh.
    fn limit(&self, mut h: f64, order: usize) -> f64 {
        if self.law.friction.is_none_or(|f| f.coulomb == 0.0) {
            return h;
        }
        let start = self.slip[0].abs();
        let margin = NEAR_POLE * libm::hypot(start, std::f64::consts::FRAC_PI_2);
        let room = margin.max(start - SATURATED);
        let change = |h: f64| self.slip[1..order - 1].iter().rev().fold(0.0, |sum, c| (sum + c.abs()) * h);
        for _ in 0..60 {
            if change(h) <= room {
                break;
            }
            h *= 0.7;
        }
        h
    }
}

/// All loads, their weight aside.
#[derive(Clone, Debug)]
pub struct Loads {
    list: Vec<Load>,
}

impl Loads {
    /// Of a system, with room for `stride` coefficients.
    pub fn new(system: &System, place: &[LanePlace], lanes: usize, stride: usize) -> Self {
        let seat = |body: usize| [body / lanes, body % lanes];
        let vectors = || vec![Vector3::zeros(); stride];
        let at = |f: FeatureId| place[f.index()];
        let given =
            |body: usize, at: Option<Vector3<f64>>, curve: &VectorCurve, frame: LoadFrame| Load::Given {
                seat: seat(body),
                at,
                curve: curve.clone(),
                body_frame: frame == LoadFrame::Body,
                local: vectors(),
                world: vectors(),
                speed: vectors(),
            };
        let list = system.loads.iter().map(|load| match load {
            SystemLoad::Force { body, local, force, frame } => given(*body, Some(*local), force, *frame),
            SystemLoad::Moment { body, moment, frame } => given(*body, None, moment, *frame),
            SystemLoad::Spring { from, to, law } => Load::Spring {
                from: at(*from),
                to: at(*to),
                between: vectors(),
                square: vec![0.0; stride],
                over_length: vec![0.0; stride],
                law: LawSeries::new(law, stride),
            },
            SystemLoad::Torsion { angle, bodies, law, .. } => Load::Torsion {
                angle: *angle,
                axis: at(system.angles[*angle].axis),
                seats: bodies.map(|body| match body {
                    BodyRef::Ground => None,
                    BodyRef::Moving(body) => Some(seat(body)),
                }),
                direction: vec![[0.0; 4]; stride],
                law: LawSeries::new(law, stride),
            },
            SystemLoad::Slider { axis, between, law } => Load::Slider {
                axis: at(*axis),
                ends: [Some(at(between.plus)), between.minus.map(at)],
                direction: vectors(),
                between: vectors(),
                law: LawSeries::new(law, stride),
            },
        });
        Self { list: list.collect() }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// The first moment after t at which a prescribed force has another piece, s.
    pub fn next_break(&self, t: f64) -> f64 {
        let breaks = self.list.iter().map(|load| match load {
            Load::Given { curve, .. } => curve.next_break(t),
            Load::Spring { law, .. } | Load::Torsion { law, .. } | Load::Slider { law, .. } => {
                law.law.next_break(t)
            }
        });
        breaks.fold(f64::INFINITY, f64::min)
    }

    /// Expands prescribed forces about time t.
    pub fn expand(&mut self, t: f64) {
        for load in &mut self.list {
            match load {
                Load::Given { curve, local, .. } => curve.expand(t, local),
                Load::Spring { law, .. } | Load::Torsion { law, .. } | Load::Slider { law, .. } => {
                    law.expand(t);
                }
            }
        }
    }

    /// Whether prescribed forces are at `time`, h after the point of expansion, what their series say, but for a
    /// relative error.
    pub fn meets(&self, h: f64, time: f64, error: f64) -> bool {
        self.list.iter().all(|load| match load {
            Load::Given { curve, local, .. } => {
                let exact = curve.at(time)[0];
                (exact - vector_value(local, h)).amax() <= error * (1.0 + exact.amax())
            }
            Load::Spring { law, .. } | Load::Torsion { law, .. } | Load::Slider { law, .. } => {
                law.law.drive.as_ref().is_none_or(|drive| {
                    let exact = drive.at(time)[0];
                    (exact - value(&law.drive, h)).abs() <= error * (1.0 + exact.abs())
                })
            }
        })
    }

    /// Whether a part of more than `part` of what a prescribed force does within h is in terms above an order.
    pub fn goes_on(&self, h: f64, order: usize, part: f64) -> bool {
        let goes_on = |[kept, left]: [f64; 2]| left > part * kept;
        self.list.iter().any(|load| match load {
            Load::Given { local, .. } => goes_on(kept_and_left(local.iter().map(Vector3::norm), order, h)),
            Load::Spring { law, .. } | Load::Torsion { law, .. } | Load::Slider { law, .. } => {
                goes_on(kept_and_left(law.drive.iter().map(|x| x.abs()), order, h))
            }
        })
    }

    /// Takes over coefficient m of all features.
    #[inline(always)]
    pub fn store<const L: usize>(&mut self, m: usize, values: &[LaneVector<L>], angles: &[AngleSeries]) {
        for load in &mut self.list {
            match load {
                Load::Given { .. } => {}
                Load::Spring { from, to, between, square, law, .. } => {
                    between[m] = LanePlace::difference([Some(*to), Some(*from)], values);
                    square[m] = dot(between, between, m);
                    law.x[m] = root(square[m], &law.x, m);
                    if m == 0 && law.beyond {
                        law.x[0] = -law.x[0];
                    }
                }
                Load::Torsion { angle, axis, direction, law, .. } => {
                    direction[m] = quad(axis.get(values));
                    law.x[m] = angles[*angle].theta[m];
                }
                Load::Slider { axis, ends, direction, between, law } => {
                    direction[m] = axis.get(values).into();
                    between[m] = LanePlace::difference(*ends, values);
                    law.x[m] = dot(direction, between, m);
                }
            }
        }
    }

    /// Adds the generalized forces of order n; `coefficient(b, i)` is Q_i of bundle b.
    #[inline(always)]
    pub fn apply<'a, S: Simd, const L: usize, B: Bodies<L> + 'a>(
        &mut self,
        simd: S,
        n: usize,
        coefficient: impl Fn(usize, usize) -> &'a B::Natural,
        forces: &mut [LaneVector<L>],
        bundles: &mut [B],
    ) {
        for load in &mut self.list {
            match load {
                Load::Given { seat, at, body_frame, local, world, .. } => {
                    let [bundle, lane] = *seat;
                    world[n] = if *body_frame {
                        (0..=n).map(|i| B::arm(&local[i], coefficient(bundle, n - i), lane, n - i)).sum()
                    } else {
                        local[n]
                    };
                    match at {
                        Some(at) => bundles[bundle].add_force(lane, at, &world[n]),
                        None => bundles[bundle].add_moment(lane, &world[n]),
                    }
                }
                Load::Spring { from, to, between, over_length, law, .. } => {
                    let force = spring_force(n, between, over_length, law);
                    to.add(forces, force.into());
                    from.add(forces, (-force).into());
                }
                Load::Torsion { seats, direction, law, .. } => {
                    law.find(n);
                    let moment = scaled_quads(simd, &law.force, direction, n);
                    for (seat, sign) in seats.iter().zip([-1.0, 1.0]) {
                        if let Some([bundle, lane]) = *seat {
                            bundles[bundle].add_moment(lane, &(moment * sign));
                        }
                    }
                }
                Load::Slider { axis, ends, direction, between, law } => {
                    law.find(n);
                    let force = scaled(&law.force, direction, n);
                    for (place, sign) in ends.iter().zip([1.0, -1.0]) {
                        if let Some(place) = place {
                            place.add(forces, (force * sign).into());
                        }
                    }
                    axis.add(forces, scaled(&law.force, between, n).into());
                }
            }
        }
    }

    /// Power of order n of all that is not a spring; lower orders must have been asked for before.
    #[inline(always)]
    pub fn power<'a, const L: usize, B: Bodies<L> + 'a>(
        &mut self,
        n: usize,
        coefficient: impl Fn(usize, usize) -> &'a B::Natural,
    ) -> f64 {
        let power = |load: &mut Load| match load {
            Load::Given { seat: [bundle, lane], at, world, speed, .. } => {
                let q = |i: usize| coefficient(*bundle, i);
                speed[n] = match at {
                    Some(at) => {
                        (B::center(q(n + 1), *lane) + B::arm(at, q(n + 1), *lane, n + 1)) * (n + 1) as f64
                    }
                    None => (0..=n).map(|i| B::spin(q(i), q(n - i + 1), *lane) * (n - i + 1) as f64).sum(),
                };
                dot(world, speed, n)
            }
            Load::Spring { law, .. } if law.without_direction() => 0.0,
            Load::Spring { law, .. } | Load::Torsion { law, .. } | Load::Slider { law, .. } => {
                product_with_rate(&law.other, &law.x, n)
            }
        };
        self.list.iter_mut().map(power).sum()
    }

    /// The part of h within which friction and prescribed forces are near their series, to a tolerance.
    pub fn limit(&self, h: f64, order: usize, tolerance: f64) -> f64 {
        self.list.iter().fold(h, |h, load| match load {
            Load::Given { local, .. } => converging(|k| local[k].norm(), local.len(), h, order, tolerance),
            Load::Spring { law, .. } | Load::Torsion { law, .. } | Load::Slider { law, .. } => {
                let h = law.limit(h, order);
                converging(|k| law.drive[k].abs(), law.drive.len(), h, order, tolerance)
            }
        })
    }
}

/// The part of h within which terms of these sizes fall fast, of which a step of this order takes two less.
fn converging(size: impl Fn(usize) -> f64, terms: usize, h: f64, order: usize, tolerance: f64) -> f64 {
    if terms < FALLING + 3 || order < 3 {
        return h;
    }
    let two = |last: usize| size(last) + size(last - 1);
    let (last, before) = (two(terms - 1), two(terms - 1 - FALLING));
    // What is not prescribed, or a polynomial, takes no powers.
    if last == 0.0 || before == 0.0 {
        return h;
    }
    let taken = order - 2;
    let added = two(taken) * libm::pow(h, taken as f64);
    if added <= SETTLED * tolerance * (1.0 + size(0)) {
        return h;
    }
    h.min(NEAR_SINGULAR * libm::pow(before / last, 1.0 / FALLING as f64))
}

/// The force on the second point of a spring: f / l times the way between its points.
#[inline(always)]
fn spring_force(
    n: usize,
    between: &[Vector3<f64>],
    over_length: &mut [f64],
    law: &mut LawSeries,
) -> Vector3<f64> {
    if !law.law.is_directed() {
        return between[n] * -law.law.stiffness;
    }
    // A spring of no length has no direction to pull in.
    if law.without_direction() {
        return Vector3::zeros();
    }
    law.find(n);
    over_length[n] = quotient(law.force[n], &law.x, over_length, n);
    scaled(over_length, between, n)
}
