//! Numbers as students type them: `-9.81`, `1,5`, `2.4e-3`, `2.4×10^-3`, `29.43 N`, `F = 3*9.81`, `8/13`, `(29.43)`.
//!
//! Besides the value, the digits that were written are kept, since they say how precise the answer can be.

use thiserror::Error;
use triad_engine::scene::expression::{Cursor, begins_factor, leading_value, notation};

use super::factors::{Sign, mixed, next_factor, times_unit};
use crate::text::shorten;

/// Longest number text that is read, in characters.
const MAX_LENGTH: usize = 200;

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

/// Reads a number, or a little arithmetic (`3*9.81`, `sqrt(2)`, `3 kg * 9.81 m/s^2`), and hands back the text after it (a
/// unit, perhaps), trimmed and in plain notation. What decorates it (`F =`, `≈`, brackets, `± 0.1`) is left out.
///
/// Errors if no finite number begins the text.
pub fn read(text: &str) -> Result<(ParsedNumber, String), NumberError> {
    let (mut number, mut unit) = one(text)?;
    while let Some((before, sign, factor)) = next_factor(&unit) {
        let (other, behind) = one(factor)?;
        let value = match sign {
            Sign::Times => number.value * other.value,
            Sign::Over => number.value / other.value,
        };
        number = ParsedNumber { value, half_ulp_decimal: 0.0 };
        // The unit of the factor may be followed by another one.
        let (own, more) =
            next_factor(&behind).map_or((behind.as_str(), ""), |(own, ..)| (own, &behind[own.len()..]));
        unit = times_unit(before, sign, own) + more;
    }
    if number.value.is_finite() {
        Ok((number, unit))
    } else {
        Err(NumberError::NotFinite { text: shorten(text) })
    }
}

/// One number, or arithmetic without units, and the text after it.
fn one(text: &str) -> Result<(ParsedNumber, String), NumberError> {
    let not_a_number = || NumberError::NotANumber { text: shorten(text) };
    if text.chars().count() > MAX_LENGTH {
        return Err(not_a_number());
    }
    let plain = notation::plain(text);
    let answer = notation::undecorated(&plain);
    let spelled = answer.strip_prefix("minus ").map(|size| format!("-{}", size.trim_start()));
    let answer = spelled.as_deref().unwrap_or(answer);
    if answer.is_empty() {
        return Err(NumberError::Empty);
    }
    let lower = answer.to_lowercase();
    let unsigned = lower.trim_start_matches(['-', '+', ' ']);
    if unsigned.starts_with("inf") || unsigned.starts_with("nan") {
        return Err(NumberError::NotFinite { text: shorten(text) });
    }
    if has_power_without_sign(answer) {
        return Err(not_a_number());
    }
    let (number, rest) = match literal(answer) {
        _ if let Some((value, rest)) = mixed(answer).filter(|(_, rest)| ends_value(rest)) => {
            (ParsedNumber { value, half_ulp_decimal: 0.0 }, rest.to_owned())
        }
        Some(Err(Comma)) => return Err(NumberError::AmbiguousComma { text: shorten(text) }),
        Some(Ok((number, rest))) if ends_value(without_uncertainty(&number, &rest)) => {
            (number, without_uncertainty(&number, &rest).to_owned())
        }
        found => match (leading_value(answer), found) {
            (Some((value, rest)), _) if ends_value(&rest) => {
                (ParsedNumber { value, half_ulp_decimal: 0.0 }, rest)
            }
            _ => return word(&lower).ok_or_else(not_a_number),
        },
    };
    if !number.value.is_finite() {
        return Err(NumberError::NotFinite { text: shorten(text) });
    }
    Ok((number, rest.trim().trim_start_matches('*').trim().to_owned()))
}

/// Without the uncertainty of the last digits, as in `200.0(5) mm`, which stands close behind decimals.
fn without_uncertainty<'a>(number: &ParsedNumber, rest: &'a str) -> &'a str {
    let decimals = (0.0..0.5).contains(&number.half_ulp_decimal) && number.value != 0.0;
    let uncertain = rest.strip_prefix('(').filter(|_| decimals).and_then(|inner| inner.split_once(')'));
    match uncertain {
        Some((digits, behind)) if !digits.is_empty() && digits.bytes().all(|c| c.is_ascii_digit()) => behind,
        _ => rest,
    }
}

