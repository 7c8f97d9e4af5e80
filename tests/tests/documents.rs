//! What the documents name exists: files, links, steps, and the commands with their options.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use std::fs;
use std::path::{Path, PathBuf};
use triad_tests::program::run;
use triad_tests::root;

/// Places that paths are counted from, besides the document's own folder: ARCHITECTURE.md writes crates and rooms short.
const BASES: &[&str] = &[
    "",
    "engine",
    "engine/dynamics/src",
    "engine/dynamics/src/dynamics",
    "engine/engine",
    "engine/engine/src",
    "web",
    "web/src",
    "lessons",
    "lessons/course/02-simple-pendulum",
];
/// Stand for a number or a word.
const PLACEHOLDERS: &[&str] = &["NN", "WORD"];
/// What commands write, and so may not be there.
const WRITTEN: &[&str] = &["target/", "reports/", "tests/output/", "/"];

/// The documents, by their paths from the root.
fn documents() -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    let mut open = vec![PathBuf::new()];
    while let Some(folder) = open.pop() {
        for entry in root().join(&folder).read_dir().unwrap() {
            let entry = entry.unwrap();
            let name = entry.file_name().to_string_lossy().into_owned();
            let path = folder.join(&name);
            let skipped = name.starts_with('.')
                || ["target", "node_modules", "course", "skeleton", "dist"].contains(&&*name);
            if entry.path().is_dir() && !skipped {
                open.push(path);
            } else if Path::new(&name).extension().is_some_and(|e| e == "md") && name != "theory-mathml.md" {
                found.push((path, fs::read_to_string(entry.path()).unwrap()));
            }
        }
    }
    assert!(found.len() > 8, "{found:?}");
    found
}

/// Texts in backticks, and lines of blocks of code.
fn code(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (k, part) in text.split("```").enumerate() {
        if k % 2 == 1 {
            found
                .extend(part.lines().skip(1).map(|line| line.split("  #").next().unwrap().trim().to_owned()));
        } else {
            // A pair of backticks may go over the end of a line.
            let spans = part.split('`').skip(1).step_by(2);
            found.extend(spans.map(|span| span.split_whitespace().collect::<Vec<_>>().join(" ")));
        }
    }
    found
}

fn exists(document: &Path, path: &str) -> bool {
    let own = document.parent().unwrap().to_str().unwrap();
    BASES.iter().chain([&own]).any(|base| root().join(base).join(path).exists())
}

/// Whether a text in backticks names a file or a folder of the repository.
fn names_file(span: &str) -> bool {
    let placeholder = PLACEHOLDERS.iter().any(|placeholder| span.contains(placeholder));
    let plain = !placeholder && span.chars().all(|c| c.is_ascii_alphanumeric() || "/._-".contains(c));
    let kinds = ["rs", "md", "mjs", "ts", "json", "toml", "py", "txt", "svg", "csv", "css", "html"];
    let file = Path::new(span).extension().is_some_and(|e| kinds.contains(&e.to_str().unwrap()));
    plain
        && span.contains('/')
        && (file || span.ends_with('/'))
        && !WRITTEN.iter().any(|w| span.starts_with(w))
}

#[test]
fn files_and_links_that_documents_name_exist() {
    let (mut missing, mut seen) = (Vec::new(), 0);
    for (document, text) in documents() {
        for span in code(&text).iter().filter(|span| names_file(span)) {
            seen += 1;
            if !exists(&document, span) {
                missing.push(format!("{}: `{span}`", document.display()));
            }
        }
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let path = link.split('#').next().unwrap();
            let file =
                !path.is_empty() && !link.contains("://") && !link.contains(' ') && !link.starts_with('$');
            seen += usize::from(file);
            if file && !root().join(document.parent().unwrap()).join(path).exists() {
                missing.push(format!("{}: ({link})", document.display()));
            }
        }
    }
    assert!(seen > 60, "{seen}");
    assert!(missing.is_empty(), "{missing:#?}");
}

/// Everything that stands behind a command's name up to the end of it.
fn commands(name: &str) -> Vec<(String, Vec<String>)> {
    let mut found = Vec::new();
    for (document, text) in documents() {
        for line in code(&text) {
            for part in line.split(['|', ';', '&']) {
                // Variables may stand before the name.
                let mut words =
                    part.split_whitespace().skip_while(|word| word.contains('=')).map(str::to_owned);
                if words.next().as_deref() == Some(name) {
                    found.push((document.display().to_string(), words.collect()));
                }
            }
        }
    }
    assert!(!found.is_empty(), "no document names {name}");
    found
}

