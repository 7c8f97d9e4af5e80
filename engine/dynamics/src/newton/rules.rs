//! When a projection stops: what "consistent" means, and the rule of each use beside those of the others.
//!
//! | rule | use | factor | stops at | corrections at most |
//! |---|---|---|---|---|
//! | [`ASSEMBLY_POSITIONS`] | the start of a run, a held position, the probe of the rank | each time | consistent, stalled | 40 |
//! | [`ROUGH_POSITIONS`] | a start from anywhere, by short steps | each time | consistent, stalled | 200 |
//! | [`KINEMATICS_POSITIONS`] | a position of a driven mechanism | each time | a tenth of consistent, stalled | 60 |
//! | [`CHART_POSITIONS`] | a position with given independent coordinates | every 4 | consistent, stalled after 5 | 30 |
//! | [`AHEAD_POSITIONS`] | a position beyond a singular one | each time | consistent, stalled | 4 |
//! | [`PASSAGE_POSITIONS`] | a position beside a singular one | each time | the next would be consistent, stalled | 12 |
//! | [`PASSAGE_VELOCITIES`] | its velocities | at hand | the next would be consistent, stalled | 3 |
//! | [`STEP_POSITIONS`] | the end of a step | at hand | consistent, stalled | 3 |
//! | [`SERIES_POSITIONS`] | the end of a step of the series | once | the next would be consistent | 3 |
//! | [`ASSEMBLY_VELOCITIES`] | the start of a run | once | consistent, stalled | 12 |
//! | [`CHART_VELOCITIES`] | a velocity with given independent coordinates | at hand | consistent, stalled after 5 | 30 |
//! | [`STEP_VELOCITIES`] | the end of a step | at hand | consistent, stalled | 2 |
//! | [`SERIES_VELOCITIES`] | the end of a step of the series | at hand | — | 1 |
//! | [`AWAY_VELOCITIES`] | the probe of the rank: a way out of the position | at hand | consistent, stalled | 2 |
//! | [`KINEMATICS_VELOCITIES`] | a velocity of a driven mechanism | once | — | 4 |
//! | [`ROUGH_VELOCITIES`] | a start with pinned bodies | once | — | 6 |
//!
//! Where two rules differ without need, the reason is that answers would change in their last digits.

use super::Ending;

/// A correction of at most this part of the size of the mechanism, its length, shows that a state is consistent: what is left
/// is rounding, a few hundred units in the last place (2.2e-16) in sums over its bodies.
pub const CONSISTENT: f64 = 1e-13;
/// A correction of at most this part of the same size that no longer halves is rounding as well: in a long chain, or near a
/// singular position, corrections do not reach [`CONSISTENT`].
pub const STALLED: f64 = 1e-9;

/// When S is factored in a projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Linearize {
    /// Never: the factor at hand belongs to these positions, or to some nearby.
    Never,
    /// Before the first correction.
    Once,
    /// Before the first correction, and again after so many.
    Every(usize),
}

impl Linearize {
    /// Whether it is due after so many corrections.
    #[inline]
    pub(super) fn is_due(self, corrections: usize) -> bool {
        match self {
            Self::Never => false,
            Self::Once => corrections == 0,
            Self::Every(count) => corrections.is_multiple_of(count),
        }
    }
}

/// When a projection stops. Sizes of corrections are relative to the size that the projection is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StopRule {
    /// When S is factored.
    pub linearize: Linearize,
    /// A correction of at most this size leaves a consistent state.
    pub consistent: f64,
    /// Corrections that are made before one may count as [`STALLED`].
    pub patience: usize,
    /// A correction of more than this size leads nowhere.
    pub diverged: f64,
    /// Most corrections.
    pub max_corrections: usize,
}

impl StopRule {
    /// So many corrections of the velocities, whatever their size, with one factor.
    const fn exactly(corrections: usize) -> Self {
        Self {
            linearize: Linearize::Once,
            consistent: 0.0,
            patience: corrections,
            diverged: f64::INFINITY,
            max_corrections: corrections,
        }
    }

    /// How a projection ends with its latest correction, of size `step` after one of size `last`, if it does.
    #[inline]
    pub(super) fn ending(&self, corrections: usize, step: f64, last: f64, size: f64) -> Option<Ending> {
        if step <= self.consistent * size {
            Some(Ending::Consistent)
        } else if step.is_nan() || step > self.diverged * size {
            Some(Ending::Diverged)
        } else if corrections > self.patience && step > 0.5 * last && step <= STALLED * size {
            Some(Ending::Stalled)
        } else {
            None
        }
    }
}

