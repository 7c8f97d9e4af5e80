//! Pieces that one thread fills, as many as there may be work on, and one at a time takes in the order in which they were filled.
//!
//! The thread that fills them goes on meanwhile; where it is too far ahead it works as the others do. So there are never more threads than were
//! allowed, nor more pieces than a few for each of them.

use std::collections::{BTreeMap, VecDeque};
use std::io;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

/// Pieces for each thread: one that it works on, and some that wait for it or for their turn.
const PIECES: usize = 4;

/// What is done with a piece, by any thread.
pub(super) trait Work: Clone + Send + 'static {
    /// A piece; those that were taken are filled again.
    type Piece: Default + Send + 'static;

    /// Works on a piece. What comes of it must depend on the piece alone.
    fn work(&mut self, piece: &mut Self::Piece);
}

/// Where pieces go.
pub(super) trait Take<P>: Send + 'static {
    /// Takes the next one.
    fn take(&mut self, piece: &P) -> io::Result<()>;
}

/// The pieces between their being filled and their being taken.
pub(super) struct InOrder<W: Work, T> {
    /// The work of the thread that fills.
    own: W,
    threads: usize,
    /// Threads that were started beside this one.
    others: usize,
    shared: Arc<Shared<W::Piece, T>>,
}

struct Shared<P, T> {
    line: Mutex<Line<P, T>>,
    /// There is something to work on, or nothing will come any more.
    work: Condvar,
    /// A piece was taken, or there is something to work on.
    taken: Condvar,
}

struct Line<P, T> {
    /// Pieces to be worked on, with their numbers.
    waiting: VecDeque<(u64, P)>,
    /// Those that wait for their turn.
    worked_on: BTreeMap<u64, P>,
    /// Pieces that are filled again.
    empty: Vec<P>,
    /// How many were filled, and how many taken.
    filled: u64,
    taken: u64,
    /// None while a thread takes a piece.
    taker: Option<T>,
    /// The first error of a piece that could not be taken: no other is taken after it.
    error: Option<io::Error>,
    failed: bool,
    /// Threads that wait for work.
    idle: usize,
    closed: bool,
    /// Whether a thread has panicked.
    lost: bool,
}

impl<P, T: Take<P>> Shared<P, T> {
    fn lock(&self) -> MutexGuard<'_, Line<P, T>> {
        self.line.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait<'a>(on: &Condvar, line: MutexGuard<'a, Line<P, T>>) -> MutexGuard<'a, Line<P, T>> {
        on.wait(line).unwrap_or_else(PoisonError::into_inner)
    }

    /// Lets a piece be taken, and those after it that wait for it: by this thread, or by the one that takes another just now.
    fn hand_on(&self, number: u64, piece: P) {
        let mut line = self.lock();
        line.worked_on.insert(number, piece);
        while let Some(mut taker) = line.taker.take() {
            let next = line.taken;
            let Some(piece) = line.worked_on.remove(&next) else {
                line.taker = Some(taker);
                break;
            };
            let failed = line.failed;
            drop(line);
            let taken = if failed { Ok(()) } else { taker.take(&piece) };
            line = self.lock();
            line.taker = Some(taker);
            line.taken += 1;
            line.empty.push(piece);
            if let Err(error) = taken {
                (line.error, line.failed) = (Some(error), true);
            }
            self.taken.notify_one();
        }
    }
}

/// Tells the others if its thread panics.
struct Watch<'a, P, T: Take<P>>(&'a Shared<P, T>);

impl<P, T: Take<P>> Drop for Watch<'_, P, T> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.lock().lost = true;
            self.0.taken.notify_one();
        }
    }
}

impl<W: Work, T: Take<W::Piece>> InOrder<W, T> {
    /// With so many threads, this one included. The others are started when there is work for them.
    pub fn new(threads: usize, own: W, taker: T) -> Self {
        let line = Line {
            waiting: VecDeque::new(),
            worked_on: BTreeMap::new(),
            empty: Vec::new(),
            filled: 0,
            taken: 0,
            taker: Some(taker),
            error: None,
            failed: false,
            idle: 0,
            closed: false,
            lost: false,
        };
        let shared = Shared { line: Mutex::new(line), work: Condvar::new(), taken: Condvar::new() };
        Self { own, threads, others: 0, shared: Arc::new(shared) }
    }

    /// Hands a filled piece over, and returns one to fill. An error is that of a piece before it.
    pub fn push(&mut self, piece: W::Piece) -> io::Result<W::Piece> {
        let waiting = self.add(piece);
        if waiting > self.shared.lock().idle && self.others + 1 < self.threads {
            self.start();
        }
        self.go_on_until(if self.threads > 1 { PIECES * self.threads } else { 1 })
    }

    /// Adds a piece, and returns how many wait.
    fn add(&self, piece: W::Piece) -> usize {
        let mut line = self.shared.lock();
        let number = line.filled;
        line.filled += 1;
        line.waiting.push_back((number, piece));
        self.shared.work.notify_one();
        line.waiting.len()
    }

