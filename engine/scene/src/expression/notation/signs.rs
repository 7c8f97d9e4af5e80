//! Unicode signs, each as the plain characters that it stands for.

/// Greek letters from alpha to omega by their names, with both sigmas.
const GREEK: [&str; 25] = [
    "alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa", "lambda", "mu",
    "nu", "xi", "omicron", "pi", "rho", "sigma", "sigma", "tau", "upsilon", "phi", "chi", "psi", "omega",
];
/// Fractions that have a sign of their own.
const FRACTIONS: [(char, &str); 9] = [
    ('½', "1/2"),
    ('⅓', "1/3"),
    ('⅔', "2/3"),
    ('¼', "1/4"),
    ('¾', "3/4"),
    ('⅕', "1/5"),
    ('⅙', "1/6"),
    ('⅛', "1/8"),
    ('⅜', "3/8"),
];

/// Every sign of the text as plain characters.
pub(super) fn plain(text: &str) -> String {
    let chars: Vec<char> = text.chars().filter_map(letter).collect();
    let mut out = String::with_capacity(text.len());
    let mut k = 0;
    while let Some(&c) = chars.get(k) {
        k += 1;
        if let Some(first) = superscript(c) {
            out.push('^');
            out.push(first);
            while let Some(next) = chars.get(k).copied().and_then(superscript) {
                out.push(next);
                k += 1;
            }
        } else if let Some(lowered) = subscript(c) {
            if k < 2 || subscript(chars[k - 2]).is_none() {
                out.push('_');
            }
            out.push(lowered);
        } else if let Some(name) = greek(c) {
            word(&mut out, &name, chars.get(k).copied());
        } else if let Some((_, fraction)) = FRACTIONS.iter().find(|(sign, _)| *sign == c) {
            let whole = out.ends_with(|c: char| c.is_ascii_digit());
            out.extend([if whole { "+" } else { "" }, "(", fraction, ")"]);
        } else if c == '√' || c == '∛' {
            k += root(&mut out, if c == '√' { "sqrt" } else { "cbrt" }, &chars[k..]);
        } else {
            out.push(c);
        }
    }
    out
}

/// A name with the spaces that keep it apart from letters and digits beside it.
fn word(out: &mut String, name: &str, next: Option<char>) {
    if out.ends_with(|c: char| c.is_alphanumeric()) {
        out.push(' ');
    }
    *out += name;
    let joined = |c: char| superscript(c).is_some() || subscript(c).is_some();
    if next.is_some_and(|c| (c.is_alphanumeric() || c == '√') && !joined(c)) {
        out.push(' ');
    }
}

/// A root of what follows: of a bracket, else of the number or name next to it. Returns how many characters were taken.
fn root(out: &mut String, name: &str, after: &[char]) -> usize {
    if out.ends_with(|c: char| c.is_alphabetic()) {
        out.push(' ');
    }
    *out += name;
    let spaces = after.iter().take_while(|c| c.is_whitespace()).count();
    if after.get(spaces) == Some(&'(') {
        return spaces;
    }
    let number = after[spaces..].iter().take_while(|c| c.is_ascii_digit() || **c == '.').count();
    let taken = if number > 0 { number } else { usize::from(after.len() > spaces) };
    let inner: String = after[spaces..spaces + taken].iter().collect();
    out.extend(["(", &plain(&inner), ")"]);
    spaces + taken
}

/// One character for one: dashes, dots, spaces, full-width and mathematical letters; nothing for what cannot be seen.
fn letter(c: char) -> Option<char> {
    Some(match c {
        // With the hat of a unit vector, the arrow over a vector, the dot over a rate.
        '\u{feff}'
        | '\u{200b}'..='\u{200f}'
        | '\u{2060}'..='\u{2064}'
        | '\u{ad}'
        | '\u{302}'
        | '\u{307}'
        | '\u{20d7}' => return None,
        'î' => 'i',
        'ĵ' => 'j',
        'ŷ' => 'y',
        'ẑ' => 'z',
        '\u{2212}' | '\u{2010}'..='\u{2015}' | '\u{fe63}' => '-',
        '·' | '⋅' | '×' | '∙' | '•' | '∗' | '✕' | '⨯' => '*',
        '\u{2215}' | '\u{2044}' | '÷' => '/',
        '\u{a0}' | '\u{2000}'..='\u{200a}' | '\u{202f}' | '\u{205f}' | '\u{3000}' | '\t' => ' ',
        '’' | '‘' | '′' => '\'',
        '“' | '”' | '″' => '"',
        'º' | '˚' => '°',
        'µ' => 'u',
        '⟨' | '〈' => '<',
        '⟩' | '〉' => '>',
        'ℎ' => 'h',
        '\u{ff01}'..='\u{ff5e}' => offset(c, 0xff01, '!'),
        '\u{1d400}'..='\u{1d6a3}' => {
            let place = (u32::from(c) - 0x1d400) % 52;
            let (first, place) = if place < 26 { ('A', place) } else { ('a', place - 26) };
            char::from_u32(u32::from(first) + place).unwrap_or(c)
        }
        '\u{1d6a8}'..='\u{1d7cb}' => match (u32::from(c) - 0x1d6a8) % 58 {
            place @ 0..=24 => char::from_u32(0x391 + place).unwrap_or(c),
            place @ 26..=50 => char::from_u32(0x3b1 + place - 26).unwrap_or(c),
            _ => c,
        },
        '\u{1d7ce}'..='\u{1d7ff}' => {
            char::from_u32(u32::from('0') + (u32::from(c) - 0x1d7ce) % 10).unwrap_or(c)
        }
        other => other,
    })
}

fn offset(c: char, first: u32, stands_for: char) -> char {
    char::from_u32(u32::from(c) - first + u32::from(stands_for)).unwrap_or(c)
}

fn superscript(c: char) -> Option<char> {
    match c {
        '⁻' => return Some('-'),
        'ᵀ' => return Some('T'),
        _ => {}
    }
    "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|s| s == c).map(|digit| char::from(b"0123456789"[digit]))
}

fn subscript(c: char) -> Option<char> {
    const LOWERED: &str = "₀₁₂₃₄₅₆₇₈₉ₐₑₕᵢⱼₖₗₘₙₒₚᵣₛₜᵤᵥₓ";
    LOWERED.chars().position(|s| s == c).map(|k| char::from(b"0123456789aehijklmnoprstuvx"[k]))
}

/// The name of a Greek letter; a capital's with a capital.
fn greek(c: char) -> Option<String> {
    let named = |first: u32| {
        usize::try_from(u32::from(c).checked_sub(first)?)
            .ok()
            .and_then(|k| GREEK.get(k))
            .map(|s| (*s).to_owned())
    };
    match c {
        'ϕ' => Some("phi".to_owned()),
        'ϑ' => Some("theta".to_owned()),
        'ϵ' => Some("epsilon".to_owned()),
        'Ω' => Some("Omega".to_owned()),
        'α'..='ω' => named(u32::from('α')),
        'Α'..='Ω' => named(u32::from('Α')).map(|name| name[..1].to_uppercase() + &name[1..]),
        _ => None,
    }
}
