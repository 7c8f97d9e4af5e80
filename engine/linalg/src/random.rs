//! Numbers that look random, for experiments and tests.

/// A small generator (splitmix64), so that a seed means the same everywhere and for ever.
///
/// Published experiments name their seeds: its numbers must never change.
///
/// ```
/// use triad_linalg::random::Random;
///
/// let mut random = Random::new(7);
/// assert_eq!(random.bits(), 7_191_089_600_892_374_487);
/// assert!((0.0..1.0).contains(&random.unit()));
/// ```
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The generator of this seed.
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Three numbers, each uniform in [−size, size).
    pub fn triple(&mut self, size: f64) -> [f64; 3] {
        [0; 3].map(|_| self.between(-size, size))
    }

    /// A vector of at most unit components that is not too short to be normalized.
    pub fn direction(&mut self) -> [f64; 3] {
        loop {
            let vector = self.triple(1.0);
            if nalgebra::Vector3::from(vector).norm() > 0.2 {
                return vector;
            }
        }
    }

    /// A whole number below n > 0.
    pub fn below(&mut self, n: usize) -> usize {
        let n = n as u64;
        usize::try_from(self.bits() % n).unwrap_or(0)
    }

    /// True in this part of all cases.
    pub fn chance(&mut self, part: f64) -> bool {
        self.unit() < part
    }
}
