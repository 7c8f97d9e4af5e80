//! Common vectors bundle by bundle, like the points of joints: what they say of the two rows across them goes straight into the
//! right-hand side, and multipliers come straight back, four bodies at a time.

use super::vectors::{index, is_held};
use crate::dynamics::series::bodies::{Bodies, FeatureSlot, LanePlace};
use crate::dynamics::series::lanes::{LaneVector, plus_whole, times_whole};
use crate::model::BodyRef;
use crate::system::System;
use crate::system::index::FeatureId;
use crate::system::row::Form;
use pulp::Simd;
use std::ops::Range;
use triad_linalg::BlockCholesky;

/// a − b = 0 for unit vectors, kept across the vector's direction at the point of expansion.
#[derive(Clone, Copy, Debug)]
pub struct CommonVector {
    pub a: LanePlace,
    pub b: LanePlace,
    /// Where the first of its two rows stands in the factor.
    pub row: usize,
    /// The first of the two rows among the system's solver rows.
    pub solver: usize,
    /// Whether [`super::JointPoints`] does not see to it, as something in it moves as prescribed.
    pub driven: bool,
    /// The two directions where S was factored last.
    pub across: [[f64; 3]; 2],
    /// The two directions that the series at hand are written in.
    pub expanded: [[f64; 3]; 2],
}

/// A vector of each of L bodies (or of none), with the sign that it has in its row.
#[derive(Clone, Debug)]
struct CommonSlot<const L: usize> {
    signed: FeatureSlot<L>,
    /// Where the first of their two rows stand.
    at: [u32; L],
    /// Which common vector it is, and the directions across it.
    common: [Option<usize>; L],
    across: [LaneVector<L>; 2],
}

/// All vectors of bodies that are common with another one, as no driver moves them.
#[derive(Clone, Debug)]
pub struct JointAxes<const L: usize> {
    slots: Vec<CommonSlot<L>>,
    /// Those of each bundle.
    of_bundle: Vec<Range<usize>>,
}

impl<const L: usize> JointAxes<L> {
    /// Of a system, if it has some; `place` tells where features stand, and `factor` where solver rows do.
    pub fn new<B: Bodies<L>>(
        system: &System,
        bundles: &[B],
        slots: &[FeatureSlot<L>],
        place: &[LanePlace],
        factor: &BlockCholesky,
    ) -> Option<Self> {
        let mut ends: Vec<Vec<(FeatureId, f64, usize, usize)>> = vec![Vec::new(); system.bodies.len()];
        let commons = system.rows.iter().filter(|row| matches!(row.form, Form::CommonVector { .. }));
        for (k, row) in commons.enumerate().filter(|(_, row)| is_held(system, &row.form)) {
            let features = row.form.features(&system.angles);
            for (feature, sign) in features.into_iter().zip([1.0, -1.0]) {
                if let BodyRef::Moving(body) = system[feature].body {
                    ends[body].push((feature, sign, factor.places()[row.solver], k));
                }
            }
        }
        let nowhere = CommonSlot {
            signed: FeatureSlot::NOTHING,
            at: [index(factor.numbers()); L],
            common: [None; L],
            across: [[[0.0; L]; 3]; 2],
        };
        let mut axes = Self { slots: Vec::new(), of_bundle: Vec::new() };
        for bundle in bundles {
            let first = axes.slots.len();
            let ends = &ends[bundle.bodies()];
            axes.slots.resize(first + ends.iter().map(Vec::len).max().unwrap_or(0), nowhere.clone());
            for (lane, ends) in ends.iter().enumerate() {
                for (slot, &(feature, sign, row, common)) in axes.slots[first..].iter_mut().zip(ends) {
                    (slot.at[lane], slot.common[lane]) = (index(row), Some(common));
                    slot.signed.take_signed(lane, sign, &slots[place[feature.index()].slot]);
                }
            }
            axes.of_bundle.push(first..axes.slots.len());
        }
        (!axes.slots.is_empty()).then_some(axes)
    }

    /// Takes over the directions across.
    #[inline(always)]
    pub fn take_directions(&mut self, commons: &[CommonVector]) {
        for CommonSlot { common, across, .. } in &mut self.slots {
            for (lane, common) in common.iter().enumerate() {
                let Some(common) = common.and_then(|k| commons.get(k)) else { continue };
                for (own, given) in across.iter_mut().zip(&common.across) {
                    for c in 0..3 {
                        own[c][lane] = given[c];
                    }
                }
            }
        }
    }

    /// Adds to a right-hand side what the vectors of bundle b make of the bodies' part x of the unknown.
    #[inline(always)]
    pub fn add_residual<S: Simd, B: Bodies<L>>(&self, simd: S, b: usize, x: &B::Natural, out: &mut [f64]) {
        for CommonSlot { signed, at, across: [t1, t2], .. } in &self.slots[self.of_bundle[b].clone()] {
            let [x, y, z] = B::point(simd, signed, x);
            let first = plus_whole(simd, &y, &t1[1], &times_whole(simd, &x, &t1[0]));
            let first = plus_whole(simd, &z, &t1[2], &first);
            let second = plus_whole(simd, &y, &t2[1], &times_whole(simd, &x, &t2[0]));
            let second = plus_whole(simd, &z, &t2[2], &second);
            for ((first, second), &at) in first.iter().zip(&second).zip(at) {
                let at = at as usize;
                if let Some([one, two]) = out.get_mut(at..at + 2) {
                    *one += first;
                    *two += second;
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
        for CommonSlot { signed, at, across: [t1, t2], .. } in &self.slots[self.of_bundle[b].clone()] {
            let (mut first, mut second) = ([0.0; L], [0.0; L]);
            for ((first, second), &at) in first.iter_mut().zip(&mut second).zip(at) {
                let at = at as usize;
                if let Some(&[one, two]) = multipliers.get(at..at + 2) {
                    (*first, *second) = (one, two);
                }
            }
            let mut taken_off = [[0.0; L]; 3];
            for c in 0..3 {
                taken_off[c] = plus_whole(simd, &t2[c], &second, &times_whole(simd, &t1[c], &first));
            }
            B::pull_off(simd, signed, &taken_off, force);
        }
    }
}
