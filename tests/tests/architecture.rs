//! Arrows point one way: a module of `lib.rs` imports only modules that stand before it there, nothing by way of
//! `lib.rs` itself, and the files of a folder make no circle. The page's own test (`web/src/layers.test.ts`) holds the same for TypeScript.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use triad_tests::root;

/// The files of a crate by their path as a module: `[]` for lib.rs, `["system", "row"]` for system/row.rs.
fn files(folder: &Path, at: &[String], found: &mut BTreeMap<Vec<String>, String>) {
    for entry in folder.read_dir().unwrap() {
        let path = entry.unwrap().path();
        let stem = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let inside = [at, std::slice::from_ref(&stem)].concat();
        if path.is_dir() {
            files(&path, &inside, found);
        } else if path.extension().is_some_and(|e| e == "rs")
            && stem != "main"
            && stem != "tests"
            && at.first().is_none_or(|first| first != "tests")
        {
            let module = if stem == "lib" || stem == "mod" { at.to_vec() } else { inside };
            found.insert(module, std::fs::read_to_string(&path).unwrap());
        }
    }
}

/// Names of modules that a file declares, in the order of the file.
fn declared(text: &str) -> Vec<&str> {
    let names = text.lines().filter_map(|line| {
        let line = line
            .trim_start_matches("pub ")
            .trim_start_matches("pub(crate) ")
            .trim_start_matches("pub(super) ");
        line.strip_prefix("mod ")?.strip_suffix(';')
    });
    names.collect()
}

/// Every path that a file's `use` lines name after `crate::` or `super::`, as modules from the crate's root.
fn imports(module: &[String], text: &str) -> Vec<Vec<String>> {
    let mut paths = Vec::new();
    let code = text.split("#[cfg(test)]\nmod ").next().unwrap();
    for part in code.split(';') {
        let Some((_, list)) = part.rsplit_once("use ") else { continue };
        let (base, rest) = if let Some(rest) = list.strip_prefix("crate::") {
            (&module[..0], rest)
        } else if let Some(rest) = list.strip_prefix("super::super::") {
            (&module[..module.len().saturating_sub(2)], rest)
        } else if let Some(rest) = list.strip_prefix("super::") {
            (&module[..module.len().saturating_sub(1)], rest)
        } else {
            continue;
        };
        for leaf in leaves(&rest.split_whitespace().collect::<String>()) {
            paths.push([base, &leaf.split("::").map(str::to_owned).collect::<Vec<_>>()].concat());
        }
    }
    paths
}

/// `a::{b,c::d}` as `a::b` and `a::c::d`.
fn leaves(tree: &str) -> Vec<String> {
    let Some((prefix, group)) = tree.split_once('{') else { return vec![tree.to_owned()] };
    let (mut depth, mut start, mut items) = (0, 0, Vec::new());
    let group = group.strip_suffix('}').unwrap_or(group);
    for (at, c) in group.char_indices().chain([(group.len(), ',')]) {
        depth += i32::from(c == '{') - i32::from(c == '}');
        if c == ',' && depth == 0 {
            items.push(&group[start..at]);
            start = at + 1;
        }
    }
    items.iter().flat_map(|item| leaves(item)).map(|leaf| format!("{prefix}{leaf}")).collect()
}

/// The arrows of a crate that run back between modules of lib.rs, and those that are part of a circle further inside.
fn backward(name: &str, folder: &Path) -> BTreeSet<String> {
    let mut modules = BTreeMap::new();
    files(folder, &[], &mut modules);
    let (mut arrows, mut through_lib) = (BTreeSet::new(), BTreeSet::new());
    for (module, text) in &modules {
        for path in imports(module, text) {
            // A name of the crate itself comes from lib.rs, where all modules are gathered: after every one of them.
            if path.len() == 1 && path[0].starts_with(|c: char| c.is_ascii_uppercase()) && !module.is_empty()
            {
                through_lib.insert(format!("{name}: {} -> lib.rs ({})", module.join("::"), path[0]));
            }
            let common = module.iter().zip(&path).take_while(|(a, b)| a == b).count();
            let order = declared(modules.get(&module[..common]).map_or("", |text| text));
            let place =
                |name: Option<&String>| order.iter().position(|module| Some(*module) == name.map(|n| &**n));
            if let (Some(from), Some(to)) = (place(module.get(common)), place(path.get(common))) {
                arrows.insert((module[..common].to_vec(), order[from], order[to], to > from));
            }
        }
    }
    let reaches = |parent: &Vec<String>, start: &str, end: &str| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![start]);
        while let Some(at) = open.pop() {
            open.extend(
                arrows.iter().filter(|a| a.0 == *parent && a.1 == at && seen.insert(a.2)).map(|a| a.2),
            );
        }
        seen.contains(end)
    };
    let back = arrows.iter().filter(|(parent, from, to, later)| {
        if parent.is_empty() {
            *later
        } else {
            from < to && reaches(parent, from, to) && reaches(parent, to, from)
        }
    });
    back.map(|(parent, from, to, _)| {
        format!("{name}: {} -> {to}", [parent.as_slice(), &[(*from).to_owned()]].concat().join("::"))
    })
    .chain(through_lib)
    .collect()
}

#[test]
fn modules_import_only_what_stands_before_them() {
    let manifest = std::fs::read_to_string(root().join("Cargo.toml")).unwrap();
    let members = manifest.split_once("members = [").unwrap().1.split_once(']').unwrap().0;
    let mut arrows = BTreeSet::new();
    for member in members.split('"').skip(1).step_by(2) {
        arrows.extend(backward(member, &root().join(member).join("src")));
    }
    assert!(arrows.is_empty(), "imports of modules that stand later: {arrows:#?}");
}
