//! What is known of the last good state of a run that stopped, and why the run could not go on from there.

use std::fmt;
use triad_dynamics::constraints::quoted;

/// What is known of the last good state of a run that stopped.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LastGood {
    /// Accepted steps until then.
    pub steps: u64,
    /// Their size, s, where the scene gives it.
    pub size: Option<f64>,
    /// Why the motion cannot continue from there, if that was found.
    pub cause: Option<Box<Cause>>,
}

/// Why a motion cannot continue from a state.
#[derive(Clone, Debug, PartialEq)]
pub enum Cause {
    /// A driver asks for positions that the joints do not allow.
    OutOfReach {
        /// The driver, or all drivers of the scene if it is not known which.
        drivers: Vec<String>,
        /// The time at which it does, s.
        time: f64,
        /// Joints and drivers that are violated there, the worst first.
        open: Vec<String>,
    },
    /// The rows of a joint or driver come to depend on others: a singular position.
    Losing {
        /// The joint or driver.
        joint: String,
        /// The product of its relative pivots beside that at the start.
        pivot_product: f64,
        /// Whether the run was made in the way that passes singular positions best: then its tolerance was too tight.
        best_way: bool,
    },
    /// The rows of a joint or driver nearly depend on others since the start.
    Weak {
        /// The joint or driver.
        joint: String,
        /// The product of its relative pivots.
        pivot_product: f64,
    },
    /// Joints allow bodies without inertia about some axes a motion in which they lend them next to none.
    WithoutInertia {
        /// When that was seen first, s.
        time: f64,
        /// The bodies.
        bodies: Vec<String>,
    },
    /// Dry friction raises the reaction that loads it by more than that raises the friction: no motion satisfies both.
    Locked {
        /// The load with the friction.
        load: String,
    },
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfReach { drivers, time, open } => write!(
                f,
                "driver {} asks for more than the joints allow: at t = {time:.6} s no position nearby closes {}",
                quoted(drivers),
                if open.is_empty() { "all of them".to_owned() } else { quoted(open) }
            ),
            Self::Losing { joint, pivot_product, .. } => {
                write!(f, "\"{joint}\" is about to lose its hold, of which {pivot_product:.0e} is left")
            }
            Self::Weak { joint, pivot_product } => {
                write!(
                    f,
                    "\"{joint}\" hardly holds since the start, where others leave it {pivot_product:.0e} of a firm hold"
                )
            }
            Self::WithoutInertia { time, bodies } => write!(
                f,
                "at t = {time:.6} s joints lend {} next to no inertia in a motion that they allow: how fast it is there depends on \
                 moments of inertia that the scene leaves out",
                quoted(bodies)
            ),
            Self::Locked { load } => write!(
                f,
                "the friction of \"{load}\" locks: it presses its joint together faster than it can hold, and no motion \
                 satisfies both"
            ),
        }
    }
}

impl Cause {
    /// What to try.
    pub(super) fn hint(&self) -> &'static str {
        match self {
            Self::OutOfReach { .. } => {
                "Look at the last good state: let the driver ask for less, change lengths, or end the run before."
            }
            Self::Losing { best_way: true, .. } => {
                "Loosen the tolerance, tenfold at first: the mechanism comes to a singular position, near which rounding is larger \
                 than this one allows. Else change lengths, or end the run before."
            }
            Self::Losing { .. } => {
                "Look at the last good state: the mechanism comes to a singular position. Use taylor or dop853 with \
                 projection, change lengths, or end the run before."
            }
            Self::Weak { .. } => {
                "Move the points or axes of that joint away from the singular position that it starts in, or leave it out \
                 if others hold the same."
            }
            Self::WithoutInertia { .. } => {
                "Give these bodies moments of inertia about every axis, as real ones have."
            }
            Self::Locked { .. } => {
                "A real mechanism stops here with a jolt. Take a smaller coefficient, a longer guide or a thinner pin, or end the \
                 run before."
            }
        }
    }
}

impl fmt::Display for LastGood {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, " (after {} step{}", self.steps, if self.steps == 1 { "" } else { "s" })?;
        if let Some(cause) = &self.cause {
            write!(f, "; {cause}")?;
        }
        f.write_str(")")
    }
}
