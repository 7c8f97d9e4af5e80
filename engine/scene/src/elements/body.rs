//! Bodies as their author writes them.

use super::orientation::Orientation;
use crate::text::words;
use crate::value::{Triple, is_default};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which generalized coordinates describe a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Coordinates {
    /// One point and three unit vectors: 12 coordinates (r, u, v, w), six rigid-body rows.
    #[default]
    Full,
    /// One point and two unit vectors: 9 coordinates (r, u, v), w = u × v, three rigid-body rows.
    Reduced,
    /// As full, but each revolute joint between such bodies (or such a body and the ground) whose axis is a director
    /// of both lets them share it, whatever `rows` it names: the axis has no row, the director is written once.
    Shared,
}

words!(Coordinates { Full => "full", Reduced => "reduced", Shared => "shared" });

/// A rigid body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Unique name.
    pub name: String,
    /// Mass, kg; positive.
    pub mass: f64,
    /// Inertia about the centre of mass; without it the body is a point mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia: Option<Inertia>,
    /// Centre of mass in the body's frame, m.
    #[serde(default, skip_serializing_if = "is_default")]
    pub center_of_mass: Triple,
    /// Masses that are part of the body; `mass`, `inertia` and `center_of_mass` are those of the body without them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub attached: Vec<AttachedMass>,
    /// Position of the body's reference point in the world, m.
    #[serde(default)]
    pub position: Triple,
    /// Orientation of the body's frame in the world.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orientation: Option<Orientation>,
    /// Velocity of the reference point in the world frame, m/s.
    #[serde(default, skip_serializing_if = "is_default")]
    pub velocity: Triple,
    /// Angular velocity in the world frame, rad/s.
    #[serde(default, skip_serializing_if = "is_default")]
    pub angular_velocity: Triple,
    /// Coordinates of this body, if not those of the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coordinates: Option<Coordinates>,
    /// What to draw; no influence on the motion.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shape: Vec<Shape>,
}

impl Body {
    /// A body of this mass, kg; without an [inertia](Self::inertia) it is a point mass.
    ///
    /// Without further words it is at rest, its frame along the world's axes and its reference point, in the centre of mass,
    /// at the world's origin. Setters take the fields' names.
    ///
    /// ```
    /// use triad_scene::{Body, Inertia};
    ///
    /// let top = Body::new("top", 2.0)
    ///     .inertia(Inertia::Principal([0.3, 0.3, 0.1]))
    ///     .center_of_mass([0.0, 0.0, 0.5])
    ///     .angular_velocity([0.0, 0.0, 20.0]);
    /// assert_eq!((top.mass, top.position), (2.0, [0.0; 3]));
    /// ```
    pub fn new(name: impl Into<String>, mass: f64) -> Self {
        Self {
            name: name.into(),
            mass,
            inertia: None,
            center_of_mass: [0.0; 3],
            attached: Vec::new(),
            position: [0.0; 3],
            orientation: None,
            velocity: [0.0; 3],
            angular_velocity: [0.0; 3],
            coordinates: None,
            shape: Vec::new(),
        }
    }

    /// A point mass, kg, at a position in the world, m.
    ///
    /// ```
    /// let bob = triad_scene::Body::point_mass("bob", 1.0, [1.0, 0.0, 0.0]);
    /// assert!(bob.inertia.is_none() && bob.position == [1.0, 0.0, 0.0]);
    /// ```
    pub fn point_mass(name: impl Into<String>, mass: f64, position: Triple) -> Self {
        Self::new(name, mass).position(position)
    }

