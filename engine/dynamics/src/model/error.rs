//! What can be wrong with a scene that reads well.

/// Where a scene chooses outputs.
const OUTPUTS: &str = "/simulation/outputs";
/// What is wrong with a formula that can be read, as its reason begins.
const NO_SERIES: &str = "its formula has no power series";
/// What is wrong with an angle whose cosine tells nothing of it, as its reason begins.
pub(super) const COSINE: &str = "it prescribes the cosine of an angle";
/// What to try with such an angle.
pub const OTHER_THAN_COSINE: &str = "Prescribe the angle of a joint (angle) or a direction (vector), which hold everywhere, or choose \
                                     vectors that are at right angles in the middle of the motion.";
/// What is wrong with a direction.
pub(super) const NO_LENGTH: &str = "the vector has no length";
/// What is wrong with a rod.
pub(super) const COINCIDENT: &str = "its points coincide, and no length is given";

/// A scene that cannot be: what, where, and what to try.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// There is nothing to move.
    #[error("the scene has no bodies")]
    NoBodies,
    /// Two elements of one list share a name.
    #[error("{list}[{index}]: the name \"{name}\" is already used by {list}[{first}]")]
    DuplicateName {
        /// Which list.
        list: &'static str,
        /// The second element of that name.
        index: usize,
        /// The first element of that name.
        first: usize,
        /// The name.
        name: String,
    },
    /// An empty name, or that of the ground.
    #[error("{list}[{index}]: \"{name}\" cannot be the name of an element")]
    ReservedName {
        /// Which list.
        list: &'static str,
        /// Which element.
        index: usize,
        /// Its name.
        name: String,
    },
    /// A joint, driver or load names a body that is not there.
    #[error("{element}: there is no body \"{name}\"")]
    UnknownBody {
        /// The joint, driver or load.
        element: String,
        /// JSON pointer of the name.
        pointer: String,
        /// The name.
        name: String,
        /// The name of a body that is nearly the same, or nothing.
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
    #[error("body \"{body}\": its mass is {mass} kg, but a mass must be positive")]
    Mass {
        /// The body.
        body: String,
        /// Where.
        pointer: String,
        /// The mass, kg.
        mass: f64,
    },
    /// Principal moments that no distribution of mass has.
    #[error(
        "body \"{body}\": its principal moments of inertia {a}, {b}, {c} kg m² break the triangle inequality \
         (each must be at least zero and at most the sum of the other two)"
    )]
    Inertia {
        /// The body.
        body: String,
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
        "body \"{body}\": its inertia tensor is not symmetric (I[{row}][{column}] differs by {difference} kg m²)"
    )]
    Asymmetric {
        /// The body.
        body: String,
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
    /// A joint, driver or load without something that it needs, or with something that it does not know.
    #[error("{element}: {reason}")]
    Geometry {
        /// The joint, driver or load.
        element: String,
        /// Where.
        pointer: String,
        /// What is missing or too much.
        reason: String,
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
            Self::UnknownBody { .. } => "unknown-body",
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
            Self::UnknownBody { pointer, .. }
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
            Self::DuplicateName { .. } => "Give each element of a list its own name.".to_owned(),
            Self::ReservedName { .. } => {
                "Choose a name that is not empty and not \"ground\", which is the fixed body.".to_owned()
            }
            Self::UnknownBody { nearest: Some(name), .. } => format!("Did you mean \"{name}\"?"),
            Self::UnknownBody { nearest: None, .. } => {
                "Use the name of one of the bodies, or \"ground\".".to_owned()
            }
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
            Self::Geometry { reason, .. } if reason.starts_with(NO_SERIES) => {
                "Change the formula so that it has a value and all derivatives in the whole run, let the run end before, or write \
                 a table instead."
                    .to_owned()
            }
            Self::Geometry { reason, .. } if reason.starts_with(COSINE) => OTHER_THAN_COSINE.to_owned(),
            Self::Geometry { reason, .. } if reason == NO_LENGTH => {
                "Give a vector that is not zero, such as [0, 0, 1]: its length does not matter.".to_owned()
            }
            Self::Geometry { pointer, reason, .. } if pointer.starts_with("/joints") => {
                hint_of_joint(pointer, reason).to_owned()
            }
            Self::Geometry { .. } => {
                "Compare the element with the JSON Schema of a scene; points and vectors of a body are in its own \
                 frame."
                    .to_owned()
            }
        }
    }
}

/// What to try with the geometry of a joint.
fn hint_of_joint(pointer: &str, reason: &str) -> &'static str {
    if is_too_much(reason) {
        "Leave it out, or choose a kind of joint that has it."
    } else if pointer.ends_with("/pitch") {
        "Give what body j advances in a whole turn, in m; a negative number for a left-handed thread."
    } else if reason == COINCIDENT {
        "Set the two points of the rod apart, or put a spherical joint in its place."
    } else if of_place(pointer) {
        "Give points and axes either in the world at the start (point, axis, axes) or in the frames of both bodies (point_i and point_j, \
         axis_i and axis_j)."
    } else {
        "Compare the joint with the JSON Schema of a scene (`triad schema`)."
    }
}

/// Whether a joint is refused for what its kind does not know.
fn is_too_much(reason: &str) -> bool {
    reason.starts_with("only ") || (reason.starts_with("a ") && reason.contains(" has no "))
}

/// Whether it is about the points or axes of a joint.
fn of_place(pointer: &str) -> bool {
    pointer.split('/').nth(3).is_some_and(|key| key.starts_with("point") || key.starts_with("ax"))
}

/// A number, by its power of ten where it would fill the line.
fn short(number: f64) -> String {
    let size = number.abs();
    if size >= 1e21 || (size > 0.0 && size < 1e-14) { format!("{number:e}") } else { number.to_string() }
}
