//! How long a command took, part by part.

use std::time::Instant;

use serde::ser::{Serialize, SerializeMap, Serializer};

/// Times of the parts of a command, in the order in which they were first met.
///
/// In JSON an object of seconds: each part by its name, and their `total` from the start to now.
#[derive(Debug, Clone)]
pub(super) struct Clock {
    started: Instant,
    lap: Instant,
    parts: Vec<(&'static str, f64)>,
}

impl Clock {
    /// Starts.
    pub(super) fn start() -> Self {
        let now = Instant::now();
        Self { started: now, lap: now, parts: Vec::new() }
    }

    /// Counts the time since the last call, or since the start, to a part.
    pub(super) fn lap(&mut self, part: &'static str) {
        let now = Instant::now();
        let seconds = (now - self.lap).as_secs_f64();
        self.lap = now;
        match self.parts.iter_mut().find(|(known, _)| *known == part) {
            Some((_, sum)) => *sum += seconds,
            None => self.parts.push((part, seconds)),
        }
    }

    /// Since the start, s.
    pub(super) fn total(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }

    /// For people.
    pub(super) fn line(&self) -> String {
        let parts: Vec<String> =
            self.parts.iter().map(|(part, seconds)| format!("{part} {}", readable(*seconds))).collect();
        format!("  run time               {}: {}", readable(self.total()), parts.join(", "))
    }
}

impl Serialize for Clock {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.parts.len() + 1))?;
        for (part, seconds) in &self.parts {
            map.serialize_entry(part, seconds)?;
        }
        map.serialize_entry("total", &self.total())?;
        map.end()
    }
}

/// A time with a unit that suits it.
fn readable(seconds: f64) -> String {
    if seconds >= 1.0 { format!("{seconds:.2} s") } else { format!("{:.2} ms", seconds * 1e3) }
}

/// An answer, with the time that it took under `seconds`.
#[derive(Debug, serde::Serialize)]
pub(super) struct Timed<'a, T: Serialize> {
    /// The answer.
    #[serde(flatten)]
    pub answer: &'a T,
    /// What it took.
    pub seconds: &'a Clock,
}
