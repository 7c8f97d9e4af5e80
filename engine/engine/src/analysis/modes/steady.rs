//! The steady motion near the start, if there is one.

mod lasting;

use crate::analysis::momenta::{self, Fields, MISSED, Momenta, Solutions, energetic};
use crate::analysis::{AnalysisError, Stage, equilibrium};
use nalgebra::{DMatrix, DVector};
use schemars::JsonSchema;
use serde::Serialize;
use triad_dynamics::constraints::violation;
use triad_linalg::{largest_size, least_squares};

/// Part of the largest force by which forces may change in the frame of the motion.
const CHANGED: f64 = 1e-6;
/// Steps of Newton's method to a steady motion next to the start.
const STEPS: usize = 10;
/// Way, in lengths of the mechanism, up to which one is next to it.
const NEAR: f64 = 0.01;
/// Positions that tell what holds at all of them: a point on a rod passes three translations but for its directions at three.
const POSITIONS: usize = 4;

/// Freedoms times bodies times squared fields that are not too many: some seconds.
const MOST_WORK: usize = 60_000_000;

/// A motion in which all bodies keep their places in a frame that turns and slides uniformly.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct SteadyMotion {
    /// Angular velocity of the frame, rad/s.
    pub turning: [f64; 3],
    /// Velocity of the frame at the world's origin at the start, m/s.
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

/// Motions of the whole that change nothing, known without linearizing: twists of each body as columns.
pub struct Unfelt {
    /// Translations that go on for ever, uniformly.
    pub translations: DMatrix<f64>,
    /// Other displacements from one steady motion to another with the same frame and spins.
    pub drifts: DMatrix<f64>,
}

impl Unfelt {
    /// The part of a basis of small motions that leaves the whole where it is.
    pub fn across(&self, stage: &Stage, basis: DMatrix<f64>) -> DMatrix<f64> {
        momenta::across(
            &stage.mechanism.system.bodies,
            &stage.places(&stage.q),
            self.translations.clone(),
            basis,
        )
    }
}

/// The steady motion in which a stage is held.
pub struct Found {
    /// What is told of it.
    pub told: SteadyMotion,
    /// What changes nothing of it.
    pub unfelt: Unfelt,
    /// A twist of the bodies by which the position may be off.
    pub off: DVector<f64>,
    /// Part of the velocities by which they may be off.
    pub slower: f64,
}

/// Finds the steady motion near the start, and holds the stage in it.
pub fn find(stage: &mut Stage) -> Result<Found, AnalysisError> {
    let symmetries = Symmetries::new(stage)?;
    stage.momenta = Some(symmetries.momenta.clone());
    fits(stage)?;
    symmetries.keep_momenta(stage)?;
    within_reach(stage, &symmetries.momenta)?;
    settle(stage)?;
    let found = equilibrium::find(stage).map_err(|error| match error {
        AnalysisError::NoEquilibrium { residual, body, .. } => none(format!(
            "in the frame that moves along, a generalized force of {residual:.3e} N is left, most of it on body \"{body}\""
        )),
        other => other,
    })?;
    let unfelt = symmetries.unfelt(stage);
    let off = across(found.off(), &unfelt.drifts);
    stage.momenta = None;
    let flow = &stage.flow;
    let names = stage.mechanism.system.model.bodies.iter().map(|body| body.name.clone());
    let told = SteadyMotion {
        turning: flow.turning.into(),
        sliding: flow.at_origin(symmetries.momenta.least).into(),
        spins: names
            .zip(&flow.spins)
            .filter(|(_, spin)| spin.rate != 0.0)
            .map(|(body, spin)| BodySpin { body, rate: spin.rate })
            .collect(),
    };
    let slower = fits(stage)?;
    lasting::lasts(stage)?;
    stage.rest();
    Ok(Found { told, unfelt, off, slower })
}

/// A twist less its part along others.
fn across(twist: DVector<f64>, others: &DMatrix<f64>) -> DVector<f64> {
    if others.is_empty() {
        return twist;
    }
    let column = DMatrix::from_column_slice(twist.len(), 1, twist.as_slice());
    let along = least_squares(others, &column, 0.0).0;
    twist - (others * along).column(0)
}

