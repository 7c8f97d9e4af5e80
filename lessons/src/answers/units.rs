//! Units: reading what a student types, knowing its dimension, converting to SI.
//!
//! A [`Unit`] is a factor to SI base units and a [`Dimension`], seven integer exponents. Plane angle has no
//! dimension of its own: `rad` is 1 and `deg` is π/180, so `rad/s` and `1/s` agree. Hertz counts turns and is not taken for
//! an angular speed: see [`Unit::counts_turns`].

mod meaning;
mod parser;
mod table;

use thiserror::Error;
use triad_engine::scene::expression::notation;

pub use super::dimension::Dimension;
use meaning::Meaning;
use parser::Readings;

/// Longest unit text that is read, in characters.
const MAX_LENGTH: usize = 80;

/// A unit of measurement: 1 of it is `factor` in SI base units.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    /// Value of one unit in SI base units.
    pub factor: f64,
    /// Exponents of the base units.
    pub dimension: Dimension,
    counts_turns: bool,
    text: String,
}

/// Why a unit could not be read. Each message says what to write instead.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum UnitError {
    /// A symbol that is no unit.
    #[error("\u{201c}{symbol}\u{201d} is not a unit I know; write it like N m, kg m/s^2 or rad/s")]
    Unknown {
        /// The symbol as written.
        symbol: String,
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
        Self { factor: 1.0, dimension: Dimension::default(), counts_turns: false, text: String::new() }
    }

    /// Reads a unit such as `N m`, `kg·m²/s²`, `mm/s^2`, `deg`, `rpm`, `newton metres`, `ft lbf`. Empty text and `1` are the
    /// pure number.
    ///
    /// Errors if a symbol is unknown, the text is too long, or can be read in two ways.
    pub fn parse(text: &str) -> Result<Self, UnitError> {
        Self::read(text, None)
    }

    /// As [`Unit::parse`], where a unit of this dimension is expected: what can be read in several ways (`Nms`, `lb`,
    /// `kg/m s`) is read in the one that has it.
    ///
    /// Errors as [`Unit::parse`].
    pub fn parse_as(text: &str, wanted: Dimension) -> Result<Self, UnitError> {
        Self::read(text, Some(wanted))
    }

    fn read(text: &str, wanted: Option<Dimension>) -> Result<Self, UnitError> {
        let plain = notation::plain(text);
        let plain = notation::undecorated(&plain).trim_end_matches('.');
        if plain.chars().count() > MAX_LENGTH {
            let text: String = plain.chars().take(20).collect();
            return Err(UnitError::Syntax { text: format!("{text}…"), problem: "it is too long" });
        }
        let readings = parser::readings(plain)?;
        let Readings { meanings, ambiguous } = readings;
        let fitting = meanings.iter().find(|m| wanted.is_some_and(|wanted| m.dimension == wanted));
        let chosen = match (fitting, ambiguous) {
            (Some(fitting), _) => *fitting,
            (None, true) => return Err(UnitError::Ambiguous { text: plain.to_owned() }),
            (None, false) => *meanings.first().unwrap_or(&Meaning::ONE),
        };
        if !(chosen.factor.is_finite() && chosen.factor > 0.0) {
            return Err(UnitError::Syntax { text: plain.to_owned(), problem: "its size is out of range" });
        }
        let Meaning { factor, dimension, counts_turns } = chosen;
        Ok(Self { factor, dimension, counts_turns, text: plain.to_owned() })
    }

    /// The unit as it was written, in plain notation.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether it is made of hertz, which count turns: 1 Hz is 2π rad/s, though both are 1/s.
    pub fn counts_turns(&self) -> bool {
        self.counts_turns
    }
}

