//! Turns: as many runs are computed at a time as there are processors, and the others stand in line.
//!
//! Where the runs of a class are more than a machine can compute, each is drawn less often and stays at its time; what is asked
//! of a run that waits for its turn is answered all the same.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{SyncSender, TrySendError};
use std::sync::{Arc, Weak};
use std::time::Duration;

use futures_util::FutureExt;
use tokio::runtime::Handle;
use tokio::sync::Semaphore;
use tokio::time::sleep;

use super::command::{Command, Signals, Turn};

/// How long a run waits for another turn that was too busy to hear of its own.
const BUSY: Duration = Duration::from_millis(20);

/// Who may compute, and who waits for it, in the order in which they came.
#[derive(Debug, Clone)]
pub(crate) struct Turns {
    places: Arc<Semaphore>,
    waiting: Arc<AtomicUsize>,
}

impl Default for Turns {
    fn default() -> Self {
        Self::of(std::thread::available_parallelism().map_or(1, usize::from))
    }
}

impl Turns {
    /// So many at a time.
    pub(crate) fn of(places: usize) -> Self {
        Self { places: Arc::new(Semaphore::new(places)), waiting: Arc::default() }
    }

    /// How many runs wait for their turn.
    pub(crate) fn waiting(&self) -> usize {
        self.waiting.load(Ordering::Relaxed)
    }

    /// A turn now, if nobody else waits for it.
    pub(super) fn now(&self) -> Option<Turn> {
        Arc::clone(&self.places).try_acquire_owned().ok().map(Turn)
    }

    /// Stands in line for a run that is told of its turn among its commands, if it still lives then. Needs the async runtime.
    pub(super) fn stand_in_line(&self, runtime: &Handle, run: Weak<SyncSender<Command>>) {
        let (turns, in_line, mut place) = (self.clone(), InLine::of(&self.waiting), self.place());
        runtime.spawn(async move {
            let _in_line = in_line;
            while let Some(turn) = place.await {
                let told = run.upgrade().map(|run| run.try_send(Command::Turn(turn)));
                let Some(Err(TrySendError::Full(back))) = told else { return };
                // So much is asked of it that it has no time to go on: others do meanwhile.
                drop(back);
                sleep(BUSY).await;
                place = turns.place();
            }
        });
    }

    /// A place in the line, from now on and not only from when it is first waited for.
    fn place(&self) -> impl Future<Output = Option<Turn>> + use<> {
        let mut place = Box::pin(Arc::clone(&self.places).acquire_owned().map(|place| place.ok().map(Turn)));
        let at_once = place.as_mut().now_or_never();
        async move {
            match at_once {
                Some(turn) => turn,
                None => place.await,
            }
        }
    }

    /// Waits in a run's thread for a turn; none if the run is interrupted before it comes.
    pub(super) fn wait(&self, runtime: &Handle, signals: &Signals) -> Option<Turn> {
        if let Some(turn) = self.now() {
            return Some(turn);
        }
        let _in_line = InLine::of(&self.waiting);
        runtime.block_on(async {
            let place = self.place();
            tokio::pin!(place);
            loop {
                if signals.interrupted() {
                    return None;
                }
                tokio::select! {
                    turn = &mut place => return turn,
                    () = signals.changed() => {}
                }
            }
        })
    }
}

/// One of those who wait.
struct InLine(Arc<AtomicUsize>);

impl InLine {
    fn of(waiting: &Arc<AtomicUsize>) -> Self {
        waiting.fetch_add(1, Ordering::Relaxed);
        Self(Arc::clone(waiting))
    }
}

impl Drop for InLine {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::{Receiver, sync_channel};

    use super::*;

    fn run(turns: &Turns) -> (Arc<SyncSender<Command>>, Receiver<Command>) {
        let (sender, commands) = sync_channel(1);
        let sender = Arc::new(sender);
        turns.stand_in_line(&Handle::current(), Arc::downgrade(&sender));
        (sender, commands)
    }

    fn turn(commands: &Receiver<Command>) -> Turn {
        let Ok(Command::Turn(turn)) = commands.recv_timeout(Duration::from_mins(1)) else {
            panic!("no turn")
        };
        turn
    }

    #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
    async fn turns_come_in_order_and_those_of_runs_that_ended_go_to_others() {
        let turns = Turns::of(1);
        let busy = turns.now().expect("free");
        assert!(turns.now().is_none());
        let waiters: Vec<_> = (0..3).map(|_| run(&turns)).collect();
        assert_eq!(turns.waiting(), 3);
        let mut waiters = waiters.into_iter();
        drop(waiters.next());
        drop(busy);
        let (_alive, commands) = waiters.next().expect("three");
        let second = tokio::task::spawn_blocking(move || turn(&commands)).await.expect("comes");
        let (_living, commands) = waiters.next().expect("three");
        assert!(commands.try_recv().is_err(), "one at a time");
        drop(second);
        drop(tokio::task::spawn_blocking(move || turn(&commands)).await.expect("comes"));
        while turns.waiting() > 0 {
            tokio::task::yield_now().await;
        }
        assert_eq!(turns.places.available_permits(), 1);
    }

    #[tokio::test(flavor = "multi_thread", worker_threads = 2)]
    async fn a_run_with_a_full_queue_holds_up_nobody_and_who_changes_its_mind_waits_no_longer() {
        let turns = Turns::of(1);
        let busy = turns.now().expect("free");
        let (sender, commands) = run(&turns);
        sender.try_send(Command::Watched).expect("it fits");
        drop(busy);
        let signals = Arc::new(Signals::default());
        let waits = || {
            let (turns, runtime, signals) = (turns.clone(), Handle::current(), Arc::clone(&signals));
            tokio::task::spawn_blocking(move || turns.wait(&runtime, &signals))
        };
        let taken = waits().await.expect("ends").expect("a turn");
        let second = waits();
        while turns.waiting() < 2 {
            tokio::task::yield_now().await;
        }
        signals.hurry();
        assert!(second.await.expect("ends").is_none());
        drop(taken);
        assert!(matches!(commands.recv(), Ok(Command::Watched)));
        drop(tokio::task::spawn_blocking(move || turn(&commands)).await.expect("comes"));
        drop(sender);
    }
}
