//! Coefficients of the Radau IIA methods of orders 5, 9 and 13: nodes, weights and eigenvalues as tables, everything else
//! from them (Hairer, Wanner, Solving Ordinary Differential Equations II, sections IV.5 and IV.8; Stiff differential
//! equations solved by Radau methods, J. Comput. Appl. Math. 111 (1999)).

use nalgebra::{Complex, DMatrix};

/// Least tolerance at which the method has order 5, and order 9: measured on stiff and driven mechanisms. At 1e-6 order 13 takes half of
/// the time of order 9 on the car axis, a sixth less on driven dampers, on the governor 6 in 100 more; at 1e-5 order 9 takes no more on
/// any, and at 1e-3 no more than order 5.
const AT_ORDER_5: f64 = 3e-3;
const AT_ORDER_9: f64 = 3e-6;
/// The latter on open trees: side by side seven stages take no longer than five, and on the governor a sixth less at 1e-5.
const AT_ORDER_9_OPEN: f64 = 3e-5;

/// A method as tables.
#[derive(Debug)]
pub struct RadauTables {
    /// Nodes c of the stages, in parts of a step, with their weights b.
    pub nodes: &'static [(f64, f64)],
    /// The real eigenvalue of A⁻¹.
    pub real: f64,
    /// One of each pair of complex eigenvalues of A⁻¹.
    pub pairs: &'static [Complex<f64>],
}

impl RadauTables {
    /// The order for a tolerance: the looser, the fewer stages. `open` says that nothing is solved for in the coordinates.
    pub fn of(tolerance: f64, open: bool) -> &'static Self {
        if tolerance >= AT_ORDER_5 {
            &RADAU_5
        } else if tolerance >= if open { AT_ORDER_9_OPEN } else { AT_ORDER_9 } {
            &RADAU_9
        } else {
            &RADAU_13
        }
    }
}

/// Three stages, order 5.
pub static RADAU_5: RadauTables = RadauTables {
    nodes: &[
        (0.155_051_025_721_682_2, 0.376_403_062_700_467_26),
        (0.644_948_974_278_317_8, 0.512_485_826_188_421_6),
        (1.0, 0.111_111_111_111_111_1),
    ],
    real: 3.637_834_252_744_496,
    pairs: &[Complex::new(2.681_082_873_627_752, 3.050_430_199_247_410_5)],
};
/// Five stages, order 9.
pub static RADAU_9: RadauTables = RadauTables {
    nodes: &[
        (0.057_104_196_114_517_68, 0.143_713_560_791_225_95),
        (0.276_843_013_638_123_8, 0.281_356_015_149_462_06),
        (0.583_590_432_368_916_8, 0.311_826_522_975_741_25),
        (0.860_240_135_656_219_4, 0.223_103_901_083_570_74),
        (1.0, 0.04),
    ],
    real: 6.286_704_751_729_276_6,
    pairs: &[
        Complex::new(5.700_953_298_671_789, 3.210_265_600_308_55),
        Complex::new(3.655_694_325_463_572, 6.543_736_899_360_077),
    ],
};
/// Seven stages, order 13.
pub static RADAU_13: RadauTables = RadauTables {
    nodes: &[
        (0.029_316_427_159_784_893, 0.074_494_235_556_010_32),
        (0.148_078_599_668_484_3, 0.159_102_115_733_650_74),
        (0.336_984_690_281_154_3, 0.212_351_889_502_977_8),
        (0.558_671_518_771_550_1, 0.223_554_914_507_283_23),
        (0.769_233_862_030_054_5, 0.190_474_936_822_115_58),
        (0.926_945_671_319_741_1, 0.119_613_744_612_656_2),
        (1.0, 0.020_408_163_265_306_12),
    ],
    real: 8.936_832_788_405_216,
    pairs: &[
        Complex::new(8.511_834_825_102_946, 3.281_013_624_325_059),
        Complex::new(7.141_055_219_187_64, 6.623_045_922_639_276),
        Complex::new(4.378_693_561_506_806, 10.169_693_283_795_012),
    ],
};
/// Nine stages, order 17: for a run that is compared with one of order 13.
pub static RADAU_17: RadauTables = RadauTables {
    nodes: &[
        (0.017_779_915_147_363_45, 0.045_357_252_461_641_46),
        (0.091_323_607_899_793_96, 0.100_276_649_012_275_98),
        (0.214_308_479_395_630_76, 0.143_193_348_178_615_6),
        (0.371_932_164_583_272_3, 0.168_846_983_487_964_8),
        (0.545_186_684_803_426_6, 0.174_136_501_386_483_3),
        (0.713_175_242_855_569_5, 0.158_421_887_835_219),
        (0.855_633_742_957_854_4, 0.123_594_689_102_296_53),
        (0.955_366_044_710_030_1, 0.073_827_009_523_157_7),
        (1.0, 0.012_345_679_012_345_678),
    ],
    real: 11.587_350_921_286_278,
    pairs: &[
        Complex::new(11.253_269_857_270_691, 3.321_340_531_521_829_4),
        Complex::new(10.206_883_220_848_505, 6.680_140_723_790_38),
        Complex::new(8.280_042_200_550_888, 10.138_359_661_108_792),
        Complex::new(4.966_129_260_686_777_5, 13.864_685_978_914_036),
    ],
};

