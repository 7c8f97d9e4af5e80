//! A state of a run, kept so that it can be looked at again after the run has gone on.

use super::Simulation;

/// A state of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// Time, s.
    pub time: f64,
    /// q and q̇.
    state: Vec<f64>,
    /// Angles with their whole turns, rad.
    angles: Vec<f64>,
}

impl Snapshot {
    /// About how many bytes it takes.
    pub fn size(&self) -> usize {
        size_of::<Self>() + size_of::<f64>() * (self.state.len() + self.angles.len())
    }
}

impl Simulation {
    /// The state that is shown, to be looked at again with [`Simulation::at_snapshot`].
    pub fn snapshot(&self) -> Snapshot {
        let angles = self.current.angles().iter().map(|angle| angle.value).collect();
        Snapshot { time: self.time, state: self.shown.clone(), angles }
    }

    /// This run as it was at a snapshot: whatever is asked of it is told for that state. It is for looking only: its
    /// integrator and counters are those of the present. `None` if the snapshot belongs to other coordinates.
    pub fn at_snapshot(&self, snapshot: &Snapshot) -> Option<Self> {
        let angles = self.current.angles();
        if snapshot.state.len() != self.shown.len() || snapshot.angles.len() != angles.len() {
            return None;
        }
        let mut then = self.clone();
        then.time = snapshot.time;
        then.shown.copy_from_slice(&snapshot.state);
        then.mechanism.state.set_revolutions(snapshot.angles.iter().copied());
        then.evaluate_current();
        Some(then)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a test that cannot go on says so
mod tests {
    use super::*;
    use crate::catalogue;

    #[test]
    fn a_snapshot_tells_what_was_told_then() {
        let mut run = Simulation::new(&catalogue::scene("spatial-slider-crank").unwrap()).unwrap();
        run.advance_to(0.3).unwrap();
        let snapshot = run.snapshot();
        let (then, matrix) = (run.multipliers(), run.jacobian());
        run.advance_to(0.7).unwrap();
        let now = run.multipliers();
        assert_ne!(now, then);
        let looked = run.at_snapshot(&snapshot).unwrap();
        assert_eq!(looked.time(), 0.3);
        let again = looked.multipliers();
        for (a, b) in again.iter().zip(&then) {
            for k in 0..3 {
                assert!((a.force[k] - b.force[k]).abs() < 1e-9 * (1.0 + b.force[k].abs()), "{a:?} {b:?}");
            }
        }
        assert_eq!(looked.jacobian().entries, matrix.entries);
        assert_eq!(run.multipliers(), now, "looking back changes nothing");
        let other = Simulation::new(&catalogue::scene("free-body").unwrap()).unwrap();
        assert!(other.at_snapshot(&snapshot).is_none());
    }
}
