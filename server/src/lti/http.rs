//! Asking a platform: bounded in time and size, encrypted wherever it leaves the machine, and never sent on to elsewhere.

use std::sync::OnceLock;
use std::time::Duration;

use axum::http::{HeaderMap, Method, Request, StatusCode, header};
use http_body_util::{BodyExt, Full, Limited};
use hyper::body::Bytes;
use hyper_rustls::{HttpsConnector, HttpsConnectorBuilder};
use hyper_util::client::legacy::Client;
use hyper_util::client::legacy::connect::HttpConnector;
use hyper_util::rt::TokioExecutor;
use tokio::time::timeout;

use super::address::safe;

/// How long an answer may take, from the first byte that we send: a request of the page waits for it.
const PATIENCE: Duration = Duration::from_secs(10);
/// Longest answer, in bytes: a page of a roster of thousands is some hundred kilobytes.
const LONGEST: usize = 2 << 20;

type Encrypted = Client<HttpsConnector<HttpConnector>, Full<Bytes>>;

/// Asks platforms.
#[derive(Debug)]
pub struct Http {
    plain: Client<HttpConnector, Full<Bytes>>,
    /// Made when it is first needed: it reads the machine's certificates.
    encrypted: OnceLock<Result<Encrypted, String>>,
}

/// An answer, whatever its status.
#[derive(Debug, Clone)]
pub struct Answer {
    /// Its status.
    pub status: StatusCode,
    /// Its head.
    pub headers: HeaderMap,
    /// Its body.
    pub body: Bytes,
}

/// Why there is no answer.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Failure {
    /// It is no address that may be asked.
    #[error("{0} is not encrypted")]
    Unsafe(String),
    /// This machine trusts nobody.
    #[error("this machine has no certificates of authorities: install ca-certificates ({0})")]
    NoRoots(String),
    /// No connection, or it broke.
    #[error("it cannot be reached: {0}")]
    Unreachable(String),
    /// No answer in time.
    #[error("it does not answer within {} s", PATIENCE.as_secs())]
    Late,
    /// Too long an answer, or one that broke off.
    #[error("its answer is longer than {} MB, or broke off", LONGEST >> 20)]
    Broken,
}

impl Default for Http {
    fn default() -> Self {
        Self::new()
    }
}

impl Http {
    /// Nothing is connected yet.
    pub fn new() -> Self {
        Self { plain: Client::builder(TokioExecutor::new()).build_http(), encrypted: OnceLock::new() }
    }

    /// Asks for what is at an address.
    ///
    /// Errors if there is no answer.
    pub async fn get(&self, url: &str, headers: &[(header::HeaderName, &str)]) -> Result<Answer, Failure> {
        self.send(Method::GET, url, headers, String::new()).await
    }

    /// Sends something to an address.
    ///
    /// Errors if there is no answer: then it may have arrived all the same.
    pub async fn post(
        &self,
        url: &str,
        headers: &[(header::HeaderName, &str)],
        body: String,
    ) -> Result<Answer, Failure> {
        self.send(Method::POST, url, headers, body).await
    }

    async fn send(
        &self,
        method: Method,
        url: &str,
        headers: &[(header::HeaderName, &str)],
        body: String,
    ) -> Result<Answer, Failure> {
        let address = safe(url).ok_or_else(|| Failure::Unsafe(url.to_owned()))?;
        let unreachable = |error: &dyn std::fmt::Display| Failure::Unreachable(error.to_string());
        let mut request = Request::builder().method(method).uri(address.as_str());
        for (name, value) in headers {
            request = request.header(name, *value);
        }
        let request = request
            .header(header::USER_AGENT, concat!("triad/", env!("CARGO_PKG_VERSION")))
            .body(Full::new(Bytes::from(body)))
            .map_err(|error| unreachable(&error))?;
        let asked = async {
            let response = if address.scheme() == "https" {
                self.encrypted()?.request(request).await
            } else {
                self.plain.request(request).await
            };
            let (head, body) = response.map_err(|error| Failure::Unreachable(whole(&error)))?.into_parts();
            let body = Limited::new(body, LONGEST).collect().await.map_err(|_| Failure::Broken)?;
            Ok(Answer { status: head.status, headers: head.headers, body: body.to_bytes() })
        };
        timeout(PATIENCE, asked).await.map_err(|_| Failure::Late)?
    }

    fn encrypted(&self) -> Result<&Encrypted, Failure> {
        let made = self.encrypted.get_or_init(|| {
            let provider = rustls::crypto::ring::default_provider();
            let builder = HttpsConnectorBuilder::new().with_provider_and_native_roots(provider);
            let builder = builder.map_err(|error| error.to_string())?;
            let connector = builder.https_only().enable_http1().build();
            Ok(Client::builder(TokioExecutor::new()).build(connector))
        });
        made.as_ref().map_err(|error| Failure::NoRoots(error.clone()))
    }
}

/// An error with what caused it: the first is often only that there was one.
fn whole(error: &dyn std::error::Error) -> String {
    let causes = std::iter::successors(Some(error), |error| error.source());
    causes.map(ToString::to_string).collect::<Vec<_>>().join(": ")
}
