//! `triad serve`.

use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;
use std::time::Duration;

use axum::http::StatusCode;
use clap::Args;
use tokio::net::TcpListener;
use triad_lessons::Course;

use super::terminal::{Outcome, print_line};
use crate::app::{App, REPORTS};
use crate::limits::Limits;
use crate::problem::Problem;
use crate::store::Store;

/// How long the end of the program waits for the gradebook.
const CLOSING: Duration = Duration::from_secs(5);

#[derive(Debug, Args)]
pub(in crate::cli) struct Serve {
    /// Address to listen at; 0.0.0.0 lets the whole network in.
    #[arg(long, default_value = "127.0.0.1")]
    pub(in crate::cli) host: IpAddr,
    /// Port to listen at; 0 takes any free one.
    #[arg(long, default_value_t = 8080)]
    pub(in crate::cli) port: u16,
    /// The gradebook; made if it is not there.
    #[arg(long, default_value = "triad.db", value_name = "PATH", env = "TRIAD_DATABASE")]
    pub(in crate::cli) database: PathBuf,
    /// Live simulations at a time.
    #[arg(long, default_value_t = 64, value_name = "N")]
    pub(in crate::cli) max_sessions: usize,
    /// Bodies that a live simulation may have.
    #[arg(long, default_value_t = 500, value_name = "N")]
    pub(in crate::cli) max_bodies: usize,
    /// The folder with the reports of `triad bench` and `triad stress`, shown at /bench and /stress.
    #[arg(long, default_value = REPORTS, value_name = "DIR")]
    pub(in crate::cli) reports: PathBuf,
    /// Lecture rooms at a time.
    #[arg(long, default_value_t = 16, value_name = "N")]
    pub(in crate::cli) max_rooms: usize,
    /// Followers of one lecture.
    #[arg(long, default_value_t = 500, value_name = "N")]
    pub(in crate::cli) max_followers: usize,
}

impl Default for Serve {
    fn default() -> Self {
        Self {
            host: IpAddr::from([127, 0, 0, 1]),
            port: 8080,
            database: "triad.db".into(),
            max_sessions: 64,
            max_bodies: 500,
            reports: REPORTS.into(),
            max_rooms: 16,
            max_followers: 500,
        }
    }
}

/// Serves until it is stopped.
pub(super) fn serve(options: &Serve, course: Course) -> Result<Outcome, Problem> {
    let limits = Limits {
        sessions: options.max_sessions,
        bodies: options.max_bodies,
        lectures: options.max_rooms,
        followers: options.max_followers,
        ..Limits::default()
    };
    let runtime =
        tokio::runtime::Builder::new_multi_thread().enable_all().build().map_err(Problem::internal)?;
    let served = runtime.block_on(async {
        let store = Store::open(&options.database).await?;
        listen(options, App::new(course, store, limits).with_reports(&options.reports)).await
    });
    // What still computes for callers that are gone is not waited for.
    runtime.shutdown_background();
    served.map(|()| Outcome::Done)
}

async fn listen(options: &Serve, app: App) -> Result<(), Problem> {
    let wanted = SocketAddr::new(options.host, options.port);
    let listener = TcpListener::bind(wanted).await.map_err(|error| {
        Problem::new(
            StatusCode::INTERNAL_SERVER_ERROR,
            "port-unavailable",
            format!("cannot listen at {wanted}: {error}"),
            "another program may use that port: choose one with --port, or --port 0 for any free one",
        )
    })?;
    let address = listener.local_addr().map_err(Problem::internal)?;
    print_line(&format!(
        "Triad is at http://{address}  ({} lessons; Ctrl-C stops it)",
        app.course.lessons().len()
    ));
    print_line(&format!("Submissions are kept in {}", options.database.display()));
    tokio::spawn(crate::api::keep_house(app.clone()));
    let (sessions, lectures) = (app.sessions.clone(), app.lectures.clone());
    // Open streams end with their sessions; otherwise they would keep the server up.
    let ending = move || {
        lectures.clear();
        sessions.clear();
    };
    let store = app.store.clone();
    crate::listen::serve(listener, crate::app(app), stopped, ending).await;
    // What is being written is finished; whoever hangs beyond that has not been answered.
    drop(tokio::time::timeout(CLOSING, store.close()).await);
    Ok(())
}

/// Waits for Ctrl-C, or for the system's request to end.
async fn stopped() {
    #[cfg(unix)]
    {
        use tokio::signal::unix::{SignalKind, signal};
        if let Ok(mut term) = signal(SignalKind::terminate()) {
            tokio::select! {
                _ = tokio::signal::ctrl_c() => {}
                _ = term.recv() => {}
            }
            return;
        }
    }
    drop(tokio::signal::ctrl_c().await);
}
