//! What can go wrong between a text and a finished run.

mod last_good;

pub use last_good::{Cause, LastGood};

use crate::catalogue::CatalogueError;
use crate::integrate::Stop;
use crate::model::ModelError;
use crate::scene::SceneError;
use crate::uniqueness::UniquenessError;
use last_good::listed;

/// Any failure of the engine: what, where, and what to try.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EngineError {
    /// The text is not a scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// There is no built-in scene of that name.
    #[error(transparent)]
    Catalogue(#[from] CatalogueError),
    /// The scene cannot be.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// Which reactions are unique cannot be told.
    #[error(transparent)]
    Uniqueness(#[from] UniquenessError),
    /// No position near the given one satisfies the joints.
    #[error(
        "the mechanism cannot be assembled near its start: joint \"{joint}\" stays open by {violation:.3e} of the \
         mechanism's size{} (moved by {moved:.3e} m)",
        contradiction(with)
    )]
    Assembly {
        /// The joint whose rows are violated most.
        joint: String,
        /// The joints that stay open with it: it contradicts one or more of them.
        with: Vec<String>,
        /// Where it stands in the scene, as a JSON pointer.
        pointer: String,
        /// Largest violation of its rows, relative to their size.
        violation: f64,
        /// How far the bodies were moved in the attempt, m.
        moved: f64,
    },
    /// The start can be corrected, but only by moving bodies so far that another start is probably meant.
    #[error(
        "joint \"{joint}\" is open at the start, and closing all joints would move bodies by {moved:.3e} m, more than \
         the {limit:.3e} m that count as a correction"
    )]
    StartTooFar {
        /// The joint that is open most at the given start.
        joint: String,
        /// Where it stands in the scene, as a JSON pointer.
        pointer: String,
        /// How far bodies would have to be moved, m.
        moved: f64,
        /// How far they may be moved, m.
        limit: f64,
    },
    /// No velocities satisfy the joints and what drivers ask for.
    #[error(
        "driver \"{driver}\" asks for a motion that the joints do not allow at t = {time:.6} s: no velocities satisfy it{}; the \
         nearest miss it by {missed:.1e}/s{last}",
        together(with)
    )]
    MotionImpossible {
        /// Time, s.
        time: f64,
        /// The driver whose rate is missed most.
        driver: String,
        /// The joints and drivers that contradict it.
        with: Vec<String>,
        /// Where it stands in the scene, as a JSON pointer.
        pointer: String,
        /// By how much the nearest velocities miss it, relative to the size of its rows, 1/s.
        missed: f64,
        /// What the last good state tells.
        last: LastGood,
    },
    /// Rounding cannot tell the rows of a joint from redundant ones.
    #[error(
        "the masses are too different: between {light_mass:.1e} kg of \"{light}\" and {heavy_mass:.1e} kg of \"{heavy}\" \
         rounding cannot tell whether joint \"{joint}\" holds"
    )]
    MassesTooDifferent {
        /// The joint.
        joint: String,
        /// Where it stands in the scene, as a JSON pointer.
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
    /// The step control found no step that meets the tolerance.
    #[error("the integration stops at t = {time:.6} s: no step above {step:.1e} s meets the tolerance{last}")]
    StepTooSmall {
        /// Time, s.
        time: f64,
        /// The step that was refused, s.
        step: f64,
        /// What the last good state tells.
        last: LastGood,
    },
    /// The accelerations are no longer finite.
    #[error("the run diverges at t = {time:.6} s: accelerations are no longer finite numbers{last}")]
    Diverged {
        /// Time, s.
        time: f64,
        /// What the last good state tells.
        last: LastGood,
    },
    /// The equations of an implicit step cannot be solved.
    #[error(
        "the integration stops at t = {time:.6} s: the equations of a step of {step:.1e} s cannot be solved{last}"
    )]
    NoConvergence {
        /// Time, s.
        time: f64,
        /// The step that was tried, s.
        step: f64,
        /// What the last good state tells.
        last: LastGood,
    },
    /// Steps have become so small that the run would never end.
    #[error(
        "the run stalls at t = {time:.6} s: its steps have shrunk to {step:.1e} s, and more than 1e9 of them are left{last}"
    )]
    Stalled {
        /// Time, s.
        time: f64,
        /// Their size, s.
        step: f64,
        /// What the last good state tells.
        last: LastGood,
    },
    /// There are no independent coordinates to integrate.
    #[error(
        "at t = {time:.6} s no independent coordinates can be chosen: nothing is free to move, or a singular position leaves open what is{last}"
    )]
    Undetermined {
        /// Time, s.
        time: f64,
        /// What the last good state tells.
        last: LastGood,
    },
    /// The constraints can no longer be satisfied.
    #[error(
        "the run stops at t = {time:.6} s: joint \"{joint}\" is open by {violation:.3e} of the mechanism's size{}{last}",
        contradiction(with)
    )]
    ConstraintsLost {
        /// Time, s.
        time: f64,
        /// The joint or driver whose rows are violated most.
        joint: String,
        /// Those that are open with it.
        with: Vec<String>,
        /// Largest violation relative to the size of the row.
        violation: f64,
        /// What the last good state tells.
        last: LastGood,
    },
    /// The run has used up the steps that it was given.
    #[error("the run stops at t = {time:.6} s: its {steps} steps are used up{last}")]
    StepLimit {
        /// Time, s.
        time: f64,
        /// How many steps it was given.
        steps: u64,
        /// What the last state tells.
        last: LastGood,
    },
    /// A time outside the run was asked for.
    #[error("t = {time} s is outside the run, which goes from {from} s to {to} s")]
    TimeOutside {
        /// The time asked for, s.
        time: f64,
        /// First time that can be reached, s.
        from: f64,
        /// Last time, s.
        to: f64,
    },
}

