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

mod audience;
mod follower;
pub mod named;
mod question;
mod registry;
mod responses;
mod told;

pub use audience::{NewRemark, Presence, Remark};
pub use follower::Follower;
pub use question::{LectureQuestion, NewQuestion, Tally, Vote};
pub use registry::Lectures;
pub use told::{LectureMessage, PresenterState, PublicState};

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};

use axum::body::Bytes;
use axum::extract::ws::Utf8Bytes;
use axum::http::StatusCode;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use tokio::sync::watch;

use crate::problem::Problem;
use crate::session::Session;
use audience::{Audience, Present};
use question::PosedQuestion;
use responses::Responses;
use told::anonymous;

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
    audience: Audience,
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
    /// How often all hands were put down.
    lowered: u64,
    /// When the presenter was last heard of.
    touched: Instant,
}

/// A lecture as it goes on later, with the question of the moment and what followers asked. Hands are raised anew.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct KeptLecture {
    code: String,
    key: String,
    /// The session that is shown.
    pub session: String,
    view: Value,
    asked: u64,
    /// Seconds since it was opened.
    age: u64,
    #[serde(default)]
    question: Option<PosedQuestion>,
    #[serde(default)]
    remarks: Vec<Remark>,
}

impl Lecture {
    /// Opens a lecture for a session and starts to send its states.
    fn open(code: String, session: Arc<Session>, max_followers: usize) -> Arc<Self> {
        let key = uuid::Uuid::new_v4().simple().to_string();
        let kept = KeptLecture { code, key, ..KeptLecture::default() };
        Self::resume(kept, session, max_followers)
    }

    /// Goes on with a lecture that was kept.
    fn resume(kept: KeptLecture, session: Arc<Session>, max_followers: usize) -> Arc<Self> {
        let KeptLecture { code, key, view, asked, age, question, remarks, .. } = kept;
        let presentation = Presentation { view, question, asked, lowered: 0, touched: Instant::now() };
        let lecture = Arc::new(Self {
            code,
            key,
            opened: Instant::now().checked_sub(Duration::from_secs(age)).unwrap_or_else(Instant::now),
            presentation: Mutex::new(presentation),
            live: watch::Sender::new(LiveView::Session(session)),
            state: watch::Sender::new(Utf8Bytes::default()),
            public: watch::Sender::new(Utf8Bytes::default()),
            followers: AtomicUsize::new(0),
            audience: Audience::resume(remarks),
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
            question: presentation.question.clone(),
            remarks: self.audience.waiting(),
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
            remark: self.audience.shown(),
            lowered: presentation.lowered,
        }
    }

    /// What the presenter sees.
    pub fn presenter_state(&self) -> PresenterState {
        let Present { roaming, hands, screens } = self.audience.present();
        let presentation = self.presentation();
        let question = presentation.question.as_ref();
        PresenterState {
            followers: self.followers.load(Ordering::Relaxed).saturating_sub(screens),
            screens,
            roaming,
            hands,
            remarks: self.audience.waiting(),
            question: question.map(PosedQuestion::view),
            tally: question.map(PosedQuestion::tally),
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

    /// Goes on with another session, led from another page of the presenter's.
    fn take_up(&self, session: Arc<Session>) {
        self.presentation().touched = Instant::now();
        self.show_session(session);
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

    /// Asks the same question again: the answers so far are kept beside those that come now. Errors if none is asked.
    pub fn ask_again(&self) -> Result<(), Problem> {
        let mut presentation = self.presentation();
        let number = presentation.asked + 1;
        presentation.question.as_mut().ok_or_else(question::none)?.again(number);
        presentation.asked = number;
        drop(presentation);
        self.publish();
        Ok(())
    }

    /// Takes a question of a follower. Errors if it is refused.
    pub fn remark(&self, new: &NewRemark) -> Result<(), Problem> {
        self.audience.ask(new, Instant::now())
    }

    /// Shows everybody a follower's question, or shows it no longer. Errors if there is none of that number.
    pub fn show_remark(&self, number: u64, shown: bool) -> Result<(), Problem> {
        self.audience.show(number, shown)?;
        self.publish();
        Ok(())
    }

    /// Takes a follower's question from the presenter's list.
    pub fn settle(&self, number: u64) {
        self.audience.done(number);
        self.publish();
    }

    /// Puts down all hands.
    pub fn lower_hands(&self) {
        self.presentation().lowered += 1;
        self.publish();
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

pub(crate) fn nothing_shown() -> Problem {
    Problem::new(
        StatusCode::CONFLICT,
        "nothing-shown",
        "no simulation is shown in this room at the moment",
        "wait until the presenter shows one",
    )
}
