//! One plain notation for whatever is typed or pasted: word processors' signs, superscripts, Greek letters and LaTeX
//! become the ASCII that the readers of numbers, units and formulas know.

mod latex;
mod signs;

/// The text in plain notation, trimmed: `−2·10⁻³` is `-2*10^-3`, `ω²` is `omega^2`, `\frac{1}{2}` is `((1)/(2))`.
pub fn plain(text: &str) -> String {
    let text = if ["\\", "$", "^{", "_{"].iter().any(|sign| text.contains(sign)) {
        latex::plain(text)
    } else {
        text.to_owned()
    };
    without_modules(signs::plain(&text).trim())
}

/// Where programs keep their functions: `np.sqrt(2)` is `sqrt(2)`.
const MODULES: [&str; 6] = ["np.", "numpy.", "math.", "Math.", "sp.", "sympy."];

/// Without the names of modules in front of names of functions.
fn without_modules(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let begins = !out.ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == '.');
        let behind = MODULES.iter().filter(|_| begins).find_map(|module| rest.strip_prefix(module));
        if let Some(behind) = behind.filter(|behind| behind.starts_with(|c: char| c.is_alphabetic())) {
            rest = behind;
        } else {
            out.push(c);
            rest = &rest[c.len_utf8()..];
        }
    }
    out
}

/// What is meant as the answer, of plain text such as `F = 29.4 N`, `(29.4)`, `approx. 29.4 ± 0.1`.
pub fn undecorated(plain: &str) -> &str {
    let mut text = plain.trim().trim_end_matches([',', ';']).trim();
    loop {
        let before = text;
        text = without_brackets(without_label(without_lead(text)));
        let uncertain = ["\u{b1}", "+/-", " +- "].iter().find_map(|sign| text.split_once(sign));
        if let Some((value, _)) = uncertain
            && !value.trim().is_empty()
        {
            text = value.trim();
        }
        if text == before {
            return text;
        }
    }
}

/// Without signs and words that say "about" or "is".
fn without_lead(text: &str) -> &str {
    // Not the sign of something greater.
    let arrow = ["=>", "->", ">>>", "\u{21d2}", "\u{2192}"].iter().find_map(|arrow| text.strip_prefix(arrow));
    let text = arrow.unwrap_or(text).trim_start();
    let mut text = text.trim_start_matches(['=', '~', '\u{2248}', '\u{2243}', '\u{2245}', ':']).trim();
    for word in ["approximately", "approx.", "approx", "roughly", "about", "circa", "ca.", "ca"] {
        if let (Some(start), Some(rest)) = (text.get(..word.len()), text.get(word.len()..))
            && start.eq_ignore_ascii_case(word)
            && rest.starts_with(|c: char| c.is_whitespace() || c.is_ascii_digit() || c == '-')
        {
            text = rest.trim();
        }
    }
    text
}

/// What stands behind the last equals sign, or behind a name and a colon.
fn without_label(text: &str) -> &str {
    let equals = ['=', '\u{2248}', '\u{2243}', '\u{2245}'];
    if let Some(at) = text.rfind(equals) {
        // `<= 4` bounds an answer, and is none.
        if text[..at].ends_with(['<', '>', '!']) {
            return text;
        }
        let behind = text[at..].trim_start_matches(equals).trim();
        // `29.4 N = F`: a name alone is no answer.
        if behind.contains(|c: char| c.is_ascii_digit()) || behind.contains("pi") {
            return behind;
        }
        let before = text[..at].trim();
        return if before.contains(|c: char| c.is_ascii_digit()) { before } else { behind };
    }
    match text.split_once(':') {
        Some((name, value))
            if !value.trim().is_empty() && name.trim().chars().all(|c| c.is_alphabetic() || c == '_') =>
        {
            value.trim()
        }
        _ => text,
    }
}

