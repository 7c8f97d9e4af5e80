//! Words of the command line that choose an integrator or a treatment of the constraints.

use triad_engine::scene::{IntegratorKind, Stabilization};

/// The integrator of that name.
pub(super) fn integrator(word: &str) -> Result<IntegratorKind, String> {
    IntegratorKind::named(word).ok_or_else(|| {
        let words: Vec<&str> = IntegratorKind::ALL.iter().map(|kind| kind.word()).collect();
        format!("no such integrator; there are auto, {}", words.join(", "))
    })
}

/// The treatment of that name, with its usual strength.
pub(super) fn treatment(word: &str) -> Result<Stabilization, String> {
    Stabilization::named(word).ok_or_else(|| {
        "no such treatment; there are projection, baumgarte, partitioning, penalty, augmented-lagrangian"
            .to_owned()
    })
}
