//! One mode: what it does, and its shape.

use nalgebra::{Complex, ComplexField, DVector};
use schemars::JsonSchema;
use serde::Serialize;

/// Relative difference above which two numbers differ by more than rounding.
pub const CLEARLY: f64 = 1e-9;

/// The part of a mode that one body takes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ModeShape {
    /// Displacement of the centre of mass at the time at which the largest of all is at its peak, m, in the world's axes or, about a
    /// steady motion, along those of its frame.
    pub translation: [f64; 3],
    /// Rotation vector at that time, rad.
    pub rotation: [f64; 3],
    /// Displacement a quarter of a period later but for growth and decay, zero where all bodies move in phase, m.
    pub translation_later: [f64; 3],
    /// Rotation vector then, rad.
    pub rotation_later: [f64; 3],
}

/// One mode, moving as e^(λt).
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Mode {
    /// What it does, in a word: `oscillates`, `decays`, `grows` or `drifts`.
    pub kind: &'static str,
    /// Frequency, Hz.
    pub frequency: f64,
    /// Real part of λ, 1/s: negative where the motion dies away.
    pub growth: f64,
    /// Part of critical damping.
    pub damping_ratio: f64,
    /// Estimated error of λ = growth + 2π i frequency, 1/s: how far it moves with the position, by what that may be off, and with the
    /// differences of which the linear equations are made. `None` where it drifts, and where it is not known.
    pub error: Option<f64>,
    /// The motion of each body. The component of displacement (m, or rad times the mechanism's length) with the largest amplitude, the
    /// first of equal ones, is one now and zero a quarter of a period from now: this fixes size, sign and phase.
    pub shape: Vec<ModeShape>,
}

/// The mode of one solution; its shape is turned in phase so that its largest displacement is one, and now.
pub fn mode(value: Complex<f64>, motion: &DVector<Complex<f64>>, length: f64) -> Mode {
    let still = value.modulus() == 0.0;
    let kind = match () {
        () if still => "drifts",
        () if value.re > CLEARLY * value.modulus() => "grows",
        () if value.im > 0.0 => "oscillates",
        () => "decays",
    };
    let arc = |k: usize| if k % 6 >= 3 { length } else { 1.0 };
    // Among equal ones the first, so that rounding does not choose.
    let mut largest = (f64::MIN_POSITIVE, Complex::new(f64::MIN_POSITIVE, 0.0));
    for (k, x) in motion.iter().enumerate() {
        let reach = arc(k) * x.modulus();
        if reach > largest.0 * (1.0 + CLEARLY) {
            largest = (reach, x * arc(k));
        }
    }
    let unit = motion.map(|x| x / largest.1);
    let part = |of: &dyn Fn(Complex<f64>) -> f64, at: usize| -> [f64; 3] {
        [of(unit[at]), of(unit[at + 1]), of(unit[at + 2])]
    };
    let shape = (0..motion.len() / 6).map(|body| ModeShape {
        translation: part(&|x| x.re, 6 * body),
        rotation: part(&|x| x.re, 6 * body + 3),
        // Re x e^(iωt) is −Im x a quarter of a period from now.
        translation_later: part(&|x| 0.0 - x.im, 6 * body),
        rotation_later: part(&|x| 0.0 - x.im, 6 * body + 3),
    });
    Mode {
        kind,
        frequency: value.im.abs() / std::f64::consts::TAU,
        growth: value.re,
        damping_ratio: if still { 0.0 } else { -value.re / value.modulus() },
        error: None,
        shape: shape.collect(),
    }
}
