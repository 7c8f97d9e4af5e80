//! The factors of rows x · y = c bundle by bundle, like the points of joints: each body adds what its own factor makes to the
//! right-hand side, and takes its force back, four bodies at a time. The other factor is that of the point of expansion.

use crate::dynamics::series::bodies::{Bodies, FeatureSlot, LanePlace};
use crate::dynamics::series::lanes::{LaneVector, plus_whole, times_whole};
use crate::model::BodyRef;
use crate::system::System;
use crate::system::row::Form;
use pulp::Simd;
use std::ops::Range;
use triad_linalg::BlockCholesky;

/// No index, nor is one that is greater by a few numbers.
const NONE: u32 = u32::MAX / 2;

/// An index; of such a kind one comparison is enough where the next few numbers are read.
pub fn index(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(NONE)
}

/// A vector (or point) of each of L bodies (or of none), with the sign that it has in a factor of a row.
#[derive(Clone, Debug)]
struct VectorSlot<const L: usize> {
    signed: FeatureSlot<L>,
    /// Where their rows stand.
    at: [u32; L],
    /// Where the other factors stand among the numbers of all factors.
    partner: [u32; L],
    /// The other factors at the point of expansion.
    other: LaneVector<L>,
}

/// All vectors of bodies in rows of products that no driver moves.
#[derive(Clone, Debug)]
pub struct JointVectors<const L: usize> {
    slots: Vec<VectorSlot<L>>,
    /// Those of each bundle.
    of_bundle: Vec<Range<usize>>,
}

/// Whether nothing in a row is moved by a driver.
pub fn is_held(system: &System, form: &Form) -> bool {
    form.features(&system.angles).into_iter().all(|feature| system[feature].curve.is_none())
}

/// For each product in order, whether nothing in its bundle of L rows is moved by a driver.
pub fn held_products(system: &System, lanes: usize) -> Vec<bool> {
    let products = system.rows.iter().filter(|row| matches!(row.form, Form::Product { .. }));
    let held: Vec<bool> = products.map(|row| is_held(system, &row.form)).collect();
    held.chunks(lanes).flat_map(|bundle| vec![!bundle.contains(&false); bundle.len()]).collect()
}

/// Where the first number of a side of a product stands among the numbers of [`super::Rows`], which keep L products of `stride`
/// orders beside each other.
fn first_number<const L: usize>(product: usize, side: usize, stride: usize) -> usize {
    (product / L * stride * 2 + side) * 3 * L + product % L
}

/// A feature in a row: itself, its sign, its row, and the other factor.
struct End {
    slot: usize,
    lane: usize,
    sign: f64,
    row: usize,
    partner: usize,
}

impl<const L: usize> JointVectors<L> {
    /// Of a system, if it has some; `place` tells where features stand, `factor` where solver rows do, and `stride` how many coefficients are kept.
    pub fn new<B: Bodies<L>>(
        system: &System,
        bundles: &[B],
        slots: &[FeatureSlot<L>],
        place: &[LanePlace],
        factor: &BlockCholesky,
        stride: usize,
    ) -> Option<Self> {
        let held = held_products(system, L);
        let mut ends: Vec<Vec<End>> = system.bodies.iter().map(|_| Vec::new()).collect();
        let mut product = 0;
        for row in &system.rows {
            let Form::Product { a, b, .. } = row.form else { continue };
            for (side, difference) in [a, b].into_iter().enumerate().filter(|_| held[product]) {
                let signed = [(Some(difference.plus), 1.0), (difference.minus, -1.0)];
                for (feature, sign) in signed.into_iter().filter_map(|(f, sign)| Some((f?, sign))) {
                    let BodyRef::Moving(body) = system[feature].body else { continue };
                    let LanePlace { slot, lane } = place[feature.index()];
                    let partner = first_number::<L>(product, 1 - side, stride);
                    ends[body].push(End { slot, lane, sign, row: factor.places()[row.solver], partner });
                }
            }
            product += 1;
        }
        let nowhere = VectorSlot {
            signed: FeatureSlot::NOTHING,
            at: [index(factor.numbers()); L],
            partner: [NONE; L],
            other: [[0.0; L]; 3],
        };
        let mut vectors = Self { slots: Vec::new(), of_bundle: Vec::new() };
        for bundle in bundles {
            let first = vectors.slots.len();
            let ends = &ends[bundle.bodies()];
            vectors.slots.resize(first + ends.iter().map(Vec::len).max().unwrap_or(0), nowhere.clone());
            for end in ends.iter().flat_map(|ends| ends.iter().enumerate()) {
                let (k, &End { slot, lane, sign, row, partner }) = end;
                let vector = &mut vectors.slots[first + k];
                (vector.at[lane], vector.partner[lane]) = (index(row), index(partner));
                vector.signed.take_signed(lane, sign, &slots[slot]);
            }
            vectors.of_bundle.push(first..vectors.slots.len());
        }
        (!vectors.slots.is_empty()).then_some(vectors)
    }

    /// Takes over the factors at the point of expansion.
    #[inline(always)]
    pub fn take_factors(&mut self, numbers: &[f64]) {
        for VectorSlot { partner, other, .. } in &mut self.slots {
            for (lane, &at) in partner.iter().enumerate() {
                let at = at as usize;
                if let Some(x) = numbers.get(at..=at + 2 * L) {
                    for c in 0..3 {
                        other[c][lane] = x[c * L];
                    }
                }
            }
        }
    }

    /// Adds to a right-hand side what the vectors of bundle b make of the bodies' part x of the unknown.
    #[inline(always)]
    pub fn add_residual<S: Simd, B: Bodies<L>>(&self, simd: S, b: usize, x: &B::Natural, out: &mut [f64]) {
        for VectorSlot { signed, at, other, .. } in &self.slots[self.of_bundle[b].clone()] {
            let [first, second, third] = B::point(simd, signed, x);
            let sum = plus_whole(simd, &second, &other[1], &times_whole(simd, &first, &other[0]));
            let sum = plus_whole(simd, &third, &other[2], &sum);
            for (x, &at) in sum.iter().zip(at) {
                if let Some(out) = out.get_mut(at as usize) {
                    *out += x;
                }
            }
        }
    }

    /// Adds the generalized force that multipliers make at the vectors of bundle b.
    #[inline(always)]
    pub fn add_forces<S: Simd, B: Bodies<L>>(
        &self,
        simd: S,
        b: usize,
        multipliers: &[f64],
        force: &mut B::Natural,
    ) {
        for VectorSlot { signed, at, other, .. } in &self.slots[self.of_bundle[b].clone()] {
            let mut own = [0.0; L];
            for (own, &at) in own.iter_mut().zip(at) {
                *own = multipliers.get(at as usize).copied().unwrap_or(0.0);
            }
            let [x, y, z] = other;
            let taken_off =
                [times_whole(simd, x, &own), times_whole(simd, y, &own), times_whole(simd, z, &own)];
            B::pull_off(simd, signed, &taken_off, force);
        }
    }
}
