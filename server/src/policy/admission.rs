//! Whether something may be handed in now.

use super::moment::Moment;
use super::rules::{Extension, Policy};

/// Why something may not be handed in now.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// It is too early.
    #[error("this exercise can be handed in from {0}")]
    NotOpen(Moment),
    /// It is too late.
    #[error("this exercise could be handed in until {0}")]
    Closed(Moment),
    /// All attempts are used.
    #[error("all {0} attempts at this exercise are used")]
    AttemptsUsed(u32),
    /// The last attempt was a moment ago.
    #[error("the next attempt at this exercise can be made at {0}")]
    TooSoon(Moment),
}

/// Errors if somebody whose attempts were made at `attempts` may not hand in at `now`. What cannot be judged, and so is no
/// attempt, is bounded by the dates alone.
pub fn admit(
    policy: &Policy,
    extension: Option<&Extension>,
    attempts: &[Moment],
    is_attempt: bool,
    now: Moment,
) -> Result<(), Refusal> {
    let times = policy.times(extension);
    if let Some(opens) = times.opens.filter(|opens| now < *opens) {
        return Err(Refusal::NotOpen(opens));
    }
    if let Some(closes) = times.closes.filter(|closes| now > *closes) {
        return Err(Refusal::Closed(closes));
    }
    if !is_attempt {
        return Ok(());
    }
    let most = policy.attempts(extension);
    if let Some(most) = most.filter(|most| attempts.len() >= usize::try_from(*most).unwrap_or(usize::MAX)) {
        return Err(Refusal::AttemptsUsed(most));
    }
    match next_attempt(policy, attempts) {
        Some(next) if now < next => Err(Refusal::TooSoon(next)),
        _ => Ok(()),
    }
}

/// From when the next attempt can be made, as far as the last one says.
pub(super) fn next_attempt(policy: &Policy, attempts: &[Moment]) -> Option<Moment> {
    let pause = i64::from(policy.cooldown_minutes) * 60_000;
    attempts.iter().max().filter(|_| pause > 0).map(|last| last.after(pause))
}
