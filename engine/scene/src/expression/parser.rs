//! From tokens to a tree.

use super::ExpressionError;
use super::named::{Named, angle_of};
use super::node::{Function, Node};
use super::token::{Placed, Token, tokens};

/// Deepest nesting.
const MAX_DEPTH: usize = 40;
/// Longest name that is taken apart into known ones, in characters.
const MAX_COMPOUND: usize = 16;

/// Reads a formula from left to right.
pub(super) struct Parser<'a> {
    text: &'a str,
    tokens: Vec<Placed>,
    at: usize,
    symbols: &'a [&'a str],
    /// A character that belongs into no formula ends the tokens.
    strange: Option<(usize, char)>,
    decimals: bool,
    /// Whether a name that is not known ends the formula, as a unit behind a value does.
    leading: bool,
    /// Open absolute values: there a bar closes.
    bars: usize,
}

type Read = Result<Node, ExpressionError>;

impl<'a> Parser<'a> {
    /// Errors at a number that is none.
    pub(super) fn new(text: &'a str, symbols: &'a [&'a str]) -> Result<Self, ExpressionError> {
        let (tokens, strange, decimals) = tokens(text)?;
        Ok(Self { text, tokens, at: 0, symbols, strange, decimals, leading: false, bars: 0 })
    }

    /// The tree of the whole text, and whether one of its numbers has decimals.
    pub(super) fn whole(mut self) -> Result<(Node, bool), ExpressionError> {
        if self.tokens.is_empty() && self.strange.is_none() {
            return Err(ExpressionError::Empty);
        }
        let root = self.sum(0)?;
        match (self.peek(), self.strange) {
            (None, None) => Ok((root, self.decimals)),
            (None, Some((_, c))) => {
                Err(self.error(&format!("\u{201c}{c}\u{201d} does not belong in a formula")))
            }
            _ => Err(self.error("this does not belong here; is a bracket missing?")),
        }
    }

    /// The tree of the arithmetic at the beginning, and the text behind it.
    pub(super) fn leading(mut self) -> Option<(Node, String)> {
        self.leading = true;
        let root = self.sum(0).ok()?;
        let end = self.at.checked_sub(1).and_then(|last| self.tokens.get(last)).map_or(0, |t| t.end);
        Some((root, self.text.chars().skip(end).collect()))
    }

    fn peek(&self) -> Option<&Token> {
        self.tokens.get(self.at).map(|placed| &placed.token)
    }

    fn take(&mut self, sign: char) -> bool {
        let found = self.peek() == Some(&Token::Sign(sign));
        self.at += usize::from(found);
        found
    }

    fn error(&self, problem: &str) -> ExpressionError {
        let end = self.strange.map_or_else(|| self.text.chars().count(), |(place, _)| place);
        let position = self.tokens.get(self.at).map_or(end, |placed| placed.start) + 1;
        ExpressionError::Syntax { position, problem: problem.to_owned() }
    }

    /// Reads on, or, in front of a unit, goes back to where nothing of this was taken.
    fn attempt(
        &mut self,
        start: usize,
        read: impl FnOnce(&mut Self) -> Read,
    ) -> Result<Option<Node>, ExpressionError> {
        match read(self) {
            Ok(node) => Ok(Some(node)),
            Err(_) if self.leading => {
                self.at = start;
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }

    fn sum(&mut self, depth: usize) -> Read {
        if depth > MAX_DEPTH {
            return Err(ExpressionError::TooLarge);
        }
        let mut left = self.product(depth)?;
        loop {
            let operator = match self.peek() {
                Some(Token::Sign(c @ ('+' | '-'))) => *c,
                _ => return Ok(left),
            };
            let start = self.at;
            self.at += 1;
            match self.attempt(start, |p| p.product(depth))? {
                Some(right) => left = Node::binary(operator, left, right),
                None => return Ok(left),
            }
        }
    }

    fn product(&mut self, depth: usize) -> Read {
        let mut left = self.sign(depth)?;
        loop {
            let start = self.at;
            let operator = match self.peek() {
                Some(Token::Sign(c @ ('*' | '/'))) => {
                    let c = *c;
                    self.at += 1;
                    c
                }
                Some(Token::Name(_) | Token::Sign('(')) => '*',
                Some(Token::Sign('|')) if self.bars == 0 => '*',
                Some(Token::Number(_)) if !self.leading => {
                    return Err(self.error("an operator is missing before this number"));
                }
                _ => return Ok(left),
            };
            match self.attempt(start, |p| p.sign(depth))? {
                Some(right) => left = Node::binary(operator, left, right),
                None => return Ok(left),
            }
        }
    }

    fn sign(&mut self, depth: usize) -> Read {
        if depth > MAX_DEPTH {
            return Err(ExpressionError::TooLarge);
        }
        if self.take('-') {
            return Ok(Node::Negative(Box::new(self.sign(depth + 1)?)));
        }
        if self.take('+') {
            return self.sign(depth + 1);
        }
        self.power(depth)
    }

    fn power(&mut self, depth: usize) -> Read {
        let mut base = self.atom(depth)?;
        // A degree sign is a factor; in front of a unit's place it is the unit.
        if (depth > 0 || !self.leading) && self.take('°') {
            base = Node::binary('*', base, Node::Number(std::f64::consts::PI / 180.0));
        }
        self.raised(base, depth)
    }

    fn raised(&mut self, base: Node, depth: usize) -> Read {
        if !self.take('^') {
            return Ok(base);
        }
        Ok(Node::binary('^', base, self.sign(depth + 1)?))
    }

    fn atom(&mut self, depth: usize) -> Read {
        match self.peek().cloned() {
            Some(Token::Number(x)) => {
                self.at += 1;
                Ok(Node::Number(x))
            }
            Some(Token::Sign('(')) => {
                self.at += 1;
                self.bracket(depth)
            }
            Some(Token::Sign('|')) => {
                self.at += 1;
                self.bars += 1;
                let inner = self.sum(depth + 1);
                self.bars -= 1;
                let inner = inner?;
                if !self.take('|') {
                    return Err(self.error("a bar of an absolute value is not closed"));
                }
                Ok(Node::Call(Function::Abs, Box::new(inner)))
            }
            Some(Token::Name(name)) => self.name(&name, depth),
            _ => Err(self.error("a number, a symbol or a bracket is missing")),
        }
    }

    fn name(&mut self, name: &str, depth: usize) -> Read {
        if let Some(node) = self.known(name, depth) {
            self.at += 1;
            return Ok(node);
        }
        let lower = name.to_lowercase();
        if matches!(lower.as_str(), "pow" | "atan2" | "arctan2") {
            self.at += 1;
            let (first, second) = self.two_arguments(depth)?;
            return Ok(if lower == "pow" {
                Node::binary('^', first, second)
            } else {
                angle_of(first, second)
            });
        }
        if let Some(function) = Named::of(name) {
            self.at += 1;
            return self.call(function, depth);
        }
        if let Some(pieces) = self.pieces(name, depth) {
            return self.chain(pieces, depth);
        }
        let known = if self.symbols.is_empty() { "none".to_owned() } else { self.symbols.join(", ") };
        Err(ExpressionError::UnknownSymbol { name: name.to_owned(), known })
    }

    /// A symbol of the question or a constant: as written, else without regard to `_`, else to capital letters.
    fn known(&self, name: &str, depth: usize) -> Option<Node> {
        let same = |fold: fn(&str) -> String| {
            let mut fitting = self.symbols.iter().enumerate().filter(|(_, s)| fold(s) == fold(name));
            let first = fitting.next().map(|(k, _)| Node::Symbol(k));
            first.filter(|_| fitting.next().is_none())
        };
        let constant = || {
            Some(Node::Number(match name {
                "pi" | "Pi" | "PI" => std::f64::consts::PI,
                "e" => std::f64::consts::E,
                "deg" | "degree" | "degrees" if depth > 0 => std::f64::consts::PI / 180.0,
                _ => return None,
            }))
        };
        same(str::to_owned)
            .or_else(constant)
            .or_else(|| same(|s| s.replace('_', "")))
            .or_else(|| Named::of(name).is_none().then(|| same(|s| s.replace('_', "").to_lowercase()))?)
    }

    /// The known names that a name is made of, longest first: `mgl` is m, g, l; a function may be the last.
    fn pieces(&self, name: &str, depth: usize) -> Option<Vec<Piece>> {
        if name.chars().count() > MAX_COMPOUND || self.leading {
            return None;
        }
        if name.is_empty() {
            return Some(Vec::new());
        }
        if let Some(function) = Named::of(name) {
            return Some(vec![Piece::Function(function)]);
        }
        let mut ends = name.char_indices().map(|(k, c)| k + c.len_utf8()).rev();
        ends.find_map(|end| {
            let node = self.known(&name[..end], depth)?;
            let mut rest = self.pieces(name[end..].trim_start_matches('_'), depth)?;
            rest.insert(0, Piece::Value(node));
            Some(rest)
        })
    }

    /// A product of names that stood together; a power or a bracket behind them belongs to the last.
    fn chain(&mut self, pieces: Vec<Piece>, depth: usize) -> Read {
        self.at += 1;
        let count = pieces.len();
        let mut product: Option<Node> = None;
        for (k, piece) in pieces.into_iter().enumerate() {
            let factor = match piece {
                Piece::Function(function) => self.call(function, depth)?,
                Piece::Value(node) if k + 1 == count => self.raised(node, depth)?,
                Piece::Value(node) => node,
            };
            product = Some(match product {
                Some(product) => Node::binary('*', product, factor),
                None => factor,
            });
        }
        product.ok_or(ExpressionError::Empty)
    }

    /// `f(x)`, `f x`, `f^2(x)`.
    fn call(&mut self, function: Named, depth: usize) -> Read {
        if depth > MAX_DEPTH {
            return Err(ExpressionError::TooLarge);
        }
        let power = if self.take('^') { Some(self.exponent_of_function(depth)?) } else { None };
        let argument = if self.take('(') { self.bracket(depth)? } else { self.bare_argument(depth)? };
        Ok(match (power, function.inverse()) {
            (Some(Node::Negative(one)), Some(inverse)) if *one == Node::Number(1.0) => {
                inverse.applied(argument)
            }
            (Some(power), _) => Node::binary('^', function.applied(argument), power),
            (None, _) => function.applied(argument),
        })
    }

    /// The 2 of `sin^2 x`: a number, perhaps with a sign, or a bracket.
    fn exponent_of_function(&mut self, depth: usize) -> Read {
        if self.take('-') {
            return Ok(Node::Negative(Box::new(self.exponent_of_function(depth + 1)?)));
        }
        match self.peek() {
            Some(Token::Number(_) | Token::Sign('(')) => self.atom(depth + 1),
            _ => Err(self.error("write the power of a function as a number, sin^2(x)")),
        }
    }

    /// The argument of a function without brackets: factors without a sign between them, up to the next function.
    fn bare_argument(&mut self, depth: usize) -> Read {
        if !matches!(self.peek(), Some(Token::Number(_) | Token::Name(_) | Token::Sign('|'))) {
            return Err(self.error("the argument of a function is missing; write it in brackets"));
        }
        let mut argument = self.power(depth + 1)?;
        while let Some(Token::Name(name)) = self.peek() {
            if Named::of(name).is_some() || self.known(name, depth).is_none() {
                break;
            }
            argument = Node::binary('*', argument, self.power(depth + 1)?);
        }
        Ok(argument)
    }

    fn two_arguments(&mut self, depth: usize) -> Result<(Node, Node), ExpressionError> {
        if !self.take('(') {
            return Err(self.error("write the two arguments in brackets, separated by a comma"));
        }
        let first = self.sum(depth + 1)?;
        if !self.take(',') {
            return Err(self.error("a comma and a second argument are missing"));
        }
        let second = self.sum(depth + 1)?;
        if self.take(')') { Ok((first, second)) } else { Err(self.error("a bracket is not closed")) }
    }

    fn bracket(&mut self, depth: usize) -> Read {
        let bars = std::mem::take(&mut self.bars);
        let inner = self.sum(depth + 1);
        self.bars = bars;
        let inner = inner?;
        if self.take(')') { Ok(inner) } else { Err(self.error("a bracket is not closed")) }
    }
}

/// One of the names that a name is made of.
enum Piece {
    Value(Node),
    Function(Named),
}
