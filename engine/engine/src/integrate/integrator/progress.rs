//! Whether a run still gets anywhere.

/// Steps over which progress is judged, for each island of the mechanism.
const WINDOW: u64 = 100;
/// Steps still needed to the end of the run above which nobody can wait for it.
const ENDLESS: f64 = 1e9;
/// Ratio of the times gained in two successive windows above which steps are growing, and the run may recover.
const GROWTH: f64 = 2.0;

/// How far the last steps have gone.
#[derive(Clone, Debug)]
pub(super) struct ProgressMonitor {
    window: u64,
    steps: u64,
    /// Where the window began, s.
    window_start: f64,
    /// Time gained in the window before it, s; zero before the first window, which is not judged.
    before: f64,
}

impl ProgressMonitor {
    /// From time t on, for a mechanism of so many islands.
    pub(super) fn new(t: f64, islands: usize) -> Self {
        Self { window: WINDOW * islands.max(1) as u64, steps: 0, window_start: t, before: 0.0 }
    }

    /// A step was taken back to time t.
    pub(super) fn take_back(&mut self, t: f64) {
        self.steps = self.steps.saturating_sub(1);
        self.window_start = self.window_start.min(t);
    }

    /// Forgets the window at hand: from time t on the motion is searched by short steps.
    pub(super) fn restart(&mut self, t: f64) {
        (self.steps, self.window_start, self.before) = (0, t, 0.0);
    }

    /// Counts a step that ended at time t. Returns the mean size of steps, s, if the rest of the run until `end` would need
    /// more than [`ENDLESS`] of them and they are not growing.
    pub(super) fn stalled(&mut self, t: f64, end: f64) -> Option<f64> {
        self.steps += 1;
        if self.steps < self.window {
            return None;
        }
        let gained = t - self.window_start;
        let before = std::mem::replace(&mut self.before, gained);
        (self.steps, self.window_start) = (0, t);
        // Each island took at least about this many steps within the window.
        let step = gained / WINDOW as f64;
        (gained <= GROWTH * before && step * ENDLESS < end - t).then_some(step)
    }
}