/// True if a student who was asked for a moment in N m wrote millinewton instead.
pub fn is_millinewton_for_newton_metre(written: &Unit, wanted: &Unit) -> bool {
    written.text.trim() == "mN" && wanted.dimension == Dimension([2, 1, -2, 0, 0, 0, 0])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(text: &str) -> Unit {
        Unit::parse(text).unwrap_or_else(|e| panic!("{text}: {e}"))
    }

    const FORCE: Dimension = Dimension([1, 1, -2, 0, 0, 0, 0]);
    const MOMENT: Dimension = Dimension([2, 1, -2, 0, 0, 0, 0]);

    #[test]
    fn common_spellings_of_newton() {
        for text in [
            "N",
            "kg m/s^2",
            "kg*m/s**2",
            "kg·m/s²",
            "kg m s^-2",
            "kg m s⁻²",
            "kg m/(s s)",
            "newton",
            "Newtons",
            "[N]",
            "kgm/s2",
            "kg.m/s^2",
            "kg-m/s^2",
            "kg m per second squared",
            "J/m",
            r"\mathrm{N}",
            "N.",
            "(N)",
            "W s/m",
            "n",
            "kilogram metres per square second",
            "kg m/s/s",
            "KG M/S^2",
        ] {
            let unit = unit(text);
            assert_eq!(unit.dimension, FORCE, "{text}");
            assert!((unit.factor - 1.0).abs() < 1e-15, "{text} {}", unit.factor);
        }
    }

    #[test]
    fn symbols_that_stand_together() {
        for (text, factor) in [
            ("Nm", 1.0),
            ("N-m", 1.0),
            ("Nmm", 1e-3),
            ("Ncm", 1e-2),
            ("kNm", 1e3),
            ("newtonmeter", 1.0),
            ("kNmm", 1.0),
            ("newton-metres", 1.0),
            ("N·m", 1.0),
            ("kgm^2/s^2", 1.0),
            ("kgm2s-2", 1.0),
            ("Ws", 1.0),
            ("mNm", 1e-3),
            ("NM", 1.0),
            ("ft lb", 1.355_817_948_331_400_4),
            ("ft·lbf", 1.355_817_948_331_400_4),
            ("lbf-in", 0.112_984_829_027_616_7),
            ("kgf m", 9.80665),
            ("dyn cm", 1e-7),
            ("foot-pounds", 1.355_817_948_331_400_4),
        ] {
            let unit = Unit::parse_as(text, MOMENT).unwrap_or_else(|e| panic!("{text}: {e}"));
            assert_eq!(unit.dimension, MOMENT, "{text}");
            assert!((unit.factor / factor - 1.0).abs() < 1e-14, "{text} {}", unit.factor);
        }
        let momentum = Dimension([2, 1, -1, 0, 0, 0, 0]);
        for text in
            ["Nms", "N m s", "kgm^2/s", "Js", "kg m^2 per second", "kg square metre per second", "kg/s m^2"]
        {
            assert_eq!(Unit::parse_as(text, momentum).map(|u| u.factor), Ok(1.0), "{text}");
        }
    }

    #[test]
    fn prefixes_and_angles_convert() {
        for (text, factor) in [
            ("kN", 1e3),
            ("mm/s^2", 1e-3),
            ("deg", 0.017_453_292_519_943_295),
            ("rpm", 0.104_719_755_119_659_77),
            ("µm", 1e-6),
            ("μm", 1e-6),
            ("g cm^2", 1e-7),
            ("rev/s", std::f64::consts::TAU),
            ("rps", std::f64::consts::TAU),
            ("rev/min", std::f64::consts::TAU / 60.0),
            ("°/s", 0.017_453_292_519_943_295),
            ("%", 0.01),
            ("kilonewtons", 1e3),
            ("centimeters", 1e-2),
            ("ft", 0.3048),
            ("inches", 0.0254),
            ("lbf", 4.448_221_615_260_5),
            ("km/h", 1.0 / 3.6),
            ("mph", 0.447_04),
            ("hp", 745.699_871_582_270_2),
            ("cal", 4.184),
            ("msec", 1e-3),
            ("milliseconds", 1e-3),
            ("kilogrammes", 1.0),
            ("slug", 14.593_902_937_206_4),
            ("lb", 0.453_592_37),
            ("degrees", 0.017_453_292_519_943_295),
        ] {
            assert!((unit(text).factor / factor - 1.0).abs() < 1e-13, "{text} {}", unit(text).factor);
        }
        assert_eq!(unit("rad/s").dimension, unit("1/s").dimension);
    }

    #[test]
    fn hertz_counts_turns() {
        assert!(unit("Hz").counts_turns() && unit("kHz").counts_turns() && unit("hertz").counts_turns());
        assert!(
            !unit("rad/s").counts_turns() && !unit("rev/s").counts_turns() && !unit("Hz s").counts_turns()
        );
    }

    #[test]
    fn millinewton_is_not_newton_metre() {
        assert_eq!(unit("mN").dimension, unit("N").dimension);
        assert_eq!(unit("N m").dimension, unit("Nm").dimension);
        assert!(is_millinewton_for_newton_metre(&unit("mN"), &unit("N m")));
        assert!(!is_millinewton_for_newton_metre(&unit("mN"), &unit("N")));
    }

    #[test]
    fn a_product_behind_a_slash_needs_brackets_or_a_dimension() {
        for text in ["kg/m s", "kg/m*s"] {
            assert!(matches!(Unit::parse(text), Err(UnitError::Ambiguous { .. })), "{text}");
            let below = Dimension([-1, 1, -1, 0, 0, 0, 0]);
            assert_eq!(Unit::parse_as(text, below).map(|u| u.dimension), Ok(below));
            assert!(matches!(Unit::parse_as(text, FORCE), Err(UnitError::Ambiguous { .. })), "{text}");
        }
    }

    #[test]
    fn errors_of_units_say_what_to_write() {
        for bad in [
            "m^x",
            "m^99",
            "(m",
            "m)",
            "m//s",
            "12 N",
            "m^",
            "$#",
            "m((((((((((m))))))))))",
            "per",
            "squared",
        ] {
            assert!(Unit::parse(bad).is_err(), "{bad}");
        }
        assert!(Unit::parse(&"m ".repeat(400)).is_err());
    }

    #[test]
    fn unknown_names_the_symbol() {
        assert_eq!(Unit::parse("blob"), Err(UnitError::Unknown { symbol: "blob".to_owned() }));
    }
}
