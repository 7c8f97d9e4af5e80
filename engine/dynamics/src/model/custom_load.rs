//! Loads that a program gives as functions of the state. A scene's JSON cannot hold them.

use super::{Model, ModelBody};
use crate::scene::{BodyHandle, GROUND, Triple};
use nalgebra::Vector3;
use std::cell::RefCell;
use std::fmt;
use std::sync::Arc;

/// A force and a moment, components in the world.
///
/// ```
/// use triad_dynamics::model::Wrench;
///
/// let push = Wrench::force([2.0, 0.0, 0.0]).with_moment([0.0, 0.0, 0.5]);
/// assert_eq!(push.moment[2], 0.5);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Force f, N.
    pub force: Triple,
    /// Moment τ about the point at which the force acts, N m.
    pub moment: Triple,
}

impl Wrench {
    /// A force f, N, without a moment.
    pub fn force(force: Triple) -> Self {
        Self { force, moment: [0.0; 3] }
    }

    /// A moment τ, N m, without a force.
    pub fn moment(moment: Triple) -> Self {
        Self { force: [0.0; 3], moment }
    }

    /// The same force, with a moment τ about its point, N m.
    #[must_use]
    pub fn with_moment(self, moment: Triple) -> Self {
        Self { moment, ..self }
    }
}

/// What a [`CustomLoad`] may look at: the time, and where bodies are and how they move, in the world.
///
/// Bodies are named as in the scene, or by what [`Scene::add`](crate::scene::Scene::add) gave for them; the ground is at
/// rest. A name that the scene does not have gives NaN here, and ends the run with an error that tells it.
#[derive(Debug)]
pub struct LoadState<'a> {
    time: f64,
    bodies: &'a [ModelBody],
    motions: &'a dyn Motions,
    unknown: RefCell<Option<String>>,
}

/// How one body moves at one moment, in the world.
#[derive(Clone, Copy, Debug)]
pub struct BodyMotion {
    /// Position r of the centre of mass, m.
    pub position: Vector3<f64>,
    /// Directors u, v, w.
    pub directors: [Vector3<f64>; 3],
    /// Velocity ṙ of the centre of mass, m/s.
    pub velocity: Vector3<f64>,
    /// Angular velocity ω, rad/s.
    pub angular_velocity: Vector3<f64>,
}

/// Where the motions of bodies are read.
pub trait Motions: fmt::Debug {
    /// That of a body, by its place in the model.
    fn motion(&self, body: usize) -> BodyMotion;
}

impl LoadState<'_> {
    /// Time t, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Position r of a body's centre of mass, m — eq. (2.2). That of the ground is the origin.
    pub fn position(&self, body: impl AsRef<str>) -> Triple {
        self.of(body.as_ref(), |_, motion| motion.position)
    }

    /// Velocity ṙ of a body's centre of mass, m/s.
    pub fn velocity(&self, body: impl AsRef<str>) -> Triple {
        self.of(body.as_ref(), |_, motion| motion.velocity)
    }

    /// Angular velocity ω of a body, rad/s — eq. (6.4).
    pub fn angular_velocity(&self, body: impl AsRef<str>) -> Triple {
        self.of(body.as_ref(), |_, motion| motion.angular_velocity)
    }

    /// Directors u, v, w of a body: unit vectors along its principal axes of inertia — THEORY section 2.
    pub fn directors(&self, body: impl AsRef<str>) -> [Triple; 3] {
        [0, 1, 2].map(|k| self.of(body.as_ref(), |_, motion| motion.directors[k]))
    }

    /// Place of a point of a body that is given in the body's own frame, m — eq. (2.2).
    pub fn point(&self, body: impl AsRef<str>, point: Triple) -> Triple {
        self.of(body.as_ref(), |model, motion| motion.position + arm(model, motion, point))
    }

    /// Velocity of a point of a body that is given in the body's own frame, m/s.
    pub fn point_velocity(&self, body: impl AsRef<str>, point: Triple) -> Triple {
        self.of(body.as_ref(), |model, motion| {
            motion.velocity + motion.angular_velocity.cross(&arm(model, motion, point))
        })
    }

    fn of(&self, name: &str, read: impl Fn(Option<&ModelBody>, &BodyMotion) -> Vector3<f64>) -> Triple {
        if name == GROUND {
            return read(None, &AT_REST).into();
        }
        let Some(body) = self.bodies.iter().position(|body| body.name == name) else {
            self.unknown.borrow_mut().get_or_insert_with(|| name.to_owned());
            return [f64::NAN; 3];
        };
        read(Some(&self.bodies[body]), &self.motions.motion(body)).into()
    }
}

