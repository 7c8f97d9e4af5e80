//! Texts that were read and found good, kept in `tests/data/reviewed/`. A text that differs fails.
//!
//! `INSTA_UPDATE=always cargo test …` writes those of the tests that it runs; read the difference, it belongs into the
//! same commit.

use crate::root;

/// The decimals that are compared: more depend on how the platform's C library rounds a sine.
const MAX_DECIMALS: usize = 9;
/// Numbers below ten to this power are rounding.
const ROUNDING: i32 = -8;

/// What stands before a time that the program took.
const RUN_TIME: &str = "  run time ";

/// Holds a text against the one that is kept under that name.
pub fn reviewed(name: &str, text: &str) {
    let mut settings = insta::Settings::new();
    settings.set_snapshot_path(root().join("tests/data/reviewed"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!(name, text));
}

/// The text without what rounding decides: numbers of the size of rounding errors are `~0`, others have so many
/// decimals, zeros have no sign; how long something took is left out.
pub fn settled(text: &str) -> String {
    let timed = |line: &str| line.find(RUN_TIME).map(|at| line[..at + RUN_TIME.len()].to_owned());
    let lines: Vec<String> =
        text.lines().map(|line| timed(line).unwrap_or_else(|| line.to_owned())).collect();
    let text = lines.join("\n");
    let mut rest = text.as_str();
    let numeric = |c: char| c.is_ascii_digit() || ".e-".contains(c);
    let mut settled = String::with_capacity(text.len());
    while let Some(at) = rest.find(|c: char| c.is_ascii_digit() || c == '-') {
        let (before, from) = rest.split_at(at);
        settled.push_str(before);
        let word_before =
            before.chars().next_back().is_some_and(|c| c.is_alphanumeric() || c == '_' || c == '-');
        let end = from.find(|c| !numeric(c)).unwrap_or(from.len());
        // A full stop ends the sentence, not the number.
        let end = from[..end].trim_end_matches('.').len().max(1);
        let (number, after) = from.split_at(end);
        let number_alone = !word_before && number.parse::<f64>().is_ok();
        settled.push_str(&if number_alone { plain(number) } else { number.to_owned() });
        rest = after;
    }
    settled + rest
}

/// One number, settled. What a text says for itself, such as 1e-9, has no decimals and stays.
fn plain(number: &str) -> String {
    let (mantissa, exponent) =
        number.split_once('e').map_or((number, None), |(m, e)| (m, e.parse::<i32>().ok()));
    let decimals = mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    if decimals > 0 && exponent.is_some_and(|exponent| exponent <= ROUNDING) {
        return "~0".to_owned();
    }
    if exponent.is_some() || decimals == 0 {
        return number.to_owned();
    }
    let value: f64 = mantissa.parse().unwrap();
    let short = format!("{value:.*}", decimals.min(MAX_DECIMALS));
    match short.parse::<f64>() {
        // A sign that goes leaves its place, so that columns stay columns.
        Ok(0.0) if decimals <= MAX_DECIMALS => short.replace('-', " "),
        Ok(0.0) => number.to_owned(),
        _ => short,
    }
}

#[test]
fn what_rounding_decides_is_not_compared() {
    let told = "drift 5.83e-10 J, force -0.000000, at 0.323997913098232 s; n-four-bar:2 rf-1e-9 -1.5 3. 2e3 1e-9 1.0.";
    let same = "drift ~0 J, force  0.000000, at 0.323997913 s; n-four-bar:2 rf-1e-9 -1.5 3. 2e3 1e-9 1.0.";
    assert_eq!(settled(told), same);
}
