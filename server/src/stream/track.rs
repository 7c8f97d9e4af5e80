//! The motion in numbers, packed for the page's own drawing: a hundredth of what a recording of the viewer takes.
//!
//! A block is little-endian: the numbers of bodies, joints and frames and a zero, as `u32`; the frames' times in s as
//! `f64`; then for each frame, as `f32`, of each body its centre of mass in m and its principal axes u, v, w, and of each
//! joint where its reaction acts in m, its force in N and its moment in N m, as [`Sample`] has them. A reaction that could
//! not be found is NaN.

use std::sync::Arc;

use super::geometry::narrow;
use super::hub::Hub;
use super::sample::Sample;

/// Reactions of scenes with more joints are left out: their states leave them out too.
const MAX_JOINTS: usize = 64;
/// Numbers of a body: position, u, v, w.
const OF_BODY: usize = 12;
/// Numbers of a joint: point, force, moment.
const OF_JOINT: usize = 9;

/// The frames of one run on their way to whoever draws them.
pub struct Track {
    hub: Arc<Hub>,
    joints: usize,
    /// How many of the run's samples are packed.
    packed: usize,
}

impl Track {
    /// Of a scene with so many joints, for the watchers of `hub`.
    pub fn new(hub: Arc<Hub>, joints: usize) -> Self {
        let joints = if joints > MAX_JOINTS { 0 } else { joints };
        Self { hub, joints, packed: 0 }
    }

    /// Packs those of a run's samples that nobody has received yet, if anybody watches.
    pub fn pack(&mut self, samples: &[Sample]) {
        let waiting = &samples[self.packed..];
        if self.hub.watchers() == 0 || waiting.is_empty() {
            return;
        }
        self.hub.push(block(waiting, self.joints));
        self.packed = samples.len();
    }

    /// Samples were dropped, of those that are packed so many.
    pub fn thinned(&mut self, dropped: impl Fn(usize) -> usize) {
        self.packed -= dropped(self.packed);
    }

    /// Another run begins, of a scene with so many joints.
    pub fn restart(&mut self, joints: usize) {
        *self = Self::new(Arc::clone(&self.hub), joints);
        self.hub.restart();
    }

    /// Who draws.
    pub fn watchers(&self) -> usize {
        self.hub.watchers()
    }
}

/// Samples as one block, with the reactions of so many joints.
pub fn block(samples: &[Sample], joints: usize) -> Vec<u8> {
    let bodies = samples.first().map_or(0, |sample| sample.poses.len());
    let frame = size_of::<f64>() + size_of::<f32>() * (OF_BODY * bodies + OF_JOINT * joints);
    let mut block = Vec::with_capacity(16 + frame * samples.len());
    for count in [bodies, joints, samples.len(), 0] {
        block.extend(u32::try_from(count).unwrap_or(u32::MAX).to_le_bytes());
    }
    block.extend(samples.iter().flat_map(|sample| sample.time.to_le_bytes()));
    let mut put = |vector: [f64; 3]| block.extend(vector.into_iter().flat_map(|x| narrow(x).to_le_bytes()));
    for sample in samples {
        for pose in &sample.poses {
            put(pose.position);
            pose.axes.into_iter().for_each(&mut put);
        }
        for joint in 0..joints {
            let unknown = [[f64::NAN; 3]; 3];
            let found = sample.reactions.get(joint).map_or(unknown, |r| [r.at, r.force, r.moment]);
            found.into_iter().for_each(&mut put);
        }
    }
    block
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stream::{Delivery, Pose, SampledReaction};

    fn at(time: f64, reactions: Vec<SampledReaction>) -> Sample {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        Sample {
            time,
            poses: vec![Pose { position: [time, 2.0, 3.0], axes }],
            weights: Vec::new(),
            inertia: Vec::new(),
            reactions,
            energy: 0.0,
            position_violation: 0.0,
            velocity_violation: 0.0,
        }
    }

    #[test]
    fn frames_are_packed_once_in_the_order_that_is_told_and_only_for_watchers() {
        let hub = Arc::new(Hub::new(1000));
        let mut track = Track::new(Arc::clone(&hub), 1);
        let known =
            SampledReaction { at: [4.0; 3], force: [5.0; 3], moment: [6.0; 3], multipliers: vec![7.0] };
        let mut samples = vec![at(0.0, vec![known]), at(0.5, Vec::new())];
        track.pack(&samples);
        assert_eq!(hub.bytes(), 0, "nobody watches");
        let mut watcher = hub.watch();
        track.pack(&samples);
        let Some(Delivery::Blocks(blocks)) = watcher.poll() else { panic!("two frames") };
        let block = &blocks[0];
        assert_eq!(block.len(), 16 + 2 * (8 + 4 * (OF_BODY + OF_JOINT)));
        let number = |index: usize| f32::from_le_bytes(std::array::from_fn(|k| block[32 + 4 * index + k]));
        assert_eq!(&block[..16], &[1, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(f64::from_le_bytes(std::array::from_fn(|k| block[24 + k])), 0.5);
        assert_eq!([number(0), number(1), number(3), number(7), number(11)], [0.0, 2.0, 1.0, 1.0, 1.0]);
        assert_eq!([number(12), number(15), number(18), number(21)], [4.0, 5.0, 6.0, 0.5]);
        assert!(number(21 + 12).is_nan(), "no reaction is known there");
        track.pack(&samples);
        assert_eq!(watcher.poll(), None, "nothing is new");
        samples.remove(1);
        track.thinned(|packed| packed - 1);
        samples.push(at(1.0, Vec::new()));
        track.pack(&samples);
        let Some(Delivery::Blocks(blocks)) = watcher.poll() else { panic!("the new frame") };
        assert_eq!(f64::from_le_bytes(std::array::from_fn(|k| blocks[0][16 + k])), 1.0);
    }
}
