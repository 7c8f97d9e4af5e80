//! What was found or corrected of a scene, and of the moment at which its run began.

use std::ops::Range;

/// Sentences about a scene, and about where its run began: at its start, or in the midst of another run.
#[derive(Clone, Debug)]
pub(crate) struct Notes {
    all: Vec<String>,
    /// Those of the beginning.
    of_beginning: Range<usize>,
    /// Those of the start, while the run is one that began elsewhere.
    of_start: Option<Vec<String>>,
}

impl Notes {
    /// The first `of_scene` are about the scene, the others about its start.
    pub fn new(all: Vec<String>, of_scene: usize) -> Self {
        Self { of_beginning: of_scene.min(all.len())..all.len(), all, of_start: None }
    }

    /// All of them.
    pub fn all(&self) -> &[String] {
        &self.all
    }

    /// One more about the scene.
    pub fn add(&mut self, note: String) {
        self.all.push(note);
    }

    /// One more about the start.
    pub fn add_of_start(&mut self, note: String) {
        self.all.insert(self.of_beginning.end, note);
        self.of_beginning.end += 1;
    }

    /// The run begins elsewhere, of which there is this to say.
    pub fn begin_elsewhere(&mut self, notes: Vec<String>) {
        let before = self.replace(notes);
        self.of_start.get_or_insert(before);
    }

    /// The run begins at its start.
    pub fn begin_at_start(&mut self) {
        if let Some(notes) = self.of_start.take() {
            self.replace(notes);
        }
    }

    fn replace(&mut self, notes: Vec<String>) -> Vec<String> {
        let end = self.of_beginning.start + notes.len();
        let before = self.all.splice(self.of_beginning.clone(), notes).collect();
        self.of_beginning.end = end;
        before
    }
}
