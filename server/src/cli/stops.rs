//! What asks the program to end: Ctrl-C, or the system.

use std::sync::Arc;

use tokio::sync::Notify;

/// Requests to end, heard from the moment that this is made: one that comes while nobody waits is found by the next who does.
#[derive(Clone)]
pub(super) struct Stops(Arc<Notify>);

impl Stops {
    /// Listens from now on. To be made before anybody is told that the program runs, since the system ends a program
    /// that does not listen.
    pub(super) fn listen() -> Self {
        let stops = Self(Arc::default());
        let told = Arc::clone(&stops.0);
        #[cfg(unix)]
        {
            use tokio::signal::unix::{SignalKind, signal};
            for kind in [SignalKind::interrupt(), SignalKind::terminate()] {
                // Where the system gives no notice of it, it ends the program as it ends any other.
                let Ok(mut heard) = signal(kind) else { continue };
                let told = Arc::clone(&told);
                tokio::spawn(async move {
                    while heard.recv().await.is_some() {
                        told.notify_one();
                    }
                });
            }
        }
        #[cfg(not(unix))]
        tokio::spawn(async move {
            while tokio::signal::ctrl_c().await.is_ok() {
                told.notify_one();
            }
        });
        stops
    }

    /// Waits for the next request to end.
    pub(super) async fn next(self) {
        self.0.notified().await;
    }
}
