//! Resolving names, points and vectors of the elements of a scene.

use super::error::{GeometryFault, NamedElement};
use super::output::{WITH_ANGLE, WITH_SLIDE};
use super::{BodyRef, MAX_LENGTH, ModelBody, ModelError, ModelJoint, finite, within};
use crate::model::motion::{Curve, VectorCurve};
use crate::scene::{GROUND, JointKind, Motion, Triple, VectorMotion};
use nalgebra::Vector3;
use std::collections::HashMap;
use triad_scene::text::nearest_name;

/// Greatest number of coefficients of a polynomial.
const MAX_COEFFICIENTS: usize = 32;
/// Greatest number of points of a table.
const MAX_POINTS: usize = 10_000;

/// What is known while the elements of one list are read.
pub(super) struct ModelReader<'a> {
    /// Which list: `joints`, `drivers`, `loads`, `markers` or `events`.
    pub list: &'static str,
    /// Place in that list.
    pub index: usize,
    /// Name of the element.
    pub name: &'a str,
    /// Names of bodies.
    pub names: &'a HashMap<String, usize>,
    /// The bodies.
    pub bodies: &'a [ModelBody],
    /// The joints, for drivers and loads that act in one.
    pub joints: &'a [ModelJoint],
    /// End of the run, s: up to there a formula must be defined.
    pub duration: f64,
}

