//! Vectors and matrices as they are typed or pasted into one field: `(1, 2, 3) N`, `[1; 2; 3]`, `1,5; 2,5; 3,5`,
//! `array([[1, 0], [0, 1]])`, `3 i − 2 k`, columns, LaTeX.

use triad_engine::scene::expression::{Expression, begins_factor, notation};

use super::enclosed::enclosed;
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
        && !plain.contains('=')
        && let Some(cells) = in_unit_vectors(&plain)
    {
        return Some(cells);
    }
    let array = enclosed(&plain)?;
    let texts = if columns == 1 {
        vector(array.inner, wanted)
    } else if array.transposed {
        matrix(array.inner, columns, rows).map(|texts| transpose(&texts, rows))
    } else {
        matrix(array.inner, rows, columns).or_else(|| vector(array.inner, wanted))
    };
    let texts = texts?.iter().map(|text| array.with_factors(text)).collect();
    Some(Cells { texts, unit: array.unit.clone() })
}

/// So many entries in one row or column, in the order of their labels if they have such.
fn vector(inner: &str, wanted: usize) -> Option<Vec<String>> {
    let texts = flat(inner, wanted).or_else(|| {
        // `[1], [2], [3]`
        let alone = inner
            .split([',', ';', '\n'])
            .all(|piece| notation::without_brackets(piece.trim()) != piece.trim());
        let spaced = !inner.contains([',', ';', '\n']) && inner.starts_with(['[', '(', '{']);
        (alone || spaced).then(|| flat(&inner.replace(['[', ']', '(', ')', '{', '}'], " "), wanted)).flatten()
    })?;
    let order = order(&texts)?;
    Some(order.into_iter().map(|k| texts[k].clone()).collect())
}

/// In which order labelled entries are meant, `z = 3, x = 1, y = 2`: as they stand where they have no labels or others. `None` if one is
/// labelled twice.
pub(crate) fn order(texts: &[String]) -> Option<Vec<usize>> {
    const LETTERS: [[char; 3]; 3] = [['x', 'y', 'z'], ['i', 'j', 'k'], ['u', 'v', 'w']];
    let as_they_stand = || Some((0..texts.len()).collect());
    let labels: Option<Vec<&str>> =
        texts.iter().map(|text| text.split_once(['=', ':']).map(|(label, _)| label.trim())).collect();
    let Some(labels) = labels.filter(|labels| !labels.is_empty()) else { return as_they_stand() };
    let by_letter = |letters: &[char; 3]| -> Option<Vec<usize>> {
        labels
            .iter()
            .map(|label| letters.iter().position(|letter| label.to_lowercase().ends_with(*letter)))
            .collect()
    };
    let number = |label: &&str| label.trim_start_matches(|c: char| !c.is_ascii_digit()).parse::<usize>().ok();
    let by_number = || labels.iter().map(number).collect::<Option<Vec<_>>>();
    let Some(places) = LETTERS.iter().find_map(by_letter).or_else(by_number) else { return as_they_stand() };
    let mut order: Vec<usize> = (0..texts.len()).collect();
    order.sort_by_key(|k| places[*k]);
    order.windows(2).all(|pair| places[pair[0]] < places[pair[1]]).then_some(order)
}

/// The entries of `rows` rows, of those column by column.
fn transpose(texts: &[String], rows: usize) -> Vec<String> {
    (0..rows).flat_map(|row| texts.iter().skip(row).step_by(rows).cloned()).collect()
}

/// Without the name of an array, `dtype=…` and a label.
fn unnamed(plain: &str) -> String {
    let mut text = plain;
    if let Some(at) = text.find('=').filter(|at| text[..*at].find(['[', '(', ',']).is_none()) {
        // `F = (1, 2, 3)`, but not `x = 1, y = 2, z = 3`.
        if text[at + 1..].find('=').is_none_or(|next| text[at..at + 1 + next].contains("dtype")) {
            text = text[at + 1..].trim();
        }
    }
    text = text.trim_end_matches(['.', ';']);
    for name in NAMES {
        if let Some(rest) =
            text.strip_prefix(name).filter(|rest| rest.trim_start().starts_with(['(', '[', '{']))
        {
            text = rest.trim();
        }
    }
    let Some(at) = text.find("dtype") else { return text.to_owned() };
    // Up to the end of the array's own bracket: `dtype=np.dtype(float))` has another within.
    let mut depth = 0;
    let end = text[at..].find(|c| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        depth < 0
    });
    let behind = end.map_or("", |end| &text[at + end + 1..]);
    text[..at].trim_end().trim_end_matches(',').to_owned() + ")" + behind
}

