//! The workbench: command line, HTTP interface, live sessions, viewer stream and gradebook.
//!
//! Mechanics live in `triad_engine`, grading in `triad_lessons`; this crate only carries what they say. In reading
//! order: errors and bounds, the parts, then the two ways of use.

#![allow(clippy::missing_errors_doc)] // said in a sentence: the crate is no library for others

pub mod request;

pub mod problem;

pub mod limits;

pub mod policy;

pub mod scenes;
pub mod store;
pub mod stream;
pub mod table;
pub mod variants;

pub mod dealing;

pub mod metrics;

pub mod grading;
pub mod handing;

pub mod grader;

pub mod nodes;

pub mod aside;

pub mod session;

pub mod lecture;

pub mod live;

pub mod work;

pub mod motion;

pub mod access;
pub mod grades;

pub mod analysis;
pub mod glance;

pub mod regrade;

pub mod lti;
pub mod oidc;

pub mod app;

pub mod docs;
pub mod page;
pub mod reports;

pub mod api;

pub mod site;

mod listen;

pub mod cli;

use problem::Problem;

/// What was built of which sources for which machine: verdicts name what made them.
pub const BUILD: &str = env!("TRIAD_BUILD");

/// The server as one service; tests call it in process.
pub fn app(state: app::App) -> axum::Router {
    api::router(state)
}

/// What those who run the server ask, at an address of its own.
pub fn admin(state: app::App) -> axum::Router {
    api::admin(state)
}

/// Runs work that computes or waits for the disk on a thread that may block.
pub(crate) async fn blocking<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, Problem> + Send + 'static,
) -> Result<T, Problem> {
    // What is logged there belongs to the request that asked for it.
    let request = tracing::Span::current();
    tokio::task::spawn_blocking(move || request.in_scope(work)).await.map_err(Problem::internal)?
}
