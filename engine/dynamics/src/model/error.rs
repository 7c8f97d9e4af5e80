//! What can be wrong with a scene that reads well.

use crate::scene::text::short;
use std::fmt;

/// Where a scene chooses outputs.
const OUTPUTS: &str = "/simulation/outputs";
/// What to try with an angle whose cosine tells nothing of it.
pub const OTHER_THAN_COSINE: &str = "Prescribe the angle of a joint (angle) or a direction (vector), which hold everywhere, or choose \
                                     vectors that are at right angles in the middle of the motion.";

/// What an element names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NamedElement {
    /// A body, or the ground.
    Body,
    /// A joint.
    Joint,
    /// A joint that has to stand before the element.
    JointBefore,
    /// A joint or driver.
    JointOrDriver,
    /// A driver.
    Driver,
    /// A load.
    Load,
    /// A marker.
    Marker,
}

impl NamedElement {
    /// Where it has to stand, if that matters: of joints only a gear names others.
    fn order(self) -> &'static str {
        match self {
            Self::JointBefore => " before it; a gear is written after its two joints",
            _ => "",
        }
    }
}

impl fmt::Display for NamedElement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Body => "body",
            Self::Joint | Self::JointBefore => "joint",
            Self::JointOrDriver => "joint or driver",
            Self::Driver => "driver",
            Self::Load => "load",
            Self::Marker => "marker",
        })
    }
}

/// What is wrong with an element, as far as there is something to try that helps with that alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GeometryFault {
    /// Something that its kind does not know.
    TooMuch,
    /// Points or axes of a joint that are missing, or given twice.
    Place,
    /// The points of a rod coincide.
    Coincident,
    /// The pitch of a screw.
    Pitch,
    /// A direction without length.
    NoLength,
    /// A direction whose components are not those of a unit vector.
    Unit,
    /// A formula without a power series in the run.
    NoSeries,
    /// An angle whose cosine tells nothing of it.
    Cosine,
    /// Anything else.
    Other,
}

/// A scene that cannot be: what, where, and what to try.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// There is nothing to move.
    #[error("the scene has no bodies")]
    NoBodies,
    /// Two elements of one list share a name.
    #[error("{list}[{index}]: the name \"{name}\" is already used by {first}")]
    DuplicateName {
        /// Which list.
        list: &'static str,
        /// The second element of that name.
        index: usize,
        /// The first element of that name, as list\[index\].
        first: String,
        /// The name.
        name: String,
    },
    /// An empty name, that of the ground, or one with line breaks.
    #[error("{list}[{index}]: {name:?} cannot be the name of an element")]
    ReservedName {
        /// Which list.
        list: &'static str,
        /// Which element.
        index: usize,
        /// Its name.
        name: String,
    },
    /// An element names one that is not there.
    #[error("{element}: there is no {what} \"{name}\"{order}", order = what.order())]
    UnknownName {
        /// The element that names another.
        element: String,
        /// JSON pointer of the name.
        pointer: String,
        /// What it names.
        what: NamedElement,
        /// The name.
        name: String,
        /// The name of one that is nearly the same, or nothing.
        nearest: Option<String>,
    },
    /// A joint between a body and itself.
    #[error("joint \"{joint}\": it joins \"{body}\" to itself")]
    SameBody {
        /// The joint.
        joint: String,
        /// Where.
        pointer: String,
        /// The body.
        body: String,
    },
    /// A number that is infinite or not a number.
    #[error("{pointer}: {value} is not a finite number")]
    NotFinite {
        /// Where.
        pointer: String,
        /// The number.
        value: f64,
    },
    /// A number outside its range.
    #[error("{pointer}: {value} is not between {low} and {high}", value = short(*value), low = short(*low), high = short(*high))]
    OutOfRange {
        /// Where.
        pointer: String,
        /// The number.
        value: f64,
        /// Least value.
        low: f64,
        /// Greatest value.
        high: f64,
    },
    /// A mass that is zero or negative.
    #[error("{element}: its mass is {mass} kg, but a mass must be positive")]
    Mass {
        /// The body, or what is attached to it.
        element: String,
        /// Where.
        pointer: String,
        /// The mass, kg.
        mass: f64,
    },
    /// Principal moments that no distribution of mass has.
    #[error(
        "{element}: its principal moments of inertia {a}, {b}, {c} kg m² break the triangle inequality \
         (each must be at least zero and at most the sum of the other two)"
    )]
    Inertia {
        /// The body, or what is attached to it.
        element: String,
        /// Where.
        pointer: String,
        /// First moment, kg m².
        a: f64,
        /// Second moment, kg m².
        b: f64,
        /// Third moment, kg m².
        c: f64,
    },
    /// An inertia tensor that is not symmetric.
    #[error(
        "{element}: its inertia tensor is not symmetric (I[{row}][{column}] differs by {difference} kg m²)"
    )]
    Asymmetric {
        /// The body, or what is attached to it.
        element: String,
        /// Where.
        pointer: String,
        /// Row of the entry.
        row: usize,
        /// Column of the entry.
        column: usize,
        /// By how much the two entries differ.
        difference: f64,
    },
    /// Data that do not define an orientation.
    #[error("body \"{body}\": {reason}")]
    Orientation {
        /// The body.
        body: String,
        /// Where.
        pointer: String,
        /// What is wrong.
        reason: String,
    },
    /// An element without something that it needs, or with something that it does not know.
    #[error("{element}: {reason}")]
    Geometry {
        /// The joint, driver, load, marker, event or output.
        element: String,
        /// Where.
        pointer: String,
        /// What is missing or too much.
        reason: String,
        /// What that is a case of.
        fault: GeometryFault,
    },
    /// A parameter that cannot be.
    #[error("parameter \"{name}\": {reason}")]
    Parameter {
        /// The parameter.
        name: String,
        /// Where.
        pointer: String,
        /// What is wrong with it.
        reason: String,
    },
}

