//! The stream of a lecture, over a WebSocket.
//!
//! Text messages are JSON: `{"type":"room",…}` when the presenter shows or asks something else, `{"type":"state",…}` at
//! most ten times a second, `{"type":"reset"}` when a run begins (its motion so far must be forgotten),
//! `{"type":"closed"}` at the end. Binary messages are those of a session's stream: numbers for a drawing, or
//! RRD blocks with `?recording=true`. A follower may send `{"roaming":true,"hand":true}`, which counts until it says something
//! else or leaves. A follower that is slow misses states, never the newest one, and reads the recording on from
//! where it is.

use axum::extract::ws::{CloseFrame, Message};
use axum::extract::{Request, State};
use axum::response::Response;
use tokio::time::{MissedTickBehavior, interval};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas};
use crate::api::extract::{PathParameters, QueryParameters};
use crate::api::sessions::stream::{Disconnected, PING_INTERVAL, ViewerSocket, upgrade};
use crate::app::App;
use crate::lecture::{Follower, LectureMessage, LiveView, Presence};
use crate::problem::Problem;
use crate::session::{StreamWish, Watched};
use crate::stream::{Delivery, Watcher};

/// Longest text that a follower may send, bytes: two words that are true or false.
const MAX_TOLD: usize = 100;

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<LectureMessage<'_>>();
    OpenApiRouter::new().routes(routes!(follow))
}

/// Follow a lecture: a WebSocket of what is shown and asked and of states (text) and of the motion (binary).
#[utoipa::path(get, path = "/rooms/{code}/stream", operation_id = "follow_lecture", tag = "rooms", params(("code" = String, Path),
    ("recording" = Option<bool>, Query, description = "Send RRD blocks instead of numbers")), responses(
    (status = 101, description = "The socket is open"),
    (status = 404, description = "No such room", body = ref(PROBLEM)),
    (status = 426, description = "The request is not a WebSocket's", body = ref(PROBLEM)),
    (status = 503, description = "The room is full", body = ref(PROBLEM))))]
async fn follow(
    State(app): State<App>,
    PathParameters(code): PathParameters<String>,
    QueryParameters(wish): QueryParameters<StreamWish>,
    request: Request,
) -> Result<Response, Problem> {
    let lecture = app.lectures.get(&code)?;
    let upgrade = upgrade(&app, request).await?;
    let follower = lecture.join()?;
    drop(lecture);
    let patience = app.limits.stalled_viewer;
    Ok(upgrade.on_upgrade(move |socket| async move {
        let viewer = ViewerSocket { socket, patience };
        // However it ends, the follower is given back.
        app.streams.serve(async move { drop(follow_on(viewer, follower, wish.watched()).await) });
    }))
}

async fn follow_on(
    mut viewer: ViewerSocket,
    mut follower: Follower,
    watched: Watched,
) -> Result<(), Disconnected> {
    let mut watcher: Option<Watcher> = None;
    let mut ping = interval(PING_INTERVAL);
    ping.set_missed_tick_behavior(MissedTickBehavior::Delay);
    follower.live.mark_changed();
    follower.public.mark_changed();
    follower.state.mark_changed();
    loop {
        tokio::select! {
            received = viewer.socket.recv() => match received {
                // What else followers say is ignored.
                Some(Ok(Message::Text(text))) => {
                    if let Some(presence) = told(&text) {
                        follower.tell(presence);
                    }
                }
                Some(Ok(message)) if !matches!(message, Message::Close(_)) => {}
                _ => return Ok(()),
            },
            changed = follower.live.changed() => {
                let shown = changed.map_or(LiveView::Closed, |()| follower.live.borrow_and_update().clone());
                watcher = match shown {
                    LiveView::Closed => {
                        viewer.tell(&LectureMessage::Closed).await?;
                        return viewer.send(Message::Close(None)).await;
                    }
                    // 1012: the server is restarted (RFC 6455 and its registry).
                    LiveView::Away => {
                        let frame = CloseFrame { code: 1012, reason: "restart".into() };
                        return viewer.send(Message::Close(Some(frame))).await;
                    }
                    LiveView::Session(session) => {
                        viewer.tell(&LectureMessage::Reset).await?;
                        Some(session.watch(watched))
                    }
                    LiveView::Empty => None,
                };
            },
            changed = follower.public.changed() => {
                if changed.is_ok() {
                    let public = follower.public.borrow_and_update().clone();
                    viewer.send(Message::Text(public)).await?;
                }
            },
            changed = follower.state.changed() => {
                let state = follower.state.borrow_and_update().clone();
                if changed.is_ok() && !state.is_empty() {
                    viewer.send(Message::Text(state)).await?;
                }
            },
            delivery = next(&mut watcher) => match delivery {
                Some(Delivery::Blocks(blocks)) => viewer.blocks(blocks).await?,
                Some(Delivery::Restarted) => viewer.tell(&LectureMessage::Reset).await?,
                // The session is gone; the presenter may show another.
                None => watcher = None,
            },
            _ = ping.tick() => viewer.send(Message::Ping(axum::body::Bytes::new())).await?,
        }
    }
}

/// What a follower lets the presenter know.
fn told(text: &str) -> Option<Presence> {
    if text.len() > MAX_TOLD {
        return None;
    }
    serde_json::from_str(text).ok()
}

/// What comes next in the recording; waits for ever where none is watched.
async fn next(watcher: &mut Option<Watcher>) -> Option<Delivery> {
    match watcher {
        Some(watcher) => watcher.next().await,
        None => std::future::pending().await,
    }
}
