//! Computing for callers, bounded: as much at a time as leaves the server a processor, and a short queue.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use axum::http::StatusCode;
use tokio::sync::Semaphore;
use triad_engine::analysis::Wanted;

use crate::aside;
use crate::problem::Problem;

/// Callers that may wait for a place. At some tenths of a second each, the last waits longer than people do.
const WAITING: usize = 64;

/// Places for computing that callers wait for.
#[derive(Debug)]
pub struct Work {
    places: Arc<Semaphore>,
    waiting: AtomicUsize,
}

impl Default for Work {
    fn default() -> Self {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        Self {
            places: Arc::new(Semaphore::new(cores.saturating_sub(1).max(1))),
            waiting: AtomicUsize::new(0),
        }
    }
}

impl Work {
    /// Callers that wait for a place.
    pub fn waiting(&self) -> usize {
        self.waiting.load(Ordering::Relaxed)
    }

    /// Runs `work` on a thread that may block and lets verdicts go first, when its turn comes. A caller that leaves before has not
    /// asked; what one that leaves later began learns that it is no longer wanted, and keeps its place until it ends, so that no more
    /// is computed at a time however many come and go.
    ///
    /// Errors if too many wait already, and as `work` does.
    pub async fn run<T: Send + 'static>(
        &self,
        work: impl FnOnce(&Wanted) -> Result<T, Problem> + Send + 'static,
    ) -> Result<T, Problem> {
        let place = {
            let _waiting = Waiting::among(&self.waiting)?;
            Arc::clone(&self.places).acquire_owned().await.map_err(Problem::internal)?
        };
        let (_asker, wanted) = Asker::new();
        aside::run(move || {
            let _place = place;
            work(&wanted)
        })
        .await
    }
}

/// Who waits for something that is computed: it is wanted until they have it, or leave.
#[derive(Debug)]
pub struct Asker(Wanted);

impl Asker {
    /// Somebody who waits, and the word for those who compute.
    pub fn new() -> (Self, Wanted) {
        let wanted = Wanted::default();
        (Self(wanted.clone()), wanted)
    }
}

impl Drop for Asker {
    fn drop(&mut self) {
        self.0.no_longer();
    }
}

/// One of those who wait.
struct Waiting<'a>(&'a AtomicUsize);

impl<'a> Waiting<'a> {
    fn among(waiting: &'a AtomicUsize) -> Result<Self, Problem> {
        // Counted before it is looked at: many may come at once.
        let this = Self(waiting);
        if waiting.fetch_add(1, Ordering::Relaxed) < WAITING {
            return Ok(this);
        }
        Err(Problem::new(
            StatusCode::SERVICE_UNAVAILABLE,
            "too-much-work",
            format!("{WAITING} others wait for the server to compute"),
            "ask again in a few seconds, or compute on your own machine: triad --help",
        ))
    }
}

impl Drop for Waiting<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use tokio::time::timeout;

    use super::*;

    /// Ends a test that hangs, and decides nothing else.
    const HANG: Duration = Duration::from_mins(1);

    #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
    async fn so_many_compute_so_many_wait_and_the_others_are_sent_away() {
        let work = Arc::new(Work { places: Arc::new(Semaphore::new(1)), waiting: AtomicUsize::new(0) });
        let busy = Arc::new(AtomicUsize::new(0));
        let (finish, gate) = std::sync::mpsc::channel::<()>();
        let gate = Arc::new(std::sync::Mutex::new(gate));
        let asked: Vec<_> = (0..WAITING + 11)
            .map(|_| {
                let (work, busy, gate) = (Arc::clone(&work), Arc::clone(&busy), Arc::clone(&gate));
                tokio::spawn(async move {
                    let job = move |_: &Wanted| {
                        assert_eq!(busy.fetch_add(1, Ordering::SeqCst), 0, "one at a time");
                        gate.lock().expect("whole").recv().expect("a word");
                        busy.fetch_sub(1, Ordering::SeqCst);
                        Ok(())
                    };
                    work.run(job).await
                })
            })
            .collect();
        let sent_away = async {
            while asked.iter().filter(|task| task.is_finished()).count() < 10 {
                tokio::task::yield_now().await;
            }
        };
        timeout(HANG, sent_away).await.expect("some are sent away");
        (0..=WAITING).for_each(|_| finish.send(()).expect("somebody waits"));
        let mut refused = 0;
        for task in asked {
            if let Err(problem) = task.await.expect("ends") {
                assert_eq!(problem.code(), "too-much-work");
                refused += 1;
            }
        }
        assert_eq!(refused, 10);
        assert_eq!(work.waiting.load(Ordering::Relaxed), 0);
    }

    #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
    async fn who_leaves_gives_no_place_to_others_before_the_work_has_ended() {
        let work = Arc::new(Work { places: Arc::new(Semaphore::new(1)), waiting: AtomicUsize::new(0) });
        let (finish, gate) = std::sync::mpsc::channel::<()>();
        let (tell, begun) = tokio::sync::oneshot::channel();
        let busy = Arc::clone(&work);
        let first = tokio::spawn(async move {
            let job = move |wanted: &Wanted| {
                tell.send(wanted.clone()).expect("somebody listens");
                gate.recv().expect("a word");
                Ok(())
            };
            busy.run(job).await
        });
        let wanted = begun.await.expect("begins");
        assert!(wanted.is_still());
        first.abort();
        drop(first.await);
        assert!(!wanted.is_still(), "it is told");
        assert_eq!(work.places.available_permits(), 0, "it still computes");
        finish.send(()).expect("it waits");
        let next = timeout(HANG, work.run(|_| Ok(()))).await;
        next.expect("its place is free").expect("then it is the next one's turn");
        assert_eq!(work.places.available_permits(), 1);
    }
}
