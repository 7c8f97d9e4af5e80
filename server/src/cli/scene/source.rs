//! Which scene a command is about, and in which coordinates.

use std::path::Path;

use clap::Args;
use triad_engine::scene::{Coordinates, Scene};

use crate::problem::Problem;
use crate::scenes;

/// A scene, and a choice that can be made for it.
#[derive(Debug, Args)]
pub(in crate::cli) struct Source {
    /// A built-in scene's name (`triad scenes` lists them), or a file.
    pub(super) scene: String,
    /// Coordinates of the bodies, instead of the scene's: full (12 a body), reduced (9) or shared (directors along the
    /// axes of joints are written once). A body that chooses for itself keeps its own.
    #[arg(long, value_name = "KIND", value_parser = crate::cli::choice::coordinates)]
    pub(super) coordinates: Option<Coordinates>,
}

impl Source {
    /// Reads the scene.
    pub(super) fn read(&self) -> Result<Scene, Problem> {
        let mut scene = scenes::named_or_in_file(&self.scene)?;
        scene.coordinates = self.coordinates.unwrap_or(scene.coordinates);
        Ok(scene)
    }

    /// The file that it is read from, if it is no built-in one.
    pub(super) fn file(&self) -> Option<&Path> {
        Some(Path::new(&self.scene)).filter(|path| path.is_file())
    }

    /// What the choice of coordinates does not do, in sentences.
    pub(super) fn notes(&self, scene: &Scene, by_series: bool) -> Vec<String> {
        let Some(asked) = self.coordinates else { return Vec::new() };
        let mut notes = Vec::new();
        let own = scene.bodies.iter().filter(|body| body.coordinates.is_some_and(|own| own != asked));
        let own: Vec<&str> = own.map(|body| body.name.as_str()).take(MOST_NAMED).collect();
        if !own.is_empty() {
            notes.push(format!(
                "--coordinates {asked} leaves bodies that choose for themselves as they are: {}",
                own.join(", ")
            ));
        }
        if by_series {
            notes.push(format!(
                "--coordinates {asked} changes how the equations are written, not how they are solved: the Taylor series \
                 treats all kinds of bodies alike; compare kinds with --integrator dop853"
            ));
        }
        notes
    }
}

/// Bodies that a note names.
const MOST_NAMED: usize = 4;
