//! Lectures: one session that a presenter leads and many follow.
//!
//! ```text
//! session ─▶ state, encoded once ─┐
//! presenter ─▶ board, encoded once ┼─▶ follower, follower, …   (each holds only its place)
//! session ─▶ recording (Hub) ─────┘
//! ```
//!
//! Followers never learn the session's own name, with which it could be steered, nor the answer to a question before
//! it is revealed.

mod question;
mod registry;

pub use question::{NewQuestion, QuestionView, Tally, Vote};
pub use registry::Rooms;

use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};

use axum::extract::ws::Utf8Bytes;
use axum::http::StatusCode;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;
use tokio::sync::watch;

use crate::problem::Problem;
use crate::session::{Links, Session, SessionState, Source};
use question::Question;

/// Between two states that followers are sent.
const STATE_INTERVAL: Duration = Duration::from_millis(100);
/// Bytes of what the presenter shows beside the run.
const MOST_VIEW: usize = 64 << 10;
/// Answers about one moment that are kept for those who ask next.
const MOST_TOLD: usize = 64;

/// A lecture room.
#[derive(Debug)]
pub struct Room {
    /// What followers type to join.
    pub code: String,
    /// What shows that somebody is the presenter.
    key: String,
    opened: Instant,
    desk: Mutex<Desk>,
    stage: watch::Sender<Stage>,
    state: watch::Sender<Utf8Bytes>,
    board: watch::Sender<Utf8Bytes>,
    followers: AtomicUsize,
    most_followers: usize,
    told: tokio::sync::Mutex<HashMap<String, (String, Value)>>,
}

/// What is shown.
#[derive(Debug, Clone, Default)]
pub enum Stage {
    /// Nothing at the moment.
    #[default]
    Empty,
    /// A session.
    Session(Arc<Session>),
    /// The lecture is over.
    Closed,
}

/// What the presenter has laid out.
#[derive(Debug)]
struct Desk {
    view: Value,
    question: Option<Question>,
    asked: u64,
    touched: Instant,
}

/// What followers are told beside the run.
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[schemars(rename = "LectureState")]
pub struct Board {
    /// What followers type to join.
    pub code: String,
    /// Title of the scene; nothing while no session is shown.
    pub title: Option<String>,
    /// Where the scene came from.
    pub source: Option<Source>,
    /// What the presenter looks at, in the page's own words.
    pub view: Value,
    /// The question that is asked.
    pub question: Option<QuestionView>,
}

/// What only the presenter is told.
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[schemars(rename = "PresenterState")]
pub struct DeskView {
    /// How many follow now.
    pub followers: usize,
    /// How the answers stand.
    pub tally: Option<Tally>,
}

impl Room {
    /// Opens a room for a session, and starts to tell of it.
    fn open(code: String, session: Arc<Session>, most_followers: usize) -> Arc<Self> {
        let desk = Desk { view: Value::Null, question: None, asked: 0, touched: Instant::now() };
        let room = Arc::new(Self {
            code,
            key: uuid::Uuid::new_v4().simple().to_string(),
            opened: Instant::now(),
            desk: Mutex::new(desk),
            stage: watch::Sender::new(Stage::Session(session)),
            state: watch::Sender::new(Utf8Bytes::default()),
            board: watch::Sender::new(Utf8Bytes::default()),
            followers: AtomicUsize::new(0),
            most_followers,
            told: tokio::sync::Mutex::default(),
        });
        room.publish();
        tokio::spawn(tell_states(Arc::downgrade(&room), room.stage.subscribe()));
        room
    }

    /// The presenter's key, told once to whoever opened the room.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// Refuses whoever is not the presenter.
    pub fn check_key(&self, given: Option<&str>) -> Result<(), Problem> {
        if given == Some(self.key.as_str()) {
            self.desk().touched = Instant::now();
            return Ok(());
        }
        Err(Problem::new(
            StatusCode::FORBIDDEN,
            "not-the-presenter",
            "only the presenter of this room may do that",
            "send the key that came with the room as `authorization: Bearer KEY`",
        ))
    }

    /// What followers are told beside the run.
    pub fn board(&self) -> Board {
        let desk = self.desk();
        let state = self.session().map(|session| session.state());
        Board {
            code: self.code.clone(),
            title: state.as_ref().map(|state| state.title.clone()),
            source: state.map(|state| state.source.clone()),
            view: desk.view.clone(),
            question: desk.question.as_ref().map(Question::view),
        }
    }

    /// What the presenter is told.
    pub fn desk_view(&self) -> DeskView {
        DeskView {
            followers: self.followers.load(Ordering::Relaxed),
            tally: self.desk().question.as_ref().map(Question::tally),
        }
    }

    /// Takes over what the presenter looks at.
    pub fn show(&self, view: Value) -> Result<(), Problem> {
        let size = view.to_string().len();
        if size > MOST_VIEW {
            return Err(Problem::new(
                StatusCode::PAYLOAD_TOO_LARGE,
                "view-too-large",
                format!("what is to be shown takes {size} bytes, more than {MOST_VIEW}"),
                "show the scene itself as the room's session",
            ));
        }
        self.desk().view = view;
        self.publish();
        Ok(())
    }

    /// Shows another session.
    pub fn stage(&self, session: Arc<Session>) {
        self.stage.send_replace(Stage::Session(session));
        self.publish();
    }

    /// Asks a question; the one before is forgotten.
    pub fn ask(&self, new: NewQuestion) -> Result<(), Problem> {
        let mut desk = self.desk();
        let question = Question::new(desk.asked + 1, new, 4 * self.most_followers)?;
        desk.asked += 1;
        desk.question = Some(question);
        drop(desk);
        self.publish();
        Ok(())
    }

