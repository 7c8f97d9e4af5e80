//! Motions that usual mistakes lead to, and what a wrong table shows of the way it was made.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use triad_engine::analysis::Wanted;
use triad_engine::run::Simulation;
use triad_engine::scene::Scene;

use super::harmonic::Waves;
use super::trajectory::ReferenceMotion;
use crate::exercise::Trajectory;
use crate::files::MeasuredFile;
use crate::mistakes::{self, Mistake};
use crate::scenario::measure::{MAX_STEPS, row, start};

/// Relative distance up to which a table is a motion that a mistake leads to.
const SAME: f64 = 0.03;
/// The same, as a part of its distance from the right motion.
const MUCH_NEARER: f64 = 0.25;
/// Points at which motions are compared.
const POINTS: usize = 400;
/// Factors between units of length, and between degrees and radians.
const UNITS: [f64; 6] = [100.0, 1000.0, 0.01, 0.001, 180.0 / PI, PI / 180.0];
/// Factors by which a time column is wrong.
const TIMES: [f64; 2] = [2.0, 0.5];
/// Growth of the swings from the first to the last third of the time, against the right motion's, that is no error of phase.
const GROWTH: f64 = 1.1;
/// Part of the swings that a harmonic motion leaves unexplained, at most.
const HARMONIC: f64 = 0.003;
/// Gravity as many round it, against what the scene has, m/s².
const ROUNDED_GRAVITY: f64 = 10.0;

/// A table, thinned out.
pub(crate) struct Table {
    times: Vec<f64>,
    columns: Vec<Vec<f64>>,
}

impl Table {
    /// At most so many rows as are compared.
    pub(crate) fn new(times: &[f64], columns: &[Vec<f64>]) -> Self {
        let step = times.len().div_ceil(POINTS).max(1);
        let thin = |values: &[f64]| values.iter().copied().step_by(step).collect::<Vec<f64>>();
        Self { times: thin(times), columns: columns.iter().map(|values| thin(values)).collect() }
    }

    /// Relative distance from other columns at the same times, where these are defined.
    fn apart(&self, other: &[Vec<f64>]) -> f64 {
        let (mut difference, mut size) = (0.0, 0.0);
        for (own, other) in self.columns.iter().zip(other) {
            for (x, y) in own.iter().zip(other).filter(|(_, y)| y.is_finite()) {
                difference += (x - y) * (x - y);
                size += y * y;
            }
        }
        if size > 0.0 { (difference / size).sqrt() } else { f64::INFINITY }
    }
}

/// The columns of a scene at some times; none where it does not run so far.
pub(crate) type Shown = Option<Arc<Vec<Vec<f64>>>>;

/// The mistake whose motion the table is, if there is one; `shown` runs a scene, or has run it.
pub(crate) fn recognise(
    task: &Trajectory,
    motion: &ReferenceMotion,
    table: &Table,
    shown: impl Fn(&Scene, &[f64]) -> Shown,
) -> Option<&'static Mistake> {
    let right = at_times(motion, table, 1.0);
    let limit = SAME.min(MUCH_NEARER * table.apart(&right));
    let is = |other: &[Vec<f64>]| table.apart(other) <= limit;
    let rearranged = rearranged(&right).into_iter().find(|(_, other)| is(other));
    if let Some((mistake, _)) = rearranged {
        return Some(mistake);
    }
    if TIMES.iter().any(|k| is(&at_times(motion, table, *k))) {
        return Some(mistakes::TIME_COLUMN);
    }
    if is(&rates(motion, table)) {
        return Some(mistakes::VELOCITIES);
    }
    let worlds = worlds(&task.scene).into_iter();
    let mut shown = worlds.filter_map(|(mistake, scene)| Some((mistake, shown(&scene, &table.times)?)));
    shown.find(|(_, other)| is(other)).map(|(mistake, _)| mistake)
}

/// What the shape of a table tells that is no motion known before; `waves` makes those of some times, or has made them.
pub(crate) fn shape(
    motion: &ReferenceMotion,
    table: &Table,
    waves: impl Fn(&[f64]) -> Arc<Waves>,
) -> Option<&'static Mistake> {
    let right = Table { times: table.times.clone(), columns: at_times(motion, table, 1.0) };
    let still = |values: &Vec<f64>| spread(values) == 0.0;
    if table.columns.iter().all(still) && !right.columns.iter().all(still) {
        return Some(mistakes::MOTIONLESS);
    }
    let moved: Vec<Vec<f64>> =
        table.columns.iter().zip(&right.columns).map(|(own, right)| offset(own, right)).collect();
    let limit = SAME.min(MUCH_NEARER * table.apart(&right.columns));
    if table.apart(&moved) <= limit {
        return Some(mistakes::OTHER_ORIGIN);
    }
    if table.apart(&stretched(table, &right)) <= limit {
        return Some(mistakes::TABLE_SCALE);
    }
    let signals = |table: &Table| [table.columns.clone(), angles(table)].concat();
    let (own, wanted) = (signals(table), signals(&right));
    let waves = waves(&table.times);
    let harmonic = own.iter().zip(&wanted).any(|(own, wanted)| {
        spread(own) > 0.0 && waves.unexplained(own) <= HARMONIC && waves.unexplained(wanted) > 2.0 * HARMONIC
    });
    if harmonic {
        return Some(mistakes::SMALL_ANGLES);
    }
    let growth = own.iter().zip(&wanted).map(|(own, wanted)| growth(own) / growth(wanted));
    let (least, most) = growth.fold((1.0f64, 1.0f64), |(a, b), x| (a.min(x), b.max(x)));
    match (most >= GROWTH, least <= 1.0 / GROWTH) {
        (true, _) => Some(mistakes::GROWING),
        (false, true) => Some(mistakes::DYING),
        (false, false) => None,
    }
}