/// Whether a power of ten has lost its `^`, as in `2.4 x 10-3` copied from a page: it could be read as 21.
fn has_power_without_sign(answer: &str) -> bool {
    let behind = answer.match_indices(['x', 'X', '*']).map(|(k, sign)| answer[k + sign.len()..].trim_start());
    behind.filter_map(|text| text.strip_prefix("10")).any(|text| {
        let after = text.strip_prefix(['-', '+']);
        after.is_some_and(|digits| digits.starts_with(|c: char| c.is_ascii_digit()))
    })
}

/// Whether the text behind a value can be a unit, or is nothing: not more of the number, nor a sign of calculation.
fn ends_value(rest: &str) -> bool {
    let after = rest.trim_start();
    let unit = after.trim_start_matches('*').trim_start();
    match (after.chars().next(), unit.chars().next()) {
        (None, _) => true,
        _ if begins_factor(unit) => false,
        (Some('/'), _) => after[1..].trim_start().starts_with(|c: char| c.is_alphabetic() || c == '('),
        (Some('*'), Some(c)) => c.is_alphabetic() || c == '°',
        (Some('1'), _) => after.starts_with("1/") && rest.starts_with(' '),
        (Some(c), _) => c.is_alphabetic() || "°%([{".contains(c) && unit_in_brackets(after),
    }
}

/// Whether a bracket behind a number holds a unit: `29.4 [N]`, not `3 (4)`.
fn unit_in_brackets(after: &str) -> bool {
    let inner = after.trim_start_matches(['(', '[', '{', ' ']);
    after.starts_with(['°', '%']) || inner.starts_with(|c: char| c.is_alphabetic() || "°%1".contains(c))
}

/// A comma that can be read in two ways.
struct Comma;

/// A number written out at the beginning of a text, with its precision, and the rest; `None` if there is none.
fn literal(answer: &str) -> Option<Result<(ParsedNumber, String), Comma>> {
    let mut cursor = Cursor::new(answer);
    let sign = cursor.take(&['+', '-']).filter(|c| *c == '-');
    cursor.take_while(usize::MAX, |c| c == ' ');
    let digits = digits(&mut cursor);
    let after = cursor.rest();
    let (exponent, rest) = exponent(&after);
    let mantissa = match decimal(&digits)? {
        Ok(mantissa) => mantissa,
        // One digit in front, a power of ten behind: scientific notation.
        Err(_) if rest.len() < after.len() && digits.find(',') == Some(1) => digits.replace(',', "."),
        Err(comma) => return Some(Err(comma)),
    };
    let sign = if sign.is_some() { "-" } else { "" };
    let value: f64 = format!("{sign}{mantissa}e{exponent}").parse().ok()?;
    let decimals = mantissa.split('.').nth(1).map_or(0, str::len);
    let power = exponent - i32::try_from(decimals).unwrap_or(0);
    let half_ulp_decimal = if value == 0.0 { 0.0 } else { 0.5 * power_of_ten(power) };
    Some(Ok((ParsedNumber { value, half_ulp_decimal }, rest.to_owned())))
}

/// 10 to a whole power, rounded once.
fn power_of_ten(power: i32) -> f64 {
    format!("1e{power}").parse().unwrap_or(0.0)
}

/// Digits with signs between them; a space, an apostrophe or a low line is taken where three digits follow, as in
/// 1 234.5.
fn digits(cursor: &mut Cursor) -> String {
    let mut digits = String::new();
    loop {
        digits += &cursor.take_while(usize::MAX, |c| c.is_ascii_digit() || c == '.' || c == ',');
        let group = matches!(cursor.peek(), Some(' ' | '\'' | '_'))
            && (1..=3).all(|k| cursor.peek_at(k).is_some_and(|c| c.is_ascii_digit()))
            && !cursor.peek_at(4).is_some_and(|c| c.is_ascii_digit())
            && !digits.is_empty()
            && digits.chars().all(|c| c.is_ascii_digit());
        if !group {
            return digits;
        }
        cursor.take_next();
    }
}

