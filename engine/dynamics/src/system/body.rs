//! A body as the equations of motion see it, in space and in a plane.

use crate::model::ModelBody;
use crate::scene::Coordinates;
use crate::system::natural::{Layout, NaturalCoordinates};
use nalgebra::{Matrix3, Vector3};

/// Principal moment of inertia, relative to m l² with l the longest arm of the body's own joints and loads, below which the inertia is
/// regularized: S would be too ill-conditioned to be factored. It has to be small: what turns about such an axis by itself, like a wire in a
/// hinge, is then moved by its inertia and δ, and the iteration that takes δ out again hardly gets on.
pub const LACKING: f64 = 1e-9;
/// δ over m l² of a body that lacks inertia, at most and at least — eq. (7.8).
const REGULARIZING_INERTIA: f64 = 1e-4;
const LEAST_REGULARIZING: f64 = 1e-6;
/// δ over the least moment of inertia of all bodies, between these: the iteration that takes δ out again leaves δ/(δ + I) at each step, I the
/// inertia that joints lend, and rounding grows as δ falls.
const BELOW_LEAST: f64 = 0.1;
/// Principal moment of inertia, relative to the largest one, that is rounding: a tensor in numbers has no exact zero.
const NONE: f64 = 1e-14;

/// Arm, in lengths of the mechanism, below which none is taken for the radius of gyration in a measure of lengths: radii that
/// differ by more would hide rows behind rounding, as masses do.
const SHORT_ARM: f64 = 1e-2;

/// A body as the equations of motion see it.
#[derive(Clone, Debug)]
pub struct RigidBody {
    /// Mass m, kg.
    pub mass: f64,
    /// Principal moments of inertia, kg m².
    pub principal: Vector3<f64>,
    /// Ī of u, v, w: the diagonal of the constant mass matrix is (m, Ī_u, Ī_v, Ī_w) — eq. (6.2).
    pub ibar: Vector3<f64>,
    /// Inertia added to each principal moment in the factorization alone, for a body that has none about some
    /// axis; refinement takes its effect out again — THEORY section 7.
    pub regularizing_inertia: f64,
    /// Which coordinates describe it.
    pub coordinates: Coordinates,
    /// How its natural coordinates follow from q.
    pub layout: Layout,
    /// The bodies that it stands for, if it is described in a frame of its own: several that are rigidly joined, or one about its
    /// pivot. Their coordinates are those of q, and its own layout is not used.
    pub parts: Vec<BodyPart>,
    /// Its pose in the plane, in a system that has been reduced to one.
    pub planar_pose: Option<PlanarPose>,
    /// The point of the ground in which it is held, if it is described about that — eq. (7.10).
    pub pivot: Option<GroundPivot>,
}

/// A body in the frame of the one that stands for it, and perhaps for others.
#[derive(Clone, Copy, Debug)]
pub struct BodyPart {
    /// How its natural coordinates follow from q.
    pub layout: Layout,
    /// Its place in the frame of the whole.
    pub place: NaturalCoordinates,
}

/// A point of the ground that holds a point of a body, where the body's frame begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundPivot {
    /// That point.
    pub ground: Vector3<f64>,
    /// The centre of mass in the body's frame.
    pub center: Vector3<f64>,
}

/// The least moment of inertia of all bodies that is one, kg m²: infinite if there is none.
pub fn least_inertia<'a>(principal: impl Iterator<Item = &'a Vector3<f64>>) -> f64 {
    let own =
        |j: &Vector3<f64>| j.iter().copied().filter(|i| *i > NONE * j.max()).fold(f64::INFINITY, f64::min);
    principal.map(own).fold(f64::INFINITY, f64::min)
}

/// δ of a body with these least and greatest moments of inertia about its axes, kg m², among bodies whose least is `among`; zero if it lacks
/// none. `of_arm` is m l² of its longest arm, `of_length` that of the mechanism's length, for a body without arms.
pub fn regularizing_inertia([least, greatest]: [f64; 2], of_arm: f64, of_length: f64, among: f64) -> f64 {
    // A free body needs help only where a moment is missing.
    let lacks = least < LACKING * of_arm || (least <= NONE * greatest && of_arm == 0.0);
    if !lacks {
        return 0.0;
    }
    let scale = if of_arm == 0.0 { greatest.max(of_length) } else { of_arm };
    (BELOW_LEAST * among).max(LEAST_REGULARIZING * scale).min(REGULARIZING_INERTIA * scale)
}

impl RigidBody {
    /// A body of a model with its coordinates, the longest arm of its own joints and loads, m, a length of the mechanism, m, and the least
    /// moment of inertia of all bodies, kg m².
    pub fn new(body: &ModelBody, layout: Layout, arm: f64, length: f64, least: f64) -> Self {
        let j = body.principal;
        let half = 0.5 * j.sum();
        let [of_arm, of_length] = [arm, length].map(|l| body.mass * l * l);
        Self {
            mass: body.mass,
            principal: j,
            ibar: j.map(|i| (half - i).max(0.0)),
            regularizing_inertia: regularizing_inertia([j.min(), j.max()], of_arm, of_length, least),
            coordinates: body.coordinates,
            layout,
            parts: Vec::new(),
            planar_pose: None,
            pivot: None,
        }
    }

    /// Takes the δ of another description of the body, if both lack inertia: bodies that turn together about axes without some share the motion
    /// in the ratio of their δ.
    pub fn regularize_as(&mut self, other: f64) {
        if self.regularizing_inertia > 0.0 && other > 0.0 {
            self.regularizing_inertia = other;
        }
    }