/// Most stages of these.
pub const MOST_STAGES: usize = 9;

/// A method with what follows from its tables.
#[derive(Clone, Debug)]
pub struct Method {
    /// The tables.
    pub tables: &'static RadauTables,
    /// Tᵀ, where T turns A⁻¹ into its real block form T⁻¹ A⁻¹ T: a row for the real eigenvalue, two for each pair.
    pub t: DMatrix<f64>,
    /// T⁻¹, transposed as well.
    pub t_inverse: DMatrix<f64>,
    /// One by the product of the distances of each node from all others.
    apart: Vec<f64>,
    /// Weights of the stages, less the start, in −p'(0), p being the collocation polynomial over the parts of the step: h ẋ at the start and −p'(0) add up to the error estimate.
    pub estimate: Vec<f64>,
}

impl Method {
    /// From its tables.
    pub fn new(tables: &'static RadauTables) -> Self {
        let s = tables.nodes.len();
        let mut t = DMatrix::zeros(s, s);
        let vector = |eigenvalue: Complex<f64>| eigenvector(tables, eigenvalue);
        for (row, x) in vector(Complex::new(tables.real, 0.0)).into_iter().enumerate() {
            t[(0, row)] = x.re;
        }
        for (pair, eigenvalue) in tables.pairs.iter().enumerate() {
            for (row, x) in vector(*eigenvalue).into_iter().enumerate() {
                (t[(1 + 2 * pair, row)], t[(2 + 2 * pair, row)]) = (x.re, -x.im);
            }
        }
        let t_inverse = t.clone().try_inverse().unwrap_or_else(|| DMatrix::identity(s, s));
        let estimate = (0..s)
            .map(|i| {
                let others = (0..s).filter(|&j| j != i).map(|j| {
                    let (own, other) = (tables.nodes[i].0, tables.nodes[j].0);
                    -other / (own - other)
                });
                -others.product::<f64>() / tables.nodes[i].0
            })
            .collect();
        let apart = |own: f64| {
            let others = tables.nodes.iter().filter(|(node, _)| *node != own);
            1.0 / others.map(|(node, _)| own - node).product::<f64>()
        };
        let apart = tables.nodes.iter().map(|(own, _)| apart(*own)).collect();
        Self { tables, t, t_inverse, apart, estimate }
    }

    /// Number of stages.
    pub fn stages(&self) -> usize {
        self.tables.nodes.len()
    }

    /// Writes the weights of the stages in the polynomial through them at the part x of a step.
    pub fn through(&self, x: f64, weights: &mut [f64]) {
        // Products of what comes before a stage, and of what comes behind it.
        let mut product = 1.0;
        for (out, ((node, _), apart)) in weights.iter_mut().zip(self.tables.nodes.iter().zip(&self.apart)) {
            *out = product * apart;
            product *= x - node;
        }
        product = 1.0;
        for (out, (node, _)) in weights.iter_mut().zip(self.tables.nodes).rev() {
            *out *= product;
            product *= x - node;
        }
    }

    /// Writes the weights of the stages, less the start of the step, in the collocation polynomial at the part x of a step.
    pub fn collocation(&self, x: f64, weights: &mut [f64]) {
        self.through(x, weights);
        for (weight, (node, _)) in weights.iter_mut().zip(self.tables.nodes) {
            *weight *= x / node;
        }
    }
}

/// An eigenvector of A⁻¹, of length one. For a collocation method A v = λ v says that ∫₀ˣ p = λ p + κ M(x) with the
/// polynomial p through v and M = ∏ (x − c): ∫₀ˣ p = Σ λʲ M⁽ʲ⁾ and p = Σ λʲ M⁽ʲ⁺¹⁾.
fn eigenvector(tables: &RadauTables, eigenvalue: Complex<f64>) -> Vec<Complex<f64>> {
    let inverse = Complex::new(1.0, 0.0) / eigenvalue;
    // Coefficients of M, lowest first.
    let mut polynomial = vec![1.0];
    for (node, _) in tables.nodes {
        let mut next = vec![0.0; polynomial.len() + 1];
        for (power, a) in polynomial.iter().enumerate() {
            next[power + 1] += a;
            next[power] -= node * a;
        }
        polynomial = next;
    }
    let derivative =
        |p: &[f64]| p.iter().enumerate().skip(1).map(|(k, a)| k as f64 * a).collect::<Vec<f64>>();
    let value = |p: &[f64], x: f64| p.iter().rev().fold(0.0, |sum, a| sum * x + a);
    let mut vector = vec![Complex::new(0.0, 0.0); tables.nodes.len()];
    let (mut power, mut rest) = (Complex::new(1.0, 0.0), derivative(&polynomial));
    while !rest.is_empty() {
        for (x, (node, _)) in vector.iter_mut().zip(tables.nodes) {
            *x += power * value(&rest, *node);
        }
        power *= inverse;
        rest = derivative(&rest);
    }
    let size = vector.iter().map(Complex::norm_sqr).sum::<f64>().sqrt();
    vector.into_iter().map(|x| x / size).collect()
}
