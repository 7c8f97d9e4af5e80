//! Factorization and solution of the matrices S of mechanisms, by the engine's block factorization and by faer:
//! `cargo run --release` in this folder.
//!
//! The pattern is analysed once for all; timed are a numeric factorization and the solution for one right-hand side, each the
//! least of many repeats taken in turns. Rows that repeat others make S singular: then S + 1e-9 diag(S) is factored.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::linalg::lu::{LuSymbolicParams, NumericLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Conj, MatMut, Par, Side};
use std::time::Instant;
use triad_engine::reactions::matrices::{self, EntryKind};
use triad_engine::constraints::mechanism::Mechanism;
use triad_engine::model::Model;
use triad_linalg::BlockCholesky;
use triad_linalg::block_cholesky::stride;
use triad_engine::system::System;
use triad_engine::catalogue;
use triad_engine::constraints::rank;

/// Scenes whose matrices are factored.
const SCENES: [&str; 6] = [
    "spatial-chain:10",
    "spatial-chain:100",
    "spatial-chain:2000",
    "n-four-bar:2",
    "n-four-bar:40",
    "bricard",
];
/// Repetitions of which the least time is told.
const ROUNDS: usize = 60;

/// A way to factor and to solve, with the error of its solution.
struct Contender<'a> {
    name: &'static str,
    factor: Box<dyn FnMut() + 'a>,
    /// Replaces the right-hand side by the solution.
    solve: Box<dyn FnMut(&mut [f64]) + 'a>,
}

fn main() {
    println!("| matrix | rows | numbers | by | factor, µs | solve, µs | residual |");
    println!("|---|---|---|---|---|---|---|");
    for name in SCENES {
        compare(name);
    }
}

/// S of a built-in scene at its start, its lower triangle, and the rows of each joint.
fn matrix(name: &str) -> (Vec<(usize, usize, f64)>, Vec<usize>) {
    let scene = catalogue::scene(name).expect("a built-in scene");
    let mut mechanism = Mechanism::new(System::new(Model::new(&scene).expect("a good scene")));
    let n = mechanism.system.coordinates;
    let mut y = vec![0.0; 2 * n];
    let (q, q_dot) = y.split_at_mut(n);
    mechanism.system.start(q, q_dot);
    mechanism.assemble(&mut y).expect("a scene that can be assembled");
    let redundant =
        !rank::analyze(&mechanism.system, &mut mechanism.state, &y[..n]).dependent.is_empty();
    mechanism.set_state(0.0, &y);
    let mut entries = Vec::new();
    for place in matrices::schur(&mechanism.system, &mechanism.state, &mut mechanism.elimination).places {
        if place.part != EntryKind::Fill {
            let shift = if redundant && place.row == place.column { 1.0 + 1e-9 } else { 1.0 };
            entries.push((place.row, place.column, place.value * shift));
        }
    }
    (entries, mechanism.system.constraints.iter().map(|constraint| constraint.solver.len()).collect())
}

fn compare(name: &str) {
    let (entries, sizes) = matrix(name);
    let n: usize = sizes.iter().sum();
    let triplets = |both: bool| -> SparseColMat<usize, f64> {
        let lower = entries.iter().map(|&(row, col, val)| Triplet { row, col, val });
        let upper = entries.iter().filter(|e| both && e.0 != e.1).map(|&(row, col, val)| Triplet {
            row: col,
            col: row,
            val,
        });
        SparseColMat::try_new_from_triplets(n, n, &lower.chain(upper).collect::<Vec<_>>())
            .expect("places within the matrix")
    };
    let (half, full) = (triplets(false), triplets(true));
    let mut contenders = vec![blocks(&entries, &sizes)];
    for (label, threshold) in [
        ("faer, Cholesky by entries", SupernodalThreshold::FORCE_SIMPLICIAL),
        ("faer, Cholesky by supernodes", SupernodalThreshold::FORCE_SUPERNODAL),
    ] {
        contenders.push(cholesky(label, &half, threshold));
    }
    contenders.push(lu(&full));
    let b: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
    let mut least = vec![[f64::INFINITY; 2]; contenders.len()];
    let mut residual = vec![0.0f64; contenders.len()];
    for _ in 0..ROUNDS {
        for (k, contender) in contenders.iter_mut().enumerate() {
            let began = Instant::now();
            (contender.factor)();
            least[k][0] = least[k][0].min(began.elapsed().as_secs_f64());
            let mut x = b.clone();
            let began = Instant::now();
            (contender.solve)(&mut x);
            least[k][1] = least[k][1].min(began.elapsed().as_secs_f64());
            let mut left = b.clone();
            for &(row, col, value) in &entries {
                left[row] -= value * x[col];
                if row != col {
                    left[col] -= value * x[row];
                }
            }
            let size = x.iter().fold(1.0f64, |a, x| a.max(x.abs()));
            residual[k] = left.iter().fold(0.0f64, |a, x| a.max(x.abs())) / size;
        }
    }
    for ((contender, [factor, solve]), residual) in contenders.iter().zip(&least).zip(&residual) {
        let (name_of, numbers) = (contender.name, entries.len());
        println!(
            "| {name} | {n} | {numbers} | {name_of} | {:.2} | {:.2} | {residual:.0e} |",
            factor * 1e6,
            solve * 1e6
        );
    }
}

