//! Units: reading what a student types, knowing its dimension, converting to SI.
//!
//! A [`Unit`] is a factor to SI base units and a [`Dimension`], seven integer exponents. Plane angle has no
//! dimension of its own: `rad` is 1 and `deg` is π/180, so `rad/s` and `1/s` agree.

mod table;

use std::fmt;

use thiserror::Error;

use table::lookup;

/// Longest unit text that is read, in characters.
const MAX_LENGTH: usize = 64;
/// Largest exponent that is accepted.
const MAX_EXPONENT: i32 = 12;

/// Exponents of m, kg, s, A, K, mol and cd.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Dimension(pub [i32; 7]);

impl Dimension {
    /// Name of the dimension for a sentence ("force", "moment or energy"), if it has a common one.
    pub fn name(self) -> Option<&'static str> {
        Some(match self.0 {
            [0, 0, 0, 0, 0, 0, 0] => "a number without dimension (or an angle)",
            [1, 0, 0, 0, 0, 0, 0] => "a length",
            [0, 1, 0, 0, 0, 0, 0] => "a mass",
            [0, 0, 1, 0, 0, 0, 0] => "a time",
            [1, 0, -1, 0, 0, 0, 0] => "a speed",
            [1, 0, -2, 0, 0, 0, 0] => "an acceleration",
            [0, 0, -1, 0, 0, 0, 0] => "an angular speed or a frequency",
            [0, 0, -2, 0, 0, 0, 0] => "an angular acceleration",
            [1, 1, -2, 0, 0, 0, 0] => "a force",
            [2, 1, -2, 0, 0, 0, 0] => "a moment or an energy",
            [2, 1, -3, 0, 0, 0, 0] => "a power",
            [2, 1, 0, 0, 0, 0, 0] => "a moment of inertia",
            [1, 1, -1, 0, 0, 0, 0] => "a momentum",
            [2, 1, -1, 0, 0, 0, 0] => "an angular momentum",
            [0, 1, -2, 0, 0, 0, 0] => "a stiffness (force per length)",
            [2, 0, 0, 0, 0, 0, 0] => "an area",
            [3, 0, 0, 0, 0, 0, 0] => "a volume",
            [2, 0, -2, 0, 0, 0, 0] => "a squared speed",
            _ => return None,
        })
    }

    fn combine(self, other: Self, power: i32) -> Option<Self> {
        let mut out = self.0;
        for (a, b) in out.iter_mut().zip(other.0) {
            *a = b.checked_mul(power).and_then(|b| a.checked_add(b)).filter(|e| e.abs() <= MAX_EXPONENT)?;
        }
        Some(Self(out))
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(name) = self.name() {
            return f.write_str(name);
        }
        let names = ["m", "kg", "s", "A", "K", "mol", "cd"];
        let mut first = true;
        for (name, exponent) in names.iter().zip(self.0).filter(|(_, e)| *e != 0) {
            if !first {
                f.write_str(" ")?;
            }
            first = false;
            if exponent == 1 { f.write_str(name)? } else { write!(f, "{name}^{exponent}")? }
        }
        Ok(())
    }
}

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

/// Replaces the signs of word processors (·, ², µ, −) by plain ones.
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
                '·' | '⋅' | '×' | '∙' => '*',
                '\u{b5}' | '\u{3bc}' => 'u',
                '\u{2212}' | '\u{2013}' => '-',
                '\u{a0}' | '\u{202f}' | '\u{2009}' => ' ',
                '\u{2215}' | '\u{2044}' => '/',
                other => other,
            });
        }
        in_superscript = mark.is_some();
    }
    out
}

fn tokenize(text: &str) -> Result<Vec<Token>, UnitError> {
    let syntax = |problem| UnitError::Syntax { text: text.to_owned(), problem };
    let chars: Vec<char> = text.chars().collect();
    let mut tokens = Vec::new();
    let mut i = 0;
    while i < chars.len() {
        let c = chars[i];
        i += 1;
        match c {
            ' ' | '\t' => {}
            '*' if chars.get(i) == Some(&'*') => {
                i += 1;
                tokens.push(Token::Power(
                    exponent(&chars, &mut i).ok_or_else(|| syntax("an exponent is a whole number"))?,
                ));
            }
            '*' => tokens.push(Token::Times),
            '/' => tokens.push(Token::Slash),
            '(' => tokens.push(Token::Open),
            ')' => tokens.push(Token::Close),
            '^' => tokens.push(Token::Power(
                exponent(&chars, &mut i).ok_or_else(|| syntax("an exponent is a whole number"))?,
            )),
            '1' if !chars.get(i).is_some_and(char::is_ascii_digit) => tokens.push(Token::One),
            c if c.is_alphabetic() || c == '°' => {
                let start = i - 1;
                while chars.get(i).is_some_and(|c| c.is_alphabetic() || *c == '°') {
                    i += 1;
                }
                tokens.push(Token::Symbol(chars[start..i].iter().collect()));
                // kg m2, s-1: a number glued to a symbol is its exponent.
                if chars.get(i).is_some_and(|c| c.is_ascii_digit() || *c == '-') {
                    tokens.push(Token::Power(
                        exponent(&chars, &mut i).ok_or_else(|| syntax("an exponent is a whole number"))?,
                    ));
                }
            }
            c if c.is_ascii_digit() => return Err(syntax("a number belongs into the field of the value")),
            _ => return Err(syntax("it has a sign that does not belong there")),
        }
    }
    Ok(tokens)
}

fn exponent(chars: &[char], i: &mut usize) -> Option<i32> {
    let open = chars.get(*i) == Some(&'(');
    if open {
        *i += 1;
    }
    let start = *i;
    if matches!(chars.get(*i), Some('-' | '+')) {
        *i += 1;
    }
    while chars.get(*i).is_some_and(char::is_ascii_digit) && *i - start < 4 {
        *i += 1;
    }
    let text: String = chars[start..*i].iter().filter(|c| **c != '+').collect();
    if open {
        if chars.get(*i) != Some(&')') {
            return None;
        }
        *i += 1;
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
            factor *= f.powi(sign);
            dimension =
                dimension.combine(d, sign).ok_or_else(|| self.syntax("its exponents are out of range"))?;
        }
        Ok((factor, dimension))
    }

    fn power(&mut self, depth: usize) -> Result<(f64, Dimension), UnitError> {
        let base = match self.tokens.get(self.at).cloned() {
            Some(Token::Symbol(symbol)) => {
                self.at += 1;
                lookup(&symbol)?
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
        Ok((base.0.powi(power), dimension))
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
    fn what_cannot_be_read_says_what_to_write() {
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
