//! Vectors and matrices as they are typed or pasted into one field: `(1, 2, 3) N`, `[1; 2; 3]`, `1,5; 2,5; 3,5`,
//! `array([[1, 0], [0, 1]])`, `3 i − 2 k`, columns, LaTeX.

use triad_engine::scene::expression::{Expression, begins_factor, notation};

use super::number;
use super::units::Unit;

/// The entries row by row, each as text, and a unit behind all of them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Cells {
    pub texts: Vec<String>,
    pub unit: String,
}

/// Longest text that is taken apart, in characters.
const MAX_LENGTH: usize = 4000;
/// What programs write in front of the brackets of an array.
const NAMES: [&str; 16] = [
    "array",
    "matrix",
    "Matrix",
    "ImmutableMatrix",
    "vector",
    "Vector",
    "Vector3",
    "vec",
    "vec!",
    "std::vec!",
    "vec3",
    "torch.tensor",
    "tensor",
    "list",
    "tuple",
    "c",
];
/// Names of the unit vectors.
const BASES: [[&str; 3]; 6] = [
    ["i", "j", "k"],
    ["e_x", "e_y", "e_z"],
    ["e_1", "e_2", "e_3"],
    ["x", "y", "z"],
    ["u", "v", "w"],
    ["e_u", "e_v", "e_w"],
];

/// The entries of a text that holds `rows` times `columns` of them; `None` if it does not.
pub(crate) fn cells(text: &str, rows: usize, columns: usize) -> Option<Cells> {
    if text.chars().count() > MAX_LENGTH {
        return None;
    }
    // Lines are rows; the plain notation would take them for spaces.
    let lines: Vec<String> =
        text.trim().lines().map(notation::plain).filter(|line| !line.is_empty()).collect();
    let plain = unnamed(&lines.join("\n"));
    let wanted = rows * columns;
    if wanted == 3
        && columns == 1
        && let Some(cells) = in_unit_vectors(&plain)
    {
        return Some(cells);
    }
    let (inner, unit) = around(&plain);
    let texts = (columns > 1).then(|| matrix(&inner, rows, columns)).flatten();
    let texts = texts.or_else(|| flat(&inner, wanted)).or_else(|| {
        // `[1], [2], [3]`
        flat(&inner.replace(['[', ']', '(', ')', '{', '}'], " "), wanted)
    });
    texts.map(|texts| Cells { texts, unit })
}

/// Without the name of an array, `dtype=…`, a label and a sign of transposition.
fn unnamed(plain: &str) -> String {
    let mut text = plain;
    if let Some(at) = text.find('=').filter(|at| text[..*at].find(['[', '(', ',']).is_none()) {
        // `F = (1, 2, 3)`, but not `x = 1, y = 2, z = 3`.
        if text[at + 1..].find('=').is_none_or(|next| text[at..at + 1 + next].contains("dtype")) {
            text = text[at + 1..].trim();
        }
    }
    let mut text = text.trim_end_matches(['.', ';']);
    for transposed in ["^T", "^(T)", "^t", "'", ".T", ".transpose()", "^ top", "^(top)"] {
        if let Some(before) =
            text.strip_suffix(transposed).filter(|before| before.trim_end().ends_with([']', ')', '>']))
        {
            text = before.trim();
        }
    }
    for name in NAMES {
        if let Some(rest) =
            text.strip_prefix(name).filter(|rest| rest.trim_start().starts_with(['(', '[', '{']))
        {
            text = rest.trim();
        }
    }
    match text.find("dtype") {
        Some(at) => text[..at].trim_end().trim_end_matches(',').to_owned() + ")",
        None => text.to_owned(),
    }
}

/// The bars beside the rows of a matrix, `| 1 0 |`.
fn without_bars(line: &str) -> &str {
    let inner = line.strip_prefix('|').and_then(|rest| rest.strip_suffix('|'));
    inner.filter(|inner| !inner.contains('|')).unwrap_or(line).trim()
}

/// What stands in the outermost brackets, and the unit behind them.
fn around(plain: &str) -> (String, String) {
    let mut text = plain.trim();
    let mut unit = String::new();
    if let Some(end) = text.rfind([')', ']', '}', '>'])
        && text.starts_with(['(', '[', '{', '<'])
    {
        let behind = text[end + 1..].trim();
        let transposed = ["^T", "^(T)", "^t", "'"].iter().find_map(|mark| behind.strip_prefix(mark));
        let behind = transposed.unwrap_or(behind).trim().trim_start_matches('*').trim();
        let is_unit =
            behind.starts_with(|c: char| c.is_alphabetic() || "°%".contains(c)) || behind.starts_with("1/");
        if is_unit {
            behind.clone_into(&mut unit);
            text = &text[..=end];
            // `(1, 2, 3) (N m)` and `(1, 2, 3) kg/(m s)` end with a bracket of the unit, which is found below.
        } else if behind.is_empty()
            && let Some((value, bracket)) = unit_in_bracket(text)
        {
            unit = bracket;
            text = value;
        }
    }
    loop {
        let inner = notation::without_brackets(text);
        if inner == text {
            return (text.to_owned(), unit);
        }
        text = inner;
    }
}

