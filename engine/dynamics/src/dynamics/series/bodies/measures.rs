//! How fast bodies move, and whether they are still rigid.

use super::bundle::Bundle;
use super::convolution::symmetric;
use super::kernels::Measures;
use super::pair::{Pair, each};
use super::planar::Planar;
use crate::dynamics::series::lanes::{Lane, Natural, add_dot, dot};
use triad_linalg::larger;

impl<const L: usize> Measures<L> for Bundle<L> {
    fn pace([r, e @ ..]: &Natural<L>, length: f64) -> Lane<L> {
        let (mut turning, moving) = ([0.0; L], dot(r, r));
        for e in e {
            add_dot(&mut turning, e, e);
        }
        each(|l| larger((0.5 * turning[l]).sqrt(), moving[l].sqrt() / length))
    }

    fn stretch(x: &Natural<L>) -> Lane<L> {
        let mut largest = [0.0; L];
        for (k, twice) in symmetric(x, x).iter().enumerate() {
            let unit = if k < 3 { 1.0 } else { 0.0 };
            for (largest, twice) in largest.iter_mut().zip(twice) {
                let off = (0.5 * twice - unit).abs();
                *largest = if off.is_nan() { off } else { larger(*largest, off) };
            }
        }
        largest
    }
}

impl<const L: usize> Measures<L> for Planar<L> {
    fn pace([r, z]: &[Pair<L>; 2], length: f64) -> Lane<L> {
        let size = |v: &Pair<L>, l: usize| (v[0][l] * v[0][l] + v[1][l] * v[1][l]).sqrt();
        each(|l| larger(size(z, l), size(r, l) / length))
    }

    fn stretch([_, z]: &[Pair<L>; 2]) -> Lane<L> {
        each(|l| (z[0][l] * z[0][l] + z[1][l] * z[1][l] - 1.0).abs())
    }
}
