//! A motion as a table, and how far another table is from it: in phase, in amplitude, in shape.

use std::fmt::Write as _;

use triad_engine::scene::Scene;

use super::least::least;
use crate::exercise::Trajectory;
use crate::scenario::measure::{MeasureError, reference_scenes, row, start};

/// Intervals of the reference.
const INTERVALS: usize = 4000;
/// Points at which two motions are compared when the shift is sought.
const SHIFT_POINTS: usize = 400;
/// Shifts that are tried on either side, as a part of the whole time.
const MAX_SHIFT: f64 = 0.1;
/// Times that the best of them is looked around for a better one, closer and closer.
const SHIFT_ROUNDS: usize = 40;

/// The reference on an even grid, column by column.
#[derive(Debug)]
pub(crate) struct ReferenceMotion {
    /// The grid covers 0 to this time, s.
    pub end: f64,
    /// For each column, values at the grid's points.
    values: Vec<Vec<f64>>,
    /// For each column, its mean.
    means: Vec<f64>,
    /// The largest value of all.
    largest: f64,
}

/// What is off between a table and the reference. All are relative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Deviation {
    /// Root of the mean square of the difference.
    pub total: f64,
    /// Time by which the table is late, s.
    pub late: f64,
    /// Factor by which its swings are larger.
    pub factor: f64,
    /// What is left when both are taken out.
    pub rest: f64,
    /// What is left when the delay alone is taken out.
    pub without_phase: f64,
    /// What is left when the factor alone is taken out.
    pub without_factor: f64,
}

impl ReferenceMotion {
    /// Runs the reference.
    pub(crate) fn new(task: &Trajectory) -> Result<Self, MeasureError> {
        let [scene, _] = reference_scenes(&task.scene, task.end);
        let values = sampled(task, &scene)?;
        let means = values.iter().map(|v| v.iter().sum::<f64>() / v.len() as f64).collect();
        let largest = values.iter().flatten().fold(0.0, |a: f64, x| a.max(x.abs()));
        Ok(Self { end: task.end, values, means, largest })
    }

    /// Bound on its relative error, by a second run: for those who write lessons.
    pub(crate) fn error(&self, task: &Trajectory) -> Result<f64, MeasureError> {
        let [_, scene] = reference_scenes(&task.scene, task.end);
        let times: Vec<f64> = (0..=INTERVALS).map(|k| task.end * k as f64 / INTERVALS as f64).collect();
        Ok(2.0 * self.distance(&times, &sampled(task, &scene)?) + 1e-12)
    }

    /// A column's value at a time within the grid, by cubic interpolation through four points.
    pub(crate) fn at(&self, column: usize, t: f64) -> f64 {
        let values = &self.values[column];
        let x = (t / self.end * INTERVALS as f64).clamp(0.0, INTERVALS as f64);
        // The cast of a small non-negative number loses nothing but its fraction.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let first = (x.floor() as usize).saturating_sub(1).min(INTERVALS - 3);
        let s = x - first as f64;
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| values[first + k]);
        let [s1, s2, s3] = [s - 1.0, s - 2.0, s - 3.0];
        a * s1 * s2 * s3 / -6.0 + b * s * s2 * s3 / 2.0 - c * s * s1 * s3 / 2.0 + d * s * s1 * s2 / 6.0
    }

    /// How far off a table is: the root of the mean square of the difference, relative.
    pub(crate) fn distance(&self, times: &[f64], given: &[Vec<f64>]) -> f64 {
        Compared::new(self, times, given).total()
    }

    /// Tells apart what is off: a search, which takes longer than all else that is done with a table that is right.
    pub(crate) fn deviation(&self, times: &[f64], given: &[Vec<f64>]) -> Deviation {
        let whole = Compared::new(self, times, given);
        let few = times.len().div_ceil(SHIFT_POINTS).max(1);
        let thin: Vec<f64> = times.iter().copied().step_by(few).collect();
        let thin_given: Vec<Vec<f64>> =
            given.iter().map(|values| values.iter().copied().step_by(few).collect()).collect();
        let thinned = Compared::new(self, &thin, &thin_given);
        let best = |fit: &dyn Fn(f64) -> f64| {
            let step = MAX_SHIFT * self.end / 100.0;
            let tried = (-100..=100).map(|k| f64::from(k) * step).map(|late| (late, fit(late)));
            least(tried, step, SHIFT_ROUNDS, fit).map_or(0.0, |(late, _)| late)
        };
        let late = best(&|late| thinned.without_delay(late, true).0);
        let alone = best(&|late| thinned.without_delay(late, false).0);
        let (rest, factor) = whole.without_delay(late, true);
        Deviation {
            total: whole.total(),
            late,
            factor,
            rest,
            without_phase: whole.without_delay(alone, false).0,
            without_factor: whole.without_delay(0.0, true).0,
        }
    }
}