impl ModelError {
    /// Stable name of the kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::NoBodies => "no-bodies",
            Self::DuplicateName { .. } => "duplicate-name",
            Self::ReservedName { .. } => "reserved-name",
            Self::UnknownName { pointer, .. } if pointer.starts_with(OUTPUTS) => "output-invalid",
            Self::UnknownName { what: NamedElement::Body, .. } => "unknown-body",
            Self::UnknownName { what: NamedElement::Joint | NamedElement::JointBefore, .. } => {
                "unknown-joint"
            }
            Self::UnknownName { .. } => "unknown-marker",
            Self::SameBody { .. } => "joint-to-itself",
            Self::NotFinite { .. } => "not-finite",
            Self::OutOfRange { .. } => "out-of-range",
            Self::Mass { .. } => "mass-not-positive",
            Self::Inertia { .. } => "inertia-not-physical",
            Self::Asymmetric { .. } => "inertia-not-symmetric",
            Self::Orientation { .. } => "orientation-invalid",
            Self::Parameter { .. } => "parameter-invalid",
            Self::Geometry { pointer, .. } if pointer.starts_with("/joints") => "joint-geometry",
            Self::Geometry { pointer, .. } if pointer.starts_with("/drivers") => "driver-invalid",
            Self::Geometry { pointer, .. } if pointer.starts_with("/events") => "event-invalid",
            Self::Geometry { pointer, .. } if pointer.starts_with("/markers") => "marker-invalid",
            Self::Geometry { pointer, .. } if pointer.starts_with(OUTPUTS) => "output-invalid",
            Self::Geometry { .. } => "load-invalid",
        }
    }

    /// Where in the scene, as a JSON pointer.
    pub fn pointer(&self) -> String {
        match self {
            Self::NoBodies => "/bodies".to_owned(),
            Self::DuplicateName { list, index, .. } | Self::ReservedName { list, index, .. } => {
                format!("/{list}/{index}/name")
            }
            Self::UnknownName { pointer, .. }
            | Self::SameBody { pointer, .. }
            | Self::NotFinite { pointer, .. }
            | Self::OutOfRange { pointer, .. }
            | Self::Mass { pointer, .. }
            | Self::Inertia { pointer, .. }
            | Self::Asymmetric { pointer, .. }
            | Self::Orientation { pointer, .. }
            | Self::Parameter { pointer, .. }
            | Self::Geometry { pointer, .. } => pointer.clone(),
        }
    }

    /// What to try.
    pub fn hint(&self) -> String {
        match self {
            Self::NoBodies => "Add at least one body with a name and a mass.".to_owned(),
            Self::DuplicateName { .. } => {
                "Give each element of a list its own name; joints and drivers share one list of names.".to_owned()
            }
            Self::ReservedName { .. } => {
                "Choose a name that is not empty, has no line breaks, and is not \"ground\", which is the fixed body.".to_owned()
            }
            Self::UnknownName { nearest: Some(name), .. } => format!("Did you mean \"{name}\"?"),
            Self::UnknownName { what: NamedElement::Body, pointer, .. } if !pointer.starts_with(OUTPUTS) => {
                "Use the name of one of the bodies, or \"ground\".".to_owned()
            }
            Self::UnknownName { what, .. } => format!("Use the name of a {what} of the scene."),
            Self::SameBody { .. } => "Name two different bodies, one of which may be \"ground\".".to_owned(),
            Self::NotFinite { .. } => "Write an ordinary number.".to_owned(),
            Self::OutOfRange { low, high, .. } => {
                let (low, high) = (short(*low), short(*high));
                format!("Choose a value from {low} to {high}.")
            }
            Self::Mass { .. } => "Give a positive mass in kg; a light body may have 1e-9 kg.".to_owned(),
            Self::Inertia { .. } => {
                "Check the units (kg m²) and that the moments are about the centre of mass; for a flat body the \
                 largest is the sum of the other two."
                    .to_owned()
            }
            Self::Asymmetric { .. } => {
                "Write the same number on both sides of the diagonal; off-diagonal entries are minus the products \
                 of inertia."
                    .to_owned()
            }
            Self::Orientation { .. } => {
                "Give either u and v (perpendicular unit vectors), or a unit quaternion [w, x, y, z], or an axis and \
                 an angle in radians."
                    .to_owned()
            }
            Self::Parameter { .. } => {
                "A parameter names numbers of this scene by JSON pointers from 0, like /bodies/0/mass, and a range \
                 that holds the number written there."
                    .to_owned()
            }
            Self::Geometry { pointer, .. } if pointer.starts_with(OUTPUTS) => {
                "Write a word alone, like reactions, or with the name of one element behind a colon, like reactions:pin."
                    .to_owned()
            }
            Self::Geometry { pointer, fault, .. } => fault.hint(pointer.starts_with("/joints")).to_owned(),
        }
    }
}