/// The bars beside the rows of a matrix, `| 1 0 |`.
fn without_bars(line: &str) -> &str {
    let inner = line.strip_prefix('|').and_then(|rest| rest.strip_suffix('|'));
    inner.filter(|inner| !inner.contains('|')).unwrap_or(line).trim()
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
    fn a_factor_and_labels_belong_to_all_entries() {
        for (text, values) in [
            ("-(1, -2.5, 3)", [-1.0, 2.5, -3.0]),
            ("2*(1, -2.5, 3)", [2.0, -5.0, 6.0]),
            ("1/2 (1, -2.5, 3)", [0.5, -1.25, 1.5]),
            ("sqrt(4)*[1, -2.5, 3]", [2.0, -5.0, 6.0]),
            ("F = -[1 -2.5 3]", [-1.0, 2.5, -3.0]),
            ("(1, -2.5, 3)/2", [0.5, -1.25, 1.5]),
            ("-(1, -2.5, 3)*10^3", [-1e3, 2.5e3, -3e3]),
            ("(1+1, 1/2, -3)/2", [1.0, 0.25, -1.5]),
            ("z = 3, y = 2, x = 1", [1.0, 2.0, 3.0]),
            ("Fx=1, Fz=3, Fy=2", [1.0, 2.0, 3.0]),
            ("q2 = 2; q1 = 1; q3 = 3", [1.0, 2.0, 3.0]),
            ("a = 3, b = 2, c = 1", [3.0, 2.0, 1.0]),
        ] {
            assert_eq!(read(text, 3, 1), (values.to_vec(), String::new()), "{text}");
        }
        assert_eq!(read("-(1, 2, 3)*10^3 N", 3, 1), (vec![-1e3, -2e3, -3e3], "N".to_owned()));
        assert_eq!(read("(1, 2, 3)/4 N m", 3, 1), (vec![0.25, 0.5, 0.75], "N m".to_owned()));
        assert_eq!(cells("-(1.50, -2, 3)", 3, 1).unwrap().texts, ["-1.50", "2", "-3"], "the digits stay");
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
        for text in [
            "[1 3; 2 4]^T",
            "[1 3; 2 4]'",
            "np.array([[1, 3], [2, 4]]).T",
            "[[1, 3], [2, 4]].transpose()",
            "[1 3; 2 4]ᵀ",
            "([1 2; 3 4]^T)^T",
            "-[-1 -3; -2 -4]^T",
            "0.5*[2 4; 6 8]",
        ] {
            assert_eq!(read(text, 2, 2), (vec![1.0, 2.0, 3.0, 4.0], String::new()), "{text}");
        }
        assert_eq!(read("[1 2; 3 4; 5 6]^T m", 2, 3), (vec![1.0, 3.0, 5.0, 2.0, 4.0, 6.0], "m".to_owned()));
    }

    #[test]
    fn what_has_another_size_is_refused() {
        for text in [
            "1, 2",
            "(1, 2, 3, 4)",
            "1 2 x",
            "",
            "i + 1",
            "i*j",
            "hello",
            "(1, 2, 3)^2",
            "(1, 2, 3) + (1, 2, 3)",
            "(1, 2, 3) 4",
            "m (1, 2, 3)",
            "x = 1, x = 2, z = 3",
            "()",
        ] {
            assert_eq!(cells(text, 3, 1), None, "{text}");
        }
        for text in ["1 2 3; 4", "[1, 2; 3, 4]^-1", "1 2 3 4^T", "[1 2 3; 4 5 6]^T"] {
            assert_eq!(cells(text, 2, 2), None, "{text}");
        }
        assert_eq!(cells(&"1 ".repeat(100_000), 3, 1), None);
        let deep = format!("{}1, 2, 3{}", "-(".repeat(1_300), ")".repeat(1_300));
        assert_eq!(cells(&deep, 3, 1), None);
        assert_eq!(
            cells(&format!("(1, 2, 3){}", "'".repeat(3_900)), 3, 1).map(|cells| cells.texts.len()),
            Some(3)
        );
    }
}
