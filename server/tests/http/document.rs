//! The description of the interface, scenes and the page.

use std::collections::BTreeSet;
use std::io::Read;

use axum::body::Body;
use axum::http::{Request, header};
use brotli_decompressor::Decompressor;
use flate2::read::GzDecoder;
use serde_json::json;

use crate::{Reply, get, post, send, server};

/// `TRIAD_WRITE_GOLDEN=1 cargo test` writes the file anew; the difference belongs into the same change.
#[tokio::test]
async fn the_description_is_the_one_that_was_reviewed() {
    let server = server();
    let document = get(&server, "/api/openapi.json").await.json();
    let written = serde_json::to_string_pretty(&document).expect("JSON") + "\n";
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/openapi.json");
    if std::env::var_os("TRIAD_WRITE_GOLDEN").is_some() {
        std::fs::write(path, &written).expect("writes");
    }
    let reviewed = std::fs::read_to_string(path).expect("openapi.json");
    assert!(
        reviewed == written,
        "server/openapi.json differs: set TRIAD_WRITE_GOLDEN=1, test again, read the change"
    );
    let mut names = BTreeSet::new();
    for (path, item) in document["paths"].as_object().expect("paths") {
        for (method, operation) in item.as_object().expect("methods") {
            assert!(operation["tags"].is_array(), "{method} {path} has no tag");
            assert!(operation["summary"].is_string(), "{method} {path} has no summary");
            let name = operation["operationId"].as_str().expect("a name");
            assert!(names.insert(name.to_owned()), "{method} {path}: a second {name}");
        }
    }
}

#[tokio::test]
async fn scenes_are_listed_shown_checked_and_described() {
    let server = server();
    let list = get(&server, "/api/v1/scenes").await.json();
    assert!(list.as_array().is_some_and(|list| list.iter().any(|entry| entry["name"] == "free-body")));
    let scene = get(&server, "/api/v1/scenes/n-four-bar:2").await.json();
    assert_eq!(scene["bodies"].as_array().map(Vec::len), Some(5));
    let report = post(&server, "/api/v1/check", scene).await.json();
    assert_eq!((&report["bodies"], &report["degrees_of_freedom"]), (&json!(5), &json!(1)));
    assert!(report["redundant"].as_array().is_some_and(|list| !list.is_empty()));
    let schema = get(&server, "/api/v1/schema/scene").await.json();
    assert!(schema["properties"]["bodies"].is_object());
}

#[tokio::test]
async fn the_page_is_sent_compressed_and_kept_only_where_its_name_has_a_hash() {
    let server = server();
    let page = get(&server, "/").await;
    assert_eq!(page.headers[header::CACHE_CONTROL], "no-cache");
    assert!(page.headers.contains_key(header::CONTENT_SECURITY_POLICY));
    let script = script(&page);
    let plain = get(&server, &script).await;
    assert_eq!(plain.headers[header::CACHE_CONTROL], "public, max-age=31536000, immutable");
    let request = Request::get(&script).header(header::ACCEPT_ENCODING, "gzip, deflate, br");
    let packed = send(&server, request.body(Body::empty()).expect("a request")).await;
    assert_eq!(packed.headers[header::CONTENT_ENCODING], "br");
    assert!(packed.bytes.len() < plain.bytes.len() / 2);
    let known = Request::get(&script).header(header::IF_NONE_MATCH, plain.headers[header::ETAG].clone());
    let unchanged = send(&server, known.body(Body::empty()).expect("a request")).await;
    assert_eq!((unchanged.status.as_u16(), unchanged.bytes.len()), (304, 0));
}

/// The program that the page loads.
fn script(page: &Reply) -> String {
    let html = String::from_utf8(page.bytes.to_vec()).expect("text");
    let start = html.find("/assets/index-").expect("the page loads its program");
    html[start..].chars().take_while(|c| *c != '"').collect()
}

#[tokio::test]
async fn a_file_is_the_same_whatever_the_browser_unpacks() {
    let server = server();
    let path = script(&get(&server, "/").await);
    let ask = async |method: &str, encodings: &str| {
        let request = Request::builder().method(method).uri(&path).header(header::ACCEPT_ENCODING, encodings);
        send(&server, request.body(Body::empty()).expect("a request")).await
    };
    let plain = ask("GET", "identity").await;
    assert!(!plain.headers.contains_key(header::CONTENT_ENCODING));
    let [first, again] = [ask("GET", "gzip, deflate").await, ask("GET", "br;q=0, gzip").await];
    assert_eq!(first.headers[header::CONTENT_ENCODING], "gzip");
    assert_eq!(first.bytes.as_ptr(), again.bytes.as_ptr(), "packed once");
    let brotli = ask("GET", "gzip, br").await;
    assert!(brotli.bytes.len() < first.bytes.len() && first.bytes.len() < plain.bytes.len() / 2);
    assert_eq!(unpacked(GzDecoder::new(&first.bytes[..])), plain.bytes);
    assert_eq!(unpacked(Decompressor::new(&brotli.bytes[..], 4096)), plain.bytes);
    let head = ask("HEAD", "gzip").await;
    assert_eq!(
        (head.status.as_u16(), &head.headers[header::CONTENT_ENCODING]),
        (200, &first.headers[header::CONTENT_ENCODING])
    );
    for reply in [&plain, &first, &brotli, &head] {
        assert_eq!(reply.headers[header::ETAG], plain.headers[header::ETAG]);
        assert_eq!(reply.headers[header::VARY], "accept-encoding");
    }
}

fn unpacked(mut source: impl Read) -> Vec<u8> {
    let mut bytes = Vec::new();
    source.read_to_end(&mut bytes).expect("unpacks");
    bytes
}
