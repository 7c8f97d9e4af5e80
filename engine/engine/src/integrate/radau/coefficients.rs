//! Coefficients of Radau IIA of order 5 (Hairer, Wanner, Solving Ordinary Differential Equations II, sections IV.5 and
//! IV.8).

#![allow(clippy::excessive_precision, reason = "the numbers stand as they were published")]

use nalgebra::Complex;

/// Nodes c of the stages, in parts of a step.
pub const C: [f64; 3] = [0.155_051_025_721_682_2, 0.644_948_974_278_317_8, 1.0];
/// The real eigenvalue of A⁻¹.
pub const REAL: f64 = 3.637_834_252_744_496;
/// One of the pair of complex eigenvalues of A⁻¹.
pub const PAIR: Complex<f64> = Complex::new(2.681_082_873_627_752_3, 3.050_430_199_247_410_5);
/// T, which turns A⁻¹ into its real block form T⁻¹ A⁻¹ T.
pub const T: [[f64; 3]; 3] = [
    [0.091_232_394_870_892_94, -0.141_255_295_020_954_2, -0.030_029_194_105_147_424],
    [0.241_717_932_707_107_02, 0.204_129_352_293_799_93, 0.382_942_112_757_261_94],
    [0.966_048_182_615_092_9, 1.0, 0.0],
];
/// T⁻¹.
pub const T_INVERSE: [[f64; 3]; 3] = [
    [4.325_579_890_063_155, 0.339_199_251_815_809_87, 0.541_770_539_935_874_9],
    [-4.178_718_591_551_905, -0.327_682_820_761_062_4, 0.476_623_554_500_550_45],
    [-0.502_872_634_945_786_9, 2.571_926_949_855_605_4, -0.596_039_204_828_224_9],
];
/// Weights of the stages in the error estimate of order 3.
pub const ESTIMATE: [f64; 3] = [-10.048_809_399_827_416, 1.382_142_733_160_748_9, -0.333_333_333_333_333_3];

/// Weights of the stages, less the start of the step, in the collocation polynomial at the part s of a step.
pub fn collocation(s: f64) -> [f64; 3] {
    [0, 1, 2].map(|stage| {
        let mut weight = s / C[stage];
        for (other, node) in C.iter().enumerate() {
            if other != stage {
                weight *= (s - node) / (C[stage] - node);
            }
        }
        weight
    })
}
