//! Whether an analysis is still wanted.

use super::AnalysisError;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A word to an analysis in another thread that nobody waits for it any more: it ends before its next step.
///
/// ```
/// use triad_engine::analysis::Wanted;
///
/// let wanted = Wanted::default();
/// wanted.clone().no_longer();
/// assert!(!wanted.is_still());
/// ```
#[derive(Clone, Debug, Default)]
pub struct Wanted(Arc<AtomicBool>);

impl Wanted {
    /// Nobody waits for it any more.
    pub fn no_longer(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether somebody waits for it.
    pub fn is_still(&self) -> bool {
        !self.0.load(Ordering::Relaxed)
    }

    /// Goes on only if somebody waits for it.
    ///
    /// # Errors
    ///
    /// [`AnalysisError::NoLongerWanted`].
    pub fn check(&self) -> Result<(), AnalysisError> {
        if self.is_still() { Ok(()) } else { Err(AnalysisError::NoLongerWanted) }
    }
}