impl ModelReader<'_> {
    /// JSON pointer of a key of the element.
    pub fn at(&self, key: &str) -> String {
        format!("/{}/{}/{key}", self.list, self.index)
    }

    /// The element, by its kind and name.
    fn element(&self) -> String {
        format!("{} \"{}\"", self.list.trim_end_matches('s'), self.name)
    }

    /// An error about a key of the element.
    pub fn wrong(&self, key: &str, reason: impl Into<String>) -> ModelError {
        self.faulty(key, GeometryFault::Other, reason)
    }

    /// An error of a known kind about a key of the element.
    pub fn faulty(&self, key: &str, fault: GeometryFault, reason: impl Into<String>) -> ModelError {
        ModelError::Geometry { element: self.element(), pointer: self.at(key), reason: reason.into(), fault }
    }

    /// An error about the name of another element, which is none of the known ones.
    pub fn unknown<'a>(
        &self,
        key: &str,
        what: NamedElement,
        name: &str,
        known: impl Iterator<Item = &'a str>,
    ) -> ModelError {
        ModelError::UnknownName {
            element: self.element(),
            pointer: self.at(key),
            what,
            name: name.to_owned(),
            nearest: nearest_name(name, known),
        }
    }

    /// A body by its name.
    ///
    /// # Errors
    ///
    /// [`ModelError`]: no body of that name, with the nearest one.
    pub fn body(&self, key: &str, name: &str) -> Result<BodyRef, ModelError> {
        if name == GROUND {
            return Ok(BodyRef::Ground);
        }
        let known = || self.bodies.iter().map(|body| body.name.as_str());
        let found = self.names.get(name).map(|&body| BodyRef::Moving(body));
        found.ok_or_else(|| self.unknown(key, NamedElement::Body, name, known()))
    }

    /// A moving body by its name.
    ///
    /// # Errors
    ///
    /// [`ModelError`]: no body of that name, or the ground.
    pub fn moving_body(&self, key: &str, name: &str) -> Result<usize, ModelError> {
        match self.body(key, name)? {
            BodyRef::Moving(body) => Ok(body),
            BodyRef::Ground => Err(self.wrong(key, "it acts on the ground, which cannot move")),
        }
    }

    /// A joint by its name, of one of the given kinds.
    ///
    /// # Errors
    ///
    /// [`ModelError`]: no joint of that name, or one of another kind.
    pub fn joint(&self, name: &str, kinds: &[JointKind]) -> Result<usize, ModelError> {
        let key = if self.list == "events" { "of/joint" } else { "joint" };
        let Some(index) = self.joints.iter().position(|j| j.name == name) else {
            // A gear knows the joints before it.
            let what = if self.list == "joints" { NamedElement::JointBefore } else { NamedElement::Joint };
            return Err(self.unknown(key, what, name, self.joints.iter().map(|j| j.name.as_str())));
        };
        let kind = self.joints[index].kind();
        if kinds.contains(&kind) {
            return Ok(index);
        }
        let kinds: Vec<String> = kinds.iter().map(JointKind::to_string).collect();
        let reason = format!("joint \"{name}\" is {kind}, and it needs one that is {}", kinds.join(" or "));
        Err(self.wrong(key, reason))
    }

    /// A joint whose angle is measured.
    ///
    /// # Errors
    ///
    /// [`ModelError`]: no joint of that name, or one without an angle.
    pub fn joint_with_angle(&self, name: &str) -> Result<usize, ModelError> {
        self.joint(name, &WITH_ANGLE)
    }

    /// A joint whose displacement along its axis is measured.
    ///
    /// # Errors
    ///
    /// [`ModelError`]: no joint of that name, or one without a displacement.
    pub fn joint_with_displacement(&self, name: &str) -> Result<usize, ModelError> {
        self.joint(name, &WITH_SLIDE)
    }

    /// Finite numbers as a vector.
    ///
    /// # Errors
    ///
    /// [`ModelError`]: a number that is not finite.
    pub fn vector(&self, key: &str, value: Triple) -> Result<Vector3<f64>, ModelError> {
        within(&value, MAX_LENGTH, &self.at(key))?;
        Ok(Vector3::from(value))
    }

    /// A direction, made a unit vector.
    ///
    /// # Errors
    ///
    /// [`ModelError`]: a number that is not finite, or a vector without length.
    pub fn unit(&self, key: &str, value: Triple) -> Result<Vector3<f64>, ModelError> {
        let unit = self.vector(key, value)?.try_normalize(1e-12);
        unit.ok_or_else(|| self.faulty(key, GeometryFault::NoLength, "the vector has no length"))
    }

    /// A finite number in a range.
    ///
    /// # Errors
    ///
    /// [`ModelError`]: a number that is not finite, or outside the range.
    pub fn number(&self, key: &str, value: f64, low: f64, high: f64) -> Result<f64, ModelError> {
        if value >= low && value <= high {
            Ok(value)
        } else {
            Err(ModelError::OutOfRange { pointer: self.at(key), value, low, high })
        }
    }

    /// A point of the author's frame in the principal frame of a body.
    pub fn local_point(&self, body: BodyRef, point: &Vector3<f64>) -> Vector3<f64> {
        match body {
            BodyRef::Ground => *point,
            BodyRef::Moving(body) => self.bodies[body].point_to_principal(point),
        }
    }

    /// A vector of the author's frame in the principal frame of a body.
    pub fn local_vector(&self, body: BodyRef, vector: &Vector3<f64>) -> Vector3<f64> {
        match body {
            BodyRef::Ground => *vector,
            BodyRef::Moving(body) => self.bodies[body].vector_to_principal(vector),
        }
    }

    /// A point of the world at the start in the principal frame of a body.
    pub fn point_from_world(&self, body: BodyRef, world: &Vector3<f64>) -> Vector3<f64> {
        match body {
            BodyRef::Ground => *world,
            BodyRef::Moving(body) => {
                let body = &self.bodies[body];
                body.directors.tr_mul(&(world - body.position))
            }
        }
    }

    /// A vector of the world at the start in the principal frame of a body.
    pub fn vector_from_world(&self, body: BodyRef, world: &Vector3<f64>) -> Vector3<f64> {
        match body {
            BodyRef::Ground => *world,
            BodyRef::Moving(body) => self.bodies[body].directors.tr_mul(world),
        }
    }

    /// World position at the start of a point in the principal frame.
    pub fn point_to_world(&self, body: BodyRef, local: &Vector3<f64>) -> Vector3<f64> {
        match body {
            BodyRef::Ground => *local,
            BodyRef::Moving(body) => {
                let body = &self.bodies[body];
                body.position + body.directors * local
            }
        }
    }

    /// World components at the start of a vector in the principal frame.
    pub fn vector_to_world(&self, body: BodyRef, local: &Vector3<f64>) -> Vector3<f64> {
        match body {
            BodyRef::Ground => *local,
            BodyRef::Moving(body) => self.bodies[body].directors * local,
        }
    }

    /// A checked motion.
    ///
    /// # Errors
    ///
    /// [`ModelError`]: a number that is not finite, a table whose times do not increase, or too many terms.
    pub fn curve(&self, key: &str, motion: &Motion) -> Result<Curve, ModelError> {
        let numbers: Vec<f64> = match motion {
            Motion::Constant { value } => vec![*value],
            Motion::Ramp { start, rate } => vec![*start, *rate],
            Motion::Polynomial { coefficients } => {
                if coefficients.is_empty() || coefficients.len() > MAX_COEFFICIENTS {
                    let reason = format!("a polynomial needs 1 to {MAX_COEFFICIENTS} coefficients");
                    return Err(self.wrong(key, reason));
                }
                coefficients.clone()
            }
            &Motion::Harmonic { mean, amplitude, frequency, phase } => {
                vec![mean, amplitude, frequency, phase]
            }
            &Motion::SmoothStep { from, to, start, end } => {
                if end - start < 1e-9 {
                    return Err(self.wrong(key, "a smooth step must end after it starts"));
                }
                vec![from, to, start, end]
            }
            Motion::Table { times, values } => {
                let increasing = times.windows(2).all(|w| w[1] - w[0] > 1e-12);
                if times.len() != values.len() || !(2..=MAX_POINTS).contains(&times.len()) || !increasing {
                    let reason =
                        format!("a table needs 2 to {MAX_POINTS} increasing times and as many values");
                    return Err(self.wrong(key, reason));
                }
                times.iter().chain(values).copied().collect()
            }
            Motion::Expression { .. } => Vec::new(),
        };
        finite(&numbers, &self.at(key))?;
        let mut curve = Curve::new(motion).map_err(|error| self.wrong(key, error.to_string()))?;
        if let Curve::Formula(formula) = &mut curve {
            if let Some(time) = formula.undefined_until(self.duration) {
                let reason = format!(
                    "its formula has no power series at t = {time:.9} s, within the run of {} s: its value or a derivative of it is infinite there, or \
                     too large for numbers on the way to it",
                    self.duration
                );
                return Err(self.faulty(key, GeometryFault::NoSeries, reason));
            }
            formula.find_wakes(self.duration);
        }
        Ok(curve)
    }

    /// A checked vector motion.
    ///
    /// # Errors
    ///
    /// [`ModelError`]: as for [`ModelReader::curve`], or an axis without length.
    pub fn vector_curve(&self, key: &str, motion: &VectorMotion) -> Result<VectorCurve, ModelError> {
        match motion {
            VectorMotion::Fixed { vector } => finite(vector, &self.at(key))?,
            VectorMotion::Components { .. } => {}
            VectorMotion::Turning { start, axis, .. } => {
                finite(start, &self.at(&format!("{key}/start")))?;
                self.unit(&format!("{key}/axis"), *axis)?;
            }
        }
        VectorCurve::made_of(motion, |name, motion| self.curve(&format!("{key}/{name}"), motion))
    }
}
