//! The units, prefixes and misspellings that are known.

use super::dimension::Dimension;

/// Units that take SI prefixes: symbol, factor, dimension.
const PREFIXABLE: &[(&str, f64, [i32; 7])] = &[
    ("m", 1.0, [1, 0, 0, 0, 0, 0, 0]),
    ("g", 1e-3, [0, 1, 0, 0, 0, 0, 0]),
    ("s", 1.0, [0, 0, 1, 0, 0, 0, 0]),
    ("A", 1.0, [0, 0, 0, 1, 0, 0, 0]),
    ("K", 1.0, [0, 0, 0, 0, 1, 0, 0]),
    ("mol", 1.0, [0, 0, 0, 0, 0, 1, 0]),
    ("cd", 1.0, [0, 0, 0, 0, 0, 0, 1]),
    ("N", 1.0, [1, 1, -2, 0, 0, 0, 0]),
    ("J", 1.0, [2, 1, -2, 0, 0, 0, 0]),
    ("W", 1.0, [2, 1, -3, 0, 0, 0, 0]),
    ("Pa", 1.0, [-1, 1, -2, 0, 0, 0, 0]),
    ("Hz", 1.0, [0, 0, -1, 0, 0, 0, 0]),
    ("rad", 1.0, [0, 0, 0, 0, 0, 0, 0]),
];

/// Units without prefixes.
const PLAIN: &[(&str, f64, [i32; 7])] = &[
    ("deg", std::f64::consts::PI / 180.0, [0, 0, 0, 0, 0, 0, 0]),
    ("°", std::f64::consts::PI / 180.0, [0, 0, 0, 0, 0, 0, 0]),
    ("rev", std::f64::consts::TAU, [0, 0, 0, 0, 0, 0, 0]),
    ("rpm", std::f64::consts::TAU / 60.0, [0, 0, -1, 0, 0, 0, 0]),
    ("min", 60.0, [0, 0, 1, 0, 0, 0, 0]),
    ("h", 3600.0, [0, 0, 1, 0, 0, 0, 0]),
    ("t", 1000.0, [0, 1, 0, 0, 0, 0, 0]),
    // ParsedNumber without a space by nearly everybody; never a prefix and a unit.
    ("Nm", 1.0, [2, 1, -2, 0, 0, 0, 0]),
    ("kNm", 1e3, [2, 1, -2, 0, 0, 0, 0]),
    ("Ns", 1.0, [1, 1, -1, 0, 0, 0, 0]),
];

/// SI prefixes.
const PREFIXES: &[(&str, f64)] = &[
    ("G", 1e9),
    ("M", 1e6),
    ("k", 1e3),
    ("h", 1e2),
    ("da", 1e1),
    ("d", 1e-1),
    ("c", 1e-2),
    ("m", 1e-3),
    ("u", 1e-6),
    ("n", 1e-9),
    ("p", 1e-12),
];

/// Spellings that are meant well.
const SPELLINGS: &[(&str, &str)] = &[
    ("sec", "s"),
    ("secs", "s"),
    ("second", "s"),
    ("seconds", "s"),
    ("meter", "m"),
    ("metre", "m"),
    ("meters", "m"),
    ("metres", "m"),
    ("newton", "N"),
    ("newtons", "N"),
    ("joule", "J"),
    ("joules", "J"),
    ("watt", "W"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("radian", "rad"),
    ("radians", "rad"),
    ("kilogram", "kg"),
    ("kilograms", "kg"),
    ("kgs", "kg"),
    ("hr", "h"),
    ("kgm", "kg m"),
    ("mps", "m/s"),
];

fn find(symbol: &str) -> Option<(f64, Dimension)> {
    if let Some((_, factor, exponents)) = PREFIXABLE.iter().chain(PLAIN).find(|(s, ..)| *s == symbol) {
        return Some((*factor, Dimension(*exponents)));
    }
    PREFIXES.iter().find_map(|(prefix, scale)| {
        let rest = symbol.strip_prefix(prefix)?;
        let (_, factor, exponents) = PREFIXABLE.iter().find(|(s, ..)| *s == rest)?;
        Some((scale * factor, Dimension(*exponents)))
    })
}

/// The factor and dimension of a symbol with or without prefix; of an unknown one the unit that was probably meant.
pub(super) fn lookup(symbol: &str) -> Result<(f64, Dimension), Option<String>> {
    find(symbol).ok_or_else(|| {
        let lower = symbol.to_lowercase();
        let spelling =
            SPELLINGS.iter().find(|(wrong, _)| *wrong == lower).map(|(_, right)| (*right).to_owned());
        let other_case = || {
            let known = PREFIXABLE.iter().chain(PLAIN).map(|(s, ..)| (*s).to_owned());
            let prefixed = ["kg", "kN", "kJ", "kW", "MPa", "mm", "cm", "km"].map(str::to_owned);
            known.chain(prefixed).find(|s| s.to_lowercase() == lower)
        };
        spelling.or_else(other_case)
    })
}
