//! A small language of formulas: `-3*m*g*cos(phi)`, `1/2 m v^2`, `4 ellipk(1/2)/sqrt(g)`, `m g sin α`, `\frac{1}{2} m v^2`.
//!
//! Bounded in length and depth, with a closed list of functions; evaluating it runs no code. Multiplication may be left out
//! between a number, a name and a bracket; a name that is not known is read as a product of names that are (`mgl`). `^` binds
//! tighter than a sign in front, and to the right. Brackets of a function may be left out: `sin 2x` is `sin(2x)`, and
//! `sin^2 x` is its square.

mod cursor;
mod node;
pub mod notation;

mod named;
mod token;

mod parser;
mod written;

use thiserror::Error;

pub use self::cursor::Cursor;
use self::named::Named;
pub use self::node::{Function, Node};
use self::parser::Parser;

/// Longest formula that is read, in characters.
const MAX_LENGTH: usize = 400;

/// A formula, ready to be evaluated.
#[derive(Debug, Clone, PartialEq)]
pub struct Expression {
    root: Node,
    /// Whether a number in it has decimals: it may be a rounded one.
    decimals: bool,
}

/// Why a formula could not be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ExpressionError {
    /// Nothing there.
    #[error("there is no formula here")]
    Empty,
    /// Too long or too deeply nested.
    #[error("the formula is too long or too deeply nested; simplify it")]
    TooLarge,
    /// A name that is not defined.
    #[error("\u{201c}{name:.24}\u{201d} is not one of the symbols here; known are {known}")]
    UnknownSymbol {
        /// The name as written.
        name: String,
        /// The names that are defined.
        known: String,
    },
    /// Something unexpected.
    #[error("at character {position}: {problem}")]
    Syntax {
        /// Place in the text in plain notation, counted from 1.
        position: usize,
        /// What is wrong and what to do.
        problem: String,
    },
}

impl ExpressionError {
    /// Stable short name of the kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Empty => "formula-empty",
            Self::TooLarge => "formula-too-large",
            Self::UnknownSymbol { .. } => "formula-unknown-symbol",
            Self::Syntax { .. } => "formula-syntax",
        }
    }
}

impl Expression {
    /// Reads a formula in the named symbols; the order of `symbols` is the order of the values in [`Self::eval`]. An equals
    /// sign with a name in front of it is left out.
    ///
    /// # Errors
    ///
    /// [`ExpressionError`]: what cannot be read, and where.
    pub fn parse(text: &str, symbols: &[&str]) -> Result<Self, ExpressionError> {
        if text.chars().count() > MAX_LENGTH {
            return Err(ExpressionError::TooLarge);
        }
        let plain = notation::plain(text);
        let formula = match plain.rsplit_once('=') {
            Some((_, behind)) if !behind.trim().is_empty() => behind,
            _ => plain.trim_end_matches('='),
        };
        let (root, decimals) = Parser::new(formula, symbols)?.whole()?;
        Ok(Self { root, decimals })
    }

    /// The value for these values of the symbols; not finite where the formula is not defined.
    pub fn eval(&self, values: &[f64]) -> f64 {
        self.root.eval(values)
    }

    /// Whether the symbol with this index occurs.
    pub fn uses(&self, symbol: usize) -> bool {
        self.root.uses(symbol)
    }

    /// The whole of it as its outermost part.
    pub fn into_root(self) -> Node {
        self.root
    }

    /// Whether a number with decimals occurs, which may have been rounded.
    pub fn has_decimals(&self) -> bool {
        self.decimals
    }

    /// The formula with every product and bracket written out, as it was understood.
    pub fn written(&self, symbols: &[&str]) -> String {
        written::of(&self.root, symbols)
    }
}

/// The value of the arithmetic at the beginning of a text in plain notation (`3*9.81 N`, `sqrt(2) m`), and the text behind
/// it; `None` if there is none. The first name that is neither a function nor a constant ends it.
pub fn leading_value(plain: &str) -> Option<(f64, String)> {
    if plain.chars().count() > MAX_LENGTH {
        return None;
    }
    let (root, rest) = Parser::new(plain, &[]).ok()?.leading()?;
    Some((root.eval(&[]), rest))
}

