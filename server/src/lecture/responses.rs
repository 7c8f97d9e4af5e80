//! What followers ask about one state of the run, computed once for all of them.

use std::collections::HashMap;
use std::sync::Arc;

use axum::body::Bytes;
use serde::Serialize;
use tokio::sync::Mutex;

use crate::problem::Problem;
use crate::session::Session;

/// Bytes of responses that a room keeps beside the newest one; when there are more, all are dropped. The matrices of a large
/// mechanism have some hundred kilobytes, and each follower may look back at a time of their own.
const MOST_KEPT: usize = 4 << 20;

/// Responses about one state of a run, for the followers who ask next.
#[derive(Debug, Default)]
pub struct Responses(Mutex<Kept>);

#[derive(Debug, Default)]
struct Kept {
    /// The state that they are about.
    state: String,
    texts: HashMap<String, Bytes>,
    bytes: usize,
}

impl Responses {
    /// The response to `what`, as JSON: kept from somebody who asked before at the same state, or from `ask`.
    ///
    /// Errors as `ask` does.
    pub async fn of<T: Serialize, F: Future<Output = Result<T, Problem>>>(
        &self,
        session: Arc<Session>,
        what: &str,
        ask: impl FnOnce(Arc<Session>) -> F,
    ) -> Result<Bytes, Problem> {
        // Requests that arrive meanwhile wait here and find the response.
        let mut kept = self.0.lock().await;
        let state = session.state();
        let state = format!("{} {} {} {}", state.id, state.time, state.changes, state.pull.is_some());
        if kept.state != state {
            *kept = Kept { state, ..Kept::default() };
        }
        if let Some(text) = kept.texts.get(what) {
            return Ok(text.clone());
        }
        let text = Bytes::from(serde_json::to_vec(&ask(session).await?).map_err(Problem::internal)?);
        kept.keep(what, &text);
        Ok(text)
    }
}

impl Kept {
    fn keep(&mut self, what: &str, text: &Bytes) {
        if self.bytes + text.len() > MOST_KEPT {
            self.texts.clear();
            self.bytes = 0;
        }
        self.bytes += text.len();
        self.texts.insert(what.to_owned(), text.clone());
    }
}

#[cfg(test)]
mod tests {
    use super::{Bytes, Kept, MOST_KEPT};

    #[test]
    fn responses_are_kept_up_to_a_number_of_bytes_however_many_moments_are_asked_for() {
        let mut kept = Kept::default();
        let text = Bytes::from(vec![b'0'; 300 << 10]);
        for moment in 0..200 {
            kept.keep(&format!("jacobian {moment}"), &text);
            let bytes: usize = kept.texts.values().map(Bytes::len).sum();
            assert_eq!(bytes, kept.bytes);
            assert!(bytes <= MOST_KEPT && kept.texts.contains_key(&format!("jacobian {moment}")));
        }
        assert!(kept.texts.len() > 1, "several moments are kept");
        // One that is larger alone is there for the next who asks for it.
        kept.keep("all", &Bytes::from(vec![b'0'; MOST_KEPT + 1]));
        assert_eq!(kept.texts.len(), 1);
    }
}
