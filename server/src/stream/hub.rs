//! One recording, kept once, watched by many.
//!
//! A watcher holds no queue: only its place in the recording. One that is slow, or stands still, costs
//! nothing and harms nobody; it reads on from its place when it can. What is oldest is forgotten where the recording
//! grows beyond its bound, or told in brief: a run is never stopped because it is watched.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use axum::body::Bytes;
use tokio::sync::watch;

use super::total::Part;

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
    /// What stands for those that were forgotten, for who has not read them.
    brief: Option<Bytes>,
    /// The blocks after it that are kept.
    tail: VecDeque<Bytes>,
    /// Blocks that were forgotten between head and tail.
    forgotten: usize,
    /// Bytes of head and tail.
    bytes: usize,
    /// All bytes, among those of all runs.
    kept: Part,
}

impl RecordedBlocks {
    /// Forgets the oldest until there are no more bytes than so many; the newest stays, however large.
    fn forget(&mut self, most: usize) {
        while self.bytes > most && self.tail.len() > 1 {
            let oldest = self.tail.pop_front().map_or(0, |block| block.len());
            self.bytes -= oldest;
            self.forgotten += 1;
        }
        self.count();
    }

    fn count(&mut self) {
        self.kept.set(self.held());
    }

    fn held(&self) -> usize {
        self.bytes + self.brief.as_ref().map_or(0, Bytes::len)
    }
}

impl Hub {
    /// No recording yet; at most about `limit` bytes of it are kept, and what is told in brief; `kept` counts them.
    pub fn new(limit: usize, kept: Part) -> Self {
        Self {
            recording: Mutex::new(RecordedBlocks { kept, ..RecordedBlocks::default() }),
            changed: watch::Sender::new(()),
            watchers: AtomicUsize::new(0),
            limit,
        }
    }

    /// Adds a block for everybody, now and later. The first of a recording is kept for good.
    pub fn push(&self, block: Vec<u8>) {
        let mut recording = self.lock();
        recording.bytes += block.len();
        // Without the room that a growing list has ahead.
        let block = Bytes::from(block.into_boxed_slice());
        if recording.head.is_none() {
            recording.head = Some(block);
        } else {
            recording.tail.push_back(block);
        }
        recording.forget(self.limit);
        drop(recording);
        self.changed.send_replace(());
    }

    /// Whether so many bytes more would make it forget.
    pub fn is_full_with(&self, bytes: usize) -> bool {
        self.lock().bytes + bytes > self.limit
    }

    /// Forgets the older half. Whoever has not read it receives `brief` in its place, which tells all that was pushed so far.
    pub fn shorten(&self, brief: Vec<u8>) {
        let mut recording = self.lock();
        recording.brief = Some(brief.into_boxed_slice().into());
        recording.forget(self.limit / 2);
    }

    /// Forgets the recording; watchers learn that another one begins.
    pub fn restart(&self) {
        let mut recording = self.lock();
        let (epoch, kept) = (recording.epoch + 1, std::mem::take(&mut recording.kept));
        *recording = RecordedBlocks { epoch, kept, ..RecordedBlocks::default() };
        recording.count();
        drop(recording);
        self.changed.send_replace(());
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.lock().held()
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
        let brief = recording.brief.iter().filter(|_| self.next <= recording.forgotten);
        let seen = self.next.saturating_sub(1 + recording.forgotten);
        let blocks: Vec<Bytes> = head.chain(brief).chain(recording.tail.iter().skip(seen)).cloned().collect();
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
    use super::super::total::Total;
    use super::*;

    #[test]
    fn a_late_watcher_gets_the_whole_recording_and_a_slow_one_catches_up() {
        let hub = Arc::new(Hub::new(1000, Part::default()));
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
        let total = Total::default();
        let hub = Arc::new(Hub::new(4, total.part()));
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
        assert_eq!((hub.bytes(), total.bytes()), (101, 101), "the newest stays");
        drop((hub, slow, quick));
        assert_eq!(total.bytes(), 0, "given back");
    }

    #[test]
    fn what_is_forgotten_is_told_in_brief_to_who_has_not_read_it_and_to_nobody_else() {
        let total = Total::default();
        let hub = Arc::new(Hub::new(6, total.part()));
        let [mut quick, mut slow] = [hub.watch(), hub.watch()];
        (0..2).for_each(|k| hub.push(vec![k]));
        quick.poll();
        slow.poll();
        for k in 2..6 {
            hub.push(vec![k]);
            quick.poll();
        }
        assert!(hub.is_full_with(1) && !hub.is_full_with(0));
        hub.shorten(vec![60, 61]);
        let blocks = |wanted: &[&[u8]]| {
            Some(Delivery::Blocks(wanted.iter().map(|block| Bytes::copy_from_slice(block)).collect()))
        };
        assert_eq!((hub.bytes(), total.bytes()), (5, 5), "the first, two of the tail, the brief");
        assert_eq!(quick.poll(), None);
        hub.push(vec![6]);
        assert_eq!(quick.poll(), blocks(&[&[6]]));
        assert_eq!(slow.poll(), blocks(&[&[60, 61], &[4], &[5], &[6]]));
        assert_eq!(hub.watch().poll(), blocks(&[&[0], &[60, 61], &[4], &[5], &[6]]));
        assert_eq!(slow.poll(), None);
        hub.restart();
        assert_eq!((hub.bytes(), total.bytes()), (0, 0));
        hub.push(vec![7]);
        assert_eq!(hub.watch().poll(), blocks(&[&[7]]));
    }

    #[test]
    fn a_restart_is_announced_once_and_the_old_blocks_are_gone() {
        let hub = Arc::new(Hub::new(1000, Part::default()));
        let mut watcher = hub.watch();
        hub.push(vec![1]);
        hub.restart();
        hub.push(vec![2]);
        assert_eq!(watcher.poll(), Some(Delivery::Restarted));
        assert_eq!(watcher.poll(), Some(Delivery::Blocks(vec![Bytes::from_static(&[2])])));
        assert_eq!(hub.bytes(), 1);
    }
}
