//! Formulas in t as functions of time, with their power series about any moment — eq. (11.9).

use super::expansion::{MAX_TERMS, sine_cosine};
use triad_linalg::largest_size;
use triad_scene::expression::{Expression, ExpressionError, Function, Node};

/// Moments of a run at which a formula is tried before it starts.
pub const TRIED: u32 = 1_000;
/// So many of these moments lie between two series from which values are foretold, and the reach of each; then the same from fewer
/// moments and farther.
const LOOKS: [(u32, u32); 2] = [(10, 100), (100, TRIED)];
/// Rounding of a value, and of one that is foretold, as parts of the largest value and of the sum of all terms; and that of a moment.
const QUIET: f64 = 1e-15;
const FORETOLD: f64 = 1e-12;
const ROUNDED: f64 = 4.0 * f64::EPSILON;
/// How many terms foretell: as many as the shortest series of a step has, and all. The last ones have to be no more than rounding where
/// they are to foretell anything: some may vanish by chance.
const FORETELL: [(usize, usize); 2] = [(9, 3), (MAX_TERMS, 6)];
/// Degree up to which polynomials in t and in sines do nothing that their series about any moment do not tell.
const GENTLE: f64 = 8.0;
/// Halvings that find the end of a formula's domain between two of them to the last digit.
const HALVINGS: u32 = 60;
/// Greatest whole exponent that is multiplied out: then the base may be zero; and that above which it is by squares.
const MAX_WHOLE: f64 = 1e6;
const MANY: f64 = 64.0;

/// Size of a number from which it is taken for an infinite one that does not change, where its derivatives are too large for numbers; and
/// that of a factor beside it up to which nothing is left of what is divided by the two.
const LARGE: f64 = 1e60;
const ORDINARY: f64 = 1e10;
/// Least exponent that leaves a large number large.
const LEAST_ROOT: f64 = 0.5;

/// Coefficients of a power series.
type Series = [f64; MAX_TERMS];

/// A formula in t that has a power series.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeFormula {
    root: Node,
    /// Where it begins to change after it did not, s.
    wakes: Vec<f64>,
}

/// Why a text is no function of time that can be prescribed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TimeFormulaError {
    /// It cannot be read.
    #[error("{0}")]
    Expression(#[from] ExpressionError),
    /// It uses t in a function without derivatives of every order.
    #[error(
        "{function} of something that depends on t has no power series; a table or pieces with `smooth-step` do"
    )]
    NotSmooth {
        /// The function.
        function: Function,
    },
}

impl TimeFormula {
    /// Reads a formula in t.
    ///
    /// # Errors
    ///
    /// [`TimeFormulaError`]: what cannot be read, with its place, or a function of t that is not smooth.
    pub fn parse(text: &str) -> Result<Self, TimeFormulaError> {
        let root = folded(Expression::parse(text, &["t"])?.into_root());
        match not_smooth(&root) {
            Some(function) => Err(TimeFormulaError::NotSmooth { function }),
            None => Ok(Self { root, wakes: Vec::new() }),
        }
    }

    /// Whether it depends on t.
    pub fn changes(&self) -> bool {
        self.root.uses(0)
    }

    /// Multiplies it by a constant.
    pub fn scale(&mut self, factor: f64) {
        let root = std::mem::replace(&mut self.root, Node::Number(factor));
        self.root = Node::Binary('*', Box::new(Node::Number(factor)), Box::new(root));
    }

    /// Writes the coefficients of the series in τ about time t, at most [`MAX_TERMS`]. They are not finite where the formula
    /// is not defined, or has no such series.
    pub fn expand(&self, t: f64, out: &mut [f64]) {
        let terms = out.len().min(MAX_TERMS);
        let series = expand(&self.root, t, terms);
        out[..terms].copy_from_slice(&series[..terms]);
    }

    /// The first time from 0 to `end`, s, at which value, rate or second derivative are not defined, as far as a thousand
    /// moments tell: those, and zeros of what it divides by between them.
    pub fn undefined_until(&self, end: f64) -> Option<f64> {
        let mut divisors = Vec::new();
        collect_divisors(&self.root, &mut divisors);
        let defined = |t: f64| {
            let series = expand(&self.root, t, 3);
            series[..3].iter().all(|c| c.is_finite())
        };
        let signs = |t: f64| divisors.iter().map(|node| expand(node, t, 1)[0] > 0.0).collect::<Vec<_>>();
        let mut before = (0.0, signs(0.0));
        if !defined(0.0) {
            return Some(0.0);
        }
        for k in 1..=TRIED {
            let t = end * f64::from(k) / f64::from(TRIED);
            let now = signs(t);
            if !defined(t) || now != before.1 {
                return Some(first_where(before.0, t, |t| !defined(t) || signs(t) != before.1));
            }
            before = (t, now);
        }
        None
    }
}

