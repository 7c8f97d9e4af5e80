//! What can be wrong with the constraints of a mechanism.

use crate::model::OTHER_THAN_COSINE;

/// The constraints cannot be satisfied, or no longer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ConstraintError {
    /// No position near the given one satisfies the joints.
    #[error(
        "the mechanism cannot be assembled near its start: {} \"{joint}\" stays open by {violation:.3e} of the \
         mechanism's size{} (moved by {moved:.3e} m)",
        joint_or_driver(pointer),
        contradiction(with)
    )]
    Assembly {
        /// The joint whose rows are violated most.
        joint: String,
        /// The joints that stay open with it: it contradicts one or more of them.
        with: Vec<String>,
        /// Its place in the scene, as a JSON pointer.
        pointer: String,
        /// Largest violation of its rows, relative to their size.
        violation: f64,
        /// How far the bodies were moved in the attempt, m.
        moved: f64,
    },
    /// The start can be corrected, but only by moving bodies so far that another start is probably meant.
    #[error(
        "{} \"{joint}\" is open at the start, and closing all joints would move bodies by {moved:.3e} m, more than \
         the {limit:.3e} m that count as a correction",
        joint_or_driver(pointer)
    )]
    StartTooFar {
        /// The joint that is open most at the given start.
        joint: String,
        /// Its place in the scene, as a JSON pointer.
        pointer: String,
        /// How far bodies would have to be moved, m.
        moved: f64,
        /// How far they may be moved, m.
        limit: f64,
    },
    /// No velocities satisfy both the joints and the drivers.
    #[error(
        "driver \"{driver}\" asks for a motion that the joints do not allow at t = {time:.6} s: no velocities satisfy it{}; the \
         nearest miss it by {missed:.1e}/s",
        together(with)
    )]
    MotionImpossible {
        /// Time, s.
        time: f64,
        /// The driver whose rate is missed most.
        driver: String,
        /// The joints and drivers that contradict it.
        with: Vec<String>,
        /// Its place in the scene, as a JSON pointer.
        pointer: String,
        /// By how much the nearest velocities miss it, relative to the size of its rows, 1/s.
        missed: f64,
    },
    /// Rounding makes the rows of a joint indistinguishable from redundant ones.
    #[error(
        "the masses are too different: between {light_mass:.1e} kg of \"{light}\" and {heavy_mass:.1e} kg of \"{heavy}\" \
         rounding cannot tell whether joint \"{joint}\" holds"
    )]
    MassesTooDifferent {
        /// The joint.
        joint: String,
        /// Its place in the scene, as a JSON pointer.
        pointer: String,
        /// The lightest body.
        light: String,
        /// Its mass, kg.
        light_mass: f64,
        /// The heaviest body.
        heavy: String,
        /// Its mass, kg.
        heavy_mass: f64,
    },
    /// The constraints can no longer be satisfied.
    #[error(
        "the run stops at t = {time:.6} s: joint \"{joint}\" is open by {violation:.3e} of the mechanism's size{}",
        contradiction(with)
    )]
    Lost {
        /// Time, s.
        time: f64,
        /// The joint or driver whose rows are violated most.
        joint: String,
        /// Those that are open with it.
        with: Vec<String>,
        /// Largest violation relative to the size of the row.
        violation: f64,
    },
    /// A body is turned about an axis about which it has no inertia, and nothing holds it there: no acceleration answers to that.
    #[error(
        "nothing determines how fast body \"{body}\" turns: at t = {time:.6} s {moment:.3e} N m turn it about ({:.3}, {:.3}, {:.3}), \
         about which it has no inertia, or next to none, and nothing holds it there",
        axis[0], axis[1], axis[2]
    )]
    NothingHolds {
        /// Time, s.
        time: f64,
        /// The body.
        body: String,
        /// Its place in the scene, as a JSON pointer.
        pointer: String,
        /// The moment that nothing answers to, N m.
        moment: f64,
        /// Its direction in the world, of length one.
        axis: [f64; 3],
    },
    /// A driver that prescribes the cosine of an angle leads it to 0 or π, or past them.
    #[error(
        "driver \"{driver}\" prescribes the cosine of an angle, which at t = {time:.6} s is {angle:.6} rad: it cannot reach 0 or pi, where \
             the cosine does not change with the angle, and holds nothing"
    )]
    AngleLost {
        /// Time, s.
        time: f64,
        /// The driver.
        driver: String,
        /// Its place in the scene, as a JSON pointer.
        pointer: String,
        /// The angle, rad.
        angle: f64,
    },
    /// A state is not finite.
    #[error("the state at t = {time:.6} s is not finite")]
    NotFinite {
        /// Time, s.
        time: f64,
    },
}

