//! `triad grader`.

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use clap::Args;
use serde_json::json;
use tokio::runtime::Builder;

use super::course::grades::existing;
use super::logging::Log;
use super::serve::{admin_address, listen_aside};
use super::stops::Stops;
use super::terminal::{Outcome, counted, print_json, print_line};
use crate::api;
use crate::grader::{Grader, LEASE};
use crate::metrics::Metrics;
use crate::problem::Problem;
use crate::store::{Location, Store};

/// How long the end of the program waits for what is being graded.
const ENDING: Duration = Duration::from_secs(10);

#[derive(Debug, Args)]
pub(in crate::cli) struct Options {
    /// The gradebook: postgres://user@host/name, or the file of a server on this machine.
    #[arg(long, default_value = "triad.db", value_name = "DATABASE", env = "TRIAD_DATABASE")]
    database: Location,
    /// Submissions that are graded at a time; all processors if it is not given.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    slots: Option<u16>,
    /// Seconds after which another grader takes over what this one had, where it ends in the middle.
    #[arg(long, value_name = "S", default_value_t = LEASE.as_secs(), value_parser = clap::value_parser!(u64).range(1..=3600))]
    lease: u64,
    /// What is logged on the standard error.
    #[arg(long, default_value = "faults", value_name = "WHAT", env = "TRIAD_LOG")]
    pub(in crate::cli) log: Log,
    /// Address for counters (/metrics) and probes (/livez, /readyz), as 127.0.0.1:9464; a port alone is one of this machine.
    #[arg(long, value_name = "ADDRESS", value_parser = admin_address, env = "TRIAD_ADMIN_ADDRESS")]
    admin_address: Option<SocketAddr>,
    /// Tell how much waits and how much was put aside, and end.
    #[arg(long, conflicts_with_all = ["slots", "again"])]
    look: bool,
    /// Put what was put aside back into the queue, and end: after three starts that nobody finished.
    #[arg(long, conflicts_with = "slots")]
    again: bool,
}

/// Grades what waits until it is stopped.
pub(super) fn grader(options: &Options, json: bool) -> Result<Outcome, Problem> {
    let runtime = Builder::new_multi_thread().enable_all().build().map_err(Problem::internal)?;
    let done = runtime.block_on(async {
        let store = Store::at(existing(&options.database)?).await?;
        if options.again || options.look {
            return look(&store, options.again, json).await;
        }
        let processors = std::thread::available_parallelism().map_or(1, usize::from);
        let slots = options.slots.map_or(processors, usize::from);
        let lease = Duration::from_secs(options.lease);
        let (store, metrics) = (Arc::new(store), Arc::new(Metrics::default()));
        let admin = api::admin_of_grader(Arc::clone(&store), Arc::clone(&metrics));
        let admin = listen_aside(options.admin_address, admin).await?;
        let grader = Grader::new(store, Arc::default(), metrics, slots, lease);
        let stops = Stops::listen();
        print_line(&format!("Grades what waits in {}, {slots} at a time", options.database));
        tokio::select! {
            () = Arc::clone(&grader).run() => {}
            () = stops.next() => {}
        }
        drop(tokio::time::timeout(ENDING, grader.finish(slots)).await);
        if let Some(admin) = admin {
            admin.abort();
        }
        Ok(Outcome::Done)
    });
    runtime.shutdown_background();
    done
}

async fn look(store: &Store, again: bool, json: bool) -> Result<Outcome, Problem> {
    let moved = if again { store.grade_again().await? } else { 0 };
    let (waiting, aside) = store.gradings().await?;
    if json {
        print_json(&json!({"waiting": waiting, "aside": aside, "again": moved}));
    } else {
        let count = |n: i64| counted(usize::try_from(n).unwrap_or_default(), "submission");
        print_line(&format!("{} waiting or being graded, {} put aside", count(waiting), count(aside)));
    }
    Ok(Outcome::Done)
}
