//! The matrix S = A D⁻¹ Aᵀ of the joints' rows, as H Hᵀ with H = A C⁻ᵀ and D = C Cᵀ.

use super::angles::Angles;
use super::rows::Rows;
use super::terms::{End, Gradient, Term, changing, ends, terms};
use crate::dynamics::blocks::{BlockProduct, SchurLayout};
use crate::dynamics::series::bodies::{Bodies, LanePlace};
use crate::dynamics::series::lanes::{plus, rows_of_lanes};
use crate::system::System;
use pulp::Simd;
use std::collections::BTreeMap;
use std::ops::Range;
use triad_linalg::BlockCholesky;
use triad_linalg::block_cholesky::stride;
use triad_linalg::fma;

/// A product H_p H_qᵀ that is added to a block of S.
#[derive(Clone, Copy, Debug)]
struct Contribution {
    offset: usize,
    left: usize,
    right: usize,
    rows: usize,
    columns: usize,
}

/// A product of what two features of a bundle do to each other, and the blocks of S that it is added to: joints that
/// are nothing but a common point need no rows of H.
#[derive(Clone, Debug)]
struct Pair {
    slots: [usize; 2],
    targets: Range<usize>,
}

/// Where the product of a pair goes in one lane.
#[derive(Clone, Copy, Debug)]
struct Target {
    lane: usize,
    sign: f64,
    offset: usize,
    /// σ/m, which is the same at every state; zero for a body about its pivot.
    constant: f64,
}

/// What two common points of a body in a lane add to S.
#[derive(Clone, Copy, Debug)]
pub struct CommonPointProduct {
    /// The points' features, and the lane of their body.
    pub slots: [usize; 2],
    pub lane: usize,
    pub sign: f64,
    /// Where the block begins.
    pub offset: usize,
}

/// S and its factor.
#[derive(Clone, Debug)]
pub struct Schur {
    /// Terms of common points.
    units: Vec<Term>,
    /// All other terms.
    terms: Vec<Term>,
    /// Ranges of H that these write at every state.
    changing: Vec<Range<usize>>,
    contributions: Vec<Contribution>,
    h: Vec<f64>,
    pairs: Vec<Pair>,
    targets: Vec<Target>,
    /// The part of S that never changes.
    base: Vec<f64>,
    /// Whether entries that never change are written once, and not at every state.
    pub keep_constants: bool,
    /// Entries that were not written again.
    pub constants_kept: u64,
    /// The factor.
    pub factor: BlockCholesky,
}

/// The products that S is the sum of, by the way in which they are computed.
struct SortedProducts {
    contributions: Vec<Contribution>,
    pairs: Vec<Pair>,
    targets: Vec<Target>,
}

impl SortedProducts {
    fn new(system: &System, products: Vec<BlockProduct>, ends: &[Option<End>], twist: usize) -> Self {
        let mut contributions = Vec::new();
        let mut targets_of_pairs: BTreeMap<[usize; 2], Vec<Target>> = BTreeMap::new();
        for BlockProduct { body, offset, left, right } in products {
            if let (Some(a), Some(b)) = (ends[left], ends[right]) {
                let sign = a.sign * b.sign;
                let constant = sign * system.bodies[body].free_inverse_mass();
                let target = Target { lane: a.place.lane, sign, offset, constant };
                targets_of_pairs.entry([a.place.slot, b.place.slot]).or_default().push(target);
                continue;
            }
            let (left, right) = (&system.incidences[left], &system.incidences[right]);
            contributions.push(Contribution {
                offset,
                left: left.offset / 6 * twist,
                right: right.offset / 6 * twist,
                rows: left.rows,
                columns: right.rows,
            });
        }
        // In the order of memory, so that the sums run through the store once.
        contributions.sort_by_key(|c| c.offset);
        let mut targets = Vec::new();
        let mut pairs = Vec::with_capacity(targets_of_pairs.len());
        for (slots, own) in targets_of_pairs {
            let first = targets.len();
            targets.extend(own);
            pairs.push(Pair { slots, targets: first..targets.len() });
        }
        Self { contributions, pairs, targets }
    }
}