/// Names of joints that are open together with the worst one.
fn contradiction(with: &[String]) -> String {
    if with.is_empty() { String::new() } else { format!(", and with it {}", listed(with)) }
}

/// Names of what contradicts a driver.
fn together(with: &[String]) -> String {
    if with.is_empty() { String::new() } else { format!(" together with {}", listed(with)) }
}

impl EngineError {
    /// A stop of an integrator, told with the last good state.
    pub fn stopped(stop: Stop, last: LastGood) -> Self {
        match stop {
            Stop::StepTooSmall { time, step } => Self::StepTooSmall { time, step, last },
            Stop::NotFinite { time } => Self::Diverged { time, last },
            Stop::NoConvergence { time, step } => Self::NoConvergence { time, step, last },
            Stop::Undetermined { time } => Self::Undetermined { time, last },
            Stop::Stalled { time, step } => Self::Stalled { time, step, last },
        }
    }

    /// The same error, told with the last good state.
    #[must_use]
    pub fn after(mut self, good: LastGood) -> Self {
        if let Self::Diverged { last, .. }
        | Self::ConstraintsLost { last, .. }
        | Self::MotionImpossible { last, .. } = &mut self
        {
            *last = good;
        }
        self
    }

    /// Stable name of the kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Scene(SceneError::TooLong { .. }) => "scene-too-long",
            Self::Scene(SceneError::Syntax { .. }) => "scene-syntax",
            Self::Scene(SceneError::TooMany { .. }) => "scene-too-large",
            Self::Scene(SceneError::NoNumber { .. }) => "no-such-number",
            Self::Scene(SceneError::UnknownParameter { .. }) => "unknown-parameter",
            Self::Scene(SceneError::OutsideParameter { .. }) => "outside-parameter",
            Self::Catalogue(error) => error.code(),
            Self::Model(error) => error.code(),
            Self::Uniqueness(error) => error.code(),
            Self::Assembly { .. } => "assembly-failed",
            Self::StartTooFar { .. } => "start-too-far",
            Self::MotionImpossible { .. } => "motion-impossible",
            Self::MassesTooDifferent { .. } => "masses-too-different",
            Self::StepTooSmall { .. } => "step-too-small",
            Self::Diverged { .. } => "diverged",
            Self::NoConvergence { .. } => "no-convergence",
            Self::Stalled { .. } => "stalled",
            Self::Undetermined { .. } => "undetermined-motion",
            Self::ConstraintsLost { .. } => "constraints-lost",
            Self::StepLimit { .. } => "step-limit",
            Self::TimeOutside { .. } => "time-outside-run",
        }
    }

    /// Where in the scene, as a JSON pointer, if it is at one place.
    pub fn pointer(&self) -> Option<String> {
        match self {
            Self::Scene(SceneError::Syntax { pointer, .. } | SceneError::NoNumber { pointer, .. }) => {
                Some(pointer.clone())
            }
            Self::Scene(SceneError::TooMany { what, .. }) => Some(format!("/{what}")),
            Self::Model(error) => Some(error.pointer()),
            Self::Assembly { pointer, .. }
            | Self::StartTooFar { pointer, .. }
            | Self::MotionImpossible { pointer, .. }
            | Self::MassesTooDifferent { pointer, .. } => Some(pointer.clone()),
            _ => None,
        }
    }

    /// Why no way leads on from the last good state, if it can be told.
    pub fn cause(&self) -> Option<&Cause> {
        match self {
            Self::StepTooSmall { last, .. }
            | Self::Diverged { last, .. }
            | Self::NoConvergence { last, .. }
            | Self::Stalled { last, .. }
            | Self::Undetermined { last, .. }
            | Self::MotionImpossible { last, .. }
            | Self::ConstraintsLost { last, .. }
            | Self::StepLimit { last, .. } => last.cause.as_deref(),
            _ => None,
        }
    }

    /// What to try.
    pub fn hint(&self) -> String {
        if let Some(cause) = self.cause().filter(|_| !matches!(self, Self::Undetermined { .. })) {
            return cause.hint().to_owned();
        }
        match self {
            Self::Scene(SceneError::TooLong { .. } | SceneError::TooMany { .. }) => {
                "Split the mechanism, or leave out what does not move.".to_owned()
            }
            Self::Scene(SceneError::Syntax { .. }) => {
                "Compare the place with the JSON Schema of a scene (`triad schema`).".to_owned()
            }
            Self::Scene(SceneError::NoNumber { .. }) => {
                "Name a place that holds a number, by keys and places in lists from 0, like /bodies/0/mass.".to_owned()
            }
            Self::Scene(SceneError::UnknownParameter { known, .. }) if known.is_empty() => {
                "This scene offers no parameters; change a number by its JSON pointer instead.".to_owned()
            }
            Self::Scene(SceneError::UnknownParameter { known, .. }) => {
                format!("Its parameters are {}.", known.join(", "))
            }
            Self::Scene(SceneError::OutsideParameter { low, high, .. }) => {
                format!("Choose a value from {low} to {high}, or change the number by its JSON pointer.")
            }
            Self::Catalogue(error) => error.hint(),
            Self::Model(error) => error.hint(),
            Self::Uniqueness(error) => error.hint(),
            Self::Assembly { .. } | Self::StartTooFar { .. } => {
                "Check the points and axes of that joint on both of its bodies, and the positions of the bodies."
                    .to_owned()
            }
            Self::MotionImpossible { .. } => {
                "Let the driver stand still there, free one of the joints that are named, or leave out one of two drivers \
                 that contradict each other: `triad check` tells the degrees of freedom."
                    .to_owned()
            }
            Self::MassesTooDifferent { .. } => {
                "Make the light bodies heavier, or leave them out: a rod without mass between two bodies is a joint of \
                 the kind \"rod\"."
                    .to_owned()
            }
            Self::StepTooSmall { .. } | Self::Stalled { .. } | Self::Diverged { .. } => {
                "Loosen the tolerance, use projection as the stabilization, and look at the last good state for a \
                 joint that locks or a body that is far too light."
                    .to_owned()
            }
            Self::NoConvergence { .. } => {
                "Tighten the tolerance, which shortens the steps; through singular positions use taylor or dop853 with \
                 projection."
                    .to_owned()
            }
            Self::Undetermined { .. } => {
                "Use projection as the stabilization, with taylor or dop853; a mechanism whose drivers prescribe all of \
                 its motion has nothing to integrate: see `triad kinematics`."
                    .to_owned()
            }
            Self::ConstraintsLost { .. } => {
                "Look at the last good state: a driver asks for more than the joints allow, two of them contradict each \
                 other, masses or stiffnesses are too different for the tolerance, or the stabilization is too weak."
                    .to_owned()
            }
            Self::StepLimit { .. } => {
                "Allow more steps, loosen the tolerance, or look for a stiff spring or a fast driver.".to_owned()
            }
            Self::TimeOutside { .. } => "Ask for a time within the run, or reset it first.".to_owned(),
        }
    }
}
