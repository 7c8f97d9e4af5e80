//! Points that pass each other within a step, or part in it.

use super::{Load, Loads};
use crate::dynamics::series::recurrence::{Vectors, real};
use crate::system::passing::longest_step;

/// What the passing of points may do to a step in terms that are left out, as part of what it does: those of order n fall with the n-th
/// power of the step, in distances of the length's branch point.
const BEYOND: f64 = 0.02;

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
}

/// How long it takes points that coincide to part by a distance, s.
fn parting(between: &Vectors, order: usize, distance: f64) -> f64 {
    let terms = between[..=order].iter().enumerate().skip(1).filter(|(_, term)| term.norm() > 0.0);
    let times = terms.map(|(k, term)| libm::pow(distance / term.norm(), real(k).recip()));
    times.fold(f64::INFINITY, f64::min)
}
