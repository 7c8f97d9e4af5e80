//! Hermite interpolation between the ends of a step, from values and derivatives.

/// Value and rate at the part s of a step of size h, of the cubic with the given [value, rate] at both ends.
pub fn cubic(start: [f64; 2], end: [f64; 2], h: f64, s: f64) -> (f64, f64) {
    let ([y0, from], [y1, to]) = (start, end);
    let mean = (y1 - y0) / h;
    let (c2, c3) = (3.0 * mean - 2.0 * from - to, from + to - 2.0 * mean);
    (y0 + h * s * (from + s * (c2 + s * c3)), from + s * (2.0 * c2 + s * 3.0 * c3))
}

/// Value and rate at the part s of a step of size h, of the polynomial of degree 5 with the given [value, rate, second
/// derivative] at both ends.
pub fn quintic(start: [f64; 3], end: [f64; 3], h: f64, s: f64) -> (f64, f64) {
    let change = end[0] - start[0] - h * start[1] - 0.5 * h * h * start[2];
    let slope = h * (end[1] - start[1]) - h * h * start[2];
    let bend = h * h * (end[2] - start[2]);
    let c3 = 10.0 * change - 4.0 * slope + 0.5 * bend;
    let c4 = -15.0 * change + 7.0 * slope - bend;
    let c5 = 6.0 * change - 3.0 * slope + 0.5 * bend;
    let (c1, c2) = (h * start[1], 0.5 * h * h * start[2]);
    let value = start[0] + s * (c1 + s * (c2 + s * (c3 + s * (c4 + s * c5))));
    let rate = c1 + s * (2.0 * c2 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)));
    (value, rate / h)
}
