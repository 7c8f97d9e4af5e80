//! The states that a run has gone through, for whoever looks back: a question about the past is answered from the state of then.

use axum::http::StatusCode;
use triad_engine::run::{Simulation, Snapshot};

use crate::problem::Problem;

/// Changes in the middle of a run that are kept apart; what came before is forgotten.
const MAX_CHAPTERS: usize = 32;
/// Two times that differ less are one, s.
const SAME: f64 = 1e-9;

/// States of a run, thinned out evenly when they become too many.
#[derive(Debug)]
pub(super) struct History {
    /// Stretches of the run with the same numbers, oldest first.
    segments: Vec<Segment>,
    bytes: usize,
    limit: usize,
    /// The run as it was at the time that was asked for last.
    looked: Option<Box<Simulation>>,
}

#[derive(Debug)]
struct Segment {
    /// The run when its numbers were replaced; nothing while they are those of the present.
    run: Option<Box<Simulation>>,
    moments: Vec<Snapshot>,
}

impl History {
    /// Nothing yet; at most about `limit` bytes.
    pub(super) fn new(limit: usize) -> Self {
        Self { segments: vec![Segment { run: None, moments: Vec::new() }], bytes: 0, limit, looked: None }
    }

    /// Forgets everything.
    pub(super) fn clear(&mut self) {
        *self = Self::new(self.limit);
    }

    /// Keeps the state of the present.
    pub(super) fn keep(&mut self, simulation: &mut Simulation) {
        let moment = simulation.snapshot();
        self.bytes += moment.size();
        if let Some(segment) = self.segments.last_mut() {
            segment.moments.push(moment);
        }
        if self.bytes > self.limit {
            self.thin();
        }
    }

    /// Every second state goes.
    fn thin(&mut self) {
        for segment in &mut self.segments {
            let mut keep = false;
            segment.moments.retain(|_| {
                keep = !keep;
                keep
            });
        }
        self.bytes = self.segments.iter().flat_map(|segment| &segment.moments).map(Snapshot::size).sum();
    }

    /// From now on the run has other numbers; `old` is how it was.
    pub(super) fn start_segment(&mut self, old: Simulation) {
        self.looked = None;
        match self.segments.last_mut() {
            // Numbers that were never run with need no segment.
            Some(last) if last.moments.is_empty() => return,
            Some(last) => last.run = Some(Box::new(old)),
            None => {}
        }
        self.segments.push(Segment { run: None, moments: Vec::new() });
        if self.segments.len() > MAX_CHAPTERS {
            self.segments.remove(0);
        }
    }

    /// The run at the latest kept state that is not after `time`.
    pub(super) fn at(&mut self, time: f64, present: &Simulation) -> Result<&mut Simulation, Problem> {
        let found = self.segments.iter().rev().find_map(|segment| {
            let after = segment.moments.partition_point(|moment| moment.time <= time + SAME);
            Some((segment, segment.moments.get(after.checked_sub(1)?)?))
        });
        let (segment, moment) = found.ok_or_else(|| unknown(time))?;
        if self.looked.as_ref().is_none_or(|looked| looked.time() != moment.time) {
            let run = segment.run.as_deref().unwrap_or(present);
            self.looked = run.at_snapshot(moment).map(Box::new);
        }
        self.looked.as_deref_mut().ok_or_else(|| unknown(time))
    }
}

fn unknown(time: f64) -> Problem {
    Problem::new(
        StatusCode::UNPROCESSABLE_ENTITY,
        "unknown-time",
        format!("the state of the run at {time} s is not kept"),
        "ask for a time that the run has passed since its last start, or leave `at` out for the present",
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use triad_engine::catalogue;

    fn pendulum(mass: f64) -> Simulation {
        let scene = catalogue::scene("simple-pendulum").expect("a scene");
        let scene = scene.changed([], [("/bodies/0/mass", &mass.into())]).expect("a mass");
        Simulation::new(&scene).expect("runs")
    }

    fn tension(simulation: &mut Simulation) -> f64 {
        let force = simulation.multipliers()[0].force;
        force.iter().map(|x| x * x).sum::<f64>().sqrt()
    }

    #[test]
    fn a_time_before_a_change_is_told_with_the_numbers_of_then() {
        let mut run = pendulum(1.0);
        let mut history = History::new(1 << 20);
        let mut then = Vec::new();
        for k in 0..3 {
            run.advance_to(0.1 * f64::from(k)).expect("runs");
            history.keep(&mut run);
            then.push(tension(&mut run));
        }
        let mut heavy = pendulum(10.0);
        heavy.continue_from(&run).expect("goes on");
        history.start_segment(std::mem::replace(&mut run, heavy));
        run.advance_to(0.3).expect("runs");
        history.keep(&mut run);
        for (k, force) in then.iter().enumerate() {
            let found = tension(history.at(0.1 * k as f64 + 0.05, &run).expect("is kept"));
            assert!((found / force - 1.0).abs() < 1e-9, "{found} {force}");
        }
        let now = tension(&mut run);
        assert!((tension(history.at(5.0, &run).expect("is kept")) / now - 1.0).abs() < 1e-9);
        assert!(now > 5.0 * then[2]);
        history.clear();
        assert!(history.at(0.1, &run).is_err());
    }

    #[test]
    fn what_is_kept_is_bounded() {
        let mut run = pendulum(1.0);
        let mut history = History::new(64 * run.snapshot().size());
        for k in 0..1000 {
            run.advance_to(1e-3 * f64::from(k)).expect("runs");
            history.keep(&mut run);
            assert!(history.bytes <= history.limit);
        }
        assert!(history.at(0.0, &run).is_ok(), "the start stays");
    }
}