fn blocks<'a>(entries: &[(usize, usize, f64)], sizes: &[usize]) -> Contender<'a> {
    let mut joint = Vec::new();
    let mut start = vec![0];
    for (index, &size) in sizes.iter().enumerate() {
        joint.extend(std::iter::repeat_n(index, size));
        start.push(start[index] + size);
    }
    let edges = entries.iter().map(|&(i, j, _)| (joint[i], joint[j]));
    let mut matrix = BlockCholesky::new(sizes, edges);
    matrix.clear();
    for &(i, j, value) in entries {
        let mut put = |i: usize, j: usize| {
            let (a, b) = (joint[i], joint[j]);
            let slot = matrix.slot(a, b);
            let (row, column, width) = if slot.transposed {
                (j - start[b], i - start[a], sizes[a])
            } else {
                (i - start[a], j - start[b], sizes[b])
            };
            matrix.values_mut()[slot.offset + row * stride(width) + column] = value;
        };
        put(i, j);
        if joint[i] == joint[j] {
            put(j, i);
        }
    }
    // The factorization uses its matrix up: a copy of it belongs to the time.
    let values = matrix.values().to_vec();
    let matrix = std::rc::Rc::new(std::cell::RefCell::new(matrix));
    let solver = matrix.clone();
    Contender {
        name: "Triad",
        factor: Box::new(move || {
            let mut matrix = matrix.borrow_mut();
            matrix.values_mut().copy_from_slice(&values);
            matrix.factor(0.0, 0.0);
        }),
        solve: Box::new(move |x| solver.borrow_mut().solve(x)),
    }
}

fn cholesky<'a>(
    name: &'static str,
    matrix: &'a SparseColMat<usize, f64>,
    threshold: SupernodalThreshold,
) -> Contender<'a> {
    let params = CholeskySymbolicParams { supernodal_flop_ratio_threshold: threshold, ..Default::default() };
    let symbolic =
        factorize_symbolic_cholesky(matrix.symbolic(), Side::Lower, SymmetricOrdering::Amd, params)
            .expect("a symmetric pattern");
    let symbolic: &'a _ = Box::leak(Box::new(symbolic));
    let values = std::rc::Rc::new(std::cell::RefCell::new(vec![0.0; symbolic.len_val()]));
    let mut memory =
        MemBuffer::new(symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()));
    let mut memory_of_solve = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
    let solver = values.clone();
    Contender {
        name,
        factor: Box::new(move || {
            symbolic
                .factorize_numeric_llt(
                    &mut values.borrow_mut(),
                    matrix.as_ref(),
                    Side::Lower,
                    LltRegularization::default(),
                    Par::Seq,
                    MemStack::new(&mut memory),
                    Default::default(),
                )
                .expect("a positive definite matrix");
        }),
        solve: Box::new(move |x| {
            let values = solver.borrow();
            let factor = faer::sparse::linalg::cholesky::LltRef::new(symbolic, &values);
            let n = x.len();
            let x = MatMut::from_column_major_slice_mut(x, n, 1);
            factor.solve_in_place_with_conj(Conj::No, x, Par::Seq, MemStack::new(&mut memory_of_solve));
        }),
    }
}

fn lu(matrix: &SparseColMat<usize, f64>) -> Contender<'_> {
    let symbolic =
        factorize_symbolic_lu(matrix.symbolic(), LuSymbolicParams::default()).expect("a square pattern");
    let symbolic: &'static _ = Box::leak(Box::new(symbolic));
    let numeric = std::rc::Rc::new(std::cell::RefCell::new(NumericLu::new()));
    let mut memory =
        MemBuffer::new(symbolic.factorize_numeric_lu_scratch::<f64>(Par::Seq, Default::default()));
    let mut memory_of_solve = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
    let solver = numeric.clone();
    Contender {
        name: "faer, LU",
        factor: Box::new(move || {
            symbolic
                .factorize_numeric_lu(
                    &mut numeric.borrow_mut(),
                    matrix.as_ref(),
                    Par::Seq,
                    MemStack::new(&mut memory),
                    Default::default(),
                )
                .expect("a regular matrix");
        }),
        solve: Box::new(move |x| {
            let numeric = solver.borrow();
            let n = x.len();
            let x = MatMut::from_column_major_slice_mut(x, n, 1);
            let factor = faer::sparse::linalg::lu::LuRef::new_unchecked(symbolic, &numeric);
            factor.solve_in_place_with_conj(Conj::No, x, Par::Seq, MemStack::new(&mut memory_of_solve));
        }),
    }
}
