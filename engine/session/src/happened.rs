//! What has happened in a run so far: its events, and the singular configurations that it has passed.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use triad_engine::run::{EventOccurrence, Simulation, SingularConfiguration};

/// Events that are told, and passages: the latest. A state is sent ten times a second.
pub(crate) const MAX_TOLD: usize = 32;
/// Joints of all passages that are told together; those of the latest are told in any case.
const MAX_JOINTS: usize = 256;
/// Passages of the same joints whose times differ by less, relative to 1 s or the time itself, are one: a change may lie in it.
const SAME_TIME: f64 = 1e-6;

/// What has happened since the start, numbers that were changed in mid-run or not.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Happened {
    /// The latest events so far, in the order of time: at most 32. The error of their times is known up to the first change of numbers in
    /// mid-run.
    pub events: Vec<EventOccurrence>,
    /// How many earlier events are left out.
    pub earlier_events: u64,
    /// The latest singular configurations passed so far, in the order of time: at most 32, and fewer where many joints take part.
    pub passages: Vec<SingularConfiguration>,
    /// How many earlier passages are left out.
    pub earlier_passages: u64,
}

impl Happened {
    /// With what has happened in the simulation since, which passed these singular configurations. Where it did not begin at the start, the
    /// errors of its times are not known.
    pub(crate) fn and(
        &self,
        simulation: &Simulation,
        passed: &[SingularConfiguration],
        from_start: bool,
    ) -> Self {
        let mut all = self.clone();
        let plain = |event: &&EventOccurrence| event.time.is_finite() && event.rate.is_finite();
        for event in simulation.events().iter().filter(plain) {
            let error = event.error.filter(|_| from_start);
            all.events.push(EventOccurrence { error, ..event.clone() });
        }
        // The search is ahead by up to a step.
        for passage in passed.iter().filter(|passage| passage.time <= simulation.time()) {
            let again = |last: &SingularConfiguration| {
                last.joints == passage.joints
                    && passage.time - last.time <= SAME_TIME * (1.0 + passage.time.abs())
            };
            if !self.passages.last().is_some_and(again) {
                all.passages.push(passage.clone());
            }
        }
        let too_many = all.events.len().saturating_sub(MAX_TOLD);
        all.events.drain(..too_many);
        all.earlier_events += too_many as u64;
        let mut joints = 0;
        let told = all.passages.iter().rev().take(MAX_TOLD).enumerate().take_while(|(k, passage)| {
            joints += passage.joints.len();
            *k == 0 || joints <= MAX_JOINTS
        });
        let too_many = all.passages.len() - told.count();
        all.passages.drain(..too_many);
        all.earlier_passages += too_many as u64;
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use triad_engine::catalogue;

    #[test]
    fn what_is_told_is_bounded_and_the_latest() {
        let simulation = Simulation::new(&catalogue::scene("free-fall").expect("a scene")).expect("stands");
        let passage = |time: f64, joints: usize| SingularConfiguration {
            time,
            joints: (0..joints).map(|k| format!("j{k}")).collect(),
        };
        let tell = |before: &Happened, passed: &[SingularConfiguration]| {
            let told = before.and(&simulation, passed, true);
            (told.passages.len(), told.earlier_passages)
        };
        let many: Vec<_> = (-100..=0).map(|k| passage(f64::from(k), 2)).collect();
        assert_eq!(tell(&Happened::default(), &many), (32, 69));
        let before = Happened::default().and(&simulation, &many, true);
        assert_eq!(before.passages[31].time, 0.0);
        assert_eq!(before.events, []);
        // Once more the one that lies in a change is the same, and what is ahead has not happened.
        assert_eq!(tell(&before, &[passage(0.0, 2), passage(0.5, 2)]), (32, 69));
        assert_eq!(tell(&before, &[passage(0.0, 3)]), (32, 70));
        // Of large mechanisms fewer, at least one.
        assert_eq!(tell(&before, &[passage(0.0, 100)]), (32, 70));
        assert_eq!(tell(&before, &[passage(-0.1, 100), passage(0.0, 100)]), (30, 73));
        assert_eq!(tell(&before, &[passage(0.0, 300)]), (1, 101));
    }
}
