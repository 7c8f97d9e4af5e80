//! Numbers that are drawn for a student, and texts and expressions that use them.

use std::collections::BTreeMap;

use crate::files::ParameterFile;
use crate::random::SeededRandom;
use crate::text::plain;
use triad_engine::scene::expression::{Expression, ExpressionError};

/// Named numbers of a lesson.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Parameters {
    names: Vec<String>,
    values: Vec<f64>,
}

impl Parameters {
    /// The default values.
    pub fn defaults(files: &BTreeMap<String, ParameterFile>) -> Self {
        Self { names: files.keys().cloned().collect(), values: files.values().map(|p| p.default).collect() }
    }

    /// True if the lesson has none.
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// Names and values.
    pub fn iter(&self) -> impl Iterator<Item = (&str, f64)> {
        self.names.iter().map(String::as_str).zip(self.values.iter().copied())
    }

    /// The value of an expression in the parameters.
    ///
    /// Errors if it cannot be read or has no finite value.
    pub fn eval(&self, text: &str) -> Result<f64, ExpressionError> {
        let names: Vec<&str> = self.names.iter().map(String::as_str).collect();
        Ok(Expression::parse(text, &names)?.eval(&self.values))
    }

    /// A text with `{{name}}` replaced by the value.
    pub fn fill(&self, text: &str) -> String {
        self.iter().fold(text.to_owned(), |text, (name, value)| {
            text.replace(&format!("{{{{{name}}}}}"), &plain(value))
        })
    }

    /// The names in double braces of a text that stand for no parameter.
    pub(crate) fn unknown(&self, text: &str) -> Vec<String> {
        let rest = text.split("{{").skip(1).filter_map(|part| Some(part.split_once("}}")?.0.trim()));
        let is_name = |name: &&str| {
            name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
                && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        };
        rest.filter(is_name)
            .filter(|name| !self.names.iter().any(|own| own == name))
            .map(str::to_owned)
            .collect()
    }

    /// One more named number.
    pub(crate) fn add(&mut self, name: &str, value: f64) {
        self.names.push(name.to_owned());
        self.values.push(value);
    }

    /// Values drawn from the ranges, in the order of the names.
    pub(crate) fn draw(files: &BTreeMap<String, ParameterFile>, random: &mut SeededRandom) -> Self {
        let values = files.values().map(|p| {
            let steps = ((p.to - p.from) / p.step + 1e-9).floor() + 1.0;
            let value = p.from + p.step * (random.unit() * steps).floor();
            // Without the noise of binary fractions: the student sees and uses the same number.
            plain(value).parse().unwrap_or(value)
        });
        Self { values: values.collect(), names: files.keys().cloned().collect() }
    }
}
