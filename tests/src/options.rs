//! What the program's help names, and what each of its answers must be.

use crate::program::triad;
use serde_json::Value;
use std::process::{Command, Stdio};

/// The help of a command, as the program prints it.
pub fn help(command: &str) -> String {
    let mut words: Vec<&str> = command.split_whitespace().collect();
    words.push("--help");
    let output = Command::new(triad()).args(&words).env("COLUMNS", "120").output().unwrap();
    String::from_utf8(output.stdout).unwrap()
}

/// Names of the subcommands that a help text lists.
pub fn subcommands(help: &str) -> Vec<String> {
    let list = help.split("\nCommands:\n").nth(1).unwrap_or_default();
    let lines = list.lines().take_while(|line| !line.is_empty());
    let names =
        lines.filter_map(|line| line.strip_prefix("  ")?.split(' ').next()).filter(|name| !name.is_empty());
    names.filter(|name| *name != "help").map(str::to_owned).collect()
}

/// All commands, those of commands behind them.
pub fn commands() -> Vec<String> {
    let mut all = Vec::new();
    for command in subcommands(&help("")) {
        let inner = subcommands(&help(&command));
        if inner.is_empty() {
            all.push(command);
        } else {
            all.extend(inner.into_iter().map(|inner| format!("{command} {inner}")));
        }
    }
    all
}

/// The long options of a command, as its help lists them; not `--help` and `--version`.
pub fn options(command: &str) -> Vec<String> {
    let help = help(command);
    let listed = help.lines().filter_map(|line| {
        let line = line.trim_start();
        let long = line
            .strip_prefix("--")
            .or_else(|| line.get(4..)?.strip_prefix("--").filter(|_| line.starts_with('-')))?;
        let end = long.find(|c: char| !(c.is_ascii_alphanumeric() || c == '-')).unwrap_or(long.len());
        Some(format!("--{}", &long[..end]))
    });
    let mut found: Vec<String> = listed.filter(|o| o != "--help" && o != "--version").collect();
    found.dedup();
    found
}

/// Places in answers where nothing is an answer: `null` elsewhere is a number that is none.
const MAY_BE_NULL: [&str; 9] =
    ["verified", "stopped", "left_out", "stable", "step", "nearest", "error", "about_at", "by"];

/// What a call of the program with `--json` must be, whatever it was called with: an answer, a "no" or a refusal, each
/// whole. Returns what is wrong.
pub fn faults(arguments: &[String]) -> Vec<String> {
    let output = Command::new(triad()).args(arguments).stdin(Stdio::null()).output().unwrap();
    let (out, said) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    let mut faults = Vec::new();
    if said.contains("panicked") {
        faults.push(format!("panics: {}", said.lines().take(2).collect::<Vec<_>>().join(" ")));
    }
    let Ok(answer) = serde_json::from_str::<Value>(&out) else {
        faults.push(format!("no JSON: {:?}, {:?}", out.lines().next(), said.lines().next()));
        return faults;
    };
    let told = match output.status.code() {
        Some(0) => None,
        Some(1) => Some(answer.get("stopped").unwrap_or(&answer)),
        Some(3) => Some(&answer),
        other => {
            faults.push(format!("exit code {other:?}: {}", answer["detail"]));
            None
        }
    };
    for (key, least) in told.into_iter().flat_map(|_| [("code", 4), ("detail", 15), ("hint", 10)]) {
        if told.and_then(|told| told[key].as_str()).is_none_or(|text| text.len() < least) {
            faults.push(format!("a refusal without {key}: {out}"));
        }
    }
    nothings(&answer, "", &mut faults);
    if told.is_none() {
        replaced(arguments, &answer, &mut faults);
    }
    faults
}

/// Numbers that are none.
fn nothings(value: &Value, at: &str, faults: &mut Vec<String>) {
    match value {
        Value::Null if !MAY_BE_NULL.contains(&at.rsplit('/').next().unwrap_or(at)) => {
            faults.push(format!("{at} is null: a number that is none"));
        }
        Value::Array(list) => {
            list.iter()
                .take(100)
                .enumerate()
                .for_each(|(k, inner)| nothings(inner, &format!("{at}/{k}"), faults));
        }
        Value::Object(map) => {
            map.iter().for_each(|(key, inner)| nothings(inner, &format!("{at}/{key}"), faults));
        }
        Value::String(text)
            if ["NaN", "inf"].iter().any(|none| text.split_whitespace().any(|word| word == *none)) =>
        {
            faults.push(format!("{at} tells no number: {text}"));
        }
        _ => {}
    }
}

/// A choice of `triad run` that the answer does not show: it was replaced.
fn replaced(arguments: &[String], answer: &Value, faults: &mut Vec<String>) {
    let asked = |option: &str| {
        let at = arguments.iter().position(|argument| argument == option)?;
        arguments.get(at + 1).map(String::as_str)
    };
    let shown = [
        ("--integrator", &answer["summary"]["integrator"]),
        ("--treatment", &answer["settings"]["stabilization"]["kind"]),
    ];
    for (option, shown) in shown {
        if let Some(asked) = asked(option).filter(|asked| *asked != "auto" && arguments[0] == "run")
            && shown != asked
        {
            faults
                .push(format!("{option} {asked} is answered with {shown}: {}", answer["summary"]["reason"]));
        }
    }
}