/// Refuses what would take long: the momenta of all fields are kept at each position at which forces are looked at, four for each
/// freedom and step.
fn within_reach(stage: &mut Stage, momenta: &Momenta) -> Result<(), AnalysisError> {
    let (freedoms, fields) = (stage.freedoms(), momenta.fields.count());
    let work = [freedoms, stage.mechanism.system.bodies.len(), fields, fields].iter().product::<usize>();
    if work > MOST_WORK {
        return Err(AnalysisError::TooManySpins { spins: momenta.fields.spins(), freedoms });
    }
    Ok(())
}

fn none(reason: String) -> AnalysisError {
    AnalysisError::NoSteadyMotion { reason }
}

/// The motions of the whole that joints, drivers and loads do not feel.
struct Symmetries {
    /// Those along which the loads are carried along.
    alike: DMatrix<f64>,
    /// The steady motions that follow of the velocities at the start.
    momenta: Momenta,
}

impl Symmetries {
    fn new(stage: &mut Stage) -> Result<Self, AnalysisError> {
        let at = stage.places(&stage.q);
        let fields = Fields::new(&stage.mechanism.system.bodies, &at, stage.mechanism.system.length);
        let (twists, start) = (fields.twists(&at), stage.twists());
        let column = |vector: &DVector<f64>| DMatrix::from_column_slice(vector.len(), 1, vector.as_slice());
        let wanted = stage.rows_times(&column(&start)).column(0).into_owned();
        let mut allowed = Solutions::all(fields.count());
        // What joints or loads let pass at one position alone is no motion of the whole: others tell.
        let (from, turns) = (stage.q.clone(), stage.turns());
        for position in 0..POSITIONS {
            stage.move_beside(position)?;
            let twists = fields.twists(&stage.places(&stage.q));
            let rows = stage.rows_times(&twists);
            let any = fields.any(start.len(), position);
            let size = stage.rows_times(&column(&any)).norm();
            // Rest meets all rows but those of drivers: these are missed if any are.
            let mut passive = rows.clone();
            for (mut row, wanted_there) in passive.row_iter_mut().zip(wanted.iter()) {
                if wanted_there.abs() > MISSED * wanted.amax() {
                    row.fill(0.0);
                }
            }
            allowed.without(&passive, MISSED * size);
            allowed.narrow(&rows, &wanted, MISSED * size);
            let (changes, smallest) = changes_of_loads(stage, &fields, &twists);
            allowed.without(&changes, smallest);
            stage.put_back(&from, &turns);
        }
        let alike = allowed.free.clone();
        // What moves freely as a whole goes on uniformly, and its axis of turning with it.
        let mut whole = Solutions { one: DVector::zeros(fields.count()), free: alike.clone() };
        whole.without(&DMatrix::identity(fields.count(), fields.count()).remove_rows(3, 3), MISSED);
        whole.without(&stage.resistance(&twists), MISSED);
        let translations = whole.free.clone();
        let bodies = &stage.mechanism.system.bodies;
        let moving = energetic(bodies, &at, twists);
        let mut velocities = energetic(bodies, &at, column(&start)).column(0).into_owned();
        let size = moving.norm() * velocities.norm();
        whole.narrow(&moving, &velocities, MISSED * moving.norm());
        velocities -= &moving * &whole.one;
        let momenta = moving.tr_mul(&velocities);
        allowed.without(&turned_momenta(&alike, &momenta), MISSED * size);
        let momenta = Momenta {
            along: allowed.free.tr_mul(&momenta),
            carried: whole.one.fixed_rows::<3>(3).into_owned(),
            translations,
            least: MISSED * fields.size(&start),
            fields,
            allowed,
        };
        Ok(Self { alike, momenta })
    }

    /// Whether the loads leave the momenta along the motions of the whole as they are.
    fn keep_momenta(&self, stage: &mut Stage) -> Result<(), AnalysisError> {
        stage.rest();
        let twists = self.momenta.fields.twists(&stage.places(&stage.q)) * &self.momenta.allowed.free;
        let force = stage.forces();
        let along = twists.tr_mul(&force);
        if along.amax() <= (CHANGED * stage.largest(&force)).max(equilibrium::rounding(stage)) {
            return Ok(());
        }
        Err(none(format!(
            "where joints and drivers leave the bodies free to move as a whole, loads drive or brake them: a generalized force \
             of {:.3e} N is left there, most of it on body \"{}\"",
            along.amax(),
            stage.foremost(&force)
        )))
    }

