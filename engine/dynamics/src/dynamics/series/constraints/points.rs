//! The points of joints bundle by bundle: what they say of the rows that hold two of them together goes straight into the
//! right-hand side, and multipliers come straight back as forces, four numbers at a time.

use crate::dynamics::series::bodies::{Bodies, FeatureSlot, LanePlace};
use crate::dynamics::series::lanes::{lanes_of_rows, rows_of_lanes};
use crate::model::BodyRef;
use crate::system::System;
use crate::system::index::FeatureId;
use crate::system::row::Form;
use pulp::Simd;
use std::ops::Range;
use triad_linalg::BlockCholesky;

/// Numbers behind a right-hand side, for lanes that have no point.
pub const NOWHERE: usize = 4;

/// A point of each of L bodies (or of none), with the sign that it has in a row.
#[derive(Clone, Debug)]
struct PointSlot<const L: usize> {
    signed: FeatureSlot<L>,
    /// Where the first numbers of their rows stand.
    at: [u32; L],
}

/// All points of bodies that are held at other points.
#[derive(Clone, Debug)]
pub struct JointPoints<const L: usize> {
    slots: Vec<PointSlot<L>>,
    /// Those of each bundle.
    of_bundle: Vec<Range<usize>>,
    /// Slots whose features other rows ask for, bundle by bundle.
    others: Vec<usize>,
    others_of_bundle: Vec<Range<usize>>,
}

/// Whether a row holds two points together that no driver moves.
pub fn holds_points(system: &System, form: &Form) -> bool {
    let fixed = |f: FeatureId| system[f].curve.is_none();
    matches!(form, Form::Coincidence { a, b } if fixed(*a) && fixed(*b))
}

impl<const L: usize> JointPoints<L> {
    /// Of a system; `place` tells where features stand, and `factor` where solver rows do.
    pub fn new<B: Bodies<L>>(
        system: &System,
        bundles: &[B],
        slots: &[FeatureSlot<L>],
        place: &[LanePlace],
        factor: &BlockCholesky,
    ) -> Self {
        // Far fewer numbers than u32 holds; indices of that kind need one comparison in place of two.
        let place_of = |row: usize| u32::try_from(factor.places()[row]).unwrap_or(u32::MAX);
        let nowhere = u32::try_from(factor.numbers()).unwrap_or(u32::MAX);
        // The ends of rows on each body; a feature may be that of several.
        let mut ends: Vec<Vec<(FeatureId, f64, u32)>> = vec![Vec::new(); system.bodies.len()];
        let mut is_other = vec![false; slots.len()];
        for row in &system.rows {
            let holds = holds_points(system, &row.form);
            for (k, feature) in row.form.features(&system.angles).into_iter().enumerate() {
                let BodyRef::Moving(body) = system[feature].body else { continue };
                if holds {
                    let sign = if k == 0 { 1.0 } else { -1.0 };
                    ends[body].push((feature, sign, place_of(row.solver)));
                } else {
                    is_other[place[feature.index()].slot] = true;
                }
            }
        }
        let mut points = Self {
            slots: Vec::new(),
            of_bundle: Vec::new(),
            others: Vec::new(),
            others_of_bundle: Vec::new(),
        };
        for bundle in bundles {
            let (first, first_other) = (points.slots.len(), points.others.len());
            let ends = &ends[bundle.bodies()];
            for k in 0..ends.iter().map(Vec::len).max().unwrap_or(0) {
                let no_point = FeatureSlot { local: [[0.0; L]; 3], point: [0.0; L] };
                let mut slot = PointSlot { signed: no_point, at: [nowhere; L] };
                for (lane, ends) in ends.iter().enumerate() {
                    let Some(&(feature, sign, at)) = ends.get(k) else { continue };
                    slot.at[lane] = at;
                    slot.signed.point[lane] = sign;
                    for c in 0..3 {
                        slot.signed.local[c][lane] = sign * slots[place[feature.index()].slot].local[c][lane];
                    }
                }
                points.slots.push(slot);
            }
            points.of_bundle.push(first..points.slots.len());
            points.others.extend(bundle.slots().filter(|&slot| is_other[slot]));
            points.others_of_bundle.push(first_other..points.others.len());
        }
        points
    }

    /// Whether other rows ask for features.
    pub fn has_others(&self) -> bool {
        !self.others.is_empty()
    }

    /// Slots of bundle b whose features other rows ask for.
    #[inline(always)]
    pub fn others(&self, b: usize) -> &[usize] {
        &self.others[self.others_of_bundle[b].clone()]
    }

    /// Adds to a right-hand side what the points of bundle b make of the bodies' part x of the unknown.
    #[inline(always)]
    pub fn add_residual<S: Simd, B: Bodies<L>>(&self, simd: S, b: usize, x: &B::Natural, out: &mut [f64]) {
        for PointSlot { signed, at } in &self.slots[self.of_bundle[b].clone()] {
            let [first, second, third] = B::point(simd, signed, x);
            let rows = rows_of_lanes(simd, [first, second, third, [0.0; L]]);
            for (row, &at) in rows.iter().zip(at) {
                if B::DIRECTIONS == 2 {
                    add(&[row[0], row[1]], out, at);
                } else {
                    // The number behind the third is that of no row, or of another one, to which nothing is added.
                    add(row, out, at);
                }
            }
        }
    }

    /// Adds the generalized force that multipliers make at the points of bundle b.
    #[inline(always)]
    pub fn add_forces<S: Simd, B: Bodies<L>>(
        &self,
        simd: S,
        b: usize,
        multipliers: &[f64],
        force: &mut B::Natural,
    ) {
        for PointSlot { signed, at } in &self.slots[self.of_bundle[b].clone()] {
            let mut rows = [[0.0; 4]; L];
            for (row, &at) in rows.iter_mut().zip(at) {
                let at = at as usize;
                if B::DIRECTIONS == 2 {
                    if let Some(&[first, second]) = multipliers.get(at..at + 2) {
                        *row = [first, second, 0.0, 0.0];
                    }
                } else if let Some(&[first, second, third, fourth]) = multipliers.get(at..at + 4) {
                    *row = [first, second, third, fourth];
                }
            }
            // The force of a joint on the body of its first point is −λ.
            let [first, second, third, _] = lanes_of_rows(simd, &rows);
            B::pull_off(simd, signed, &[first, second, third], force);
        }
    }
}

#[inline(always)]
fn add<const W: usize>(row: &[f64; W], out: &mut [f64], at: u32) {
    let at = at as usize;
    if let Some(out) = out.get_mut(at..at + W).and_then(<[f64]>::first_chunk_mut::<W>) {
        for c in 0..W {
            out[c] += row[c];
        }
    }
}
