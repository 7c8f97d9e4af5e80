//! Equations of three of the six components of each body's twist, and of the rows that belong to them: S of a motion in a plane falls
//! into one part in the plane and one across it.

use crate::dynamics::blocks::{BlockProduct, SchurLayout, add_block, add_square};
use crate::system::System;
use crate::system::row::Form;
use triad_linalg::{BlockCholesky, larger, largest_size};

/// The rows of a joint on a body, among those of all blocks.
#[derive(Clone, Debug)]
struct Block {
    first: usize,
    rows: usize,
}

/// A row of a block.
#[derive(Clone, Copy, Debug)]
struct BlockRow {
    body: usize,
    /// Where it stands in right-hand sides.
    place: usize,
    /// Where it begins in A.
    source: usize,
}

/// What a part knows of a body.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PartBody {
    /// The inverse of its inertia: on the diagonal, and what the second and the third component share.
    pub inverse: [f64; 4],
    /// Three components of (v̇, ω̇).
    pub twist: [f64; 3],
}

impl PartBody {
    /// The inverse inertia times a wrench.
    #[inline(always)]
    fn accelerated(&self, wrench: [f64; 3]) -> [f64; 3] {
        let [a, b, c, shared] = self.inverse;
        let [x, y, z] = wrench;
        [a * x, b * y + shared * z, shared * y + c * z]
    }

    /// ξ ← D⁻¹ (F, T).
    pub fn push(&mut self, wrench: [f64; 3]) {
        self.twist = self.accelerated(wrench);
    }
}

/// The equations.
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// Which components they are.
    columns: [usize; 3],
    factor: BlockCholesky,
    products: Vec<BlockProduct>,
    /// For each incidence.
    blocks: Vec<Block>,
    /// The solver rows, each with its place in right-hand sides.
    rows: Vec<(usize, usize)>,
    /// The rows of the blocks.
    block_rows: Vec<BlockRow>,
    /// Those of them whose form alone does not tell which components they have.
    unsure: Vec<usize>,
    /// Whether the rows of A that were taken have nothing of the other components.
    alone: bool,
    /// The rows of A, and A D⁻¹.
    a: Vec<[f64; 3]>,
    b: Vec<[f64; 3]>,
    pub bodies: Vec<PartBody>,
    lambda: Vec<f64>,
    residual: Vec<f64>,
    /// ε of the factor at hand.
    epsilon: f64,
}

impl Part {
    /// The equations of these solver rows and components.
    pub fn new(system: &System, columns: [usize; 3], takes: impl Fn(usize) -> bool) -> Self {
        let sizes: Vec<usize> =
            system.constraints.iter().map(|c| c.solver.clone().filter(|&row| takes(row)).count()).collect();
        let SchurLayout { factor, products } = SchurLayout::of(system, &sizes);
        let (mut rows, mut first) = (Vec::new(), Vec::with_capacity(sizes.len()));
        for constraint in &system.constraints {
            first.push(rows.len());
            for row in constraint.solver.clone().filter(|&row| takes(row)) {
                rows.push((row, factor.places()[rows.len()]));
            }
        }
        let mut of_points = vec![false; system.solver_rows];
        for row in &system.rows {
            if matches!(row.form, Form::Coincidence { .. }) {
                of_points[row.solver..row.solver + 3].fill(true);
            }
        }
        let (mut blocks, mut block_rows) = (Vec::with_capacity(system.incidences.len()), Vec::new());
        let mut unsure = Vec::new();
        for incidence in &system.incidences {
            let constraint = incidence.constraint.index();
            let mut places = rows[first[constraint]..].iter().map(|&(_, place)| place);
            blocks.push(Block { first: block_rows.len(), rows: sizes[constraint] });
            for (local, row) in system.constraints[constraint].solver.clone().enumerate() {
                let source = incidence.offset + 6 * local;
                if takes(row)
                    && let Some(place) = places.next()
                {
                    block_rows.push(BlockRow { body: incidence.body, place, source });
                    if !of_points[row] {
                        unsure.push(source);
                    }
                }
            }
        }
        Self {
            columns,
            products,
            blocks,
            rows,
            a: vec![[0.0; 3]; block_rows.len()],
            b: vec![[0.0; 3]; block_rows.len()],
            block_rows,
            unsure,
            alone: false,
            bodies: vec![PartBody::default(); system.bodies.len()],
            lambda: vec![0.0; factor.numbers()],
            residual: vec![0.0; factor.numbers()],
            epsilon: 0.0,
            factor,
        }
    }

    /// Its solver rows.
    pub fn solver_rows(&self) -> impl Iterator<Item = usize> {
        self.rows.iter().map(|&(row, _)| row)
    }

