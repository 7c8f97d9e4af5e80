//! Whether a motion that is steady now goes on as it is.

use super::{CHANGED, none};
use crate::analysis::momenta::MISSED;
use crate::analysis::{AnalysisError, Stage, equilibrium};
use nalgebra::{DVector, Rotation3, Vector3};
use triad_dynamics::constraints::violation;
use triad_dynamics::system::load::SystemLoad;

/// Angle or, in lengths of the mechanism, way after which it is seen first whether the motion is steady.
const LATER: f64 = 0.7;
/// Further instants about a turn, in times of the first: roots of primes, that no period fits all of them.
const TURNED: [f64; 3] = [2.236_067_977_499_79, 4.123_105_625_617_661, 7.810_249_675_906_654];
/// Further instants in parts of the scene's duration: roots of 1/131, 1/31, 1/11, 1/5, 1/3, 1/2, 2/3 and 6/7.
const PARTS: [f64; 8] = [
    0.087_370_406_443_0,
    0.179_605_302_026_8,
    0.301_511_344_577_8,
    0.447_213_595_499_9,
    0.577_350_269_189_6,
    std::f64::consts::FRAC_1_SQRT_2,
    0.816_496_580_927_7,
    0.925_820_099_772_6,
];
/// Pieces of what is prescribed that are looked at, each in its midst.
const PIECES: usize = 64;
/// Part of the largest force of a spring, were it as long as its place is known to be, that rounding of a place leaves.
const ROUNDED: f64 = 1e-12;

/// Refuses a motion that does not go on as it is: at later instants joints and drivers are met, loads prescribe what they do now,
/// and the forces are those of now, moved along.
pub(super) fn lasts(stage: &mut Stage) -> Result<(), AnalysisError> {
    stage.rest();
    let now = Now::new(stage);
    let turns = stage.turns();
    let rates: Vec<f64> = stage.mechanism.state.angles().iter().map(|angle| angle.rate).collect();
    let told = instants(stage, now.speed).into_iter().try_for_each(|time| {
        let later = turns.iter().zip(&rates).map(|(turn, rate)| turn + rate * time);
        stage.mechanism.state.set_revolutions(later);
        now.goes_on(stage, time)
    });
    stage.mechanism.state.set_revolutions(turns.into_iter());
    told
}

/// Times after which the motion is looked at, s.
fn instants(stage: &Stage, speed: f64) -> Vec<f64> {
    let duration = stage.mechanism.system.model.settings.duration;
    let first = LATER / speed.max(LATER);
    let mut out = vec![first];
    out.extend(TURNED.iter().map(|k| k * first).filter(|time| *time <= duration));
    out.extend(PARTS.iter().map(|part| part * duration));
    let mut from = stage.time;
    for _ in 0..PIECES {
        let next = stage.mechanism.system.next_break(from);
        if next - stage.time > duration {
            break;
        }
        out.push(0.5 * (from + next) - stage.time);
        from = next;
    }
    out
}

/// The steady motion at its start.
struct Now {
    /// Of turning, spinning, and sliding by lengths of the mechanism, the fastest, 1/s.
    speed: f64,
    /// Forces and moments of the loads.
    loads: DVector<f64>,
    /// What of a force is none, N.
    nothing: f64,
    /// What loads prescribe.
    prescribed: Vec<Option<Prescribed>>,
}

impl Now {
    fn new(stage: &Stage) -> Self {
        let (flow, length) = (&stage.flow, stage.mechanism.system.length);
        let turning = flow.spins.iter().fold(flow.turning.norm(), |a, spin| a.max(spin.rate.abs()));
        let loads = stage.loads();
        // What keeps bodies on their circles is a measure as well.
        let largest = stage.largest(&loads).max(stage.largest(&(stage.forces() - &loads)));
        let rounding = ROUNDED * equilibrium::largest_part(stage);
        Self {
            speed: turning.max(flow.sliding.norm() / length),
            loads,
            nothing: (CHANGED * largest).max(rounding),
            prescribed: prescribed(stage, stage.time),
        }
    }