/// The digits with a point as their decimal sign; `None` if they are no number.
fn decimal(digits: &str) -> Option<Result<String, Comma>> {
    let count = |wanted: char| digits.chars().filter(|c| *c == wanted).count();
    if !digits.contains(|c: char| c.is_ascii_digit()) {
        return None;
    }
    // Digits in groups of three behind a first one of one to three, none of which begins with a zero.
    let grouped = |text: &str, sign: char| {
        let mut groups = text.split(sign);
        let first = groups.next().unwrap_or_default();
        (1..=3).contains(&first.len()) && !first.starts_with('0') && groups.all(|group| group.len() == 3)
    };
    let without = |sign: char| digits.replace(sign, "");
    Some(Ok(match (count('.'), count(',')) {
        (0 | 1, 0) => digits.to_owned(),
        (0, 1) => {
            let (before, after) = digits.split_once(',')?;
            if after.len() == 3 && grouped(digits, ',') && !before.is_empty() {
                return Some(Err(Comma));
            }
            digits.replace(',', ".")
        }
        (_, 0) if grouped(digits, '.') => without('.'),
        (0, _) if grouped(digits, ',') => without(','),
        (1, _) if digits.rfind('.') > digits.rfind(',') && grouped(digits.split('.').next()?, ',') => {
            without(',')
        }
        (_, 1) if digits.rfind(',') > digits.rfind('.') && grouped(digits.split(',').next()?, '.') => {
            without('.').replace(',', ".")
        }
        _ => return None,
    }))
}

/// The power of ten after the mantissa (`e-3`, `*10^-3`, `x10^(-3)`, `E 03`) and what follows it.
fn exponent(rest: &str) -> (i32, &str) {
    let power_of_ten = || {
        let factor = rest.trim_start().strip_prefix(['*', 'x', 'X'])?;
        factor.trim_start().strip_prefix("10")?.trim_start().strip_prefix(['^'])
    };
    let letter = || {
        let body = rest.trim_start().strip_prefix(['e', 'E', 'd', 'D'])?;
        let signed = body.starts_with(['+', '-']);
        let fortran = rest.trim_start().starts_with(['d', 'D']);
        // `2 E3` is 2000; `2 d3` and `2d3` may be anything.
        (signed || !fortran).then_some(body)
    };
    let Some(body) = letter().or_else(power_of_ten) else { return (0, rest) };
    let (body, bracket) = body.strip_prefix('(').map_or((body, false), |inner| (inner, true));
    let sign = usize::from(body.starts_with(['-', '+']));
    let digits = body[sign..].bytes().take_while(u8::is_ascii_digit).count();
    if digits == 0 || digits > 3 {
        return (0, rest);
    }
    let Ok(power) = body[..sign + digits].trim_start_matches('+').parse() else { return (0, rest) };
    let after = &body[sign + digits..];
    match (bracket, after.strip_prefix(')')) {
        (true, Some(after)) => (power, after),
        (true, None) => (0, rest),
        (false, _) => (power, after),
    }
}

