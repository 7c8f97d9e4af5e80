//! The units, prefixes and names that are known.

use super::meaning::{Meaning, products};
use crate::answers::dimension::Dimension;

type Row = (&'static str, f64, [i32; 7]);

/// Units that take SI prefixes: symbol, factor, dimension.
const PREFIXABLE: &[Row] = &[
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
    ("V", 1.0, [2, 1, -3, -1, 0, 0, 0]),
    ("Pa", 1.0, [-1, 1, -2, 0, 0, 0, 0]),
    ("Hz", 1.0, [0, 0, -1, 0, 0, 0, 0]),
    ("rad", 1.0, [0, 0, 0, 0, 0, 0, 0]),
    ("bar", 1e5, [-1, 1, -2, 0, 0, 0, 0]),
    ("cal", 4.184, [2, 1, -2, 0, 0, 0, 0]),
    ("l", 1e-3, [3, 0, 0, 0, 0, 0, 0]),
    ("L", 1e-3, [3, 0, 0, 0, 0, 0, 0]),
];

/// Metres in a foot.
const FOOT: f64 = 0.3048;
/// Kilograms in a pound.
const POUND: f64 = 0.453_592_37;
/// Standard gravity, m/s².
const G: f64 = 9.806_65;

/// Units without prefixes.
const PLAIN: &[Row] = &[
    ("deg", std::f64::consts::PI / 180.0, [0; 7]),
    ("°", std::f64::consts::PI / 180.0, [0; 7]),
    ("gon", std::f64::consts::PI / 200.0, [0; 7]),
    ("rev", std::f64::consts::TAU, [0; 7]),
    ("turn", std::f64::consts::TAU, [0; 7]),
    ("%", 0.01, [0; 7]),
    ("rpm", std::f64::consts::TAU / 60.0, [0, 0, -1, 0, 0, 0, 0]),
    ("rps", std::f64::consts::TAU, [0, 0, -1, 0, 0, 0, 0]),
    ("min", 60.0, [0, 0, 1, 0, 0, 0, 0]),
    ("h", 3600.0, [0, 0, 1, 0, 0, 0, 0]),
    ("t", 1000.0, [0, 1, 0, 0, 0, 0, 0]),
    ("ft", FOOT, [1, 0, 0, 0, 0, 0, 0]),
    ("in", FOOT / 12.0, [1, 0, 0, 0, 0, 0, 0]),
    ("yd", 3.0 * FOOT, [1, 0, 0, 0, 0, 0, 0]),
    ("mi", 5280.0 * FOOT, [1, 0, 0, 0, 0, 0, 0]),
    ("mph", 5280.0 * FOOT / 3600.0, [1, 0, -1, 0, 0, 0, 0]),
    ("kph", 1.0 / 3.6, [1, 0, -1, 0, 0, 0, 0]),
    ("mps", 1.0, [1, 0, -1, 0, 0, 0, 0]),
    ("fps", FOOT, [1, 0, -1, 0, 0, 0, 0]),
    ("kn", 1852.0 / 3600.0, [1, 0, -1, 0, 0, 0, 0]),
    ("lbm", POUND, [0, 1, 0, 0, 0, 0, 0]),
    ("slug", POUND * G / FOOT, [0, 1, 0, 0, 0, 0, 0]),
    ("lbf", POUND * G, [1, 1, -2, 0, 0, 0, 0]),
    ("kgf", G, [1, 1, -2, 0, 0, 0, 0]),
    ("kp", G, [1, 1, -2, 0, 0, 0, 0]),
    ("dyn", 1e-5, [1, 1, -2, 0, 0, 0, 0]),
    ("erg", 1e-7, [2, 1, -2, 0, 0, 0, 0]),
    ("hp", 550.0 * FOOT * POUND * G, [2, 1, -3, 0, 0, 0, 0]),
    ("psi", POUND * G / (FOOT * FOOT / 144.0), [-1, 1, -2, 0, 0, 0, 0]),
    ("atm", 101_325.0, [-1, 1, -2, 0, 0, 0, 0]),
];

/// Symbols with two meanings, the likelier first: pounds are a mass and, in America, a force.
const DOUBLE: &[(&str, [&str; 2])] = &[("lb", ["lbm", "lbf"]), ("lbs", ["lbm", "lbf"])];

/// SI prefixes with their names.
const PREFIXES: &[(&str, &str, f64)] = &[
    ("G", "giga", 1e9),
    ("M", "mega", 1e6),
    ("k", "kilo", 1e3),
    ("h", "hecto", 1e2),
    ("da", "deca", 1e1),
    ("d", "deci", 1e-1),
    ("c", "centi", 1e-2),
    ("m", "milli", 1e-3),
    ("u", "micro", 1e-6),
    ("n", "nano", 1e-9),
    ("p", "pico", 1e-12),
];

/// Names of units, and other ways to shorten them, in small letters and without the s of the plural.
const NAMES: &[(&str, &str)] = &[
    ("meter", "m"),
    ("metre", "m"),
    ("mtr", "m"),
    ("gram", "g"),
    ("gramme", "g"),
    ("kilo", "kg"),
    ("kg", "kg"),
    ("second", "s"),
    ("sec", "s"),
    ("minute", "min"),
    ("min", "min"),
    ("hour", "h"),
    ("hr", "h"),
    ("tonne", "t"),
    ("newton", "N"),
    ("joule", "J"),
    ("watt", "W"),
    ("pascal", "Pa"),
    ("hertz", "Hz"),
    ("radian", "rad"),
    ("rad", "rad"),
    ("degree", "deg"),
    ("percent", "%"),
    ("revolution", "rev"),
    ("rotation", "rev"),
    ("turn", "turn"),
    ("foot", "ft"),
    ("feet", "ft"),
    ("inch", "in"),
    ("inche", "in"),
    ("yard", "yd"),
    ("mile", "mi"),
    ("knot", "kn"),
    ("pound", "lb"),
    ("slug", "slug"),
    ("dyne", "dyn"),
    ("kilopond", "kp"),
    ("horsepower", "hp"),
    ("calorie", "cal"),
    ("liter", "l"),
    ("litre", "l"),
];

/// Longest run of symbols without spaces that is taken apart, in bytes.
const MAX_COMPOUND: usize = 24;

fn row(rows: &[Row], symbol: &str) -> Option<Meaning> {
    let (_, factor, exponents) = rows.iter().find(|(s, ..)| *s == symbol)?;
    Some(Meaning { factor: *factor, dimension: Dimension(*exponents), counts_turns: symbol == "Hz" })
}

/// A symbol with or without a prefix, exactly as it is written.
fn exact(symbol: &str) -> Option<Meaning> {
    let whole = row(PREFIXABLE, symbol).or_else(|| row(PLAIN, symbol));
    whole.or_else(|| {
        PREFIXES.iter().find_map(|(prefix, _, scale)| {
            let meaning = row(PREFIXABLE, symbol.strip_prefix(prefix)?)?;
            Some(Meaning { factor: scale * meaning.factor, ..meaning })
        })
    })
}

/// A symbol that has one meaning or two.
fn symbol_meanings(symbol: &str) -> Vec<Meaning> {
    match DOUBLE.iter().find(|(s, _)| *s == symbol) {
        Some((_, two)) => two.iter().filter_map(|s| exact(s)).collect(),
        None => exact(symbol).into_iter().collect(),
    }
}

/// A unit by its name, in singular or plural, with or without the name of a prefix: `kilonewtons`, `msec`.
fn named(symbol: &str) -> Vec<Meaning> {
    let lower = symbol.to_lowercase();
    let singular = lower.strip_suffix('s').unwrap_or(&lower);
    let unit = |name: &str| NAMES.iter().find(|(known, _)| *known == name).map(|(_, symbol)| *symbol);
    if let Some(symbol) = unit(&lower).or_else(|| unit(singular)) {
        return symbol_meanings(symbol);
    }
    let prefixed = PREFIXES.iter().find_map(|(letter, name, scale)| {
        let short = symbol.strip_prefix(letter).map(str::to_lowercase);
        let base = unit(singular.strip_prefix(name).or(short.as_deref())?)?;
        let meaning = row(PREFIXABLE, base)?;
        Some(Meaning { factor: scale * meaning.factor, ..meaning })
    });
    prefixed.into_iter().collect()
}

/// A symbol in letters of another size: `KG`, `n`.
fn other_case(symbol: &str) -> Vec<Meaning> {
    let lower = symbol.to_lowercase();
    let known = |rows: &'static [Row]| rows.iter().map(|(s, ..)| *s);
    let prefixed = ["kg", "kN", "kJ", "kW", "MPa", "kPa", "mm", "cm", "km", "ms"];
    let all = known(PREFIXABLE).chain(prefixed).chain(known(PLAIN));
    all.filter(|s| s.to_lowercase() == lower).filter_map(exact).collect()
}

/// Every way to take a run of letters apart into symbols, fewest first; the power belongs to the last of them.
fn compound(symbol: &str, power: i32, single: fn(&str) -> Vec<Meaning>) -> Vec<Meaning> {
    fn split(
        text: &str,
        power: i32,
        pieces: usize,
        single: fn(&str) -> Vec<Meaning>,
        out: &mut Vec<(usize, Meaning)>,
    ) {
        if pieces > 4 || out.len() > 16 {
            return;
        }
        let whole = single(text).into_iter().filter_map(|m| m.power(power));
        out.extend(whole.map(|meaning| (pieces, meaning)));
        for (k, _) in text.char_indices().skip(1) {
            let first = single(&text[..k]);
            if first.is_empty() {
                continue;
            }
            let mut rest = Vec::new();
            split(&text[k..], power, pieces + 1, single, &mut rest);
            for (count, meaning) in rest {
                out.extend(products(&first, &[meaning], 1).into_iter().map(|m| (count, m)));
            }
        }
    }
    if symbol.len() > MAX_COMPOUND {
        return Vec::new();
    }
    let mut found = Vec::new();
    split(symbol, power, 1, single, &mut found);
    found.sort_by_key(|(pieces, _)| *pieces);
    found.into_iter().map(|(_, meaning)| meaning).collect()
}

/// What a symbol to a power can mean, the likeliest first; `None` if nothing is known that is written so.
pub(super) fn meanings(symbol: &str, power: i32) -> Option<Vec<Meaning>> {
    let single = |found: Vec<Meaning>| found.into_iter().filter_map(|m| m.power(power)).collect::<Vec<_>>();
    let ways: [&dyn Fn() -> Vec<Meaning>; 6] = [
        &|| single(symbol_meanings(symbol)),
        &|| single(named(symbol)),
        &|| single(other_case(symbol)),
        &|| compound(symbol, power, symbol_meanings),
        &|| {
            compound(
                symbol,
                power,
                |piece| if piece.len() < 3 { symbol_meanings(piece) } else { named(piece) },
            )
        },
        &|| compound(symbol, power, other_case),
    ];
    ways.iter().map(|way| way()).find(|found| !found.is_empty())
}