    /// A uniform slender rod, kg, between two points of the world, m: u lies along it, its frame in its middle,
    /// I = diag(0, m l²/12, m l²/12). It is drawn with a radius of l/50.
    ///
    /// Ends that coincide leave no direction: then it keeps the world's axes.
    ///
    /// ```
    /// use triad_scene::{Body, Inertia};
    ///
    /// let rod = Body::rod("rod", 3.0, [0.0; 3], [0.0, 2.0, 0.0]);
    /// assert_eq!(rod.position, [0.0, 1.0, 0.0]);
    /// assert_eq!(rod.inertia, Some(Inertia::Principal([0.0, 1.0, 1.0])));
    /// ```
    pub fn rod(name: impl Into<String>, mass: f64, from: Triple, to: Triple) -> Self {
        let length = distance(from, to);
        let across = mass * length * length / 12.0;
        Self::along(name, mass, from, to, 0.02 * length).inertia(Inertia::Principal([0.0, across, across]))
    }

    /// A uniform solid cylinder of a radius, m, between two points of the world: u lies along it, its frame in its middle,
    /// I = diag(m r²/2, m (3 r² + l²)/12, m (3 r² + l²)/12).
    ///
    /// ```
    /// use triad_scene::{Body, Inertia};
    ///
    /// let drum = Body::cylinder("drum", 12.0, 1.0, [0.0; 3], [0.0, 0.0, 3.0]);
    /// assert_eq!(drum.inertia, Some(Inertia::Principal([6.0, 12.0, 12.0])));
    /// ```
    pub fn cylinder(name: impl Into<String>, mass: f64, radius: f64, from: Triple, to: Triple) -> Self {
        let length = distance(from, to);
        let across = mass * (3.0 * radius * radius + length * length) / 12.0;
        let axial = 0.5 * mass * radius * radius;
        Self::along(name, mass, from, to, radius).inertia(Inertia::Principal([axial, across, across]))
    }

    /// A uniform solid ball of a radius, m, about a point of the world: I = 2/5 m r².
    ///
    /// ```
    /// use triad_scene::{Body, Inertia};
    ///
    /// let ball = Body::sphere("ball", 10.0, 0.5, [0.0, 0.0, 2.0]);
    /// assert_eq!(ball.inertia, Some(Inertia::Principal([1.0; 3])));
    /// ```
    pub fn sphere(name: impl Into<String>, mass: f64, radius: f64, center: Triple) -> Self {
        Self::new(name, mass)
            .position(center)
            .inertia(Inertia::Principal([0.4 * mass * radius * radius; 3]))
            .shape(Shape::Sphere { center: [0.0; 3], radius })
    }

    /// A uniform solid box with edges `size`, m, about a point of the world: I_x = m (b² + c²)/12 and so on.
    ///
    /// ```
    /// use triad_scene::{Body, Inertia};
    ///
    /// let brick = Body::cuboid("brick", 12.0, [1.0, 2.0, 3.0], [0.0; 3]);
    /// assert_eq!(brick.inertia, Some(Inertia::Principal([13.0, 10.0, 5.0])));
    /// ```
    pub fn cuboid(name: impl Into<String>, mass: f64, size: Triple, center: Triple) -> Self {
        let [a, b, c] = size.map(|edge| edge * edge);
        let principal = [b + c, c + a, a + b].map(|squares| mass * squares / 12.0);
        Self::new(name, mass)
            .position(center)
            .inertia(Inertia::Principal(principal))
            .shape(Shape::Box { center: [0.0; 3], size })
    }

    /// A bar between two points, drawn; u along it.
    fn along(name: impl Into<String>, mass: f64, from: Triple, to: Triple, radius: f64) -> Self {
        let half = 0.5 * distance(from, to);
        let mut body = Self::new(name, mass)
            .position([0, 1, 2].map(|k| 0.5 * (from[k] + to[k])))
            .shape(Shape::Rod { from: [-half, 0.0, 0.0], to: [half, 0.0, 0.0], radius });
        if half > 0.0 {
            let u = [0, 1, 2].map(|k| 0.5 * (to[k] - from[k]) / half);
            if u != [1.0, 0.0, 0.0] {
                body = body.orientation(Orientation::directors(u, perpendicular(u)));
            }
        }
        body
    }