/// Without one pair of brackets or quotes around the whole.
pub fn without_brackets(text: &str) -> &str {
    const PAIRS: [(char, char); 7] =
        [('(', ')'), ('[', ']'), ('{', '}'), ('<', '>'), ('"', '"'), ('\'', '\''), ('`', '`')];
    let inner = PAIRS.iter().find_map(|(open, close)| {
        let inner = text.strip_prefix(*open)?.strip_suffix(*close)?;
        encloses(inner, *open, *close).then(|| inner.trim())
    });
    inner.unwrap_or(text)
}

/// Whether brackets around `inner` are a pair: inside, none is closed that was not opened.
fn encloses(inner: &str, open: char, close: char) -> bool {
    let mut depth = 0usize;
    for c in inner.chars() {
        if c == close && open != close {
            match depth.checked_sub(1) {
                Some(less) => depth = less,
                None => return false,
            }
        } else if c == open {
            if open == close {
                return false;
            }
            depth += 1;
        }
    }
    depth == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_become_plain() {
        for (typed, wanted) in [
            ("\u{feff}\u{2212}2·10⁻³", "-2*10^-3"),
            ("\u{ff12}\u{ff0e}\u{ff15}", "2.5"),
            ("mω²r", "m omega^2r"),
            ("2πr", "2 pi r"),
            ("ω₀", "omega_0"),
            ("Iₜω", "I_t omega"),
            ("2π√3", "2 pi sqrt(3)"),
            ("√2", "sqrt(2)"),
            ("√(2g)", "sqrt(2g)"),
            ("½mv²", "(1/2)mv^2"),
            ("2½", "2+(1/2)"),
            ("5 µm", "5 um"),
            ("𝑚𝑔", "mg"),
            ("30º", "30°"),
            ("3 î − 2 k̂", "3 i - 2 k"),
            ("[1]ᵀ", "[1]^T"),
            ("np.sqrt(2)*math.cos(0)", "sqrt(2)*cos(0)"),
            ("3 N.m", "3 N.m"),
        ] {
            assert_eq!(plain(typed), wanted, "{typed}");
        }
    }

    #[test]
    fn latex_becomes_plain() {
        for (typed, wanted) in [
            (r"$29.4\,\mathrm{N}$", "29.4 N"),
            (r"\frac{1}{2} m v^{2}", "((1)/(2)) m v^(2)"),
            (r"\sqrt{2 g}", "sqrt(2 g)"),
            (r"2\cdot 10^{-3}", "2* 10^(-3)"),
            (r"m g \cos\alpha", "m g cos alpha"),
            (r"I_{t}", "I_t"),
            (r"\left(a+b\right)", "(a+b)"),
            (r"\begin{pmatrix} 1 \\ 2 \\ 3 \end{pmatrix}", "[1 ; 2 ; 3]"),
            (r"30^\circ", "30°"),
            (r"\SI{29.4}{\newton}", "29.4(newton)"),
            (r"\tfrac{1}{2}3", "((1)/(2))*3"),
            (r"\langle 1, 2\rangle", "< 1, 2>"),
        ] {
            let got = plain(typed).split_whitespace().collect::<Vec<_>>().join(" ");
            let got = got.replace("( ", "(").replace("[ ", "[").replace(" ]", "]").replace(" )", ")");
            assert_eq!(got, wanted, "{typed}");
        }
    }

    #[test]
    fn ornaments_are_taken_off() {
        for typed in [
            "29.4",
            "= 29.4",
            "(29.4)",
            "[29.4]",
            "F = 29.4",
            "F_x=29.4",
            "F: 29.4",
            "approx. 29.4",
            "~29.4",
            "29.4 ± 0.1",
            "((29.4))",
            "F = 3*9.8 = 29.4",
            "29.4 = F",
            "29.4;",
            "\"29.4\"",
            "about 29.4",
        ] {
            assert_eq!(undecorated(typed), "29.4", "{typed}");
        }
        assert_eq!(undecorated("(1)/(2)"), "(1)/(2)");
        assert_eq!(undecorated("T = 2*pi"), "2*pi");
    }
}
