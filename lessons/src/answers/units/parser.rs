//! Reads a unit in plain notation: symbols and words, powers, products and quotients.

use triad_engine::scene::expression::Cursor;

use super::meaning::{Meaning, products};
use super::{UnitError, table};
use crate::answers::dimension::MAX_EXPONENT;

/// Digits of an exponent that are read.
const MAX_EXPONENT_DIGITS: usize = 3;
/// Deepest nesting of brackets.
const MAX_DEPTH: usize = 8;

/// What a text can mean, the likeliest first, and whether a product behind a slash makes it unclear which.
pub(super) struct Readings {
    pub meanings: Vec<Meaning>,
    pub ambiguous: bool,
}

#[derive(Debug, Clone, PartialEq)]
enum Token {
    Symbol(String),
    One,
    Power(i32),
    /// `square` in front of what it squares.
    PowerOfNext(i32),
    Times,
    Slash,
    Open,
    Close,
}

/// The meanings of a text; of an empty one the pure number.
///
/// Errors if a symbol is unknown or the text is no unit.
pub(super) fn readings(text: &str) -> Result<Readings, UnitError> {
    let tokens = tokenize(text)?;
    let mut parser = Parser { text, tokens, at: 0, ambiguous: false };
    if parser.tokens.is_empty() {
        return Ok(Readings { meanings: vec![Meaning::ONE], ambiguous: false });
    }
    let meanings = parser.product(0)?;
    if parser.at < parser.tokens.len() {
        return Err(parser.syntax("a bracket is closed that was never opened"));
    }
    if meanings.is_empty() {
        return Err(parser.syntax("its exponents are out of range"));
    }
    Ok(Readings { meanings, ambiguous: parser.ambiguous })
}

fn tokenize(text: &str) -> Result<Vec<Token>, UnitError> {
    let syntax = |problem| UnitError::Syntax { text: text.to_owned(), problem };
    let power = |cursor: &mut Cursor| {
        exponent(cursor).map(Token::Power).ok_or_else(|| syntax("an exponent is a whole number"))
    };
    let in_symbol = |c: char| c.is_alphabetic() || c == '°' || c == '%';
    let mut cursor = Cursor::new(text);
    let mut tokens = Vec::new();
    while let Some(c) = cursor.peek() {
        if in_symbol(c) {
            tokens.push(word(cursor.take_while(usize::MAX, in_symbol), &mut cursor, in_symbol));
            let digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
            // kg m2, s-1: a number glued to a symbol is its exponent.
            if digit(cursor.peek()) || cursor.peek() == Some('-') && digit(cursor.peek_at(1)) {
                tokens.push(power(&mut cursor)?);
            }
            continue;
        }
        cursor.take_next();
        match c {
            ' ' => {}
            '*' if cursor.take(&['*']).is_some() => tokens.push(power(&mut cursor)?),
            '^' => tokens.push(power(&mut cursor)?),
            // N·m, N-m, N.m
            '*' | '-' | '.' => tokens.push(Token::Times),
            '/' => tokens.push(Token::Slash),
            '(' | '[' | '{' => tokens.push(Token::Open),
            ')' | ']' | '}' => tokens.push(Token::Close),
            '1' if !cursor.peek().is_some_and(|c| c.is_ascii_digit()) => tokens.push(Token::One),
            c if c.is_ascii_digit() => return Err(syntax("a number belongs into the field of the value")),
            _ => return Err(syntax("it has a sign that does not belong there")),
        }
    }
    Ok(tokens)
}

/// A symbol, or a word that is a sign: `per`, `squared`, `square`. The letter μ stands for micro in front of a symbol.
fn word(symbol: String, cursor: &mut Cursor, in_symbol: impl Fn(char) -> bool) -> Token {
    match symbol.to_lowercase().as_str() {
        "per" => Token::Slash,
        "squared" => Token::Power(2),
        "cubed" => Token::Power(3),
        "square" | "sq" => Token::PowerOfNext(2),
        "cubic" => Token::PowerOfNext(3),
        "mu" => {
            cursor.take_while(1, |c| c == ' ');
            Token::Symbol(format!("u{}", cursor.take_while(usize::MAX, in_symbol)))
        }
        _ => Token::Symbol(symbol),
    }
}

