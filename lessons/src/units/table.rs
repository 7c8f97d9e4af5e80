//! The units, prefixes and misspellings that are known.

/// Units that take SI prefixes: symbol, factor, dimension.
pub(super) const PREFIXABLE: &[(&str, f64, [i32; 7])] = &[
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
pub(super) const PLAIN: &[(&str, f64, [i32; 7])] = &[
    ("deg", std::f64::consts::PI / 180.0, [0, 0, 0, 0, 0, 0, 0]),
    ("°", std::f64::consts::PI / 180.0, [0, 0, 0, 0, 0, 0, 0]),
    ("rev", std::f64::consts::TAU, [0, 0, 0, 0, 0, 0, 0]),
    ("rpm", std::f64::consts::TAU / 60.0, [0, 0, -1, 0, 0, 0, 0]),
    ("min", 60.0, [0, 0, 1, 0, 0, 0, 0]),
    ("h", 3600.0, [0, 0, 1, 0, 0, 0, 0]),
    ("t", 1000.0, [0, 1, 0, 0, 0, 0, 0]),
    // Written without a space by nearly everybody; never a prefix and a unit.
    ("Nm", 1.0, [2, 1, -2, 0, 0, 0, 0]),
    ("kNm", 1e3, [2, 1, -2, 0, 0, 0, 0]),
    ("Ns", 1.0, [1, 1, -1, 0, 0, 0, 0]),
];

/// SI prefixes.
pub(super) const PREFIXES: &[(&str, f64)] = &[
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
pub(super) const SPELLINGS: &[(&str, &str)] = &[
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