#[test]
fn commands_of_the_program_know_the_options_that_documents_name() {
    let mut wrong = Vec::new();
    let mut check = |document: &str, words: &[String]| {
        let plain = |word: &&String| word.chars().all(|c| c.is_ascii_lowercase()) && word.len() > 2;
        let mut names: Vec<&str> = words.iter().take(2).take_while(plain).map(String::as_str).collect();
        if !matches!(names.first(), Some(&"lesson" | &"class" | &"export")) {
            names.truncate(1);
        }
        let help = run(&[names.as_slice(), &["--help"]].concat());
        let said = String::from_utf8_lossy(&help.stdout).into_owned();
        if !help.status.success() {
            wrong.push(format!("{document}: triad {}", words.join(" ")));
        }
        for option in words.iter().filter(|word| word.starts_with("--")) {
            let option = option.split('=').next().unwrap().trim_end_matches(['.', ',']);
            let known =
                said.split(|c: char| !(c.is_ascii_alphanumeric() || c == '-')).any(|word| word == option);
            if !known && !["--version"].contains(&option) {
                wrong.push(format!("{document}: triad {}: {option}", words.join(" ")));
            }
        }
    };
    for (document, words) in commands("triad") {
        check(&document, &words);
    }
    for (document, words) in commands("cargo") {
        let ours = words.first().is_some_and(|word| word == "run")
            && !words.iter().any(|w| w == "--example" || w == "-p");
        if let Some(at) = words.iter().position(|word| word == "--").filter(|_| ours) {
            check(&document, &words[at + 1..]);
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// The folder of a package of the workspace.
fn folder_of(package: &str) -> Option<PathBuf> {
    let manifest = fs::read_to_string(root().join("Cargo.toml")).unwrap();
    let members = manifest.split_once("members = [").unwrap().1.split_once(']').unwrap().0;
    let name = format!("name = \"{package}\"");
    let mut folders = members.split('"').skip(1).step_by(2).map(|member| root().join(member));
    folders.find(|folder| fs::read_to_string(folder.join("Cargo.toml")).unwrap().contains(&name))
}

#[test]
fn steps_tests_and_scripts_that_documents_name_exist() {
    let mut wrong = Vec::new();
    let steps = fs::read_to_string(root().join("tests/verify/src/main.rs")).unwrap();
    for (document, words) in commands("cargo") {
        let line = format!("{document}: cargo {}", words.join(" "));
        let after = |option: &str| {
            let at = words.windows(2).filter(|pair| pair[0] == option).map(|pair| pair[1].clone());
            at.collect::<Vec<String>>()
        };
        match words.first().map(String::as_str) {
            Some("verify") => {
                let unknown = words[1..].iter().find(|step| {
                    !step.starts_with("--") && !steps.contains(&format!("Step::new(\"{step}\","))
                });
                wrong.extend(unknown.map(|step| format!("{line}: no step {step}")));
            }
            Some("test" | "bench" | "run") => {
                let folder = after("-p").first().map(|package| folder_of(package));
                if folder == Some(None) {
                    wrong.push(format!("{line}: no such package"));
                }
                for (option, below) in
                    [("--test", "tests"), ("--example", "examples"), ("--bench", "benches")]
                {
                    for name in after(option) {
                        let there = |folder: &PathBuf| {
                            let at = folder.join(below).join(&name);
                            at.is_dir() || at.with_extension("rs").exists()
                        };
                        let anywhere =
                            ["engine/engine", "engine/lab", "tests", "server"].map(|f| root().join(f));
                        let found = folder
                            .clone()
                            .flatten()
                            .map_or_else(|| anywhere.iter().any(there), |f| there(&f));
                        if !found {
                            wrong.push(format!("{line}: no {below}/{name}"));
                        }
                    }
                }
            }
            _ => {}
        }
    }
    let scripts: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(root().join("web/package.json")).unwrap()).unwrap();
    for (document, words) in commands("npm") {
        if words.first().is_some_and(|word| word == "run") && scripts["scripts"][&words[1]].is_null() {
            wrong.push(format!("{document}: npm {}", words.join(" ")));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// All sources of a folder, one after the other.
fn sources(folder: &Path, found: &mut String) {
    for entry in folder.read_dir().unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push_str(&fs::read_to_string(path).unwrap());
        }
    }
}

/// The column "type" of the glossary: the last part of each path is declared somewhere.
#[test]
fn types_that_the_glossary_names_exist() {
    let mut all = String::new();
    for folder in ["engine", "lessons/src", "server/src"] {
        sources(&root().join(folder), &mut all);
    }
    let declared = |name: &str| {
        let kinds = ["struct", "enum", "trait", "fn", "const", "type", "mod"];
        let ends = |rest: &str| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_');
        let stands = |kind: &str| {
            all.match_indices(&format!("{kind} {name}")).any(|(at, m)| ends(&all[at + m.len()..]))
        };
        // A variant, or what a macro declares: alone on its line.
        let alone = all.lines().map(str::trim).any(|line| {
            line.strip_suffix(';').or_else(|| line.strip_suffix(" {")).is_some_and(|line| line == name)
        });
        kinds.iter().any(|kind| stands(kind)) || alone || all.contains(&format!("pub {name}:"))
    };
    let glossary = fs::read_to_string(root().join("docs/GLOSSARY.md")).unwrap();
    let (here, _) = glossary.split_once("## Names in files").unwrap();
    let names = code(here)
        .into_iter()
        .filter(|span| span.chars().all(|c| c.is_alphanumeric() || c == '_' || c == ':'));
    let missing: Vec<String> = names.filter(|span| !declared(span.rsplit("::").next().unwrap())).collect();
    assert!(missing.is_empty(), "{missing:?}");
}
