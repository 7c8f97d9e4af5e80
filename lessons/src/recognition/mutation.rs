//! The reference's own expression with one mistake in it: what would come out.

use std::f64::consts::PI;

use triad_engine::scene::expression::{Function, Node};

use crate::mistakes::{self, Mistake};

/// Standard gravity as courses state it, m/s².
const G: f64 = 9.81;
/// Most tried values; what is longer is no expression that a person works out.
const MOST_VALUES: usize = 4000;

/// A place in an expression: what stands there, its value and those of its parts.
pub(super) struct Place<'a> {
    node: &'a Node,
    symbols: &'a [f64],
    value: f64,
    parts: [f64; 2],
}

/// Values that a mistake makes of a place: always as many at the same place of the same expression, whatever the symbols' values.
type Make = fn(&Place, &[f64], &mut Vec<f64>);
/// The value that a mistake gives a place when it is made wherever it can be.
type Everywhere = fn(&Place) -> Option<f64>;

/// A kind of mistake: made at one place at a time, and everywhere at once.
pub(super) struct Kind {
    pub mistake: &'static Mistake,
    make: Make,
    everywhere: &'static [Everywhere],
}

/// All kinds, the likelier first.
pub(super) const KINDS: [Kind; 13] = [
    Kind { mistake: mistakes::SINE_COSINE, make: sine_cosine, everywhere: &[exchanged] },
    Kind { mistake: mistakes::ANGLE_UNIT, make: angle_unit, everywhere: &[from_degrees, to_degrees] },
    Kind { mistake: mistakes::OTHER_GRAVITY, make: other_gravity, everywhere: &[gravity_of_ten] },
    Kind { mistake: mistakes::POWER, make: power, everywhere: &[] },
    Kind { mistake: mistakes::FUNCTION_MISSING, make: function_missing, everywhere: &[] },
    Kind { mistake: mistakes::TERM_MISSING, make: term_missing, everywhere: &[] },
    Kind { mistake: mistakes::TERM_SIGN, make: term_sign, everywhere: &[] },
    Kind { mistake: mistakes::MASS_AND_WEIGHT, make: no_gravity, everywhere: &[gravity_of_one] },
    Kind { mistake: mistakes::INERTIA, make: inertia, everywhere: &[] },
    Kind { mistake: mistakes::PART_TWICE, make: part_twice, everywhere: &[] },
    Kind { mistake: mistakes::UPSIDE_DOWN, make: upside_down, everywhere: &[] },
    Kind { mistake: mistakes::FACTOR_MISSING, make: factor_missing, everywhere: &[] },
    Kind { mistake: mistakes::OTHER_NUMBER, make: other_number, everywhere: &[] },
];

/// Every number that one mistake of any kind leads to.
#[cfg(test)]
pub(crate) fn slips(node: &Node, symbols: &[f64]) -> Vec<f64> {
    let values = KINDS.iter().flat_map(|kind| kind.values(node, symbols, &[]));
    values.filter(|value| value.is_finite()).collect()
}

impl Kind {
    /// Every value that the expression has with one mistake of this kind; `numbers` are those of the whole question.
    pub(super) fn values(&self, node: &Node, symbols: &[f64], numbers: &[f64]) -> Vec<f64> {
        let (_, mut list) = self.at_each_place(node, symbols, numbers);
        list.truncate(MOST_VALUES);
        list.extend(self.everywhere.iter().map(|everywhere| at_every_place(node, symbols, *everywhere)));
        list
    }

    fn at_each_place(&self, node: &Node, symbols: &[f64], numbers: &[f64]) -> (f64, Vec<f64>) {
        let (value, parts, mut list) = match node {
            Node::Number(_) | Node::Symbol(_) => (node.eval(symbols), [f64::NAN; 2], Vec::new()),
            Node::Negative(a) => {
                let (a, list) = self.at_each_place(a, symbols, numbers);
                (-a, [a, f64::NAN], list.into_iter().map(|x| -x).collect())
            }
            Node::Call(function, a) => {
                let (a, list) = self.at_each_place(a, symbols, numbers);
                let list = list.into_iter().map(|x| function.eval(x)).collect();
                (function.eval(a), [a, f64::NAN], list)
            }
            Node::Binary(operator, a, b) => {
                let (a, left) = self.at_each_place(a, symbols, numbers);
                let (b, right) = self.at_each_place(b, symbols, numbers);
                let mut list: Vec<f64> = left.into_iter().map(|x| joined(*operator, x, b)).collect();
                list.extend(right.into_iter().map(|x| joined(*operator, a, x)));
                (joined(*operator, a, b), [a, b], list)
            }
        };
        if list.len() < MOST_VALUES {
            (self.make)(&Place { node, symbols, value, parts }, numbers, &mut list);
        }
        (value, list)
    }
}