    /// Takes an answer.
    pub fn vote(&self, vote: &Vote) -> Result<(), Problem> {
        self.desk().question.as_mut().ok_or_else(question::none)?.take(vote)
    }

    /// Tells everybody how the answers stand, and which is right.
    pub fn reveal(&self) -> Result<(), Problem> {
        self.desk().question.as_mut().ok_or_else(question::none)?.reveal();
        self.publish();
        Ok(())
    }

    /// Takes the question away.
    pub fn forget_question(&self) {
        self.desk().question = None;
        self.publish();
    }

    /// The session that is shown.
    pub fn session(&self) -> Option<Arc<Session>> {
        match &*self.stage.borrow() {
            Stage::Session(session) => Some(Arc::clone(session)),
            Stage::Empty | Stage::Closed => None,
        }
    }

    /// Joins as a follower.
    pub fn join(self: &Arc<Self>) -> Result<Seat, Problem> {
        let before = self.followers.fetch_add(1, Ordering::Relaxed);
        let seat = Seat {
            stage: self.stage.subscribe(),
            state: self.state.subscribe(),
            board: self.board.subscribe(),
            room: Arc::clone(self),
        };
        if before >= self.most_followers {
            return Err(Problem::new(
                StatusCode::SERVICE_UNAVAILABLE,
                "room-full",
                format!("{} already follow this lecture, as many as this server takes", self.most_followers),
                "look on with a neighbour; the instructor can start the server with a larger --max-followers",
            ));
        }
        Ok(seat)
    }

    /// What is told of the run at one moment: asked once of the session however many followers want it.
    pub async fn told<T: Future<Output = Result<Value, Problem>>>(
        &self,
        what: &str,
        tell: impl FnOnce(Arc<Session>) -> T,
    ) -> Result<Value, Problem> {
        let session = self.session().ok_or_else(nothing_shown)?;
        // Whoever asks meanwhile waits here, and finds the answer.
        let mut told = self.told.lock().await;
        let state = session.state();
        let moment = format!("{} {} {} {}", state.id, state.time, state.changes, state.pull.is_some());
        if let Some((_, value)) = told.get(what).filter(|(of, _)| *of == moment) {
            return Ok(value.clone());
        }
        let value = tell(session).await?;
        if told.len() >= MOST_TOLD {
            told.clear();
        }
        told.insert(what.to_owned(), (moment, value.clone()));
        Ok(value)
    }

    /// Ends the lecture for everybody.
    fn close(&self) {
        self.stage.send_replace(Stage::Closed);
    }

    /// How long the presenter has not been heard of, and how old the room is.
    fn ages(&self) -> (Duration, Duration) {
        (self.desk().touched.elapsed(), self.opened.elapsed())
    }

    fn publish(&self) {
        self.board.send_replace(LectureMessage::Room(&self.board()).text());
    }

    fn desk(&self) -> MutexGuard<'_, Desk> {
        // Every change is a single assignment or insertion.
        self.desk.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A follower's place: newest state, newest board, and the session whose recording is watched.
#[derive(Debug)]
pub struct Seat {
    /// What is shown.
    pub stage: watch::Receiver<Stage>,
    /// The newest state as it is sent.
    pub state: watch::Receiver<Utf8Bytes>,
    /// The newest board as it is sent.
    pub board: watch::Receiver<Utf8Bytes>,
    room: Arc<Room>,
}

impl Drop for Seat {
    fn drop(&mut self) {
        self.room.followers.fetch_sub(1, Ordering::Relaxed);
    }
}

/// What followers are sent in text.
#[derive(Serialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case")]
pub enum LectureMessage<'a> {
    /// What is shown and asked beside the run.
    Room(&'a Board),
    /// The state of the session that is shown.
    State(&'a SessionState),
    /// A recording begins: the viewer must forget the one before.
    Reset,
    /// The lecture is over.
    Closed,
}

impl LectureMessage<'_> {
    /// The message as it is sent, written once for all followers.
    fn text(&self) -> Utf8Bytes {
        serde_json::to_string(self).unwrap_or_default().into()
    }
}

/// Writes each state of the session that is shown, at most ten a second, until the room is gone.
async fn tell_states(room: Weak<Room>, mut stage: watch::Receiver<Stage>) {
    loop {
        let shown = stage.borrow_and_update().clone();
        let mut states = match shown {
            Stage::Closed => return,
            Stage::Empty => match stage.changed().await {
                Ok(()) => continue,
                Err(_) => return,
            },
            Stage::Session(session) => session.states(),
        };
        states.mark_changed();
        loop {
            let changed = tokio::select! {
                changed = stage.changed() => match changed {
                    Ok(()) => break,
                    Err(_) => return,
                },
                changed = states.changed() => changed,
            };
            let Some(room) = room.upgrade() else { return };
            if changed.is_err() {
                // The session is gone; another may come.
                room.stage.send_replace(Stage::Empty);
                room.publish();
                break;
            }
            let state = Arc::clone(&states.borrow_and_update());
            room.state.send_replace(LectureMessage::State(&anonymous(&state, &room.code)).text());
            drop(room);
            tokio::time::sleep(STATE_INTERVAL).await;
        }
    }
}

/// The state without the name by which the session could be steered.
fn anonymous(state: &SessionState, code: &str) -> SessionState {
    let links = Links::below(format!("/api/v1/rooms/{code}"));
    SessionState { id: format!("room-{code}"), links, ..state.clone() }
}

pub(crate) fn nothing_shown() -> Problem {
    Problem::new(
        StatusCode::CONFLICT,
        "nothing-shown",
        "no simulation is shown in this room at the moment",
        "wait until the presenter shows one",
    )
}
