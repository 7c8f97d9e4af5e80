//! The steady motion near the start, if there is one.

use crate::analysis::flow::{Flow, Spin};
use crate::analysis::{AnalysisError, Stage, equilibrium};
use nalgebra::{DMatrix, DVector, Vector3};
use schemars::JsonSchema;
use serde::Serialize;
use triad_dynamics::constraints::violation;
use triad_linalg::left_null_space;

/// Relative difference of principal moments below which a body is alike all around the third axis.
const ALIKE: f64 = 1e-9;
/// Part of the velocities by which rows may be missed.
const MISSED: f64 = 1e-8;
/// Part of the largest force by which forces may change in the frame of the motion.
const CHANGED: f64 = 1e-6;
/// Angle or, in lengths of the mechanism, way after which it is seen whether the motion is steady.
const LATER: f64 = 0.7;

/// A motion in which all bodies keep their places in a frame that turns and slides uniformly.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct SteadyMotion {
    /// Angular velocity of the frame, rad/s.
    pub turning: [f64; 3],
    /// Velocity of the frame at the world's origin, m/s.
    pub sliding: [f64; 3],
    /// Bodies that spin in it about an axis around which they are alike, and how fast, rad/s.
    pub spins: Vec<BodySpin>,
}

/// The spin of one body.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct BodySpin {
    /// The body.
    pub body: String,
    /// Angular velocity in the frame, rad/s.
    pub rate: f64,
}

/// Finds the steady motion near the start, and holds the stage in it.
pub fn find(stage: &mut Stage) -> Result<SteadyMotion, AnalysisError> {
    let flow = nearest(stage)?;
    let names = stage.mechanism.system.model.bodies.iter().map(|body| body.name.clone());
    let told = SteadyMotion {
        turning: flow.turning.into(),
        sliding: flow.sliding.into(),
        spins: names
            .zip(&flow.spins)
            .filter(|(_, spin)| spin.rate != 0.0)
            .map(|(body, spin)| BodySpin { body, rate: spin.rate })
            .collect(),
    };
    stage.flow = flow;
    equilibrium::find(stage).map_err(|error| match error {
        AnalysisError::NoEquilibrium { residual, body, .. } => none(format!(
            "in the frame that moves along, a generalized force of {residual:.3e} N is left, most of it on body \"{body}\""
        )),
        other => other,
    })?;
    fits(stage)?;
    lasts(stage)?;
    stage.rest();
    Ok(told)
}

fn none(reason: String) -> AnalysisError {
    AnalysisError::NoSteadyMotion { reason }
}

/// The steady motion that meets the joints and drivers at the start, and among those the one nearest to the velocities there.
fn nearest(stage: &mut Stage) -> Result<Flow, AnalysisError> {
    let length = stage.mechanism.system.length;
    let start = stage.twists();
    let (fields, axes) = fields(stage);
    let wanted = stage.rows_times(&DMatrix::from_column_slice(start.len(), 1, start.as_slice()));
    let wanted = wanted.column(0).into_owned();
    let rows = stage.rows_times(&fields);
    let scaled = |mut x: DMatrix<f64>| {
        x.row_iter_mut().enumerate().filter(|(row, _)| row % 6 >= 3).for_each(|(_, mut row)| row *= length);
        x
    };
    let (fields, start) =
        (scaled(fields), scaled(DMatrix::from_column_slice(start.len(), 1, start.as_slice())));
    let start = start.column(0).into_owned();
    let distance = |p: &DVector<f64>| (&fields * p - &start).norm();
    let size = start.norm().max(f64::MIN_POSITIVE);
    let all = closest(&rows, &wanted, &fields, &start);
    // A frame that need not turn does not: then frequencies are those that somebody at rest sees.
    let turning = 3;
    let without = closest(
        &rows.columns_range(turning..).into_owned(),
        &wanted,
        &fields.columns_range(turning..).into_owned(),
        &start,
    );
    let mut still = DVector::zeros(all.len());
    still.rows_range_mut(turning..).copy_from(&without);
    let missed = |p: &DVector<f64>| (&rows * p - &wanted).norm();
    let enough = missed(&still) <= missed(&all) + MISSED * rows.norm() * still.norm()
        && distance(&still) <= distance(&all) + MISSED * size;
    let p = if enough { still } else { all };
    let part = |k: usize| Vector3::new(p[k], p[k + 1], p[k + 2]);
    let rounded = |x: f64, reach: f64| if x.abs() * reach <= MISSED * size { 0.0 } else { x };
    let mut flow = Flow {
        turning: part(0).map(|x| rounded(x, length)),
        sliding: part(3).map(|x| rounded(x, 1.0)),
        spins: vec![Spin::default(); stage.mechanism.system.bodies.len()],
    };
    for (k, &(body, axis)) in axes.iter().enumerate() {
        flow.spins[body] = Spin { axis, rate: rounded(p[6 + k], length) };
    }
    stage.flow = flow.clone();
    fits(stage)?;
    Ok(flow)
}