impl TimeFormula {
    /// Finds where it begins to do what its series before do not foretell, although their terms have come to an end, as far as a thousand
    /// moments from 0 to `end`, s, tell: a pulse after a rest, or on a straight line or a sine. Steps would pass it.
    pub fn find_wakes(&mut self, end: f64) {
        self.wakes.clear();
        if degree(&self.root, true).is_some_and(|degree| degree <= GENTLE) {
            return;
        }
        let moment = |k: u32| end * f64::from(k) / f64::from(TRIED);
        let values: Vec<f64> = (0..=TRIED).map(|k| expand(&self.root, moment(k), 1)[0]).collect();
        let change = values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        let rounding = QUIET * largest_size(&values) + ROUNDED * f64::from(TRIED) * change;
        let mut found = Vec::new();
        for (apart, reach) in LOOKS {
            for from in (0..TRIED).step_by(apart as usize) {
                let series = expand(&self.root, moment(from), MAX_TERMS);
                for (terms, last) in FORETELL {
                    let ahead = (from + 1..).zip(&values[from as usize + 1..]).take(reach as usize);
                    let look = |(k, value): (u32, &f64)| {
                        (k, foretold(&series[..terms], last, moment(k) - moment(from), *value, rounding))
                    };
                    let mut told = ahead.map(look).take_while(|(_, look)| *look != Look::Unknown);
                    found.extend(told.find(|(_, look)| *look == Look::Otherwise).map(|(k, _)| k - 1));
                }
            }
        }
        found.sort_unstable();
        found.dedup_by(|later, before| *later <= *before + LOOKS[0].0);
        self.wakes.extend(found.into_iter().map(moment));
    }

    /// The first of these moments after t, s, or infinity.
    pub fn next_wake(&self, t: f64) -> f64 {
        self.wakes.iter().copied().find(|wake| *wake > t).unwrap_or(f64::INFINITY)
    }
}

/// What a value says of a series that foretells it with these terms.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Look {
    /// It is what was foretold.
    Foretold,
    /// It is something else, although the terms have come to an end.
    Otherwise,
    /// They have not.
    Unknown,
}

fn foretold(series: &[f64], end: usize, tau: f64, value: f64, rounding: f64) -> Look {
    let (mut sum, mut sizes, mut last, mut power) = (0.0, 0.0, 0.0f64, 1.0);
    for (n, c) in series.iter().enumerate() {
        let term = c * power;
        sum += term;
        sizes += term.abs();
        if n + end >= series.len() {
            last = last.max(term.abs());
        }
        power *= tau;
    }
    let small = rounding + FORETOLD * sizes;
    // Also of what is no number nothing is known.
    if !(last <= small && sizes.is_finite()) {
        Look::Unknown
    } else if (sum - value).abs() > small {
        Look::Otherwise
    } else {
        Look::Foretold
    }
}

/// The degree of a polynomial in t and, where they are allowed, in sines of such. What one of low degree does anywhere, its series tell
/// everywhere.
fn degree(node: &Node, sines: bool) -> Option<f64> {
    if !node.uses(0) {
        return Some(0.0);
    }
    match node {
        Node::Symbol(_) => Some(1.0),
        Node::Number(_) => Some(0.0),
        Node::Negative(a) => degree(a, sines),
        Node::Call(Function::Sin | Function::Cos, a) if sines => degree(a, false).map(|_| 1.0),
        Node::Call(..) => None,
        Node::Binary('^', a, b) => match **b {
            Node::Number(n) if n >= 0.0 && n.fract() == 0.0 => degree(a, sines).map(|of| n * of),
            _ => None,
        },
        Node::Binary('/', a, b) => degree(a, sines).filter(|_| !b.uses(0)),
        Node::Binary('*', a, b) => Some(degree(a, sines)? + degree(b, sines)?),
        Node::Binary(_, a, b) => Some(degree(a, sines)?.max(degree(b, sines)?)),
    }
}

/// The earliest time at which a statement that is false at `from` and true at `to` becomes true, by halving.
pub fn first_where(mut from: f64, mut to: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (from + to);
        if holds(middle) {
            to = middle;
        } else {
            from = middle;
        }
    }
    to
}

