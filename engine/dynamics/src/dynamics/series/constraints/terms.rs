//! The terms of H, from which S = H Hᵀ is built: what each feature contributes to the block of its body.

use crate::dynamics::series::bodies::LanePlace;
use crate::system::index::FeatureId;
use crate::system::row::Form;
use crate::system::{NO_INCIDENCE, System};
use std::ops::Range;

/// Which gradient a term of H has.
#[derive(Clone, Copy, Debug)]
pub enum Gradient {
    /// The three unit vectors, in three rows.
    Unit,
    /// The two directions across common vector k, in two rows.
    Across(usize),
    /// The other factor of lane `lane` of product bundle `bundle`: 0 for x, 1 for y.
    Factor { bundle: usize, lane: usize, side: usize },
    /// Gradient k of relation r.
    Relation { r: usize, k: usize },
}

/// A feature's part of a row form in the block of its body.
#[derive(Clone, Copy, Debug)]
pub struct Term {
    pub incidence: usize,
    pub at: usize,
    pub place: LanePlace,
    pub gradient: Gradient,
    pub sign: f64,
    /// 1/√m for points, 0 for vectors.
    pub translation: f64,
}

/// The point of a joint that is nothing but a common point, on one body.
#[derive(Clone, Copy, Debug)]
pub struct End {
    pub place: LanePlace,
    pub sign: f64,
}

/// For each incidence its point, if its joint is nothing but a common point.
pub fn ends(system: &System, place: &[LanePlace]) -> Vec<Option<End>> {
    let mut ends = vec![None; system.incidences.len()];
    for constraint in &system.constraints {
        let [row] = &system.rows[constraint.forms.clone()] else { continue };
        let Form::Coincidence { a, b } = row.form else { continue };
        for (order, feature, sign) in [(0, a, 1.0), (1, b, -1.0)] {
            let incidence = row.incidence[order];
            if incidence != NO_INCIDENCE {
                ends[incidence] = Some(End { place: place[feature.index()], sign });
            }
        }
    }
    ends
}

/// The rows of H that terms add to, in pieces.
pub fn changing(terms: &[Term], twist: usize) -> Vec<Range<usize>> {
    let mut rows: Vec<Range<usize>> = terms
        .iter()
        .map(|term| {
            let rows = if matches!(term.gradient, Gradient::Across(_)) { 2 } else { 1 };
            term.at..term.at + rows * twist
        })
        .collect();
    rows.sort_by_key(|range| range.start);
    let mut pieces: Vec<Range<usize>> = Vec::new();
    for range in rows {
        match pieces.last_mut() {
            Some(last) if last.end >= range.start => last.end = last.end.max(range.end),
            _ => pieces.push(range),
        }
    }
    pieces
}

/// The terms of H, row form by row form.
pub fn terms(system: &System, place: &[LanePlace], lanes: usize, twist: usize) -> Vec<Term> {
    let mut terms = Vec::new();
    let (mut commons, mut products, mut relations) = (0, 0, 0);
    for row in &system.rows {
        let mut add = |order: usize, feature: FeatureId, gradient: Gradient, sign: f64| {
            let place_of = row.incidence[order];
            if place_of == NO_INCIDENCE {
                return;
            }
            let incidence = &system.incidences[place_of];
            let point = system[feature].point;
            let inverse_mass = system.bodies[incidence.body].free_inverse_mass();
            terms.push(Term {
                incidence: place_of,
                at: incidence.offset / 6 * twist + twist * row.local,
                place: place[feature.index()],
                gradient,
                sign,
                translation: if point { inverse_mass.sqrt() } else { 0.0 },
            });
        };
        match row.form {
            Form::Coincidence { a, b } => {
                add(0, a, Gradient::Unit, 1.0);
                add(1, b, Gradient::Unit, -1.0);
            }
            Form::CommonVector { a, b } => {
                add(0, a, Gradient::Across(commons), 1.0);
                add(1, b, Gradient::Across(commons), -1.0);
                commons += 1;
            }
            Form::Product { a, b, .. } => {
                let mut order = 0;
                for (side, difference) in [a, b].into_iter().enumerate() {
                    let gradient =
                        Gradient::Factor { bundle: products / lanes, lane: products % lanes, side };
                    add(order, difference.plus, gradient, 1.0);
                    order += 1;
                    if let Some(minus) = difference.minus {
                        add(order, minus, gradient, -1.0);
                        order += 1;
                    }
                }
                products += 1;
            }
            Form::Relation { .. } => {
                for (k, feature) in row.form.features(&system.angles).into_iter().enumerate() {
                    add(k, feature, Gradient::Relation { r: relations, k }, 1.0);
                }
                relations += 1;
            }
        }
    }
    terms
}