/// Twists of the steady motions at the held position as columns: three turns, three translations, then a spin of each body that
/// is alike around an axis, with body and director.
fn fields(stage: &Stage) -> (DMatrix<f64>, Vec<(usize, usize)>) {
    let mechanism = &stage.mechanism;
    let bodies = || mechanism.system.bodies.iter().zip(mechanism.state.bodies()).enumerate();
    let axes: Vec<(usize, usize)> = bodies()
        .filter_map(|(index, (body, _))| {
            let j = body.principal;
            let same = |a: usize, b: usize| (j[a] - j[b]).abs() <= ALIKE * j.max();
            let axis = (0..3).find(|&k| same((k + 1) % 3, (k + 2) % 3) && !same(k, (k + 1) % 3));
            axis.map(|axis| (index, axis))
        })
        .collect();
    let mut out = DMatrix::zeros(6 * mechanism.system.bodies.len(), 6 + axes.len());
    for (index, (_, at)) in bodies() {
        for k in 0..3 {
            let unit = Vector3::ith(k, 1.0);
            out.fixed_view_mut::<3, 1>(6 * index, k).copy_from(&unit.cross(&at.q.r));
            out[(6 * index + 3 + k, k)] = 1.0;
            out[(6 * index + k, 3 + k)] = 1.0;
        }
    }
    for (column, &(body, axis)) in axes.iter().enumerate() {
        let e = mechanism.state.bodies()[body].q.e[axis];
        out.fixed_view_mut::<3, 1>(6 * body + 3, 6 + column).copy_from(&e);
    }
    (out, axes)
}

/// p with `rows` p = `wanted` as nearly as can be, and among those the one with `fields` p nearest to `start`.
fn closest(
    rows: &DMatrix<f64>,
    wanted: &DVector<f64>,
    fields: &DMatrix<f64>,
    start: &DVector<f64>,
) -> DVector<f64> {
    let least = |matrix: &DMatrix<f64>, right: &DVector<f64>| {
        if matrix.is_empty() {
            return DVector::zeros(matrix.ncols());
        }
        let svd = matrix.clone().svd(true, true);
        let limit = MISSED * svd.singular_values.max();
        svd.solve(right, limit).unwrap_or_else(|_| DVector::zeros(matrix.ncols()))
    };
    let p = least(rows, wanted);
    let unseen = left_null_space(&rows.transpose(), MISSED);
    let further = least(&(fields * &unseen), &(start - fields * &p));
    p + unseen * further
}

/// Whether joints and drivers allow the steady motion at the held position.
fn fits(stage: &mut Stage) -> Result<(), AnalysisError> {
    stage.rest();
    let fastest = stage.q_dot.iter().fold(0.0f64, |a, x| a.max(x.abs()));
    let system = &stage.mechanism.system;
    let rates = violation::rates(system, &stage.mechanism.state);
    let worst = violation::worst(&rates).into_iter().next();
    match worst {
        Some((id, rate)) if rate > MISSED * fastest.max(f64::MIN_POSITIVE) => Err(none(format!(
            "\"{}\" does not let the bodies keep their places in one frame that turns and slides uniformly (a body may spin \
             only about an axis around which its moments of inertia are alike)",
            system[id].name
        ))),
        _ => Ok(()),
    }
}

/// Whether the motion goes on as it is: after a while joints and drivers are met, and the forces are those of now, moved along.
fn lasts(stage: &mut Stage) -> Result<(), AnalysisError> {
    stage.rest();
    let now = stage.loads();
    let length = stage.mechanism.system.length;
    let flow = &stage.flow;
    let turning = flow.spins.iter().fold(flow.turning.norm(), |a, spin| a.max(spin.rate.abs()));
    let time = LATER / turning.max(flow.sliding.norm() / length).max(LATER);
    let (mut q, mut turned) = (stage.q.clone(), now.clone());
    let turn = nalgebra::Rotation3::from_scaled_axis(flow.turning * time);
    for (index, body) in stage.mechanism.system.bodies.iter().enumerate() {
        body.layout.store(&flow.later(index, &body.layout.position(&stage.q), time), &mut q);
        for k in [6 * index, 6 * index + 3] {
            let part = turn * Vector3::new(now[k], now[k + 1], now[k + 2]);
            turned.fixed_rows_mut::<3>(k).copy_from(&part);
        }
    }
    let y = [q.as_slice(), stage.velocities(&q).as_slice()].concat();
    stage.mechanism.set_state(stage.time + time, &y);
    let system = &stage.mechanism.system;
    let open = violation::measure(system, &stage.mechanism.state);
    let (worst, changed) = (open.constraints.first().copied(), stage.loads() - &turned);
    if let Some((id, by)) = worst.filter(|(_, by)| *by > MISSED) {
        return Err(none(format!(
            "\"{}\" does not go on as at the start: it is off by {by:.3e} after {time:.3} s",
            system[id].name
        )));
    }
    if changed.amax() > (CHANGED * now.amax()).max(equilibrium::rounding(stage)) {
        return Err(none(format!(
            "the forces on body \"{}\" change in the frame that moves along: weight and springs to the ground stay the same \
             only about an axis along them",
            stage.foremost(&changed)
        )));
    }
    Ok(())
}
