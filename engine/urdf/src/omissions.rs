//! What of a URDF could not be carried over, and why a text is no robot at all.

use schemars::JsonSchema;
use serde::Serialize;

/// Goes on as long as somebody waits.
pub(crate) fn go_on(wanted: &dyn Fn() -> bool) -> Result<(), UrdfError> {
    if wanted() { Ok(()) } else { Err(UrdfError::NoLongerWanted) }
}

/// Bytes of a URDF.
pub const MAX_TEXT: usize = 4 << 20;
/// Links of a robot.
pub const MAX_LINKS: usize = 2_000;

/// Something that could not be carried over.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
#[schemars(rename = "LeftOut")]
pub struct OmittedItem {
    /// Its line in the URDF.
    pub line: u32,
    /// What it belongs to, such as `joint elbow`.
    pub of: String,
    /// What is missing, and what it means.
    pub what: String,
}

/// Why a URDF is no robot that can be simulated.
#[derive(Debug, thiserror::Error)]
pub enum UrdfError {
    /// More text than is read.
    #[error("the URDF has {bytes} bytes, more than {MAX_TEXT}")]
    TooLong {
        /// Its size.
        bytes: usize,
    },
    /// Not XML.
    #[error("line {line}: this is not XML: {cause}")]
    Xml {
        /// Where.
        line: u32,
        /// What the reader says.
        cause: String,
    },
    /// An element or attribute is missing, or says something that it cannot.
    #[error("line {line}: {what}")]
    Wrong {
        /// Where.
        line: u32,
        /// What.
        what: String,
        /// What to try.
        hint: &'static str,
    },
    /// Nobody waits for the scene any more.
    #[error("nobody waits for the scene any more")]
    NoLongerWanted,
    /// The side-car names something that is not there.
    #[error("the side-car names {what} \"{name}\", which the URDF does not have")]
    Unknown {
        /// What kind of thing.
        what: &'static str,
        /// Its name.
        name: String,
        /// Names that there are.
        known: Vec<String>,
    },
}
