//! One recording, kept once, watched by many.
//!
//! A watcher holds no queue: only its place in the recording. One that is slow, or stands still, costs
//! nothing and harms nobody; it reads on from its place when it can. What is oldest is forgotten where the recording
//! grows beyond its bound: a run is never stopped because it is watched.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use axum::body::Bytes;
use tokio::sync::watch;

/// The encoded recording of a session: complete RRD blocks, oldest first.
#[derive(Debug)]
pub struct Hub {
    recording: Mutex<RecordedBlocks>,
    /// Changes whenever the recording does.
    changed: watch::Sender<()>,
    watchers: AtomicUsize,
    limit: usize,
}

#[derive(Debug, Default)]
struct RecordedBlocks {
    /// Counts the recordings: a reset starts another.
    epoch: u64,
    /// The first block: layout and shapes, without which the others show nothing.
    head: Option<Bytes>,
    /// The blocks after it that are kept.
    tail: VecDeque<Bytes>,
    /// Blocks that were forgotten between head and tail.
    forgotten: usize,
    bytes: usize,
}

impl Hub {
    /// No recording yet; at most about `limit` bytes of it are kept.
    pub fn new(limit: usize) -> Self {
        Self {
            recording: Mutex::default(),
            changed: watch::Sender::new(()),
            watchers: AtomicUsize::new(0),
            limit,
        }
    }

    /// Adds a block for everybody, now and later. The first of a recording is kept for good.
    pub fn push(&self, block: Vec<u8>) {
        let mut recording = self.lock();
        recording.bytes += block.len();
        if recording.head.is_none() {
            recording.head = Some(block.into());
        } else {
            recording.tail.push_back(block.into());
        }
        // The newest stays, however large.
        while recording.bytes > self.limit && recording.tail.len() > 1 {
            let oldest = recording.tail.pop_front().map_or(0, |block| block.len());
            recording.bytes -= oldest;
            recording.forgotten += 1;
        }
        drop(recording);
        self.changed.send_replace(());
    }

    /// Forgets the recording; watchers learn that another one begins.
    pub fn restart(&self) {
        let mut recording = self.lock();
        *recording = RecordedBlocks { epoch: recording.epoch + 1, ..RecordedBlocks::default() };
        drop(recording);
        self.changed.send_replace(());
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.lock().bytes
    }

    /// How many watch now.
    pub fn watchers(&self) -> usize {
        self.watchers.load(Ordering::Relaxed)
    }

    /// Starts watching from the beginning of the recording.
    pub fn watch(self: &Arc<Self>) -> Watcher {
        self.watchers.fetch_add(1, Ordering::Relaxed);
        let epoch = self.lock().epoch;
        Watcher { changed: self.changed.subscribe(), hub: Arc::clone(self), epoch, next: 0 }
    }

    fn lock(&self) -> MutexGuard<'_, RecordedBlocks> {
        // Every change is a single push or assignment, so a panic elsewhere leaves nothing half-done.
        self.recording.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What a watcher receives.
#[derive(Debug, PartialEq, Eq)]
pub enum Delivery {
    /// The next blocks, each complete in itself.
    Blocks(Vec<Bytes>),
    /// The recording was replaced: forget what was delivered.
    Restarted,
}

/// A place in a recording.
#[derive(Debug)]
pub struct Watcher {
    hub: Arc<Hub>,
    changed: watch::Receiver<()>,
    epoch: u64,
    next: usize,
}

impl Watcher {
    /// What there is now, if anything, without waiting.
    pub fn poll(&mut self) -> Option<Delivery> {
        let recording = self.hub.lock();
        if recording.epoch != self.epoch {
            self.epoch = recording.epoch;
            self.next = 0;
            return Some(Delivery::Restarted);
        }
        let head = recording.head.iter().filter(|_| self.next == 0);
        let seen = self.next.saturating_sub(1 + recording.forgotten);
        let blocks: Vec<Bytes> = head.chain(recording.tail.iter().skip(seen)).cloned().collect();
        self.next = usize::from(recording.head.is_some()) + recording.forgotten + recording.tail.len();
        (!blocks.is_empty()).then_some(Delivery::Blocks(blocks))
    }

    /// Waits for what comes next; `None` once the session is gone.
    pub async fn next(&mut self) -> Option<Delivery> {
        loop {
            self.changed.borrow_and_update();
            if let Some(delivery) = self.poll() {
                return Some(delivery);
            }
            self.changed.changed().await.ok()?;
        }
    }
}

impl Drop for Watcher {
    fn drop(&mut self) {
        self.hub.watchers.fetch_sub(1, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_late_watcher_gets_the_whole_recording_and_a_slow_one_catches_up() {
        let hub = Arc::new(Hub::new(1000));
        let mut slow = hub.watch();
        hub.push(vec![1]);
        hub.push(vec![2]);
        let mut late = hub.watch();
        let both = Some(Delivery::Blocks(vec![Bytes::from_static(&[1]), Bytes::from_static(&[2])]));
        assert_eq!(late.poll(), both);
        assert_eq!(late.poll(), None);
        assert_eq!(slow.poll(), both);
        assert_eq!((hub.watchers(), hub.bytes()), (2, 2));
        drop(late);
        assert_eq!(hub.watchers(), 1);
    }

    #[test]
    fn the_oldest_blocks_but_the_first_are_forgotten_and_nobody_gets_one_twice() {
        let hub = Arc::new(Hub::new(4));
        let mut slow = hub.watch();
        let mut quick = hub.watch();
        let mut got = Vec::new();
        for k in 0..10 {
            hub.push(vec![k]);
            if let Some(Delivery::Blocks(blocks)) = quick.poll() {
                got.extend(blocks.iter().map(|block| block[0]));
            }
        }
        assert_eq!(got, (0..10).collect::<Vec<u8>>());
        let kept = [0, 7, 8, 9].map(|k: u8| Bytes::copy_from_slice(&[k]));
        assert_eq!(slow.poll(), Some(Delivery::Blocks(kept.to_vec())));
        assert_eq!((slow.poll(), hub.bytes()), (None, 4));
        hub.push(vec![0; 100]);
        assert_eq!(hub.bytes(), 101, "the newest stays");
    }

    #[test]
    fn a_restart_is_announced_once_and_the_old_blocks_are_gone() {
        let hub = Arc::new(Hub::new(1000));
        let mut watcher = hub.watch();
        hub.push(vec![1]);
        hub.restart();
        hub.push(vec![2]);
        assert_eq!(watcher.poll(), Some(Delivery::Restarted));
        assert_eq!(watcher.poll(), Some(Delivery::Blocks(vec![Bytes::from_static(&[2])])));
        assert_eq!(hub.bytes(), 1);
    }
}
