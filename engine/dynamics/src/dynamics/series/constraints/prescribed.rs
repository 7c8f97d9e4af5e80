//! What moves as prescribed: points and vectors that drivers move, and the numbers that they give to products —
//! eq. (11.3).
//!
//! A driven feature is x = C(t) Q with local coordinates that are series themselves. In order m it has, besides
//! C₀ Q_m, the part Σ C_i Q_(m−i), i > 0, which is known beforehand; likewise the generalized force on it.

use crate::dynamics::series::bodies::{Bodies, FeatureSlot, LanePlace};
use crate::dynamics::series::lanes::LaneVector;
use crate::dynamics::series::recurrence::{Vectors, kept_and_left, product_with_rate, value, vector_value};
use crate::model::BodyRef;
use crate::model::motion::VectorCurve;
use crate::system::System;
use crate::system::feature::{Target, TargetCurve};
use crate::system::row::Form;
use nalgebra::Vector3;
use triad_linalg::BlockCholesky;

/// A feature that moves as prescribed.
#[derive(Clone, Debug)]
struct Driven {
    curve: VectorCurve,
    place: LanePlace,
    /// Bundle and lane of its body; none for the ground.
    body: Option<[usize; 2]>,
    /// Coefficients of its local coordinates and of the constraint force on it.
    local: Vectors,
    force: Vectors,
    /// That of the second kind of multipliers, if there are any: see [`Prescribed::exchange_multipliers`].
    other_force: Vectors,
    /// What it has in the current order beyond C₀ Q_m.
    known: Vector3<f64>,
    /// That while it counts for nothing.
    set_aside: Vector3<f64>,
}

/// A prescribed number of a product row.
#[derive(Clone, Debug)]
struct PrescribedNumber {
    row: usize,
    curve: TargetCurve,
    series: Vec<f64>,
}

/// All prescribed features and numbers.
#[derive(Clone, Debug)]
pub struct Prescribed {
    features: Vec<Driven>,
    numbers: Vec<PrescribedNumber>,
}

impl Prescribed {
    /// Of a system, with room for `stride` coefficients.
    pub fn new(
        system: &System,
        place: &[LanePlace],
        factor: &BlockCholesky,
        lanes: usize,
        stride: usize,
    ) -> Self {
        let driven = system.features.iter().zip(place).filter_map(|(feature, &place)| {
            let body = match feature.body {
                BodyRef::Ground => None,
                BodyRef::Moving(body) => Some([body / lanes, body % lanes]),
            };
            Some(Driven {
                curve: system.curves[feature.curve?].clone(),
                place,
                body,
                local: vec![Vector3::zeros(); stride],
                force: vec![Vector3::zeros(); stride],
                other_force: vec![Vector3::zeros(); if system.regularizes_inertia() { stride } else { 0 }],
                known: Vector3::zeros(),
                set_aside: Vector3::zeros(),
            })
        });
        let numbers = system.rows.iter().filter_map(|row| match row.form {
            Form::Product { target: Target::Driven(k), .. } => {
                let curve = system.targets[k].clone();
                Some(PrescribedNumber { row: factor.places()[row.solver], curve, series: vec![0.0; stride] })
            }
            _ => None,
        });
        Self { features: driven.collect(), numbers: numbers.collect() }
    }

    /// Whether nothing is prescribed.
    pub fn is_empty(&self) -> bool {
        self.features.is_empty() && self.numbers.is_empty()
    }

    /// The first moment after t at which a prescribed function has another piece, s.
    pub fn next_break(&self, t: f64) -> f64 {
        let features = self.features.iter().map(|f| f.curve.next_break(t));
        let numbers = self.numbers.iter().map(|n| n.curve.curve.next_break(t));
        features.chain(numbers).fold(f64::INFINITY, f64::min)
    }

    /// Expands all about time t and puts the features' places of that moment among the others.
    pub fn expand<const L: usize>(
        &mut self,
        t: f64,
        slots: &mut [FeatureSlot<L>],
        ground: &mut [LaneVector<L>],
    ) {
        for feature in &mut self.features {
            feature.curve.expand(t, &mut feature.local);
            let lane = feature.place.lane % L;
            let target = match feature.body {
                Some(_) => &mut slots[feature.place.slot].local,
                None => &mut ground[feature.place.slot - slots.len()],
            };
            for c in 0..3 {
                target[c][lane] = feature.local[0][c];
            }
        }
        for number in &mut self.numbers {
            number.curve.expand(t, &mut number.series);
        }
    }

    /// Whether all are at `time`, h after the point of expansion, what their series say, but for a relative error.
    pub fn meets(&self, h: f64, time: f64, error: f64) -> bool {
        self.features.iter().all(|f| {
            let exact = f.curve.at(time)[0];
            (exact - vector_value(&f.local, h)).amax() <= error * (1.0 + exact.amax())
        }) && self.numbers.iter().all(|n| {
            let exact = n.curve.at(time)[0];
            (exact - value(&n.series, h)).abs() <= error * (1.0 + exact.abs())
        })
    }

