//! The matrix S = A D⁻¹ Aᵀ of the joints' rows, as H Hᵀ with H = A C⁻ᵀ and D = C Cᵀ.

use super::angles::Angles;
use super::lanes::Triple;
use super::rows::{Place, Rows};
use crate::row::Form;
use crate::sparse::{BlockCholesky, Pivots, Slot};
use crate::system::{NO_INCIDENCE, System};

/// Which gradient a term of H has.
#[derive(Clone, Copy, Debug)]
enum Gradient {
    /// The three unit vectors, in three rows.
    Unit,
    /// The two directions across common vector k, in two rows.
    Across(usize),
    /// The other factor of lane `lane` of product bundle `bundle`: 0 for x, 1 for y.
    Factor { bundle: usize, lane: usize, side: usize },
    /// Gradient k of relation r.
    Relation { r: usize, k: usize },
}

/// A feature's part of a row form in the block of its body.
#[derive(Clone, Copy, Debug)]
struct Term {
    at: usize,
    place: Place,
    gradient: Gradient,
    sign: f64,
    /// 1/√m for points, 0 for vectors.
    translation: f64,
}

/// A product H_p H_qᵀ that is added to a block of S.
#[derive(Clone, Copy, Debug)]
struct Contribution {
    slot: Slot,
    left: usize,
    right: usize,
    rows: usize,
    columns: usize,
}

/// S and its factor.
#[derive(Clone, Debug)]
pub struct Schur {
    terms: Vec<Term>,
    contributions: Vec<Contribution>,
    h: Vec<f64>,
    /// The factor.
    pub factor: BlockCholesky,
}

impl Schur {
    /// Writes the program of S.
    pub fn new(system: &System, place: &[Place], lanes: usize) -> Self {
        let sizes: Vec<usize> = system.groups.iter().map(|g| g.solver.len()).collect();
        let edges = system.touching.iter().flat_map(|incidences| {
            incidences.iter().enumerate().flat_map(move |(k, &p)| {
                let group = |i: usize| system.incidences[i].group;
                incidences[k + 1..].iter().map(move |&q| (group(p), group(q)))
            })
        });
        let factor = BlockCholesky::new(&sizes, edges);
        let mut contributions = Vec::new();
        for incidences in &system.touching {
            for (k, &p) in incidences.iter().enumerate() {
                for &q in &incidences[k..] {
                    let slot = factor.slot(system.incidences[p].group, system.incidences[q].group);
                    let (left, right) = if slot.transposed { (q, p) } else { (p, q) };
                    let (left, right) = (&system.incidences[left], &system.incidences[right]);
                    contributions.push(Contribution {
                        slot,
                        left: left.offset,
                        right: right.offset,
                        rows: left.rows,
                        columns: right.rows,
                    });
                }
            }
        }
        // In the order of memory, so that the sums run through the store once.
        contributions.sort_by_key(|c| c.slot.offset);
        Self { terms: terms(system, place, lanes), contributions, h: vec![0.0; system.block_numbers], factor }
    }