/// A whole number after `^`, perhaps in brackets.
fn exponent(cursor: &mut Cursor) -> Option<i32> {
    let open = cursor.take(&['(', '{']).is_some();
    let mut text: String = cursor.take(&['-', '+']).into_iter().filter(|c| *c == '-').collect();
    text += &cursor.take_while(MAX_EXPONENT_DIGITS, |c| c.is_ascii_digit());
    if open {
        cursor.take(&[')', '}'])?;
    }
    text.parse().ok().filter(|e: &i32| e.abs() <= MAX_EXPONENT)
}

struct Parser<'a> {
    text: &'a str,
    tokens: Vec<Token>,
    at: usize,
    ambiguous: bool,
}

impl Parser<'_> {
    fn syntax(&self, problem: &'static str) -> UnitError {
        UnitError::Syntax { text: self.text.to_owned(), problem }
    }

    fn take(&mut self, token: &Token) -> bool {
        let found = self.tokens.get(self.at) == Some(token);
        self.at += usize::from(found);
        found
    }

    /// Factors and divisors. What stands behind a divisor without a slash of its own may be above or below: both are kept.
    fn product(&mut self, depth: usize) -> Result<Vec<Meaning>, UnitError> {
        if depth > MAX_DEPTH {
            return Err(self.syntax("brackets are nested too deeply"));
        }
        let starts_divided = self.take(&Token::Slash);
        let first = self.factor(depth)?;
        let mut above = if starts_divided { products(&[Meaning::ONE], &first, -1) } else { first };
        let (mut below, mut divided) = (above.clone(), starts_divided);
        while let Some(token) = self.tokens.get(self.at) {
            let slash = match token {
                Token::Close => break,
                Token::Slash => true,
                _ => false,
            };
            self.at += usize::from(slash || *token == Token::Times);
            let factor = self.factor(depth)?;
            let behind_slash = divided && !slash;
            self.ambiguous |= behind_slash;
            divided |= slash;
            above = products(&above, &factor, if slash { -1 } else { 1 });
            below = products(&below, &factor, if slash || behind_slash { -1 } else { 1 });
        }
        below.retain(|meaning| !above.contains(meaning));
        above.extend(below);
        Ok(above)
    }

    fn factor(&mut self, depth: usize) -> Result<Vec<Meaning>, UnitError> {
        if let Some(Token::PowerOfNext(power)) = self.tokens.get(self.at).cloned() {
            self.at += 1;
            let base = self.factor_of(depth, power)?;
            return Ok(base);
        }
        self.factor_of(depth, 1)
    }

    /// A symbol or a bracket to its own power, times this one.
    fn factor_of(&mut self, depth: usize, outer: i32) -> Result<Vec<Meaning>, UnitError> {
        let token = self.tokens.get(self.at).cloned();
        self.at += 1;
        let bracket = match &token {
            Some(Token::Open) => {
                let inner = self.product(depth + 1)?;
                if !self.take(&Token::Close) {
                    return Err(self.syntax("a bracket is not closed"));
                }
                Some(inner)
            }
            Some(Token::One) => Some(vec![Meaning::ONE]),
            Some(Token::Symbol(_)) => None,
            _ => return Err(self.syntax("a unit is missing next to an operator")),
        };
        let mut power = outer;
        while let Some(Token::Power(more)) = self.tokens.get(self.at) {
            power *= more;
            self.at += 1;
        }
        if power.abs() > MAX_EXPONENT {
            return Err(self.syntax("its exponents are out of range"));
        }
        match (bracket, token) {
            (Some(inner), _) => Ok(inner.into_iter().filter_map(|m| m.power(power)).collect()),
            (None, Some(Token::Symbol(symbol))) => {
                table::meanings(&symbol, power).ok_or(UnitError::Unknown { symbol })
            }
            _ => Err(self.syntax("a unit is missing next to an operator")),
        }
    }
}
