//! The web page: built if its sources are newer than the last build, and embedded into the binary.

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::SystemTime;
use std::{env, fs, io};

use crate::engine;

/// What the page is made from, relative to `web/`.
const SOURCES: [&str; 8] = [
    "src",
    "build",
    "public",
    "index.html",
    "package.json",
    "package-lock.json",
    "tsconfig.json",
    "vite.config.ts",
];

/// Builds the page where that is needed, and writes the table of its files.
pub fn embed() -> Result<(), Box<dyn Error>> {
    let server = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    let root = server.parent().ok_or("the server's folder has no parent")?;
    let web = root.join("web");
    let dist = web.join("dist");
    for source in SOURCES {
        let source = web.join(source);
        if source.exists() {
            println!("cargo::rerun-if-changed={}", source.display());
        }
    }
    let sources = SOURCES.iter().filter_map(|source| newest(&web.join(source))).max();
    let built = fs::metadata(dist.join("index.html")).and_then(|m| m.modified()).ok();
    let engine = engine::build(root)?;
    let engine_built = engine.as_deref().and_then(newest);
    let changed = built.is_none_or(|built| sources.max(engine_built).is_some_and(|changed| changed > built));
    if changed || has_engine(&dist)? != engine.is_some() {
        build_page(&web, engine.as_deref())?;
    }
    write_table(&dist)
}

/// Time of the last change below `path`, folders themselves left out (tools write into them).
fn newest(path: &Path) -> Option<SystemTime> {
    let meta = fs::metadata(path).ok()?;
    if !meta.is_dir() {
        return meta.modified().ok();
    }
    fs::read_dir(path).ok()?.filter_map(|entry| newest(&entry.ok()?.path())).max()
}

/// Whether the page that is there was built with an engine of its own.
fn has_engine(dist: &Path) -> Result<bool, Box<dyn Error>> {
    let assets = dist.join("assets");
    if !assets.exists() {
        return Ok(false);
    }
    let mut names = fs::read_dir(assets)?.filter_map(Result::ok).map(|entry| entry.file_name());
    Ok(names.any(|name| name.to_string_lossy().starts_with("engine-")))
}

fn build_page(web: &Path, engine: Option<&Path>) -> Result<(), Box<dyn Error>> {
    let lock = newest(&web.join("package-lock.json"));
    let installed = newest(&web.join("node_modules/.package-lock.json"));
    if installed.is_none() || lock > installed {
        // Vite and what the page loads. Who has installed the tools of `npm run check`, three times as many files,
        // keeps them.
        let tools = web.join("node_modules/typescript").exists();
        npm(
            web,
            &["ci", if tools { "--include=dev" } else { "--omit=dev" }, "--no-audit", "--no-fund"],
            None,
        )?;
    }
    npm(web, &["run", "build"], engine)
}

fn npm(web: &Path, arguments: &[&str], engine: Option<&Path>) -> Result<(), Box<dyn Error>> {
    let program = if cfg!(windows) { "npm.cmd" } else { "npm" };
    let shown = format!("npm {} (in {})", arguments.join(" "), web.display());
    let mut command = Command::new(program);
    command.args(arguments).current_dir(web).env_remove("TRIAD_ENGINE_WASM");
    if let Some(engine) = engine {
        command.env("TRIAD_ENGINE_WASM", engine);
    }
    let output = command.output().map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => {
            "the web page needs Node.js 20 or later to be built, and `npm` was not found: \
             install Node.js from https://nodejs.org or with your package manager, then build again"
                .to_owned()
        }
        _ => format!("`{shown}` could not be started: {error}"),
    })?;
    if output.status.success() {
        return Ok(());
    }
    let said = [output.stdout, output.stderr].concat();
    Err(format!("`{shown}` failed; the page was not built. It said:\n{}", String::from_utf8_lossy(&said))
        .into())
}

/// How a file of the page is kept.
enum Stored {
    Plain(PathBuf),
    Brotli(PathBuf),
}

fn write_table(dist: &Path) -> Result<(), Box<dyn Error>> {
    let mut assets = BTreeMap::new();
    collect(dist, dist, &mut assets)?;
    let out = PathBuf::from(env::var("OUT_DIR")?);
    let mut table = format!("pub(super) static ASSETS: [Asset; {}] = [\n", assets.len());
    for (index, (name, stored)) in assets.iter().enumerate() {
        let (kind, file) = match stored {
            Stored::Plain(file) => ("Plain", file),
            Stored::Brotli(file) => ("Brotli", file),
        };
        let tag = fnv(&fs::read(file)?);
        // Copies, so that a build of the page during a build of the binary cannot mix two pages.
        let copy = out.join(format!("asset-{index}"));
        fs::copy(file, &copy)?;
        let copy = copy.display().to_string();
        writeln!(
            table,
            "    Asset::new({name:?}, \"\\\"{tag:016x}\\\"\", Stored::{kind}(include_bytes!({copy:?}))),"
        )?;
    }
    table.push_str("];\n");
    fs::write(out.join("assets.rs"), table)?;
    Ok(())
}

fn collect(dist: &Path, folder: &Path, assets: &mut BTreeMap<String, Stored>) -> Result<(), Box<dyn Error>> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            collect(dist, &path, assets)?;
            continue;
        }
        let parts = path.strip_prefix(dist)?.iter().map(|part| part.to_string_lossy());
        let name = parts.collect::<Vec<_>>().join("/");
        match name.strip_suffix(".br") {
            Some(name) => assets.insert(name.to_owned(), Stored::Brotli(path)),
            None => assets.insert(name, Stored::Plain(path)),
        };
    }
    Ok(())
}

/// FNV-1a: tells two versions of a file apart.
fn fnv(bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}
