//! Built-in scenes by name.

mod chain;
mod four_bar;

use crate::elements::Inertia;
use crate::limits::MAX_BODIES;
use crate::scene::Scene;
use crate::text::nearest_name;

/// A built-in scene, or a family of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneEntry {
    /// Name, with `:N` where a number belongs.
    pub name: &'static str,
    /// What it is, in one line.
    pub summary: &'static str,
}

/// All built-in scenes.
pub const ENTRIES: &[SceneEntry] = &[
    SceneEntry {
        name: "simple-pendulum",
        summary: "A point mass of 1 kg on a rod of 1 m, released horizontally (A01)",
    },
    SceneEntry {
        name: "n-four-bar:N",
        summary: "N four-bar windows in a row, through their singular positions (A02); N from 1 to 1000",
    },
    SceneEntry {
        name: "spatial-chain:N",
        summary: "N rods on spherical joints swinging in space, for measuring; N from 1 to 5000",
    },
    SceneEntry {
        name: "spatial-double-pendulum",
        summary: "Two cylinders on spherical joints in non-planar motion (C04)",
    },
    SceneEntry {
        name: "free-body",
        summary: "A torque-free body with three different moments of inertia (C01)",
    },
    SceneEntry {
        name: "free-body-flip",
        summary: "The same body turning about its middle axis: it flips (C01)",
    },
    SceneEntry { name: "free-fall", summary: "A body thrown and tumbling (C03)" },
    SceneEntry {
        name: "heavy-top",
        summary: "Lagrange's top, let go with a spin: it nods to cusps and goes round",
    },
    SceneEntry {
        name: "bricard",
        summary: "Six revolute joints in a loop that moves although its rows leave no freedom (A04)",
    },
    SceneEntry {
        name: "spatial-slider-crank",
        summary: "Revolute, spherical, universal and prismatic joint in a spatial loop (IFToMM library)",
    },
    SceneEntry {
        name: "spatial-slider-crank:slender",
        summary: "The same with a slender rod, as later authors read the printed data",
    },
    SceneEntry {
        name: "spatial-slider-crank:mbdyn",
        summary: "The same with a slender rod and the crank balanced on its axis",
    },
    SceneEntry {
        name: "squeezer",
        summary: "Andrews' squeezing mechanism, seven bodies in three loops, for 0.05 s (A03)",
    },
    SceneEntry { name: "squeezer:ivp", summary: "The same from the start of the Test Set for IVP Solvers" },
    SceneEntry {
        name: "governor",
        summary: "A flyball governor on springs of 800 kN/m and dampers of 40 kN s/m (A05)",
    },
    SceneEntry {
        name: "car-axis",
        summary: "A chassis on stiff springs over a bumpy road (Test Set for IVP Solvers)",
    },
    SceneEntry { name: "rssr", summary: "A crank drives a rocker in space by a coupler on two ball joints" },
    SceneEntry { name: "crank-rocker", summary: "A Grashof four-bar whose crank turns at 5 rad/s" },
];

/// Scenes that are plain data.
const FIXED: &[(&str, &str)] = &[
    ("simple-pendulum", include_str!("catalogue/simple-pendulum.json")),
    ("spatial-double-pendulum", include_str!("catalogue/spatial-double-pendulum.json")),
    ("free-body", include_str!("catalogue/free-body.json")),
    ("free-body-flip", include_str!("catalogue/free-body-flip.json")),
    ("free-fall", include_str!("catalogue/free-fall.json")),
    ("heavy-top", include_str!("catalogue/heavy-top.json")),
    ("bricard", include_str!("catalogue/bricard.json")),
    ("spatial-slider-crank", include_str!("catalogue/spatial-slider-crank.json")),
    ("squeezer", include_str!("catalogue/squeezer.json")),
    ("squeezer:ivp", include_str!("catalogue/squeezer-ivp.json")),
    ("governor", include_str!("catalogue/governor.json")),
    ("car-axis", include_str!("catalogue/car-axis.json")),
    ("rssr", include_str!("catalogue/rssr.json")),
    ("crank-rocker", include_str!("catalogue/crank-rocker.json")),
];

