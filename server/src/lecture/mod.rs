//! Lectures: one session that a presenter leads and many follow.
//!
//! ```text
//! session ─▶ state, encoded once ──────────┐
//! presenter ─▶ public state, encoded once ─┼─▶ follower, follower, …   (each holds only its place)
//! session ─▶ recording (Hub) ──────────────┘
//! ```
//!
//! Followers never learn the session's own name, with which it could be steered, nor the answer to a question before
//! it is revealed.

mod question;
mod registry;
mod responses;

pub use question::{LectureQuestion, NewQuestion, Tally, Vote};
pub use registry::Lectures;

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};

use axum::body::Bytes;
use axum::extract::ws::Utf8Bytes;
use axum::http::StatusCode;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use tokio::sync::watch;
use triad_session::{Links, SceneSource, SessionState};

use crate::problem::Problem;
use crate::session::Session;
use question::PosedQuestion;
use responses::Responses;

/// Pause between two states that followers are sent: ten a second, as often as tables can be read.
const STATE_INTERVAL: Duration = Duration::from_millis(100);
/// Largest view that a presenter may show beside the run, bytes: time, selection, panels, changed numbers.
const MAX_VIEW_BYTES: usize = 64 << 10;

/// A lecture: a session that a presenter leads and followers watch.
#[derive(Debug)]
pub struct Lecture {
    /// What followers type to join.
    pub code: String,
    /// The presenter's secret.
    key: String,
    opened: Instant,
    presentation: Mutex<Presentation>,
    live: watch::Sender<LiveView>,
    state: watch::Sender<Utf8Bytes>,
    public: watch::Sender<Utf8Bytes>,
    followers: AtomicUsize,
    max_followers: usize,
    responses: Responses,
}

/// What is shown.
#[derive(Debug, Clone, Default)]
pub enum LiveView {
    /// Nothing at the moment.
    #[default]
    Empty,
    /// A session.
    Session(Arc<Session>),
    /// The lecture is over.
    Closed,
    /// The server stops; the lecture goes on when it is back.
    Away,
}

/// What the presenter shows and asks.
#[derive(Debug)]
struct Presentation {
    view: Value,
    question: Option<PosedQuestion>,
    /// Questions asked so far.
    asked: u64,
    /// When the presenter was last heard of.
    touched: Instant,
}

/// What followers see beside the run.
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[schemars(rename = "LectureState")]
pub struct PublicState {
    /// What followers type to join.
    pub code: String,
    /// Title of the scene; nothing while no session is shown.
    pub title: Option<String>,
    /// Where the scene came from.
    pub source: Option<SceneSource>,
    /// What the presenter looks at, in the page's own words.
    pub view: Value,
    /// The question that is asked.
    pub question: Option<LectureQuestion>,
}

/// A lecture as it goes on later. The question of the moment is not kept, nor who answered it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct KeptLecture {
    code: String,
    key: String,
    /// The session that is shown.
    pub session: String,
    view: Value,
    asked: u64,
    /// Seconds since it was opened.
    age: u64,
}

/// What only the presenter sees.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PresenterState {
    /// How many follow now.
    pub followers: usize,
    /// How the answers stand.
    pub tally: Option<Tally>,
}

impl Lecture {
    /// Opens a lecture for a session and starts to send its states.
    fn open(code: String, session: Arc<Session>, max_followers: usize) -> Arc<Self> {
        let key = uuid::Uuid::new_v4().simple().to_string();
        let kept = KeptLecture { code, key, session: String::new(), view: Value::Null, asked: 0, age: 0 };
        Self::resume(kept, session, max_followers)
    }

