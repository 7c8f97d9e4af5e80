//! The layout of S, which never changes: which products of incidences make up its blocks — eq. (7.6).

use crate::system::{Incidence, System};
use triad_linalg::block_cholesky::stride;
use triad_linalg::{BlockCholesky, block_cholesky};

/// A product A_p D_b⁻¹ A_qᵀ of two incidences of one body, which is added to a block of S.
#[derive(Clone, Copy, Debug)]
pub struct BlockProduct {
    /// The body.
    pub body: usize,
    /// Where the block begins.
    pub offset: usize,
    /// The incidence whose joint's rows are the rows of the block.
    pub left: usize,
    /// The one whose joint's rows are its columns.
    pub right: usize,
}

/// S with the products that it is the sum of, S_gh = Σ_b A_gb D_b⁻¹ A_hbᵀ, body by body.
#[derive(Clone, Debug)]
pub struct SchurLayout {
    /// S, and its factor.
    pub factor: BlockCholesky,
    /// The products.
    pub products: Vec<BlockProduct>,
}

impl SchurLayout {
    /// Of a system: the blocks are its joints, and two of them meet where a body has both.
    pub fn new(system: &System) -> Self {
        let sizes: Vec<usize> = system.constraints.iter().map(|c| c.solver.len()).collect();
        Self::of(system, &sizes)
    }

    /// The same with so many rows of each joint.
    pub fn of(system: &System, sizes: &[usize]) -> Self {
        let with_rows = with_rows(system, |incidence| sizes[incidence.constraint.index()]);
        let joint = |incidence: usize| system.incidences[incidence].constraint.index();
        let edges = pairs(&with_rows).map(|(_, p, q)| (joint(p), joint(q)));
        let factor = BlockCholesky::new(sizes, edges);
        let products = pairs(&with_rows).map(|(body, p, q)| {
            let slot = factor.slot(joint(p), joint(q));
            let (left, right) = if slot.transposed { (q, p) } else { (p, q) };
            BlockProduct { body, offset: slot.offset, left, right }
        });
        Self { products: products.collect(), factor }
    }
}

/// The incidences of each body whose joints have rows: one without (in the plane) shares no block.
fn with_rows(system: &System, rows: impl Fn(&Incidence) -> usize) -> Vec<Vec<usize>> {
    let rows =
        |list: &Vec<usize>| list.iter().copied().filter(|&i| rows(&system.incidences[i]) > 0).collect();
    system.incidences_of_body.iter().map(rows).collect()
}

/// Pairs of incidences of a body, with the body.
fn pairs(with_rows: &[Vec<usize>]) -> impl Iterator<Item = (usize, usize, usize)> {
    with_rows.iter().enumerate().flat_map(|(body, incidences)| {
        let all = incidences.iter().enumerate();
        all.flat_map(move |(k, &p)| incidences[k..].iter().map(move |&q| (body, p, q)))
    })
}

/// Whether a factorization of S takes at most `most` products of blocks: with joints all over, or very many on one body, it takes
/// more than any machine has.
pub fn products_within(system: &System, most: usize) -> bool {
    let joint = |incidence: usize| system.incidences[incidence].constraint.index();
    let edges = with_rows(system, |incidence| incidence.rows);
    let edges = pairs(&edges).map(|(_, p, q)| (joint(p), joint(q)));
    block_cholesky::products_within(system.constraints.len(), edges, most)
}

/// Adds A Bᵀ to a block of S; rows of A and B have C numbers.
pub fn add_block<const C: usize>(a: &[[f64; C]], b: &[[f64; C]], out: &mut [f64]) {
    for (a, out) in a.iter().zip(out.chunks_exact_mut(stride(b.len()))) {
        for (b, out) in b.iter().zip(out) {
            *out += dot(a, b);
        }
    }
}

/// The same for N rows of both, whose block has rows of W numbers.
#[inline(always)]
pub fn add_square<const N: usize, const W: usize, const C: usize>(
    a: &[[f64; C]],
    b: &[[f64; C]],
    out: &mut [f64],
) {
    let out = out.as_chunks_mut::<W>().0.first_chunk_mut::<N>();
    let (Some(a), Some(b), Some(out)) = (a.first_chunk::<N>(), b.first_chunk::<N>(), out) else { return };
    for (a, out) in a.iter().zip(out) {
        for k in 0..N {
            out[k] += dot(a, &b[k]);
        }
    }
}

#[inline(always)]
fn dot<const C: usize>(a: &[f64; C], b: &[f64; C]) -> f64 {
    (1..C).fold(a[0] * b[0], |sum, c| sum + a[c] * b[c])
}
