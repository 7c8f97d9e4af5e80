//! What a program of this machine holds: memory, threads, open files, on Linux.

use std::time::Duration;

/// A program at one moment.
#[derive(Debug, Clone, Copy)]
pub struct Vitals {
    /// Memory that it holds, MB.
    pub memory: f64,
    /// Its threads.
    pub threads: f64,
    /// Open files, connections among them.
    pub files: usize,
    /// Processor time that it has used.
    pub processor: Duration,
}

impl Vitals {
    /// Of the program with this number.
    pub fn of(id: u32) -> Self {
        let status = std::fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
        let number = |name: &str| {
            let line = status.lines().find(|line| line.starts_with(name)).unwrap_or_default();
            line.split_whitespace().nth(1).and_then(|text| text.parse().ok()).unwrap_or(f64::NAN)
        };
        let stat = std::fs::read_to_string(format!("/proc/{id}/stat")).unwrap_or_default();
        // After the name in brackets; times in hundredths of a second are the 12th and 13th from there.
        let after = stat.rsplit(')').next().unwrap_or_default();
        let ticks: u64 =
            after.split_whitespace().skip(11).take(2).filter_map(|text| text.parse::<u64>().ok()).sum();
        Self {
            memory: number("VmRSS:") / 1024.0,
            threads: number("Threads:"),
            files: std::fs::read_dir(format!("/proc/{id}/fd")).map_or(0, Iterator::count),
            processor: Duration::from_millis(10 * ticks),
        }
    }
}