/// A small number as a word.
fn word(lower: &str) -> Option<(ParsedNumber, String)> {
    const WORDS: [&str; 13] = [
        "zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven",
        "twelve",
    ];
    let (first, rest) = lower.split_once(' ').unwrap_or((lower, ""));
    let value = WORDS.iter().position(|word| *word == first).or((lower == "none").then_some(0))?;
    Some((ParsedNumber { value: value as f64, half_ulp_decimal: 0.0 }, rest.to_owned()))
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
    #[allow(clippy::too_many_lines)] // one line for each way to write a number
    fn further_spellings() {
        for (text, wanted) in [
            ("- 2", -2.0),
            ("29,", 29.0),
            ("0,404", 0.404),
            ("1.234,5", 1234.5),
            ("1,234.5", 1234.5),
            ("1 234,5", 1234.5),
            ("1'234", 1234.0),
            ("1,234,567", 1_234_567.0),
            ("1234,567", 1234.567),
            ("2.4·10⁻³", 2.4e-3),
            ("2.4E-03", 2.4e-3),
            ("2.4D-03", 2.4e-3),
            ("2.4 x 10^(-3)", 2.4e-3),
            ("2.4 e-3", 2.4e-3),
            ("= 29.4", 29.4),
            ("≈29.4", 29.4),
            ("F_x = −3", -3.0),
            ("(29.43)", 29.43),
            ("3*9.81", 29.43),
            ("8/13", 8.0 / 13.0),
            ("2^8", 256.0),
            ("three", 3.0),
            ("sqrt(19.62)", 19.62f64.sqrt()),
            ("2π", std::f64::consts::TAU),
            ("π/2", std::f64::consts::FRAC_PI_2),
            ("½", 0.5),
            ("1½", 1.5),
            ("１２", 12.0),
            (r"$\frac{8}{13}$", 8.0 / 13.0),
            ("-(3)", -3.0),
            ("10^-8", 1e-8),
            ("3,5*2", 7.0),
            ("none", 0.0),
            ("29.4 ± 0.1", 29.4),
            ("2.36 +- 0.01", 2.36),
            ("200.0(5) mm", 200.0),
            ("2(3)", 6.0),
            ("=> 4", 4.0),
            ("-> 4", 4.0),
            ("4,429e0", 4.429),
            ("2.9 E1", 29.0),
            ("2π√4", 4.0 * std::f64::consts::PI),
            ("9 3/8", 9.375),
            ("-1 1/2", -1.5),
            ("minus 0.35", -0.35),
            ("3 kg * 9.81 m/s^2", 29.43),
            ("3kg·9.81m/s²·2", 58.86),
            ("30 N / 4 kg", 7.5),
            ("-.5", -0.5),
            ("+ 3", 3.0),
        ] {
            let got = value(text);
            assert!((got - wanted).abs() <= 1e-15 * wanted.abs(), "{text}: {got}");
        }
        assert_eq!(read("11 rows").unwrap().1, "rows");
        assert_eq!(read("29.4 [N]").unwrap().1, "[N]");
        assert_eq!(read("29.4*N").unwrap().1, "N");
        assert_eq!(read("0.1 %").unwrap().1, "%");
        assert_eq!(read("3/s").unwrap().1, "/s");
        assert_eq!(read("3 1/s").unwrap().1, "1/s");
        assert_eq!(read("30°").unwrap().1, "°");
        assert_eq!(read("3 kg * 9.81 m/s^2").unwrap().1, "kg*m/s^2");
        assert_eq!(read("3 m/s * 2 s").unwrap().1, "(m/s)*s");
        assert_eq!(read("30 N / 4 kg").unwrap().1, "N/(kg)");
        assert_eq!(read("3 kg m**2").unwrap().1, "kg m**2");
        assert_eq!(
            read("3e2m").unwrap(),
            (ParsedNumber { value: 300.0, half_ulp_decimal: 50.0 }, "m".to_owned())
        );
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
        assert!(matches!(read("-2,368"), Err(NumberError::AmbiguousComma { .. })));
        for text in ["1.2.3", "1,2,3", "12,34.5", "2.4x10-3", "3 4", "1 2345", "29.4+", "2..5", "29.4 30"] {
            assert!(matches!(read(text), Err(NumberError::NotANumber { .. })), "{text} {:?}", read(text));
        }
        assert!(matches!(read("NaN"), Err(NumberError::NotFinite { .. })));
        assert!(matches!(read("-inf"), Err(NumberError::NotFinite { .. })));
        assert!(matches!(read("1e999"), Err(NumberError::NotFinite { .. })));
        assert!(matches!(read("-"), Err(NumberError::NotANumber { .. })));
        assert!(matches!(read("1e5.5"), Err(NumberError::NotANumber { .. })));
        assert!(read(&"9".repeat(5000)).is_err());
    }
}
