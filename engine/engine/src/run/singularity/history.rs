//! What is known of the pivot products of an island from the steps so far.

use super::sample::{Scales, single};

/// Bound of the rate at which the distance from a singular configuration, as an angle, changes, relative to the pace of the
/// fastest body.
const RATE_BOUND: f32 = 5.0;
/// The same relative to the fastest change of that joint so far, which masses and lengths may make faster.
const OBSERVED_RATE_BOUND: f64 = 2.0;
/// Least turn of the rows in a step from which the rate of change of pivot products is taken, rad.
const MIN_TURN: f64 = 0.005;

/// Pivot products of an island so far.
#[derive(Clone, Debug, Default)]
pub(super) struct IslandHistory {
    /// The largest pivot products, and what goes with them.
    pub scales: Scales,
    /// Pivot products at the end of the last step.
    pub pivot_products: Vec<f64>,
    /// Bounds of how fast the distances of joints from a singular configuration change, as angles, for each radian that rows turn.
    pub rate_bounds: Vec<f32>,
    /// The end of a step that is a part of one that was searched, s.
    pub cleared: f64,
    /// How fast rows turned at the end of the last step, 1/s.
    pub pace: f64,
    /// Places of the island's joints and drivers in the mechanism.
    pub constraints: Vec<usize>,
}

impl IslandHistory {
    /// Whether no step was noted.
    pub(super) fn is_new(&self) -> bool {
        self.scales.largest.is_empty()
    }

    /// Starts from the pivot products at the start of the first step.
    pub(super) fn begin(&mut self, pivot_products: &[f64], pace: f64) {
        (self.scales, self.pace) = (Scales::new(pivot_products), pace);
        self.pivot_products = pivot_products.to_vec();
        self.cleared = f64::NEG_INFINITY;
        self.rate_bounds = vec![RATE_BOUND; pivot_products.len()];
    }

    /// Notes how fast the root of a joint's pivot product changes for each radian that rows turn.
    pub(super) fn note_rate(&mut self, joint: usize, rate: f64) {
        self.rate_bounds[joint] = self.rate_bounds[joint].max(single(OBSERVED_RATE_BOUND * rate));
    }

    /// Notes a change of pivot products while rows turned by an angle.
    pub(super) fn note_change(&mut self, from: &[f64], to: &[f64], turned: f64) {
        if turned < MIN_TURN {
            return;
        }
        self.scales.raise_rates(&mut self.rate_bounds, [from, to], turned, OBSERVED_RATE_BOUND);
    }
}
