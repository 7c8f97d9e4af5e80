//! A formula written out: every product has its sign, every function its brackets.

use super::node::Node;

/// Strength with which an operator holds its sides.
fn strength(node: &Node) -> u8 {
    match node {
        Node::Binary('+' | '-', ..) => 1,
        Node::Negative(_) | Node::Binary('*' | '/', ..) => 3,
        Node::Binary('^', ..) => 4,
        _ => 5,
    }
}

/// The formula as text.
pub(super) fn of(node: &Node, symbols: &[&str]) -> String {
    let side = |side: &Node, least: u8| {
        let text = of(side, symbols);
        if strength(side) < least { format!("({text})") } else { text }
    };
    // Behind a sign another one needs brackets.
    let behind_sign = |node: &Node| match node {
        Node::Negative(_) => format!("({})", of(node, symbols)),
        node => side(node, 2),
    };
    match node {
        Node::Number(x) if *x == std::f64::consts::PI => "π".to_owned(),
        Node::Number(x) if *x == std::f64::consts::E => "e".to_owned(),
        Node::Number(x) => x.to_string(),
        Node::Symbol(index) => symbols.get(*index).map_or_else(String::new, |s| (*s).to_owned()),
        Node::Negative(a) => format!("\u{2212}{}", side(a, 3)),
        Node::Call(function, a) => format!("{function}({})", of(a, symbols)),
        Node::Binary('+', a, b) => format!("{} + {}", side(a, 1), behind_sign(b)),
        Node::Binary('-', a, b) => format!("{} \u{2212} {}", side(a, 1), behind_sign(b)),
        Node::Binary('*', a, b) => {
            let product = matches!(**b, Node::Binary('*', ..));
            format!("{}·{}", side(a, 3), side(b, if product { 3 } else { 4 }))
        }
        Node::Binary('/', a, b) => format!("{}/{}", side(a, 3), side(b, 4)),
        Node::Binary(_, a, b) => format!("{}^{}", side(a, 5), side(b, 4)),
    }
}
