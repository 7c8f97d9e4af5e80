//! Units: reading what a student types, knowing its dimension, converting to SI.
//!
//! A [`Unit`] is a factor to SI base units and a [`Dimension`], seven integer exponents. Plane angle has no
//! dimension of its own: `rad` is 1 and `deg` is π/180, so `rad/s` and `1/s` agree.

use thiserror::Error;

pub use super::dimension::Dimension;
use super::dimension::MAX_EXPONENT;
use super::unit_table;
use triad_engine::scene::expression::{Cursor, plain_sign};

/// Longest unit text that is read, in characters.
const MAX_LENGTH: usize = 64;
/// Digits of an exponent that are read.
const MAX_EXPONENT_DIGITS: usize = 3;

/// A unit of measurement: 1 of it is `factor` in SI base units.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    /// Value of one unit in SI base units.
    pub factor: f64,
    /// Exponents of the base units.
    pub dimension: Dimension,
    text: String,
}

/// Why a unit could not be read. Each message says what to write instead.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum UnitError {
    /// A symbol that is no unit.
    #[error("\u{201c}{symbol}\u{201d} is not a unit I know{}", suggestion.as_ref().map(|s| format!("; did you mean {s}?")).unwrap_or_default())]
    Unknown {
        /// The symbol as written.
        symbol: String,
        /// A unit that was probably meant.
        suggestion: Option<String>,
    },
    /// A product after a slash can be read in two ways.
    #[error("\u{201c}{text}\u{201d} can be read in two ways; use brackets, for example kg/(m s)")]
    Ambiguous {
        /// The unit as written.
        text: String,
    },
    /// Something other than a unit at this place.
    #[error(
        "\u{201c}{text}\u{201d} cannot be read as a unit: {problem}; write it like N m, kg m/s^2 or rad/s"
    )]
    Syntax {
        /// The unit as written.
        text: String,
        /// What is wrong.
        problem: &'static str,
    },
}

impl UnitError {
    /// Stable short name of the kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Unknown { .. } => "unit-unknown",
            Self::Ambiguous { .. } => "unit-ambiguous",
            Self::Syntax { .. } => "unit-syntax",
        }
    }
}

impl Unit {
    /// The unit of a pure number.
    pub fn one() -> Self {
        Self { factor: 1.0, dimension: Dimension::default(), text: String::new() }
    }

    /// Reads a unit such as `N m`, `kg·m²/s²`, `mm/s^2`, `deg`, `rpm`. Empty text and `1` are the pure number.
    ///
    /// Errors if a symbol is unknown or the text is too long.
    pub fn parse(text: &str) -> Result<Self, UnitError> {
        let normal = normalise(text);
        if normal.chars().count() > MAX_LENGTH {
            let text: String = normal.chars().take(20).collect();
            return Err(UnitError::Syntax { text: format!("{text}…"), problem: "it is too long" });
        }
        let tokens = tokenize(&normal)?;
        let mut parser = Parser { text: &normal, tokens, at: 0 };
        let (factor, dimension) =
            if parser.tokens.is_empty() { (1.0, Dimension::default()) } else { parser.product(0)? };
        if parser.at < parser.tokens.len() {
            return Err(parser.syntax("a bracket is closed that was never opened"));
        }
        if !(factor.is_finite() && factor > 0.0) {
            return Err(parser.syntax("its size is out of range"));
        }
        Ok(Self { factor, dimension, text: normal })
    }

    /// The unit as it was written, with plain ASCII operators.
    pub fn text(&self) -> &str {
        &self.text
    }
}

/// True if a student who was asked for a moment in N m wrote millinewton instead.
pub fn is_millinewton_for_newton_metre(written: &Unit, wanted: &Unit) -> bool {
    written.text.trim() == "mN" && wanted.dimension == Dimension([2, 1, -2, 0, 0, 0, 0])
}

#[derive(Debug, Clone, PartialEq)]
enum Token {
    Symbol(String),
    One,
    Power(i32),
    Times,
    Slash,
    Open,
    Close,
}

