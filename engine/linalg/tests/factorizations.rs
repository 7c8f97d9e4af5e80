//! Factorizations and null spaces beside dense ones of nalgebra.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use triad_linalg::block_cholesky::{BlockCholesky, BlockSlot, stride};
use triad_linalg::random::Random;
use triad_linalg::{Columns, SparseLu, independent_rows, left_null_space};

proptest! {
    #[test]
    fn solves_what_a_dense_factorization_solves(
        sizes in prop::collection::vec(prop_oneof![4 => 1usize..6, 1 => 8usize..14], 1..12),
        links in prop::collection::vec((0usize..12, 0usize..12), 0..20),
        seed in any::<u64>(),
    ) {
        let count = sizes.len();
        let edges: Vec<(usize, usize)> =
            links.into_iter().map(|(i, j)| (i % count, j % count)).filter(|(i, j)| i != j).collect();
        let start: Vec<usize> = (0..count).map(|i| sizes[..i].iter().sum()).collect();
        let n: usize = sizes.iter().sum();
        let mut random = Random::new(seed);
        let mut dense = DMatrix::<f64>::identity(n, n) * 200.0;
        let mut factor = BlockCholesky::new(&sizes, edges.iter().copied());
        factor.clear();
        let mut add = |i: usize, j: usize, factor: &mut BlockCholesky| {
            let slot = factor.slot(i, j);
            for a in 0..sizes[i] {
                for b in 0..sizes[j] {
                    let x = if i == j { 0.0 } else { random.between(-1.0, 1.0) };
                    dense[(start[i] + a, start[j] + b)] += x;
                    if i != j { dense[(start[j] + b, start[i] + a)] += x; }
                    let (row, column, width) =
                        if slot.transposed { (b, a, sizes[i]) } else { (a, b, sizes[j]) };
                    let diagonal = if i == j && a == b { 200.0 } else { 0.0 };
                    factor.values_mut()[slot.offset + row * stride(width) + column] += x + diagonal;
                }
            }
        };
        for i in 0..count { add(i, i, &mut factor); }
        for &(i, j) in &edges { add(i, j, &mut factor); }
        let b = DVector::from_fn(n, |i, _| libm::sin(i as f64));
        let mut x = b.clone();
        factor.factor(0.0, 0.0);
        factor.solve(x.as_mut_slice());
        prop_assert!((dense * x - b).amax() < 1e-12);
    }

    #[test]
    fn pivots_of_several_matrices_at_once_are_those_of_each(
        sizes in prop::collection::vec(prop_oneof![4 => 1usize..6, 1 => 8usize..10], 1..12),
        chain in any::<bool>(),
        links in prop::collection::vec((0usize..12, 0usize..12), 0..20),
        seed in any::<u64>(),
    ) {
        let count = sizes.len();
        let sizes = if chain { vec![sizes[0].min(3); count] } else { sizes };
        let row = (1..count).map(|i| (i - 1, i));
        let edges: Vec<(usize, usize)> =
            if chain { row.collect() } else { links.into_iter().map(|(i, j)| (i % count, j % count)).collect() };
        let mut random = Random::new(seed);
        let mut factor = BlockCholesky::new(&sizes, edges.iter().copied());
        factor.keep_pivot_products();
        let mut lanes = factor.pivot_lanes::<3>().unwrap();
        let mut expected = Vec::new();
        for lane in 0..3 {
            factor.values_mut().iter_mut().for_each(|x| *x = random.between(-1.0, 1.0));
            for (&size, block) in sizes.iter().zip(0..) {
                let slot = factor.slot(block, block);
                for i in 0..size {
                    for k in 0..=i {
                        let x = if i == k { 9.0 } else { random.between(-1.0, 1.0) };
                        for (row, column) in [(i, k), (k, i)] {
                            factor.values_mut()[slot.offset + row * stride(size) + column] = x;
                        }
                    }
                }
            }
            for (lanes, x) in lanes.values.iter_mut().zip(factor.values()) {
                lanes[lane] = *x;
            }
            factor.factor(0.0, 0.0);
            expected.push(factor.pivot_products().to_vec());
        }
        factor.eliminate(&mut lanes);
        for (lane, expected) in expected.iter().enumerate() {
            for (found, expected) in lanes.pivot_products().iter().zip(expected) {
                prop_assert!((found[lane] - expected).abs() < 1e-9, "{found:?} {lane} {expected}");
            }
        }
    }
}