fn at_every_place(node: &Node, symbols: &[f64], replace: Everywhere) -> f64 {
    let at = |node: &Node| at_every_place(node, symbols, replace);
    let (value, parts) = match node {
        Node::Number(_) | Node::Symbol(_) => (node.eval(symbols), [f64::NAN; 2]),
        Node::Negative(a) => {
            let a = at(a);
            (-a, [a, f64::NAN])
        }
        Node::Call(function, a) => {
            let a = at(a);
            (function.eval(a), [a, f64::NAN])
        }
        Node::Binary(operator, a, b) => {
            let (a, b) = (at(a), at(b));
            (joined(*operator, a, b), [a, b])
        }
    };
    replace(&Place { node, symbols, value, parts }).unwrap_or(value)
}

fn joined(operator: char, a: f64, b: f64) -> f64 {
    Node::Binary(operator, Box::new(Node::Number(a)), Box::new(Node::Number(b))).eval(&[])
}

const TRIGONOMETRIC: [Function; 3] = [Function::Sin, Function::Cos, Function::Tan];
const INVERSE: [Function; 3] = [Function::Asin, Function::Acos, Function::Atan];

fn family(node: &Node) -> Option<[Function; 3]> {
    match node {
        Node::Call(function, _) if TRIGONOMETRIC.contains(function) => Some(TRIGONOMETRIC),
        Node::Call(function, _) if INVERSE.contains(function) => Some(INVERSE),
        _ => None,
    }
}

fn sine_cosine(place: &Place, _: &[f64], list: &mut Vec<f64>) {
    for function in family(place.node).into_iter().flatten() {
        let value = function.eval(place.parts[0]);
        list.extend([value, 1.0 / value]);
    }
}

fn exchanged(place: &Place) -> Option<f64> {
    match place.node {
        Node::Call(Function::Sin, _) => Some(Function::Cos.eval(place.parts[0])),
        Node::Call(Function::Cos, _) => Some(Function::Sin.eval(place.parts[0])),
        _ => None,
    }
}

fn angle_unit(place: &Place, _: &[f64], list: &mut Vec<f64>) {
    list.extend([180.0 / PI, PI / 180.0].map(|k| turned(place, k).unwrap_or(f64::NAN)));
}

fn from_degrees(place: &Place) -> Option<f64> {
    turned(place, 180.0 / PI)
}

fn to_degrees(place: &Place) -> Option<f64> {
    turned(place, PI / 180.0)
}

/// A function of an angle in other units.
fn turned(place: &Place, k: f64) -> Option<f64> {
    match place.node {
        Node::Call(function, _) if TRIGONOMETRIC.contains(function) => {
            Some(function.eval(k * place.parts[0]))
        }
        Node::Call(function, _) if INVERSE.contains(function) => Some(k * place.value),
        _ => None,
    }
}

fn other_gravity(place: &Place, _: &[f64], list: &mut Vec<f64>) {
    list.extend(gravity_of_ten(place));
}

fn gravity_of_ten(place: &Place) -> Option<f64> {
    (*place.node == Node::Number(G)).then_some(10.0)
}

fn no_gravity(place: &Place, _: &[f64], list: &mut Vec<f64>) {
    list.extend(gravity_of_one(place));
}

fn gravity_of_one(place: &Place) -> Option<f64> {
    (*place.node == Node::Number(G)).then_some(1.0)
}

/// Powers that are there, symbols, and what is projected twice: nobody squares an angle or a sum in which no square stands.
fn power(place: &Place, _: &[f64], list: &mut Vec<f64>) {
    let [a, b] = place.parts;
    match place.node {
        Node::Binary('^', ..) => {
            let roots = [1.0 / (1.0 / b + 1.0), 1.0 / (1.0 / b - 1.0)];
            let raised = [b - 1.0, b + 1.0, 2.0 * b, 0.5 * b, -b, 1.0 / b];
            list.extend(raised.into_iter().chain(roots).map(|b| joined('^', a, b)));
            list.extend([a, a * b, a / b, joined('^', b, a)]);
        }
        Node::Call(Function::Sqrt, _) => list.extend([a, a * a, joined('^', a, 0.25)]),
        Node::Call(function, _) if TRIGONOMETRIC.contains(function) => list.push(place.value * place.value),
        Node::Symbol(_) => list.extend([place.value * place.value, joined('^', place.value, 0.5)]),
        Node::Number(_) | Node::Negative(_) | Node::Call(..) | Node::Binary(..) => {}
    }
}