/// A start that is near enough for Newton's method, and a position that is held: a new factor for each correction, and more
/// corrections than were ever needed.
pub const ASSEMBLY_POSITIONS: StopRule = StopRule {
    linearize: Linearize::Every(1),
    consistent: CONSISTENT,
    patience: 0,
    diverged: f64::INFINITY,
    max_corrections: 40,
};
/// A start from anywhere: its steps are cut short, so there may be many.
pub const ROUGH_POSITIONS: StopRule = StopRule { max_corrections: 200, ..ASSEMBLY_POSITIONS };
/// Positions of a driven mechanism are answers themselves, and drivers may pull far: solved to the last digit.
pub const KINEMATICS_POSITIONS: StopRule =
    StopRule { consistent: 0.1 * CONSISTENT, max_corrections: 60, ..ASSEMBLY_POSITIONS };
/// Positions at the stages of a method in a chart: with an old factor convergence is linear, and may pause before a new one.
pub const CHART_POSITIONS: StopRule = StopRule {
    linearize: Linearize::Every(4),
    patience: 5,
    diverged: 1e3,
    max_corrections: 30,
    ..ASSEMBLY_POSITIONS
};
/// A position a thousandth of the length away from a consistent one, of which only the tangent is wanted.
pub const AHEAD_POSITIONS: StopRule = StopRule { max_corrections: 4, ..ASSEMBLY_POSITIONS };
/// A position beside a singular one, at a part of 1e-6 or more of the length: a correction of 1e-10 leaves what rounding leaves.
pub const PASSAGE_POSITIONS: StopRule =
    StopRule { consistent: 1e-10, diverged: 0.3, max_corrections: 12, ..ASSEMBLY_POSITIONS };
/// Velocities there: the problem is linear, and the factor at most 1e-10 of the length away: a correction of 1e-6 leaves 1e-12.
pub const PASSAGE_VELOCITIES: StopRule =
    StopRule { linearize: Linearize::Never, consistent: 1e-6, max_corrections: 3, ..ASSEMBLY_POSITIONS };
/// The end of a step of a method that knows nothing of the constraints: as far off as its error, with the factor of its last
/// evaluation. What is left is projected at the end of the next step.
pub const STEP_POSITIONS: StopRule =
    StopRule { linearize: Linearize::Never, max_corrections: 3, ..ASSEMBLY_POSITIONS };
/// The end of a step of the series, whose factor serves the next step as well: a correction of 1e-7 leaves its square, 1e-14,
/// which is less than [`CONSISTENT`].
pub const SERIES_POSITIONS: StopRule =
    StopRule { linearize: Linearize::Once, consistent: 1e-7, max_corrections: 3, ..ASSEMBLY_POSITIONS };

/// The velocities of a start: where drivers contradict joints, a regularized factor closes in on the nearest ones.
pub const ASSEMBLY_VELOCITIES: StopRule =
    StopRule { linearize: Linearize::Once, max_corrections: 12, ..ASSEMBLY_POSITIONS };
/// Velocities at the stages of a method in a chart, with the last factor of the positions.
pub const CHART_VELOCITIES: StopRule =
    StopRule { linearize: Linearize::Never, diverged: f64::MAX, ..CHART_POSITIONS };
/// The velocities at the end of a step.
pub const STEP_VELOCITIES: StopRule = StopRule { max_corrections: 2, ..STEP_POSITIONS };
/// The velocities at the end of a step of the series: its factor is exact there, and regularized ones are refined within.
pub const SERIES_VELOCITIES: StopRule = StopRule { linearize: Linearize::Never, ..StopRule::exactly(1) };
/// An admissible velocity; only its direction is wanted.
pub const AWAY_VELOCITIES: StopRule =
    StopRule { linearize: Linearize::Never, max_corrections: 2, ..ASSEMBLY_VELOCITIES };
/// Velocities of a driven mechanism, as exact as its positions.
pub const KINEMATICS_VELOCITIES: StopRule = StopRule::exactly(4);
/// The velocities of a start with pinned bodies, which weigh 1e8 times what they do: what they yield is lost in rounding at first.
pub const ROUGH_VELOCITIES: StopRule = StopRule::exactly(6);