    fn unfelt(&self, stage: &Stage) -> Unfelt {
        let (bodies, at) = (&stage.mechanism.system.bodies, stage.places(&stage.q));
        let fields = &self.momenta.fields;
        let twists = fields.twists(&at);
        let moving = energetic(bodies, &at, twists.clone());
        let translations = &self.momenta.translations;
        let momentum = (&moving * translations).tr_mul(&moving);
        let p = self.momenta.velocities(bodies, &at);
        let mut drifts = Solutions { one: DVector::zeros(p.len()), free: self.alike.clone() };
        drifts.without(&momentum, MISSED * momentum.norm());
        drifts.without(&fields.bracket(&p), MISSED * p.norm());
        Unfelt { translations: &twists * translations, drifts: twists * drifts.free }
    }
}

/// Takes a start that all but is a steady motion to that one, be it stable or not: the search that follows goes downhill.
fn settle(stage: &mut Stage) -> Result<(), AnalysisError> {
    let (from, turns, length) = (stage.q.clone(), stage.turns(), stage.mechanism.system.length);
    let mut way = 0.0;
    for _ in 0..STEPS {
        stage.wanted.check()?;
        let basis = stage.tangent()?;
        stage.rest();
        let multipliers = stage.accelerate().multipliers.solver_rows().to_vec();
        let stiffness = stage.stiffness(&basis, &multipliers);
        let along = basis.tr_mul(&stage.forces());
        let mut step = Solutions::all(along.len());
        step.narrow(&stiffness, &along, MISSED * stiffness.norm());
        let step = step.one;
        way += step.norm();
        if way > NEAR * length || stage.assemble(stage.moved(&(&basis * &step), 1.0)) > MISSED * length {
            stage.put_back(&from, &turns);
            break;
        }
        if step.norm() <= MISSED * length {
            break;
        }
    }
    Ok(())
}

/// How loads change when all is carried along each field, less how they would if they were carried along; and what of that is
/// none.
fn changes_of_loads(stage: &mut Stage, fields: &Fields, twists: &DMatrix<f64>) -> (DMatrix<f64>, f64) {
    let q = stage.q.clone();
    stage.place(&q);
    let loads = stage.loads();
    let mut out = twists.clone();
    for k in 0..twists.ncols() {
        let change = stage.slope(&twists.column(k).into_owned(), |stage| stage.loads());
        out.set_column(k, &(change - fields.turned(k, &loads)));
    }
    stage.place(&q);
    let length = stage.mechanism.system.length;
    for (k, mut row) in out.row_iter_mut().enumerate() {
        // Moments over the length are beside forces what these are.
        row /= if k % 6 >= 3 { length } else { 1.0 };
    }
    (out, CHANGED * equilibrium::largest_part(stage) / length)
}

/// Rows that are zero for motions along which the momenta stay in place: ⟨μ, [ξ, η]⟩ of each η in `alike`.
fn turned_momenta(alike: &DMatrix<f64>, momenta: &DVector<f64>) -> DMatrix<f64> {
    let part = |p: &DVector<f64>, first: usize| p.fixed_rows::<3>(first).into_owned();
    let (angular, linear) = (part(momenta, 0), part(momenta, 3));
    let mut out = DMatrix::zeros(alike.ncols(), alike.nrows());
    for (mut row, column) in out.row_iter_mut().zip(alike.column_iter()) {
        let (turning, sliding) = (part(&column.into_owned(), 0), part(&column.into_owned(), 3));
        let along_turns = turning.cross(&angular) + sliding.cross(&linear);
        row.columns_mut(0, 3).copy_from(&along_turns.transpose());
        row.columns_mut(3, 3).copy_from(&turning.cross(&linear).transpose());
    }
    out
}

/// Whether joints and drivers allow the steady motion at the held position; by what part of the velocities it misses them.
fn fits(stage: &mut Stage) -> Result<f64, AnalysisError> {
    stage.rest();
    let fastest = largest_size(&stage.q_dot).max(f64::MIN_POSITIVE);
    let system = &stage.mechanism.system;
    let rates = violation::rates(system, &stage.mechanism.state);
    let worst = violation::worst(&rates).into_iter().next();
    match worst {
        Some((id, rate)) if rate > MISSED * fastest => Err(none(format!(
            "\"{}\" does not let the bodies keep their places in one frame that turns and slides uniformly (a body may spin \
             only about an axis around which its moments of inertia are alike)",
            system[id].name
        ))),
        worst => Ok(worst.map_or(0.0, |(_, rate)| rate / fastest)),
    }
}
