//! Physical dimensions: seven integer exponents of SI base units.

use std::fmt;

/// Largest exponent of a base unit, and of a unit as typed.
pub(super) const MAX_EXPONENT: i32 = 12;

/// Exponents of m, kg, s, A, K, mol and cd.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Dimension(pub [i32; 7]);

impl Dimension {
    /// Name of the dimension for a sentence ("force", "moment or energy"), if it has a common one.
    pub fn name(self) -> Option<&'static str> {
        Some(match self.0 {
            [0, 0, 0, 0, 0, 0, 0] => "a number without dimension (or an angle)",
            [1, 0, 0, 0, 0, 0, 0] => "a length",
            [0, 1, 0, 0, 0, 0, 0] => "a mass",
            [0, 0, 1, 0, 0, 0, 0] => "a time",
            [1, 0, -1, 0, 0, 0, 0] => "a speed",
            [1, 0, -2, 0, 0, 0, 0] => "an acceleration",
            [0, 0, -1, 0, 0, 0, 0] => "an angular speed or a frequency",
            [0, 0, -2, 0, 0, 0, 0] => "an angular acceleration",
            [1, 1, -2, 0, 0, 0, 0] => "a force",
            [2, 1, -2, 0, 0, 0, 0] => "a moment or an energy",
            [2, 1, -3, 0, 0, 0, 0] => "a power",
            [2, 1, 0, 0, 0, 0, 0] => "a moment of inertia",
            [1, 1, -1, 0, 0, 0, 0] => "a momentum",
            [2, 1, -1, 0, 0, 0, 0] => "an angular momentum",
            [0, 1, -2, 0, 0, 0, 0] => "a stiffness (force per length)",
            [2, 0, 0, 0, 0, 0, 0] => "an area",
            [3, 0, 0, 0, 0, 0, 0] => "a volume",
            [2, 0, -2, 0, 0, 0, 0] => "a squared speed",
            _ => return None,
        })
    }

    /// Exponents of `self · other^power`; `None` if one is out of range.
    pub(super) fn combine(self, other: Self, power: i32) -> Option<Self> {
        let mut out = self.0;
        for (a, b) in out.iter_mut().zip(other.0) {
            *a = b.checked_mul(power).and_then(|b| a.checked_add(b)).filter(|e| e.abs() <= MAX_EXPONENT)?;
        }
        Some(Self(out))
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(name) = self.name() {
            return f.write_str(name);
        }
        let names = ["m", "kg", "s", "A", "K", "mol", "cd"];
        let mut first = true;
        for (name, exponent) in names.iter().zip(self.0).filter(|(_, e)| *e != 0) {
            if !first {
                f.write_str(" ")?;
            }
            first = false;
            if exponent == 1 { f.write_str(name)? } else { write!(f, "{name}^{exponent}")? }
        }
        Ok(())
    }
}
