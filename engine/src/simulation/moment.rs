//! A state of a run, kept so that it can be looked at again after the run has gone on.

use super::Simulation;
use crate::matrices::{self, Symmetric};

/// A state of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// Time, s.
    pub time: f64,
    /// q and q̇.
    state: Vec<f64>,
    /// Angles with their whole turns, rad.
    angles: Vec<f64>,
}

impl Moment {
    /// About how many bytes it takes.
    pub fn size(&self) -> usize {
        size_of::<Self>() + size_of::<f64>() * (self.state.len() + self.angles.len())
    }
}

impl Simulation {
    /// The state that is shown, to be looked at again with [`Simulation::at_moment`].
    pub fn moment(&mut self) -> Moment {
        self.mechanism.set_state(self.time, &self.shown);
        let angles = self.mechanism.elimination.angles.iter().map(|angle| angle.value).collect();
        Moment { time: self.time, state: self.shown.clone(), angles }
    }

    /// This run as it was at a moment: whatever is asked of it is told for that state. It is for looking only: its
    /// integrator and counters are those of the present. `None` if the moment belongs to other coordinates.
    pub fn at_moment(&self, moment: &Moment) -> Option<Self> {
        let angles = &self.mechanism.elimination.angles;
        if moment.state.len() != self.shown.len() || moment.angles.len() != angles.len() {
            return None;
        }
        let mut then = self.clone();
        then.time = moment.time;
        then.shown.copy_from_slice(&moment.state);
        for (angle, value) in then.mechanism.elimination.angles.iter_mut().zip(&moment.angles) {
            angle.reference = *value;
        }
        Some(then)
    }

    /// The augmented matrix of the equations of motion at the shown state.
    pub fn augmented(&mut self) -> Symmetric {
        self.mechanism.set_state(self.time, &self.shown);
        matrices::augmented(&self.mechanism.system, &self.mechanism.elimination)
    }

    /// S, which the solver factors, at the shown state.
    pub fn schur(&mut self) -> Symmetric {
        let time = self.time;
        self.without_counting(|mechanism, shown| {
            mechanism.set_state(time, shown);
            matrices::schur(&mechanism.system, &mut mechanism.elimination)
        })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a test that cannot go on says so
mod tests {
    use super::*;
    use crate::catalogue;

    #[test]
    fn a_moment_tells_what_was_told_then() {
        let mut run = Simulation::new(&catalogue::scene("spatial-slider-crank").unwrap()).unwrap();
        run.advance_to(0.3).unwrap();
        let moment = run.moment();
        let (then, matrix) = (run.multipliers(), run.jacobian().clone());
        run.advance_to(0.7).unwrap();
        let now = run.multipliers();
        assert_ne!(now, then);
        let mut looked = run.at_moment(&moment).unwrap();
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
        assert!(other.at_moment(&moment).is_none());
    }
}
