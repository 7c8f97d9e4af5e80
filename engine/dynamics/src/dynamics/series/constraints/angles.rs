//! Joint angles as series, and the rows that relate them: gears and screws — eq. (11.6), (11.7).

use crate::dynamics::series::bodies::LanePlace;
use crate::dynamics::series::lanes::LaneVector;
use crate::dynamics::series::recurrence::{
    Quads, Vectors, folded, folded_vectors, inner_dot, product, quad, quotient, real, scaled, scaled_quads,
    square, value,
};
use crate::state::AngleState;
use crate::system::System;
use crate::system::feature::Difference;
use crate::system::index::FeatureId;
use crate::system::row::Form;
use nalgebra::Vector3;
use pulp::Simd;
use triad_linalg::BlockCholesky;

/// The angle of a joint, θ = atan2(a₂ · b, a₁ · b).
#[derive(Clone, Debug)]
pub struct AngleSeries {
    places: [LanePlace; 3],
    /// Coefficients of a₁, a₂, b, of x = a₁ · b, y = a₂ · b and x² + y², and of x and y over x² + y².
    vectors: [Quads; 3],
    x: Vec<f64>,
    y: Vec<f64>,
    square: Vec<f64>,
    cosine: Vec<f64>,
    sine: Vec<f64>,
    /// Coefficients of θ.
    pub theta: Vec<f64>,
    /// Those of x, y and θ, each times its order.
    rates: [Vec<f64>; 3],
    /// Whether a row relates it to others, which asks for x and y over x² + y².
    related: bool,
    /// Value and gradient at the state; whole turns are counted from the value that the last series gave.
    pub state: AngleState,
}

impl AngleSeries {
    fn new(places: [LanePlace; 3], stride: usize, start: f64) -> Self {
        let scalar = || vec![0.0; stride];
        Self {
            places,
            vectors: [0; 3].map(|_| vec![[0.0; 4]; stride]),
            x: scalar(),
            y: scalar(),
            square: scalar(),
            cosine: scalar(),
            sine: scalar(),
            theta: scalar(),
            rates: [0; 3].map(|_| scalar()),
            related: false,
            state: AngleState { reference: start, ..AngleState::default() },
        }
    }

    /// Takes over the positions of the features.
    pub fn place<const L: usize>(&mut self, values: &[LaneVector<L>]) {
        let at = self.places.map(|p| p.get(values).into());
        self.state.set_position(at, self.state.reference);
    }

    /// Takes over coefficient m of the features, all before it being known.
    #[inline(always)]
    pub fn store<S: Simd, const L: usize>(&mut self, simd: S, m: usize, values: &[LaneVector<L>]) {
        for (vectors, place) in self.vectors.iter_mut().zip(self.places) {
            vectors[m] = quad(place.get(values));
        }
        let [a1, a2, b] = &self.vectors;
        self.x[m] = folded_vectors(simd, &a1[..=m], &b[..=m]);
        self.y[m] = folded_vectors(simd, &a2[..=m], &b[..=m]);
        self.square[m] = square(&self.x, m) + square(&self.y, m);
        if self.related {
            self.cosine[m] = quotient(self.x[m], &self.square, &self.cosine, m);
            self.sine[m] = quotient(self.y[m], &self.square, &self.sine, m);
        }
        if m == 0 {
            self.place(values);
            self.theta[0] = self.state.value;
        } else {
            self.theta[m] = self.term(m, self.x[m], self.y[m]);
        }
        for (rate, term) in self.rates.iter_mut().zip([self.x[m], self.y[m], self.theta[m]]) {
            rate[m] = real(m) * term;
        }
    }

    /// θ_m for given x_m and y_m: ρ θ̇ = x ẏ − y ẋ with ρ = x² + y².
    #[inline(always)]
    fn term(&self, m: usize, x_m: f64, y_m: f64) -> f64 {
        let (x, y) = (&self.x, &self.y);
        let [x_rate, y_rate, rate] = self.rates.each_ref().map(|rates| &rates[1..m]);
        let sum = folded(&x[1..m], y_rate) - folded(&y[1..m], x_rate) - folded(&self.square[1..m], rate);
        let order = real(m);
        (order * (x[0] * y_m - y[0] * x_m) + sum) / (order * self.square[0])
    }

