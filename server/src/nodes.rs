//! Several servers on one gradebook: what lives in one of them, runs and lecture rooms, carries its name, and whoever is asked for
//! it elsewhere hands the request on.

use std::time::Duration;

use axum::body::Body;
use axum::extract::Request;
use axum::http::header::UPGRADE;
use axum::http::{HeaderName, HeaderValue, StatusCode, Version};
use axum::response::Response;
use hyper_util::rt::TokioIo;
use tokio::net::TcpStream;
use tokio::time::timeout;

use crate::problem::Problem;
use crate::request;
use crate::store::{Store, StoreError};

/// Letters of names and codes: none that is mistaken for another, no vowel that makes a word.
const LETTERS: &[u8; 28] = b"BCDFGHJKLMNPQRSTVWXZ23456789";
/// Letters in the name of a server: 784 names.
const NAME: usize = 2;
/// Letters in a room's code where one server has them all: 17 million codes, short enough to be read aloud.
const CODE: usize = 5;
/// Letters in a room's code after the name of its server: 600 thousand codes in each.
const CODE_OF_NODE: usize = 4;
/// Names that are tried: with a hundred servers one in eight is taken.
const TRIES: usize = 100;
/// How long another server may take to answer the telephone.
const PATIENCE: Duration = Duration::from_secs(3);
/// Says that another server handed the request on: it is not handed on again.
pub const HANDED_ON: HeaderName = HeaderName::from_static("x-triad-handed-on");

/// Random letters.
pub fn letters(count: usize) -> String {
    let random = uuid::Uuid::new_v4();
    // The first bytes of a random UUID are random; its version stands behind them.
    let bytes = random.as_bytes()[..count].iter();
    bytes.map(|byte| char::from(LETTERS[usize::from(*byte) % LETTERS.len()])).collect()
}

/// A server among several; one alone has no name.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Node {
    name: String,
    /// Host and port at which the others reach it.
    address: String,
}

impl Node {
    /// Takes its place among the servers of a gradebook: under the name that it had, where nobody else has that by now.
    ///
    /// Errors if the gradebook does not answer.
    pub async fn among(store: &Store, before: Option<String>, address: String) -> Result<Self, Problem> {
        let fresh = std::iter::repeat_with(|| letters(NAME)).take(TRIES);
        for name in before.filter(|name| is_name(name)).into_iter().chain(fresh) {
            if store.take_node(&name, &address).await? {
                return Ok(Self { name, address });
            }
        }
        Err(Problem::internal("all names of servers are taken"))
    }

    /// Its name; empty where it is alone.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// A new name for what lives here.
    pub fn identifier(&self) -> String {
        let id = crate::store::identifier();
        if self.name.is_empty() { id } else { format!("{}-{id}", self.name) }
    }

    /// A new code for a room.
    pub fn code(&self) -> String {
        if self.name.is_empty() { letters(CODE) } else { format!("{}{}", self.name, letters(CODE_OF_NODE)) }
    }

    /// The name of another server, in which `id` lives.
    pub fn other_of_id<'a>(&self, id: &'a str) -> Option<&'a str> {
        let (name, _) = id.split_once('-')?;
        self.other(name)
    }

    /// The name of another server, in which the room of that code is.
    pub fn other_of_code(&self, code: &str) -> Option<String> {
        let code = code.trim().to_uppercase();
        let name = (code.len() == NAME + CODE_OF_NODE).then(|| code.get(..NAME)).flatten()?;
        self.other(name).map(str::to_owned)
    }

    /// That name, if it is another's.
    pub fn other<'a>(&self, name: &'a str) -> Option<&'a str> {
        (!self.name.is_empty() && name != self.name && is_name(name)).then_some(name)
    }

    /// Lets itself be heard.
    ///
    /// Errors if the gradebook does not answer.
    pub async fn is_here(&self, store: &Store) -> Result<(), StoreError> {
        if !self.name.is_empty() && !store.take_node(&self.name, &self.address).await? {
            tracing::error!(target: "triad", node = self.name.as_str(), "another server has taken this one's name");
        }
        Ok(())
    }

    /// Says that it goes.
    ///
    /// Errors if the gradebook does not answer.
    pub async fn leaves(&self, store: &Store) -> Result<(), StoreError> {
        if self.name.is_empty() { Ok(()) } else { store.leave_node(&self.name, &self.address).await }
    }
}

