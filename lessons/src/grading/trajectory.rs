//! A table of a motion, from any program, against the reference; and how a run of this one is written as such a table.

use std::sync::Arc;

use triad_engine::Scene;
use triad_engine::analysis::Wanted;
use triad_engine::run::Simulation;

use super::known::Known;
use crate::answers::{Answer, table};
use crate::exercise::{QuestionBody, Trajectory};
use crate::lesson::Lesson;
use crate::scenario::measure::{MeasureError, row};
use crate::tasks::trajectory::ReferenceMotion;
use crate::tasks::wrong_motions::{self, Table};
use crate::verdict::feedback::{Feedback, Judgement, MotionFinding};
use crate::verdict::invalid::InvalidTrajectory;

/// Fewest samples.
const FEWEST: usize = 20;
/// Longest time without a sample, as a part of the whole.
const LONGEST_GAP: f64 = 0.05;
/// An error is of one kind if this part of it, or less, is left without that kind.
const EXPLAINED: f64 = 0.25;

/// Most intervals of a table that is written here: a file of them is far smaller than the largest that is read.
const MOST_INTERVALS: f64 = 2000.0;

/// The table that a question asks for, to be written of a run.
#[derive(Debug, Clone, Copy)]
pub struct AskedTable<'a>(&'a Trajectory);

impl Lesson {
    /// The table that a question asks for; `None` if it is of another kind.
    pub fn asked_table(&self, question: &str) -> Option<AskedTable<'_>> {
        match &self.question(question)?.body {
            QuestionBody::Trajectory(task) => Some(AskedTable(task)),
            _ => None,
        }
    }
}

impl AskedTable<'_> {
    /// Where it ends, s.
    pub fn end(&self) -> f64 {
        self.0.end
    }

    /// Time between its rows, s, for a scene that is written every so many: near that, often enough, and not too often.
    pub fn interval(&self, every: f64) -> f64 {
        let end = self.0.end;
        every.clamp(end / MOST_INTERVALS, 0.5 * LONGEST_GAP * end)
    }

    /// Its first line: names.
    pub fn names(&self) -> String {
        self.0.columns.keys().fold("t".to_owned(), |line, name| line + "," + name)
    }

    /// Its values at the run's moment.
    ///
    /// Errors if the scene lacks what a column is about.
    pub fn row(&self, scene: &Scene, run: &Simulation) -> Result<Vec<f64>, MeasureError> {
        row(scene, run, &self.0.columns)
    }
}

/// Judges a table.
pub(super) fn judge(
    task: &Trajectory,
    answer: &Answer,
    known: &Known,
    wanted: &Wanted,
) -> Result<Judgement, InvalidTrajectory> {
    let text = answer.file.as_ref().ok_or(InvalidTrajectory::NoFile)?;
    let (times, given) = read(task, text)?;
    let run = |task: &Trajectory| ReferenceMotion::new(task).map(Arc::new);
    let motion = known.motions.of(task.clone(), wanted, run).map_err(InvalidTrajectory::Reference)?;
    let error = motion.distance(&times, &given);
    let share = task.bands.iter().find(|b| error <= b.error).map_or(0.0, |b| b.share);
    if share == 1.0 {
        return Ok(Judgement::right(Feedback::TrajectoryRight { error, note: String::new() }));
    }
    let finding = kind(task, &motion, (&times, &given), known, wanted);
    Ok(Judgement::wrong(share, finding.misconception(), Feedback::Trajectory { error, finding }))
}

/// Times, and the values of the columns in the question's order.
fn read(task: &Trajectory, text: &str) -> Result<(Vec<f64>, Vec<Vec<f64>>), InvalidTrajectory> {
    let table = table::read(text)?;
    let place = |name: &str| {
        table.names.iter().position(|n| *n == name.to_lowercase()).ok_or_else(|| {
            InvalidTrajectory::NoColumn { name: name.to_owned(), known: table.names.join(", ") }
        })
    };
    // Whoever writes out the name of the time means the same column.
    let time = place("t").or_else(|missing| place("time").map_err(|_| missing))?;
    let columns: Vec<usize> = task.columns.keys().map(|name| place(name)).collect::<Result<_, _>>()?;
    let times: Vec<f64> = table.rows.iter().map(|row| row[time]).collect();
    if times.len() < FEWEST {
        return Err(InvalidTrajectory::FewRows { rows: times.len(), fewest: FEWEST });
    }
    if let Some(k) = times.windows(2).position(|w| w[1] <= w[0]) {
        return Err(InvalidTrajectory::Times { from: times[k], to: times[k + 1] });
    }
    let tiny = 1e-6 * task.end;
    let (first, last) = (times[0], times[times.len() - 1]);
    if first > tiny || first < -tiny || last < task.end - tiny {
        return Err(InvalidTrajectory::Range { first, last, end: task.end });
    }
    let gap = times.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
    if gap > LONGEST_GAP * task.end {
        return Err(InvalidTrajectory::Gap { gap, most: LONGEST_GAP * task.end });
    }
    // What lies beyond the end is not asked for.
    let kept = times.iter().take_while(|t| **t <= task.end + tiny).count();
    let given = columns.iter().map(|c| table.rows[..kept].iter().map(|row| row[*c]).collect()).collect();
    Ok((times[..kept].to_vec(), given))
}

/// Which kind of error it is: what takes longer is only asked where the quicker tells nothing.
fn kind(
    task: &Trajectory,
    motion: &ReferenceMotion,
    (times, given): (&[f64], &[Vec<f64>]),
    known: &Known,
    wanted: &Wanted,
) -> MotionFinding {
    let negative = given.iter().map(|v| v.iter().map(|x| -x).collect()).collect::<Vec<Vec<f64>>>();
    let worst = task.bands.last().map_or(0.0, |b| b.error);
    if motion.distance(times, given) > worst && motion.distance(times, &negative) <= worst {
        return MotionFinding::OppositeSign;
    }
    known.finding(task, times, given, wanted, |times, given| off(task, motion, times, given, known, wanted))
}

/// What is off with a table that is not the opposite of the right one, whatever its points.
fn off(
    task: &Trajectory,
    motion: &ReferenceMotion,
    times: &[f64],
    given: &[Vec<f64>],
    known: &Known,
    wanted: &Wanted,
) -> MotionFinding {
    let table = Table::new(times, given);
    let shown = |scene: &Scene, times: &[f64]| known.shown(task, scene, times, wanted);
    if let Some(mistake) = wrong_motions::recognise(task, motion, &table, shown) {
        return MotionFinding::Usual(mistake);
    }
    let d = motion.deviation(times, given);
    let (late, factor) = (d.late, d.factor);
    if d.without_phase <= EXPLAINED * d.total {
        MotionFinding::Phase { late }
    } else if d.without_factor <= EXPLAINED * d.total {
        MotionFinding::Amplitude { factor }
    } else if d.rest <= EXPLAINED * d.total && factor > 0.0 {
        MotionFinding::PhaseAndAmplitude { late, factor }
    } else {
        let found = wrong_motions::shape(motion, &table, |times| known.waves(times, wanted));
        found.map_or(MotionFinding::Unknown, MotionFinding::Usual)
    }
}
