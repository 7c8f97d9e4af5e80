//! Names of functions as people write them, and what stands for those that are no function of their own.

use super::node::{Function, Node};

/// What a name in a formula stands for: a function, or an expression of its argument.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Named {
    Function(Function),
    Cot,
    Sinh,
    Cosh,
    Tanh,
    CubeRoot,
    Log10,
}

/// Names besides the functions' own, in small letters. `log` is the natural logarithm, as in programming languages.
const NAMES: [(&str, Named); 21] = [
    ("arcsin", Named::Function(Function::Asin)),
    ("arccos", Named::Function(Function::Acos)),
    ("arctan", Named::Function(Function::Atan)),
    ("arcsen", Named::Function(Function::Asin)),
    ("arctg", Named::Function(Function::Atan)),
    ("ln", Named::Function(Function::Log)),
    ("sen", Named::Function(Function::Sin)),
    ("tg", Named::Function(Function::Tan)),
    ("wurzel", Named::Function(Function::Sqrt)),
    ("root", Named::Function(Function::Sqrt)),
    ("cot", Named::Cot),
    ("ctg", Named::Cot),
    ("sinh", Named::Sinh),
    ("cosh", Named::Cosh),
    ("tanh", Named::Tanh),
    ("cbrt", Named::CubeRoot),
    ("log10", Named::Log10),
    ("lg", Named::Log10),
    ("arcosin", Named::Function(Function::Acos)),
    ("atg", Named::Function(Function::Atan)),
    ("asen", Named::Function(Function::Asin)),
];

impl Named {
    /// What the name stands for, however its letters are written.
    pub(super) fn of(name: &str) -> Option<Self> {
        let lower = name.to_lowercase();
        let own = || lower.parse().ok().map(Self::Function);
        NAMES.iter().find(|(known, _)| *known == lower).map(|(_, named)| *named).or_else(own)
    }

    /// What takes its value back: `sin^-1` is arcsin.
    pub(super) fn inverse(self) -> Option<Self> {
        match self {
            Self::Function(Function::Sin) => Some(Self::Function(Function::Asin)),
            Self::Function(Function::Cos) => Some(Self::Function(Function::Acos)),
            Self::Function(Function::Tan) => Some(Self::Function(Function::Atan)),
            _ => None,
        }
    }

    /// It, of this argument.
    pub(super) fn applied(self, x: Node) -> Node {
        let call = |function, x: &Node| Node::Call(function, Box::new(x.clone()));
        let exponentials = |operator: char, x: &Node| {
            let minus = Node::Call(Function::Exp, Box::new(Node::Negative(Box::new(x.clone()))));
            Node::binary('/', Node::binary(operator, call(Function::Exp, x), minus), Node::Number(2.0))
        };
        match self {
            Self::Function(function) => Node::Call(function, Box::new(x)),
            Self::Cot => Node::binary('/', Node::Number(1.0), call(Function::Tan, &x)),
            Self::Sinh => exponentials('-', &x),
            Self::Cosh => exponentials('+', &x),
            Self::Tanh => Node::binary('/', exponentials('-', &x), exponentials('+', &x)),
            Self::CubeRoot => Node::binary('^', x, Node::Number(1.0 / 3.0)),
            Self::Log10 => Node::binary('/', call(Function::Log, &x), Node::Number(std::f64::consts::LN_10)),
        }
    }
}

/// The angle of the point (x, y): 2 atan(y/(√(x² + y²) + x)), smooth but on the negative x axis.
pub(super) fn angle_of(y: Node, x: Node) -> Node {
    let square = |a: &Node| Node::binary('^', a.clone(), Node::Number(2.0));
    let radius = Node::Call(Function::Sqrt, Box::new(Node::binary('+', square(&x), square(&y))));
    let half = Node::Call(Function::Atan, Box::new(Node::binary('/', y, Node::binary('+', radius, x))));
    Node::binary('*', Node::Number(2.0), half)
}