    /// Its inertia about the centre of mass.
    #[must_use]
    pub fn inertia(mut self, inertia: Inertia) -> Self {
        self.inertia = Some(inertia);
        self
    }

    /// Its centre of mass in its frame, m.
    #[must_use]
    pub fn center_of_mass(mut self, center: Triple) -> Self {
        self.center_of_mass = center;
        self
    }

    /// A mass more that is part of it, kg, at a point of its frame, m; without an inertia it is a point.
    ///
    /// ```
    /// let arm = triad_scene::Body::rod("arm", 1.0, [0.0; 3], [1.0, 0.0, 0.0]).attach(5.0, [0.5, 0.0, 0.0], None);
    /// assert_eq!(arm.attached[0].mass, 5.0);
    /// ```
    #[must_use]
    pub fn attach(mut self, mass: f64, point: Triple, inertia: Option<Inertia>) -> Self {
        self.attached.push(AttachedMass { mass, point, inertia });
        self
    }

    /// The position of its reference point in the world at the start, m.
    #[must_use]
    pub fn position(mut self, position: Triple) -> Self {
        self.position = position;
        self
    }

    /// The orientation of its frame in the world at the start.
    #[must_use]
    pub fn orientation(mut self, orientation: Orientation) -> Self {
        self.orientation = Some(orientation);
        self
    }

    /// The velocity of its reference point in the world at the start, m/s.
    #[must_use]
    pub fn velocity(mut self, velocity: Triple) -> Self {
        self.velocity = velocity;
        self
    }

    /// Its angular velocity ω in the world at the start, rad/s.
    #[must_use]
    pub fn angular_velocity(mut self, omega: Triple) -> Self {
        self.angular_velocity = omega;
        self
    }

    /// Its coordinates, if not those of the scene.
    #[must_use]
    pub fn coordinates(mut self, coordinates: Coordinates) -> Self {
        self.coordinates = Some(coordinates);
        self
    }

    /// Draws one shape more.
    #[must_use]
    pub fn shape(mut self, shape: Shape) -> Self {
        self.shape.push(shape);
        self
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }
}

fn distance(from: Triple, to: Triple) -> f64 {
    (0..3).map(|k| to[k] - from[k]).map(|d| d * d).sum::<f64>().sqrt()
}

/// A unit vector at a right angle to u: in the plane z = 0 where there is one that is not short.
fn perpendicular(u: Triple) -> Triple {
    let v = if u[2].abs() < 0.9 { [-u[1], u[0], 0.0] } else { [u[2], 0.0, -u[0]] };
    let length = distance([0.0; 3], v);
    v.map(|x| x / length)
}

/// Inertia about the centre of mass along the axes of the body's frame, kg m².
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub enum Inertia {
    /// The body's frame lies along the principal axes: their three moments.
    Principal(Triple),
    /// The full symmetric tensor; the engine finds the principal axes.
    Tensor([Triple; 3]),
}

/// A mass that is part of a body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AttachedMass {
    /// Mass, kg; positive.
    pub mass: f64,
    /// Its centre in the body's frame, m.
    #[serde(default, skip_serializing_if = "is_default")]
    pub point: Triple,
    /// Its inertia about its own centre, along the axes of the body's frame; without it a point mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia: Option<Inertia>,
}

/// A primitive drawn in a body's frame, lengths in m.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", deny_unknown_fields, rename_all = "kebab-case")]
pub enum Shape {
    /// A round bar between two points.
    Rod {
        /// One end.
        from: Triple,
        /// The other end.
        to: Triple,
        /// Radius.
        radius: f64,
    },
    /// A ball.
    Sphere {
        /// Centre.
        center: Triple,
        /// Radius.
        radius: f64,
    },
    /// A box along the axes of the body's frame.
    Box {
        /// Centre.
        center: Triple,
        /// Full edge lengths.
        size: Triple,
    },
}
