//! How fast bodies move, their energies, and whether they are still rigid.

use super::bundle::Bundle;
use super::components::{Components, narrowed};
use super::convolution::symmetric;
use super::kernels::Measures;
use super::pair::{Pair, each};
use super::planar::Planar;
use super::single::Single;
use crate::dynamics::series::lanes::{Lane, Natural, add_dot, dot, plus, times};
use triad_linalg::{fma, larger, larger_or_nan};

/// Work of a constant generalized force.
#[inline(always)]
fn work<const L: usize>(force: &[Lane<L>], from: &[Lane<L>], to: &[Lane<L>]) -> Lane<L> {
    let mut work = [0.0; L];
    for ((force, from), to) in force.iter().zip(from).zip(to) {
        for l in 0..L {
            work[l] = fma(force[l], to[l] - from[l], work[l]);
        }
    }
    work
}

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
                *largest = larger_or_nan(*largest, off);
            }
        }
        largest
    }

    #[inline(always)]
    fn twice_kinetic(&self, rate: &Natural<L>) -> Lane<L> {
        let mut twice = times(&self.mass, &dot(&rate[0], &rate[0]));
        for k in 0..3 {
            twice = plus(&self.ibar[k], &dot(&rate[1 + k], &rate[1 + k]), &twice);
        }
        twice
    }

    #[inline(always)]
    fn work_of_weight(&self, from: &Natural<L>, to: &Natural<L>) -> Lane<L> {
        work(self.weight.as_flattened(), from.as_flattened(), to.as_flattened())
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
        work(self.weight.as_flattened(), from.as_flattened(), to.as_flattened())
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
