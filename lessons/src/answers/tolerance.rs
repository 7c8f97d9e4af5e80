//! The tolerance of an answer: the same struct grades and writes the student's sentence, so the two agree.
//!
//! An answer `s` is right when `‖s − t‖ ≤ absolute + relative·‖t‖`, where `t` is the reference and ‖·‖ is the
//! absolute value of a number, the length of a vector, or the root of the sum of squares of a matrix. A
//! component that should be zero is thereby judged on the scale of the whole vector.

use crate::text::plain;

/// How far an answer may be from the reference. All lengths are in the unit the question names.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Allowed difference regardless of size, in the question's unit.
    pub absolute: f64,
    /// Allowed difference as a share of the reference's norm.
    pub relative: f64,
}

/// What an answer is made of; it decides how the sentence speaks of a difference.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ValueShape {
    /// One number.
    Number,
    /// A vector, whose components are in the frame the question states.
    Vector,
    /// A matrix, row by row.
    Matrix,
}

/// Root of the sum of squares.
pub fn norm(components: &[f64]) -> f64 {
    let largest = components.iter().fold(0.0f64, |largest, c| largest.max(c.abs()));
    // Squares that can be held.
    let scale = if (1e-140..1e140).contains(&largest) || largest == 0.0 { 1.0 } else { largest };
    scale * components.iter().map(|c| (c / scale) * (c / scale)).sum::<f64>().sqrt()
}

/// Norm of the difference.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    norm(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>())
}

impl Tolerance {
    /// A rule for counts: the number must be exact.
    pub const EXACT: Self = Self { absolute: 0.0, relative: 0.0 };

    /// True when only the exact value is accepted.
    pub fn is_exact(&self) -> bool {
        self.absolute == 0.0 && self.relative == 0.0
    }

    /// The largest difference accepted for a reference of this norm.
    pub fn allowed(&self, reference_norm: f64) -> f64 {
        self.absolute + self.relative * reference_norm
    }

    /// Whether an answer is right. `answer` and `reference` have the same number of components.
    pub fn accepts(&self, answer: &[f64], reference: &[f64]) -> bool {
        if answer.len() != reference.len() {
            return false;
        }
        // Half a unit in the last place of the sums, so that an answer exactly on the edge is inside.
        let allowed = self.allowed(norm(reference));
        distance(answer, reference) <= allowed * (1.0 + 1e-12)
    }

    /// Significant digits that are enough for every value, if the rule has a relative part.
    pub fn digits(&self) -> Option<u32> {
        if self.relative <= 0.0 {
            return None;
        }
        let needed = 1.0 + libm::log10(0.5 / self.relative).ceil().max(0.0);
        // At most 16 by the check of authors; the cast cannot lose anything.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        Some(needed as u32)
    }

    /// The rule in words, for the student. `unit` is the question's unit, empty for a pure number.
    pub fn sentence(&self, shape: ValueShape, unit: &str, frame: Option<&str>) -> String {
        if self.is_exact() {
            return match shape {
                ValueShape::Number => {
                    "The answer is exact: only this very number counts as right.".to_owned()
                }
                ValueShape::Vector => {
                    "The answer is exact: every component must be this very number.".to_owned()
                }
                ValueShape::Matrix => "The answer is exact: every entry must be this very number.".to_owned(),
            };
        }
        let (difference, whole) = match shape {
            ValueShape::Number => ("it differs from ours by at most", "our value"),
            ValueShape::Vector => {
                ("the length of the difference from our vector is at most", "our vector's length")
            }
            ValueShape::Matrix => {
                ("the root of the sum of the squared differences is at most", "the same root of our matrix")
            }
        };
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        let allowed = match (self.relative > 0.0, self.absolute > 0.0) {
            (true, true) => {
                format!("{} % of {whole} plus {}{unit}", plain(self.relative * 100.0), plain(self.absolute))
            }
            (true, false) => format!("{} % of {whole}", plain(self.relative * 100.0)),
            _ => format!("{}{unit}", plain(self.absolute)),
        };
        let mut sentence = format!("Right if {difference} {allowed}.");
        if let Some(frame) = frame {
            sentence = format!("{sentence} Components in {frame}.");
        }
        if shape != ValueShape::Number {
            sentence.push_str(" A component that should be zero is judged by the same allowance.");
        }
        if let Some(digits) = self.digits() {
            sentence = format!("{sentence} Give at least {digits} significant digits.");
        }
        sentence
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answers::number::read;

    const RULE: Tolerance = Tolerance { absolute: 0.001, relative: 0.005 };

    /// Reads the allowance back out of the sentence and checks that the verdict agrees with it.
    #[test]
    fn sentence_and_verdict_agree() {
        let mut seed = 7u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1u64 << 53) as f64
        };
        for _ in 0..2000 {
            let rule = Tolerance {
                absolute: plain(random() * 0.01).parse().unwrap(),
                relative: plain(random() * 0.02).parse().unwrap(),
            };
            let sentence = rule.sentence(ValueShape::Vector, "N", None);
            let percent: f64 = between(&sentence, "at most ", " % of").parse().unwrap();
            let absolute: f64 = between(&sentence, "plus ", " N.").parse().unwrap();
            let target = [random() * 20.0 - 10.0, random() * 20.0 - 10.0, 0.0];
            let length = norm(&target);
            let offset = random() * 0.4 - 0.2;
            let answer = [target[0], target[1], offset];
            let promised = offset.abs() <= percent / 100.0 * length + absolute;
            assert_eq!(rule.accepts(&answer, &target), promised, "{sentence} {answer:?} {target:?}");
        }
    }

    fn between<'a>(text: &'a str, before: &str, after: &str) -> &'a str {
        let start = text.find(before).unwrap() + before.len();
        &text[start..start + text[start..].find(after).unwrap()]
    }

    #[test]
    fn a_zero_component_is_judged_on_the_vectors_scale() {
        let target = [10.0, 0.0, 0.0];
        assert!(RULE.accepts(&[10.0, 0.05, 0.0], &target));
        assert!(!RULE.accepts(&[10.0, 0.052, 0.0], &target));
    }

    #[test]
    fn a_sign_is_never_stripped() {
        assert!(RULE.accepts(&[-9.81], &[-9.81]));
        assert!(!RULE.accepts(&[9.81], &[-9.81]));
    }

    #[test]
    fn the_digits_that_are_asked_for_are_enough() {
        for relative in [0.3, 0.05, 0.02, 0.01, 0.005, 0.001, 1e-4, 1e-6] {
            let rule = Tolerance { absolute: 0.0, relative };
            let digits = rule.digits().unwrap() as usize;
            for k in 0..400 {
                let target = libm::pow(10f64, f64::from(k) * 0.0171 - 3.0);
                let text = format!("{target:.*e}", digits - 1);
                let (written, _) = read(&text).unwrap();
                assert!(rule.accepts(&[written.value], &[target]), "{relative} {text} {target}");
            }
        }
    }

    #[test]
    fn sentence_of_a_number() {
        assert_eq!(
            RULE.sentence(ValueShape::Number, "N", None),
            "Right if it differs from ours by at most 0.5 % of our value plus 0.001 N. Give at least 3 significant digits."
        );
    }
}
