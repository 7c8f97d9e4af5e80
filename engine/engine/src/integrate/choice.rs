//! Which integrator a scene gets, and why.

mod stiffness;

use super::taylor::Taylor;
use crate::scene::{ConstraintMethod, IntegratorKind};
use stiffness::stiffness;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::system::System;

/// Tolerance above which order 5 needs less work than order 8 (docs/PERFORMANCE.md).
const LOOSE_TOLERANCE: f64 = 1e-5;

/// The integrator that a scene asks for, or the best one for it, and the reason.
///
/// y is the state at time 0.
pub fn choose(mechanism: &mut Mechanism, y: &[f64]) -> (IntegratorKind, String) {
    let settings = &mechanism.system.model.settings;
    let method = settings.constraint_method;
    let free_choice = settings.integrator == IntegratorKind::Auto && settings.step.is_none();
    if free_choice
        && matches!(method, ConstraintMethod::Projection | ConstraintMethod::Partitioning)
        && let Some(why) = stiffness(mechanism, 0.0, y)
    {
        return (IntegratorKind::Radau, why);
    }
    mechanism.set_state(0.0, y);
    let settings = &mechanism.system.model.settings;
    if let ConstraintMethod::AugmentedLagrangian { .. } = method {
        let why = match settings.integrator {
            IntegratorKind::Auto | IntegratorKind::Trapezoidal => String::new(),
            requested => format!("{requested} was asked for, but "),
        };
        let why = format!("{why}the augmented Lagrangian is solved together with the trapezoidal rule");
        return (IntegratorKind::Trapezoidal, why);
    }
    let dry = mechanism.system.frictions.first().map(|dry| &mechanism.system.model.loads[dry.load].name);
    let obstacle = if let Some(load) = dry {
        Some(format!(
            "friction of \"{load}\" follows from the reactions, which have no series before the motion has"
        ))
    } else if let Some(load) = mechanism.system.model.custom_loads.first() {
        Some(format!("load \"{}\" is a function without a power series", load.name))
    } else if method == ConstraintMethod::Projection {
        settings.step.map(|_| "a series takes no steps of a size that is given".to_owned())
    } else {
        Some(format!("{method} belongs to Runge-Kutta methods"))
    };
    match (settings.integrator, obstacle) {
        (IntegratorKind::Auto, None) => series_or_dop853(mechanism, y),
        (IntegratorKind::Auto, Some(obstacle)) if settings.tolerance > LOOSE_TOLERANCE => {
            (IntegratorKind::Dopri5, format!("{obstacle}, and the tolerance is loose"))
        }
        (IntegratorKind::Auto, Some(obstacle)) => (IntegratorKind::Dop853, obstacle),
        (IntegratorKind::Taylor, Some(obstacle)) => {
            (IntegratorKind::Dop853, format!("taylor was asked for, but {obstacle}"))
        }
        (requested, _) => match conflict(requested, method) {
            Some(why) => (IntegratorKind::Dop853, format!("{requested} was asked for, but {why}")),
            None => (requested, "the scene asks for it".to_owned()),
        },
    }
}

/// Taylor series, unless breakpoints of prescribed motions would end their steps far too early.
fn series_or_dop853(mechanism: &Mechanism, y: &[f64]) -> (IntegratorKind, String) {
    let settings = &mechanism.system.model.settings;
    let System { curves, targets, loads, .. } = &mechanism.system;
    let prescribed = !(curves.is_empty() && targets.is_empty() && loads.is_empty());
    if prescribed && Taylor::new(mechanism, 0.0, y, settings.tolerance).breakpoints_dense(settings.duration) {
        (
            IntegratorKind::Dop853,
            "the knots of prescribed motions follow so closely that a series would end at each of them long before its \
             reach"
                .to_owned(),
        )
    } else {
        (
            IntegratorKind::Taylor,
            "every row and load of the scene has a recurrence, so that one factorization serves a whole step"
                .to_owned(),
        )
    }
}

/// Why an integrator that satisfies the constraints in its own way cannot be combined with a constraint method.
fn conflict(requested: IntegratorKind, method: ConstraintMethod) -> Option<&'static str> {
    use ConstraintMethod::{Partitioning, Projection};
    match (requested, method) {
        (IntegratorKind::Radau, Projection | Partitioning) | (IntegratorKind::Rattle, Projection) => None,
        (IntegratorKind::Radau | IntegratorKind::Rattle, _) => Some(
            "it satisfies the constraints at each step by itself, and leaves nothing for another treatment",
        ),
        _ => None,
    }
}