/// Replaces typographic signs by plain ones: those of every answer, and also ², ⁻ and µ.
fn normalise(text: &str) -> String {
    let mut out = String::new();
    let mut in_superscript = false;
    for c in text.trim().chars() {
        let superscript = "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|s| s == c).map(|d| char::from(b"0123456789"[d]));
        let mark = superscript.or(if c == '⁻' { Some('-') } else { None });
        if let Some(mark) = mark {
            if !in_superscript {
                out.push('^');
            }
            out.push(mark);
        } else {
            out.push(match c {
                '\u{b5}' | '\u{3bc}' => 'u',
                other => plain_sign(other),
            });
        }
        in_superscript = mark.is_some();
    }
    out
}

fn tokenize(text: &str) -> Result<Vec<Token>, UnitError> {
    let syntax = |problem| UnitError::Syntax { text: text.to_owned(), problem };
    let power = |cursor: &mut Cursor| {
        exponent(cursor).map(Token::Power).ok_or_else(|| syntax("an exponent is a whole number"))
    };
    let in_symbol = |c: char| c.is_alphabetic() || c == '°';
    let mut cursor = Cursor::new(text);
    let mut tokens = Vec::new();
    while let Some(c) = cursor.peek() {
        if in_symbol(c) {
            tokens.push(Token::Symbol(cursor.take_while(usize::MAX, in_symbol)));
            // kg m2, s-1: a number glued to a symbol is its exponent.
            if cursor.peek().is_some_and(|c| c.is_ascii_digit() || c == '-') {
                tokens.push(power(&mut cursor)?);
            }
            continue;
        }
        cursor.next();
        match c {
            ' ' | '\t' => {}
            '*' if cursor.take(&['*']).is_some() => tokens.push(power(&mut cursor)?),
            '^' => tokens.push(power(&mut cursor)?),
            '*' => tokens.push(Token::Times),
            '/' => tokens.push(Token::Slash),
            '(' => tokens.push(Token::Open),
            ')' => tokens.push(Token::Close),
            '1' if !cursor.peek().is_some_and(|c| c.is_ascii_digit()) => tokens.push(Token::One),
            c if c.is_ascii_digit() => return Err(syntax("a number belongs into the field of the value")),
            _ => return Err(syntax("it has a sign that does not belong there")),
        }
    }
    Ok(tokens)
}

/// A whole number after `^`, perhaps in brackets.
fn exponent(cursor: &mut Cursor) -> Option<i32> {
    let open = cursor.take(&['(']).is_some();
    let mut text: String = cursor.take(&['-', '+']).into_iter().filter(|c| *c == '-').collect();
    text += &cursor.take_while(MAX_EXPONENT_DIGITS, |c| c.is_ascii_digit());
    if open {
        cursor.take(&[')'])?;
    }
    text.parse().ok().filter(|e: &i32| e.abs() <= MAX_EXPONENT)
}

struct Parser<'a> {
    text: &'a str,
    tokens: Vec<Token>,
    at: usize,
}

