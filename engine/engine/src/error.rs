//! The errors of the engine, from reading a scene to the end of a run.

mod last_good;

pub use last_good::{Cause, LastGood};

use crate::catalogue::CatalogueError;
use crate::integrate::StopReason;
use crate::reactions::uniqueness::UniquenessError;
use crate::scene::IntegratorKind;
use crate::scene::SceneError;
use crate::scene::text::{nearest_name, short};
use triad_dynamics::constraints::ConstraintError;
use triad_dynamics::model::{CustomLoadError, ModelError};

/// Any error of the engine: what went wrong, where in the scene, and what to try.
///
/// ```
/// use triad_engine::prelude::*;
///
/// let mut scene = Scene::new("sign");
/// scene.add(Body::new("stone", -1.0));
/// let error = scene.simulate(0.0..1.0).unwrap_err();
/// assert!(error.to_string().contains("stone") && !error.hint().is_empty());
/// assert_eq!(error.pointer().as_deref(), Some("/bodies/0/mass"));
/// ```
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EngineError {
    /// The text is not a scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// There is no built-in scene of that name.
    #[error(transparent)]
    Catalogue(#[from] CatalogueError),
    /// The scene describes no mechanism.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// It cannot be decided which reactions are unique.
    #[error(transparent)]
    Uniqueness(#[from] UniquenessError),
    /// The constraints cannot be satisfied.
    #[error("{error}{}", last.as_ref().map(ToString::to_string).unwrap_or_default())]
    Constraint {
        /// Which constraints, and by how much they are violated.
        error: Box<ConstraintError>,
        /// What is known of the last good state, if the run had started.
        last: Option<LastGood>,
    },
    /// A custom load cannot be evaluated.
    #[error("{error}{}", last.as_ref().map(ToString::to_string).unwrap_or_default())]
    CustomLoad {
        /// Which load, and why.
        error: CustomLoadError,
        /// What is known of the last good state, if the run had started.
        last: Option<LastGood>,
    },
    /// The step control found no step that meets the tolerance.
    #[error("the integration stops at t = {time:.6} s: no step above {step:.1e} s meets the tolerance{last}")]
    StepTooSmall {
        /// Time, s.
        time: f64,
        /// The step that was refused, s.
        step: f64,
        /// What is known of the last good state.
        last: LastGood,
    },
    /// The accelerations are no longer finite.
    #[error("the run diverges at t = {time:.6} s: accelerations are no longer finite numbers{last}")]
    Diverged {
        /// Time, s.
        time: f64,
        /// What is known of the last good state.
        last: LastGood,
    },
    /// Steps of one size are too long to count the turns of a joint.
    #[error(
        "the integration stops at t = {time:.6} s: within a step of {step:.1e} s the turning of a joint changes so much that its whole turns are not known{last}"
    )]
    TurnsUnknown {
        /// Time, s.
        time: f64,
        /// The step that was tried, s.
        step: f64,
        /// What is known of the last good state.
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
        /// What is known of the last good state.
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
        /// What is known of the last good state.
        last: LastGood,
    },
    /// There are no independent coordinates to integrate.
    #[error(
        "at t = {time:.6} s no independent coordinates can be chosen: a singular position leaves open what is free to move{last}"
    )]
    Undetermined {
        /// Time, s.
        time: f64,
        /// What is known of the last good state.
        last: LastGood,
    },
    /// An integrator that the scene asks for without what it needs, or with what it does not know.
    #[error("{integrator} cannot run this scene: {why}")]
    Integrator {
        /// The integrator.
        integrator: IntegratorKind,
        /// Why not.
        why: &'static str,
    },
    /// The run has reached its limit of steps.
    #[error("the run stops at t = {time:.6} s: its {steps} steps are used up{last}")]
    StepLimit {
        /// Time, s.
        time: f64,
        /// The limit.
        steps: u64,
        /// What is known of the last good state.
        last: LastGood,
    },
    /// A requested time is outside the run.
    #[error("t = {time} s is outside the run, which goes from {from} s to {to} s", time = short(*time), from = short(*from), to = short(*to))]
    TimeOutside {
        /// The requested time, s.
        time: f64,
        /// First time that can be reached, s.
        from: f64,
        /// Last time, s.
        to: f64,
    },
    /// The scene has no body, joint, driver or event of a requested name.
    #[error("there is no {what} \"{name}\"")]
    UnknownName {
        /// What the name should belong to: "body", "joint", "driver" or "event".
        what: &'static str,
        /// The name.
        name: String,
        /// The nearest name that there is.
        nearest: Option<String>,
    },
}

