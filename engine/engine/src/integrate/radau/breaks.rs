//! Steps that end where a prescribed function goes on by another piece: it is smooth only between such breaks.

use super::Radau;
use crate::integrate::step::RARE_BREAKS;
use triad_dynamics::ode::OdeSystem;

/// Least part of a refused step that ends at a break within it.
const LEAST: f64 = 0.1;

impl Radau {
    /// Where the next step of a run to `end`, which may be a break, ends at the latest, if breaks are rare.
    pub(super) fn end_at_rare_break(&mut self, system: &impl OdeSystem, end: f64) -> f64 {
        self.stages.latest = f64::INFINITY;
        let first = system.next_break(self.last.t);
        let rare = system.next_break(first) - first >= RARE_BREAKS * self.h;
        let ends = first == end || rare && first < end.min(self.last.t + self.h);
        if ends && !self.fixed { self.end_at(first) } else { end }
    }

    /// After a refused step of size h of a run to `end`: whether the next try ends at a break within it, as one that is `by` times as long would
    /// not even come there. Later steps may be as long as the refused one.
    pub(super) fn ends_at_break(
        &mut self,
        system: &impl OdeSystem,
        (h, by): (f64, f64),
        end: &mut f64,
    ) -> bool {
        let next = system.next_break(self.last.t);
        let part = (next - self.last.t) / h;
        let ends = !self.fixed && next < *end && (LEAST.max(by)..1.0).contains(&part);
        if ends {
            self.last.steps.rejected += 1;
            *end = self.end_at(next);
        }
        ends
    }

    /// The stage there belongs to what is before.
    fn end_at(&mut self, next: f64) -> f64 {
        self.stages.latest = next.next_down();
        next
    }
}