impl Schur {
    /// Plans the computation of S for twists of `twist` components.
    pub fn new(system: &System, place: &[LanePlace], lanes: usize, twist: usize) -> Self {
        let SchurLayout { factor, products } = SchurLayout::new(system);
        let ends = ends(system, place);
        let SortedProducts { contributions, pairs, targets } =
            SortedProducts::new(system, products, &ends, twist);
        let h = vec![0.0; system.block_entries / 6 * twist];
        let (units, terms): (Vec<Term>, Vec<Term>) = terms(system, place, lanes, twist)
            .into_iter()
            .partition(|t| matches!(t.gradient, Gradient::Unit));
        // Joints that are only a common point need no rows in H unless they meet others.
        let mixed = |unit: &Term| {
            let body = system.incidences[unit.incidence].body;
            let own = &system.incidences_of_body[body];
            own.iter().any(|&i| system.incidences[i].rows > 0 && ends[i].is_none())
        };
        let units = units.into_iter().filter(mixed).collect();
        let changing = changing(&terms, twist);
        let mut schur = Self {
            units,
            terms,
            changing,
            contributions,
            h,
            pairs,
            targets,
            base: vec![0.0; factor.values().len()],
            keep_constants: true,
            constants_kept: 0,
            factor,
        };
        schur.write_constants(twist, if twist == 3 { 2 } else { 3 });
        schur
    }

    /// All products that S is the sum of, if they are those of common points.
    pub fn products_of_common_points(&self) -> Option<Vec<CommonPointProduct>> {
        let product = |slots: [usize; 2], &Target { lane, sign, offset, .. }: &Target| CommonPointProduct {
            slots,
            lane,
            sign,
            offset,
        };
        let of_pair = |pair: &Pair| {
            let slots = pair.slots;
            self.targets[pair.targets.clone()].iter().map(move |target| product(slots, target))
        };
        self.contributions.is_empty().then(|| self.pairs.iter().flat_map(of_pair).collect())
    }

    /// The part of S that never changes.
    pub fn base(&self) -> &[f64] {
        &self.base
    }

    /// Builds S from C⁻¹ s̃ of all features.
    #[inline(always)]
    pub fn assemble<S: Simd, const L: usize, B: Bodies<L>>(
        &mut self,
        simd: S,
        rows: &Rows<L>,
        angles: &Angles,
        mobility: &[B::Mobility],
    ) {
        self.set_terms::<L, B>(rows, angles, mobility);
        self.factor.values_mut().copy_from_slice(&self.base);
        self.add_pairs::<S, L, B>(simd, mobility);
        if B::TWIST == 3 {
            self.multiply::<3>();
        } else {
            self.multiply::<6>();
        }
    }

    /// H. Rows of common points have a part that never changes: it is written once.
    #[inline(always)]
    fn set_terms<const L: usize, B: Bodies<L>>(
        &mut self,
        rows: &Rows<L>,
        angles: &Angles,
        mobility: &[B::Mobility],
    ) {
        if self.keep_constants {
            self.constants_kept += ((self.units.len() + self.targets.len()) * B::DIRECTIONS) as u64;
        } else {
            self.write_constants(B::TWIST, B::DIRECTIONS);
        }
        for unit in &self.units {
            let block = &mut self.h[unit.at..unit.at + B::TWIST * B::DIRECTIONS];
            B::set_unit_rotations(&mobility[unit.place.slot], unit.place.lane, unit.sign, block);
        }
        for range in &self.changing {
            self.h[range.clone()].fill(0.0);
        }
        for term in &self.terms {
            let z = &mobility[term.place.slot];
            let mut block = self.h[term.at..].chunks_exact_mut(B::TWIST);
            let mut add = |g: &[f64; 3]| {
                if let Some(row) = block.next() {
                    B::add_translation(g, term.sign * term.translation, row);
                    B::add_rotation(z, term.place.lane, g, term.sign, row);
                }
            };
            match term.gradient {
                Gradient::Unit => {}
                Gradient::Across(k) => rows.commons[k].across.iter().for_each(add),
                Gradient::Factor { bundle, lane, side } => add(&rows.product_factors(bundle, lane)[1 - side]),
                Gradient::Relation { r, k } => add(&angles.gradient(r, k)),
            }
        }
    }

