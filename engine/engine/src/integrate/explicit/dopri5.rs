//! Coefficients of the pair of orders 5(4) by Dormand and Prince, A family of embedded Runge-Kutta formulae, J. Comput.
//! Appl. Math. 6 (1980), with the dense output of order 4 — Hairer, Nørsett, Wanner, Solving Ordinary Differential
//! Equations I, sections II.5 and II.6. The order test of the integrator checks them.

use super::tableau::{Estimate, Tableau};

/// Explicit Runge-Kutta of order 5 with an error estimate of order 4 and dense output of order 4.
pub const DOPRI5: Tableau = Tableau {
    order: 5,
    stages: STAGES,
    reuses_last: true,
    nodes: &[0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0],
    rows: &A,
    estimate: Estimate::Single(E),
    dense: &[D],
    change: (0.2, 10.0),
};

/// Stages of the method; the last one is the first of the next step.
const STAGES: usize = 7;

/// The last row is b, whose rate is the first stage of the next step.
const A: [&[(usize, f64)]; STAGES] = [
    &[],
    &[(0, 1.0 / 5.0)],
    &[(0, 3.0 / 40.0), (1, 9.0 / 40.0)],
    &[(0, 44.0 / 45.0), (1, -56.0 / 15.0), (2, 32.0 / 9.0)],
    &[(0, 19372.0 / 6561.0), (1, -25360.0 / 2187.0), (2, 64448.0 / 6561.0), (3, -212.0 / 729.0)],
    &[
        (0, 9017.0 / 3168.0),
        (1, -355.0 / 33.0),
        (2, 46732.0 / 5247.0),
        (3, 49.0 / 176.0),
        (4, -5103.0 / 18656.0),
    ],
    &[(0, 35.0 / 384.0), (2, 500.0 / 1113.0), (3, 125.0 / 192.0), (4, -2187.0 / 6784.0), (5, 11.0 / 84.0)],
];

/// b less the weights of order 4.
pub(super) const E: &[(usize, f64)] = &[
    (0, 71.0 / 57600.0),
    (2, -71.0 / 16695.0),
    (3, 71.0 / 1920.0),
    (4, -17253.0 / 339_200.0),
    (5, 22.0 / 525.0),
    (6, -1.0 / 40.0),
];

/// The fourth difference of the dense output.
const D: &[(usize, f64)] = &[
    (0, -12_715_105_075.0 / 11_282_082_432.0),
    (2, 87_487_479_700.0 / 32_700_410_799.0),
    (3, -10_690_763_975.0 / 1_880_347_072.0),
    (4, 701_980_252_875.0 / 199_316_789_632.0),
    (5, -1_453_857_185.0 / 822_651_844.0),
    (6, 69_997_945.0 / 29_380_423.0),
];