/// `(1, 2, 3) [N]`, `(1, 2, 3) kg/(m s)`: the array, and the unit that ends with a bracket.
fn unit_in_bracket(text: &str) -> Option<(&str, String)> {
    let mut depth = 0usize;
    let end = text.char_indices().find_map(|(k, c)| {
        match c {
            '(' | '[' | '{' | '<' => depth += 1,
            ')' | ']' | '}' | '>' => depth = depth.saturating_sub(1),
            _ => return None,
        }
        (depth == 0).then_some(k + c.len_utf8())
    })?;
    let behind = text[end..].trim();
    behind.contains(|c: char| c.is_alphabetic()).then(|| (&text[..end], behind.to_owned()))
}

/// Rows by lines, semicolons or brackets, entries as in a vector.
fn matrix(inner: &str, rows: usize, columns: usize) -> Option<Vec<String>> {
    let bracketed = inner.contains(['[', '(', '{']) && inner.contains([']', ')', '}']);
    let lines: Vec<&str> = if bracketed {
        inner
            .split([']', ')', '}'])
            .map(|row| row.trim_start_matches([',', ';', '\n', ' ', '[', '(', '{']))
            .collect()
    } else {
        inner.split([';', '\n']).collect()
    };
    let lines: Vec<&str> = lines.into_iter().map(str::trim).filter(|line| !line.is_empty()).collect();
    if lines.len() != rows {
        return None;
    }
    let rows: Option<Vec<Vec<String>>> =
        lines.into_iter().map(|line| flat(without_bars(line), columns)).collect();
    Some(rows?.concat())
}

/// Exactly so many entries, separated by the first sign that gives them.
fn flat(text: &str, wanted: usize) -> Option<Vec<String>> {
    type Separate<'a> = &'a dyn Fn(&str) -> Vec<String>;
    let separators: [Separate; 5] = [
        &|text| pieces(text.split([';', '&', '|', '\n'])),
        &|text| pieces(text.split(", ")),
        &|text| pieces(text.split([',', '\n'])),
        &|text| pieces(text.split([',', ';', '\n'])),
        &by_spaces,
    ];
    separators.iter().map(|separate| separate(text)).find(|pieces| {
        pieces.len() == wanted
            && pieces.iter().all(|piece| !piece.contains(';') && number::read(piece).is_ok())
    })
}

/// What spaces separate; a unit belongs to the number in front of it.
fn by_spaces(text: &str) -> Vec<String> {
    let joined = signs_joined(text);
    let mut out: Vec<String> = Vec::new();
    for piece in pieces(joined.split_whitespace().map(|piece| piece.trim_matches(','))) {
        match out.last_mut() {
            Some(last)
                if piece.starts_with(|c: char| c.is_alphabetic() || c == '/')
                    && !piece.contains('=')
                    && !begins_factor(&piece) =>
            {
                *last = format!("{last} {piece}");
            }
            _ => out.push(piece),
        }
    }
    out
}

fn pieces<'a>(split: impl Iterator<Item = &'a str>) -> Vec<String> {
    let unquoted = split.map(|piece| piece.trim().trim_matches(['"', '\'', '`']).trim());
    unquoted.filter(|piece| !piece.is_empty()).map(str::to_owned).collect()
}

/// `- 2` as `-2`, so that spaces separate.
fn signs_joined(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut after_sign = false;
    for c in text.chars() {
        if after_sign && c == ' ' {
            continue;
        }
        after_sign = matches!(c, '-' | '+') && out.ends_with([' ', '\n', '(', '[', ',', ';'])
            || out.is_empty() && c == '-';
        out.push(c);
    }
    out
}

/// A sum of multiples of unit vectors, each at most once, and a unit behind it: `3 i − 2 k`, `(3 i − 2 k) N m`.
fn in_unit_vectors(plain: &str) -> Option<Cells> {
    let whole = sum_of_unit_vectors(plain);
    let spaces = plain.char_indices().filter(|(_, c)| *c == ' ').map(|(at, _)| at);
    whole.or_else(|| {
        spaces.rev().find_map(|at| {
            let unit = plain[at..].trim();
            Unit::parse(unit).ok()?;
            Some(Cells { unit: unit.to_owned(), ..sum_of_unit_vectors(plain[..at].trim_end())? })
        })
    })
}

