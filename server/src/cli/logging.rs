//! The log of the server, on the standard error: a service manager keeps it.

use std::io;

use clap::ValueEnum;
use tracing::level_filters::LevelFilter;
use tracing_subscriber::Layer;
use tracing_subscriber::filter::Targets;
use tracing_subscriber::fmt::layer;
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::util::SubscriberInitExt;

/// What is logged, and how.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Log {
    /// The server's own faults, as text.
    #[default]
    Faults,
    /// Each request and grading besides, as text.
    Text,
    /// The same, one JSON object a line.
    Json,
}

/// Begins the log of this process. Other libraries' words are left out: they may quote what they were given.
pub(in crate::cli) fn start(log: Log) {
    let level = if log == Log::Faults { LevelFilter::ERROR } else { LevelFilter::INFO };
    let ours = Targets::new().with_target("triad", level);
    let layer = match log {
        Log::Faults | Log::Text => {
            layer().with_writer(io::stderr).with_target(false).with_ansi(false).boxed()
        }
        Log::Json => {
            let json = json_subscriber::fmt::layer().with_writer(io::stderr).with_target(false);
            json.flatten_event(true).with_current_span(true).with_span_list(false).boxed()
        }
    };
    // For all layers: a filter of one forgets lines and spans where a library asks whether its own would be written (sqlx does).
    // A second log of one process would be a mistake of this program; the first one stays.
    drop(tracing_subscriber::registry().with(ours).with(layer).try_init());
}
