//! The reaction of one joint or driver over time.

use super::Motion;
use crate::arrays::{Numbers, shaped, truths};
use crate::refusal::Refusal;
use pyo3::prelude::*;
use triad_engine::reactions::report::{Convention, Reaction, ReactionComponent};

/// Force and moment at all outputs, which of their numbers are unique, about which points and along which axes.
#[pyclass(frozen, get_all, module = "triad._native")]
pub struct Reactions {
    /// The body that it acts on.
    on: String,
    /// The body that exerts it.
    by: String,
    /// The point of the moment, in words.
    point: String,
    /// The frame of the components, in words.
    frame: String,
    /// Forces, N: (n, 3).
    force: Numbers,
    /// Moments, N m: (n, 3).
    moment: Numbers,
    /// Whether the equations of motion determine each number of the force: (n, 3).
    force_unique: Numbers,
    /// The same of the moment.
    moment_unique: Numbers,
    /// That point in the world, m: (n, 3).
    point_at: Numbers,
    /// The axes of the frame in the world: (n, 3, 3), one in each row.
    axes: Numbers,
    /// Joints that share rows that depend on each other, and what to relax: JSON, of the first output.
    redundancies: String,
}

/// Of a joint or driver of a run.
pub fn of(motion: &Motion, py: Python<'_>, joint: &str, convention: &str) -> PyResult<Reactions> {
    let convention: Convention = serde_json::from_str(convention).map_err(Refusal::from)?;
    let model = motion.run.model();
    let names = || {
        let drivers = model.drivers.iter().map(|driver| driver.name.as_str());
        model.joints.iter().map(|joint| joint.name.as_str()).chain(drivers)
    };
    if names().all(|name| name != joint) {
        return Err(Refusal::unknown("joint or driver", joint, names()).into());
    }
    let mut redundancies = None;
    let found = motion.at_outputs(py, |state| {
        let report = state.reactions(convention)?;
        let reaction = report.reactions.into_iter().find(|reaction| reaction.joint == joint);
        Ok((reaction, report.redundancies))
    })?;
    let mut all: Vec<Reaction> = Vec::with_capacity(found.len());
    for (reaction, shared) in found {
        redundancies.get_or_insert(shared);
        all.extend(reaction);
    }
    let n = all.len();
    let values = |of: fn(&Reaction) -> &[ReactionComponent; 3]| -> Vec<f64> {
        all.iter().flat_map(|reaction| of(reaction).map(|component| component.value)).collect()
    };
    let unique = |of: fn(&Reaction) -> &[ReactionComponent; 3]| -> Vec<bool> {
        all.iter().flat_map(|reaction| of(reaction).map(|component| component.unique)).collect()
    };
    let words =
        |of: fn(&Reaction) -> &str| all.first().map_or_else(String::new, |reaction| of(reaction).to_owned());
    let axes: Vec<f64> = all.iter().flat_map(|reaction| reaction.axes).flatten().collect();
    Ok(Reactions {
        on: words(|reaction| &reaction.on),
        by: words(|reaction| &reaction.by),
        point: words(|reaction| &reaction.about),
        frame: words(|reaction| &reaction.expressed_in),
        force: shaped(py, values(|reaction| &reaction.force), &[n, 3])?,
        moment: shaped(py, values(|reaction| &reaction.moment), &[n, 3])?,
        force_unique: truths(py, unique(|reaction| &reaction.force), &[n, 3])?,
        moment_unique: truths(py, unique(|reaction| &reaction.moment), &[n, 3])?,
        point_at: shaped(py, all.iter().flat_map(|reaction| reaction.about_at).collect(), &[n, 3])?,
        axes: shaped(py, axes, &[n, 3, 3])?,
        redundancies: serde_json::to_string(&redundancies.unwrap_or_default()).map_err(Refusal::from)?,
    })
}