/// A table beside the reference.
struct Compared<'a> {
    motion: &'a ReferenceMotion,
    times: &'a [f64],
    given: &'a [Vec<f64>],
    /// The reference at these times, column by column.
    right: Vec<Vec<f64>>,
}

impl<'a> Compared<'a> {
    fn new(motion: &'a ReferenceMotion, times: &'a [f64], given: &'a [Vec<f64>]) -> Self {
        let mut compared = Self { motion, times, given, right: Vec::new() };
        compared.right = compared.moved(0.0);
        compared
    }

    /// The reference at the times less a delay; where there is none, at its nearest end.
    fn moved(&self, late: f64) -> Vec<Vec<f64>> {
        let column = |k| self.times.iter().map(|t| self.motion.at(k, t - late)).collect();
        (0..self.given.len()).map(column).collect()
    }

    fn total(&self) -> f64 {
        self.difference(&self.right, 0.0, 1.0)
    }

    /// What is left when a delay is taken out, and a factor, the best for it, or none.
    fn without_delay(&self, late: f64, stretched: bool) -> (f64, f64) {
        let moved = self.moved(late);
        let factor = if stretched { self.best_factor(&moved, late) } else { 1.0 };
        (self.difference(&moved, late, factor), factor)
    }

    /// Root of the mean square over time of what is measured against `a·(x(t − late) − mean) + mean`, each column
    /// relative to its own.
    fn difference(&self, moved: &[Vec<f64>], late: f64, factor: f64) -> f64 {
        let Self { motion, times, given, right } = self;
        let mut sum = 0.0;
        for (column, values) in given.iter().enumerate() {
            let mean = motion.means[column];
            let (mut square, mut size, mut weight) = (0.0, 0.0, 0.0);
            for (k, (t, value)) in times.iter().zip(values).enumerate() {
                if t - late < 0.0 || t - late > motion.end {
                    continue;
                }
                // Each sample stands for its part of the time, so that uneven steps do not count twice.
                let before = if k > 0 { times[k - 1] } else { *t };
                let after = times.get(k + 1).copied().unwrap_or(*t);
                let w = 0.5 * (after - before);
                let (own, true_value) = (moved[column][k], right[column][k]);
                let left = value - mean - factor * (own - mean);
                square += w * left * left;
                size += w * true_value * true_value;
                weight += w;
            }
            // A column that should be zero is judged by the largest column.
            let least = 1e-3 * motion.largest;
            let floor = weight * least * least;
            sum += square / size.max(floor).max(f64::MIN_POSITIVE);
        }
        (sum / given.len().max(1) as f64).sqrt()
    }

    /// The factor that fits best for a delay: a linear problem.
    fn best_factor(&self, moved: &[Vec<f64>], late: f64) -> f64 {
        let (mut product, mut square) = (0.0, 0.0);
        for (column, values) in self.given.iter().enumerate() {
            let mean = self.motion.means[column];
            for ((t, value), own) in self.times.iter().zip(values).zip(&moved[column]) {
                if (0.0..=self.motion.end).contains(&(t - late)) {
                    let own = own - mean;
                    product += own * (value - mean);
                    square += own * own;
                }
            }
        }
        if square > 0.0 { product / square } else { 1.0 }
    }
}

/// The columns of a scene on the grid.
fn sampled(task: &Trajectory, scene: &Scene) -> Result<Vec<Vec<f64>>, MeasureError> {
    let mut simulation = start(scene)?;
    let mut values = vec![Vec::with_capacity(INTERVALS + 1); task.columns.len()];
    for k in 0..=INTERVALS {
        let t = task.end * k as f64 / INTERVALS as f64;
        simulation.advance_to(t)?;
        for (column, value) in values.iter_mut().zip(row(scene, &simulation, &task.columns)?) {
            column.push(value);
        }
    }
    Ok(values)
}

/// The reference as a table, as a program would write it.
pub(crate) fn reference_csv(task: &Trajectory, samples: usize) -> Result<String, MeasureError> {
    let track = ReferenceMotion::new(task)?;
    let names = task.columns.keys().cloned().collect::<Vec<_>>().join(",");
    let mut text = format!("t,{names}\n");
    for k in 0..=samples {
        let t = task.end * k as f64 / samples as f64;
        let _ = write!(text, "{t:.9}");
        for column in 0..task.columns.len() {
            let _ = write!(text, ",{:.12e}", track.at(column, t));
        }
        text.push('\n');
    }
    Ok(text)
}
