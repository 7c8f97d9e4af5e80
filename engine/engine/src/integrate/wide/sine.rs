//! Sine and cosine of several angles at once, by the polynomials of `libm` (those of FreeBSD's msun, `k_sin.c` and `k_cos.c`).

use super::{MOST_LANES, Wide};
use pulp::Simd;

/// Angle, rad, up to which quarters of a turn are taken off here.
const FAR: f64 = 1e5;
/// π/2 as a sum of two numbers.
const QUARTER: [f64; 2] = [std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17];
/// Added and taken off again, it leaves the nearest whole number.
const WHOLE: f64 = 6_755_399_441_055_744.0;
const SINE: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
const COSINE: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

impl<S: Simd> Wide<S> {
    /// Sine and cosine of angles.
    #[inline(always)]
    pub fn sine_cosine(self) -> [Self; 2] {
        let mut angles = [0.0; MOST_LANES];
        self.store(&mut angles);
        if angles.iter().any(|x| x.is_nan() || x.abs() > FAR) {
            return [self.each(|_, x| libm::sin(x)), self.each(|_, x| libm::cos(x))];
        }
        let simd = self.simd();
        let [one, whole] = [Self::all(simd, 1.0), Self::all(simd, WHOLE)];
        let [half, quarter] = [Self::all(simd, 0.5), Self::all(simd, 0.25)];
        let turns = (self * Self::all(simd, std::f64::consts::FRAC_2_PI) + whole) - whole;
        let near = self.less(turns, Self::all(simd, QUARTER[0]));
        let x = near.less(turns, Self::all(simd, QUARTER[1]));
        let rest = (near - x).less(turns, Self::all(simd, QUARTER[1]));
        let [sine, cosine] = polynomials(x, rest);
        // Quarters from the last half turn on, and half turns from the last whole one on: 0 or 1.
        let halves = ((turns * half - quarter) + whole) - whole;
        let odd = turns - halves - halves;
        let wholes = ((halves * half - quarter) + whole) - whole;
        let back = halves - wholes - wholes;
        let sign = one - back - back;
        let even = one - odd;
        [sign * (sine * even).plus(cosine, odd), sign * (even - odd) * (cosine * even).plus(sine, odd)]
    }
}

/// Of angles up to π/4, with what they lack of theirs.
#[inline(always)]
fn polynomials<S: Simd>(x: Wide<S>, rest: Wide<S>) -> [Wide<S>; 2] {
    let simd = x.simd();
    let [one, half] = [Wide::all(simd, 1.0), Wide::all(simd, 0.5)];
    let square = x * x;
    let mut sine = Wide::all(simd, SINE[5]);
    let mut cosine = Wide::all(simd, COSINE[5]);
    for k in (1..5).rev() {
        sine = Wide::all(simd, SINE[k]).plus(square, sine);
    }
    for k in (0..5).rev() {
        cosine = Wide::all(simd, COSINE[k]).plus(square, cosine);
    }
    let cube = square * x;
    let lacking = (square * (half * rest).less(cube, sine) - rest).less(cube, Wide::all(simd, SINE[0]));
    let near = one.less(half, square);
    let off = (one - near).less(half, square) + (square * square * cosine).less(x, rest);
    [x - lacking, near + off]
}
