//! The layout of S, which never changes: which products of incidences make up its blocks — eq. (7.6).

use crate::system::System;
use triad_linalg::BlockCholesky;

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
        // A joint without rows (in the plane) shares no block.
        let with_rows: Vec<Vec<usize>> = system
            .incidences_of_body
            .iter()
            .map(|list| list.iter().copied().filter(|&i| system.incidences[i].rows > 0).collect())
            .collect();
        let pairs = || {
            with_rows.iter().enumerate().flat_map(|(body, incidences)| {
                incidences
                    .iter()
                    .enumerate()
                    .flat_map(move |(k, &p)| incidences[k..].iter().map(move |&q| (body, p, q)))
            })
        };
        let joint = |incidence: usize| system.incidences[incidence].constraint.index();
        let factor = BlockCholesky::new(&sizes, pairs().map(|(_, p, q)| (joint(p), joint(q))));
        let products = pairs().map(|(body, p, q)| {
            let slot = factor.slot(joint(p), joint(q));
            let (left, right) = if slot.transposed { (q, p) } else { (p, q) };
            BlockProduct { body, offset: slot.offset, left, right }
        });
        Self { products: products.collect(), factor }
    }
}
