//! Words of the command line that choose an integrator, a treatment of the constraints or coordinates.

use triad_engine::scene::{ConstraintMethod, Coordinates, IntegratorKind, Output, UnknownWord};

/// The integrator of that name.
pub(super) fn integrator(word: &str) -> Result<IntegratorKind, String> {
    word.parse().map_err(|UnknownWord(_)| {
        // One is solved together with a treatment, which brings it along: asked for without that it is refused.
        let alone = IntegratorKind::ALL.into_iter().filter(|kind| *kind != IntegratorKind::Trapezoidal);
        let words: Vec<String> = alone.map(|kind| kind.to_string()).collect();
        format!(
            "no such integrator; there are {}, and trapezoidal with the treatment augmented-lagrangian",
            words.join(", ")
        )
    })
}

/// The treatment of that name, with its usual strength.
pub(super) fn treatment(word: &str) -> Result<ConstraintMethod, String> {
    word.parse().map_err(|UnknownWord(words)| format!("no such treatment; there are {words}"))
}

/// The coordinates of that name.
pub(super) fn coordinates(word: &str) -> Result<Coordinates, String> {
    word.parse().map_err(|UnknownWord(words)| format!("no such coordinates; there are {words}"))
}

/// The output of that name.
pub(super) fn output(word: &str) -> Result<Output, String> {
    word.parse().map_err(|UnknownWord(words)| format!("no such output; there are {words}"))
}

/// A time that something may take, s.
pub(super) fn seconds(word: &str) -> Result<f64, String> {
    let seconds: f64 = word.parse().map_err(|_| "not a number of seconds".to_owned())?;
    if seconds > 0.0 {
        Ok(seconds)
    } else {
        Err("it must be above 0, as nothing is computed in no time".to_owned())
    }
}

/// The words of `simulation.skip`, and one for all of them.
pub(super) fn skip_words() -> Vec<&'static str> {
    triad_engine::scene::Skip::WORDS.into_iter().chain(["all"]).collect()
}
