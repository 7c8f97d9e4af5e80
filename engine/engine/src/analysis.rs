//! Analyses other than running forward in time — THEORY section 10.
//!
//! All of them work where the rigid-body rows have been eliminated: a small motion of the mechanism is a twist (ṙ, ω) of
//! each body with A ξ = 0, and an orthonormal basis of such twists, the tangent, turns forces,
//! masses and stiffnesses into small dense matrices.

pub mod check;

mod wanted;

mod assembly;
mod equilibrium;
mod flow;
mod idle;
mod inertia;
mod kinematics;
mod modes;
mod momenta;
mod stability;
mod stage;

pub use assembly::{Assembly, Placement, assemble, assemble_while};
pub use equilibrium::{Equilibrium, equilibrium, equilibrium_while};
pub use idle::IdleTurns;
pub use inertia::TurnsWithoutInertia;
pub use kinematics::{KinematicState, Kinematics, kinematics, kinematics_while};
pub use modes::{Mode, ModeShape, Modes, ModesAbout, SteadyMotion, modes, modes_while};
#[doc(hidden)]
pub use stage::Stage;
pub use wanted::Wanted;

use crate::error::EngineError;
use triad_dynamics::constraints::{ConstraintError, quoted};

/// Greatest number of degrees of freedom in analyses with dense matrices, whose work grows with its cube.
pub const MAX_FREEDOMS: usize = 600;

