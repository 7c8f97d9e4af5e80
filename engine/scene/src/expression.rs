//! A small language of formulas: `-3*m*g*cos(phi)`, `1/2 m v^2`, `4*ellipk(1/2)/sqrt(g)`.
//!
//! Bounded in length and depth, with a closed list of functions; evaluating it runs no code. Multiplication may
//! be left out between a number, a name and a bracket. `^` binds tighter than a sign in front, and to the right.

mod cursor;

mod node;

pub use cursor::{Cursor, normalise, plain_sign};
pub use node::{Function, Node};

use thiserror::Error;

/// Longest formula that is read, in characters.
const MAX_LENGTH: usize = 400;
/// Deepest nesting.
const MAX_DEPTH: usize = 40;

/// A formula, ready to be evaluated.
#[derive(Debug, Clone, PartialEq)]
pub struct Expression {
    root: Node,
}

/// Why a formula could not be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ExpressionError {
    /// Nothing there.
    #[error("there is no formula here")]
    Empty,
    /// Too long or too deeply nested.
    #[error("the formula is too long or too deeply nested; simplify it")]
    TooLarge,
    /// A name that is not defined.
    #[error("\u{201c}{name:.24}\u{201d} is not one of the symbols here; known are {known}")]
    UnknownSymbol {
        /// The name as written.
        name: String,
        /// The names that are defined.
        known: String,
    },
    /// Something unexpected.
    #[error("at character {position}: {problem}")]
    Syntax {
        /// Place in the text, counted from 1.
        position: usize,
        /// What is wrong and what to do.
        problem: String,
    },
}

impl ExpressionError {
    /// Stable short name of the kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Empty => "formula-empty",
            Self::TooLarge => "formula-too-large",
            Self::UnknownSymbol { .. } => "formula-unknown-symbol",
            Self::Syntax { .. } => "formula-syntax",
        }
    }
}

impl Expression {
    /// Reads a formula in the named symbols; the order of `symbols` is the order of the values in [`Self::eval`].
    ///
    /// Errors name what cannot be read, and where.
    pub fn parse(text: &str, symbols: &[&str]) -> Result<Self, ExpressionError> {
        if text.chars().count() > MAX_LENGTH {
            return Err(ExpressionError::TooLarge);
        }
        let tokens = tokenize(text)?;
        if tokens.is_empty() {
            return Err(ExpressionError::Empty);
        }
        let mut parser = Parser { tokens, at: 0, symbols, end: text.chars().count() + 1 };
        let root = parser.sum(0)?;
        match parser.peek() {
            None => Ok(Self { root }),
            Some(_) => Err(parser.error("this does not belong here; is a bracket missing?")),
        }
    }

    /// The value for these values of the symbols; not finite where the formula is not defined.
    pub fn eval(&self, values: &[f64]) -> f64 {
        self.root.eval(values)
    }

    /// Whether the symbol with this index occurs.
    pub fn uses(&self, symbol: usize) -> bool {
        self.root.uses(symbol)
    }

    /// The whole of it as its outermost part.
    pub fn into_root(self) -> Node {
        self.root
    }
}

#[derive(Debug, Clone, PartialEq)]
enum Token {
    Number(f64),
    Name(String),
    Operator(char),
}

fn tokenize(text: &str) -> Result<Vec<(Token, usize)>, ExpressionError> {
    // Not trimmed: errors count characters of the text as it was typed.
    let plain: String = text.chars().map(plain_sign).collect();
    let mut cursor = Cursor::new(&plain);
    let mut tokens = Vec::new();
    while let Some(c) = cursor.peek() {
        let position = cursor.position() + 1;
        let syntax = |problem| ExpressionError::Syntax { position, problem };
        let token = if c.is_whitespace() {
            cursor.next();
            continue;
        } else if c.is_ascii_digit() || c == '.' {
            let number = cursor.take_number();
            Token::Number(
                number.parse().map_err(|_| syntax(format!("\u{201c}{number}\u{201d} is not a number")))?,
            )
        } else if c.is_alphabetic() {
            Token::Name(cursor.take_while(usize::MAX, |c| c.is_alphanumeric() || c == '_'))
        } else if "+-*/^()".contains(c) {
            cursor.next();
            let power = c == '*' && cursor.take(&['*']).is_some();
            Token::Operator(if power { '^' } else { c })
        } else {
            return Err(syntax(format!("\u{201c}{c}\u{201d} does not belong in a formula")));
        };
        tokens.push((token, position));
    }
    Ok(tokens)
}

struct Parser<'a> {
    tokens: Vec<(Token, usize)>,
    at: usize,
    symbols: &'a [&'a str],
    end: usize,
}

