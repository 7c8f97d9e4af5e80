//! What lets others go first: runs that play, what is sent of them, analyses and regrades, beside verdicts and answers.

use std::future::Future;
use std::sync::OnceLock;

use tokio::runtime::{Builder, Handle, Runtime};
use tokio::sync::oneshot;

use crate::problem::Problem;

/// How much less such a thread counts than one that answers, in the system's own measure (nice): where 200 runs play on two
/// processors the runs become slower, and answers do not wait for them.
#[cfg(target_os = "linux")]
const LESS: i32 = 10;
/// The least that a thread can count.
#[cfg(target_os = "linux")]
const MOST: i32 = 19;

/// Lets those who answer go before this thread and those that it starts, where the system can. It stays so.
pub fn step_back() {
    #[cfg(target_os = "linux")]
    {
        use rustix::process::{getpid, getpriority_process, setpriority_process};
        // Those who answer count as the program was started.
        let others = getpriority_process(Some(getpid())).unwrap_or_default();
        let less = (others + LESS).clamp(LESS, MOST);
        setpriority_process(Some(rustix::thread::gettid()), less).unwrap_or_default();
    }
}

/// Runs work on a thread of its own that steps back: those of the runtime serve others afterwards, and could not step forward.
///
/// Errors if there is no thread, and as `work` does.
pub async fn run<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, Problem> + Send + 'static,
) -> Result<T, Problem> {
    let (tell, told) = oneshot::channel();
    // What is logged there belongs to the request that asked for it.
    let (runtime, request) = (Handle::current(), tracing::Span::current());
    let thread = std::thread::Builder::new().name("triad-aside".into());
    let begun = thread.spawn(move || {
        let _runtime = runtime.enter();
        step_back();
        drop(tell.send(request.in_scope(work)));
    });
    begun.map_err(Problem::internal)?;
    told.await.map_err(Problem::internal)?
}

/// Threads that step back, for what is sent to those who watch; none before somebody does.
#[derive(Debug, Default)]
pub struct Streams(OnceLock<Option<Runtime>>);

impl Streams {
    /// Serves a watcher there. Where there are no threads for it, among the answers.
    pub fn serve(&self, watcher: impl Future<Output = ()> + Send + 'static) {
        let make = || {
            Builder::new_multi_thread()
                .thread_name("triad-stream")
                .on_thread_start(step_back)
                .enable_all()
                .build()
        };
        match self.0.get_or_init(|| make().ok()) {
            Some(runtime) => drop(runtime.spawn(watcher)),
            None => drop(tokio::spawn(watcher)),
        }
    }
}

impl Drop for Streams {
    fn drop(&mut self) {
        // Who still watches is not waited for: it may be the server itself that ends.
        if let Some(runtime) = self.0.take().flatten() {
            runtime.shutdown_background();
        }
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[tokio::test]
    async fn what_runs_aside_counts_less_and_the_others_as_before() {
        let own = || rustix::process::getpriority_process(Some(rustix::thread::gettid())).ok();
        let before = own().expect("a priority");
        let aside = run(move || Ok(own())).await.expect("runs").expect("a priority");
        assert_eq!((aside, own()), ((before + LESS).clamp(LESS, 19), Some(before)));
        let (streams, (tell, told)) = (Streams::default(), oneshot::channel());
        streams.serve(async move { tell.send(own()).expect("somebody listens") });
        assert_eq!(told.await.expect("serves"), Some(aside));
        let broken = run(|| -> Result<(), Problem> { std::panic::panic_any(()) }).await;
        assert_eq!(broken.expect_err("says so").code(), "internal");
    }
}
