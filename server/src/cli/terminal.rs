//! Printing for people and for machines.

use std::io::{ErrorKind, IsTerminal, Write};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

/// How a command ended, if nothing was refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Outcome {
    /// Done.
    Done,
    /// Done, and the answer is no.
    No,
}

/// Prints a JSON document.
pub(super) fn print_json(value: &impl Serialize) {
    if let Ok(text) = serde_json::to_string_pretty(value) {
        print_line(&text);
    }
}

/// Whether standard output holds a file, which must stay what it is.
static TAKEN: AtomicBool = AtomicBool::new(false);

/// Prints lines to the standard error from now on.
pub(super) fn tell_on_stderr() {
    TAKEN.store(true, Ordering::Relaxed);
}

/// Why something could not be printed.
static LOST: OnceLock<String> = OnceLock::new();

/// Prints a line; a reader that has had enough (`| head`) is no error, and of any other see [`lost`].
pub(super) fn print_line(line: &str) {
    if TAKEN.load(Ordering::Relaxed) {
        tell(line);
        return;
    }
    let mut out = std::io::stdout();
    if let Err(error) = writeln!(out, "{line}").and_then(|()| out.flush())
        && error.kind() != ErrorKind::BrokenPipe
    {
        LOST.get_or_init(|| error.to_string());
    }
}

/// Why what was printed is not complete, if it is not.
pub(super) fn lost() -> Option<&'static str> {
    LOST.get().map(String::as_str)
}

/// Tells people a line beside what is printed.
pub(super) fn tell(line: &str) {
    drop(writeln!(std::io::stderr(), "{line}"));
}

/// `error:`, red where colours are shown.
pub(super) fn error_label() -> &'static str {
    let plain = std::env::var_os("NO_COLOR").is_some() || !std::io::stderr().is_terminal();
    if plain { "error:" } else { "\x1b[1;31merror:\x1b[0m" }
}

/// A bar that fills from 0 to `end` seconds of simulated time; hidden where nobody would see it.
pub(super) fn progress(name: &str, end: f64, hidden: bool) -> TimeBar {
    if hidden || !std::io::stderr().is_terminal() {
        return TimeBar { bar: ProgressBar::hidden(), end };
    }
    let bar = ProgressBar::new(SCALE);
    if let Ok(style) = ProgressStyle::with_template("{prefix} [{bar:40}] {msg} · {eta} left") {
        bar.set_style(style.progress_chars("━╸ "));
    }
    bar.set_prefix(name.to_owned());
    TimeBar { bar, end }
}

/// Resolution of the bar.
const SCALE: u64 = 10_000;

/// A bar of simulated time.
pub(super) struct TimeBar {
    bar: ProgressBar,
    end: f64,
}

impl TimeBar {
    /// Shows that the run has reached `time`.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub(super) fn reached(&self, time: f64) {
        if self.bar.is_hidden() {
            return;
        }
        let part = if self.end > 0.0 { (time / self.end).clamp(0.0, 1.0) } else { 1.0 };
        self.bar.set_position((part * SCALE as f64) as u64);
        self.bar.set_message(format!("{time:.2} of {} s", self.end));
    }
}

impl Drop for TimeBar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// "1 fault", "2 faults".
pub(super) fn counted(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}
