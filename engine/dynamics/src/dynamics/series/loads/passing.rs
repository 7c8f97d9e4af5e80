//! Points that pass each other within a step, or part in it.

use super::{Load, Loads};
use crate::dynamics::series::bodies::LanePlace;
use crate::dynamics::series::lanes::LaneVector;
use crate::dynamics::series::recurrence::{Vectors, real};
use crate::system::passing::longest_step;
use nalgebra::Vector3;

/// What the passing of points may do to a step in terms that are left out, as part of what it does: those of order n fall with the n-th
/// power of the step, in distances of the length's branch point.
const BEYOND: f64 = 0.02;
/// Part of their distance that points come to at the least which pass each other: then the force between them turns round at once.
const CLOSER: f64 = 0.1;

impl Loads {
    /// The part of h within which no points of a spring pass each other unseen. Far from where they do, terms of the series hardly know of it,
    /// and a step would go over it. Points nearer to each other than `met` are let pass: what turns round within such a way moves nothing.
    /// Points that coincide part by no more than that: until they have, nothing is known of where the spring pulls.
    pub fn limit_passing(&self, h: f64, order: usize, met: f64) -> f64 {
        self.list.iter().fold(h, |h, load| match load {
            Load::Spring { between, law, .. } if law.law.is_directed() && law.without_direction() => {
                h.min(parting(between, order, met))
            }
            Load::Spring { square, law, .. } if !law.without_direction() => {
                let square = [square[0], square[1], square[2]];
                // The root is found only where it can matter.
                if longest_step(square, true, BEYOND, met) > h {
                    return h;
                }
                h.min(longest_step(square, true, libm::pow(BEYOND, real(order).recip()), met))
            }
            _ => h,
        })
    }

    /// When points of springs pass each other within a time h, s, if they do: here at a state whose values of features are in place, and which
    /// differs from that of `of`, whose series are known, by little. The lengths of these springs go on beyond, as negative ones.
    pub fn go_beyond<const L: usize>(&mut self, of: &Self, h: f64, values: &[LaneVector<L>]) -> Option<f64> {
        let mut first = None;
        for (load, of) in self.list.iter_mut().zip(&of.list) {
            let Load::Spring { from, to, law, .. } = load else { continue };
            let Load::Spring { between: theirs, .. } = of else { continue };
            if law.law.is_directed() {
                let between = LanePlace::difference([Some(*to), Some(*from)], values);
                let time = passing(&between, &theirs[1]).filter(|time| *time < h);
                law.beyond = time.is_some();
                first = first.or(time);
            }
        }
        first
    }

    /// Takes lengths of springs as they are again.
    pub fn stay(&mut self) {
        for load in &mut self.list {
            if let Load::Spring { law, .. } = load {
                law.beyond = false;
            }
        }
    }
}

/// How long it takes points to pass each other, s, if they come much closer than they are.
fn passing(between: &Vector3<f64>, velocity: &Vector3<f64>) -> Option<f64> {
    let time = -between.dot(velocity) / velocity.norm_squared();
    (time > 0.0 && (between + velocity * time).norm() < CLOSER * between.norm()).then_some(time)
}

/// How long it takes points that coincide to part by a distance, s.
fn parting(between: &Vectors, order: usize, distance: f64) -> f64 {
    let terms = between[..=order].iter().enumerate().skip(1).filter(|(_, term)| term.norm() > 0.0);
    let times = terms.map(|(k, term)| libm::pow(distance / term.norm(), real(k).recip()));
    times.fold(f64::INFINITY, f64::min)
}