impl From<ConstraintError> for EngineError {
    fn from(error: ConstraintError) -> Self {
        if let ConstraintError::NotFinite { time } = error {
            return Self::Diverged { time, last: LastGood::default() };
        }
        let last = error.is_during_motion().then(LastGood::default);
        Self::Constraint { error: Box::new(error), last }
    }
}

impl From<CustomLoadError> for EngineError {
    fn from(error: CustomLoadError) -> Self {
        Self::CustomLoad { error, last: None }
    }
}

impl EngineError {
    /// The error for an integrator that stopped, with the last good state.
    pub fn stopped(stop: StopReason, last: LastGood) -> Self {
        match stop {
            StopReason::StepTooSmall { time, step } => Self::StepTooSmall { time, step, last },
            StopReason::NotFinite { time } => Self::Diverged { time, last },
            StopReason::TurnsUnknown { time, step } => Self::TurnsUnknown { time, step, last },
            StopReason::NoConvergence { time, step } => Self::NoConvergence { time, step, last },
            StopReason::Undetermined { time } => Self::Undetermined { time, last },
            StopReason::Stalled { time, step } => Self::Stalled { time, step, last },
            StopReason::Alone => Self::Integrator {
                integrator: IntegratorKind::Trapezoidal,
                why: "it is the partner of the augmented Lagrangian alone",
            },
        }
    }