    /// θ_m without what coefficient m of the features adds to it.
    #[inline(always)]
    fn known<S: Simd>(&self, simd: S, m: usize) -> f64 {
        let [a1, a2, b] = &self.vectors;
        let x = folded_vectors(simd, &a1[1..m], &b[1..m]);
        let y = folded_vectors(simd, &a2[1..m], &b[1..m]);
        self.term(m, x, y)
    }

    /// Ends a step: whole turns are counted from the value at its end.
    pub fn advance(&mut self, h: f64, order: usize) {
        self.state.reference = value(&self.theta[..=order], h);
    }

    /// How far the angle turns at most within h, rad.
    pub fn sweep(&self, h: f64, order: usize) -> f64 {
        self.theta[1..=order].iter().rev().fold(0.0, |sum, c| (sum + c.abs()) * h)
    }
}

/// A row Σ cᵢ θᵢ + d (x · y) − c = 0.
#[derive(Clone, Debug)]
struct Relation {
    row: usize,
    constant: f64,
    angles: [Option<Turn>; 2],
    slide: Option<Slide>,
    /// Its multiplier, and that of the second kind: see [`Angles::exchange_multipliers`].
    multiplier: Multiplier,
    other: Multiplier,
    /// Its features and gradient with respect to them at the state, in the order of [`Form::features`].
    places: Vec<LanePlace>,
    gradients: Vec<Vector3<f64>>,
}

/// The coefficients of a multiplier, and for each angle those of its products with x and y over x² + y².
#[derive(Clone, Debug)]
struct Multiplier {
    lambda: Vec<f64>,
    cosine: [Vec<f64>; 2],
    sine: [Vec<f64>; 2],
}

impl Multiplier {
    fn new(stride: usize) -> Self {
        let each = || [0; 2].map(|_| vec![0.0; stride]);
        Self { lambda: vec![0.0; stride], cosine: each(), sine: each() }
    }

    /// Takes over coefficient n.
    #[inline(always)]
    fn store(&mut self, n: usize, lambda: f64, angles: &[Option<Turn>; 2], list: &[AngleSeries]) {
        self.lambda[n] = lambda;
        for (k, turn) in angles.iter().enumerate() {
            let Some(turn) = turn else { continue };
            let angle = &list[turn.angle];
            self.cosine[k][n] = product(&self.lambda, &angle.cosine, n);
            self.sine[k][n] = product(&self.lambda, &angle.sine, n);
        }
    }
}

/// The part of an angle.
#[derive(Clone, Copy, Debug)]
struct Turn {
    angle: usize,
    factor: f64,
}

/// The part of a displacement: minuend and subtrahend of both factors, and their series.
#[derive(Clone, Debug)]
struct Slide {
    places: [[Option<LanePlace>; 2]; 2],
    factor: f64,
    sides: [Vectors; 2],
}

impl Slide {
    fn side<const L: usize>(&self, side: usize, values: &[LaneVector<L>]) -> Vector3<f64> {
        let [plus, minus] = self.places[side].map(|p| p.map_or(Vector3::zeros(), |p| p.get(values).into()));
        plus - minus
    }
}

/// All angles, and the rows that relate them.
#[derive(Clone, Debug)]
pub struct Angles {
    /// The angles, in the order of the system's.
    pub list: Vec<AngleSeries>,
    /// How many of them, the first ones, something but outputs depends on.
    needed: usize,
    relations: Vec<Relation>,
}

