//! Loads at several states at once — THEORY section 6.

use super::TreeLanes;
use crate::integrate::in_chart::tree::Tree;
use crate::integrate::wide::{MOST_LANES, Stored, Wide, WidePair, WidePlacement, WideVector};
use nalgebra::Vector3;
use pulp::Simd;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::model::motion::VectorCurve;
use triad_dynamics::model::{BodyRef, ForceLaw};
use triad_dynamics::scene::LoadFrame;
use triad_dynamics::system::System;
use triad_dynamics::system::feature::Difference;
use triad_dynamics::system::index::FeatureId;
use triad_dynamics::system::load::SystemLoad;

/// The angle of a joint as a coordinate of the tree, times a factor and from an offset on.
#[derive(Clone, Copy, Debug)]
pub struct Torsion {
    place: usize,
    factor: f64,
    offset: f64,
}

/// The angles that loads act about, for a mechanism where all coordinates of its tree are zero. `None` if a load asks for a state in place.
pub fn torsions(mechanism: &Mechanism, tree: &Tree) -> Option<Vec<Option<Torsion>>> {
    let system = &mechanism.system;
    let driven = |id: &FeatureId| system[*id].curve.is_some();
    let strange = system.loads.iter().any(|load| load.features().iter().any(driven));
    if strange || !system.model.custom_loads.is_empty() {
        return None;
    }
    let torsions = system.loads.iter().map(|load| match load {
        SystemLoad::Torsion { angle, axis, bodies, .. } => {
            torsion(mechanism, tree, (*angle, *axis, *bodies)).map(Some)
        }
        _ => Some(None),
    });
    torsions.collect()
}

/// The angle about an axis between two bodies, if one coordinate of the tree turns the one against the other.
fn torsion(
    Mechanism { state, .. }: &Mechanism,
    tree: &Tree,
    (angle, axis, bodies): (usize, FeatureId, [BodyRef; 2]),
) -> Option<Torsion> {
    let (place, factor) = tree.turn_between(state, bodies, axis)?;
    Some(Torsion { place, factor, offset: state.angles()[angle].value })
}

/// A feature at several states: its value, seen from the point of reference if it is a point, and its rate.
struct WideFeature<S: Simd> {
    body: BodyRef,
    point: bool,
    value: WideVector<S>,
    rate: WideVector<S>,
}

/// Loads and where they act, for the power of those without potential.
struct Acting<'a> {
    system: &'a System,
    times: Stored,
}

impl TreeLanes {
    /// Adds all loads to what bodies lack, and finds the power of those without potential.
    #[inline(always)]
    pub(super) fn apply_loads<S: Simd>(&mut self, simd: S, system: &System) {
        let mut power = Wide::all(simd, 0.0);
        let acting = Acting { system, times: self.at.times };
        for (place, load) in system.loads.iter().enumerate() {
            power = power + self.apply(simd, &acting, (place, load));
        }
        power.store(&mut self.at.power);
    }

    /// Adds a load. Returns the power of what is not its spring.
    #[inline(always)]
    fn apply<S: Simd>(&mut self, simd: S, acting: &Acting, (index, load): (usize, &SystemLoad)) -> Wide<S> {
        let system = acting.system;
        match load {
            SystemLoad::Spring { from, to, law } => {
                let from = self.feature(simd, system, *from);
                let to = self.feature(simd, system, *to);
                let (between, rate) = (to.value - from.value, to.rate - from.rate);
                let length = between.dot(between).root();
                let direction = between.times(inverse(simd, length));
                let speed = direction.dot(rate);
                let (force, without) = acting.law(simd, law, length, speed);
                let force = direction.times(force);
                self.push(simd, &to, force);
                self.push(simd, &from, force.times(Wide::all(simd, -1.0)));
                without * speed
            }
            SystemLoad::Torsion { axis, bodies, law, .. } => {
                let Some(Torsion { place, factor, offset }) = self.torsions[index] else {
                    return Wide::all(simd, f64::NAN);
                };
                let factor = Wide::all(simd, factor);
                let speed = factor * Wide::load(simd, &self.at.rates[place]);
                let angle = Wide::all(simd, offset).plus(factor, Wide::load(simd, &self.at.places[place]));
                let (moment, without) = acting.law(simd, law, angle, speed);
                let moment = self.feature(simd, system, *axis).value.times(moment);
                self.turn(simd, bodies[0], moment.times(Wide::all(simd, -1.0)));
                self.turn(simd, bodies[1], moment);
                without * speed
            }
            SystemLoad::Slider { axis, between, law } => self.slide(simd, acting, (*axis, *between), law),
            SystemLoad::Force { body, local, force, frame } => {
                let force = self.given(simd, acting, *body, force, *frame);
                let at = WidePlacement::load(simd, &self.bodies[*body].place);
                let velocity = WidePair::load(simd, &self.bodies[*body].velocity);
                let value = at.turned(WideVector::all(simd, local)) + at.at;
                let point = WideFeature {
                    body: BodyRef::Moving(*body),
                    point: true,
                    value,
                    rate: velocity.moving + velocity.turning.cross(value),
                };
                self.push(simd, &point, force);
                force.dot(point.rate)
            }
            SystemLoad::Moment { body, moment, frame } => {
                let moment = self.given(simd, acting, *body, moment, *frame);
                self.turn(simd, BodyRef::Moving(*body), moment);
                moment.dot(WideVector::load(simd, &self.bodies[*body].velocity[0]))
            }
        }
    }