impl GeometryFault {
    /// What to try, with a joint or another element.
    fn hint(self, joint: bool) -> &'static str {
        match self {
            Self::TooMuch if joint => "Leave it out, or choose a kind of joint that has it.",
            Self::TooMuch => "Leave it out.",
            Self::Place => {
                "Give points and axes either in the world at the start (point, axis, axes) or in the frames of both bodies (point_i and point_j, \
                 axis_i and axis_j)."
            }
            Self::Coincident => "Set the two points of the rod apart, or put a spherical joint in its place.",
            Self::Pitch => {
                "Give what body j advances in a whole turn, in m; a negative number for a left-handed thread."
            }
            Self::NoLength => {
                "Give a vector that is not zero, such as [0, 0, 1]: its length does not matter."
            }
            Self::Unit => {
                "Divide its components by its length, or give a vector that turns about an axis, which keeps its length."
            }
            Self::NoSeries => {
                "Change the formula so that it has a value and all derivatives in the whole run, let the run end before, or write \
                 a table instead."
            }
            Self::Cosine => OTHER_THAN_COSINE,
            Self::Other if joint => "Compare the joint with the JSON Schema of a scene (`triad schema`).",
            Self::Other => {
                "Compare the element with the JSON Schema of a scene; points and vectors of a body are in its own \
                 frame."
            }
        }
    }
}
