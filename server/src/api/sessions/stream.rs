//! The live stream of a session, over a WebSocket.
//!
//! Binary messages are blocks of the motion in numbers, as `stream/track.rs` packs them, from the beginning of the run;
//! with `?recording=true` complete RRD blocks for the rerun viewer instead. Text messages are JSON: `{"type":"state",…}` at most ten times a second, `{"type":"reset"}` when the recording begins anew (the
//! viewer must forget the old one), `{"type":"closed"}` at the end.

use std::sync::Arc;
use std::time::Duration;

use axum::extract::ws::rejection::WebSocketUpgradeRejection;
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::extract::{FromRequestParts, Request, State};
use axum::http::StatusCode;
use axum::response::Response;
use serde::Serialize;
use tokio::sync::watch;
use tokio::time::{Instant, MissedTickBehavior, interval, timeout};
use triad_session::{SessionMessage, SessionState};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::api::describe::{PROBLEM, Schemas};
use crate::api::extract::{PathParameters, QueryParameters};
use crate::app::App;
use crate::problem::Problem;
use crate::session::StreamWish;
use crate::stream::{Delivery, Watcher};

/// Pause between two states on one socket: ten a second, as often as tables can be read.
const STATE_INTERVAL: Duration = Duration::from_millis(100);
/// Time between two pings, so that no proxy closes a quiet connection.
pub(in crate::api) const PING_INTERVAL: Duration = Duration::from_secs(20);

pub(in crate::api) fn routes(schemas: &mut Schemas) -> OpenApiRouter<App> {
    schemas.answer::<SessionMessage<'_>>();
    OpenApiRouter::new().routes(routes!(stream))
}

/// Watch a session: a WebSocket of states (text) and of the motion (binary): numbers for a drawing, or RRD blocks for the rerun viewer.
#[utoipa::path(get, path = "/sessions/{id}/stream", operation_id = "stream_session", tag = "sessions", params(("id" = String, Path),
    ("recording" = Option<bool>, Query, description = "Send RRD blocks instead of numbers")), responses(
    (status = 101, description = "The socket is open"),
    (status = 404, description = "No such session", body = ref(PROBLEM)),
    (status = 426, description = "The request is not a WebSocket's", body = ref(PROBLEM))))]
async fn stream(
    State(app): State<App>,
    PathParameters(id): PathParameters<String>,
    QueryParameters(wish): QueryParameters<StreamWish>,
    request: Request,
) -> Result<Response, Problem> {
    let session = app.sessions.get(&id)?;
    let upgrade = upgrade(&app, request).await?;
    let patience = app.limits.stalled_viewer;
    Ok(upgrade.on_upgrade(move |socket| async move {
        let watcher = session.watch(wish.watched());
        let states = session.states();
        // The session may be deleted while it is watched.
        drop(session);
        app.streams.serve(ViewerSocket { socket, patience }.serve(watcher, states));
    }))
}

/// Makes a socket of a request that asks for one.
pub(in crate::api) async fn upgrade(app: &App, request: Request) -> Result<WebSocketUpgrade, Problem> {
    let (mut parts, _) = request.into_parts();
    let upgrade = WebSocketUpgrade::from_request_parts(&mut parts, app).await;
    let upgrade = upgrade.map_err(|rejection: WebSocketUpgradeRejection| {
        Problem::new(
            StatusCode::UPGRADE_REQUIRED,
            "not-a-websocket",
            format!("this address is a WebSocket: {}", rejection.body_text()),
            "open it with new WebSocket(…), or read the address above it",
        )
    })?;
    Ok(upgrade.max_message_size(4096))
}

/// The open socket of one viewer.
pub(in crate::api) struct ViewerSocket {
    pub socket: WebSocket,
    /// How long a message may wait for a viewer that reads nothing.
    pub patience: Duration,
}

/// The other side has gone, or reads nothing.
pub(in crate::api) struct Disconnected;

impl ViewerSocket {
    async fn serve(mut self, mut watcher: Watcher, mut states: watch::Receiver<Arc<SessionState>>) {
        let mut state_timer = interval(STATE_INTERVAL);
        state_timer.set_missed_tick_behavior(MissedTickBehavior::Delay);
        states.mark_changed();
        let mut last_ping = Instant::now();
        loop {
            let sent = tokio::select! {
                received = self.socket.recv() => match received {
                    // Nothing that a watcher says changes the session.
                    Some(Ok(message)) if !matches!(message, Message::Close(_)) => Ok(()),
                    _ => return,
                },
                delivery = watcher.next() => match delivery {
                    Some(Delivery::Blocks(blocks)) => self.blocks(blocks).await,
                    Some(Delivery::Restarted) => self.tell(&SessionMessage::Reset).await,
                    None => return self.finish(watcher).await,
                },
                _ = state_timer.tick() => match states.has_changed() {
                    Ok(true) => {
                        let state = Arc::clone(&states.borrow_and_update());
                        self.tell(&SessionMessage::State(&state)).await
                    }
                    Ok(false) if last_ping.elapsed() > PING_INTERVAL => {
                        last_ping = Instant::now();
                        self.send(Message::Ping(axum::body::Bytes::new())).await
                    }
                    Ok(false) => Ok(()),
                    // The worker is gone, and with it the session.
                    Err(_) => return self.finish(watcher).await,
                },
            };
            if sent.is_err() {
                return;
            }
        }
    }

    /// Sends what is left of the recording, and says that it was all.
    async fn finish(mut self, mut watcher: Watcher) {
        while let Some(delivery) = watcher.poll() {
            let sent = match delivery {
                Delivery::Blocks(blocks) => self.blocks(blocks).await,
                Delivery::Restarted => self.tell(&SessionMessage::Reset).await,
            };
            if sent.is_err() {
                return;
            }
        }
        drop(self.tell(&SessionMessage::Closed).await);
        drop(self.send(Message::Close(None)).await);
    }

    pub async fn blocks(&mut self, blocks: Vec<axum::body::Bytes>) -> Result<(), Disconnected> {
        for block in blocks {
            self.send(Message::Binary(block)).await?;
        }
        Ok(())
    }

    pub async fn tell(&mut self, message: &impl Serialize) -> Result<(), Disconnected> {
        let text = serde_json::to_string(message).map_err(|_| Disconnected)?;
        self.send(Message::Text(text.into())).await
    }

    pub async fn send(&mut self, message: Message) -> Result<(), Disconnected> {
        match timeout(self.patience, self.socket.send(message)).await {
            Ok(Ok(())) => Ok(()),
            Ok(Err(_)) | Err(_) => Err(Disconnected),
        }
    }
}
