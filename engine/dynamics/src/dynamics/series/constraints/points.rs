//! The points of joints bundle by bundle: what they say of the rows that hold two of them together goes straight into the
//! right-hand side, and multipliers come straight back as forces, four numbers at a time.

use super::commons::{CommonVector, JointAxes};
use super::vectors::{JointVectors, held_products, index, is_held};
use crate::dynamics::series::bodies::{Bodies, FeatureSlot, LanePlace};
use crate::model::BodyRef;
use crate::system::System;
use crate::system::angle::Angle;
use crate::system::index::FeatureId;
use crate::system::load::SystemLoad;
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
    others: Slots,
    /// Slots whose features convolutions ask for, or forces of lower orders act on.
    convolved: Slots,
    /// Those of products, if there are any.
    vectors: Option<JointVectors<L>>,
    /// Common vectors, if there are any.
    axes: Option<JointAxes<L>>,
}

/// Slots, bundle by bundle.
#[derive(Clone, Debug)]
struct Slots {
    all: Vec<usize>,
    of_bundle: Vec<Range<usize>>,
}

impl Slots {
    fn new<const L: usize, B: Bodies<L>>(bundles: &[B], belongs: &[bool]) -> Self {
        let mut slots = Self { all: Vec::new(), of_bundle: Vec::new() };
        for bundle in bundles {
            let first = slots.all.len();
            slots.all.extend(bundle.slots().filter(|&slot| belongs[slot]));
            slots.of_bundle.push(first..slots.all.len());
        }
        slots
    }

    #[inline(always)]
    fn of(&self, b: usize) -> &[usize] {
        &self.all[self.of_bundle[b].clone()]
    }
}

/// Features of bodies that convolutions ask for, or that forces of lower orders act on: all but those of rows that are linear.
fn convolved(system: &System) -> Vec<FeatureId> {
    let curved =
        system.rows.iter().filter(|row| matches!(row.form, Form::Product { .. } | Form::Relation { .. }));
    let of_rows = curved.flat_map(|row| row.form.features(&system.angles));
    let of_angles = system.angles.iter().flat_map(Angle::features);
    let of_loads = system.loads.iter().flat_map(SystemLoad::features);
    let driven = (0..system.features.len()).map(FeatureId).filter(|&f| system[f].curve.is_some());
    of_rows.chain(of_angles).chain(of_loads).chain(driven).collect()
}

/// Whether a row holds two points together that no driver moves.
pub fn holds_points(system: &System, form: &Form) -> bool {
    matches!(form, Form::Coincidence { .. }) && is_held(system, form)
}

impl<const L: usize> JointPoints<L> {
    /// Of a system; `place` tells where features stand, and `factor` where solver rows do.
    pub fn new<B: Bodies<L>>(
        system: &System,
        bundles: &[B],
        slots: &[FeatureSlot<L>],
        place: &[LanePlace],
        factor: &BlockCholesky,
        stride: usize,
    ) -> Self {
        let place_of = |row: usize| index(factor.places()[row]);
        let nowhere = index(factor.numbers());
        // The ends of rows on each body; a feature may be that of several.
        let mut ends: Vec<Vec<(FeatureId, f64, u32)>> = vec![Vec::new(); system.bodies.len()];
        let mut is_other = vec![false; slots.len()];
        let mut held = held_products(system, L).into_iter();
        for row in &system.rows {
            let holds = holds_points(system, &row.form);
            if matches!(row.form, Form::Product { .. }) && held.next() == Some(true) {
                continue;
            }
            if matches!(row.form, Form::CommonVector { .. }) && is_held(system, &row.form) {
                continue;
            }
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
        let mut is_convolved = vec![false; slots.len()];
        for feature in convolved(system) {
            if let Some(convolved) = is_convolved.get_mut(place[feature.index()].slot) {
                *convolved = true;
            }
        }
        let mut points = Self {
            slots: Vec::new(),
            of_bundle: Vec::new(),
            others: Slots::new(bundles, &is_other),
            convolved: Slots::new(bundles, &is_convolved),
            vectors: JointVectors::new(system, bundles, slots, place, factor, stride),
            axes: JointAxes::new(system, bundles, slots, place, factor),
        };
        for bundle in bundles {
            let first = points.slots.len();
            let ends = &ends[bundle.bodies()];
            for k in 0..ends.iter().map(Vec::len).max().unwrap_or(0) {
                let mut slot = PointSlot { signed: FeatureSlot::NOTHING, at: [nowhere; L] };
                for (lane, ends) in ends.iter().enumerate() {
                    let Some(&(feature, sign, at)) = ends.get(k) else { continue };
                    slot.at[lane] = at;
                    slot.signed.take_signed(lane, sign, &slots[place[feature.index()].slot]);
                }
                points.slots.push(slot);
            }
            points.of_bundle.push(first..points.slots.len());
        }
        points
    }

    /// Whether other rows ask for features.
    pub fn has_others(&self) -> bool {
        !self.others.all.is_empty()
    }

    /// Slots of bundle b whose features other rows ask for.
    #[inline(always)]
    pub fn others(&self, b: usize) -> &[usize] {
        self.others.of(b)
    }

    /// Slots of bundle b that convolutions ask for, or that forces of lower orders act on.
    #[inline(always)]
    pub fn convolved(&self, b: usize) -> &[usize] {
        self.convolved.of(b)
    }

    /// Takes over the factors of products at the point of expansion, from the numbers of all factors, and the directions across
    /// common vectors where S was factored last.
    #[inline(always)]
    pub fn take_factors(&mut self, numbers: &[f64], commons: &[CommonVector]) {
        if let Some(vectors) = &mut self.vectors {
            vectors.take_factors(numbers);
        }
        if let Some(axes) = &mut self.axes {
            axes.take_directions(commons);
        }
    }

    /// Whether there are rows of vectors that no driver moves.
    pub fn has_vectors(&self) -> bool {
        self.vectors.is_some() || self.axes.is_some()
    }

    /// Adds to a right-hand side what the points of bundle b make of the bodies' part x of the unknown.
    #[inline(always)]
    pub fn add_residual<S: Simd, B: Bodies<L>>(&self, simd: S, b: usize, x: &B::Natural, out: &mut [f64]) {
        for PointSlot { signed, at } in &self.slots[self.of_bundle[b].clone()] {
            let rows = B::point_rows(simd, signed, x);
            for (row, &at) in rows.iter().zip(at) {
                if B::DIRECTIONS == 2 {
                    add(&[row[0], row[1]], out, at);
                } else {
                    // The number behind the third is that of no row, or of another one, to which nothing is added.
                    add(row, out, at);
                }
            }
        }
        if let Some(vectors) = &self.vectors {
            vectors.add_residual::<S, B>(simd, b, x, out);
        }
        if let Some(axes) = &self.axes {
            axes.add_residual::<S, B>(simd, b, x, out);
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
            B::pull_off_rows(simd, signed, &rows, force);
        }
        if let Some(vectors) = &self.vectors {
            vectors.add_forces::<S, B>(simd, b, multipliers, force);
        }
        if let Some(axes) = &self.axes {
            axes.add_forces::<S, B>(simd, b, multipliers, force);
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
