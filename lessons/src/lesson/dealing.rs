//! Numbers that students have already stay theirs when the lesson is mended.
//!
//! Which draws are refused depends on all answers that a lesson knows: with one misconception more, a few students would get other
//! numbers in the middle of their work, and what they handed in would be judged by them. So a lesson can carry the version that
//! dealt. Numbers are drawn by that one, and judged by this.

use std::sync::Arc;

use super::content::Lesson;
use super::variant::starts;

impl Lesson {
    /// The same lesson, dealing as an earlier version of it did. Nothing changes where that one is this version, or deals from
    /// other ranges or pools: numbers are dealt anew then, as the author wants.
    #[must_use]
    pub fn dealing_as(&self, earlier: &Self) -> Self {
        let dealer = earlier.dealer.clone().unwrap_or_else(|| Arc::new(earlier.clone()));
        let is_another = dealer.hash != self.hash && self.deals_from_the_same(&dealer);
        Self { dealer: is_another.then_some(dealer), ..self.clone() }
    }

    /// Whether another version of this lesson draws its numbers from the same ranges, and questions from as large pools.
    pub fn deals_from_the_same(&self, other: &Self) -> bool {
        let (own, other_file) = (&self.sources.exercise, &other.sources.exercise);
        self.slug == other.slug && own.parameters == other_file.parameters && own.draw == other_file.draw
    }

    /// Fingerprint of the version that deals.
    pub fn dealer_hash(&self) -> &str {
        self.dealer.as_ref().map_or(&self.hash, |dealer| &dealer.hash)
    }

    /// The lesson with the numbers that an earlier version deals, unless there is none or its numbers cannot be used any more.
    pub(super) fn dealt(&self, seed: &str) -> Option<Self> {
        let numbers = self.dealer.as_ref()?.drawn(seed).ok()?.parameters;
        self.with(numbers).ok().filter(|lesson| starts(&lesson.scene).is_ok())
    }
}
