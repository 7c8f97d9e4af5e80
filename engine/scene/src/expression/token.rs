//! Numbers, names and signs of a formula in plain notation.

use super::{Cursor, ExpressionError};

/// A piece of a formula.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Token {
    Number(f64),
    Name(String),
    Sign(char),
}

/// A token, where it begins and where it ends, counted in characters.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Placed {
    pub token: Token,
    pub start: usize,
    pub end: usize,
}

/// Tokens, the first strange character, and whether a number has decimals.
type Tokens = (Vec<Placed>, Option<(usize, char)>, bool);

/// The tokens up to the first character that belongs into no formula, and that character's place if there is one.
///
/// Errors at a number such as `1.2.3`.
pub(super) fn tokens(plain: &str) -> Result<Tokens, ExpressionError> {
    // A comma separates the arguments of a function of two, else it is a decimal sign.
    let lower = plain.to_lowercase();
    let separates = ["pow", "atan2", "arctan2"].iter().any(|name| lower.contains(name));
    let mut cursor = Cursor::new(plain);
    let (mut found, mut decimals) = (Vec::new(), false);
    while let Some(c) = cursor.peek() {
        let start = cursor.position();
        let token = if c.is_whitespace() {
            cursor.take_next();
            continue;
        } else if c.is_ascii_digit() || c == '.' {
            let (value, with_decimals) = number(&mut cursor, separates)?;
            decimals |= with_decimals;
            Token::Number(value)
        } else if c.is_alphabetic() {
            Token::Name(cursor.take_while(usize::MAX, |c| c.is_alphanumeric() || c == '_'))
        } else {
            let sign = match c {
                '[' | '{' => '(',
                ']' | '}' => ')',
                '+' | '-' | '*' | '/' | '^' | '(' | ')' | '|' | '°' => c,
                ',' if separates => c,
                _ => return Ok((found, Some((start, c)), decimals)),
            };
            cursor.take_next();
            let power = c == '*' && cursor.take(&['*']).is_some();
            Token::Sign(if power { '^' } else { sign })
        };
        found.push(Placed { token, start, end: cursor.position() });
    }
    Ok((found, None, decimals))
}

/// A number, with a comma or a point, and whether it has decimals.
fn number(cursor: &mut Cursor, separates: bool) -> Result<(f64, bool), ExpressionError> {
    let position = cursor.position() + 1;
    let mut text = cursor.take_number();
    let comma = cursor.peek() == Some(',') && cursor.peek_at(1).is_some_and(|c| c.is_ascii_digit());
    if comma && !separates && !text.contains('.') {
        cursor.take_next();
        let decimals = cursor.take_number();
        if decimals.len() == 3 && (1..=3).contains(&text.len()) && !text.starts_with('0') {
            let problem = format!(
                "the comma in \u{201c}{text},{decimals}\u{201d} can be read in two ways; write the decimal sign as a point"
            );
            return Err(ExpressionError::Syntax { position, problem });
        }
        text = format!("{text}.{decimals}");
    }
    let value = text.parse().map_err(|_| ExpressionError::Syntax {
        position,
        problem: format!("\u{201c}{text}\u{201d} is not a number"),
    })?;
    Ok((value, text.contains('.')))
}