    /// Whether its rows have nothing of three other components in A, the displacements and the turn in a plane: rows of points across
    /// it never do.
    pub fn has_nothing_of(&self, columns: [usize; 3], a: &[f64]) -> bool {
        let [i, j, k] = columns;
        self.unsure.iter().all(|&at| a[at + i] == 0.0 && a[at + j] == 0.0 && a[at + k] == 0.0)
    }

    /// Takes its rows of A, and looks whether they have anything of three other components.
    pub fn take(&mut self, others: [usize; 3], a: &[f64]) {
        let ([i, j, k], [x, y, z]) = (self.columns, others);
        self.alone = true;
        for (own, row) in self.a.iter_mut().zip(&self.block_rows) {
            let Some(a) = a[row.source..].first_chunk::<6>() else { return };
            *own = [a[i], a[j], a[k]];
            self.alone &= a[x] == 0.0 && a[y] == 0.0 && a[z] == 0.0;
        }
    }

    /// Takes off from `wrenches` what the multipliers of its rows exert along three other components.
    pub fn exert(&self, others: [usize; 3], a: &[f64], wrenches: &mut [[f64; 3]]) {
        if self.alone {
            return;
        }
        for row in &self.block_rows {
            let Some(a) = a[row.source..].first_chunk::<6>() else { return };
            let lambda = self.lambda[row.place];
            for (wrench, column) in wrenches[row.body].iter_mut().zip(others) {
                *wrench -= a[column] * lambda;
            }
        }
    }

    /// A D⁻¹ of the rows and inertias that were taken.
    pub fn scale(&mut self) {
        for ((a, b), row) in self.a.iter().zip(&mut self.b).zip(&self.block_rows) {
            *b = self.bodies[row.body].accelerated(*a);
        }
    }

    /// Factors its block of S, regularized by ε, and returns the smallest relative pivot.
    pub fn factor(&mut self, epsilon: f64) -> f64 {
        self.factor.clear();
        let values = self.factor.values_mut();
        for product in &self.products {
            let [left, right] = [product.left, product.right].map(|incidence| &self.blocks[incidence]);
            let a = &self.a[left.first..left.first + left.rows];
            let b = &self.b[right.first..right.first + right.rows];
            let out = &mut values[product.offset..];
            match (left.rows, right.rows) {
                // Hinges in a plane.
                (2, 2) => add_square::<2, 2, 3>(a, b, out),
                (3, 3) => add_square::<3, 4, 3>(a, b, out),
                _ => add_block(a, b, out),
            }
        }
        self.epsilon = epsilon;
        self.factor.factor(epsilon, 0.0)
    }

    /// λ ← 0.
    pub fn clear(&mut self) {
        self.lambda.fill(0.0);
    }

    /// λ ← λ + S⁻¹ (A ξ − γ'), and ξ with it, by the factor of this part or of one of the same rows.
    pub fn correct(&mut self, gamma: impl Fn(usize) -> f64, other: Option<&Self>) {
        for &(row, place) in &self.rows {
            self.residual[place] = -gamma(row);
        }
        for (a, row) in self.a.iter().zip(&self.block_rows) {
            let [u, v, w] = self.bodies[row.body].twist;
            self.residual[row.place] += a[0] * u + a[1] * v + a[2] * w;
        }
        let factor = other.map_or(&self.factor, |other| &other.factor);
        factor.solve_in_place(&mut self.residual);
        if self.epsilon > 0.0 {
            self.factor.clean_placed(self.epsilon, &mut self.residual);
        }
        self.apply();
    }

    /// λ ← λ + those of a part of the same rows, and ξ with it.
    pub fn add(&mut self, other: &Self) {
        self.residual.copy_from_slice(&other.lambda);
        self.apply();
    }

    /// λ ← λ + x, ξ ← ξ − D⁻¹ Aᵀ x, x being the residual as multipliers.
    fn apply(&mut self) {
        for (lambda, change) in self.lambda.iter_mut().zip(&self.residual) {
            *lambda += change;
        }
        for (b, row) in self.b.iter().zip(&self.block_rows) {
            let (twist, lambda) = (&mut self.bodies[row.body].twist, self.residual[row.place]);
            for c in 0..3 {
                twist[c] -= b[c] * lambda;
            }
        }
    }

    /// The largest of the last changes of the multipliers, and of the multipliers.
    pub fn change(&self) -> [f64; 2] {
        [&self.residual, &self.lambda].map(|x| largest_size(x))
    }

    /// The largest component of a twist.
    pub fn largest_twist(&self) -> f64 {
        self.bodies.iter().map(|body| largest_size(&body.twist)).fold(0.0, larger)
    }

    /// Hands over its multipliers.
    pub fn hand_over(&self, lambda: &mut [f64]) {
        for &(row, place) in &self.rows {
            lambda[row] = self.lambda[place];
        }
    }
}
