//! Orientations as their author writes them.

use crate::value::Triple;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Orientation of a body's frame in the world.
///
/// ```
/// use triad_scene::Orientation;
///
/// let turned = Orientation::rotation([0.0, 0.0, 1.0], 0.5);
/// assert_eq!(serde_json::to_string(&turned)?, r#"{"axis":[0.0,0.0,1.0],"angle":0.5}"#);
/// let read: Orientation = serde_json::from_str(r#"{"quaternion": [1, 0, 0, 0]}"#)?;
/// assert_eq!(read, Orientation::Quaternion([1.0, 0.0, 0.0, 0.0]));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "WrittenOrientation", into = "WrittenOrientation")]
pub enum Orientation {
    /// The directors u and v in the world, made orthonormal if they are nearly so.
    Directors {
        /// First director u.
        u: Triple,
        /// Second director v.
        v: Triple,
        /// Third director w, if it is stated: then it must be u × v.
        w: Option<Triple>,
    },
    /// Unit quaternion, scalar first, body to world.
    Quaternion([f64; 4]),
    /// A rotation from the world's axes.
    Rotation {
        /// Its axis; made a unit vector.
        axis: Triple,
        /// Its angle, rad.
        angle: f64,
    },
    /// What a text may say although it says nothing: none of the three ways, or more than one. The model refuses it
    /// with the name of the body.
    Unclear(WrittenOrientation),
}

impl Orientation {
    /// By the directors u and v in the world, unit vectors at a right angle.
    pub const fn directors(u: Triple, v: Triple) -> Self {
        Self::Directors { u, v, w: None }
    }

    /// By a rotation about an axis of the world through an angle in rad.
    pub const fn rotation(axis: Triple, angle: f64) -> Self {
        Self::Rotation { axis, angle }
    }
}

/// The keys of an orientation in JSON: those of one of the three ways.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Orientation", description = "Orientation of a body's frame in the world.")]
pub struct WrittenOrientation {
    /// First director u (with `v`); made orthonormal if it is nearly so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub u: Option<Triple>,
    /// Second director v (with `u`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub v: Option<Triple>,
    /// Third director w, if it is stated: then it must be u × v.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub w: Option<Triple>,
    /// Unit quaternion, scalar first, body to world.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quaternion: Option<[f64; 4]>,
    /// Axis of a rotation (with `angle`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<Triple>,
    /// Angle of the rotation about `axis`, rad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle: Option<f64>,
}

impl From<WrittenOrientation> for Orientation {
    fn from(written: WrittenOrientation) -> Self {
        match written {
            WrittenOrientation { u: Some(u), v: Some(v), w, quaternion: None, axis: None, angle: None } => {
                Self::Directors { u, v, w }
            }
            WrittenOrientation {
                u: None,
                v: None,
                w: None,
                quaternion: Some(q),
                axis: None,
                angle: None,
            } => Self::Quaternion(q),
            WrittenOrientation {
                u: None,
                v: None,
                w: None,
                quaternion: None,
                axis: Some(axis),
                angle: Some(angle),
            } => Self::Rotation { axis, angle },
            unclear => Self::Unclear(unclear),
        }
    }
}

impl From<Orientation> for WrittenOrientation {
    fn from(orientation: Orientation) -> Self {
        match orientation {
            Orientation::Directors { u, v, w } => Self { u: Some(u), v: Some(v), w, ..Self::default() },
            Orientation::Quaternion(q) => Self { quaternion: Some(q), ..Self::default() },
            Orientation::Rotation { axis, angle } => {
                Self { axis: Some(axis), angle: Some(angle), ..Self::default() }
            }
            Orientation::Unclear(written) => written,
        }
    }
}

impl JsonSchema for Orientation {
    fn schema_name() -> Cow<'static, str> {
        WrittenOrientation::schema_name()
    }

    fn schema_id() -> Cow<'static, str> {
        WrittenOrientation::schema_id()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        WrittenOrientation::json_schema(generator)
    }
}