/// Why there is no such built-in scene.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CatalogueError {
    /// No scene of that name.
    #[error("there is no built-in scene \"{name}\"")]
    Unknown {
        /// The name.
        name: String,
        /// One that is nearly the same.
        nearest: Option<String>,
    },
    /// A family that needs a number, or a number out of its range.
    #[error("\"{family}\" needs a whole number from {low} to {high} after a colon, not \"{number}\"")]
    Number {
        /// The family.
        family: &'static str,
        /// What was written.
        number: String,
        /// Least number.
        low: usize,
        /// Greatest number.
        high: usize,
    },
}

impl CatalogueError {
    /// Stable name of the kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Unknown { .. } => "unknown-scene",
            Self::Number { .. } => "scene-number",
        }
    }

    /// What to try.
    pub fn hint(&self) -> String {
        match self {
            Self::Unknown { nearest: Some(nearest), .. } => format!("Did you mean \"{nearest}\"?"),
            Self::Unknown { nearest: None, .. } => {
                let names: Vec<&str> = ENTRIES.iter().map(|e| e.name).collect();
                format!("Built-in scenes: {}.", names.join(", "))
            }
            Self::Number { family, .. } => format!("For example \"{family}:2\"."),
        }
    }
}

/// The built-in scene of a name such as `simple-pendulum` or `n-four-bar:40`.
///
/// # Errors
///
/// [`CatalogueError`]: a name that no built-in scene has, with the nearest one, or a number outside its range.
pub fn scene(name: &str) -> Result<Scene, CatalogueError> {
    if let Some((_, text)) = FIXED.iter().find(|(fixed, _)| *fixed == name) {
        // The texts are checked by a test; a broken one must still not panic.
        return Scene::from_json(text)
            .map_err(|_| CatalogueError::Unknown { name: name.to_owned(), nearest: None });
    }
    let (family, number) = name.split_once(':').unwrap_or((name, ""));
    if family == "n-four-bar" {
        return ranged("n-four-bar", number, 1, 1000).map(four_bar::scene);
    }
    if family == "spatial-chain" {
        return ranged("spatial-chain", number, 1, MAX_BODIES).map(chain::scene);
    }
    if let ("spatial-slider-crank", "file" | "slender" | "mbdyn") = (family, number) {
        return scene("spatial-slider-crank").map(|base| slider_crank_variant(base, number));
    }
    let names = ENTRIES.iter().map(|e| e.name);
    Err(CatalogueError::Unknown { name: name.to_owned(), nearest: nearest_name(name, names) })
}

/// The readings of the slider-crank's printed data: `file` is the scene as it stands.
fn slider_crank_variant(mut scene: Scene, variant: &str) -> Scene {
    scene.name = format!("{}-{variant}", scene.name);
    for body in &mut scene.bodies {
        match (body.name.as_str(), variant) {
            ("rod", "slender" | "mbdyn") => body.inertia = Some(Inertia::Principal([4e-4, 4e-3, 4e-3])),
            ("crank", "mbdyn") => body.center_of_mass = [0.0; 3],
            _ => {}
        }
    }
    scene
}

fn ranged(family: &'static str, number: &str, low: usize, high: usize) -> Result<usize, CatalogueError> {
    number.parse().ok().filter(|n| (low..=high).contains(n)).ok_or_else(|| CatalogueError::Number {
        family,
        number: number.to_owned(),
        low,
        high,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_misspelt_name_is_answered_with_the_nearest() {
        let error = scene("simple-pendulm").unwrap_err();
        assert_eq!(error.hint(), "Did you mean \"simple-pendulum\"?");
        assert_eq!(scene("n-four-bar:0").unwrap_err().code(), "scene-number");
    }
}