/// Whether a text in plain notation begins with a function or with π: a factor behind a number, not a unit.
pub fn begins_factor(plain: &str) -> bool {
    let name: String = plain.chars().take_while(|c| c.is_alphanumeric()).collect();
    name.eq_ignore_ascii_case("pi") || Named::of(&name).is_some()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        Expression::parse(text, &["m", "g", "v"])
            .unwrap_or_else(|e| panic!("{text}: {e}"))
            .eval(&[2.0, 9.81, 3.0])
    }

    #[test]
    fn precedence_is_the_usual_one() {
        assert_eq!(value("1/2 m v^2"), 9.0);
        assert_eq!(value("-v^2"), -9.0);
        assert_eq!(value("2^3^2"), 512.0);
        assert_eq!(value("2^-1"), 0.5);
        assert_eq!(value("7-4-2"), 1.0);
        assert_eq!(value("8/4/2"), 1.0);
        assert_eq!(value("2(v+1)m"), 16.0);
        assert_eq!(value("3*m*g"), 3.0 * 2.0 * 9.81);
        assert!((value("cos(pi)") + 1.0).abs() < 1e-15);
        assert_eq!(value("1.5e1 + 2E-1"), 15.2);
    }

    #[test]
    fn what_is_left_out_is_understood() {
        for (text, wanted) in [
            ("mgv", 2.0 * 9.81 * 3.0),
            ("3mg", 6.0 * 9.81),
            ("m g sin v", 2.0 * 9.81 * libm::sin(3.0)),
            ("mg sin(v)", 2.0 * 9.81 * libm::sin(3.0)),
            ("mgsin(v)", 2.0 * 9.81 * libm::sin(3.0)),
            ("sin 2v", libm::sin(6.0)),
            ("sin v cos v", libm::sin(3.0) * libm::cos(3.0)),
            ("sin^2 v", libm::sin(3.0) * libm::sin(3.0)),
            ("sin^2(v) m", libm::sin(3.0) * libm::sin(3.0) * 2.0),
            ("sin²v", libm::sin(3.0) * libm::sin(3.0)),
            ("tan^-1(v)", libm::atan(3.0)),
            ("√v m", 3f64.sqrt() * 2.0),
            ("√(2 g)", (2.0 * 9.81f64).sqrt()),
            ("e^v", libm::exp(3.0)),
            ("e^(-v/m)", libm::exp(-1.5)),
            ("ln v", libm::log(3.0)),
            ("Log(v)", libm::log(3.0)),
            ("lg(v)", libm::log10(3.0)),
            ("Sqrt[v]", 3f64.sqrt()),
            ("pow(v, 2)", 9.0),
            ("atan2(v, m)", libm::atan2(3.0, 2.0)),
            ("|m - v|", 1.0),
            ("2|v|m", 12.0),
            ("0,5 m v²", 9.0),
            (r"\frac{1}{2} m v^{2}", 9.0),
            (r"m\,g\,\cos(v)", 2.0 * 9.81 * libm::cos(3.0)),
            ("½ m v²", 9.0),
            ("T = 1/2 m v^2", 9.0),
            ("2 π v", 6.0 * std::f64::consts::PI),
            ("2Pi v", 6.0 * std::f64::consts::PI),
            ("m·g×v", 2.0 * 9.81 * 3.0),
            ("{m [v (g)]}", 2.0 * 9.81 * 3.0),
            ("m**2", 4.0),
            ("sin(30°)", libm::sin(30f64.to_radians())),
        ] {
            let got = value(text);
            assert!((got - wanted).abs() <= 1e-14 * wanted.abs(), "{text}: {got} {wanted}");
        }
    }

    #[test]
    fn names_are_matched_as_they_are_meant() {
        let parse = |text: &str, symbols: &[&str]| {
            Expression::parse(text, symbols).unwrap_or_else(|e| panic!("{text}: {e}")).eval(&[2.0, 3.0, 5.0])
        };
        assert_eq!(parse("I_t omega", &["It", "omega"]), 6.0);
        assert_eq!(parse("ItΩ", &["I_t", "Omega"]), 6.0);
        assert_eq!(parse("mR", &["m", "R"]), 6.0);
        assert_eq!(parse("MR", &["m", "R"]), 6.0);
        assert_eq!(parse("mω²R", &["m", "omega", "R"]), 2.0 * 9.0 * 5.0);
        assert_eq!(parse("m*e", &["m", "e"]), 6.0);
        assert_eq!(parse("I₁*ω", &["I_1", "omega"]), 6.0);
    }

    #[test]
    fn a_value_in_front_of_a_unit_is_found() {
        for (text, wanted, rest) in [
            ("3*9.81 N", 29.43, "N"),
            ("8/13 m", 8.0 / 13.0, "m"),
            ("sqrt(19.62) m/s", 19.62f64.sqrt(), "m/s"),
            ("2^8", 256.0, ""),
            ("3*2*N", 6.0, "*N"),
            ("2 pi rad/s", std::f64::consts::TAU, "rad/s"),
            ("6/2/s", 3.0, "/s"),
            ("4/3 (N m)", 4.0 / 3.0, "(N m)"),
            ("2*sin(30°) N", 1.0, "N"),
        ] {
            let (value, behind) = leading_value(text).unwrap_or_else(|| panic!("{text}"));
            assert!((value - wanted).abs() < 1e-14 * wanted, "{text}: {value}");
            assert_eq!(behind.trim(), rest, "{text}");
        }
        assert_eq!(leading_value("N 3"), None);
    }

    #[test]
    fn elliptic_integral_matches_its_table() {
        // Abramowitz and Stegun, table 17.1: K(0.5).
        assert!((value("ellipk(1/2)") - 1.854_074_677_301_371_9).abs() < 1e-15);
        assert!((value("ellipk(0)") - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
        assert!(value("ellipk(1)").is_nan());
    }

    #[test]
    fn a_formula_is_written_as_it_was_understood() {
        let written = |t: &str| Expression::parse(t, &["m", "g", "v"]).unwrap().written(&["m", "g", "v"]);
        assert_eq!(written("mgsin v"), "m·g·sin(v)");
        assert_eq!(written("1/2mv²"), "1/2·m·v^2");
        assert_eq!(written("m/(g v)"), "m/(g·v)");
        assert_eq!(written("-(m+g)v"), "−(m + g)·v");
        assert_eq!(written("(-v)^2"), "(−v)^2");
        assert_eq!(written("m-(g-v)"), "m − (g − v)");
        for text in ["mgsin v", "1/2mv²", "m/(g v)", "-(m+g)v", "(-v)^2", "m-(g-v)", "2^(m^g)", "(2^m)^g"] {
            let once = Expression::parse(text, &["m", "g", "v"]).unwrap();
            let twice = Expression::parse(&once.written(&["m", "g", "v"]), &["m", "g", "v"]).unwrap();
            assert_eq!(once.eval(&[2.0, 1.5, 3.0]), twice.eval(&[2.0, 1.5, 3.0]), "{text}");
        }
    }

    #[test]
    fn errors_say_where_and_what() {
        let fails = |t: &str| Expression::parse(t, &["m", "g"]).unwrap_err().to_string();
        assert!(fails("3*mq").contains("known are m, g"));
        assert!(fails("(m+g").contains("not closed"));
        assert!(fails("m+").contains("character 3"));
        assert!(fails("m 2").contains("operator is missing"));
        assert!(fails("m;g").contains("does not belong"));
        assert!(fails("sin").contains("argument"));
        assert!(fails("|m").contains("not closed"));
        assert_eq!(Expression::parse(" ", &[]), Err(ExpressionError::Empty));
    }

    #[test]
    fn hostile_input_is_bounded() {
        for text in ["(", "-", "2^", "sin ", "|", "1+", "\\frac{", "\\sqrt", "√", "((((-"] {
            assert!(Expression::parse(&text.repeat(300 / text.len()), &[]).is_err(), "{text}");
        }
        assert!(Expression::parse(&"1+".repeat(4000), &[]).is_err());
    }
}
