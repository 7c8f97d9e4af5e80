//! Prescribed functions of time as their author writes them.

use crate::Triple;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A number as a function of time t.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", deny_unknown_fields, rename_all = "kebab-case")]
pub enum Motion {
    /// Always the same.
    Constant {
        /// The value.
        value: f64,
    },
    /// start + rate t.
    Ramp {
        /// Value at t = 0.
        #[serde(default)]
        start: f64,
        /// Change in a second.
        rate: f64,
    },
    /// c₀ + c₁ t + c₂ t² + ….
    Polynomial {
        /// c₀, c₁, …; at most 32.
        coefficients: Vec<f64>,
    },
    /// mean + amplitude sin(frequency t + phase).
    Harmonic {
        /// Value about which it swings.
        #[serde(default)]
        mean: f64,
        /// Greatest deviation from the mean.
        amplitude: f64,
        /// Angular frequency, rad/s.
        frequency: f64,
        /// Phase at t = 0, rad.
        #[serde(default)]
        phase: f64,
    },
    /// From one value to another by a polynomial of degree five, at rest and without acceleration at both ends.
    SmoothStep {
        /// Value until `start`.
        from: f64,
        /// Value after `end`.
        to: f64,
        /// Time at which it leaves the first value, s.
        start: f64,
        /// Time at which it has reached the second value, s.
        end: f64,
    },
    /// The natural cubic spline through points (two continuous derivatives), continued straight beyond them.
    Table {
        /// Times, s, increasing; at least two, at most 10 000.
        times: Vec<f64>,
        /// Values at those times.
        values: Vec<f64>,
    },
}

/// A vector as a function of time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", deny_unknown_fields, rename_all = "kebab-case")]
pub enum VectorMotion {
    /// Always the same.
    Fixed {
        /// The vector.
        vector: Triple,
    },
    /// Three numbers, each with its own motion.
    Components {
        /// First component.
        x: Motion,
        /// Second component.
        y: Motion,
        /// Third component.
        z: Motion,
    },
    /// A vector that turns about a fixed axis.
    Turning {
        /// The vector where the angle is zero.
        start: Triple,
        /// The axis; made a unit vector.
        axis: Triple,
        /// The angle, rad.
        angle: Motion,
    },
}
