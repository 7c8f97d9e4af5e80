//! The request that is being answered: its name is in the answer, in each line of the log about it, and in a problem that it meets.

use std::future::Future;
use std::sync::Arc;

use axum::http::{HeaderMap, HeaderName, HeaderValue};

/// Where a proxy names a request, and an answer tells the name.
pub const HEADER: HeaderName = HeaderName::from_static("x-request-id");
/// Longest name that is taken over.
const LONGEST: usize = 64;

tokio::task_local! {
    static CURRENT: RequestId;
}

/// The name of a request.
#[derive(Debug, Clone)]
pub struct RequestId(Arc<str>);

impl RequestId {
    /// The name that a proxy gave, if it can stand in a log as it is, else one that was never used.
    pub fn of(headers: &HeaderMap) -> Self {
        let given = headers.get(HEADER).and_then(|value| value.to_str().ok());
        let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
        let given = given.filter(|id| (1..=LONGEST).contains(&id.len()) && id.chars().all(plain));
        Self(given.map_or_else(|| fresh().into(), Into::into))
    }

    /// The name.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// The name as the value of a header.
    pub fn header(&self) -> Option<HeaderValue> {
        HeaderValue::from_str(&self.0).ok()
    }

    /// Answers under this name.
    pub async fn name<T>(self, answering: impl Future<Output = T>) -> T {
        CURRENT.scope(self, answering).await
    }
}

/// The name of the request that is being answered; outside of one, a name that was never used.
pub fn current() -> String {
    CURRENT.try_with(|id| id.0.to_string()).unwrap_or_else(|_| fresh())
}

fn fresh() -> String {
    uuid::Uuid::new_v4().simple().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn a_plain_name_is_taken_over_and_any_other_is_replaced() {
        let of = |text: &str| {
            let mut headers = HeaderMap::new();
            headers.insert(HEADER, HeaderValue::from_str(text).expect("a header"));
            RequestId::of(&headers).as_str().to_owned()
        };
        assert_eq!(of("edge-1.Ab_2"), "edge-1.Ab_2");
        for other in ["", "two words", "{\"id\":1}", &"a".repeat(65)] {
            assert_ne!(of(other), other);
            assert_eq!(of(other).len(), 32, "{other}");
        }
        let id = RequestId::of(&HeaderMap::new());
        let name = id.as_str().to_owned();
        assert_eq!(id.name(async { current() }).await, name);
        assert_ne!(current(), name);
    }
}
