//! The motion in numbers, packed for the page's own drawing: a hundredth of what a recording of the viewer takes.
//!
//! A block is little-endian: the numbers of bodies, joints and frames and a zero, as `u32`; the frames' times in s as
//! `f64`; then for each frame, as `f32`, of each body its centre of mass in m, its principal axes u, v, w, its velocity in
//! m/s, its angular velocity in rad/s and its acceleration in m/s², and of each joint where its reaction acts in m, its force
//! in N and its moment in N m, as [`Sample`] has them. A reaction that could not be found is NaN.

use super::sample::Sample;

/// Reactions of scenes with more joints are left out: their states leave them out too.
const MAX_JOINTS: usize = 64;
/// Numbers of a body: position, u, v, w, velocity, angular velocity, acceleration.
const OF_BODY: usize = 21;
/// Numbers of a joint: point, force, moment.
const OF_JOINT: usize = 9;

/// How many joints a block has of a scene with so many.
pub fn joints_told(joints: usize) -> usize {
    if joints > MAX_JOINTS { 0 } else { joints }
}

/// Bytes of one frame, its time included.
pub fn frame_size(bodies: usize, joints: usize) -> usize {
    size_of::<f64>() + size_of::<f32>() * (OF_BODY * bodies + OF_JOINT * joints)
}

/// The block of some frames, with so many joints.
pub fn block(samples: &[Sample], joints: usize) -> Vec<u8> {
    let bodies = samples.first().map_or(0, |sample| sample.poses.len());
    let mut block = Vec::with_capacity(16 + frame_size(bodies, joints) * samples.len());
    for count in [bodies, joints, samples.len(), 0] {
        block.extend(u32::try_from(count).unwrap_or(u32::MAX).to_le_bytes());
    }
    block.extend(samples.iter().flat_map(|sample| sample.time.to_le_bytes()));
    let mut put = |vector: [f64; 3]| block.extend(vector.into_iter().flat_map(|x| narrow(x).to_le_bytes()));
    for sample in samples {
        for pose in &sample.poses {
            put(pose.position);
            pose.axes.into_iter().for_each(&mut put);
            [pose.velocity, pose.angular_velocity, pose.acceleration].into_iter().for_each(&mut put);
        }
        for joint in 0..joints {
            let unknown = [[f64::NAN; 3]; 3];
            let found = sample.reactions.get(joint).map_or(unknown, |r| [r.at, r.force, r.moment]);
            found.into_iter().for_each(&mut put);
        }
    }
    block
}

/// A picture is drawn in single precision.
#[allow(clippy::cast_possible_truncation)]
fn narrow(x: f64) -> f32 {
    x as f32
}

#[cfg(test)]
mod tests {
    use super::super::sample::{Pose, SampledReaction};
    use super::*;

    fn at(time: f64, reactions: Vec<SampledReaction>) -> Sample {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        Sample {
            time,
            poses: vec![Pose {
                position: [time, 2.0, 3.0],
                axes,
                velocity: [8.0; 3],
                angular_velocity: [9.0; 3],
                acceleration: [10.0; 3],
            }],
            weights: Vec::new(),
            inertia: Vec::new(),
            reactions,
            energy: 0.0,
            position_violation: 0.0,
            velocity_violation: 0.0,
        }
    }

    #[test]
    fn frames_are_packed_in_the_order_that_is_told() {
        let known =
            SampledReaction { at: [4.0; 3], force: [5.0; 3], moment: [6.0; 3], multipliers: vec![7.0] };
        let block = block(&[at(0.0, vec![known]), at(0.5, Vec::new())], joints_told(1));
        assert_eq!(block.len(), 16 + 2 * (8 + 4 * (OF_BODY + OF_JOINT)));
        let number = |index: usize| f32::from_le_bytes(std::array::from_fn(|k| block[32 + 4 * index + k]));
        assert_eq!(&block[..16], &[1, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(f64::from_le_bytes(std::array::from_fn(|k| block[24 + k])), 0.5);
        assert_eq!([number(0), number(1), number(3), number(7), number(11)], [0.0, 2.0, 1.0, 1.0, 1.0]);
        assert_eq!([number(12), number(15), number(18)], [8.0, 9.0, 10.0]);
        assert_eq!([number(21), number(24), number(27), number(30)], [4.0, 5.0, 6.0, 0.5]);
        assert!(number(30 + 21).is_nan(), "no reaction is known there");
        assert_eq!(joints_told(MAX_JOINTS + 1), 0, "as their states do");
    }
}