/// Why an analysis has no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AnalysisError {
    /// The scene, or its assembly.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// More degrees of freedom than dense matrices are good for.
    #[error(
        "this analysis takes at most {MAX_FREEDOMS} degrees of freedom, because its work grows with their cube; the scene has \
         {freedoms}{}",
        idle.as_ref().map_or_else(String::new, |idle| format!(
            ", {} of which are turns of bodies about axes about which they have no inertia, \"{}\" first", idle.turns, idle.body
        ))
    )]
    TooLarge {
        /// Degrees of freedom of the scene.
        freedoms: usize,
        /// Those that move nothing with inertia, if there are any.
        idle: Option<IdleTurns>,
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
    /// No motion in which all bodies keep their places in a frame that turns and slides uniformly.
    #[error("there is no steady motion near the start: {reason}")]
    NoSteadyMotion {
        /// What stands against it.
        reason: String,
    },
    /// More bodies that may spin about themselves than a steady motion is looked for with.
    #[error(
        "a steady motion keeps the momentum of each spin, and its search takes work that grows with the fourth power of the size: \
         {spins} bodies that are alike around an axis, with {freedoms} degrees of freedom, are too many"
    )]
    TooManySpins {
        /// Bodies that are alike around an axis.
        spins: usize,
        /// Degrees of freedom of the scene.
        freedoms: usize,
    },
    /// The QR algorithm did not converge.
    #[error("the eigenvalues of the small motions were not found")]
    NoModes,
    /// Kinematic analysis of a scene that is free to move.
    #[error(
        "the drivers leave freedoms of motion ({freedoms}{}): it is not a matter of geometry alone",
        body.as_ref().map_or_else(String::new, |body| format!("; \"{body}\" moves most in one"))
    )]
    Free {
        /// Degrees of freedom that are left.
        freedoms: usize,
        /// The body that moves most in one of them, where that is known.
        body: Option<String>,
    },
    /// A body that the drivers leave free to spin about itself, and that something turns.
    #[error(
        "body \"{body}\" is free to spin about its axis through {}, and at t = {time:.6} s a moment of {moment:.3e} N m turns it \
         there: how it spins is not a matter of geometry alone",
        quoted(joints)
    )]
    Spins {
        /// The body.
        body: String,
        /// The joints that it spins in.
        joints: Vec<String>,
        /// Time, s.
        time: f64,
        /// The moment about the axis, N m.
        moment: f64,
    },
    /// Drivers that start in a position where branches of the motion meet, with velocities of none.
    #[error(
        "the start is a singular position of the driven mechanism, where the rows of {} depend on others: several branches of \
         the motion begin there, and the velocities do not say which is meant",
        quoted(joints)
    )]
    SingularStart {
        /// The joints and drivers whose rows depend on others there, and not a little later.
        joints: Vec<String>,
    },
    /// The drivers come to a dead point: beyond it they ask for what the joints do not allow.
    #[error(
        "at t = {time:.9} s driver {} comes to a dead point: the bodies would have to move infinitely fast there, and no position \
         beyond it closes {}",
        quoted(drivers),
        quoted(joints)
    )]
    Unreachable {
        /// When it gets there, s.
        time: f64,
        /// The drivers that push into it.
        drivers: Vec<String>,
        /// The joints that hold against them.
        joints: Vec<String>,
    },
    /// The motion that was followed and the position that meets the drivers are not the same.
    #[error(
        "at t = {time:.6} s the nearest position that meets the drivers is {moved:.3e} away from the one that the motion leads \
         to: it may be another branch"
    )]
    BranchLost {
        /// Time, s.
        time: f64,
        /// The distance, m or, of directors, without a unit.
        moved: f64,
    },
    /// More outputs than one analysis gives.
    #[error("{positions:.0} positions are more than one analysis gives")]
    TooManyPositions {
        /// Positions asked for.
        positions: f64,
    },
    /// A body to be kept in place that is not there, or had to move.
    #[error("body \"{body}\" cannot be kept in place: {reason}")]
    Pinned {
        /// The body.
        body: String,
        /// Why.
        reason: String,
    },
    /// Whoever asked for it left.
    #[error("nobody waits for the analysis any more")]
    NoLongerWanted,
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
            Self::TooManySpins { .. } => "too-many-spins",
            Self::NoEquilibrium { .. } => "no-equilibrium",
            Self::NoSteadyMotion { .. } => "no-steady-motion",
            Self::NoModes => "no-modes",
            Self::Free { .. } => "not-driven",
            Self::Spins { .. } => "free-to-spin",
            Self::SingularStart { .. } => "singular-start",
            Self::Unreachable { .. } => "unreachable",
            Self::BranchLost { .. } => "branch-lost",
            Self::TooManyPositions { .. } => "too-many-positions",
            Self::Pinned { .. } => "cannot-pin",
            Self::NoLongerWanted => "no-longer-wanted",
        }
    }

    /// What to try.
    pub fn hint(&self) -> String {
        match self {
            Self::Engine(error) => return error.hint(),
            Self::TooLarge { idle: None, .. } | Self::TooManySpins { .. } => "Analyse a part of the mechanism as a scene of its own.",
            Self::TooLarge { idle: Some(_), .. } => {
                "Take those turns away: in place of points on joints of the kind \"rod\", or of thin rods between spherical joints, \
                 let thin rods hang on revolute joints where all moves in a plane, on universal joints where it does not. Or \
                 analyse a part of the mechanism as a scene of its own."
            }
            Self::NoEquilibrium { .. } => {
                "Look whether anything holds that body: a body that falls freely has no equilibrium. Make springs alike: where stiffnesses differ \
                 by more than 1e8, the rounding of the stiff ones hides the soft ones. Otherwise start nearer to where it comes to rest."
            }
            Self::NoSteadyMotion { .. } => {
                "Drive at constant speed what loads drive or brake, turn about an axis along the weight, and leave out the weight \
                 of what falls freely. Modes about a position at rest are those about the equilibrium or the start."
            }
            Self::NoModes => "Look whether stiffness and damping of the loads are of a sensible size.",
            Self::Free { .. } => "Add a driver for each degree of freedom, or run the scene forward in time.",
            Self::Spins { .. } => {
                "Put a universal joint in place of a spherical one at one end, leave the body out by a joint of the kind \"rod\", \
                 or run the scene forward in time."
            }
            Self::SingularStart { .. } => {
                "Give the bodies the velocities of the branch that is meant, or start a little before that position: it is passed on its smooth \
                 branch."
            }
            Self::Unreachable { .. } => {
                "Let the driver turn back before that time, change lengths, drive another joint, or end the analysis before."
            }
            Self::BranchLost { .. } => "Look whether the mechanism is next to a singular position there, and change a length.",
            Self::TooManyPositions { .. } => "Raise \"every\", the interval of outputs, or shorten the duration.",
            Self::Pinned { .. } => "Check the name, and keep fewer bodies in place.",
            Self::NoLongerWanted => "Ask again, and wait.",
        }
        .to_owned()
    }
}
