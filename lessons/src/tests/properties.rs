//! Properties of everything that reads what a student types: written numbers, units and formulas come back, and no text
//! makes a reader panic.

use proptest::prelude::*;

use crate::answers::number;
use crate::answers::table;
use crate::answers::units::Unit;
use crate::rendering::figure::Figure;
use triad_engine::scene::expression::Expression;

/// Signs that students and hostile clients type, ordinary and not.
fn typed() -> impl Strategy<Value = String> {
    let sign = prop_oneof![
        4 => "[-+*/^()., 0-9eE]",
        3 => "[a-zA-Zµμ°_]",
        2 => "[⁰¹²³⁻·×⋅∙−–²\u{a0}\u{202f}\u{2009}\u{2215}\u{2044}]",
        1 => any::<char>().prop_map(String::from),
    ];
    prop::collection::vec(sign, 0..60).prop_map(|signs| signs.concat())
}

/// A formula as text, with its value for x = 0.75 and y = −1.25.
fn formula() -> impl Strategy<Value = (String, f64)> {
    let leaf = prop_oneof![
        (0.001f64..1e6).prop_map(|x| (format!("{x}"), x)),
        (1e-12f64..1e12).prop_map(|x| (format!("{x:e}"), x)),
        Just(("x".to_owned(), 0.75)),
        Just(("y".to_owned(), -1.25)),
        Just(("pi".to_owned(), std::f64::consts::PI)),
    ];
    leaf.prop_recursive(5, 40, 2, |inner| {
        let pair = (inner.clone(), inner.clone());
        prop_oneof![
            pair.clone().prop_map(|((a, x), (b, y))| (format!("({a}) + ({b})"), x + y)),
            pair.clone().prop_map(|((a, x), (b, y))| (format!("({a}) − ({b})"), x - y)),
            pair.clone().prop_map(|((a, x), (b, y))| (format!("({a})·({b})"), x * y)),
            pair.clone().prop_map(|((a, x), (b, y))| (format!("({a})({b})"), x * y)),
            pair.prop_map(|((a, x), (b, y))| (format!("({a})/({b})"), x / y)),
            inner.clone().prop_map(|(a, x)| (format!("-({a})"), -x)),
            inner.clone().prop_map(|(a, x)| (format!("cos({a})"), libm::cos(x))),
            // Hidden from the compiler, which would make a square of it: the last bit may differ from that of a power.
            inner.prop_map(|(a, x)| (format!("({a})**2"), libm::pow(x, std::hint::black_box(2.0)))),
        ]
    })
    .prop_filter("formulas have a greatest length", |(text, _)| text.chars().count() <= 400)
}

/// A unit as text, with its dimension in m, kg and s, and its factor.
fn unit() -> impl Strategy<Value = (String, [i32; 3], f64)> {
    let base = prop::sample::select(vec![
        ("m", [1, 0, 0], 1.0),
        ("mm", [1, 0, 0], 1e-3),
        ("kg", [0, 1, 0], 1.0),
        ("s", [0, 0, 1], 1.0),
        ("min", [0, 0, 1], 60.0),
        ("kN", [1, 1, -2], 1e3),
        ("J", [2, 1, -2], 1.0),
        ("deg", [0, 0, 0], std::f64::consts::PI / 180.0),
    ]);
    prop::collection::vec((base, -2i32..=2), 1..4).prop_map(|factors| {
        let text = factors.iter().map(|((name, ..), power)| format!("{name}^{power}"));
        let text = text.collect::<Vec<_>>().join(" ");
        let dimension = |k: usize| factors.iter().map(|((_, d, _), power)| d[k] * power).sum();
        let factor =
            factors.iter().map(|((.., factor), power)| libm::pow(*factor, f64::from(*power))).product();
        (text, [dimension(0), dimension(1), dimension(2)], factor)
    })
}

proptest! {
    #[test]
    fn nothing_that_is_typed_makes_a_reader_panic(text in typed()) {
        if let Ok((parsed, _)) = number::read(&text) {
            prop_assert!(parsed.value.is_finite() && parsed.half_ulp_decimal >= 0.0);
        }
        if let Ok(unit) = Unit::parse(&text) {
            prop_assert!(unit.factor.is_finite() && unit.factor > 0.0);
        }
        if let Ok(formula) = Expression::parse(&text, &["m", "x"]) {
            let _ = formula.eval(&[1.0, 2.0]);
        }
        let _ = table::read(&text);
        let _ = Figure::parse(&format!("<svg viewBox=\"0 0 1 1\">{text}</svg>"));
    }

    #[test]
    fn a_written_number_comes_back(x in prop::num::f64::NORMAL) {
        for text in [format!("{x:e}"), format!("{x:e} N m").replace('-', "\u{2212}")] {
            // Exponents of more than three digits do not exist, so every normal number can be read.
            let (parsed, rest) = number::read(&text).map_err(|e| TestCaseError::fail(format!("{text}: {e}")))?;
            prop_assert_eq!(parsed.value, x);
            prop_assert!(rest.is_empty() || rest == "N m", "{}", rest);
        }
    }

    #[test]
    fn the_digits_of_a_number_tell_its_precision(digits in 1i64..1_000_000, decimals in 0usize..6) {
        let text = format!("{:.decimals$}", digits as f64);
        let (parsed, _) = number::read(&text).map_err(|e| TestCaseError::fail(format!("{text}: {e}")))?;
        let expected = 0.5 * libm::pow(0.1, decimals as f64);
        prop_assert!((parsed.half_ulp_decimal / expected - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_formula_has_the_value_of_what_it_was_written_from((text, value) in formula()) {
        let parsed = Expression::parse(&text, &["x", "y"]);
        let parsed = parsed.map_err(|e| TestCaseError::fail(format!("{text}: {e}")))?;
        let got = parsed.eval(&[0.75, -1.25]);
        prop_assert!(got == value || got.is_nan() && value.is_nan(), "{}: {} {}", text, got, value);
    }

    #[test]
    fn a_unit_has_its_dimension_and_reads_itself((text, dimension, factor) in unit()) {
        let parsed = Unit::parse(&text).map_err(|e| TestCaseError::fail(format!("{text}: {e}")))?;
        prop_assert_eq!(&parsed.dimension.0[..3], &dimension);
        prop_assert!((parsed.factor / factor - 1.0).abs() < 1e-12);
        prop_assert_eq!(Unit::parse(parsed.text()), Ok(parsed));
    }
}
