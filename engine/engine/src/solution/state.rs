//! A state of a motion, and what is known of its bodies without solving anything.

use crate::error::EngineError;
use crate::run::{Frame, MarkerFrame, Simulation};
use crate::scene::{BodyHandle, GROUND, MarkerHandle, Triple};
use nalgebra::Vector3;
use triad_dynamics::model::{Model, ModelBody};
use triad_dynamics::state::BodyFrame;

/// The bodies of a motion at one moment. Points and vectors are in the world.
///
/// ```
/// use triad_engine::prelude::*;
///
/// let mut scene = Scene::new("spin").gravity([0.0; 3]);
/// let top = scene.add(Body::new("top", 1.0).inertia(Inertia::Principal([1.0, 1.0, 2.0])).angular_velocity([0.0, 0.0, 3.0]));
/// let motion = scene.simulate(0.0..1.0)?;
/// let state = motion.at(0.5)?;
/// assert_eq!(state.position(&top)?, [0.0; 3]);
/// let error = state.position("topp").unwrap_err();
/// assert_eq!(error.to_string(), "there is no body \"topp\"");
/// assert_eq!(error.hint(), "Did you mean \"top\"?");
/// # Ok::<(), EngineError>(())
/// ```
#[derive(Clone, Debug)]
pub struct SolutionState<'a> {
    time: f64,
    bodies: Vec<BodyFrame>,
    markers: Vec<MarkerFrame>,
    model: &'a Model,
}

impl<'a> SolutionState<'a> {
    /// What a run shows.
    pub(super) fn of(model: &'a Model, run: &Simulation) -> Self {
        let Frame { time, bodies, markers } = run.frame();
        Self { time, bodies, markers, model }
    }

    /// Time t, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// All bodies, in the scene's order.
    pub fn bodies(&self) -> &[BodyFrame] {
        &self.bodies
    }

    /// Position r of a body's centre of mass in the world, m — eq. (2.2). That of the ground is the origin.
    ///
    /// # Errors
    ///
    /// [`EngineError::UnknownName`] for a body that the scene does not have; so for all that follow.
    pub fn position(&self, body: impl Into<BodyHandle>) -> Result<Triple, EngineError> {
        Ok(self.frame(body)?.1.position)
    }

    /// Velocity ṙ of a body's centre of mass in the world, m/s.
    ///
    /// # Errors
    ///
    /// [`EngineError`]: no body of that name.
    pub fn velocity(&self, body: impl Into<BodyHandle>) -> Result<Triple, EngineError> {
        Ok(self.frame(body)?.1.velocity)
    }

    /// Angular velocity ω of a body, components in the world, rad/s — eq. (6.4).
    ///
    /// # Errors
    ///
    /// [`EngineError`]: no body of that name.
    pub fn angular_velocity(&self, body: impl Into<BodyHandle>) -> Result<Triple, EngineError> {
        Ok(self.frame(body)?.1.angular_velocity)
    }

    /// Directors u, v, w of a body in the world: unit vectors along its principal axes of inertia — THEORY section 2.
    ///
    /// # Errors
    ///
    /// [`EngineError`]: no body of that name.
    pub fn directors(&self, body: impl Into<BodyHandle>) -> Result<[Triple; 3], EngineError> {
        let (_, frame) = self.frame(body)?;
        Ok([frame.u, frame.v, frame.w])
    }

    /// Place in the world, m, of a point of a body that is given in the body's own frame, m — eq. (2.2).
    ///
    /// # Errors
    ///
    /// [`EngineError`]: no body of that name.
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let mut scene = Scene::new("rod");
    /// let rod = scene.add(Body::rod("rod", 1.0, [0.0; 3], [0.0, 1.0, 0.0]));
    /// let motion = scene.simulate(0.0..1.0)?;
    /// let tip = motion.at(0.0)?.point(&rod, [0.5, 0.0, 0.0])?;
    /// assert!((tip[1] - 1.0).abs() < 1e-12, "u of a rod is along it, from its middle");
    /// # Ok::<(), EngineError>(())
    /// ```
    pub fn point(&self, body: impl Into<BodyHandle>, point: Triple) -> Result<Triple, EngineError> {
        let (model, frame) = self.frame(body)?;
        let Some(model) = model else { return Ok(point) };
        let local = model.point_to_principal(&Vector3::from(point));
        let directors = [frame.u, frame.v, frame.w].map(Vector3::from);
        let arm = directors[0] * local.x + directors[1] * local.y + directors[2] * local.z;
        Ok((Vector3::from(frame.position) + arm).into())
    }

    /// Position and velocity of a marker in the world, m and m/s.
    ///
    /// # Errors
    ///
    /// [`EngineError::UnknownName`] for a marker that the scene does not have.
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let mut scene = Scene::new("wheel").gravity([0.0; 3]);
    /// let wheel = scene.add(Body::sphere("wheel", 1.0, 1.0, [0.0; 3]).angular_velocity([0.0, 0.0, 2.0]));
    /// let rim = scene.add(Marker::new("rim", &wheel, [1.0, 0.0, 0.0]));
    /// let motion = scene.simulate(0.0..1.0)?;
    /// assert!((motion.at(0.5)?.marker(&rim)?.position[0] - 0.540_302_305_868_139_7).abs() < 1e-8);
    /// assert!((motion.at(0.0)?.marker(&rim)?.velocity[1] - 2.0).abs() < 1e-12);
    /// # Ok::<(), EngineError>(())
    /// ```
    pub fn marker(&self, marker: impl Into<MarkerHandle>) -> Result<MarkerFrame, EngineError> {
        let marker = marker.into();
        let known = || self.model.markers.iter().map(|known| known.name.as_str());
        let place = known().position(|name| name == marker.name());
        let found = place.and_then(|place| self.markers.get(place)).copied();
        found.ok_or_else(|| EngineError::unknown("marker", marker.name(), known()))
    }

    /// A body as it is shown, and its data where it moves.
    fn frame(&self, body: impl Into<BodyHandle>) -> Result<(Option<&ModelBody>, BodyFrame), EngineError> {
        let body = body.into();
        if body.name() == GROUND {
            return Ok((None, GROUND_FRAME));
        }
        let found = self.model.bodies.iter().zip(&self.bodies).find(|(model, _)| model.name == body.name());
        let known = || self.model.bodies.iter().map(|body| body.name.as_str());
        let (model, frame) = found.ok_or_else(|| EngineError::unknown("body", body.name(), known()))?;
        Ok((Some(model), *frame))
    }
}

/// The ground: the world's frame, at rest.
const GROUND_FRAME: BodyFrame = BodyFrame {
    position: [0.0; 3],
    u: [1.0, 0.0, 0.0],
    v: [0.0, 1.0, 0.0],
    w: [0.0, 0.0, 1.0],
    velocity: [0.0; 3],
    angular_velocity: [0.0; 3],
};