/// The same formula with every part that does not depend on t as its number.
fn folded(node: Node) -> Node {
    if !node.uses(0) {
        return Node::Number(node.eval(&[0.0]));
    }
    match node {
        Node::Negative(a) => Node::Negative(Box::new(folded(*a))),
        Node::Binary(operator, a, b) => Node::Binary(operator, Box::new(folded(*a)), Box::new(folded(*b))),
        Node::Call(function, a) => Node::Call(function, Box::new(folded(*a))),
        Node::Number(_) | Node::Symbol(_) => node,
    }
}

/// A function without derivatives of every order, of something that depends on t.
fn not_smooth(node: &Node) -> Option<Function> {
    match node {
        Node::Number(_) | Node::Symbol(_) => None,
        Node::Call(function @ (Function::Abs | Function::EllipticK), _) => Some(*function),
        Node::Negative(a) | Node::Call(_, a) => not_smooth(a),
        Node::Binary(_, a, b) => not_smooth(a).or_else(|| not_smooth(b)),
    }
}

/// What a formula divides by.
fn collect_divisors(node: &Node, found: &mut Vec<Node>) {
    match node {
        Node::Number(_) | Node::Symbol(_) => {}
        Node::Negative(a) => collect_divisors(a, found),
        Node::Call(function, a) => {
            if *function == Function::Tan {
                found.push(Node::Call(Function::Cos, a.clone()));
            }
            collect_divisors(a, found);
        }
        Node::Binary(operator, a, b) => {
            if *operator == '/' {
                found.push((**b).clone());
            }
            collect_divisors(a, found);
            collect_divisors(b, found);
        }
    }
}

/// The first `terms` coefficients of a formula about time t.
fn expand(node: &Node, t: f64, terms: usize) -> Series {
    let mut out = [0.0; MAX_TERMS];
    match node {
        Node::Number(x) => out[0] = *x,
        Node::Symbol(_) => (out[0], out[1]) = (t, 1.0),
        Node::Negative(a) => out = expand(a, t, terms).map(|c| -c),
        Node::Binary('^', a, b) => out = power(a, b, t, terms),
        Node::Binary(operator, a, b) => {
            let (a, b) = (expand(a, t, terms), expand(b, t, terms));
            match operator {
                '+' => (0..terms).for_each(|n| out[n] = a[n] + b[n]),
                '-' => (0..terms).for_each(|n| out[n] = a[n] - b[n]),
                '*' => out = product(&a, &b, terms),
                _ => out = quotient(&a, &b, terms),
            }
        }
        Node::Call(function, a) => out = call(*function, &expand(a, t, terms), terms),
    }
    out
}

/// A function of a series.
fn call(function: Function, u: &Series, terms: usize) -> Series {
    let one_and_square = |sign: f64| {
        let mut w = product(u, u, terms).map(|c| sign * c);
        w[0] += 1.0;
        w
    };
    match function {
        Function::Sin | Function::Cos | Function::Tan => {
            let (mut sin, mut cos) = ([0.0; MAX_TERMS], [0.0; MAX_TERMS]);
            sine_cosine(&u[..terms], &mut sin, &mut cos);
            match function {
                Function::Sin => sin,
                Function::Cos => cos,
                _ => quotient(&sin, &cos, terms),
            }
        }
        Function::Asin => {
            integral_of_rate_over(u, &constant_power(&one_and_square(-1.0), 0.5, terms), function, terms)
        }
        Function::Acos => integral_of_rate_over(
            u,
            &constant_power(&one_and_square(-1.0), 0.5, terms).map(|c| -c),
            function,
            terms,
        ),
        Function::Atan => integral_of_rate_over(u, &one_and_square(1.0), function, terms),
        // Of a number beyond all others nothing tells how large its logarithm is.
        Function::Log if is_beyond(u, terms) => [f64::NAN; MAX_TERMS],
        Function::Log => integral_of_rate_over(u, u, function, terms),
        Function::Sqrt => constant_power(u, 0.5, terms),
        Function::Exp => {
            let mut e = [0.0; MAX_TERMS];
            e[0] = function.eval(u[0]);
            for n in 1..terms {
                e[n] = (1..=n).map(|j| j as f64 * u[j] * e[n - j]).sum::<f64>() / n as f64;
            }
            settled(e, is_known(u, terms), terms)
        }
        // Parsing refuses those of t; of a number they are numbers.
        Function::Abs | Function::EllipticK => {
            let mut value = [0.0; MAX_TERMS];
            value[0] = function.eval(u[0]);
            value
        }
    }
}

