//! Whether a run still gets anywhere.

/// Steps over which progress is judged, for each part that takes steps of its own.
const WINDOW: u64 = 100;
/// Steps that nobody can wait for.
const ENDLESS: f64 = 1e9;

/// A window that goes less than so many times as far as the one before it does not grow.
const GROWTH: f64 = 2.0;

/// How far the last steps have gone.
#[derive(Clone, Debug)]
pub(super) struct Progress {
    window: u64,
    steps: u64,
    /// Where the window began, and how far the one before it went, s: nothing before the first, which is not judged.
    mark: f64,
    before: f64,
}

impl Progress {
    /// From time t on, for a mechanism of so many parts.
    pub(super) fn new(t: f64, parts: usize) -> Self {
        Self { window: WINDOW * parts.max(1) as u64, steps: 0, mark: t, before: 0.0 }
    }

    /// Counts a step that ended at time t. Tells the size of steps if the rest of the run until `end` would need endlessly
    /// many of them, and they do not grow.
    pub(super) fn stalled(&mut self, t: f64, end: f64) -> Option<f64> {
        self.steps += 1;
        if self.steps < self.window {
            return None;
        }
        let gained = t - self.mark;
        let before = std::mem::replace(&mut self.before, gained);
        (self.steps, self.mark) = (0, t);
        // Of each part at least so many steps lie within the window.
        let step = gained / WINDOW as f64;
        (gained <= GROWTH * before && step * ENDLESS < end - t).then_some(step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shrinking_steps_stall_and_growing_or_sufficient_ones_do_not() {
        let run = |mut h: f64, factor: f64| {
            let (mut t, mut progress) = (0.0, Progress::new(0.0, 1));
            (0..2_000).find_map(|_| {
                t += h;
                h *= factor;
                progress.stalled(t, 10.0)
            })
        };
        assert!(run(1e-2, 0.8).is_some_and(|step| step < 1e-8));
        assert!(run(1e-12, 1.0).is_some());
        assert!(run(1e-13, 1.0005).is_some());
        assert_eq!(run(1e-12, 1.03), None);
        assert_eq!(run(1e-7, 1.0), None);
    }
}
