//! The states of a run that are kept, so that a question about a time that has passed is answered from its state.

use http::StatusCode;
use triad_engine::run::{Simulation, Snapshot, StateView};

use crate::refusal::Refusal;

/// Stretches of a run with different numbers that are kept; the oldest is forgotten first.
const MAX_SEGMENTS: usize = 32;
/// Bodies of all stretches together: each holds its mechanism, of some 20 kB a body.
const MAX_BODIES: usize = 256;
/// Times that differ by less are the same, s: far below any step, far above rounding.
pub(crate) const SAME_TIME: f64 = 1e-9;

/// States of a run, thinned out evenly when they become too many.
#[derive(Debug)]
pub(crate) struct History {
    /// Stretches of the run with the same numbers, oldest first.
    segments: Vec<Segment>,
    bytes: usize,
    limit: usize,
}

#[derive(Debug)]
struct Segment {
    /// The run when its numbers were replaced; nothing while they are those of the present.
    run: Option<Box<Simulation>>,
    snapshots: Vec<Snapshot>,
}

impl History {
    /// Nothing yet; at most about `limit` bytes.
    pub(crate) fn new(limit: usize) -> Self {
        Self { segments: vec![Segment { run: None, snapshots: Vec::new() }], bytes: 0, limit }
    }

    /// Forgets everything.
    pub(crate) fn clear(&mut self) {
        *self = Self::new(self.limit);
    }

    /// Keeps the state of the present.
    pub(crate) fn keep(&mut self, simulation: &Simulation) {
        let snapshot = simulation.snapshot();
        self.bytes += snapshot.size();
        if let Some(segment) = self.segments.last_mut() {
            segment.snapshots.push(snapshot);
        }
        if self.bytes > self.limit {
            self.thin();
        }
    }

    /// Drops every second state.
    fn thin(&mut self) {
        for segment in &mut self.segments {
            let mut keep = false;
            segment.snapshots.retain(|_| {
                keep = !keep;
                keep
            });
            segment.snapshots.shrink_to_fit();
        }
        self.bytes = self.segments.iter().map(|segment| size(&segment.snapshots)).sum();
    }

    /// Bytes of the states that are kept.
    pub(crate) fn bytes(&self) -> usize {
        self.bytes
    }

    /// Begins a segment with other numbers; `old` is the run before the change.
    pub(crate) fn start_segment(&mut self, old: Simulation) {
        let most = (MAX_BODIES / old.model().bodies.len().max(1)).clamp(2, MAX_SEGMENTS);
        match self.segments.last_mut() {
            // Numbers that were never run with need no segment.
            Some(last) if last.snapshots.is_empty() => return,
            Some(last) => last.run = Some(Box::new(old)),
            None => {}
        }
        self.segments.push(Segment { run: None, snapshots: Vec::new() });
        if self.segments.len() > most {
            let oldest = self.segments.remove(0);
            self.bytes -= size(&oldest.snapshots);
        }
    }

    /// The latest kept state that is not after `time`. Errors if none is kept.
    pub(crate) fn at<'a>(&'a self, time: f64, present: &'a Simulation) -> Result<StateView<'a>, Refusal> {
        let found = self.segments.iter().rev().find_map(|segment| {
            let after = segment.snapshots.partition_point(|snapshot| snapshot.time <= time + SAME_TIME);
            Some((segment, segment.snapshots.get(after.checked_sub(1)?)?))
        });
        let (segment, snapshot) = found.ok_or_else(|| unknown(time))?;
        let run = segment.run.as_deref().unwrap_or(present);
        run.at_snapshot(snapshot).ok_or_else(|| unknown(time))
    }
}

fn size(snapshots: &[Snapshot]) -> usize {
    snapshots.iter().map(Snapshot::size).sum()
}

pub(crate) fn unknown(time: f64) -> Refusal {
    Refusal::new(
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

    fn tension(state: &StateView) -> f64 {
        let force = state.multipliers()[0].force;
        force.iter().map(|x| x * x).sum::<f64>().sqrt()
    }

    #[test]
    fn a_time_before_a_change_has_the_numbers_of_that_time() {
        let mut run = pendulum(1.0);
        let mut history = History::new(1 << 20);
        let mut then = Vec::new();
        for k in 0..3 {
            run.advance_to(0.1 * f64::from(k)).expect("runs");
            history.keep(&run);
            then.push(tension(&run.state()));
        }
        let mut heavy = pendulum(10.0);
        heavy.continue_from(&run).expect("goes on");
        history.start_segment(std::mem::replace(&mut run, heavy));
        run.advance_to(0.3).expect("runs");
        history.keep(&run);
        for (k, force) in then.iter().enumerate() {
            let found = tension(&history.at(0.1 * k as f64 + 0.05, &run).expect("is kept"));
            assert!((found / force - 1.0).abs() < 1e-9, "{found} {force}");
        }
        let now = tension(&run.state());
        assert!((tension(&history.at(5.0, &run).expect("is kept")) / now - 1.0).abs() < 1e-9);
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
            history.keep(&run);
            assert!(history.bytes <= history.limit);
        }
        assert!(history.at(0.0, &run).is_ok(), "the start stays");
    }

    #[test]
    fn what_is_forgotten_with_the_oldest_numbers_is_not_counted_any_more() {
        let mut run = pendulum(1.0);
        let mut history = History::new(1 << 20);
        for k in 0..3 * MAX_SEGMENTS {
            history.keep(&run);
            history.start_segment(std::mem::replace(&mut run, pendulum(1.0 + 0.05 * k as f64)));
        }
        assert_eq!(history.segments.len(), MAX_SEGMENTS);
        let kept: usize = history.segments.iter().map(|segment| size(&segment.snapshots)).sum();
        assert_eq!((history.bytes(), kept), (kept, (MAX_SEGMENTS - 1) * run.snapshot().size()));
    }

    #[test]
    fn of_many_bodies_fewer_stretches_are_kept() {
        let scene = catalogue::scene("n-four-bar:40").expect("a scene");
        let run = || Simulation::new(&scene).expect("stands");
        let mut history = History::new(64 << 20);
        for _ in 0..5 {
            history.keep(&run());
            history.start_segment(run());
        }
        assert_eq!(history.segments.len(), MAX_BODIES / scene.bodies.len());
    }
}