/// f with f' w = u': w fₙ n = n uₙ − Σ j fⱼ wₙ₋ⱼ; the value is that of the function.
fn integral_of_rate_over(u: &Series, w: &Series, function: Function, terms: usize) -> Series {
    let mut f = [0.0; MAX_TERMS];
    f[0] = function.eval(u[0]);
    for n in 1..terms {
        let known: f64 = (1..n).map(|j| j as f64 * f[j] * w[n - j]).sum();
        f[n] = (n as f64 * u[n] - known) / (n as f64 * w[0]);
    }
    f
}

/// Whether a series has a value, a finite one or that of [`settled`], and finite derivatives. At a pole they are infinite.
fn is_known(a: &Series, terms: usize) -> bool {
    !a[0].is_nan() && a[..terms].iter().skip(1).all(|c| c.is_finite())
}

/// Whether it is beyond all numbers, as [`settled`] makes it.
fn is_beyond(a: &Series, terms: usize) -> bool {
    a[0].is_infinite() && is_known(a, terms)
}

/// A function of known series, nowhere near a pole, whose value or derivatives may be too large for numbers: then an infinite one that does
/// not change.
fn settled(mut out: Series, known: bool, terms: usize) -> Series {
    if known && out[0].abs() > LARGE && !out[..terms].iter().all(|c| c.is_finite()) {
        out[1..].fill(0.0);
        out[0] *= f64::INFINITY;
    }
    out
}

/// Whether a factor changes nothing about the size of a large number beside it.
fn is_no_less(a: f64) -> bool {
    a.abs() >= 1.0 / ORDINARY
}

fn product(a: &Series, b: &Series, terms: usize) -> Series {
    let mut out = [0.0; MAX_TERMS];
    for n in 0..terms {
        out[n] = (0..=n).map(|j| a[j] * b[n - j]).sum();
    }
    let known = is_known(a, terms) && is_known(b, terms) && is_no_less(a[0]) && is_no_less(b[0]);
    settled(out, known, terms)
}

fn quotient(a: &Series, b: &Series, terms: usize) -> Series {
    let mut out = [0.0; MAX_TERMS];
    let finite = a[..terms].iter().all(|c| c.is_finite());
    if is_beyond(b, terms) && finite && a[0].abs() <= ORDINARY {
        return out;
    }
    for n in 0..terms {
        let known: f64 = (1..=n).map(|j| b[j] * out[n - j]).sum();
        out[n] = (a[n] - known) / b[0];
    }
    let known = is_known(a, terms) && is_known(b, terms) && is_no_less(b[0]) && b[0].abs() <= ORDINARY;
    settled(out, known, terms)
}

/// a to the power of b.
fn power(a: &Node, b: &Node, t: f64, terms: usize) -> Series {
    let base = expand(a, t, terms);
    let Node::Number(exponent) = *b else {
        let logarithm = call(Function::Log, &base, terms);
        return call(Function::Exp, &product(&expand(b, t, terms), &logarithm, terms), terms);
    };
    if exponent.fract() != 0.0 || exponent.abs() > MAX_WHOLE {
        return constant_power(&base, exponent, terms);
    }
    let mut out = [0.0; MAX_TERMS];
    out[0] = 1.0;
    let whole = out;
    let (mut square, mut left) = (base, exponent.abs());
    while left > 0.0 {
        if left > MANY {
            if left % 2.0 == 1.0 {
                out = product(&out, &square, terms);
            }
            square = product(&square, &square, terms);
            left = (0.5 * left).floor();
        } else {
            out = product(&out, &square, terms);
            left -= 1.0;
        }
    }
    if exponent < 0.0 { quotient(&whole, &out, terms) } else { out }
}

/// pₙ = Σ (b j − (n − j)) aⱼ pₙ₋ⱼ / (n a₀): a to the power of a number.
fn constant_power(a: &Series, exponent: f64, terms: usize) -> Series {
    let mut p = [0.0; MAX_TERMS];
    p[0] = if exponent == 0.5 { a[0].sqrt() } else { libm::pow(a[0], exponent) };
    for n in 1..terms {
        let sum: f64 = (1..=n).map(|j| (exponent * j as f64 - (n - j) as f64) * a[j] * p[n - j]).sum();
        p[n] = sum / (n as f64 * a[0]);
    }
    if is_beyond(a, terms) && exponent <= -LEAST_ROOT {
        return [0.0; MAX_TERMS];
    }
    settled(p, is_known(a, terms) && is_no_less(a[0]) && exponent >= LEAST_ROOT, terms)
}
