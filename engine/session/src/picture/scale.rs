//! How long forces and moments are drawn: one scale for the whole scene.

use super::sample::{Sample, SampledReaction};
use super::vector::norm;

/// How long arrows are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// m/N.
    pub force: f64,
    /// Radius of a moment's circle, m/(N m).
    pub moment: f64,
    /// The longest arrow that is drawn, m; a circle is at most half as large.
    pub longest: f64,
}

/// The part of the forces of a recording that are drawn at full length or shorter: outliers do not set the scale.
const PERCENTILE: f64 = 0.95;
/// Full length of a force's arrow, relative to the size of the mechanism.
const FULL: f64 = 0.5;
/// Full radius of a moment's circle, relative to the size of the mechanism.
const FULL_CIRCLE: f64 = 0.22;
/// Length of the longest arrow, relative to the size of the mechanism.
const LONGEST: f64 = 0.8;
/// A moment below this part of the force of the same joint times the mechanism's size is rounding.
pub const NO_MOMENT: f64 = 1e-7;

impl Scale {
    /// Before anything is recorded: the weight of everything is drawn at full length.
    pub fn of_weight(weight: f64, size: f64) -> Self {
        let force = FULL * size / if weight > 0.0 { weight } else { 1.0 };
        Self { force, moment: FULL_CIRCLE / FULL * force / size.max(1e-9), longest: LONGEST * size }
    }

    /// From a recording; what it has none of keeps its scale.
    #[must_use]
    pub fn fitted<'a>(self, samples: impl Iterator<Item = &'a Sample>, size: f64) -> Self {
        let (mut forces, mut moments) = (Vec::new(), Vec::new());
        for sample in samples {
            forces.extend(sample.reactions.iter().map(|r| norm(r.force)));
            moments.extend(
                sample.reactions.iter().filter(|r| has_moment(r, size)).map(|reaction| norm(reaction.moment)),
            );
            forces.extend(sample.weights.iter().copied().map(norm));
        }
        let scaled = |sizes: Vec<f64>, length: f64, old: f64| {
            percentile(sizes).map_or(old, |full| length * size / full)
        };
        Self {
            force: scaled(forces, FULL, self.force),
            moment: scaled(moments, FULL_CIRCLE, self.moment),
            ..self
        }
    }

    /// Whether another scale differs too little to be seen.
    pub fn is_near(self, other: Self) -> bool {
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 0.2;
        near(self.force, other.force) && near(self.moment, other.moment)
    }
}

fn percentile(mut sizes: Vec<f64>) -> Option<f64> {
    sizes.retain(|size| size.is_finite() && *size > 0.0);
    if sizes.is_empty() {
        return None;
    }
    // The place is within the list because the part is below one.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let at = (PERCENTILE * sizes.len() as f64) as usize;
    let at = at.min(sizes.len() - 1);
    let (_, found, _) = sizes.select_nth_unstable_by(at, f64::total_cmp);
    Some(*found)
}

/// Whether a reaction has a moment that is more than rounding.
pub fn has_moment(reaction: &SampledReaction, size: f64) -> bool {
    norm(reaction.moment) > NO_MOMENT * size * norm(reaction.force).max(1e-300)
}