    /// Whether a part of more than `part` of what one of them does within h is in terms above an order.
    pub fn goes_on(&self, h: f64, order: usize, part: f64) -> bool {
        let features =
            self.features.iter().map(|f| kept_and_left(f.local.iter().map(Vector3::norm), order, h));
        let numbers = self.numbers.iter().map(|n| kept_and_left(n.series.iter().map(|x| x.abs()), order, h));
        features.chain(numbers).any(|[kept, left]| left > part * kept)
    }

    /// Finds what features have in order m beyond C₀ Q_m, times a factor; `coefficient(b, i)` is Q_i of bundle b.
    #[inline(always)]
    pub fn prepare<'a, const L: usize, B: Bodies<L> + 'a>(
        &mut self,
        m: usize,
        factor: f64,
        coefficient: impl Fn(usize, usize) -> &'a B::Natural,
    ) {
        for feature in &mut self.features {
            feature.known = match feature.body {
                None => feature.local[m],
                Some([bundle, lane]) => {
                    (1..=m).map(|i| B::arm(&feature.local[i], coefficient(bundle, m - i), lane, m - i)).sum()
                }
            } * factor;
        }
    }

    /// Makes features move with their bodies alone.
    pub fn clear_known(&mut self) {
        for feature in &mut self.features {
            feature.known = Vector3::zeros();
        }
    }

    /// Has what [`Self::prepare`] found count for nothing, or again.
    pub fn exchange_known(&mut self) {
        for feature in &mut self.features {
            std::mem::swap(&mut feature.known, &mut feature.set_aside);
        }
    }

    /// Adds what [`Self::prepare`] found, times a factor, to the values of features.
    #[inline(always)]
    pub fn add_known<const L: usize>(&self, factor: f64, values: &mut [LaneVector<L>]) {
        for feature in &self.features {
            let known = feature.known * factor;
            if feature.body.is_some() {
                feature.place.add(values, known.into());
            } else {
                feature.place.set(values, known.into());
            }
        }
    }

    /// Takes the known forces of order n on features and adds to those on bodies what earlier orders make.
    #[inline(always)]
    pub fn pull_back<const L: usize, B: Bodies<L>>(
        &mut self,
        n: usize,
        forces: &[LaneVector<L>],
        bundles: &mut [B],
    ) {
        for feature in &mut self.features {
            feature.force[n] = feature.place.get(forces).into();
            let Some([bundle, lane]) = feature.body else { continue };
            for i in 1..=n {
                bundles[bundle].add_director_force(lane, &feature.local[i], &feature.force[n - i]);
            }
        }
    }

    /// Adds further forces of order n.
    #[inline(always)]
    pub fn add_forces<const L: usize>(&mut self, n: usize, forces: &[LaneVector<L>]) {
        for feature in &mut self.features {
            feature.force[n] += Vector3::from(feature.place.get(forces));
        }
    }

    /// Has the forces of the second kind of multipliers in the place of the first, or the first in theirs again.
    pub fn exchange_multipliers(&mut self) {
        for feature in &mut self.features {
            std::mem::swap(&mut feature.force, &mut feature.other_force);
        }
    }

    /// Takes coefficient m of the prescribed numbers, times a factor, off what products demand.
    #[inline(always)]
    pub fn demand(&self, m: usize, factor: f64, extra: &mut [f64]) {
        for number in &self.numbers {
            extra[number.row] -= factor * number.series[m];
        }
    }

    /// Power −λᵀν of order n that drivers bring in: the force on a feature times the rate that is prescribed, and
    /// multiplier times rate of a number. `multiplier(i, row)` is a coefficient of λ.
    pub fn power<'a, const L: usize, B: Bodies<L> + 'a>(
        &self,
        n: usize,
        coefficient: impl Fn(usize, usize) -> &'a B::Natural,
        multiplier: impl Fn(usize, usize) -> f64,
    ) -> f64 {
        let mut power = 0.0;
        for feature in &self.features {
            let rate = |m: usize| match feature.body {
                None => feature.local[m + 1] * (m + 1) as f64,
                Some([bundle, lane]) => (0..=m)
                    .map(|i| {
                        B::arm(&feature.local[i + 1], coefficient(bundle, m - i), lane, m - i)
                            * (i + 1) as f64
                    })
                    .sum(),
            };
            power -= (0..=n).map(|i| feature.force[i].dot(&rate(n - i))).sum::<f64>();
        }
        for number in &self.numbers {
            let lambda: [f64; crate::model::motion::MAX_TERMS] =
                std::array::from_fn(|i| if i <= n { multiplier(i, number.row) } else { 0.0 });
            power -= product_with_rate(&lambda, &number.series, n);
        }
        power
    }
}