impl Parser<'_> {
    fn syntax(&self, problem: &'static str) -> UnitError {
        UnitError::Syntax { text: self.text.to_owned(), problem }
    }

    fn product(&mut self, depth: usize) -> Result<(f64, Dimension), UnitError> {
        if depth > 8 {
            return Err(self.syntax("brackets are nested too deeply"));
        }
        let (mut factor, mut dimension) = self.power(depth)?;
        let mut divided = false;
        while let Some(token) = self.tokens.get(self.at) {
            let sign = match token {
                Token::Close => break,
                Token::Slash => {
                    self.at += 1;
                    divided = true;
                    -1
                }
                Token::Times => {
                    self.at += 1;
                    1
                }
                _ => 1,
            };
            if divided && sign == 1 {
                return Err(UnitError::Ambiguous { text: self.text.to_owned() });
            }
            let (f, d) = self.power(depth)?;
            factor *= libm::pow(f, f64::from(sign));
            dimension =
                dimension.combine(d, sign).ok_or_else(|| self.syntax("its exponents are out of range"))?;
        }
        Ok((factor, dimension))
    }

    fn power(&mut self, depth: usize) -> Result<(f64, Dimension), UnitError> {
        let base = match self.tokens.get(self.at).cloned() {
            Some(Token::Symbol(symbol)) => {
                self.at += 1;
                unit_table::lookup(&symbol)
                    .map_err(|suggestion| UnitError::Unknown { symbol: symbol.clone(), suggestion })?
            }
            Some(Token::One) => {
                self.at += 1;
                (1.0, Dimension::default())
            }
            Some(Token::Open) => {
                self.at += 1;
                let inner = self.product(depth + 1)?;
                if self.tokens.get(self.at) != Some(&Token::Close) {
                    return Err(self.syntax("a bracket is not closed"));
                }
                self.at += 1;
                inner
            }
            _ => return Err(self.syntax("a unit is missing next to an operator")),
        };
        let Some(Token::Power(power)) = self.tokens.get(self.at).cloned() else { return Ok(base) };
        self.at += 1;
        let dimension = Dimension::default()
            .combine(base.1, power)
            .ok_or_else(|| self.syntax("its exponents are out of range"))?;
        Ok((libm::pow(base.0, f64::from(power)), dimension))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(text: &str) -> Unit {
        Unit::parse(text).unwrap_or_else(|e| panic!("{text}: {e}"))
    }

    #[test]
    fn one_force_written_in_many_ways() {
        for text in ["N", "kg m/s^2", "kg*m/s²", "kg·m·s⁻²", "kg m s-2", "kg m/s/s", "J/m"] {
            let unit = unit(text);
            assert_eq!(unit.dimension, Dimension([1, 1, -2, 0, 0, 0, 0]), "{text}");
            assert!((unit.factor - 1.0).abs() < 1e-15, "{text}");
        }
    }

    #[test]
    fn prefixes_and_angles_convert() {
        assert!((unit("kN").factor - 1e3).abs() < 1e-12);
        assert!((unit("mm/s^2").factor - 1e-3).abs() < 1e-18);
        assert!((unit("deg").factor - 0.017_453_292_519_943_295).abs() < 1e-18);
        assert!((unit("rpm").factor - 0.104_719_755_119_659_77).abs() < 1e-17);
        assert!((unit("µm").factor - 1e-6).abs() < 1e-20 && (unit("μm").factor - 1e-6).abs() < 1e-20);
        assert!((unit("g cm^2").factor - 1e-7).abs() < 1e-21);
        assert_eq!(unit("rad/s").dimension, unit("1/s").dimension);
    }

    #[test]
    fn millinewton_is_not_newton_metre() {
        assert_eq!(unit("mN").dimension, unit("N").dimension);
        assert_eq!(unit("N m").dimension, unit("Nm").dimension);
        assert!(is_millinewton_for_newton_metre(&unit("mN"), &unit("N m")));
        assert!(!is_millinewton_for_newton_metre(&unit("mN"), &unit("N")));
    }

    #[test]
    fn errors_of_units_say_what_to_write() {
        let hint = |t: &str| Unit::parse(t).unwrap_err().to_string();
        assert!(hint("n").contains("did you mean N?"), "{}", hint("n"));
        assert!(hint("Kg").contains("kg"));
        assert!(hint("seconds").contains("did you mean s?"));
        assert!(hint("kg/m s").contains("two ways"));
        assert!(hint("kg/m*s").contains("two ways"));
        for bad in ["m^x", "m^99", "(m", "m)", "/s", "m//s", "12 N", "m^", "$", "((((((((((m))))))))))"] {
            assert!(Unit::parse(bad).is_err(), "{bad}");
        }
        assert!(Unit::parse(&"m ".repeat(400)).is_err());
    }

    #[test]
    fn unknown_names_the_symbol() {
        assert_eq!(
            Unit::parse("blob"),
            Err(UnitError::Unknown { symbol: "blob".to_owned(), suggestion: None })
        );
    }
}
