//! Settings of the server from a file, and `triad config`, which tells each one and where it comes from.
//!
//! An option on the command line goes before the environment, that before the file, and the file before the default: a value of
//! the file takes the place of the option's default, so that the order is clap's own.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use axum::http::StatusCode;
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Command};
use serde_json::{Value, json};

use super::terminal::{Outcome, print_json, print_line};
use crate::problem::{Problem, suggest};
use crate::scenes;

/// Largest file of settings, in bytes.
const LARGEST: u64 = 1 << 20;
/// Commands that take the settings of the server.
const TAKERS: [&str; 2] = ["serve", "config"];
/// Options that are no settings: said once, or about the command itself.
const NO_SETTINGS: [&str; 4] = ["config", "json", "help", "new_owner"];
/// Parts of the names of settings whose values are not shown.
const SECRET: [&str; 4] = ["secret", "password", "token", "key"];

/// The values of a file of settings: names of options without dashes before them.
pub(super) type Settings = BTreeMap<String, Vec<String>>;

/// Whether a command takes the settings of the server.
pub(super) fn takes(command: &str) -> bool {
    TAKERS.contains(&command)
}

/// Reads a file of settings.
///
/// Errors if it is no TOML, or a key is no option of `triad serve`.
pub(super) fn read(file: &Path, command: &Command) -> Result<Settings, Problem> {
    let text = scenes::read(file, LARGEST)?;
    let refused = |code: &'static str, detail: String, hint: String| {
        Problem::new(StatusCode::UNPROCESSABLE_ENTITY, code, format!("{}: {detail}", file.display()), hint)
    };
    let table: toml::Table = text.parse().map_err(|error: toml::de::Error| {
        let hint = "write one setting a line, as in port = 8080".to_owned();
        refused("settings-unreadable", error.to_string().trim_end().to_owned(), hint)
    })?;
    let options = options(command);
    let known: Vec<&str> = options.iter().filter_map(|option| option.get_long()).collect();
    let mut settings = Settings::new();
    for (key, value) in table {
        let Some(option) = options.iter().find(|option| option.get_long() == Some(&key)) else {
            let hint = suggest(&key, known.iter().copied());
            return Err(refused("unknown-setting", format!("there is no setting called {key}"), hint));
        };
        let takes_many = matches!(option.get_action(), ArgAction::Append);
        let values = match value {
            toml::Value::Array(list) if takes_many => list.iter().map(plain).collect(),
            one => plain(&one).map(|one| vec![one]),
        };
        let Some(values) = values else {
            let hint =
                if takes_many { "write a list of texts" } else { "write a text, a number, true or false" };
            return Err(refused(
                "invalid-setting",
                format!("{key} has a value of the wrong kind"),
                hint.to_owned(),
            ));
        };
        let is_flag = matches!(option.get_action(), ArgAction::SetTrue);
        if let Err(why) = accepted(command, &key, &values, is_flag) {
            let hint = format!("triad {} --help tells what {key} takes", TAKERS[0]);
            return Err(refused("invalid-setting", why, hint));
        }
        settings.insert(key, values);
    }
    Ok(settings)
}

/// Whether the command line would take these values.
fn accepted(command: &Command, key: &str, values: &[String], is_flag: bool) -> Result<(), String> {
    if is_flag {
        let known = values.iter().all(|value| value == "true" || value == "false");
        return if known { Ok(()) } else { Err(format!("{key} is true or false")) };
    }
    let words = ["triad", TAKERS[0]].map(str::to_owned).into_iter();
    let words = words.chain(values.iter().map(|value| format!("--{key}={value}")));
    command.clone().try_get_matches_from(words).map(drop).map_err(|error| {
        let text = error.to_string();
        text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned()
    })
}

/// A value as it is written on the command line.
fn plain(value: &toml::Value) -> Option<String> {
    match value {
        toml::Value::String(text) => Some(text.clone()),
        toml::Value::Integer(_) | toml::Value::Float(_) | toml::Value::Boolean(_) => Some(value.to_string()),
        _ => None,
    }
}

/// What can be set: the options of the server, and those of every command that are about its course.
fn options(command: &Command) -> Vec<&Arg> {
    let own = command.find_subcommand(TAKERS[0]).into_iter().flat_map(Command::get_arguments);
    own.chain(command.get_arguments())
        .filter(|option| !NO_SETTINGS.contains(&option.get_id().as_str()))
        .collect()
}

/// The command line with the values of a file in place of defaults.
pub(super) fn with(command: Command, settings: &Settings) -> Command {
    let set = |option: Arg| match option.get_long().and_then(|name| settings.get(name)) {
        Some(values) => option.default_values(values.clone()),
        None => option,
    };
    TAKERS.into_iter().fold(command.mut_args(set), |command, name| {
        command.mut_subcommand(name, |taker| taker.mut_args(set))
    })
}

/// Tells each setting, as a line of a file of settings, and where it comes from.
pub(super) fn tell(command: &Command, matches: &ArgMatches, settings: &Settings, json: bool) -> Outcome {
    let mut all = serde_json::Map::new();
    let mut text = String::new();
    for option in options(command) {
        let (id, name) = (option.get_id().as_str(), option.get_long().unwrap_or_default());
        let from = match matches.value_source(id) {
            Some(ValueSource::CommandLine) => "command line",
            Some(ValueSource::EnvVariable) => "environment",
            _ if settings.contains_key(name) => "file",
            _ => "default",
        };
        let raw = matches.get_raw(id).into_iter().flatten();
        let values: Vec<Value> = raw.map(|value| shown(name, &value.to_string_lossy(), option)).collect();
        let value = match (option.get_action(), values.as_slice()) {
            (ArgAction::Append, _) => Value::Array(values),
            (_, [one]) => one.clone(),
            _ => Value::Null,
        };
        if value.is_null() {
            let _ = writeln!(text, "# {name} is not set");
        } else {
            let _ = writeln!(text, "{name} = {value}  # {from}");
        }
        all.insert(name.to_owned(), json!({"value": value, "from": from}));
    }
    if json {
        print_json(&all);
    } else {
        print_line(text.trim_end());
    }
    Outcome::Done
}

/// A value as it may be seen: numbers and truths as such, passwords not at all.
fn shown(name: &str, text: &str, option: &Arg) -> Value {
    if SECRET.iter().any(|part| name.contains(part)) {
        return json!("(hidden)");
    }
    let is_flag = matches!(option.get_action(), ArgAction::SetTrue);
    match (is_flag, text.parse::<u64>()) {
        (true, _) => json!(text == "true"),
        (false, Ok(number)) => json!(number),
        (false, Err(_)) => json!(without_password(text)),
    }
}

/// An address without the password in `scheme://user:password@host`.
fn without_password(text: &str) -> String {
    let Some((scheme, rest)) = text.split_once("://") else { return text.to_owned() };
    let Some((who, host)) = rest.rsplit_once('@') else { return text.to_owned() };
    match who.split_once(':') {
        Some((user, _)) => format!("{scheme}://{user}:***@{host}"),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::without_password;

    #[test]
    fn a_password_in_an_address_is_hidden() {
        assert_eq!(
            without_password("postgres://triad:four@words@db/grades"),
            "postgres://triad:***@db/grades"
        );
        for same in ["triad.db", "/srv/a:b@c.db", "https://triad.example.org", "postgres://triad@db/grades"] {
            assert_eq!(without_password(same), same);
        }
    }
}