    /// Refuses a motion that is another one a time later.
    fn goes_on(&self, stage: &mut Stage, time: f64) -> Result<(), AnalysisError> {
        let turn = Rotation3::from_scaled_axis(stage.flow.turning * time);
        let mut turned = self.loads.clone();
        for k in (0..turned.len()).step_by(3) {
            let part = turn * turned.fixed_rows::<3>(k).into_owned();
            turned.fixed_rows_mut::<3>(k).copy_from(&part);
        }
        let mut q = stage.q.clone();
        for (index, body) in stage.mechanism.system.bodies.iter().enumerate() {
            body.layout.store(&stage.flow.later(index, &body.layout.position(&stage.q), time), &mut q);
        }
        let y = [q.as_slice(), stage.velocities(&q).as_slice()].concat();
        stage.mechanism.set_state(stage.time + time, &y);
        // Velocities are not known better than this, and places the less the farther all has come.
        let way = (self.speed * time / LATER).max(1.0);
        let system = &stage.mechanism.system;
        let open = violation::measure(system, &stage.mechanism.state).constraints;
        if let Some((id, by)) = open.first().copied().filter(|(_, by)| *by > MISSED * way) {
            return Err(none(format!(
                "\"{}\" does not go on as at the start: it is off by {by:.3e} after {time:.3} s",
                system[id].name
            )));
        }
        let then = prescribed(stage, stage.time + time);
        let changed = self.prescribed.iter().zip(&then).position(|pair| match pair {
            (Some(now), Some(then)) => now.turned(&turn).differs(then, self.nothing),
            _ => false,
        });
        if let Some(load) = changed {
            let name = &system.model.loads[load].name;
            return Err(none(format!(
                "what load \"{name}\" prescribes after {time:.3} s is not what it prescribes at the start"
            )));
        }
        let changed = stage.loads() - &turned;
        if stage.largest(&changed) > self.nothing * way {
            return Err(none(format!(
                "the forces on body \"{}\" change in the frame that moves along: weight and springs to the ground stay the same \
                 only about an axis along them",
                stage.foremost(&changed)
            )));
        }
        Ok(())
    }
}

/// What a load prescribes as a function of time: forces, or moments over the mechanism's length, N.
enum Prescribed {
    /// Along an axis or a line.
    Along(f64),
    /// In the world.
    Vector(Vector3<f64>),
}

impl Prescribed {
    fn turned(&self, turn: &Rotation3<f64>) -> Self {
        match self {
            Self::Along(force) => Self::Along(*force),
            Self::Vector(force) => Self::Vector(turn * force),
        }
    }

    /// Whether another one is not the same: changes below a part of both, or below `nothing`, are none.
    fn differs(&self, other: &Self, nothing: f64) -> bool {
        let (change, size) = match (self, other) {
            (Self::Along(a), Self::Along(b)) => ((a - b).abs(), a.abs().max(b.abs())),
            (Self::Vector(a), Self::Vector(b)) => ((a - b).norm(), a.norm().max(b.norm())),
            _ => return true,
        };
        change > (CHANGED * size).max(nothing)
    }
}

/// What each load prescribes at a time, at the state taken over last; `None` of those that depend on positions and velocities alone.
fn prescribed(stage: &Stage, time: f64) -> Vec<Option<Prescribed>> {
    let (system, state) = (&stage.mechanism.system, &stage.mechanism.state);
    let of = |load: &SystemLoad| match load {
        SystemLoad::Force { .. } => load.given(state).map(Prescribed::Vector),
        SystemLoad::Moment { .. } => {
            load.given(state).map(|moment| Prescribed::Vector(moment / system.length))
        }
        SystemLoad::Spring { law, .. } | SystemLoad::Slider { law, .. } => {
            law.drive.as_ref().map(|drive| Prescribed::Along(drive.at(time)[0]))
        }
        SystemLoad::Torsion { law, .. } => {
            law.drive.as_ref().map(|drive| Prescribed::Along(drive.at(time)[0] / system.length))
        }
    };
    system.loads.iter().map(of).collect()
}
