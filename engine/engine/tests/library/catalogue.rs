//! Built-in scenes are mechanisms that start.

use triad_engine::catalogue;
use triad_engine::run::Simulation;

#[test]
fn every_scene_of_the_list_starts() {
    for entry in catalogue::ENTRIES {
        let name = entry.name.replace(":N", ":3");
        let scene = catalogue::scene(&name).unwrap();
        assert_eq!(scene.name, name.replace(':', "-"));
        Simulation::new(&scene).unwrap();
    }
}