/// From the centre of mass of a body, or the origin of the ground, to a point of its own frame.
fn arm(model: Option<&ModelBody>, motion: &BodyMotion, point: Triple) -> Vector3<f64> {
    let point = Vector3::from(point);
    let local = model.map_or(point, |model| model.point_to_principal(&point));
    motion.directors[0] * local.x + motion.directors[1] * local.y + motion.directors[2] * local.z
}

/// The ground.
const AT_REST: BodyMotion = BodyMotion {
    position: Vector3::new(0.0, 0.0, 0.0),
    directors: [Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.0, 1.0, 0.0), Vector3::new(0.0, 0.0, 1.0)],
    velocity: Vector3::new(0.0, 0.0, 0.0),
    angular_velocity: Vector3::new(0.0, 0.0, 0.0),
};

/// A force and a moment on a body as a function of the whole state, given by a program.
///
/// The function is called at each evaluation of the accelerations, from any thread and in no order of time: steps are
/// tried, refused and repeated. It must give the same wrench for the same state, or neither the error control nor the
/// promise of the same bits holds. Integrators that need power series do not know it: `auto` takes one that evaluates,
/// and says so; [`CustomLoadError::NoSeries`] refuses a scene that asks for `taylor`. The energy balance counts its
/// power f · v + τ · ω as work.
///
/// ```
/// use triad_dynamics::model::{CustomLoad, Wrench};
/// use triad_dynamics::scene::{Body, Scene};
///
/// let mut scene = Scene::new("fall");
/// let ball = scene.add(Body::sphere("ball", 0.5, 0.1, [0.0; 3]));
/// let drag = CustomLoad::new("drag", &ball, {
///     let ball = ball.clone();
///     move |state| Wrench::force(state.velocity(&ball).map(|v| -0.02 * v * v.abs()))
/// });
/// assert_eq!(drag.name(), "drag");
/// ```
#[derive(Clone)]
pub struct CustomLoad {
    name: String,
    body: BodyHandle,
    point: Option<Triple>,
    law: Law,
}

type Law = Arc<dyn Fn(&LoadState<'_>) -> Wrench + Send + Sync>;

impl CustomLoad {
    /// A load on a body, at its centre of mass unless [`CustomLoad::at`] says otherwise. The name is for errors; no other
    /// load of the run may have it.
    pub fn new(
        name: impl Into<String>,
        body: impl Into<BodyHandle>,
        law: impl Fn(&LoadState<'_>) -> Wrench + Send + Sync + 'static,
    ) -> Self {
        Self { name: name.into(), body: body.into(), point: None, law: Arc::new(law) }
    }

    /// Where the force acts, and about which point the moment is given: a point of the body's own frame, m.
    #[must_use]
    pub fn at(self, point: Triple) -> Self {
        Self { point: Some(point), ..self }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }
}

impl fmt::Debug for CustomLoad {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, body, point, law: _ } = self;
        f.debug_struct("CustomLoad").field("name", name).field("body", body).field("point", point).finish()
    }
}

/// Why a [`CustomLoad`] cannot act.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CustomLoadError {
    /// Another load has its name.
    #[error("two loads are called \"{load}\"")]
    DuplicateName {
        /// The load.
        load: String,
    },
    /// It acts on, or looks at, a body that the scene does not have.
    #[error("load \"{load}\" asks for body \"{body}\", which the scene does not have")]
    UnknownBody {
        /// The load.
        load: String,
        /// The name of the body.
        body: String,
        /// The nearest name that there is.
        nearest: Option<String>,
    },
    /// It acts on the ground.
    #[error("load \"{load}\" acts on the ground, which cannot move")]
    OnGround {
        /// The load.
        load: String,
    },
    /// The function or its point is not finite.
    #[error("load \"{load}\" is not a finite number at t = {time:.6} s")]
    NotFinite {
        /// The load.
        load: String,
        /// Time, s.
        time: f64,
    },
    /// The scene asks for an integrator that needs a power series of each load.
    #[error("the scene asks for taylor, but load \"{load}\" is a function without a power series")]
    NoSeries {
        /// The load.
        load: String,
    },
}

