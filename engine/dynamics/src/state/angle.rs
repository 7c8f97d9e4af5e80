//! An angle of a joint at one state — eq. (5.2).

use nalgebra::Vector3;
use std::f64::consts::TAU;

/// An angle at one state.
#[derive(Clone, Copy, Debug, Default)]
pub struct AngleState {
    /// θ, rad.
    pub value: f64,
    /// θ̇, rad/s.
    pub rate: f64,
    /// ∂θ/∂(a₁, a₂, b).
    pub gradient: [Vector3<f64>; 3],
    /// θ̈ without the part of second derivatives of the vectors.
    pub curvature: f64,
    /// θ at the last accepted step.
    pub reference: f64,
    /// θ̇ there, where whole turns are counted by it.
    pub reference_rate: f64,
    /// Both of them before that step.
    pub before: [f64; 2],
    /// θ at the state to less than half a turn, as far as that is known before its directors are.
    pub expected: f64,
    /// Whether another has told what is expected.
    pub told: bool,
}

/// The angle that differs from `angle` by whole turns and lies nearest to `wanted`.
pub fn nearest(angle: f64, wanted: f64) -> f64 {
    angle + TAU * ((wanted - angle) / TAU).round()
}

impl AngleState {
    /// Takes over positions of (a₁, a₂, b), whole turns being those of an angle that is known to less than half a turn.
    pub fn set_position(&mut self, [a1, a2, b]: [Vector3<f64>; 3], expected: f64) {
        let (x, y) = (a1.dot(&b), a2.dot(&b));
        let principal = libm::atan2(y, x);
        self.value = nearest(principal, expected);
        let square = (x * x + y * y).max(f64::MIN_POSITIVE);
        self.gradient = [b * (-y / square), b * (x / square), (a2 * x - a1 * y) / square];
    }

    /// Takes over velocities of (a₁, a₂, b), whose positions have been taken over.
    pub fn set_velocity(&mut self, at: [Vector3<f64>; 3], rate: [Vector3<f64>; 3]) {
        let [a1, a2, b] = at;
        let [a1r, a2r, br] = rate;
        let (x, y) = (a1.dot(&b), a2.dot(&b));
        let (xr, yr) = (a1r.dot(&b) + a1.dot(&br), a2r.dot(&b) + a2.dot(&br));
        let square = (x * x + y * y).max(f64::MIN_POSITIVE);
        self.rate = (x * yr - y * xr) / square;
        self.curvature =
            2.0 * ((x * a2r.dot(&br) - y * a1r.dot(&br)) / square - (x * xr + y * yr) / square * self.rate);
    }

    /// Counts whole turns from an angle on, and from a rate.
    pub fn count_from(&mut self, angle: f64, rate: f64) {
        (self.reference, self.reference_rate) = (angle, rate);
        (self.expected, self.told) = (angle, false);
    }

    /// Remembers from where it is counted, for a step that is taken back.
    pub fn remember(&mut self) {
        self.before = [self.reference, self.reference_rate];
    }

    /// Counts from where that was.
    pub fn count_back(&mut self) {
        let [angle, rate] = self.before;
        self.count_from(angle, rate);
    }

    /// Where the rate of the last accepted step leads in the time since then, s.
    pub fn foreseen(&self, since: f64) -> f64 {
        self.reference + since * self.reference_rate
    }

    /// Counts whole turns by the mean of the rates at both ends of the time since the last accepted step, s.
    pub fn count_by_rates(&mut self, since: f64) {
        let mean = self.reference + 0.5 * since * (self.reference_rate + self.rate);
        if !self.told && mean.is_finite() {
            self.value = nearest(self.value, mean);
            self.expected = mean;
        }
    }

    /// Whether the rates at both ends of that time say nearly enough the same to tell whole turns: each by itself, they lead less than a turn
    /// apart.
    pub fn is_counted(&self, since: f64) -> bool {
        self.told || (since * (self.rate - self.reference_rate)).abs() < TAU
    }
}