fn sum_of_unit_vectors(plain: &str) -> Option<Cells> {
    BASES.iter().find_map(|names| {
        let sum = Expression::parse(plain, names).ok()?;
        let at = |point: [f64; 3]| sum.eval(&point);
        let entries = [at([1.0, 0.0, 0.0]), at([0.0, 1.0, 0.0]), at([0.0, 0.0, 1.0])];
        let linear = at([0.0; 3]) == 0.0
            && (at([2.0, 3.0, 5.0]) - (2.0 * entries[0] + 3.0 * entries[1] + 5.0 * entries[2])).abs()
                <= 1e-12 * entries.iter().map(|e| e.abs()).sum::<f64>();
        (linear && entries.iter().all(|e| e.is_finite()))
            .then(|| Cells { texts: entries.iter().map(f64::to_string).collect(), unit: String::new() })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, rows: usize, columns: usize) -> (Vec<f64>, String) {
        let cells = cells(text, rows, columns).unwrap_or_else(|| panic!("{text}"));
        (cells.texts.iter().map(|cell| number::read(cell).unwrap().0.value).collect(), cells.unit)
    }

    #[test]
    fn vectors_in_one_field() {
        for text in [
            "(1, -2.5, 3)",
            "1, -2.5, 3",
            "[1,-2.5,3]",
            "1 -2.5 3",
            "1; -2.5; 3",
            "1\n-2.5\n3",
            "{1, -2.5, 3}",
            "<1, -2.5, 3>",
            "array([ 1. , -2.5,  3. ])",
            "np.array([1, -2.5, 3])",
            "[1 -2.5 3]",
            "[1 - 2.5 3]",
            "[1; -2.5; 3]",
            "1\t-2.5\t3",
            "1,0; -2,5; 3,0",
            "1,0 -2,5 3,0",
            "(1,0 | -2,5 | 3,0)",
            "[[1], [-2.5], [3]]",
            "[1, -2.5, 3]^T",
            "F = (1, -2.5, 3)",
            r"\begin{pmatrix} 1 \\ -2.5 \\ 3 \end{pmatrix}",
            "[\"1\", \"-2.5\", \"3\"]",
            "x = 1, y = -2.5, z = 3",
            "i - 2.5 j + 3 k",
            "1 i - 2.5 j + 3 k",
            "1 e_x − 2.5 e_y + 3 e_z",
            "(1, -5/2, 3)",
            "1,-2.5,3",
            "array([1, -2.5, 3], dtype=float64)",
            "[1, -2.5, 3]'",
            "(1.0, −2.5, 3.0)",
            "Matrix([1, -2.5, 3])",
            "tensor([1., -2.5, 3.])",
            "1 , -2.5 , 3 ;",
            "x=1 y=-2.5 z=3",
            "(1, -2.5, 3)ᵀ",
            "torch.tensor([1., -2.5, 3.])",
            "c(1, -2.5, 3)",
            "vec![1.0, -2.5, 3.0]",
            "î − 2.5 ĵ + 3 k̂",
            r"\langle 1, -2.5, 3\rangle",
        ] {
            assert_eq!(read(text, 3, 1), (vec![1.0, -2.5, 3.0], String::new()), "{text}");
        }
        for (text, unit) in [
            ("(1, -2.5, 3) N", "N"),
            ("[1, -2.5, 3] N m", "N m"),
            ("(1, -2.5, 3) [N]", "[N]"),
            ("(1, -2.5, 3) kg/(m s)", "kg/(m s)"),
            ("[1, -2.5, 3]*N", "N"),
            ("1 i - 2.5 j + 3 k N m", "N m"),
            ("(i - 2.5 j + 3 k) N", "N"),
            ("[1, -2.5, 3]ᵀ N", "N"),
        ] {
            assert_eq!(read(text, 3, 1), (vec![1.0, -2.5, 3.0], unit.to_owned()), "{text}");
        }
        let cells = cells("1 N, -2.5 N, 3 N", 3, 1).unwrap();
        assert_eq!(cells.texts, ["1 N", "-2.5 N", "3 N"]);
    }

    #[test]
    fn matrices_in_one_field() {
        for text in [
            "[[1, 2], [3, 4]]",
            "[1 2; 3 4]",
            "1 2\n3 4",
            "1, 2; 3, 4",
            "array([[1, 2],\n       [3, 4]])",
            "((1, 2), (3, 4))",
            "{{1, 2}, {3, 4}}",
            r"\begin{bmatrix} 1 & 2 \\ 3 & 4 \end{bmatrix}",
            "1 2 3 4",
            "[[1 2]\n [3 4]]",
            "1\t2\n3\t4",
            "1,0 2,0; 3,0 4,0",
            "| 1 2 |\n| 3 4 |",
            "sp.Matrix([[1, 2], [3, 4]])",
        ] {
            assert_eq!(read(text, 2, 2), (vec![1.0, 2.0, 3.0, 4.0], String::new()), "{text}");
        }
    }

    #[test]
    fn what_has_another_size_is_refused() {
        for text in ["1, 2", "(1, 2, 3, 4)", "1 2 x", "", "i + 1", "i*j", "hello"] {
            assert_eq!(cells(text, 3, 1), None, "{text}");
        }
        assert_eq!(cells("1 2 3; 4", 2, 2), None);
        assert_eq!(cells(&"1 ".repeat(100_000), 3, 1), None);
    }
}