impl CustomLoadError {
    /// Stable name of the kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::DuplicateName { .. } => "duplicate-name",
            Self::UnknownBody { .. } => "unknown-name",
            Self::OnGround { .. } => "load-on-ground",
            Self::NotFinite { .. } => "load-not-finite",
            Self::NoSeries { .. } => "load-without-series",
        }
    }

    /// What to try.
    pub fn hint(&self) -> String {
        match self {
            Self::DuplicateName { .. } => "Give each load a name of its own.".to_owned(),
            Self::UnknownBody { nearest: Some(nearest), .. } => format!("Did you mean \"{nearest}\"?"),
            Self::UnknownBody { .. } => "Name a body as the scene does.".to_owned(),
            Self::OnGround { .. } => "Let it act on a body that moves.".to_owned(),
            Self::NotFinite { .. } => {
                "Look for a division by zero or a root of a negative number in the function at that state.".to_owned()
            }
            Self::NoSeries { .. } => {
                "Leave the integrator to `auto`, or choose one that evaluates accelerations, such as dop853 or radau."
                    .to_owned()
            }
        }
    }
}

/// A checked [`CustomLoad`].
#[derive(Clone)]
pub struct ModelCustomLoad {
    /// Name.
    pub name: String,
    /// The body that it acts on.
    pub body: usize,
    /// Where, in the principal frame.
    pub local: Vector3<f64>,
    law: Law,
}

impl fmt::Debug for ModelCustomLoad {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, body, local, law: _ } = self;
        f.debug_struct("ModelCustomLoad")
            .field("name", name)
            .field("body", body)
            .field("local", local)
            .finish()
    }
}

impl ModelCustomLoad {
    /// Force and moment at a state, in the world, or why there are none.
    ///
    /// # Errors
    ///
    /// [`CustomLoadError`]: a body that the scene does not have, or a number that is not finite, with the name of the load.
    pub fn at(
        &self,
        model: &Model,
        time: f64,
        motions: &dyn Motions,
    ) -> Result<[Vector3<f64>; 2], CustomLoadError> {
        let state = LoadState { time, bodies: &model.bodies, motions, unknown: RefCell::default() };
        let Wrench { force, moment } = (self.law)(&state);
        if let Some(body) = state.unknown.into_inner() {
            return Err(model.unknown_body(&self.name, body));
        }
        if force.iter().chain(&moment).all(|x| x.is_finite()) {
            return Ok([force, moment].map(Vector3::from));
        }
        Err(CustomLoadError::NotFinite { load: self.name.clone(), time })
    }
}

impl Model {
    /// Adds loads that are functions of the state.
    ///
    /// # Errors
    ///
    /// [`CustomLoadError`] with the load's name: a name that another load has, a body that there is not, a point that
    /// is not finite.
    pub fn with_loads(
        mut self,
        loads: impl IntoIterator<Item = CustomLoad>,
    ) -> Result<Self, CustomLoadError> {
        for CustomLoad { name, body, point, law } in loads {
            let taken = self.loads.iter().map(|load| &load.name);
            if taken.chain(self.custom_loads.iter().map(|load| &load.name)).any(|taken| *taken == name) {
                return Err(CustomLoadError::DuplicateName { load: name });
            }
            if body.name() == GROUND {
                return Err(CustomLoadError::OnGround { load: name });
            }
            let Some(body) = self.bodies.iter().position(|known| known.name == body.name()) else {
                return Err(self.unknown_body(&name, body.into()));
            };
            let local = point.map_or(Vector3::zeros(), |point| {
                self.bodies[body].point_to_principal(&Vector3::from(point))
            });
            if local.iter().any(|x| !x.is_finite()) {
                return Err(CustomLoadError::NotFinite { load: name, time: 0.0 });
            }
            self.custom_loads.push(ModelCustomLoad { name, body, local, law });
        }
        Ok(self)
    }

    fn unknown_body(&self, load: &str, body: String) -> CustomLoadError {
        let nearest =
            crate::scene::text::nearest_name(&body, self.bodies.iter().map(|body| body.name.as_str()));
        CustomLoadError::UnknownBody { load: load.to_owned(), body, nearest }
    }
}