impl Parser<'_> {
    fn peek(&self) -> Option<&Token> {
        self.tokens.get(self.at).map(|(token, _)| token)
    }

    fn take(&mut self, operator: char) -> bool {
        let found = self.peek() == Some(&Token::Operator(operator));
        self.at += usize::from(found);
        found
    }

    fn error(&self, problem: &str) -> ExpressionError {
        let position = self.tokens.get(self.at).map_or(self.end, |(_, position)| *position);
        ExpressionError::Syntax { position, problem: problem.to_owned() }
    }

    fn sum(&mut self, depth: usize) -> Result<Node, ExpressionError> {
        if depth > MAX_DEPTH {
            return Err(ExpressionError::TooLarge);
        }
        let mut left = self.product(depth)?;
        loop {
            let operator = match self.peek() {
                Some(Token::Operator(c @ ('+' | '-'))) => *c,
                _ => return Ok(left),
            };
            self.at += 1;
            left = Node::Binary(operator, Box::new(left), Box::new(self.product(depth)?));
        }
    }

    fn product(&mut self, depth: usize) -> Result<Node, ExpressionError> {
        let mut left = self.sign(depth)?;
        loop {
            let operator = match self.peek() {
                Some(Token::Operator(c @ ('*' | '/'))) => {
                    let c = *c;
                    self.at += 1;
                    c
                }
                Some(Token::Name(_) | Token::Operator('(')) => '*',
                Some(Token::Number(_)) => return Err(self.error("an operator is missing before this number")),
                _ => return Ok(left),
            };
            left = Node::Binary(operator, Box::new(left), Box::new(self.sign(depth)?));
        }
    }

    fn sign(&mut self, depth: usize) -> Result<Node, ExpressionError> {
        if depth > MAX_DEPTH {
            return Err(ExpressionError::TooLarge);
        }
        if self.take('-') {
            return Ok(Node::Negative(Box::new(self.sign(depth + 1)?)));
        }
        if self.take('+') {
            return self.sign(depth + 1);
        }
        let base = self.atom(depth)?;
        if self.take('^') {
            return Ok(Node::Binary('^', Box::new(base), Box::new(self.sign(depth + 1)?)));
        }
        Ok(base)
    }

    fn atom(&mut self, depth: usize) -> Result<Node, ExpressionError> {
        match self.peek().cloned() {
            Some(Token::Number(x)) => {
                self.at += 1;
                Ok(Node::Number(x))
            }
            Some(Token::Operator('(')) => {
                self.at += 1;
                self.bracket(depth)
            }
            Some(Token::Name(name)) => {
                if let Some(index) = self.symbols.iter().position(|s| *s == name) {
                    self.at += 1;
                    return Ok(Node::Symbol(index));
                }
                if let Ok(function) = Function::named(&name) {
                    self.at += 1;
                    if !self.take('(') {
                        return Err(self.error(&format!("write the argument of {name} in brackets")));
                    }
                    return Ok(Node::Call(function, Box::new(self.bracket(depth)?)));
                }
                if name == "pi" {
                    self.at += 1;
                    return Ok(Node::Number(std::f64::consts::PI));
                }
                let known = if self.symbols.is_empty() { "none".to_owned() } else { self.symbols.join(", ") };
                Err(ExpressionError::UnknownSymbol { name, known })
            }
            _ => Err(self.error("a number, a symbol or a bracket is missing")),
        }
    }

    fn bracket(&mut self, depth: usize) -> Result<Node, ExpressionError> {
        let inner = self.sum(depth + 1)?;
        if self.take(')') { Ok(inner) } else { Err(self.error("a bracket is not closed")) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        Expression::parse(text, &["m", "g", "v"])
            .unwrap_or_else(|e| panic!("{text}: {e}"))
            .eval(&[2.0, 9.81, 3.0])
    }

    #[test]
    fn precedence_is_the_usual_one() {
        assert_eq!(value("1/2 m v^2"), 9.0);
        assert_eq!(value("-v^2"), -9.0);
        assert_eq!(value("2^3^2"), 512.0);
        assert_eq!(value("2^-1"), 0.5);
        assert_eq!(value("7-4-2"), 1.0);
        assert_eq!(value("8/4/2"), 1.0);
        assert_eq!(value("2(v+1)m"), 16.0);
        assert_eq!(value("3*m*g"), 3.0 * 2.0 * 9.81);
        assert!((value("cos(pi)") + 1.0).abs() < 1e-15);
        assert_eq!(value("1.5e1 + 2E-1"), 15.2);
    }

    #[test]
    fn elliptic_integral_matches_its_table() {
        // Abramowitz and Stegun, table 17.1: K(0.5).
        assert!((value("ellipk(1/2)") - 1.854_074_677_301_371_9).abs() < 1e-15);
        assert!((value("ellipk(0)") - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
        assert!(value("ellipk(1)").is_nan());
    }

    #[test]
    fn errors_say_where_and_what() {
        let fails = |t: &str| Expression::parse(t, &["m", "g"]).unwrap_err().to_string();
        assert!(fails("3*mg").contains("known are m, g"));
        assert!(fails("sin m").contains("in brackets"));
        assert!(fails("(m+g").contains("not closed"));
        assert!(fails("m+").contains("character 3"));
        assert!(fails("m 2").contains("operator is missing"));
        assert!(fails("m;g").contains("does not belong"));
        assert_eq!(Expression::parse(" ", &[]), Err(ExpressionError::Empty));
    }

    #[test]
    fn hostile_input_is_bounded() {
        assert!(Expression::parse(&"(".repeat(300), &[]).is_err());
        assert!(Expression::parse(&"-".repeat(300), &[]).is_err());
        assert!(Expression::parse(&"2^".repeat(150), &[]).is_err());
        assert!(Expression::parse(&"1+".repeat(4000), &[]).is_err());
    }
}