/// What stands at a place of the scene.
fn joint_or_driver(pointer: &str) -> &'static str {
    if pointer.starts_with("/drivers") { "driver" } else { "joint" }
}

/// Names in quotes.
pub fn quoted(names: &[String]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
    names.join(", ")
}

/// Names of joints that are open together with the worst one.
fn contradiction(with: &[String]) -> String {
    if with.is_empty() { String::new() } else { format!(", and with it {}", quoted(with)) }
}

/// Names of what contradicts a driver.
fn together(with: &[String]) -> String {
    if with.is_empty() { String::new() } else { format!(" together with {}", quoted(with)) }
}

impl ConstraintError {
    /// Whether it is found at a state of a motion, and not before it begins.
    pub fn is_during_motion(&self) -> bool {
        matches!(
            self,
            Self::MotionImpossible { .. }
                | Self::Lost { .. }
                | Self::NothingHolds { .. }
                | Self::AngleLost { .. }
                | Self::NotFinite { .. }
        )
    }

    /// Stable name of the kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Assembly { .. } => "assembly-failed",
            Self::StartTooFar { .. } => "start-too-far",
            Self::MotionImpossible { .. } => "motion-impossible",
            Self::MassesTooDifferent { .. } => "masses-too-different",
            Self::Lost { .. } => "constraints-lost",
            Self::NothingHolds { .. } => "nothing-holds",
            Self::AngleLost { .. } => "angle-lost",
            Self::NotFinite { .. } => "diverged",
        }
    }

    /// Where in the scene, as a JSON pointer, if it is at one place.
    pub fn pointer(&self) -> Option<&str> {
        match self {
            Self::Assembly { pointer, .. }
            | Self::StartTooFar { pointer, .. }
            | Self::MotionImpossible { pointer, .. }
            | Self::MassesTooDifferent { pointer, .. }
            | Self::NothingHolds { pointer, .. }
            | Self::AngleLost { pointer, .. } => Some(pointer),
            Self::Lost { .. } | Self::NotFinite { .. } => None,
        }
    }

    /// What to try.
    pub fn hint(&self) -> &'static str {
        match self {
            Self::Assembly { pointer, .. } | Self::StartTooFar { pointer, .. }
                if pointer.starts_with("/drivers") =>
            {
                "Let the driver begin where the stated positions stand: angles count from those, slides are the distance of the \
                 joint's points along the axis. Or state the bodies where the driver begins."
            }
            Self::Assembly { .. } | Self::StartTooFar { .. } => {
                "Check the points and axes of that joint on both of its bodies, and the positions of the bodies."
            }
            Self::MotionImpossible { .. } => {
                "Let the driver stand still there, free one of the joints that are named, or leave out one of two drivers \
                 that contradict each other: `triad check` tells the degrees of freedom."
            }
            Self::MassesTooDifferent { .. } => {
                "Make the light bodies heavier, or leave them out: a rod without mass between two bodies is a joint of \
                 the kind \"rod\"."
            }
            Self::Lost { .. } => {
                "Look at the last good state: a driver asks for more than the joints allow, two of them contradict each \
                 other, joints that hold the same are not aligned, masses or stiffnesses are too different for the \
                 tolerance, or the stabilization is too weak."
            }
            Self::NothingHolds { .. } => {
                "Give the body a moment of inertia about that axis, let a joint keep it from turning about it, or let the load act \
                 in points of the axis."
            }
            Self::AngleLost { .. } => OTHER_THAN_COSINE,
            Self::NotFinite { .. } => "Loosen the tolerance, and look at the last good state.",
        }
    }
}
