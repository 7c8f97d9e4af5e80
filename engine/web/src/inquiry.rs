//! Requests that need no live run: scenes, their check, their analyses, a whole run.

use http::StatusCode;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use triad_engine::EngineError;
use triad_engine::analysis::{self, ModesAbout};
use triad_engine::catalogue;
use triad_engine::reactions::report::Convention;
use triad_engine::scene::Scene;
use triad_session::bounds::SceneBounds;
use triad_session::refusal::Refusal;

use crate::message::{Answer, Request, json};
use crate::whole::{self, Arrays};

/// The largest scene: more than a picture shows.
pub const BOUNDS: SceneBounds = SceneBounds { bodies: 500, connections: 2000 };
/// The largest scene that is analysed: equilibria and modes take dense matrices.
const ANALYSED: SceneBounds = SceneBounds { bodies: 60, ..BOUNDS };
/// Who takes scenes of that size.
pub const TAKER: &str = "the engine in this page";

/// A built-in scene.
#[derive(Serialize)]
struct SceneEntry {
    name: &'static str,
    summary: &'static str,
}

/// A scene to analyse.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct AnalysisRequest {
    scene: Value,
    #[serde(default)]
    about: ModesAbout,
    #[serde(default)]
    pinned: Vec<String>,
}

/// The built-in scene of that name.
///
/// Errors if there is none.
pub fn builtin(name: &str) -> Result<Scene, Refusal> {
    catalogue::scene(name).map_err(|error| EngineError::from(error).into())
}

/// The answer to a request that needs no live run; none if it is another.
pub fn answer(request: &Request) -> Option<Answer> {
    let words = request.words();
    Some(match (request.method.as_str(), words.as_slice()) {
        ("GET", ["scenes"]) => {
            let entries = catalogue::ENTRIES.iter();
            json(&entries.map(|e| SceneEntry { name: e.name, summary: e.summary }).collect::<Vec<_>>())
        }
        ("GET", ["scenes", name]) => decoded(name).and_then(|name| json(&builtin(&name)?)),
        ("POST", ["check"]) => check(&request.body),
        ("POST", ["analyses", kind]) => analyse(kind, request),
        ("POST", ["run"]) => request.body().and_then(|asked| json(&Arrays::of(asked)?)),
        ("POST", ["steps"]) => request.body().and_then(|asked| json(&whole::steps(asked)?)),
        _ => return None,
    })
}

/// A word of an address as it was before it was written there.
fn decoded(word: &str) -> Result<String, Refusal> {
    let pairs: Result<Vec<(String, String)>, _> = serde_urlencoded::from_str(&format!("w={word}"));
    let found = pairs.ok().and_then(|pairs| pairs.into_iter().next());
    found.map(|(_, word)| word).ok_or_else(|| {
        Refusal::new(
            StatusCode::NOT_FOUND,
            "unknown-scene",
            format!("there is no scene called \"{word}\""),
            "the names are those of GET /scenes",
        )
    })
}

fn check(scene: &Value) -> Answer {
    let scene = Scene::from_json(&scene.to_string())?;
    BOUNDS.hold(&scene, TAKER)?;
    json(&analysis::check::check(&scene)?)
}

fn analyse(kind: &str, request: &Request) -> Answer {
    let asked: AnalysisRequest = request.body()?;
    let scene = Scene::from_json(&asked.scene.to_string())?;
    ANALYSED.hold(&scene, TAKER)?;
    match kind {
        "assembly" => json(&analysis::assemble(&scene, &asked.pinned)?),
        "kinematics" => json(&analysis::kinematics(&scene, Convention::default())?),
        "equilibrium" => json(&analysis::equilibrium(&scene)?),
        "modes" => json(&analysis::modes(&scene, asked.about)?),
        _ => Err(Refusal::new(
            StatusCode::NOT_FOUND,
            "not-here",
            format!("the engine in this page makes no analysis called \"{kind}\""),
            "let the run be computed on the server",
        )),
    }
}
