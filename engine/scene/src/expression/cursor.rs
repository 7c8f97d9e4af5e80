//! Reads typed text from left to right.

/// Characters of a text and a place among them.
pub struct Cursor {
    chars: Vec<char>,
    at: usize,
}

impl Cursor {
    /// A cursor at the first character.
    pub fn new(text: &str) -> Self {
        Self { chars: text.chars().collect(), at: 0 }
    }

    /// Place of the next character, from 0.
    pub fn position(&self) -> usize {
        self.at
    }

    /// The next character, left where it is.
    pub fn peek(&self) -> Option<char> {
        self.peek_at(0)
    }

    /// The character `ahead` places after the next one.
    pub fn peek_at(&self, ahead: usize) -> Option<char> {
        self.chars.get(self.at + ahead).copied()
    }

    /// Takes the next character.
    pub fn take_next(&mut self) -> Option<char> {
        let c = self.peek()?;
        self.at += 1;
        Some(c)
    }

    /// Takes the next character if it is one of these.
    pub fn take(&mut self, wanted: &[char]) -> Option<char> {
        let c = self.peek().filter(|c| wanted.contains(c))?;
        self.at += 1;
        Some(c)
    }

    /// Takes all characters up to the first one that does not fit, at most `most`.
    pub fn take_while(&mut self, most: usize, fits: impl Fn(char) -> bool) -> String {
        let start = self.at;
        while self.at - start < most && self.peek().is_some_and(&fits) {
            self.at += 1;
        }
        self.chars[start..self.at].iter().collect()
    }

    /// Takes a decimal number with a point and perhaps an exponent (`1.5`, `.5`, `2e-3`), unread and perhaps empty.
    /// An exponent is taken only if digits follow: `2e` is 2 times e.
    pub fn take_number(&mut self) -> String {
        let mut text = self.take_while(usize::MAX, |c| c.is_ascii_digit() || c == '.');
        let signed = usize::from(matches!(self.peek_at(1), Some('-' | '+')));
        let exponent = matches!(self.peek(), Some('e' | 'E'))
            && self.peek_at(1 + signed).is_some_and(|c| c.is_ascii_digit());
        if exponent {
            for _ in 0..=signed {
                text.extend(self.take_next());
            }
            text += &self.take_while(usize::MAX, |c| c.is_ascii_digit());
        }
        text
    }

    /// What has not been taken yet.
    pub fn rest(&self) -> String {
        self.chars[self.at..].iter().collect()
    }
}
