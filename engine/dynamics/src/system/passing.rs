//! Points of springs that pass each other: where a length has its minimum, a force along it turns round, the faster the closer they pass.

use super::System;
use super::load::SystemLoad;
use crate::model::BodyRef;
use crate::system::index::FeatureId;
use nalgebra::Vector3;

/// Distance of points, in lengths of the mechanism, at which a step passes their nearest approach whatever turns round there: part of
/// the tolerance, and least.
const MET_PART: f64 = 1e-3;
const MET: f64 = 1e-12;
/// Roundings of time in the shortest step that they make.
const SHORTEST: f64 = 64.0;

/// How the points of a spring approach each other at a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// l², m².
    pub square: f64,
    /// Its rate, m²/s.
    pub rate: f64,
    /// Their velocity to each other, squared, m²/s².
    pub speed_square: f64,
}

impl System {
    /// How near points come that have met.
    pub fn met(&self) -> f64 {
        met(self.model.settings.tolerance, self.length)
    }

    /// Whether there are springs whose force turns round where their points pass.
    pub fn has_directed_springs(&self) -> bool {
        self.loads.iter().any(|load| matches!(load, SystemLoad::Spring { law, .. } if law.is_directed()))
    }

    /// How the points of these springs approach each other in the state y = (q, q̇).
    pub fn approaches(&self, y: &[f64], out: &mut Vec<Approach>) {
        out.clear();
        out.extend(self.loads.iter().filter_map(|load| match load {
            SystemLoad::Spring { from, to, law } if law.is_directed() => {
                let [from, to] = [from, to].map(|point| self.point(*point, y));
                let (between, velocity) = (to[0] - from[0], to[1] - from[1]);
                let (square, speed_square) = (between.norm_squared(), velocity.norm_squared());
                Some(Approach { square, rate: 2.0 * between.dot(&velocity), speed_square })
            }
            _ => None,
        }));
    }

    /// A point and its velocity in the state y.
    fn point(&self, feature: FeatureId, y: &[f64]) -> [Vector3<f64>; 2] {
        let feature = &self[feature];
        let BodyRef::Moving(body) = feature.body else { return [feature.local, Vector3::zeros()] };
        let (q, q_dot) = y.split_at(self.coordinates);
        self.bodies[body].motion(q, q_dot).map(|at| at.r + at.arm(&feature.local))
    }
}

/// How near points come that have met, in a mechanism of a length and at a tolerance, m.
pub fn met(tolerance: f64, length: f64) -> f64 {
    MET.max(MET_PART * tolerance) * length
}

/// The shortest step that passing points may ask for at time t of a run to `end`, s: time has no finer parts.
pub fn shortest_step(t: f64, end: f64) -> f64 {
    SHORTEST * f64::EPSILON * t.abs().max(end.abs())
}

/// The longest step beside points that pass each other, whose squared distance is now a and a + b t + c t² afterwards, s: `part` of the way to
/// the zeros of that in the complex plane, or all of it where they are hardly farther apart than where they pass, or beyond where they are
/// within `met`. Points that part do not count if only what lies `ahead` does; else those that begin to turn towards each other do not, of which
/// too little is known.
pub fn longest_step([a, b, c]: [f64; 3], ahead: bool, part: f64, met: f64) -> f64 {
    let (half, length) = (0.5 * b, a.sqrt());
    let discriminant = half * half - a * c;
    if ahead && half >= 0.0 && discriminant <= 0.0 || !ahead && c <= 0.0 {
        return f64::INFINITY;
    }
    // Times to the nearest zero, in lengths.
    let slowness = if discriminant > 0.0 {
        // Two on the real axis: the first positive one, if there is one, or the nearer.
        let denominator = discriminant.sqrt() + if ahead { -half } else { half.abs() };
        if denominator > 0.0 { length / denominator } else { f64::INFINITY }
    } else {
        c.sqrt().recip()
    };
    let part = if half * half < -discriminant { 1.0 } else { part };
    slowness * (part * length).max(2.0 * met)
}
