//! Prescribed functions of time as their author writes them.

use crate::value::Triple;
use schemars::{JsonSchema, Schema, json_schema};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// A number as a function of time t: one of the kinds of motion, or a plain number, which is constant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(remote = "Self", tag = "kind", deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(rename = "Motion", transform = or_number)]
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
    /// A formula in t, s: `asin(0.1*sin(10*t))`.
    Expression {
        /// The formula: numbers, t, pi, + - * / ^, brackets, and sin, cos, tan, asin, acos, atan, sqrt, exp, ln.
        value: String,
    },
}

/// A vector as a function of time: one of the kinds of motion, or three plain numbers, which are constant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(remote = "Self", tag = "kind", deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(rename = "VectorMotion", transform = or_three_numbers)]
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

impl Motion {
    /// Always `value`. A plain number where a motion is asked for means the same.
    pub const fn constant(value: f64) -> Self {
        Self::Constant { value }
    }

    /// start + rate t.
    ///
    /// ```
    /// use triad_scene::Motion;
    ///
    /// assert_eq!(Motion::ramp(0.0, 2.0), Motion::Ramp { start: 0.0, rate: 2.0 });
    /// ```
    pub const fn ramp(start: f64, rate: f64) -> Self {
        Self::Ramp { start, rate }
    }

    /// c₀ + c₁ t + c₂ t² + …; at most 32 coefficients.
    pub fn polynomial(coefficients: impl Into<Vec<f64>>) -> Self {
        Self::Polynomial { coefficients: coefficients.into() }
    }

    /// amplitude sin(frequency t), frequency in rad/s.
    pub const fn sine(amplitude: f64, frequency: f64) -> Self {
        Self::Harmonic { mean: 0.0, amplitude, frequency, phase: 0.0 }
    }

    /// From one value, held until `start`, to another, reached at `end` (s), without a jump of the acceleration.
    pub const fn smooth_step(from: f64, to: f64, start: f64, end: f64) -> Self {
        Self::SmoothStep { from, to, start, end }
    }

    /// A formula in t.
    ///
    /// ```
    /// let motion = triad_scene::Motion::expression("asin(0.1*sin(10*t))");
    /// assert_eq!(serde_json::to_value(&motion)?["kind"], "expression");
    /// # Ok::<(), serde_json::Error>(())
    /// ```
    pub fn expression(value: impl Into<String>) -> Self {
        Self::Expression { value: value.into() }
    }

    /// The natural cubic spline through values at times (s), which increase.
    pub fn table(times: impl Into<Vec<f64>>, values: impl Into<Vec<f64>>) -> Self {
        Self::Table { times: times.into(), values: values.into() }
    }
}

impl From<f64> for Motion {
    fn from(value: f64) -> Self {
        Self::constant(value)
    }
}

impl VectorMotion {
    /// Always `vector`. Three plain numbers where the motion of a vector is asked for mean the same.
    pub const fn fixed(vector: Triple) -> Self {
        Self::Fixed { vector }
    }

    /// Three components, each with its own motion.
    ///
    /// ```
    /// use triad_scene::{Motion, VectorMotion};
    ///
    /// let shaken = VectorMotion::components(Motion::sine(0.01, 50.0), 0.0, 1.0);
    /// assert!(matches!(shaken, VectorMotion::Components { y: Motion::Constant { value: 0.0 }, .. }));
    /// ```
    pub fn components(x: impl Into<Motion>, y: impl Into<Motion>, z: impl Into<Motion>) -> Self {
        Self::Components { x: x.into(), y: y.into(), z: z.into() }
    }

    /// A vector that turns about a fixed axis through an angle, rad.
    pub fn turning(start: Triple, axis: Triple, angle: impl Into<Motion>) -> Self {
        Self::Turning { start, axis, angle: angle.into() }
    }
}

impl From<Triple> for VectorMotion {
    fn from(vector: Triple) -> Self {
        Self::fixed(vector)
    }
}

impl Serialize for Motion {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Self::serialize(self, serializer)
    }
}

impl Serialize for VectorMotion {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Self::serialize(self, serializer)
    }
}

impl<'de> Deserialize<'de> for Motion {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(MotionVisitor)
    }
}

impl<'de> Deserialize<'de> for VectorMotion {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(VectorMotionVisitor)
    }
}

/// Reads a number or a kind of motion. An untagged enum would read the same, and tell no reason where neither fits.
struct MotionVisitor;

impl<'de> Visitor<'de> for MotionVisitor {
    type Value = Motion;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(r#"a number, or a motion such as {"kind": "ramp", "rate": 2}"#)
    }

    fn visit_f64<E>(self, value: f64) -> Result<Motion, E> {
        Ok(Motion::constant(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Motion, E> {
        Ok(Motion::constant(value as f64))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Motion, E> {
        Ok(Motion::constant(value as f64))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Motion, A::Error> {
        Motion::deserialize(MapAccessDeserializer::new(map))
    }
}

/// Reads three numbers or a kind of motion.
struct VectorMotionVisitor;

impl<'de> Visitor<'de> for VectorMotionVisitor {
    type Value = VectorMotion;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(
            r#"three numbers, or a motion of a vector such as {"kind": "components", "x": …, "y": …, "z": …}"#,
        )
    }

    fn visit_seq<A: SeqAccess<'de>>(self, sequence: A) -> Result<VectorMotion, A::Error> {
        Triple::deserialize(SeqAccessDeserializer::new(sequence)).map(VectorMotion::fixed)
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<VectorMotion, A::Error> {
        VectorMotion::deserialize(MapAccessDeserializer::new(map))
    }
}

fn or_number(schema: &mut Schema) {
    let number = json_schema!({ "description": "Always this number.", "type": "number" });
    add_choice(schema, number);
}

fn or_three_numbers(schema: &mut Schema) {
    add_choice(
        schema,
        json_schema!({
            "description": "Always this vector.",
            "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3,
        }),
    );
}

fn add_choice(schema: &mut Schema, choice: Schema) {
    let choices = schema.get_mut("oneOf").and_then(|choices| choices.as_array_mut());
    if let Some(choices) = choices {
        choices.push(choice.into());
    }
}