fn is_name(name: &str) -> bool {
    name.len() == NAME && name.bytes().all(|byte| LETTERS.contains(&byte))
}

/// Hands a request on to the server at an address, a WebSocket too, and its answer back.
///
/// Errors if that does not answer.
pub async fn hand_on(address: &str, mut request: Request) -> Result<Response, Problem> {
    let connected = timeout(PATIENCE, TcpStream::connect(address)).await;
    let stream = connected.map_err(away)?.map_err(away)?;
    // Answers are short and wanted at once; where the system refuses they come a little later.
    drop(stream.set_nodelay(true));
    let handshake = hyper::client::conn::http1::handshake::<_, Body>(TokioIo::new(stream));
    let (mut sender, connection) = handshake.await.map_err(away)?;
    tokio::spawn(async move { drop(connection.with_upgrades().await) });

    let path = request.uri().path_and_query().map_or("/", |path| path.as_str());
    let path = path.parse().map_err(Problem::internal)?;
    *request.uri_mut() = path;
    *request.version_mut() = Version::HTTP_11;
    request.headers_mut().insert(HANDED_ON, HeaderValue::from_static("1"));
    if let Ok(name) = HeaderValue::from_str(&request::current()) {
        request.headers_mut().insert(request::HEADER, name);
    }
    let ours = request.headers().contains_key(UPGRADE).then(|| hyper::upgrade::on(&mut request));
    let mut response = sender.send_request(request).await.map_err(away)?;
    if response.status() == StatusCode::SWITCHING_PROTOCOLS
        && let Some(ours) = ours
    {
        let theirs = hyper::upgrade::on(&mut response);
        tokio::spawn(async move {
            if let (Ok(ours), Ok(theirs)) = tokio::join!(ours, theirs) {
                let (mut ours, mut theirs) = (TokioIo::new(ours), TokioIo::new(theirs));
                // However it ends, both sides see that it has.
                drop(tokio::io::copy_bidirectional(&mut ours, &mut theirs).await);
            }
        });
    }
    Ok(response.map(Body::new))
}

/// The other server is known and does not answer.
fn away(_: impl std::fmt::Display) -> Problem {
    Problem::new(
        StatusCode::SERVICE_UNAVAILABLE,
        "node-away",
        "this lives in another server, which does not answer at the moment",
        "ask again in a moment: it comes back, or is found to be gone",
    )
}

/// The other server is gone, and what lived in it.
pub fn gone() -> Problem {
    Problem::new(
        StatusCode::GONE,
        "node-gone",
        "this lived in a server that has gone",
        "start it again: the page does so by itself, at the time that was shown",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node(name: &str) -> Node {
        Node { name: name.to_owned(), address: String::new() }
    }

    #[test]
    fn what_lives_in_a_server_carries_its_name() {
        let (here, there) = (node("KX"), node("B2"));
        let (id, code) = (here.identifier(), here.code());
        assert_eq!((id.len(), code.len()), (35, 6));
        assert_eq!((here.other_of_id(&id), here.other_of_code(&code)), (None, None));
        assert_eq!((there.other_of_id(&id), there.other_of_code(&code)), (Some("KX"), Some("KX".to_owned())));
        assert_eq!(there.other_of_code(&format!(" {} ", code.to_lowercase())), Some("KX".to_owned()));
        for id in ["", "kx-1", "K-1", "KXB-1", "A0-1", "KX", "../-1"] {
            assert_eq!(there.other_of_id(id), None, "{id}");
        }
        assert_eq!(there.other_of_code("KXBCD"), None, "of a server that is alone");
        assert_eq!(there.other_of_code("ÄÖÜ"), None);
    }

    #[test]
    fn a_server_that_is_alone_names_nobody() {
        let alone = Node::default();
        assert_eq!((alone.identifier().len(), alone.code().len()), (32, 5));
        assert_eq!((alone.other_of_id("KX-1"), alone.other_of_code("KXBCDF")), (None, None));
    }
}
