//! When a run is looked at.

/// Part of an interval by which rounding may put one of its multiples beside the end of a run, or beside its present time.
const SAME: f64 = 1e-6;
/// Part of a time by which rounding may put a sum of others beside it.
const SUMMED: f64 = 1e-12;

/// The times of the outputs of a run: the multiples of an interval from 0 on, and the end, which comes once although rounding may put
/// a multiple right before it.
///
/// ```
/// use triad_scene::OutputTimes;
///
/// let times = OutputTimes::new(0.3, 0.9);
/// assert_eq!([0, 1, 2, 3, 4].map(|index| times.at(index)), [0.0, 0.3, 0.6, 0.9, 0.9]);
/// assert_eq!((times.intervals(), OutputTimes::new(0.4, 0.9).intervals()), (3.0, 3.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutputTimes {
    every: f64,
    end: f64,
}

impl OutputTimes {
    /// Those of a run from 0 to `end`, s, at intervals of `every`, s.
    pub fn new(every: f64, end: f64) -> Self {
        Self { every, end }
    }

    /// How many intervals lie between them, the last of which may be shorter than the others; one where `every` is no interval, which
    /// the check of a scene refuses.
    pub fn intervals(&self) -> f64 {
        let count = (self.end / self.every - SAME).ceil();
        if self.every > 0.0 { count.max(1.0) } else { 1.0 }
    }

    /// The time of an output, s, counted from 0 on; the end for those that are beyond it.
    pub fn at(&self, index: usize) -> f64 {
        self.nth(index as f64)
    }

    /// The last of them that time t, s, has reached; those that rounding puts right behind it are reached.
    pub fn reached(&self, t: f64) -> f64 {
        self.nth(self.count(t))
    }

    /// The first of them that time t, s, has not reached; the end if there is none.
    pub fn after(&self, t: f64) -> f64 {
        self.nth(self.count(t) + 1.0)
    }

    /// The time that is meant by the sum t of others, s: one of them where only rounding lies between.
    pub fn meant(&self, t: f64) -> f64 {
        let reached = self.reached(t);
        if (reached - t).abs() <= SUMMED * t { reached } else { t }
    }

    /// How many intervals t has reached the end of.
    fn count(&self, t: f64) -> f64 {
        if t + SAME * self.every >= self.end { self.intervals() } else { (t / self.every + SAME).floor() }
    }

    fn nth(&self, index: f64) -> f64 {
        if index < self.intervals() { index * self.every } else { self.end }
    }
}