    /// Builds S from C⁻¹ s̃ of all features and factors it.
    pub fn build<const L: usize>(
        &mut self,
        rows: &Rows<L>,
        angles: &Angles,
        mobility: &[[Triple<L>; 3]],
        epsilon: f64,
    ) -> Pivots {
        self.h.fill(0.0);
        for term in &self.terms {
            let z = &mobility[term.place.slot];
            let lane = term.place.lane % L;
            let z = [0, 1, 2].map(|r| [z[r][0][lane], z[r][1][lane], z[r][2][lane]]);
            let block = self.h[term.at..].as_chunks_mut::<6>().0;
            match term.gradient {
                Gradient::Unit => {
                    for (k, row) in block.iter_mut().take(3).enumerate() {
                        row[k] += term.sign * term.translation;
                        for c in 0..3 {
                            row[3 + c] += term.sign * z[c][k];
                        }
                    }
                }
                Gradient::Across(k) => {
                    let across = rows.commons[k].across;
                    for (row, g) in block.iter_mut().zip(&across) {
                        add_gradient(row, g, &z, term);
                    }
                }
                Gradient::Factor { bundle, lane, side } => {
                    let g = rows.product_factors(bundle, lane)[1 - side];
                    if let Some(row) = block.first_mut() {
                        add_gradient(row, &g, &z, term);
                    }
                }
                Gradient::Relation { r, k } => {
                    if let Some(row) = block.first_mut() {
                        add_gradient(row, &angles.gradient(r, k), &z, term);
                    }
                }
            }
        }
        self.factor.clear();
        let values = self.factor.values_mut();
        for c in &self.contributions {
            let (left, right) =
                (&self.h[c.left..c.left + 6 * c.rows], &self.h[c.right..c.right + 6 * c.columns]);
            let out = &mut values[c.slot.offset..c.slot.offset + c.rows * c.columns];
            match (c.rows, c.columns) {
                (3, 3) => add_product::<3>(left, right, out),
                (5, 5) => add_product::<5>(left, right, out),
                _ => {
                    for (a, out) in left.as_chunks::<6>().0.iter().zip(out.chunks_exact_mut(c.columns)) {
                        for (b, out) in right.as_chunks::<6>().0.iter().zip(out) {
                            *out += dot(a, b);
                        }
                    }
                }
            }
        }
        self.factor.factor(epsilon, 0.0, |_, _| {})
    }
}

#[inline(always)]
fn add_gradient(row: &mut [f64; 6], g: &[f64; 3], z: &[[f64; 3]; 3], term: &Term) {
    for c in 0..3 {
        row[c] += term.sign * term.translation * g[c];
        row[3 + c] += term.sign * (z[c][0] * g[0] + z[c][1] * g[1] + z[c][2] * g[2]);
    }
}

#[inline(always)]
fn dot(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] + a[4] * b[4] + a[5] * b[5]
}

#[inline(always)]
fn add_product<const N: usize>(left: &[f64], right: &[f64], out: &mut [f64]) {
    let (left, right) = (left.as_chunks::<6>().0, right.as_chunks::<6>().0);
    let (Some(left), Some(right), Some(out)) = (
        left.first_chunk::<N>(),
        right.first_chunk::<N>(),
        out.as_chunks_mut::<N>().0.first_chunk_mut::<N>(),
    ) else {
        return;
    };
    for i in 0..N {
        for k in 0..N {
            out[i][k] += dot(&left[i], &right[k]);
        }
    }
}

/// The terms of H, row form by row form.
fn terms(system: &System, place: &[Place], lanes: usize) -> Vec<Term> {
    let mut terms = Vec::new();
    let (mut commons, mut products, mut relations) = (0, 0, 0);
    for row in &system.rows {
        let mut add = |order: usize, feature: usize, gradient: Gradient, sign: f64| {
            let incidence = row.incidence[order];
            if incidence == NO_INCIDENCE {
                return;
            }
            let incidence = &system.incidences[incidence];
            let point = system.features[feature].point;
            let mass = system.bodies[incidence.body].mass;
            terms.push(Term {
                at: incidence.offset + 6 * row.local,
                place: place[feature],
                gradient,
                sign,
                translation: if point { 1.0 / mass.sqrt() } else { 0.0 },
            });
        };
        match row.form {
            Form::Coincidence { a, b } => {
                add(0, a, Gradient::Unit, 1.0);
                add(1, b, Gradient::Unit, -1.0);
            }
            Form::CommonVector { a, b } => {
                add(0, a, Gradient::Across(commons), 1.0);
                add(1, b, Gradient::Across(commons), -1.0);
                commons += 1;
            }
            Form::Product { a, b, .. } => {
                let mut order = 0;
                for (side, difference) in [a, b].into_iter().enumerate() {
                    let gradient =
                        Gradient::Factor { bundle: products / lanes, lane: products % lanes, side };
                    add(order, difference.plus, gradient, 1.0);
                    order += 1;
                    if let Some(minus) = difference.minus {
                        add(order, minus, gradient, -1.0);
                        order += 1;
                    }
                }
                products += 1;
            }
            Form::Relation { .. } => {
                for (k, feature) in row.form.features(&system.angles).into_iter().enumerate() {
                    add(k, feature, Gradient::Relation { r: relations, k }, 1.0);
                }
                relations += 1;
            }
        }
    }
    terms
}
