//! A free-body diagram: forces and moments, each with its place, its body and its sense.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Name of the place where the weight acts, the centre of mass.
pub(crate) const CENTRE: &str = "centre";
/// A place of a body as people read it: `motor-2` is motor 2.
pub(crate) fn place_in_words(name: &str) -> String {
    if name == CENTRE { "centre of mass".to_owned() } else { name.replace('-', " ") }
}

/// Most arrows of a diagram.
pub(crate) const MAX_ARROWS: usize = 60;

/// What an arrow stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ArrowKind {
    /// A force along an axis.
    Force,
    /// A moment about an axis.
    Moment,
}

/// An axis of the ground frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// x.
    X,
    /// y.
    Y,
    /// z.
    Z,
}

impl Axis {
    /// Its place among three components.
    pub(crate) fn index(self) -> usize {
        self as usize
    }

    /// The axes to the right, up, and out of the picture that is seen along this one.
    pub(crate) fn picture(self) -> [Self; 3] {
        match self {
            Self::X => [Self::Y, Self::Z, Self::X],
            Self::Y => [Self::X, Self::Z, Self::Y],
            Self::Z => [Self::X, Self::Y, Self::Z],
        }
    }
}

/// An axis with its sense.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
pub enum Sense {
    /// Along or about +x.
    #[serde(rename = "+x")]
    PlusX,
    /// Along or about −x.
    #[serde(rename = "-x")]
    MinusX,
    /// Along or about +y.
    #[serde(rename = "+y")]
    PlusY,
    /// Along or about −y.
    #[serde(rename = "-y")]
    MinusY,
    /// Along or about +z.
    #[serde(rename = "+z")]
    PlusZ,
    /// Along or about −z.
    #[serde(rename = "-z")]
    MinusZ,
}

impl Sense {
    /// Its axis.
    pub(crate) fn axis(self) -> Axis {
        match self {
            Self::PlusX | Self::MinusX => Axis::X,
            Self::PlusY | Self::MinusY => Axis::Y,
            Self::PlusZ | Self::MinusZ => Axis::Z,
        }
    }

    /// 1, or −1 against the axis.
    pub(crate) fn sign(self) -> f64 {
        match self {
            Self::PlusX | Self::PlusY | Self::PlusZ => 1.0,
            Self::MinusX | Self::MinusY | Self::MinusZ => -1.0,
        }
    }

    /// The sense along an axis with the sign of a number.
    pub(crate) fn of(axis: Axis, sign: f64) -> Self {
        match (axis, sign < 0.0) {
            (Axis::X, false) => Self::PlusX,
            (Axis::X, true) => Self::MinusX,
            (Axis::Y, false) => Self::PlusY,
            (Axis::Y, true) => Self::MinusY,
            (Axis::Z, false) => Self::PlusZ,
            (Axis::Z, true) => Self::MinusZ,
        }
    }

    /// As people read it.
    pub(crate) fn text(self) -> &'static str {
        match self {
            Self::PlusX => "+x",
            Self::MinusX => "\u{2212}x",
            Self::PlusY => "+y",
            Self::MinusY => "\u{2212}y",
            Self::PlusZ => "+z",
            Self::MinusZ => "\u{2212}z",
        }
    }
}

/// A force or a moment in a diagram.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Arrow {
    /// Force or moment.
    pub kind: ArrowKind,
    /// Where: a joint or driver, `centre` for the centre of mass, or another point of the picture.
    pub at: String,
    /// The body on which it acts.
    pub on: String,
    /// Along or about which axis of the ground frame, and in which sense.
    pub along: Sense,
}
