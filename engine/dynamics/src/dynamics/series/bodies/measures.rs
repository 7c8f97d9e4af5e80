//! How fast bodies move, their energies, and whether they are still rigid.

use super::bundle::Bundle;
use super::components::{Components, narrowed};
use super::convolution::symmetric;
use super::kernels::Measures;
use super::pair::{Pair, each};
use super::planar::Planar;
use super::single::Single;
use crate::dynamics::series::lanes::{Lane, Natural, add_dot, dot, plus};
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

    #[inline(always)]
    fn twice_kinetic(&self, rate: &Natural<L>) -> Lane<L> {
        let mut twice = dot(&rate[0], &rate[0]);
        for l in 0..L {
            twice[l] /= self.inverse_mass[l];
        }
        for k in 0..3 {
            twice = plus(&self.ibar[k], &dot(&rate[1 + k], &rate[1 + k]), &twice);
        }
        twice
    }

    #[inline(always)]
    fn work_of_weight(&self, from: &Natural<L>, to: &Natural<L>) -> Lane<L> {
        let mut way = to[0];
        for (way, from) in way.iter_mut().zip(&from[0]) {
            for l in 0..L {
                way[l] -= from[l];
            }
        }
        dot(&self.weight, &way)
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

    #[inline(always)]
    fn twice_kinetic(&self, [r, z]: &[Pair<L>; 2]) -> Lane<L> {
        each(|l| {
            let [straight, turning] = [r, z].map(|rate| rate[0][l] * rate[0][l] + rate[1][l] * rate[1][l]);
            self.mass[l] * straight + self.inertia[l] * turning
        })
    }

    #[inline(always)]
    fn work_of_weight(&self, from: &[Pair<L>; 2], to: &[Pair<L>; 2]) -> Lane<L> {
        each(|l| (0..2).map(|c| self.weight[c][l] * (to[0][c][l] - from[0][c][l])).sum())
    }
}

impl Measures<1> for Single {
    fn pace(rate: &[Components; 4], length: f64) -> Lane<1> {
        Bundle::<1>::pace(&narrowed(rate), length)
    }

    fn stretch(x: &[Components; 4]) -> Lane<1> {
        Bundle::<1>::stretch(&narrowed(x))
    }

    #[inline(always)]
    fn twice_kinetic(&self, rate: &[Components; 4]) -> Lane<1> {
        self.plain.twice_kinetic(&narrowed(rate))
    }

    #[inline(always)]
    fn work_of_weight(&self, from: &[Components; 4], to: &[Components; 4]) -> Lane<1> {
        self.plain.work_of_weight(&narrowed(from), &narrowed(to))
    }
}
