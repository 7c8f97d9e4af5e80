//! Pivot products at one time, and what they say of the distance of each joint from a singular configuration.

use pulp::{Arch, Simd, WithSimd};
use std::f32::consts::FRAC_PI_2;

/// A joint whose largest pivot product is below this is redundant.
pub(super) const REDUNDANT: f64 = 1e-7;
/// Distance from a singular configuration, as an angle, rad, below which a dip is likely.
const LOW: f32 = 0.25;
/// What rounding to single precision may have added to a root.
const ROUNDED_DOWN: f32 = 1.0 - 2e-7;

/// In single precision, of which a vector holds twice as many: for bounds, which it is enough for.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "bounds have room for it")]
pub(super) fn single(x: f64) -> f32 {
    x as f32
}

/// What products are measured by, joint by joint.
#[derive(Clone, Debug, Default)]
pub(super) struct Scales {
    /// The largest product so far, and its inverse.
    pub largest: Vec<f64>,
    inverse: Vec<f64>,
    /// What is added to an angle: infinity for joints that are redundant.
    offset: Vec<f32>,
}

impl Scales {
    /// Starts from the first products.
    pub(super) fn new(products: &[f64]) -> Self {
        let count = products.len();
        let [largest, inverse] = [(); 2].map(|()| vec![0.0; count]);
        let mut scales = Self { largest, inverse, offset: vec![f32::INFINITY; count] };
        scales.raise(products);
        scales
    }

    /// Takes over products that are larger.
    pub(super) fn raise(&mut self, products: &[f64]) {
        for (joint, &product) in products.iter().enumerate() {
            if product > self.largest[joint] {
                (self.largest[joint], self.inverse[joint]) = (product, 1.0 / product);
                self.offset[joint] = if product > REDUNDANT { 0.0 } else { f32::INFINITY };
            }
        }
    }

    /// Finds lower bounds of distances from a singular configuration, as angles, rad. Returns whether one is low.
    fn find_angles<'a>(
        &self,
        products: impl Iterator<Item = &'a f64>,
        floor: f64,
        angles: &mut [f32],
    ) -> bool {
        for ((angle, product), inverse) in angles.iter_mut().zip(products).zip(&self.inverse) {
            *angle = single(product * inverse);
        }
        Arch::new().dispatch(FindAngles { angles, offset: &self.offset, floor: single(floor) })
    }

    /// Raises bounds to the rate at which roots of products change between two times, for each radian of a turn, times a factor.
    pub(super) fn raise_rates(&self, rates: &mut [f32], [from, to]: [&[f64]; 2], turned: f64, factor: f64) {
        let by = factor / turned;
        Arch::new().dispatch(RaiseRates { rates, products: [from, to], inverse: &self.inverse, by });
    }
}

/// Pivot products at one time, joint by joint.
#[derive(Clone, Debug)]
pub(super) struct Sample {
    pub products: Vec<f64>,
    /// Lower bounds of the distances from a singular configuration, as angles, rad; zero for roots that count as zero, infinite for
    /// joints that are redundant.
    pub angles: Vec<f32>,
    /// Whether one of them is so small that a dip is likely.
    pub low: bool,
}

impl Sample {
    /// Allocates for a number of joints.
    pub(super) fn new(joints: usize) -> Self {
        Self { products: Vec::with_capacity(joints), angles: Vec::with_capacity(joints), low: false }
    }

    /// Makes room for so many joints.
    pub(super) fn resize(&mut self, joints: usize) {
        self.products.resize(joints, 0.0);
        self.angles.resize(joints, 0.0);
    }

    /// Root of a joint's product, relative to the largest, at most 1.
    pub(super) fn root(&self, joint: usize, largest: &[f64]) -> f64 {
        (self.products[joint] / largest[joint]).clamp(0.0, 1.0).sqrt()
    }

    /// Finds angles, once for all that ask: `floor` is a root that counts as zero.
    pub(super) fn measure(&mut self, scales: &Scales, floor: f64) {
        self.low = scales.find_angles(self.products.iter(), floor, &mut self.angles);
    }

    /// The same for one of several times at which there are products, without keeping these.
    pub(super) fn measure_one(&mut self, products: &[[f64; 4]], time: usize, scales: &Scales, floor: f64) {
        let products = products.iter().map(|all| &all[time]);
        self.low = scales.find_angles(products, floor, &mut self.angles);
    }
}

/// Whether something is true of some joint's angles at two times and the bound of its rate.
pub(super) fn any_within(ends: [&[f32]; 2], rates: &[f32], within: impl Fn(f32, f32, f32) -> bool) -> bool {
    Arch::new().dispatch(AnyWithin { ends, rates, within })
}

/// [`any_within`], to be compiled for each set of vector instructions.
struct AnyWithin<'a, F> {
    ends: [&'a [f32]; 2],
    rates: &'a [f32],
    within: F,
}

impl<F: Fn(f32, f32, f32) -> bool> WithSimd for AnyWithin<'_, F> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> bool {
        let Self { ends: [from, to], rates, within } = self;
        // All of them at once, as in most cases it is none.
        let mut any = 0;
        for ((low, high), rate) in from.iter().zip(to).zip(rates) {
            any |= u32::from(within(*low, *high, *rate));
        }
        any > 0
    }
}

/// Angles of relative products, to be compiled for each set of vector instructions.
struct FindAngles<'a> {
    angles: &'a mut [f32],
    offset: &'a [f32],
    floor: f32,
}

impl WithSimd for FindAngles<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> bool {
        let Self { angles, offset, floor } = self;
        // All of them, without a branch, so that they go in vectors.
        let mut low = 0;
        for (angle, offset) in angles.iter_mut().zip(offset) {
            let root = angle.clamp(0.0, 1.0).sqrt() * ROUNDED_DOWN;
            *angle = angle_above(root - floor) + offset;
            low |= u32::from(*angle < LOW);
        }
        low > 0
    }
}

/// [`Scales::raise_rates`], likewise.
struct RaiseRates<'a> {
    rates: &'a mut [f32],
    products: [&'a [f64]; 2],
    inverse: &'a [f64],
    by: f64,
}

impl WithSimd for RaiseRates<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { rates, products: [from, to], inverse, by } = self;
        for (((rate, from), to), inverse) in rates.iter_mut().zip(from).zip(to).zip(inverse) {
            let change = (to * inverse).max(0.0).sqrt() - (from * inverse).max(0.0).sqrt();
            *rate = rate.max(single(by * change.abs()));
        }
    }
}

/// A lower bound of the arcsine of a number up to 1, at most 2e-4 below it (Abramowitz and Stegun, 4.4.45), and 8e-4 with that rounded
/// down beside a right angle; zero if it is negative.
/// Products are not fused: without vectors that would be a call, and rounding is far below the bound's own distance.
#[inline(always)]
fn angle_above(sine: f32) -> f32 {
    let x = sine.max(0.0);
    let slope = ((-0.018_729_3 * x + 0.074_261) * x - 0.212_114_4) * x + 1.570_728_8;
    (FRAC_PI_2 - 1e-4 - (1.0 - x).sqrt() * slope).max(0.0)
}
