//! S at several instants of a step at once, one in each lane: how near the step comes to a singular configuration — THEORY section 8.
//! For mechanisms whose joints are nothing but common points: those of the plane, and balls.

use super::Series;
use super::bodies::{Bodies, FeatureSlot};
use super::constraints::CommonPointProduct;
use super::lanes::{Lane, plus};
use crate::system::System;
use pulp::{Simd, WithSimd};
use std::ops::Range;
use triad_linalg::block_cholesky::PivotLanes;

/// A body, alone in all lanes of a bundle.
#[derive(Clone, Debug)]
struct Alone<const L: usize, B: Bodies<L>> {
    bundle: B,
    /// Where its coefficients stand: the bundle and the lane.
    place: [usize; 2],
    pairs: Range<usize>,
}

/// Two points of a body, and where the block of S is that they add to.
#[derive(Clone, Copy, Debug)]
struct PointPair {
    slots: [usize; 2],
    sign: f64,
    offset: usize,
}

/// S at L instants, and what is needed to build it.
#[derive(Clone, Debug)]
pub struct Instants<const L: usize, B: Bodies<L>> {
    bodies: Vec<Alone<L, B>>,
    slots: Vec<FeatureSlot<L>>,
    mobility: Vec<B::Mobility>,
    pairs: Vec<PointPair>,
    /// The part of S that never changes.
    base: Vec<Lane<L>>,
    pivots: PivotLanes<L>,
}

/// What [`Series::pivot_products_at`] does, to be compiled for each set of vector instructions.
struct Look<'a, const L: usize, B: Bodies<L>> {
    instants: &'a mut Instants<L, B>,
    q: &'a [B::Natural],
    stride: usize,
    order: usize,
    tau: &'a Lane<L>,
}

impl<const L: usize, B: Bodies<L>> WithSimd for Look<'_, L, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { instants, q, stride, order, tau } = self;
        instants.pivots.values.copy_from_slice(&instants.base);
        for body in 0..instants.bodies.len() {
            let [bundle, lane] = instants.bodies[body].place;
            let state = value_at::<L, B>(&q[bundle * stride..=bundle * stride + order], lane, tau);
            instants.add_body(body, &state);
        }
    }
}

impl<const L: usize, B: Bodies<L>> Instants<L, B> {
    /// Of series and the system that they are of. `None` if joints are more than common points, or rows are left out.
    pub fn new(series: &Series<L, B>, system: &System) -> Option<Self> {
        if !series.prescribed.is_empty() {
            return None;
        }
        let products = series.schur.products_of_common_points()?;
        let pivots = series.schur.factor.pivot_lanes()?;
        let mut instants = Self {
            bodies: Vec::new(),
            slots: Vec::new(),
            mobility: Vec::new(),
            pairs: Vec::new(),
            base: series.schur.base().iter().map(|&x| [x; L]).collect(),
            pivots,
        };
        // In the order of slots, as those of bundles are.
        let mut rest = products.as_slice();
        for (b, bundle) in series.bundles.iter().enumerate() {
            let count = rest.partition_point(|product| product.slots[0] < bundle.slots().end);
            let (own, others) = rest.split_at(count);
            rest = others;
            for (lane, body) in bundle.bodies().enumerate() {
                let own = own.iter().filter(|product| product.lane == lane);
                instants.add(series, system, body, [b, lane], own);
            }
        }
        instants.mobility = vec![B::NO_MOBILITY; instants.slots.len()];
        Some(instants)
    }

    /// Takes over a body with its pairs of points.
    fn add<'a>(
        &mut self,
        series: &Series<L, B>,
        system: &System,
        body: usize,
        place: [usize; 2],
        products: impl Iterator<Item = &'a CommonPointProduct>,
    ) {
        let first = (self.slots.len(), self.pairs.len());
        let mut known: Vec<usize> = Vec::new();
        for product in products {
            let slots = product.slots.map(|slot| {
                let at = known.iter().position(|&other| other == slot);
                let at = at.unwrap_or_else(|| {
                    known.push(slot);
                    known.len() - 1
                });
                first.0 + at
            });
            self.pairs.push(PointPair { slots, sign: product.sign, offset: product.offset });
        }
        if known.is_empty() {
            return;
        }
        let lane = place[1];
        self.slots.extend(known.iter().map(|&slot| {
            let FeatureSlot { local, point } = &series.slots[slot];
            FeatureSlot { local: [0, 1, 2].map(|c| [local[c][lane]; L]), point: [point[lane]; L] }
        }));
        let mut bundle = B::empty(body..body + 1, first.0..self.slots.len());
        (0..L).for_each(|lane| bundle.set_body(lane, system, &system.bodies[body]));
        self.bodies.push(Alone { bundle, place, pairs: first.1..self.pairs.len() });
    }

    /// Adds to S what a body makes of it.
    #[inline(always)]
    fn add_body(&mut self, body: usize, state: &B::Natural) {
        let Self { bodies, slots, mobility, pairs, pivots, .. } = self;
        let Alone { bundle, pairs: own, .. } = &mut bodies[body];
        bundle.linearize(state);
        for slot in bundle.slots() {
            mobility[slot] = bundle.half_mobility(&slots[slot], state);
        }
        for PointPair { slots, sign, offset } in &pairs[own.clone()] {
            let [a, b] = slots.map(|slot| &mobility[slot]);
            let strips = B::pair(a, b);
            let block = &mut pivots.values[*offset..*offset + 4 * B::STRIPS];
            for (out, strip) in block.as_chunks_mut::<4>().0.iter_mut().zip(&strips) {
                for (out, x) in out.iter_mut().zip(strip) {
                    *out = plus(&[*sign; L], x, out);
                }
            }
        }
    }
}

/// Values at L times of one lane of polynomials Σ Q_k τᵏ.
#[inline(always)]
fn value_at<const L: usize, B: Bodies<L>>(
    coefficients: &[B::Natural],
    lane: usize,
    tau: &Lane<L>,
) -> B::Natural {
    let (mut value, lane) = (B::ZERO, lane % L);
    let lanes = B::lanes_mut(&mut value);
    for coefficient in coefficients.iter().rev() {
        for (value, c) in lanes.iter_mut().zip(B::lanes(coefficient)) {
            *value = plus(value, tau, &[c[lane]; L]);
        }
    }
    value
}

impl<const L: usize, B: Bodies<L>> Series<L, B> {
    /// Pivot products of the joints at L times after the start of the last step, which was cut at order `order`. `None` if they can
    /// only be found one after another.
    pub fn pivot_products_at(&mut self, tau: &Lane<L>, order: usize) -> Option<&[Lane<L>]> {
        let Self { instructions, q, stride, instants, schur, .. } = self;
        let instants = instants.as_deref_mut()?;
        instructions.dispatch(Look { instants, q: q.as_slice(), stride: *stride, order, tau });
        schur.factor.eliminate(&mut instants.pivots);
        Some(instants.pivots.pivot_products())
    }
}
