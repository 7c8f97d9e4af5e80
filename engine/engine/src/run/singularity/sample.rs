//! Pivot products at one time, and what they say of the distance of each joint from a singular configuration.

use std::f64::consts::FRAC_PI_2;

/// A joint whose largest pivot product is below this is redundant.
pub(super) const REDUNDANT: f64 = 1e-7;

/// Pivot products at one time, joint by joint.
#[derive(Clone, Debug)]
pub(super) struct Sample {
    pub products: Vec<f64>,
    /// Lower bounds of the distances from a singular configuration, as angles, rad; zero for roots that count as zero, infinite for
    /// joints that are redundant.
    pub angles: Vec<f64>,
}

impl Sample {
    /// Allocates for a number of joints.
    pub(super) fn new(joints: usize) -> Self {
        let [products, angles] = [(); 2].map(|()| Vec::with_capacity(joints));
        Self { products, angles }
    }

    /// Makes room for so many joints.
    pub(super) fn resize(&mut self, joints: usize) {
        for numbers in [&mut self.products, &mut self.angles] {
            numbers.resize(joints, 0.0);
        }
    }

    /// Root of a joint's product, relative to the largest, at most 1.
    pub(super) fn root(&self, joint: usize, largest: &[f64]) -> f64 {
        (self.products[joint] / largest[joint]).clamp(0.0, 1.0).sqrt()
    }

    /// Finds angles, once for all that ask: `largest` are the largest products so far, and `floor` is a root that counts as zero.
    pub(super) fn measure(&mut self, largest: &[f64], floor: f64) {
        let Self { products, angles } = self;
        for ((angle, product), largest) in angles.iter_mut().zip(&*products).zip(largest) {
            let root = (product / largest).clamp(0.0, 1.0).sqrt();
            // Found for those that are redundant as well: several at once, without a branch.
            *angle = angle_above(root - floor) + if *largest > REDUNDANT { 0.0 } else { f64::INFINITY };
        }
    }
}

/// A lower bound of the arcsine of a number up to 1, at most 2e-4 below it (Abramowitz and Stegun, 4.4.45); zero if that is negative.
/// Products are not fused: without vectors that would be a call, and rounding is far below the bound's own distance.
#[inline(always)]
fn angle_above(sine: f64) -> f64 {
    let x = sine.max(0.0);
    let slope = ((-0.018_729_3 * x + 0.074_261) * x - 0.212_114_4) * x + 1.570_728_8;
    (FRAC_PI_2 - 1e-4 - (1.0 - x).sqrt() * slope).max(0.0)
}
