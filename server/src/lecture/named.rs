//! Names of rooms that are chosen once, for links that stay the same: longer than any code, so that none is taken for one.

use axum::http::StatusCode;

use crate::problem::Problem;

/// Fewest and most letters of a name. Codes have five or six.
const SHORTEST: usize = 7;
const LONGEST: usize = 40;

/// What was typed, as codes and names are written: codes in capitals, names in small letters.
pub fn written(typed: &str) -> String {
    let typed = typed.trim();
    if typed.len() < SHORTEST { typed.to_uppercase() } else { typed.to_lowercase() }
}

/// The name that was typed, if it is one.
///
/// Errors if it is too short or too long, or has other letters.
pub fn name(typed: &str) -> Result<String, Problem> {
    let name = written(typed);
    let is_plain = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit();
    let is_name = (SHORTEST..=LONGEST).contains(&name.len())
        && name.split('-').all(|part| !part.is_empty() && part.bytes().all(is_plain));
    if is_name {
        return Ok(name);
    }
    let detail = format!("a room cannot be named {:?}", typed.chars().take(2 * LONGEST).collect::<String>());
    Err(Problem::new(
        StatusCode::UNPROCESSABLE_ENTITY,
        "invalid-room-name",
        detail,
        format!(
            "write {SHORTEST} to {LONGEST} letters a to z and digits, with single hyphens between: mbs-2026"
        ),
    )
    .at("/name", "no name of a room"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_an_address_and_no_code() {
        for typed in ["mbs-2026", " MBS-2026 ", "dynamics", "2026-winter-mks", &"a".repeat(40)] {
            assert_eq!(name(typed).as_deref(), Ok(typed.trim().to_lowercase().as_str()));
        }
        for typed in [
            "",
            "mbs-26",
            "-mbs-2026",
            "mbs--2026",
            "mbs 2026",
            "mbs/2026",
            "mbs.2026",
            "häufig-26",
            "ｍbs-2026",
        ] {
            assert_eq!(name(typed).expect_err(typed).code(), "invalid-room-name");
        }
        assert!(name(&"a".repeat(41)).is_err() && name(&"é".repeat(5000)).is_err());
        assert_eq!((written(" kxbcdf "), written("MBS-2026")), ("KXBCDF".to_owned(), "mbs-2026".to_owned()));
    }
}
