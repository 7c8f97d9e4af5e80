//! Where a gradebook is.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use sqlx::any::AnyConnectOptions;

/// Where a gradebook is: the path of a file, or the address of a server, as `--database` has it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Location {
    /// A file of SQLite.
    File(PathBuf),
    /// A database of a PostgreSQL server, as `postgres://user@host/name`.
    Server(String),
}

impl FromStr for Location {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if ["postgres://", "postgresql://"].iter().any(|scheme| text.starts_with(scheme)) {
            return match AnyConnectOptions::from_str(text) {
                Ok(_) => Ok(Self::Server(text.to_owned())),
                Err(error) => Err(format!("{error}; as in postgres://triad@localhost/grades")),
            };
        }
        if let Some((scheme, _)) = text.split_once("://") {
            return Err(format!("{scheme} is no database for a gradebook: name a file, or postgres://…"));
        }
        Ok(Self::File(text.into()))
    }
}

impl fmt::Display for Location {
    /// Without the password: this is printed and logged.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(path) => path.display().fmt(f),
            Self::Server(url) => {
                let (scheme, rest) = url.split_once("://").unwrap_or(("postgres", url));
                // A password may stand before the host or among the parameters.
                let rest = rest.split_once('?').map_or(rest, |(place, _)| place);
                let (user, place) = rest.rsplit_once('@').unwrap_or(("", rest));
                let user = user.split_once(':').map_or(user, |(user, _)| user);
                let at = if user.is_empty() { "" } else { "@" };
                write!(f, "{scheme}://{user}{at}{place}")
            }
        }
    }
}
