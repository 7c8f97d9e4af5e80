//! What stands around the brackets of a vector or a matrix: a factor, a sign of transposition, a unit.

use triad_engine::scene::expression::notation;

use super::number;

/// Brackets within each other that have something around them.
const DEEPEST: usize = 8;
/// Signs of transposition, as they stand behind an array.
const TRANSPOSED: [&str; 8] = ["^ top", "^(top)", "^(T)", "^T", "^t", "'", ".transpose()", ".T"];

/// An array in one text, in plain notation.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Enclosed<'a> {
    /// What stands in the brackets.
    pub inner: &'a str,
    /// A factor of all entries in front of them, with its sign of multiplication, or a sign alone.
    before: String,
    /// A factor or a divisor of all entries behind them, with its sign.
    behind: String,
    /// Whether rows are written for columns.
    pub transposed: bool,
    /// The unit of all entries.
    pub unit: String,
}

/// Takes a text apart; `None` where what stands around the brackets is none of these. A text without brackets around all its entries
/// is its own inner text.
pub(super) fn enclosed(plain: &str) -> Option<Enclosed<'_>> {
    within(plain, DEEPEST)
}

fn within(plain: &str, deepest: usize) -> Option<Enclosed<'_>> {
    let plain = plain.trim();
    let plain = if plain.starts_with(['"', '\'', '`']) { without_brackets(plain) } else { plain };
    let Some([from, to]) = array(plain) else {
        return Some(Enclosed { inner: without_brackets(plain), ..Enclosed::default() });
    };
    let (behind, transposed) = transposition(plain[to..].trim());
    let (behind, unit) = divided(behind)?;
    let outer = factor(&plain[..from])?;
    let inner = within(without_brackets(&plain[from..to]), deepest.checked_sub(1)?)?;
    Some(Enclosed {
        inner: inner.inner,
        before: only(outer, inner.before)?,
        behind: only(behind, inner.behind)?,
        transposed: transposed != inner.transposed,
        unit: only(unit, inner.unit)?,
    })
}

/// The one of two texts that is there, if not both are.
fn only(one: String, other: String) -> Option<String> {
    if one.is_empty() { Some(other) } else { other.is_empty().then_some(one) }
}

impl Enclosed<'_> {
    /// An entry as a text that has the factors too.
    pub fn with_factors(&self, entry: &str) -> String {
        if self.before.is_empty() && self.behind.is_empty() {
            return entry.to_owned();
        }
        let entry = entry.strip_prefix('+').unwrap_or(entry);
        let is_number =
            entry.trim_start_matches(['-', '+']).chars().all(|c| c.is_ascii_digit() || ".,".contains(c));
        match (self.before.as_str(), entry.strip_prefix('-')) {
            // The digits of a number say how precise it is, and stay.
            ("-", Some(size)) if is_number => format!("{size}{}", self.behind),
            (before, _) if is_number => format!("{before}{entry}{}", self.behind),
            (before, _) => format!("{before}({entry}){}", self.behind),
        }
    }
}

fn without_brackets(mut text: &str) -> &str {
    loop {
        let inner = notation::without_brackets(text);
        if inner == text {
            return text;
        }
        text = inner;
    }
}

/// From where to where the brackets stand that hold all entries: outside of them nothing is separated, and inside something is.
fn array(plain: &str) -> Option<[usize; 2]> {
    const SEPARATE: [char; 5] = [',', ';', '\n', '|', '&'];
    let (mut depth, mut from, mut found) = (0usize, 0, None);
    for (at, c) in plain.char_indices() {
        match c {
            '(' | '[' | '{' | '<' => {
                if depth == 0 {
                    from = at;
                }
                depth += 1;
            }
            ')' | ']' | '}' | '>' if depth > 0 => {
                depth -= 1;
                let (to, inner) = (at + c.len_utf8(), plain[from + 1..at].trim());
                let several =
                    inner.contains(SEPARATE) || inner.contains(' ') || inner.contains(['(', '[', '{']);
                match found {
                    _ if depth > 0 || !several => {}
                    None => found = Some([from, to]),
                    // Rows beside each other, not a unit.
                    Some(_) if inner.starts_with(|c: char| c.is_ascii_digit() || "+-.([{".contains(c)) => {
                        return None;
                    }
                    Some(_) => {}
                }
            }
            c if depth == 0 && SEPARATE.contains(&c) => return None,
            _ => {}
        }
    }
    found
}

/// Without signs of transposition; whether there was an odd number of them.
fn transposition(behind: &str) -> (&str, bool) {
    let (mut rest, mut transposed) = (behind, false);
    while let Some(more) = TRANSPOSED.iter().find_map(|mark| rest.strip_prefix(mark)) {
        (rest, transposed) = (more.trim(), !transposed);
    }
    (rest, transposed)
}

/// What stands in front of an array, as a factor; `None` if it is none.
fn factor(before: &str) -> Option<String> {
    let before = notation::undecorated(before);
    let product = match before.chars().last() {
        None | Some('-' | '+' | '*') => before.to_owned(),
        Some(_) => format!("{before}*"),
    };
    let is_number = number::read(&format!("{product}1")).is_ok_and(|(_, unit)| unit.is_empty());
    is_number.then_some(product)
}

/// A factor or a divisor behind an array, and the unit behind that; `None` if it is neither, as a power or a sum is.
fn divided(behind: &str) -> Option<(String, String)> {
    let scales = behind.starts_with(['*', '/', 'x', 'X']);
    let counts = behind.starts_with(|c: char| c.is_ascii_digit()) && !behind.starts_with("1/");
    if behind.starts_with(['^', '+', '-']) || counts {
        return None;
    }
    let one = if scales { format!("1{behind}") } else { format!("1 {behind}") };
    let (number, unit) = number::read(&one).ok()?;
    if number.value == 1.0 {
        return Some((String::new(), if unit.starts_with('/') { format!("1{unit}") } else { unit }));
    }
    let written = behind.strip_suffix(unit.as_str()).map(str::trim_end);
    Some((written.map_or_else(|| format!("*{:e}", number.value), str::to_owned), unit))
}
