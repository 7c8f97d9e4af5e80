//! How large a scene may be where somebody else's machine runs it.

use http::StatusCode;
use triad_engine::analysis::check::products_within;
use triad_engine::scene::Scene;

use crate::refusal::Refusal;

/// Products of blocks that one factorization of a scene's constraints may take: 40 MB, and some tenths of a second. Of joints that stand in
/// rows, trees and ladders it takes some thousand; of 180 joints on one body, or 500 between any bodies, more.
const MOST_PRODUCTS: usize = 1_000_000;

/// The largest scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SceneBounds {
    /// Its bodies.
    pub bodies: usize,
    /// Its joints, drivers and loads together.
    pub connections: usize,
}

impl SceneBounds {
    /// Refuses a scene that is larger, before anything of its size is built from it; `taker` is who runs it, as in “this server takes”.
    pub fn hold(self, scene: &Scene, taker: &str) -> Result<(), Refusal> {
        let connections = scene.joints.len() + scene.drivers.len() + scene.loads.len();
        // The longest of the lists that are bounded together is the place to mend.
        let lists =
            [("joints", scene.joints.len()), ("drivers", scene.drivers.len()), ("loads", scene.loads.len())];
        let longest = lists.into_iter().max_by_key(|(_, count)| *count).map_or("joints", |(list, _)| list);
        for (list, what, count, limit) in [
            ("bodies", "bodies", scene.bodies.len(), self.bodies),
            (longest, "joints, drivers and loads", connections, self.connections),
        ] {
            if count > limit {
                let detail = format!("the scene has {count} {what}, {taker} takes {limit}");
                let hint = "make the scene smaller, or run it on the command line: triad run SCENE";
                return Err(too_large(&format!("/{list}"), detail, hint));
            }
        }
        if !products_within(scene, MOST_PRODUCTS) {
            let detail = format!(
                "too many joints meet at the same bodies, by way of others too, for what {taker} takes"
            );
            let hint = "leave out joints that hold again what others hold, or run it on the command line: triad run SCENE";
            return Err(too_large("/joints", detail, hint));
        }
        Ok(())
    }
}

/// A scene that asks for more than is taken, at the list that is too long.
fn too_large(list: &str, detail: String, hint: &str) -> Refusal {
    Refusal::new(StatusCode::UNPROCESSABLE_ENTITY, "scene-too-large", detail.clone(), hint).at(list, detail)
}
