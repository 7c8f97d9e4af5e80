//! Long computations in Python: Ctrl-C ends them, and a function of the user's hears how far they are.

use pyo3::prelude::*;
use std::time::{Duration, Instant};

/// Time between two looks at the keyboard.
pub const LOOK: Duration = Duration::from_millis(50);

/// Who watches a computation.
pub struct Watcher<'a> {
    progress: Option<&'a Py<PyAny>>,
    looked: Instant,
}

impl<'a> Watcher<'a> {
    /// Begins; `progress` is called with how far it is and how far it goes.
    pub fn new(progress: Option<&'a Py<PyAny>>) -> Self {
        Self { progress, looked: Instant::now() }
    }

    /// Looks whether somebody wants it to end, now and then.
    pub fn look(&mut self, done: f64, all: f64) -> PyResult<()> {
        if self.looked.elapsed() < LOOK {
            return Ok(());
        }
        self.look_now(done, all)
    }

    /// The same at once.
    pub fn look_now(&mut self, done: f64, all: f64) -> PyResult<()> {
        self.looked = Instant::now();
        Python::attach(|py| {
            py.check_signals()?;
            self.progress.map_or(Ok(()), |told| told.call1(py, (done, all)).map(drop))
        })
    }
}