    /// Adds a load along the axis of a joint.
    #[inline(always)]
    fn slide<S: Simd>(
        &mut self,
        simd: S,
        acting: &Acting,
        (axis, between): (FeatureId, Difference),
        law: &ForceLaw,
    ) -> Wide<S> {
        let system = acting.system;
        let axis = self.feature(simd, system, axis);
        let plus = self.feature(simd, system, between.plus);
        let minus = match between.minus {
            Some(id) => self.feature(simd, system, id),
            None => self.origin(simd),
        };
        let (apart, rate) = (plus.value - minus.value, plus.rate - minus.rate);
        let speed = axis.value.dot(rate) + axis.rate.dot(apart);
        let (force, without) = acting.law(simd, law, axis.value.dot(apart), speed);
        self.push(simd, &plus, axis.value.times(force));
        self.push(simd, &minus, axis.value.times(-force));
        self.push(simd, &axis, apart.times(force));
        without * speed
    }

    /// A prescribed force or moment in the world.
    #[inline(always)]
    fn given<S: Simd>(
        &self,
        simd: S,
        acting: &Acting,
        body: usize,
        curve: &VectorCurve,
        frame: LoadFrame,
    ) -> WideVector<S> {
        let mut vectors = [[0.0; MOST_LANES]; 3];
        for (lane, time) in acting.times.iter().enumerate().take(S::F64_LANES) {
            let vector: Vector3<f64> = curve.at(*time)[0];
            for (lanes, x) in vectors.iter_mut().zip(vector.iter()) {
                lanes[lane] = *x;
            }
        }
        let vector = WideVector::load(simd, &vectors);
        match frame {
            LoadFrame::World => vector,
            LoadFrame::Body => WidePlacement::load(simd, &self.bodies[body].place).turned(vector),
        }
    }

    /// The origin of the world.
    #[inline(always)]
    fn origin<S: Simd>(&self, simd: S) -> WideFeature<S> {
        let rest = WideVector::all(simd, &Vector3::zeros());
        let value = rest - WideVector::all(simd, &self.center);
        WideFeature { body: BodyRef::Ground, point: true, value, rate: rest }
    }

    #[inline(always)]
    fn feature<S: Simd>(&self, simd: S, system: &System, id: FeatureId) -> WideFeature<S> {
        let feature = &system[id];
        let (body, point) = (feature.body, feature.point);
        let local = WideVector::all(simd, &feature.local);
        let BodyRef::Moving(index) = body else {
            let origin = WideVector::all(simd, &self.center);
            let value = if point { local - origin } else { local };
            return WideFeature { body, point, value, rate: WideVector::all(simd, &Vector3::zeros()) };
        };
        let place = WidePlacement::load(simd, &self.bodies[index].place);
        let velocity = WidePair::load(simd, &self.bodies[index].velocity);
        let arm = place.turned(local);
        let value = if point { arm + place.at } else { arm };
        let turning = velocity.turning.cross(value);
        WideFeature { body, point, value, rate: if point { velocity.moving + turning } else { turning } }
    }

    /// Adds a force on a feature.
    #[inline(always)]
    fn push<S: Simd>(&mut self, simd: S, at: &WideFeature<S>, force: WideVector<S>) {
        self.turn(simd, at.body, at.value.cross(force));
        if let (BodyRef::Moving(body), true) = (at.body, at.point) {
            let sum = &mut self.bodies[body].lacking[1];
            (WideVector::load(simd, sum) + force).store(sum);
        }
    }

    /// Adds a moment on a body.
    #[inline(always)]
    fn turn<S: Simd>(&mut self, simd: S, body: BodyRef, moment: WideVector<S>) {
        if let BodyRef::Moving(body) = body {
            let sum = &mut self.bodies[body].lacking[0];
            (WideVector::load(simd, sum) + moment).store(sum);
        }
    }
}

impl Acting<'_> {
    /// The force or moment of a law, and that without its spring.
    #[inline(always)]
    fn law<S: Simd>(&self, simd: S, law: &ForceLaw, x: Wide<S>, rate: Wide<S>) -> (Wide<S>, Wide<S>) {
        let without = if law.drive.is_none() && law.friction.is_none() {
            rate * Wide::all(simd, -law.damping)
        } else {
            rate.each(|lane, rate| law.without_spring(rate, self.times[lane]))
        };
        (without.less(x - Wide::all(simd, law.free), Wide::all(simd, law.stiffness)), without)
    }
}

/// 1/x of lengths; zero of none: a spring of no length has no direction to pull in.
#[inline(always)]
fn inverse<S: Simd>(simd: S, length: Wide<S>) -> Wide<S> {
    let mut lanes = [1.0; MOST_LANES];
    length.store(&mut lanes);
    if lanes.iter().any(|x| *x <= f64::MIN_POSITIVE) {
        return length.each(|_, x| if x <= f64::MIN_POSITIVE { 0.0 } else { 1.0 / x });
    }
    Wide::all(simd, 1.0) / length
}
