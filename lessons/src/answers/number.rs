//! Numbers as students type them: `-9.81`, `1,5`, `2.4e-3`, `2.4×10^-3`, `29.43 N`.
//!
//! Besides the value, the digits that were written are kept, since they say how precise the answer can be.

use thiserror::Error;

use crate::text::shorten;
use triad_engine::scene::expression::{Cursor, normalise};

/// Longest number text that is read, in characters.
const MAX_LENGTH: usize = 80;

/// A number with the precision it was written with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParsedNumber {
    /// The value.
    pub value: f64,
    /// Half a unit in the last written decimal place: what rounding may have changed. Zero for a written zero.
    pub half_ulp_decimal: f64,
}

/// Why a number could not be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum NumberError {
    /// Nothing there.
    #[error("there is no number here; write one such as -1.25 or 3.2e-4")]
    Empty,
    /// Not a number.
    #[error("\u{201c}{text}\u{201d} is not a number; write digits such as -1.25 or 3.2e-4")]
    NotANumber {
        /// What was written, shortened.
        text: String,
    },
    /// A comma that may separate thousands or decimals.
    #[error("the comma in \u{201c}{text}\u{201d} can be read in two ways; write the decimal sign as a point")]
    AmbiguousComma {
        /// What was written.
        text: String,
    },
    /// Infinite, not a number, or too large to be held.
    #[error("\u{201c}{text}\u{201d} is not a finite number")]
    NotFinite {
        /// What was written.
        text: String,
    },
}

impl NumberError {
    /// Stable short name of the kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Empty => "number-empty",
            Self::NotANumber { .. } => "number-unreadable",
            Self::AmbiguousComma { .. } => "number-comma",
            Self::NotFinite { .. } => "number-not-finite",
        }
    }
}

/// Reads a number and hands back the text after it (a unit, perhaps), trimmed and with plain signs.
///
/// Errors if no finite number begins the text.
pub fn read(text: &str) -> Result<(ParsedNumber, String), NumberError> {
    let not_a_number = || NumberError::NotANumber { text: shorten(text) };
    let normal = normalise(text);
    if normal.is_empty() {
        return Err(NumberError::Empty);
    }
    if normal.chars().count() > MAX_LENGTH {
        return Err(not_a_number());
    }
    let lower = normal.to_lowercase();
    if lower.trim_start_matches(['-', '+']).starts_with("inf") || lower.starts_with("nan") {
        return Err(NumberError::NotFinite { text: shorten(text) });
    }
    let mut cursor = Cursor::new(&normal);
    let mantissa = mantissa(&mut cursor, text)?;
    let after = cursor.rest();
    let (exponent, rest) = exponent(&after);
    if rest.starts_with(|c: char| c.is_ascii_digit() || c == '.' || c == ',') {
        return Err(not_a_number());
    }
    let value: f64 = format!("{mantissa}e{exponent}").parse().map_err(|_| not_a_number())?;
    if !value.is_finite() {
        return Err(NumberError::NotFinite { text: shorten(text) });
    }
    let decimals = mantissa.split('.').nth(1).map_or(0, str::len);
    let power = exponent - i32::try_from(decimals).unwrap_or(0);
    let half_ulp_decimal = if value == 0.0 { 0.0 } else { 0.5 * libm::pow(10.0, f64::from(power)) };
    Ok((ParsedNumber { value, half_ulp_decimal }, rest.trim().to_owned()))
}

/// Sign, digits and decimal sign, the latter as a point.
fn mantissa(cursor: &mut Cursor, text: &str) -> Result<String, NumberError> {
    let mut mantissa: String = cursor.take(&['+', '-']).into_iter().collect();
    mantissa += &cursor.take_while(usize::MAX, |c| c.is_ascii_digit() || c == '.' || c == ',');
    let count = |wanted: char| mantissa.chars().filter(|c| *c == wanted).count();
    let (points, commas) = (count('.'), count(','));
    if !mantissa.contains(|c: char| c.is_ascii_digit()) || points > 1 {
        return Err(NumberError::NotANumber { text: shorten(text) });
    }
    if commas > 0 {
        // Three digits after a comma may be thousands.
        let after = mantissa.rsplit(',').next().map_or(0, str::len);
        if commas > 1 || points > 0 || after == 3 || after == 0 {
            return Err(NumberError::AmbiguousComma { text: shorten(text) });
        }
    }
    Ok(mantissa.replace(',', "."))
}

/// The power of ten after the mantissa (`e-3`, `*10^-3`, `x10^-3`) and what follows it.
fn exponent(rest: &str) -> (i32, &str) {
    let power_of_ten = || {
        let factor = rest.trim_start().strip_prefix(['*', 'x'])?;
        factor.trim_start().strip_prefix("10")?.strip_prefix('^')
    };
    let Some(body) = rest.strip_prefix(['e', 'E']).or_else(power_of_ten) else { return (0, rest) };
    let sign = usize::from(body.starts_with(['-', '+']));
    let digits = body[sign..].bytes().take_while(u8::is_ascii_digit).count();
    if digits == 0 || digits > 3 {
        return (0, rest);
    }
    match body[..sign + digits].trim_start_matches('+').parse() {
        Ok(power) => (power, &body[sign + digits..]),
        Err(_) => (0, rest),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        read(text).unwrap_or_else(|e| panic!("{text}: {e}")).0.value
    }

    #[test]
    fn usual_spellings() {
        assert_eq!(value("-9.81"), -9.81);
        assert_eq!(value("\u{2212}9,81"), -9.81);
        assert_eq!(value("+.5"), 0.5);
        assert_eq!(value("2.4e-3"), 2.4e-3);
        assert_eq!(value("2.4 × 10^-3"), 2.4e-3);
        assert_eq!(value("2.4*10^3"), 2400.0);
        assert_eq!(value("1234567.5"), 1_234_567.5);
    }

    #[test]
    fn unit_behind_the_number_is_handed_back() {
        assert_eq!(read("29.43 N").unwrap().1, "N");
        assert_eq!(read("29.43N m").unwrap().1, "N m");
        assert_eq!(read("3 m/s").unwrap().1, "m/s");
    }

    #[test]
    fn written_digits_are_counted() {
        let half = |t: &str| read(t).unwrap().0.half_ulp_decimal;
        assert!((half("29") - 0.5).abs() < 1e-15);
        assert!((half("29.40") - 0.005).abs() < 1e-15);
        assert!((half("2.94e1") - 0.05).abs() < 1e-15);
        assert_eq!(half("0"), 0.0);
    }

    #[test]
    fn text_and_traps_are_refused() {
        assert_eq!(read(""), Err(NumberError::Empty));
        assert!(matches!(read("abc"), Err(NumberError::NotANumber { .. })));
        assert!(matches!(read("1,500"), Err(NumberError::AmbiguousComma { .. })));
        assert!(matches!(read("1.2.3"), Err(NumberError::NotANumber { .. })));
        assert!(matches!(read("NaN"), Err(NumberError::NotFinite { .. })));
        assert!(matches!(read("-inf"), Err(NumberError::NotFinite { .. })));
        assert!(matches!(read("1e999"), Err(NumberError::NotFinite { .. })));
        assert!(matches!(read("-"), Err(NumberError::NotANumber { .. })));
        assert!(matches!(read("1e5.5"), Err(NumberError::NotANumber { .. })));
        assert!(read(&"9".repeat(5000)).is_err());
    }
}
