//! A workbench at a path below another site's name.

use axum::body::Body;
use axum::http::{Request, header};
use serde_json::{Value, json};
use triad::access::Access;
use triad::limits::Limits;
use triad::store::{CLASS, Role};

use crate::{Reply, get, post, send, state};

fn location(reply: &Reply) -> &str {
    reply.headers[header::LOCATION].to_str().expect("text")
}

/// What stands in an attribute of a page, at every place.
fn all<'a>(page: &'a str, attribute: &str) -> Vec<&'a str> {
    let opening = format!(" {attribute}=\"");
    page.split(opening.as_str()).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

#[tokio::test]
async fn page_interface_and_documentation_stand_below_the_path() {
    let server = triad::app(state(Limits::default()).below("/school/triad"));
    for (path, to) in [
        ("/school/triad", "/school/triad/"),
        ("/school/triad?page=1", "/school/triad/?page=1"),
        ("/school/triad/docs", "/school/triad/docs/"),
        ("/school/triad/guide", "/school/triad/docs/scenes.html"),
    ] {
        let reply = get(&server, path).await;
        assert_eq!((reply.status.as_u16(), location(&reply)), (308, to), "{path}");
    }
    for elsewhere in ["/", "/school", "/school/triads", "/api/v1/lessons", "/school/triad../api/v1/lessons"] {
        let told = get(&server, elsewhere).await.problem(404, "not-found");
        assert!(told["hint"].as_str().expect("text").contains("/school/triad/"), "{told}");
    }
    for view in ["/school/triad/", "/school/triad/lessons/simple-pendulum"] {
        let page = get(&server, view).await;
        let page = String::from_utf8(page.bytes.to_vec()).expect("text");
        assert!(page.contains("<html data-base=\"/school/triad\" "), "{page}");
        let files: Vec<_> = [all(&page, "href"), all(&page, "src")]
            .concat()
            .into_iter()
            .filter(|at| !at.starts_with('#'))
            .collect();
        assert!(files.len() >= 3, "{files:?}");
        for file in files {
            assert_eq!(get(&server, file).await.status, 200, "{file}");
        }
    }
    let docs = get(&server, "/school/triad/docs/scenes.html").await;
    assert!(String::from_utf8_lossy(&docs.bytes).contains("<a href=\"../\">Workbench</a>"));
    let document = get(&server, "/school/triad/api/openapi.json").await.json();
    assert_eq!(document["servers"], json!([{"url": "/school/triad"}]));

    let session = post(&server, "/school/triad/api/v1/sessions", json!({"builtin": "free-fall"})).await;
    assert_eq!(session.status, 201);
    assert_eq!(get(&server, location(&session)).await.json()["id"], session.json()["id"]);
}

/// A cookie goes to nobody else on the host, whether it is sent encrypted or not.
#[tokio::test]
async fn cookies_are_held_to_the_path() {
    for (encrypted, head) in [(false, "triad="), (true, "__Secure-triad=")] {
        let app = state(Limits::default()).below("/triad");
        let row = app.store.ensure_course(CLASS, "Mechanics").await.expect("a class");
        let setup = app.store.invite(CLASS, "triad", Role::Owner).await.expect("an invitation");
        let access = Access::class(&row, encrypted).below("/triad");
        let server = triad::app(app.with_access(access));
        let body = json!({"token": setup, "name": "Prof"});
        let reply = post(&server, "/triad/api/v1/setup", body).await;
        let set = reply.headers[header::SET_COOKIE].to_str().expect("text");
        assert!(set.starts_with(head) && set.contains("; Path=/triad;"), "{set}");
        assert_eq!(set.contains("; Secure"), encrypted, "{set}");
        let cookie = set.split(';').next().unwrap_or_default();
        let request = Request::get("/triad/api/v1/me").header(header::COOKIE, cookie);
        let me: Value = send(&server, request.body(Body::empty()).expect("a request")).await.json();
        assert_eq!(me["person"]["name"], "Prof", "{me}");
    }
}
