//! Positions that runs are compared with.

use triad_engine::EngineError;
use triad_engine::run::Simulation;
use triad_scene::{IntegratorKind, Scene};

use super::plan::{BenchCase, Truth};

/// Interval at which runs are compared, s; shorter where a run has fewer than a hundred of them.
pub const EVERY: f64 = 0.01;

/// Steps after which a run counts as not worth its time: the longest of the built-in scenes takes a tenth of them.
pub const MAX_STEPS: u64 = 1_000_000;

/// Positions of the compared bodies at multiples of the interval.
pub type Positions = Vec<Vec<[f64; 3]>>;

/// The interval of a run of that length, s.
fn interval(duration: f64) -> f64 {
    EVERY.min(duration / 100.0)
}

/// Number of intervals of a run.
fn intervals(duration: f64) -> u32 {
    let every = interval(duration);
    let mut count = 0;
    while every > 0.0 && f64::from(count + 1) * every <= duration * (1.0 + 1e-9) {
        count += 1;
    }
    count
}

/// Positions of the first `bodies` bodies of a scene.
///
/// # Errors
///
/// [`EngineError`]: the scene cannot start or go on.
pub fn positions(scene: &Scene, bodies: usize) -> Result<Positions, EngineError> {
    followed(scene, bodies, |_| ())
}

/// The same; `at` sees the run at each of the moments.
fn followed(scene: &Scene, bodies: usize, mut at: impl FnMut(&Simulation)) -> Result<Positions, EngineError> {
    let mut simulation = Simulation::new(scene)?;
    simulation.set_step_limit(MAX_STEPS);
    let duration = scene.simulation.duration;
    (0..=intervals(duration))
        .map(|k| {
            simulation.advance_to((f64::from(k) * interval(duration)).min(duration))?;
            at(&simulation);
            Ok(simulation.frame().bodies.iter().take(bodies).map(|b| b.position).collect())
        })
        .collect()
}

/// What runs are compared with.
pub struct Reference {
    /// Positions of the bodies that are compared.
    pub positions: Positions,
    /// How far they are off themselves, m; `None` where nothing is known of that before the end.
    pub error: Option<f64>,
}

/// The reference of a case.
///
/// # Errors
///
/// [`EngineError`]: the scene cannot start or go on.
pub fn reference(case: &BenchCase, scene: &Scene) -> Result<Reference, EngineError> {
    match case.truth {
        Truth::Converged => {
            let mut tight = scene.clone();
            let settings = &mut tight.simulation;
            settings.compare_by(IntegratorKind::Auto, settings.tolerance);
            settings.error_estimate = true;
            let stiff = Simulation::new(&tight)?.summary().integrator == IntegratorKind::Radau;
            (tight.simulation.integrator, tight.simulation.tolerance) =
                if stiff { (IntegratorKind::Radau, 1e-12) } else { (IntegratorKind::Dop853, 1e-13) };
            let mut error = Some(0.0f64);
            let positions = followed(&tight, scene.bodies.len(), |run| {
                error = error.zip(run.error_estimate()).map(|(most, here)| most.max(here.position));
            })?;
            Ok(Reference { positions, error })
        }
        Truth::Angle { kappa, start, rate, arm } => {
            let angles = pendulum(kappa, start, rate, intervals(case.duration));
            let positions =
                angles.into_iter().map(|phi| vec![[arm * libm::sin(phi), arm * libm::cos(phi), 0.0]]);
            Ok(Reference { positions: positions.collect(), error: Some(0.0) })
        }
    }
}

/// φ̈ = κ sin φ at multiples of [`EVERY`], by its own Taylor series of order 20: exact to rounding.
fn pendulum(kappa: f64, start: f64, rate: f64, intervals: u32) -> Vec<f64> {
    /// Order of the Taylor series of the angle.
    const ORDER: usize = 20;
    let (mut phi, mut omega) = (start, rate);
    let mut angles = vec![phi];
    for _ in 0..intervals {
        let mut series = [0.0; ORDER + 1];
        let (mut sine, mut cosine) = ([0.0; ORDER + 1], [0.0; ORDER + 1]);
        (series[0], series[1]) = (phi, omega);
        (sine[0], cosine[0]) = libm::sincos(phi);
        for n in 0..ORDER - 1 {
            series[n + 2] = kappa * sine[n] / ((n + 1) * (n + 2)) as f64;
            for i in 0..=n {
                let change = (i + 1) as f64 * series[i + 1] / (n + 1) as f64;
                sine[n + 1] += change * cosine[n - i];
                cosine[n + 1] -= change * sine[n - i];
            }
        }
        (phi, omega) = (0.0, 0.0);
        for c in series.iter().rev() {
            omega = omega * EVERY + phi;
            phi = phi * EVERY + c;
        }
        angles.push(phi);
    }
    angles
}

/// Largest distance between two records.
pub fn distance(a: &Positions, b: &Positions) -> f64 {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.map(|(a, b)| (0..3).map(|c| a[c] - b[c]).map(|d| d * d).sum::<f64>().sqrt()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The period of a pendulum released horizontally is 4 K(1/2)/√(g/L).
    #[test]
    fn the_angle_returns_after_its_period() {
        let angles = pendulum(9.81, -std::f64::consts::FRAC_PI_2, 0.0, 1000);
        // Four periods are 9.4713677903 s; before and after, the angle is even about that moment.
        let period = 4.0 * 2.367_841_947_576_237_4;
        let ahead = angles[947] + std::f64::consts::FRAC_PI_2;
        let tau: f64 = period - 9.47;
        assert!((ahead + 0.5 * 9.81 * tau * tau).abs() < 1e-7, "{ahead}");
    }
}
