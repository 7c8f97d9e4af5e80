//! What a table of a run holds.

use crate::text::{UnknownWord, words};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt;
use std::str::FromStr;

/// Groups of columns of a table, by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputKind {
    /// Centre of mass, principal axes u, v, w, velocity of the centre of mass, angular velocity of each body.
    Bodies,
    /// Reference point and axes x, y, z of each body as its author wrote them, and the velocity of that point.
    Frames,
    /// Acceleration of the centre of mass and angular acceleration of each body.
    Accelerations,
    /// Force and moment of each joint and driver.
    Reactions,
    /// Of each driver its power; of a driven angle or slide its value, its rate and the torque or force along it, of another
    /// driver force and moment.
    Drivers,
    /// Angle and slide of each joint that has them, with their rates.
    Joints,
    /// Of each load what it does, and its power: of springs and dampers also length, angle or slide and its rate.
    Loads,
    /// Position and velocity of each marker.
    Markers,
    /// Total energy.
    Energy,
    /// Kinetic and potential energy, the work of drivers and loads since the start, and what is left over.
    Balance,
    /// How far the constraints are violated.
    Violations,
    /// Estimated errors of what the row says, where they are estimated: of positions, directions, velocities and the energy, and of
    /// reactions where these or drivers are among the outputs; none of loads.
    Errors,
}

words!(
    ///
    /// ```
    /// use triad_scene::OutputKind;
    ///
    /// assert_eq!("joints".parse(), Ok(OutputKind::Joints));
    /// ```
    OutputKind {
        Bodies => "bodies",
        Frames => "frames",
        Accelerations => "accelerations",
        Reactions => "reactions",
        Drivers => "drivers",
        Joints => "joints",
        Loads => "loads",
        Markers => "markers",
        Energy => "energy",
        Balance => "balance",
        Violations => "violations",
        Errors => "errors",
    }
);

/// One group of columns, of all elements or of one: `joints`, or `joints:crank-pin`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Output {
    /// The group.
    pub kind: OutputKind,
    /// The one body, joint, driver, load or marker that it is wanted of.
    pub of: Option<String>,
}

impl Output {
    /// What a table holds that nobody has chosen: bodies, reactions, energy, violations, errors.
    ///
    /// ```
    /// use triad_scene::{Output, OutputKind};
    ///
    /// assert_eq!(Output::usual()[0].kind, OutputKind::Bodies);
    /// let pin: Output = "reactions:pin".parse()?;
    /// assert_eq!((pin.of.as_deref(), pin.to_string()), (Some("pin"), "reactions:pin".to_owned()));
    /// assert!("forces".parse::<Output>().is_err());
    /// # Ok::<(), triad_scene::UnknownWord>(())
    /// ```
    pub fn usual() -> Vec<Self> {
        use OutputKind::{Bodies, Energy, Errors, Reactions, Violations};
        [Bodies, Reactions, Energy, Violations, Errors].map(Self::from).to_vec()
    }

    /// Whether a list is that.
    pub fn are_usual(list: &[Self]) -> bool {
        list == Self::usual()
    }
}

impl From<OutputKind> for Output {
    fn from(kind: OutputKind) -> Self {
        Self { kind, of: None }
    }
}

impl FromStr for Output {
    type Err = UnknownWord;

    fn from_str(text: &str) -> Result<Self, UnknownWord> {
        let (kind, of) = text.split_once(':').map_or((text, None), |(kind, of)| (kind, Some(of.to_owned())));
        Ok(Self { kind: kind.parse()?, of })
    }
}

impl TryFrom<String> for Output {
    type Error = UnknownWord;

    fn try_from(text: String) -> Result<Self, UnknownWord> {
        text.parse()
    }
}

impl fmt::Display for Output {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.of {
            Some(of) => write!(f, "{}:{of}", self.kind),
            None => write!(f, "{}", self.kind),
        }
    }
}

impl From<Output> for String {
    fn from(output: Output) -> Self {
        output.to_string()
    }
}

impl JsonSchema for Output {
    fn schema_name() -> Cow<'static, str> {
        "Output".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let words = OutputKind::ALL.map(|kind| kind.to_string());
        json_schema!({
            "description": format!(
                "A group of columns: {}; of one element alone with its name behind a colon, like reactions:pin.",
                words.join(", ")
            ),
            "type": "string",
            "pattern": format!("^({})(:.+)?$", words.join("|")),
        })
    }
}