    /// Works until fewer pieces than these are under way, and returns one that can be filled.
    fn go_on_until(&mut self, fewer: usize) -> io::Result<W::Piece> {
        loop {
            let mut line = self.shared.lock();
            if line.lost {
                return Err(io::Error::other("a thread that writes rows has failed"));
            }
            if line.filled - line.taken < fewer as u64 {
                let empty = line.empty.pop().unwrap_or_default();
                return line.error.take().map_or(Ok(empty), Err);
            }
            let Some((number, mut piece)) = line.waiting.pop_front() else {
                drop(Shared::wait(&self.shared.taken, line));
                continue;
            };
            drop(line);
            self.own.work(&mut piece);
            self.shared.hand_on(number, piece);
        }
    }

    /// Starts another thread; where there can be none, those that are there do its work.
    fn start(&mut self) {
        let (shared, mut own) = (Arc::clone(&self.shared), self.own.clone());
        let other = thread::Builder::new().name("rows".to_owned()).spawn(move || {
            let _watch = Watch(&*shared);
            let mut line = shared.lock();
            loop {
                if let Some((number, mut piece)) = line.waiting.pop_front() {
                    drop(line);
                    own.work(&mut piece);
                    shared.hand_on(number, piece);
                    line = shared.lock();
                } else if line.closed {
                    return;
                } else {
                    line.idle += 1;
                    line = Shared::wait(&shared.work, line);
                    line.idle -= 1;
                }
            }
        });
        match other {
            Ok(_) => self.others += 1,
            Err(_) => self.threads = self.others + 1,
        }
    }

    /// Hands a last piece over, waits until all are taken, and returns what has taken them.
    pub fn finish(mut self, last: W::Piece) -> io::Result<T> {
        self.add(last);
        self.go_on_until(1)?;
        let taker = self.shared.lock().taker.take();
        taker.ok_or_else(|| io::Error::other("rows are still being written"))
    }
}

/// Lets the other threads end.
impl<W: Work, T> Drop for InOrder<W, T> {
    fn drop(&mut self) {
        self.shared.line.lock().unwrap_or_else(PoisonError::into_inner).closed = true;
        self.shared.work.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// A number, of which many are added up.
    struct Sum {
        upto: u64,
        sum: u64,
    }

    const FIRST: u64 = 1000;
    static MADE: AtomicUsize = AtomicUsize::new(0);

    impl Default for Sum {
        fn default() -> Self {
            MADE.fetch_add(1, Ordering::Relaxed);
            Self { upto: 0, sum: 0 }
        }
    }

    /// Knows how many pieces were worked on, by all threads.
    #[derive(Clone)]
    struct Add(Arc<AtomicUsize>);

    impl Work for Add {
        type Piece = Sum;

        fn work(&mut self, piece: &mut Sum) {
            // The first piece is ready after others.
            while piece.upto == FIRST && self.0.load(Ordering::Relaxed) < 2 {
                thread::yield_now();
            }
            piece.sum = (0..piece.upto).sum();
            self.0.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Takes so many.
    struct Sums(Vec<u64>, usize);

    impl Take<Sum> for Sums {
        fn take(&mut self, piece: &Sum) -> io::Result<()> {
            if self.0.len() == self.1 {
                return Err(io::Error::other("full"));
            }
            self.0.push(piece.sum);
            Ok(())
        }
    }

    fn taken(threads: usize, most: usize) -> io::Result<Vec<u64>> {
        let worked_on = Arc::new(AtomicUsize::new(if threads == 1 { 2 } else { 0 }));
        let mut line = InOrder::new(threads, Add(worked_on), Sums(Vec::new(), most));
        let mut piece = Sum { upto: 0, sum: 0 };
        for number in 0..200 {
            piece.upto = FIRST + number;
            piece = line.push(piece)?;
        }
        piece.upto = 1;
        line.finish(piece).map(|sums| sums.0)
    }

    #[test]
    fn pieces_are_taken_in_order_and_are_few() {
        let alone = taken(1, 1000).unwrap();
        assert_eq!((alone.len(), alone[200]), (201, 0));
        for threads in [2, 3, 8] {
            let before = MADE.load(Ordering::Relaxed);
            assert_eq!(taken(threads, 1000).unwrap(), alone, "{threads} threads");
            let made = MADE.load(Ordering::Relaxed) - before;
            assert!(made <= PIECES * threads, "{made} pieces for {threads} threads");
        }
        for threads in [1, 3] {
            assert_eq!(taken(threads, 50).unwrap_err().to_string(), "full", "{threads} threads");
        }
    }

    /// Fails on every thread but the first.
    #[derive(Clone)]
    struct Fails;

    impl Work for Fails {
        type Piece = ();

        fn work(&mut self, (): &mut ()) {
            assert_ne!(thread::current().name(), Some("rows"));
        }
    }

    impl Take<()> for Fails {
        fn take(&mut self, (): &()) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_thread_that_fails_is_told() {
        let mut line = InOrder::new(2, Fails, Fails);
        let error = loop {
            if let Err(error) = line.push(()) {
                break error;
            }
        };
        assert!(error.to_string().contains("has failed"), "{error}");
    }
}