    /// Goes on with a lecture that was kept.
    fn resume(kept: KeptLecture, session: Arc<Session>, max_followers: usize) -> Arc<Self> {
        let KeptLecture { code, key, view, asked, age, .. } = kept;
        let presentation = Presentation { view, question: None, asked, touched: Instant::now() };
        let lecture = Arc::new(Self {
            code,
            key,
            opened: Instant::now().checked_sub(Duration::from_secs(age)).unwrap_or_else(Instant::now),
            presentation: Mutex::new(presentation),
            live: watch::Sender::new(LiveView::Session(session)),
            state: watch::Sender::new(Utf8Bytes::default()),
            public: watch::Sender::new(Utf8Bytes::default()),
            followers: AtomicUsize::new(0),
            max_followers,
            responses: Responses::default(),
        });
        lecture.publish();
        tokio::spawn(send_states(Arc::downgrade(&lecture), lecture.live.subscribe()));
        lecture
    }

    /// What is needed to go on with it after a restart; nothing while no session is shown.
    pub fn keep(&self) -> Option<KeptLecture> {
        let session = self.session()?.state().id.clone();
        let presentation = self.presentation();
        Some(KeptLecture {
            code: self.code.clone(),
            key: self.key.clone(),
            session,
            view: presentation.view.clone(),
            asked: presentation.asked,
            age: self.opened.elapsed().as_secs(),
        })
    }

    /// The presenter's key, sent once to whoever opened the lecture.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// Errors unless `given` is the presenter's key.
    pub fn check_key(&self, given: Option<&str>) -> Result<(), Problem> {
        if given == Some(self.key.as_str()) {
            self.presentation().touched = Instant::now();
            return Ok(());
        }
        Err(Problem::new(
            StatusCode::FORBIDDEN,
            "not-the-presenter",
            "only the presenter of this room may do that",
            "send the key that came with the room as `authorization: Bearer KEY`",
        ))
    }

    /// What followers see beside the run.
    pub fn public_state(&self) -> PublicState {
        let presentation = self.presentation();
        let state = self.session().map(|session| session.state());
        PublicState {
            code: self.code.clone(),
            title: state.as_ref().map(|state| state.title.clone()),
            source: state.map(|state| state.source.clone()),
            view: presentation.view.clone(),
            question: presentation.question.as_ref().map(PosedQuestion::view),
        }
    }

    /// What the presenter sees.
    pub fn presenter_state(&self) -> PresenterState {
        PresenterState {
            followers: self.followers.load(Ordering::Relaxed),
            tally: self.presentation().question.as_ref().map(PosedQuestion::tally),
        }
    }

    /// Shows followers what the presenter looks at. Errors if it is too large.
    pub fn show(&self, view: Value) -> Result<(), Problem> {
        let size = view.to_string().len();
        if size > MAX_VIEW_BYTES {
            return Err(Problem::new(
                StatusCode::PAYLOAD_TOO_LARGE,
                "view-too-large",
                format!("what is to be shown takes {size} bytes, more than {MAX_VIEW_BYTES}"),
                "show the scene itself as the room's session",
            ));
        }
        self.presentation().view = view;
        self.publish();
        Ok(())
    }

    /// Shows another session.
    pub fn show_session(&self, session: Arc<Session>) {
        self.live.send_replace(LiveView::Session(session));
        self.publish();
    }

    /// Asks a question; the one before is forgotten. Errors if a text or the number of choices is out of bounds.
    pub fn ask(&self, new: NewQuestion) -> Result<(), Problem> {
        let mut presentation = self.presentation();
        let question = PosedQuestion::new(presentation.asked + 1, new, 4 * self.max_followers)?;
        presentation.asked += 1;
        presentation.question = Some(question);
        drop(presentation);
        self.publish();
        Ok(())
    }

    /// Counts an answer. Errors if no question is open or the choice does not exist.
    pub fn vote(&self, vote: &Vote) -> Result<(), Problem> {
        self.presentation().question.as_mut().ok_or_else(question::none)?.count(vote)
    }

    /// Shows everybody the counts of the answers and the right one. Errors if no question is asked.
    pub fn reveal(&self) -> Result<(), Problem> {
        self.presentation().question.as_mut().ok_or_else(question::none)?.reveal();
        self.publish();
        Ok(())
    }

    /// Withdraws the question.
    pub fn withdraw_question(&self) {
        self.presentation().question = None;
        self.publish();
    }

