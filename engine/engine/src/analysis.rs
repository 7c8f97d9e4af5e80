//! Analyses other than running forward in time — THEORY section 10.
//!
//! All of them work where the rigid-body rows have been eliminated: a small motion of the mechanism is a twist (ṙ, ω) of
//! each body with A ξ = 0, and an orthonormal basis of such twists, the tangent, turns forces,
//! masses and stiffnesses into small dense matrices.

pub mod check;

mod assembly;
mod equilibrium;
mod kinematics;
mod modes;
mod stage;

pub use assembly::{Assembly, Placement, assemble};
pub use equilibrium::{Equilibrium, equilibrium};
pub use kinematics::{KinematicState, Kinematics, kinematics};
pub use modes::{Mode, ModeShape, Modes, ModesAbout, modes};
#[doc(hidden)]
pub use stage::Stage;

use crate::error::EngineError;
use triad_dynamics::constraints::ConstraintError;

/// Greatest number of bodies in analyses with dense matrices, whose work grows with its cube.
pub const MAX_BODIES: usize = 150;

/// Why an analysis has no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AnalysisError {
    /// The scene, or its assembly.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// More bodies than dense matrices are good for.
    #[error("this analysis takes at most {MAX_BODIES} bodies; the scene has {bodies}")]
    TooLarge {
        /// Bodies of the scene.
        bodies: usize,
    },
    /// No position without acceleration was reached.
    #[error(
        "no equilibrium was found: after {iterations} steps a generalized force of {residual:.3e} N is left, \
         most of it on body \"{body}\""
    )]
    NoEquilibrium {
        /// Steps taken.
        iterations: usize,
        /// Generalized force that is left, N.
        residual: f64,
        /// The body that it acts on most.
        body: String,
    },
    /// A motion without inertia.
    #[error(
        "body \"{body}\" can turn about an axis about which it has no inertia: that motion has no frequency"
    )]
    Massless {
        /// The body that moves most.
        body: String,
    },
    /// Kinematic analysis of a scene that is free to move.
    #[error("the drivers leave freedoms of motion ({freedoms}): it is not a matter of geometry alone")]
    Free {
        /// Degrees of freedom that are left.
        freedoms: usize,
    },
    /// The drivers ask for what the joints do not allow.
    #[error(
        "at t = {time:.6} s the drivers and joints contradict each other: \"{origin}\" stays open by {violation:.3e}"
    )]
    Unreachable {
        /// Time, s.
        time: f64,
        /// The joint or driver that is violated most.
        origin: String,
        /// By how much.
        violation: f64,
    },
    /// A body to be kept in place that is not there, or had to move.
    #[error("body \"{body}\" cannot be kept in place: {reason}")]
    Pinned {
        /// The body.
        body: String,
        /// Why.
        reason: String,
    },
}

impl From<ConstraintError> for AnalysisError {
    fn from(error: ConstraintError) -> Self {
        Self::Engine(error.into())
    }
}

impl AnalysisError {
    /// Stable name of the kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Engine(error) => error.code(),
            Self::TooLarge { .. } => "analysis-too-large",
            Self::NoEquilibrium { .. } => "no-equilibrium",
            Self::Massless { .. } => "massless-motion",
            Self::Free { .. } => "not-driven",
            Self::Unreachable { .. } => "unreachable",
            Self::Pinned { .. } => "cannot-pin",
        }
    }

    /// What to try.
    pub fn hint(&self) -> String {
        match self {
            Self::Engine(error) => return error.hint(),
            Self::TooLarge { .. } => "Analyse a part of the mechanism as a scene of its own.",
            Self::NoEquilibrium { .. } => {
                "Look whether anything holds that body: a body that falls freely has no equilibrium. Otherwise start \
                 nearer to where it comes to rest."
            }
            Self::Massless { .. } => "Give the body a small moment of inertia about that axis.",
            Self::Free { .. } => "Add a driver for each degree of freedom, or run the scene forward in time.",
            Self::Unreachable { .. } => {
                "Look at the driver's motion at that time: it may ask for more than the links can reach."
            }
            Self::Pinned { .. } => "Check the name, and keep fewer bodies in place.",
        }
        .to_owned()
    }
}
