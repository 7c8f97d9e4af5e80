//! Small pieces of text that several modules write: shortened quotations, sentences, plain numbers.

/// Characters of a quotation that still fit into a sentence.
const MAX_QUOTED: usize = 24;

/// A student's text, cut to a length that fits into a sentence.
pub(crate) fn shorten(text: &str) -> String {
    let mut out: String = text.trim().chars().take(MAX_QUOTED).collect();
    if text.trim().chars().count() > MAX_QUOTED {
        out.push('…');
    }
    out
}

/// A message as a sentence of its own: a capital first letter and a full stop.
pub(crate) fn sentence(message: &str) -> String {
    let mut chars = message.chars();
    let first = chars.next().map(|c| c.to_uppercase().to_string()).unwrap_or_default();
    format!("{first}{}.", chars.as_str())
}

/// A number without trailing zeros and without the noise of binary fractions: seven significant digits.
pub(crate) fn plain(value: f64) -> String {
    let rounded: f64 = format!("{value:.6e}").parse().unwrap_or(value);
    if rounded != 0.0 && !(1e-4..1e6).contains(&rounded.abs()) {
        return format!("{rounded:e}");
    }
    rounded.to_string()
}

/// Letters of writing without spaces that count as a word: Chinese has about so many, others more.
const LETTERS_OF_A_WORD: usize = 2;

/// Words of a text: what has a letter between spaces; where words are written without spaces between them, so many letters.
pub(crate) fn words(text: &str) -> usize {
    let apart = text.split(|c: char| c.is_whitespace() || is_written_without_spaces(c));
    let letters = text.chars().filter(|c| is_written_without_spaces(*c)).count();
    apart.filter(|word| word.chars().any(char::is_alphabetic)).count() + letters.div_ceil(LETTERS_OF_A_WORD)
}

/// Whether a character is a letter of Thai, Lao, Tibetan, Burmese, Khmer, Japanese or Chinese.
fn is_written_without_spaces(c: char) -> bool {
    let ranges = matches!(c, '\u{e00}'..='\u{109f}' | '\u{1780}'..='\u{17ff}' | '\u{3040}'..='\u{30ff}' | '\u{3400}'..='\u{4dbf}'
        | '\u{4e00}'..='\u{9fff}' | '\u{f900}'..='\u{faff}' | '\u{20000}'..='\u{3ffff}');
    ranges && c.is_alphabetic()
}
