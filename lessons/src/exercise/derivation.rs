//! Where the numbers of a reference come from, kept to recognise the mistakes that people make on the way to them.

use triad_engine::scene::expression::{Expression, Node};

use super::context::BuildContext;
use super::parameters::Parameters;
use crate::answers::TypedValue;
use crate::files::{QuestionFile, ReferenceFile};
use crate::scenario::worlds::Worlds;

/// Most numbers of a question that are tried in the place of others.
const MOST_NUMBERS: usize = 20;

/// The expressions behind a reference, and the scene that shows it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Derivation {
    /// The expression of each entry, row by row; none where the engine measured it.
    pub(crate) entries: Vec<Node>,
    /// The values of their symbols.
    pub(crate) symbols: Vec<f64>,
    /// Numbers that stand in it, in the author's misconceptions and in the question's text, each once.
    pub(crate) given: Vec<f64>,
    /// The expressions of the author's misconceptions with their places in the list, where they are single numbers.
    pub(crate) wrong: Vec<(usize, Node)>,
    /// What wrong models show.
    pub(crate) worlds: Worlds,
}

impl Derivation {
    /// That of a reference that could be read.
    pub(super) fn new(question: &QuestionFile, reference: &ReferenceFile, context: &BuildContext) -> Self {
        let mut entries = Vec::new();
        let read =
            reference.value.as_ref().is_some_and(|value| collect(value, context.parameters, &mut entries));
        if !read {
            entries.clear();
        }
        let worlds = match (&reference.measured, context.scene_of(None)) {
            (Some(measured), Ok(scene)) => Worlds::new(scene, measured.clone()),
            _ => Worlds::default(),
        };
        let symbols: Vec<f64> = context.parameters.iter().map(|(_, value)| value).collect();
        let mut wrong = Vec::new();
        for value in question.misconceptions.iter().filter_map(|m| m.value.as_ref()) {
            collect(value, context.parameters, &mut wrong);
        }
        let mut given = Vec::new();
        for node in entries.iter().chain(&wrong) {
            numbers(node, &symbols, &mut given);
        }
        for value in in_text(&context.parameters.fill(&question.prompt)) {
            numbers(&Node::Number(value), &[], &mut given);
        }
        given.truncate(MOST_NUMBERS);
        let wrong = single(question, context.parameters);
        Self { entries, symbols, given, wrong, worlds }
    }
}

/// The misconceptions that are one expression.
fn single(question: &QuestionFile, parameters: &Parameters) -> Vec<(usize, Node)> {
    let values = question.misconceptions.iter().map(|m| m.value.as_ref()).enumerate();
    let read = |(at, value): (usize, Option<&TypedValue>)| {
        let mut nodes = Vec::new();
        let read = collect(value?, parameters, &mut nodes);
        if read && nodes.len() == 1 { nodes.pop().map(|node| (at, node)) } else { None }
    };
    values.filter_map(read).collect()
}

/// The numbers of a text, such as 0.3 in `$r=0.3$ m`.
fn in_text(text: &str) -> Vec<f64> {
    let pieces = text.split(|c: char| !(c.is_ascii_digit() || c == '.'));
    pieces.filter_map(|piece| piece.trim_end_matches('.').parse().ok()).collect()
}

/// Adds the expressions of a value; false if one cannot be read.
fn collect(value: &TypedValue, parameters: &Parameters, entries: &mut Vec<Node>) -> bool {
    match value {
        TypedValue::Number(x) => entries.push(Node::Number(*x)),
        TypedValue::Text(text) => {
            let names: Vec<&str> = parameters.iter().map(|(name, _)| name).collect();
            let Ok(expression) = Expression::parse(text, &names) else { return false };
            entries.push(expression.into_root());
        }
        TypedValue::List(list) => return list.iter().all(|one| collect(one, parameters, entries)),
    }
    true
}

/// The numbers of an expression and its symbols' values, without zeros.
pub(crate) fn numbers(node: &Node, symbols: &[f64], found: &mut Vec<f64>) {
    match node {
        Node::Number(_) | Node::Symbol(_) => {
            let value = node.eval(symbols);
            if value != 0.0 && !found.contains(&value) {
                found.push(value);
            }
        }
        Node::Negative(a) | Node::Call(_, a) => numbers(a, symbols, found),
        Node::Binary(_, a, b) => {
            numbers(a, symbols, found);
            numbers(b, symbols, found);
        }
    }
}
