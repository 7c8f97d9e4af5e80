//! Bytes that are kept of live runs, counted by those who keep them.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// All bytes together.
#[derive(Debug, Clone, Default)]
pub struct Total(Arc<AtomicUsize>);

impl Total {
    /// How many there are now.
    pub fn bytes(&self) -> usize {
        self.0.load(Ordering::Relaxed)
    }

    /// Nothing yet, for somebody who is to keep some.
    pub fn part(&self) -> Part {
        Part { total: self.clone(), bytes: 0 }
    }
}

/// What one keeps; it is given back as it is dropped.
#[derive(Debug, Default)]
pub struct Part {
    total: Total,
    bytes: usize,
}

impl Part {
    /// So many are kept now.
    pub fn set(&mut self, bytes: usize) {
        self.total.0.fetch_add(bytes, Ordering::Relaxed);
        self.total.0.fetch_sub(self.bytes, Ordering::Relaxed);
        self.bytes = bytes;
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        self.set(0);
    }
}