fn function_missing(place: &Place, _: &[f64], list: &mut Vec<f64>) {
    if let Node::Call(..) = place.node {
        list.push(place.parts[0]);
    }
}

/// The parts of a sum, each with its sign.
fn term_missing(place: &Place, _: &[f64], list: &mut Vec<f64>) {
    let [a, b] = place.parts;
    match place.node {
        Node::Binary('+', ..) => list.extend([a, b]),
        Node::Binary('-', ..) => list.extend([a, b, -b]),
        _ => {}
    }
}

fn term_sign(place: &Place, _: &[f64], list: &mut Vec<f64>) {
    let [a, b] = place.parts;
    match place.node {
        Node::Binary('+', ..) => list.extend([a - b, b - a]),
        Node::Binary('-', ..) => list.extend([a + b, b - a, -a - b]),
        Node::Negative(_) => list.push(a),
        _ => {}
    }
}

/// Moments of inertia of a rod about its middle and its end, of a ball and a cylinder.
fn inertia(place: &Place, _: &[f64], list: &mut Vec<f64>) {
    if let Node::Binary('/', _, divisor) = place.node {
        match **divisor {
            Node::Number(12.0) => list.extend([3.0, 6.0, 24.0].map(|k| place.parts[0] / k)),
            Node::Number(3.0) => list.extend([12.0, 2.0].map(|k| place.parts[0] / k)),
            _ => {}
        }
    }
}

fn part_twice(place: &Place, _: &[f64], list: &mut Vec<f64>) {
    list.extend([2.0, 0.5].map(|k| k * place.value));
}

fn upside_down(place: &Place, _: &[f64], list: &mut Vec<f64>) {
    let [a, b] = place.parts;
    match place.node {
        Node::Binary('*', ..) => list.extend([a / b, b / a]),
        Node::Binary('/', top, _) => {
            list.extend([a * b, b / a]);
            // Of x·y/z also x·z/y, whichever factors of the top are turned.
            let factors = factors(top, place.symbols);
            let ends = (1..factors.len()).map(|k| factors[k..].iter().product::<f64>());
            list.extend(ends.map(|end| a / end * b / end));
        }
        _ => {}
    }
}

/// The factors of a product, from left to right.
fn factors(node: &Node, symbols: &[f64]) -> Vec<f64> {
    match node {
        Node::Binary('*', a, b) => {
            let mut list = factors(a, symbols);
            list.push(b.eval(symbols));
            list
        }
        other => vec![other.eval(symbols)],
    }
}

/// One factor or divisor, or two factors that stand together, such as 2π.
fn factor_missing(place: &Place, _: &[f64], list: &mut Vec<f64>) {
    let [a, b] = place.parts;
    match place.node {
        Node::Binary('*', left, _) => {
            list.extend([a, b]);
            let factors = factors(left, place.symbols);
            if let [.., _, last] = factors.as_slice() {
                list.push(a / last);
            }
        }
        Node::Binary('/', ..) => list.extend([a, 1.0 / b, b]),
        _ => {}
    }
}

/// The values of all parts of an expression that are worked out and are neither the whole nor a mere number.
pub(super) fn part_results(node: &Node, symbols: &[f64]) -> Vec<f64> {
    let mut list = Vec::new();
    let mut add = |part: &Node| {
        if !matches!(part, Node::Number(_) | Node::Symbol(_)) {
            list.push(part.eval(symbols));
            list.extend(part_results(part, symbols));
        }
    };
    match node {
        Node::Number(_) | Node::Symbol(_) => {}
        Node::Negative(a) | Node::Call(_, a) => add(a),
        Node::Binary(_, a, b) => {
            add(a);
            add(b);
        }
    }
    list
}

fn other_number(place: &Place, numbers: &[f64], list: &mut Vec<f64>) {
    if matches!(place.node, Node::Number(_) | Node::Symbol(_)) {
        list.extend(numbers.iter().map(|x| if *x == place.value { f64::NAN } else { *x }));
    }
}