    /// How far a point of its principal frame is from the axis about which it has no inertia, m, or from its centre of mass if that is every
    /// axis; zero if there is none.
    pub fn beside_lacking_axis(&self, point: &Vector3<f64>) -> f64 {
        let lacks = |k: &usize| self.principal[*k] < self.regularizing_inertia;
        let mut lacking = (0..3).filter(lacks);
        match (lacking.next(), lacking.next()) {
            (None, _) => 0.0,
            (Some(axis), None) => (point - Vector3::ith(axis, point[axis])).norm(),
            (Some(_), Some(_)) => point.norm(),
        }
    }

    /// Q of all generalized coordinates q.
    pub fn position(&self, q: &[f64]) -> NaturalCoordinates {
        let Some(part) = self.parts.first() else { return self.layout.position(q) };
        let carrier = part.layout.position(q).carrier(&part.place);
        NaturalCoordinates { r: self.pivot.map_or(carrier.r, |pivot| pivot.ground), ..carrier }
    }

    /// Q and Q̇ of all generalized coordinates and velocities.
    pub fn motion(&self, q: &[f64], q_dot: &[f64]) -> [NaturalCoordinates; 2] {
        let Some(part) = self.parts.first() else {
            let position = self.layout.position(q);
            return [position, self.layout.velocity(&position, q_dot)];
        };
        let velocity = part.layout.velocity(&part.layout.position(q), q_dot).carrier(&part.place);
        let r = if self.pivot.is_some() { Vector3::zeros() } else { velocity.r };
        [self.position(q), NaturalCoordinates { r, ..velocity }]
    }

    /// Writes the coordinates in q that a vector of its natural coordinates, a position or its rate or error, tells.
    pub fn store(&self, natural: &NaturalCoordinates, q: &mut [f64]) {
        if self.parts.is_empty() {
            self.layout.store(natural, q);
        }
        for part in &self.parts {
            part.layout.store(&natural.carried(&part.place), q);
        }
    }

    /// Gives it mass one and its arm as radius of gyration about every axis — eq. (8.2).
    pub fn measure_lengths(&mut self, arm: f64, length: f64) {
        let radius = arm.max(SHORT_ARM * length);
        let square = radius * radius;
        self.mass = 1.0;
        self.principal = Vector3::from_element(square);
        self.ibar = match self.planar_pose {
            None => Vector3::from_element(0.5 * square),
            Some(_) => Vector3::new(square, 0.0, 0.0),
        };
        self.regularizing_inertia = 0.0;
    }

    /// 1/m, or zero if it is held in a point of the ground.
    pub fn free_inverse_mass(&self) -> f64 {
        if self.pivot.is_some() { 0.0 } else { 1.0 / self.mass }
    }

    /// Where its weight acts, in its own frame.
    pub fn center(&self) -> Vector3<f64> {
        self.pivot.map_or_else(Vector3::zeros, |pivot| pivot.center)
    }

    /// Its weight as a generalized force.
    pub fn weight(&self, gravity: &Vector3<f64>) -> NaturalCoordinates {
        let (r, center) = (gravity * self.mass, self.center());
        NaturalCoordinates { r, e: [0, 1, 2].map(|k| r * center[k]) }
    }
}

/// The pose of a body in its plane: its directors where z = (1, 0), and its height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarPose {
    /// Directions in the plane and its normal, as columns.
    frame: Matrix3<f64>,
    /// Directors u, v, w as columns: along z, across z, along the normal.
    pub directors: Matrix3<f64>,
    /// Height of the centre of mass above the plane through the origin, m.
    pub height: f64,
    /// What the two numbers of z make of each director in space, and what is always there; the same of r.
    turned: [[Vector3<f64>; 3]; 3],
    moved: [Vector3<f64>; 3],
}

impl Default for PlanarPose {
    fn default() -> Self {
        Self::new(Matrix3::identity(), Matrix3::identity(), 0.0)
    }
}

impl PlanarPose {
    /// Of a body with these directors where z = (1, 0), and the height of its centre of mass, in a plane with two directions and a normal
    /// as columns.
    pub fn new(frame: Matrix3<f64>, directors: Matrix3<f64>, height: f64) -> Self {
        let turned = [0, 1, 2].map(|k| {
            let d = directors.column(k);
            [Vector3::new(d[0], d[1], 0.0), Vector3::new(-d[1], d[0], 0.0), Vector3::new(0.0, 0.0, d[2])]
                .map(|part| frame * part)
        });
        let moved = [Vector3::x(), Vector3::y(), height * Vector3::z()].map(|part| frame * part);
        Self { frame, directors, height, turned, moved }
    }

    /// (r, z) of a position or velocity in space.
    pub fn lower(&self, lift: &NaturalCoordinates) -> ([f64; 2], [f64; 2]) {
        let r = self.frame.tr_mul(&lift.r);
        let mut z = [0.0; 2];
        for (e, d) in lift.e.iter().zip(self.directors.column_iter()) {
            let e = self.frame.tr_mul(e);
            // e = z d as complex numbers; the squares of the three |d| make two.
            z[0] += 0.5 * (d[0] * e[0] + d[1] * e[1]);
            z[1] += 0.5 * (d[0] * e[1] - d[1] * e[0]);
        }
        ([r[0], r[1]], z)
    }

    /// Position, or velocity or acceleration if `rate`, in space of (r, z).
    pub fn raise(&self, r: [f64; 2], z: [f64; 2], rate: bool) -> NaturalCoordinates {
        let sum = |[first, second, always]: &[Vector3<f64>; 3], x: [f64; 2]| {
            first * x[0] + second * x[1] + if rate { Vector3::zeros() } else { *always }
        };
        let [u, v, w] = &self.turned;
        NaturalCoordinates { r: sum(&self.moved, r), e: [sum(u, z), sum(v, z), sum(w, z)] }
    }
}
