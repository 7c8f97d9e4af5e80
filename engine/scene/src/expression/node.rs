//! The parts of a formula, and what they amount to.

use crate::text::words;

/// Functions that a formula may call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// Sine.
    Sin,
    /// Cosine.
    Cos,
    /// Tangent.
    Tan,
    /// Arcsine.
    Asin,
    /// Arccosine.
    Acos,
    /// Arctangent.
    Atan,
    /// Square root.
    Sqrt,
    /// Exponential.
    Exp,
    /// Natural logarithm, also written `ln`.
    Log,
    /// Absolute value.
    Abs,
    /// Complete elliptic integral of the first kind of the parameter m = k².
    EllipticK,
}

words!(
    ///
    /// ```
    /// use triad_scene::expression::Function;
    ///
    /// assert_eq!("sin".parse(), Ok(Function::Sin));
    /// ```
    Function {
        Sin => "sin",
        Cos => "cos",
        Tan => "tan",
        Asin => "asin",
        Acos => "acos",
        Atan => "atan",
        Sqrt => "sqrt",
        Exp => "exp",
        Log => "log",
        Abs => "abs",
        EllipticK => "ellipk",
    }
);

/// A part of a formula.
#[derive(Debug, Clone, PartialEq)]
pub enum Node {
    /// A number.
    Number(f64),
    /// A symbol, by its place among those that were named.
    Symbol(usize),
    /// The part with the other sign.
    Negative(Box<Self>),
    /// Two parts with one of `+-*/^` between them.
    Binary(char, Box<Self>, Box<Self>),
    /// A function of a part.
    Call(Function, Box<Self>),
}

impl Node {
    /// Two parts with an operator between them.
    pub(super) fn binary(operator: char, a: Self, b: Self) -> Self {
        Self::Binary(operator, Box::new(a), Box::new(b))
    }

    /// Whether the symbol with this index occurs in it.
    pub fn uses(&self, symbol: usize) -> bool {
        match self {
            Self::Number(_) => false,
            Self::Symbol(index) => *index == symbol,
            Self::Negative(a) | Self::Call(_, a) => a.uses(symbol),
            Self::Binary(_, a, b) => a.uses(symbol) || b.uses(symbol),
        }
    }

    /// Its value for these values of the symbols.
    pub fn eval(&self, values: &[f64]) -> f64 {
        match self {
            Self::Number(x) => *x,
            Self::Symbol(index) => values.get(*index).copied().unwrap_or(f64::NAN),
            Self::Negative(a) => -a.eval(values),
            Self::Binary(operator, a, b) => {
                let (a, b) = (a.eval(values), b.eval(values));
                match operator {
                    '+' => a + b,
                    '-' => a - b,
                    '*' => a * b,
                    '/' => a / b,
                    _ => libm::pow(a, b),
                }
            }
            Self::Call(function, a) => function.eval(a.eval(values)),
        }
    }
}

impl Function {
    /// Its value; not finite where it is not defined.
    pub fn eval(self, a: f64) -> f64 {
        match self {
            Self::Sin => libm::sin(a),
            Self::Cos => libm::cos(a),
            Self::Tan => libm::tan(a),
            Self::Asin => libm::asin(a),
            Self::Acos => libm::acos(a),
            Self::Atan => libm::atan(a),
            Self::Sqrt => a.sqrt(),
            Self::Exp => libm::exp(a),
            Self::Log => libm::log(a),
            Self::Abs => a.abs(),
            Self::EllipticK => elliptic_k(a),
        }
    }
}

/// Complete elliptic integral of the first kind of the parameter m = k², by the arithmetic-geometric mean.
fn elliptic_k(m: f64) -> f64 {
    if !(0.0..1.0).contains(&m) {
        return f64::NAN;
    }
    let (mut a, mut b) = (1.0, (1.0 - m).sqrt());
    for _ in 0..40 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    std::f64::consts::FRAC_PI_2 / a
}
