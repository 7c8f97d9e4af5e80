//! Calculations with units, `3 kg * 9.81 m/s^2`, and numbers with a fraction behind them, `9 3/8`, in plain notation.

/// How a factor stands behind what is before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sign {
    /// `*`
    Times,
    /// `/`
    Over,
}

/// What stands before the first sign with a number behind it, the sign, and the text from that number on: of `kg * 9.81 m/s^2`
/// the unit `kg` and `9.81 m/s^2`. Not the power in `m**2`.
pub(super) fn next_factor(unit: &str) -> Option<(&str, Sign, &str)> {
    let at = unit.char_indices().find_map(|(at, c)| {
        let sign = match c {
            '*' => Sign::Times,
            '/' => Sign::Over,
            _ => return None,
        };
        let behind = unit[at + 1..].trim_start();
        let is_number = behind.starts_with(|c: char| c.is_ascii_digit() || c == '.');
        let is_power = unit[..at].ends_with('*') || unit[at + 1..].starts_with('*');
        (is_number && !is_power && !unit[..at].trim().is_empty()).then_some((at, sign))
    });
    at.map(|(at, sign)| (unit[..at].trim(), sign, unit[at + 1..].trim_start()))
}

/// The unit of a product or a quotient of two quantities.
pub(super) fn times_unit(before: &str, sign: Sign, own: &str) -> String {
    match (sign, own.is_empty()) {
        (_, true) => before.to_owned(),
        (Sign::Times, _) if before.contains('/') => format!("({before})*{own}"),
        (Sign::Times, _) => format!("{before}*{own}"),
        (Sign::Over, _) => format!("{before}/({own})"),
    }
}

/// The value of a whole number with a proper fraction behind it, and the text after it.
pub(super) fn mixed(answer: &str) -> Option<(f64, &str)> {
    let (negative, size) = answer.strip_prefix('-').map_or((false, answer), |size| (true, size.trim_start()));
    let (whole, rest) = digits(size)?;
    let (above, rest) = digits(rest.strip_prefix(' ')?.trim_start())?;
    let (below, rest) = digits(rest.strip_prefix('/')?)?;
    let value = whole + above / below;
    (0.0 < above && above < below && !rest.starts_with(['.', ',']))
        .then_some((if negative { -value } else { value }, rest))
}

/// The whole number that begins a text, and what follows.
fn digits(text: &str) -> Option<(f64, &str)> {
    let end = text.bytes().take_while(u8::is_ascii_digit).count();
    Some((text[..end].parse().ok()?, &text[end..]))
}
