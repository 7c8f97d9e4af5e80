//! What two stiff solutions have both lost: a vibration that hardly anything damps, and that their steps skip.

use crate::integrate::StepRecord;
use std::mem::swap;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::state::{Apart, Difference, State};

/// Angle, rad, that a vibration goes on by in a step from which on a method that damps what it skips may lose it.
const SKIPPED: f64 = 2.0;
/// Part of the energy of a vibration below which what is left between the two solutions is something else.
const LEFT: f64 = 0.1;
/// Steps at which it is to be seen: errors that each step makes anew are as large at some by chance, not at as many.
const LASTING: u32 = 6;
/// Weight of what dampers took at a step, for each step since.
const FORGOTTEN: f64 = 0.8;

/// A vibration that was seen between two solutions, at the ends of steps of the first one.
///
/// One loses it before the other does. As long as one has it, it lies between them, and is another part of itself at each step; once both
/// have lost it, the motion still has it.
#[derive(Clone, Debug)]
pub(super) struct Ringing {
    states: [State; 2],
    /// What lay between both at the ends of the last two steps, and that as y = (q, q̇).
    seen: [Difference; 2],
    between: [Vec<f64>; 2],
    vibration: Vibration,
    /// Half of what positions and velocities changed by at the steps where springs and velocities changed the most.
    kept: Vec<f64>,
    /// Whether both have lost it.
    lost: bool,
}

/// What is known of it.
#[derive(Clone, Copy, Debug, Default)]
struct Vibration {
    /// At how many steps it has been seen.
    steps: u32,
    /// Twice its energy, J.
    energy: f64,
    /// What dampers took from it at steps where it was seen, W, and twice its energies there, J.
    taken: [f64; 2],
    /// Twice the largest energies of what springs and velocities changed by, J.
    largest: [f64; 2],
}

impl Ringing {
    /// Nothing yet; `None` for a mechanism without a spring that can vibrate.
    pub fn new(mechanism: &Mechanism) -> Option<Self> {
        let system = &mechanism.system;
        let rings = system.loads.iter().any(|load| load.law().is_some_and(|law| law.stiffness > 0.0));
        let nothing = vec![0.0; 2 * system.coordinates];
        rings.then(|| Self {
            states: [mechanism.state.clone(), mechanism.state.clone()],
            seen: [Difference::none(system), Difference::none(system)],
            between: [nothing.clone(), nothing.clone()],
            vibration: Vibration::default(),
            kept: nothing,
            lost: false,
        })
    }

    /// Looks at both solutions at the end of a step of the first one.
    pub fn look(&mut self, mechanism: &Mechanism, step: &StepRecord, second: &[f64]) {
        self.decay(step.h);
        let apart = self.go_on(mechanism, step, second);
        // At steps that skip it, it changes by as much as it is, up to twice. What they follow hardly changes.
        let energy = 0.5 * (apart.kinetic + apart.springs);
        let skipped = 2.0 * energy * step.h * step.h > SKIPPED * SKIPPED * apart.positions;
        let Vibration { steps, energy: known, .. } = self.vibration;
        self.lost = steps >= LASTING && energy < LEFT * known;
        if !skipped && steps < LASTING {
            self.vibration = Vibration::default();
        }
        if skipped && !self.lost {
            if !(LEFT * known..=known / LEFT).contains(&energy) {
                self.vibration = Vibration::default();
            }
            self.see(energy, &apart);
        }
    }

    /// Takes over what lies between both at the end of a step, and says how far that is from what did at the end of the one before.
    fn go_on(&mut self, mechanism: &Mechanism, step: &StepRecord, second: &[f64]) -> Apart {
        let system = &mechanism.system;
        let n = system.coordinates;
        for (state, y) in self.states.iter_mut().zip([&step.y[..], second]) {
            state.copy_revolutions(&mechanism.state);
            state.set(system, step.t, &y[..n], &y[n..]);
        }
        let [now, before] = &mut self.between;
        swap(now, before);
        now.iter_mut().zip(step.y.iter().zip(second)).for_each(|(now, (a, b))| *now = a - b);
        let [now, before] = &mut self.seen;
        swap(now, before);
        let [first, second] = &self.states;
        now.set(system, [first, second]);
        now.apart(system, before)
    }

    /// What dampers take from it in the time h.
    fn decay(&mut self, h: f64) {
        let [taken, from] = self.vibration.taken;
        if from > 0.0 {
            let part = libm::exp(-h * taken / from);
            self.vibration.energy *= part;
            self.vibration.largest = self.vibration.largest.map(|largest| part * largest);
            let root = part.sqrt();
            self.kept.iter_mut().for_each(|kept| *kept *= root);
        }
    }

    /// Takes note of it at a step, and keeps by what positions and velocities have changed there, if that is the most.
    fn see(&mut self, energy: f64, apart: &Apart) {
        let known = &mut self.vibration;
        known.steps = known.steps.saturating_add(1);
        known.energy = known.energy.max(energy);
        let [taken, from] = known.taken.map(|sum| FORGOTTEN * sum);
        known.taken = [taken + apart.damping, from + energy];
        let [now, before] = &self.between;
        let n = now.len() / 2;
        let changes = [apart.springs, apart.kinetic];
        for (k, kept) in self.kept.chunks_mut(n).enumerate() {
            if changes[k] > known.largest[k] {
                known.largest[k] = changes[k];
                let between = now[k * n..].iter().zip(&before[k * n..]);
                kept.iter_mut().zip(between).for_each(|(kept, (now, before))| *kept = 0.5 * (now - before));
            }
        }
    }

    /// Adds it to an error, if both have lost it.
    pub fn add_to(&self, error: &mut [f64]) {
        if self.lost {
            error.iter_mut().zip(&self.kept).for_each(|(error, kept)| *error += kept);
        }
    }
}