impl Angles {
    /// Of a system, with room for `stride` coefficients; `turns` are the angles at the start.
    pub fn new(
        system: &System,
        place: &[LanePlace],
        factor: &BlockCholesky,
        stride: usize,
        turns: &[f64],
    ) -> Self {
        let starts = turns.iter().copied().chain(std::iter::repeat(0.0));
        let angles = system.angles.iter().zip(starts);
        let list =
            angles.map(|(a, start)| AngleSeries::new(a.features().map(|f| place[f.index()]), stride, start));
        let mut list: Vec<AngleSeries> = list.collect();
        let relations = system.rows.iter().filter_map(|row| {
            let Form::Relation { angles, slide, constant } = row.form else { return None };
            let places: Vec<LanePlace> =
                row.form.features(&system.angles).iter().map(|&f| place[f.index()]).collect();
            let at = |f: FeatureId| place[f.index()];
            let pair = |d: Difference| [Some(at(d.plus)), d.minus.map(at)];
            Some(Relation {
                row: factor.places()[row.solver],
                constant,
                angles: angles.map(|term| {
                    let (angle, factor) = term?;
                    Some(Turn { angle, factor })
                }),
                slide: slide.map(|(a, b, factor)| Slide {
                    places: [pair(a), pair(b)],
                    factor,
                    sides: [0; 2].map(|_| vec![Vector3::zeros(); stride]),
                }),
                multiplier: Multiplier::new(stride),
                other: Multiplier::new(if system.regularizes_inertia() { stride } else { 0 }),
                gradients: vec![Vector3::zeros(); places.len()],
                places,
            })
        });
        let relations: Vec<Relation> = relations.collect();
        for turn in relations.iter().flat_map(|relation| relation.angles.iter().flatten()) {
            list[turn.angle].related = true;
        }
        Self { list, needed: system.needed_angles, relations }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty() && self.relations.is_empty()
    }

    /// Takes over the positions of features: values and gradients at the state.
    pub fn place<const L: usize>(&mut self, values: &[LaneVector<L>]) {
        for angle in &mut self.list {
            angle.place(values);
        }
        for relation in &mut self.relations {
            relation.set_gradients(&self.list, values);
        }
    }

    /// Gradient k of relation r.
    pub fn gradient(&self, r: usize, k: usize) -> [f64; 3] {
        self.relations[r].gradients[k].into()
    }

    /// Takes over coefficient m of all features.
    #[inline(always)]
    pub fn store<S: Simd, const L: usize>(&mut self, simd: S, m: usize, values: &[LaneVector<L>]) {
        for angle in &mut self.list {
            angle.store(simd, m, values);
        }
        for relation in &mut self.relations {
            if let Some(slide) = &mut relation.slide {
                for side in 0..2 {
                    slide.sides[side][m] = slide.side(side, values);
                }
            }
            if m == 0 {
                relation.set_gradients(&self.list, values);
            }
        }
    }

    /// Takes over the multipliers of order n.
    #[inline(always)]
    pub fn store_multipliers(&mut self, n: usize, lambda: &[f64]) {
        for relation in &mut self.relations {
            relation.multiplier.store(n, lambda[relation.row], &relation.angles, &self.list);
        }
    }

    /// Has the second kind of multipliers in the place of the first, or the first in theirs again.
    pub fn exchange_multipliers(&mut self) {
        for relation in &mut self.relations {
            std::mem::swap(&mut relation.multiplier, &mut relation.other);
        }
    }

    /// What relations demand of coefficient m beyond its own part, times a factor.
    #[inline(always)]
    pub fn demand<S: Simd>(&self, simd: S, m: usize, factor: f64, extra: &mut [f64]) {
        for relation in &self.relations {
            let turns = relation.angles.iter().flatten();
            let mut known: f64 = turns.map(|t| t.factor * self.list[t.angle].known(simd, m)).sum();
            if let Some(slide) = &relation.slide {
                known += slide.factor * inner_dot(&slide.sides[0], &slide.sides[1], m);
            }
            extra[relation.row] = factor * known;
        }
    }

    /// Φ of relations.
    pub fn set_violation<const L: usize>(&self, values: &[LaneVector<L>], extra: &mut [f64]) {
        for relation in &self.relations {
            let turns = relation.angles.iter().flatten();
            let turned: f64 = turns.map(|t| t.factor * self.list[t.angle].state.value).sum();
            let slid =
                relation.slide.as_ref().map_or(0.0, |s| s.factor * s.side(0, values).dot(&s.side(1, values)));
            extra[relation.row] = turned + slid - relation.constant;
        }
    }