    /// The error for a name that is not among the known ones.
    pub(crate) fn unknown<'a>(what: &'static str, name: &str, known: impl Iterator<Item = &'a str>) -> Self {
        Self::UnknownName { what, name: name.to_owned(), nearest: nearest_name(name, known) }
    }

    /// The same error with the last good state.
    #[must_use]
    pub fn after(mut self, good: LastGood) -> Self {
        match &mut self {
            Self::Diverged { last, .. } | Self::Constraint { last: Some(last), .. } => *last = good,
            _ => {}
        }
        self
    }

    /// Stable code of the kind of error, for programs.
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
            Self::Constraint { error, .. } => error.code(),
            Self::CustomLoad { error, .. } => error.code(),
            Self::StepTooSmall { .. } => "step-too-small",
            Self::Diverged { .. } => "diverged",
            Self::TurnsUnknown { .. } => "turns-unknown",
            Self::NoConvergence { .. } => "no-convergence",
            Self::Stalled { .. } => "stalled",
            Self::Undetermined { .. } => "undetermined-motion",
            Self::Integrator { integrator: IntegratorKind::Trapezoidal, .. } => "integrator-alone",
            Self::Integrator { .. } => "integrator-unable",
            Self::StepLimit { .. } => "step-limit",
            Self::TimeOutside { .. } => "time-outside-run",
            Self::UnknownName { .. } => "unknown-name",
        }
    }

    /// The place in the scene as a JSON pointer, if the error belongs to one place.
    pub fn pointer(&self) -> Option<String> {
        match self {
            Self::Scene(SceneError::Syntax { pointer, .. } | SceneError::NoNumber { pointer, .. }) => {
                Some(pointer.clone())
            }
            Self::Scene(SceneError::TooMany { what, .. }) => Some(format!("/{what}")),
            Self::Model(error) => Some(error.pointer()),
            Self::Constraint { error, .. } => error.pointer().map(str::to_owned),
            Self::Integrator { .. } => Some("/simulation/integrator".to_owned()),
            _ => None,
        }
    }

    /// Why the motion cannot continue from the last good state, if that was found.
    pub fn cause(&self) -> Option<&Cause> {
        self.last_good()?.cause.as_deref()
    }

    /// What is known of the last good state.
    fn last_good(&self) -> Option<&LastGood> {
        match self {
            Self::StepTooSmall { last, .. }
            | Self::Diverged { last, .. }
            | Self::TurnsUnknown { last, .. }
            | Self::NoConvergence { last, .. }
            | Self::Stalled { last, .. }
            | Self::Undetermined { last, .. }
            | Self::Constraint { last: Some(last), .. }
            | Self::StepLimit { last, .. } => Some(last),
            _ => None,
        }
    }

    /// What to try where steps of one size, s, are the likeliest reason.
    fn hint_of_steps(&self, size: f64) -> Option<String> {
        let lost =
            matches!(self, Self::Constraint { error, .. } if matches!(**error, ConstraintError::Lost { .. }));
        match self {
            Self::NoConvergence { .. } => Some(format!(
                "Take shorter steps than those of {size} s, or leave their size to the tolerance; through singular positions use \
                 taylor or dop853 with projection."
            )),
            Self::Diverged { .. } => Some(too_long(size)),
            _ => lost.then(|| too_long(size)),
        }
    }

    /// What to try.
    pub fn hint(&self) -> String {
        let undetermined = matches!(self, Self::Undetermined { .. });
        if let Some(cause) = self.cause().filter(|_| !undetermined) {
            return cause.hint().to_owned();
        }
        let size = self.last_good().and_then(|last| last.size);
        size.and_then(|size| self.hint_of_steps(size)).unwrap_or_else(|| self.remedy())
    }

    /// What to try where nothing is known but what went wrong.
    fn remedy(&self) -> String {
        match self {
            Self::Scene(SceneError::TooLong { .. } | SceneError::TooMany { .. }) => {
                "Split the mechanism, or leave out what does not move.".to_owned()
            }
            Self::Scene(error @ SceneError::Syntax { .. }) => error.meant().unwrap_or_else(|| {
                "Compare the place with the JSON Schema of a scene (`triad schema`).".to_owned()
            }),
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
            Self::Constraint { error, .. } => error.hint().to_owned(),
            Self::CustomLoad { error, .. } => error.hint(),
            Self::StepTooSmall { .. } | Self::Stalled { .. } | Self::Diverged { .. } => {
                "Loosen the tolerance, use projection as the stabilization, and look at the last good state for a \
                 joint that locks or a body that is far too light."
                    .to_owned()
            }
            Self::TurnsUnknown { .. } => {
                "Take shorter steps, or none of one size: methods that choose their steps count turns.".to_owned()
            }
            Self::NoConvergence { .. } => {
                "Tighten the tolerance, which shortens the steps; through singular positions use taylor or dop853 with \
                 projection."
                    .to_owned()
            }
            Self::Undetermined { .. } => {
                "Use projection as the stabilization, with taylor or dop853.".to_owned()
            }
            Self::Integrator { integrator: IntegratorKind::Trapezoidal, .. } => {
                "Ask for the stabilization augmented-lagrangian, which brings it along, or leave the integrator to auto."
                    .to_owned()
            }
            Self::Integrator { .. } => {
                "Leave the integrator to auto and the constraints to projection, or ask for dop853, dopri5, ode45 or radau."
                    .to_owned()
            }
            Self::StepLimit { .. } => {
                "Allow more steps, loosen the tolerance, or look for a stiff spring or a fast driver.".to_owned()
            }
            Self::TimeOutside { time, from, .. } => later_or_earlier(*time, *from).to_owned(),
            Self::UnknownName { nearest: Some(nearest), .. } => format!("Did you mean \"{nearest}\"?"),
            Self::UnknownName { what, .. } => format!("Ask for a {what} by its name in the scene."),
        }
    }
}

/// What to try in place of a time outside a run that has what is from `from` on, s.
fn later_or_earlier(time: f64, from: f64) -> &'static str {
    // Only a run that has gone on has times behind it.
    if from > 0.0 && time < from {
        "Ask for a later time, or reset the run first."
    } else {
        "Ask for a time within the run: it ends after the \"duration\" in the scene's \"simulation\", or at an event that \
         stops it."
    }
}

/// What to try after steps of that size, s.
fn too_long(size: f64) -> String {
    format!("Take shorter steps than those of {size} s, or leave their size to the tolerance.")
}
