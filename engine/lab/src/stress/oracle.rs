//! Motions that are known without the engine.

/// Step of the reference integration, s: the method of order four is exact to rounding with it for motions of a few
/// radians a second.
const STEP: f64 = 1e-4;

/// A motion of one degree of freedom, θ̈ = f(t, θ, θ̇), integrated by the classical method of Runge and Kutta with a
/// step so small that its error is that of rounding. Nothing of the engine is used.
pub struct OneDegree<'a> {
    acceleration: Box<dyn Fn(f64, f64, f64) -> f64 + 'a>,
    step: f64,
    /// Steps taken: times that were summed up would drift.
    taken: f64,
    time: f64,
    angle: f64,
    rate: f64,
}

impl<'a> OneDegree<'a> {
    /// Starts at an angle and a rate; θ̈ = f(θ, θ̇).
    pub fn new(angle: f64, rate: f64, acceleration: impl Fn(f64, f64) -> f64 + 'a) -> Self {
        Self::driven(angle, rate, STEP, move |_, a, r| acceleration(a, r))
    }

    /// Starts at an angle and a rate, with its own step; θ̈ = f(t, θ, θ̇).
    pub fn driven(
        angle: f64,
        rate: f64,
        step: f64,
        acceleration: impl Fn(f64, f64, f64) -> f64 + 'a,
    ) -> Self {
        Self { acceleration: Box::new(acceleration), step, taken: 0.0, time: 0.0, angle, rate }
    }

    /// Angle and rate at a time not before that of the last call.
    pub fn at(&mut self, time: f64) -> (f64, f64) {
        while time - self.time > self.step {
            (self.angle, self.rate) = self.advanced(self.step);
            self.taken += 1.0;
            self.time = self.taken * self.step;
        }
        self.advanced(time - self.time)
    }

    fn advanced(&self, h: f64) -> (f64, f64) {
        let f = |part: f64, a: f64, r: f64| (r, (self.acceleration)(self.time + part * h, a, r));
        let (a, r) = (self.angle, self.rate);
        let (a1, r1) = f(0.0, a, r);
        let (a2, r2) = f(0.5, a + 0.5 * h * a1, r + 0.5 * h * r1);
        let (a3, r3) = f(0.5, a + 0.5 * h * a2, r + 0.5 * h * r2);
        let (a4, r4) = f(1.0, a + h * a3, r + h * r3);
        (a + h * (a1 + 2.0 * a2 + 2.0 * a3 + a4) / 6.0, r + h * (r1 + 2.0 * r2 + 2.0 * r3 + r4) / 6.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_oscillation_is_exact_to_rounding() {
        let mut oscillation = OneDegree::new(1.0, 0.0, |a, _| -9.0 * a);
        let (angle, rate) = oscillation.at(20.0);
        assert!((angle - libm::cos(60f64)).abs() < 1e-11, "{angle}");
        assert!((rate + 3.0 * libm::sin(60f64)).abs() < 1e-10, "{rate}");
    }
}
