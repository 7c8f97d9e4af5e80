//! What a symbol, or a product of them, can mean.

use crate::answers::dimension::Dimension;

/// One meaning: 1 of it is `factor` in SI base units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Meaning {
    pub factor: f64,
    pub dimension: Dimension,
    /// Whether turns are counted by it: hertz.
    pub counts_turns: bool,
}

/// Most meanings of one text that are followed.
const MAX_MEANINGS: usize = 16;

impl Meaning {
    /// A pure number.
    pub(super) const ONE: Self = Self { factor: 1.0, dimension: Dimension([0; 7]), counts_turns: false };

    /// This times the other to a power; `None` if an exponent is out of range. Turns are counted by hertz alone: Hz s is a
    /// number of turns.
    pub(super) fn times(self, other: Self, power: i32) -> Option<Self> {
        let dimension = self.dimension.combine(other.dimension, power)?;
        let factor = self.factor * power_of(other.factor, power);
        Some(Self {
            factor,
            dimension,
            counts_turns: (self.counts_turns || other.counts_turns) && dimension == HERTZ,
        })
    }

    /// This to a power; `None` if an exponent is out of range.
    pub(super) fn power(self, power: i32) -> Option<Self> {
        Self::ONE.times(self, power)
    }
}

/// 1/s.
const HERTZ: Dimension = Dimension([0, 0, -1, 0, 0, 0, 0]);

fn power_of(factor: f64, power: i32) -> f64 {
    let positive = (0..power.unsigned_abs()).fold(1.0, |product, _| product * factor);
    if power < 0 { 1.0 / positive } else { positive }
}

/// Every product of one of the first and one of the second to this power, without repeats.
pub(super) fn products(first: &[Meaning], second: &[Meaning], power: i32) -> Vec<Meaning> {
    let mut out: Vec<Meaning> = Vec::new();
    for a in first {
        for b in second {
            if let Some(product) = a.times(*b, power)
                && !out.contains(&product)
                && out.len() < MAX_MEANINGS
            {
                out.push(product);
            }
        }
    }
    out
}