/// S = A Aᵀ with a row of A that repeats two others: consistent equations are solved without one of the three, whichever.
#[test]
fn dependent_rows_are_found_and_left_out() {
    let sizes = [3, 2];
    let mut random = Random::new(7);
    let mut a = DMatrix::<f64>::from_fn(5, 6, |_, _| random.between(-1.0, 1.0));
    let sum = a.row(0) * 2.0 + a.row(2);
    a.row_mut(4).copy_from(&sum);
    let s = &a * a.transpose();
    let mut factor = BlockCholesky::new(&sizes, std::iter::once((0, 1)));
    let fill = |factor: &mut BlockCholesky| {
        factor.clear();
        for (i, j) in [(0, 0), (0, 1), (1, 1)] {
            let BlockSlot { offset, transposed } = factor.slot(i, j);
            let block = s.view((3 * i, 3 * j), (sizes[i], sizes[j]));
            let block = if transposed { block.transpose() } else { block.clone_owned() };
            for (row, numbers) in block.row_iter().enumerate() {
                for (column, number) in numbers.iter().enumerate() {
                    factor.values_mut()[offset + row * stride(block.ncols()) + column] = *number;
                }
            }
        }
    };
    fill(&mut factor);
    let dependent = factor.dependent_rows(1e-10);
    assert!(matches!(dependent[..], [0 | 2 | 4]), "{dependent:?}");
    let b = &s * DVector::from_fn(5, |i, _| 1.0 + libm::sin(i as f64));
    for weakest in [false, true] {
        let mut factor = factor.clone();
        if weakest {
            factor.leave_out_weakest(dependent.iter().copied());
        } else {
            factor.leave_out(dependent.iter().copied());
        }
        fill(&mut factor);
        assert!(factor.factor(0.0, 0.0) > 1e-3);
        let mut x = b.clone();
        factor.solve(x.as_mut_slice());
        assert!((&s * x - &b).amax() < 1e-12);
        assert_eq!(factor.relative_pivots().iter().filter(|pivot| !pivot.is_finite()).count(), 1);
    }
}

#[test]
fn a_chain_has_no_fill() {
    let factor = BlockCholesky::new(&[3; 50], (0..49).map(|i| (i, i + 1)));
    assert_eq!(factor.values().len(), (50 + 49) * 3 * stride(3));
}

proptest! {
    #[test]
    fn sparse_lu_solves_what_a_dense_factorization_solves(
        entries in prop::collection::vec((0usize..20, 0usize..20, -1.0f64..1.0), 0..90),
        shift in 0usize..20,
    ) {
        // A permuted diagonal keeps the matrix regular without a usable diagonal.
        let n = 20;
        let mut dense = DMatrix::<f64>::zeros(n, n);
        for i in 0..n { dense[(i, (i + shift) % n)] = 9.0; }
        for (i, j, x) in entries { dense[(i, j)] += x; }
        let list: Vec<_> = (0..n * n)
            .map(|at| (at / n, at % n, dense[(at / n, at % n)]))
            .filter(|(_, _, x)| *x != 0.0)
            .collect();
        let mut matrix = Columns::default();
        matrix.fill(n, &list);
        let mut lu = SparseLu::new(n);
        let b = DVector::from_fn(n, |i, _| libm::cos(i as f64));
        // Twice, since the store is used again.
        for _ in 0..2 {
            prop_assert!(lu.factor(&matrix));
            let mut x = b.clone();
            lu.solve(x.as_mut_slice());
            prop_assert!((&dense * &x - &b).amax() < 1e-11);
            prop_assert_eq!(x, dense.clone().lu().solve(&b).unwrap());
        }
    }
}

#[test]
fn a_singular_matrix_is_refused() {
    let mut matrix = Columns::default();
    matrix.fill(2, &[(0, 0, 1.0), (0, 1, 2.0)]);
    assert!(!SparseLu::new(2).factor(&matrix));
}

#[test]
fn a_row_that_is_a_sum_of_others_is_left_out() {
    let matrix =
        DMatrix::from_row_slice(4, 3, &[1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 1.0, 2.0, 0.0, 0.0, 0.0, 1e-3]);
    assert_eq!(independent_rows(&matrix, 1e-9), [1, 2, 3]);
    assert_eq!(independent_rows(&matrix, 1e-2), [1, 2]);
    let null = left_null_space(&matrix, 1e-9);
    assert_eq!(null.shape(), (4, 1));
    assert!(matrix.tr_mul(&null).amax() < 1e-15);
    assert!((null.norm() - 1.0).abs() < 1e-15);
}