    /// What joints that are only common points add to S: σ (1/m + s̃ᵀ I⁻¹ s̃), whose first part stands there.
    #[inline(always)]
    fn add_pairs<S: Simd, const L: usize, B: Bodies<L>>(&mut self, simd: S, mobility: &[B::Mobility]) {
        let values = self.factor.values_mut();
        for pair in &self.pairs {
            let [a, b] = pair.slots.map(|slot| &mobility[slot]);
            // No closures: they would not be compiled for the vector instructions in use.
            let [first, second, third] = B::pair(a, b);
            let strips =
                [rows_of_lanes(simd, first), rows_of_lanes(simd, second), rows_of_lanes(simd, third)];
            for &Target { lane, sign, offset, .. } in &self.targets[pair.targets.clone()] {
                let block = &mut values[offset..offset + 4 * B::STRIPS];
                for (out, strip) in block.as_chunks_mut::<4>().0.iter_mut().zip(&strips) {
                    *out = plus(&[sign; 4], &strip[lane % L], out);
                }
            }
        }
    }

    /// The translations in rows of common points: ±1/√m along each direction, and what they make in S.
    fn write_constants(&mut self, twist: usize, directions: usize) {
        for unit in &self.units {
            for k in 0..directions {
                let row = &mut self.h[unit.at + k * twist..unit.at + (k + 1) * twist];
                row.fill(0.0);
                row[k] = unit.sign * unit.translation;
            }
        }
        self.base.fill(0.0);
        for target in &self.targets {
            for k in 0..directions {
                self.base[target.offset + k * (stride(directions) + 1)] += target.constant;
            }
        }
    }

    /// S = H Hᵀ.
    #[inline(always)]
    fn multiply<const W: usize>(&mut self) {
        let values = self.factor.values_mut();
        for c in &self.contributions {
            let (left, right) =
                (&self.h[c.left..c.left + W * c.rows], &self.h[c.right..c.right + W * c.columns]);
            let out = &mut values[c.offset..c.offset + c.rows * stride(c.columns)];
            match (c.rows, c.columns) {
                (2, 2) => add_product::<W, 2>(left, right, out),
                (3, 3) => add_product::<W, 3>(left, right, out),
                (5, 5) => add_product::<W, 5>(left, right, out),
                _ => {
                    for (a, out) in
                        left.as_chunks::<W>().0.iter().zip(out.chunks_exact_mut(stride(c.columns)))
                    {
                        for (b, out) in right.as_chunks::<W>().0.iter().zip(out) {
                            *out += dot(a, b);
                        }
                    }
                }
            }
        }
    }
}

#[inline(always)]
fn dot<const W: usize>(a: &[f64; W], b: &[f64; W]) -> f64 {
    let mut sum = a[0] * b[0];
    for k in 1..W {
        sum = fma(a[k], b[k], sum);
    }
    sum
}

#[inline(always)]
fn add_product<const W: usize, const N: usize>(left: &[f64], right: &[f64], out: &mut [f64]) {
    let (left, right) = (left.as_chunks::<W>().0, right.as_chunks::<W>().0);
    let (Some(left), Some(right)) = (left.first_chunk::<N>(), right.first_chunk::<N>()) else { return };
    for (a, out) in left.iter().zip(out.chunks_exact_mut(stride(N))) {
        for k in 0..N {
            out[k] += dot(a, &right[k]);
        }
    }
}
