//! What is said about a free-body diagram.

use crate::answers::diagram::Arrow;

/// What is wrong with a diagram, arrow by arrow.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum DiagramFinding {
    /// A right arrow that is not there.
    Missing(Arrow),
    /// An arrow of the other sense.
    Opposite(Arrow),
    /// An arrow that nothing exerts.
    TooMuch(Arrow),
}

/// The mistake behind it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DiagramSlip {
    /// The arrows of one joint point the same way on both bodies.
    ActionReaction,
    /// All arrows of joints point the other way.
    OtherSide,
    /// An arrow stands at another point.
    WrongPoint,
    WeightMissing,
    /// Something besides the weight acts at the centre of mass.
    InertiaForce,
    /// A joint transmits no such moment.
    MomentNotCarried,
    TooMuch,
    Missing,
    WrongWay,
}

impl DiagramSlip {
    /// Stable name.
    pub(crate) fn code(self) -> &'static str {
        match self {
            Self::ActionReaction => "action-reaction",
            Self::OtherSide => "other-side",
            Self::WrongPoint => "wrong-point",
            Self::WeightMissing => "weight-missing",
            Self::InertiaForce => "inertia-force",
            Self::MomentNotCarried => "moment-not-carried",
            Self::TooMuch => "too-much",
            Self::Missing => "missing",
            Self::WrongWay => "wrong-way",
        }
    }

    /// What to think of.
    pub(crate) fn advice(self) -> &'static str {
        match self {
            Self::ActionReaction => {
                "Across one joint you drew the same arrow on both bodies. What one exerts on the other, the other exerts on it: \
                 which way must the second arrow point?"
            }
            Self::OtherSide => {
                "Every arrow at a joint is the one that this body exerts on its neighbour. Draw what acts **on** the body that is \
                 cut free."
            }
            Self::WrongPoint => {
                "An arrow has the right direction and stands at the wrong point. Where is the body touched there?"
            }
            Self::WeightMissing => "The joints are cut, but the earth still pulls at the body.",
            Self::InertiaForce => {
                "At the centre of mass acts the weight, and nothing else. Mass times acceleration stands on the other side of \
                 Newton's law: it is no force that somebody exerts."
            }
            Self::MomentNotCarried => {
                "A moment stands at a joint that does not transmit it. About which axes is the body free to turn there?"
            }
            Self::TooMuch => {
                "There is an arrow that nobody exerts. For each arrow, name the body that it comes from."
            }
            Self::Missing => {
                "Something is missing. Go round the body: where was it cut, and what did each joint hinder?"
            }
            Self::WrongWay => {
                "Everything is there, but not everything points the right way. Which way would the body go without it?"
            }
        }
    }
}