    /// Φ̇ of relations from the rates of features.
    pub fn set_rate_violation<const L: usize>(&self, rates: &[LaneVector<L>], extra: &mut [f64]) {
        for relation in &self.relations {
            extra[relation.row] = relation.along(rates);
        }
    }

    /// What is left of relations, given the features' part of the unknown.
    #[inline(always)]
    pub fn residual<const L: usize>(&self, values: &[LaneVector<L>], extra: &[f64], out: &mut [f64]) {
        for relation in &self.relations {
            out[relation.row] = relation.along(values) + extra[relation.row];
        }
    }

    /// Generalized forces of multipliers of the current order.
    #[inline(always)]
    pub fn add_forces<const L: usize>(&self, lambda: &[f64], forces: &mut [LaneVector<L>]) {
        for relation in &self.relations {
            for (place, gradient) in relation.places.iter().zip(&relation.gradients) {
                place.add(forces, (gradient * -lambda[relation.row]).into());
            }
        }
    }

    /// Generalized forces of order n that multipliers of lower order make.
    #[inline(always)]
    pub fn add_known_forces<S: Simd, const L: usize>(
        &mut self,
        simd: S,
        n: usize,
        forces: &mut [LaneVector<L>],
    ) {
        if n == 0 {
            return;
        }
        for relation in &mut self.relations {
            let Relation { multiplier, angles, slide, .. } = relation;
            multiplier.store(n, 0.0, angles, &self.list);
            let Multiplier { lambda, cosine, sine } = multiplier;
            for ((turn, cosine), sine) in angles.iter().zip(cosine).zip(sine) {
                let Some(Turn { angle, factor }) = *turn else { continue };
                let angle = &self.list[angle];
                let [a1, a2, b] = &angle.vectors;
                let [on_a1, on_a2, on_b] = angle.places;
                on_a1.add(forces, (scaled_quads(simd, sine, b, n) * factor).into());
                on_a2.add(forces, (scaled_quads(simd, cosine, b, n) * -factor).into());
                let across = scaled_quads(simd, sine, a1, n) - scaled_quads(simd, cosine, a2, n);
                on_b.add(forces, (across * factor).into());
            }
            let Some(slide) = slide else { continue };
            for side in 0..2 {
                let force = scaled(lambda, &slide.sides[1 - side], n) * -slide.factor;
                for (place, sign) in slide.places[side].into_iter().zip([1.0, -1.0]) {
                    if let Some(place) = place {
                        place.add(forces, (force * sign).into());
                    }
                }
            }
        }
    }

    /// The part of h, by halves, within which no angle on which something depends turns by more than `most`.
    pub fn limit(&self, mut h: f64, order: usize, most: f64) -> f64 {
        for angle in &self.list[..self.needed] {
            for _ in 0..60 {
                if angle.sweep(h, order) <= most {
                    break;
                }
                h *= 0.5;
            }
        }
        h
    }

    /// Ends a step of size h.
    pub fn advance(&mut self, h: f64, order: usize) {
        for angle in &mut self.list {
            angle.advance(h, order);
        }
    }
}

impl Relation {
    fn set_gradients<const L: usize>(&mut self, angles: &[AngleSeries], values: &[LaneVector<L>]) {
        let mut k = 0;
        for turn in self.angles.iter().flatten() {
            for gradient in angles[turn.angle].state.gradient {
                self.gradients[k] = gradient * turn.factor;
                k += 1;
            }
        }
        let Some(slide) = &self.slide else { return };
        for side in 0..2 {
            let gradient = slide.side(1 - side, values) * slide.factor;
            for (_, sign) in slide.places[side].iter().zip([1.0, -1.0]).filter(|(place, _)| place.is_some()) {
                self.gradients[k] = gradient * sign;
                k += 1;
            }
        }
    }

    /// The gradient times values of features.
    #[inline(always)]
    fn along<const L: usize>(&self, values: &[LaneVector<L>]) -> f64 {
        let terms = self.places.iter().zip(&self.gradients);
        terms.map(|(place, gradient)| gradient.dot(&Vector3::from(place.get(values)))).sum()
    }
}