    /// The session that is shown.
    pub fn session(&self) -> Option<Arc<Session>> {
        match &*self.live.borrow() {
            LiveView::Session(session) => Some(Arc::clone(session)),
            LiveView::Empty | LiveView::Closed | LiveView::Away => None,
        }
    }

    /// Joins as a follower. Errors if the lecture is full.
    pub fn join(self: &Arc<Self>) -> Result<Follower, Problem> {
        let before = self.followers.fetch_add(1, Ordering::Relaxed);
        let follower = Follower {
            live: self.live.subscribe(),
            state: self.state.subscribe(),
            public: self.public.subscribe(),
            lecture: Arc::clone(self),
        };
        if before >= self.max_followers {
            return Err(Problem::new(
                StatusCode::SERVICE_UNAVAILABLE,
                "room-full",
                format!("{} already follow this lecture, as many as this server takes", self.max_followers),
                "look on with a neighbour; the instructor can start the server with a larger --max-followers",
            ));
        }
        Ok(follower)
    }

    /// A response about the run at its present state, as JSON: the session computes it once, however many followers ask.
    ///
    /// Errors if no session is shown, and as `ask` does.
    pub async fn cached<T: Serialize, F: Future<Output = Result<T, Problem>>>(
        &self,
        what: &str,
        ask: impl FnOnce(Arc<Session>) -> F,
    ) -> Result<Bytes, Problem> {
        let session = self.session().ok_or_else(nothing_shown)?;
        self.responses.of(session, what, ask).await
    }

    /// Ends the lecture for everybody.
    fn close(&self) {
        self.live.send_replace(LiveView::Closed);
    }

    /// Lets go of everybody, who may come back to it.
    fn leave(&self) {
        self.live.send_replace(LiveView::Away);
    }

    /// How long the presenter has not been heard of, and how old the lecture is.
    fn ages(&self) -> (Duration, Duration) {
        (self.presentation().touched.elapsed(), self.opened.elapsed())
    }

    fn publish(&self) {
        self.public.send_replace(LectureMessage::Room(&self.public_state()).text());
    }

    fn presentation(&self) -> MutexGuard<'_, Presentation> {
        // Every change is a single assignment or insertion, so a panic elsewhere leaves nothing half-done.
        self.presentation.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What a follower receives: the newest state, the newest public state, and the session whose recording is watched.
#[derive(Debug)]
pub struct Follower {
    /// What is shown.
    pub live: watch::Receiver<LiveView>,
    /// The newest state as it is sent.
    pub state: watch::Receiver<Utf8Bytes>,
    /// The newest public state as it is sent.
    pub public: watch::Receiver<Utf8Bytes>,
    lecture: Arc<Lecture>,
}

impl Drop for Follower {
    fn drop(&mut self) {
        self.lecture.followers.fetch_sub(1, Ordering::Relaxed);
    }
}

/// What followers are sent in text.
#[derive(Serialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case")]
pub enum LectureMessage<'a> {
    /// What is shown and asked beside the run.
    Room(&'a PublicState),
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

/// Sends each state of the session that is shown, at most ten a second, until the lecture is over.
async fn send_states(lecture: Weak<Lecture>, mut live: watch::Receiver<LiveView>) {
    loop {
        let shown = live.borrow_and_update().clone();
        let mut states = match shown {
            LiveView::Closed | LiveView::Away => return,
            LiveView::Empty => match live.changed().await {
                Ok(()) => continue,
                Err(_) => return,
            },
            LiveView::Session(session) => session.states(),
        };
        states.mark_changed();
        loop {
            let changed = tokio::select! {
                changed = live.changed() => match changed {
                    Ok(()) => break,
                    Err(_) => return,
                },
                changed = states.changed() => changed,
            };
            let Some(lecture) = lecture.upgrade() else { return };
            if changed.is_err() {
                // The session is gone; another may come.
                lecture.live.send_replace(LiveView::Empty);
                lecture.publish();
                break;
            }
            let state = Arc::clone(&states.borrow_and_update());
            lecture.state.send_replace(LectureMessage::State(&anonymous(&state, &lecture.code)).text());
            drop(lecture);
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