/// The right motion at the table's times multiplied; not a number beyond the end.
fn at_times(motion: &ReferenceMotion, table: &Table, k: f64) -> Vec<Vec<f64>> {
    let at = |column: usize, t: f64| if t <= motion.end { motion.at(column, t) } else { f64::NAN };
    (0..table.columns.len()).map(|c| table.times.iter().map(|t| at(c, k * t)).collect()).collect()
}

/// Its rates.
fn rates(motion: &ReferenceMotion, table: &Table) -> Vec<Vec<f64>> {
    let h = 1e-4 * motion.end;
    let rate = |c: usize, t: f64| {
        let (from, to) = ((t - h).max(0.0), (t + h).min(motion.end));
        (motion.at(c, to) - motion.at(c, from)) / (to - from)
    };
    (0..table.columns.len()).map(|c| table.times.iter().map(|t| rate(c, *t)).collect()).collect()
}

/// The right columns with other signs, in other places, in other units.
fn rearranged(right: &[Vec<f64>]) -> Vec<(&'static Mistake, Vec<Vec<f64>>)> {
    let n = right.len();
    let scaled = |values: &[f64], k: f64| values.iter().map(|x| k * x).collect::<Vec<f64>>();
    let mut list = Vec::new();
    for column in 0..n {
        let mut other = right.to_vec();
        other[column] = scaled(&right[column], -1.0);
        list.push((mistakes::MIRROR_IMAGE, other));
    }
    for (a, b) in (0..n).flat_map(|b| (0..b).map(move |a| (a, b))) {
        for (x, y) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let mut other = right.to_vec();
            (other[a], other[b]) = (scaled(&right[b], x), scaled(&right[a], y));
            list.push((mistakes::SWAPPED_COLUMNS, other));
        }
    }
    for k in UNITS {
        list.push((mistakes::TABLE_UNITS, right.iter().map(|values| scaled(values, k)).collect()));
    }
    list
}

/// Scenes with a mistake in them.
fn worlds(scene: &Scene) -> Vec<(&'static Mistake, Scene)> {
    let size = scene.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
    let with = |k: f64| Scene { gravity: scene.gravity.map(|g| k * g), ..scene.clone() };
    if size == 0.0 {
        return Vec::new();
    }
    vec![
        (mistakes::OTHER_GRAVITY, with(ROUNDED_GRAVITY / size)),
        (mistakes::NO_GRAVITY, with(0.0)),
        (mistakes::GRAVITY_UP, with(-1.0)),
        (mistakes::MASS_AND_WEIGHT, with(1.0 / size)),
        (mistakes::ANGLE_UNIT, with(PI / 180.0)),
    ]
}

/// The columns that a question asks for, of a scene at these times up to an end, as long as they are wanted.
pub(crate) fn run(
    scene: &Scene,
    columns: &BTreeMap<String, MeasuredFile>,
    end: f64,
    times: &[f64],
    wanted: &Wanted,
) -> Shown {
    if !wanted.is_still() {
        return None;
    }
    let mut simulation: Simulation = start(scene).ok()?;
    simulation.set_step_limit(MAX_STEPS);
    let mut shown = vec![Vec::with_capacity(times.len()); columns.len()];
    for t in times {
        simulation.advance_to(t.clamp(0.0, end)).ok().filter(|()| wanted.is_still())?;
        for (column, value) in shown.iter_mut().zip(row(scene, &simulation, columns).ok()?) {
            column.push(value);
        }
    }
    Some(Arc::new(shown))
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Difference of the largest and the smallest value.
fn spread(values: &[f64]) -> f64 {
    let (low, high) =
        values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
    (high - low).max(0.0)
}

/// The right values moved by what lies between the means.
fn offset(own: &[f64], right: &[f64]) -> Vec<f64> {
    let by = mean(own) - mean(right);
    right.iter().map(|x| x + by).collect()
}

/// The right columns times the factor that comes nearest.
fn stretched(own: &Table, right: &Table) -> Vec<Vec<f64>> {
    let product = |a: &[Vec<f64>]| {
        a.iter().zip(&right.columns).flat_map(|(a, b)| a.iter().zip(b)).map(|(a, b)| a * b).sum::<f64>()
    };
    let size = product(&right.columns);
    let factor = if size > 0.0 { product(&own.columns) / size } else { 1.0 };
    right.columns.iter().map(|values| values.iter().map(|x| factor * x).collect()).collect()
}

/// Spread of the last third over that of the first.
fn growth(values: &[f64]) -> f64 {
    let third = values.len() / 3;
    let (first, last) = (spread(&values[..third]), spread(&values[values.len() - third..]));
    if first > 0.0 { last / first } else { 1.0 }
}

/// The angle of the first two columns about the origin, without jumps; none if there are fewer.
fn angles(table: &Table) -> Vec<Vec<f64>> {
    let [x, y, ..] = table.columns.as_slice() else { return Vec::new() };
    let mut turns = 0.0;
    let mut list: Vec<f64> = Vec::with_capacity(x.len());
    for (x, y) in x.iter().zip(y) {
        // From the downward vertical, so that a pendulum's angle is small where it hangs.
        let angle = libm::atan2(*x, -*y) + turns;
        let jump = list.last().map_or(0.0, |before| ((before - angle) / TAU).round() * TAU);
        turns += jump;
        list.push(angle + jump);
    }
    vec![list]
}
