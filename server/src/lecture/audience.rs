//! What followers let the presenter know: that they look around on their own, a hand, a question without a name.

use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use axum::http::StatusCode;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::question::check_voter;
use crate::problem::Problem;

/// Longest question of a follower, characters.
const MAX_REMARK: usize = 300;
/// Questions of followers that wait for the presenter: more are not read in a lecture.
const MAX_REMARKS: usize = 100;
/// Pause between two questions of one follower: as long as it takes to write one that is meant.
const PAUSE: Duration = Duration::from_secs(10);
/// Questions that all followers together ask within that pause. A name is made up by the browser, so that one
/// follower may have many; what a presenter can read is bounded all the same.
const MOST_IN_PAUSE: usize = 30;

/// What a follower tells over its stream, as text: it counts for as long as the stream is open.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Presence {
    /// Looks around alone, not at what the presenter shows.
    pub roaming: bool,
    /// Raises a hand.
    pub hand: bool,
    /// Is no follower but the projector's window.
    pub screen: bool,
}

/// A question of a follower, to be asked.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NewRemark {
    /// What is asked; nobody is told by whom.
    #[schemars(example = "Why is the multiplier negative here?")]
    pub text: String,
    /// A name that the follower's browser made up: it bounds how often one asks, and is told to nobody.
    pub voter: String,
}

/// A question of a follower, without a name.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "LectureRemark")]
pub struct Remark {
    /// Its number.
    pub number: u64,
    /// What is asked.
    pub text: String,
    /// Whether the presenter shows it to everybody.
    pub shown: bool,
}

/// How many followers do what.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Present {
    pub(super) roaming: usize,
    pub(super) hands: usize,
    pub(super) screens: usize,
}

/// What the followers of one lecture let its presenter know.
#[derive(Debug, Default)]
pub(super) struct Audience(Mutex<Heard>);

#[derive(Debug, Default)]
struct Heard {
    present: Present,
    /// Questions so far.
    asked: u64,
    remarks: Vec<Remark>,
    /// Who asked within the pause, and when.
    lately: HashMap<String, Instant>,
}

impl Audience {
    /// Goes on with questions that were kept.
    pub(super) fn resume(remarks: Vec<Remark>) -> Self {
        let asked = remarks.iter().map(|remark| remark.number).max().unwrap_or(0);
        Self(Mutex::new(Heard { asked, remarks, ..Heard::default() }))
    }

    /// One follower's presence becomes another.
    pub(super) fn change(&self, from: Presence, to: Presence) {
        let present = &mut self.heard().present;
        for (count, was, is) in [
            (&mut present.roaming, from.roaming, to.roaming),
            (&mut present.hands, from.hand, to.hand),
            (&mut present.screens, from.screen, to.screen),
        ] {
            *count = (*count + usize::from(is)).saturating_sub(usize::from(was));
        }
    }

    /// How many do what.
    pub(super) fn present(&self) -> Present {
        self.heard().present
    }

    /// Takes a question at a time. Errors if it is empty or too long, comes too soon, or too many wait.
    pub(super) fn ask(&self, new: &NewRemark, now: Instant) -> Result<(), Problem> {
        let text = new.text.trim();
        if text.is_empty() || text.chars().count() > MAX_REMARK {
            let detail = format!("a question must have 1 to {MAX_REMARK} characters");
            let (status, hint) = (StatusCode::UNPROCESSABLE_ENTITY, "say it in a sentence or two");
            return Err(Problem::new(status, "invalid-remark", detail.clone(), hint).at("/text", detail));
        }
        check_voter(&new.voter)?;
        let mut heard = self.heard();
        heard.lately.retain(|_, asked| now.saturating_duration_since(*asked) < PAUSE);
        if heard.lately.contains_key(&new.voter) || heard.lately.len() >= MOST_IN_PAUSE {
            return Err(Problem::new(
                StatusCode::TOO_MANY_REQUESTS,
                "remark-too-soon",
                format!("a follower asks once in {} s, and a room takes only so many", PAUSE.as_secs()),
                "wait a moment and send it again",
            ));
        }
        if heard.remarks.len() >= MAX_REMARKS {
            return Err(Problem::new(
                StatusCode::SERVICE_UNAVAILABLE,
                "too-many-remarks",
                format!("{MAX_REMARKS} questions wait for the presenter, as many as this room takes"),
                "raise a hand",
            ));
        }
        heard.lately.insert(new.voter.clone(), now);
        heard.asked += 1;
        let number = heard.asked;
        heard.remarks.push(Remark { number, text: text.to_owned(), shown: false });
        Ok(())
    }

    /// The questions that wait, the oldest first.
    pub(super) fn waiting(&self) -> Vec<Remark> {
        self.heard().remarks.clone()
    }

    /// The question that the presenter shows to everybody.
    pub(super) fn shown(&self) -> Option<Remark> {
        self.heard().remarks.iter().find(|remark| remark.shown).cloned()
    }

    /// Shows a question to everybody in place of the one before, or shows it no longer. Errors if there is none.
    pub(super) fn show(&self, number: u64, shown: bool) -> Result<(), Problem> {
        let mut heard = self.heard();
        if heard.remarks.iter().all(|remark| remark.number != number) {
            return Err(Problem::new(
                StatusCode::NOT_FOUND,
                "unknown-remark",
                format!("no question {number} waits in this room"),
                "ask GET /api/v1/rooms/CODE/desk which do",
            ));
        }
        for remark in &mut heard.remarks {
            remark.shown = shown && remark.number == number;
        }
        Ok(())
    }

    /// Takes a question from the list; one that is not there is gone already.
    pub(super) fn done(&self, number: u64) {
        self.heard().remarks.retain(|remark| remark.number != number);
    }

    fn heard(&self) -> MutexGuard<'_, Heard> {
        // Every change is a single push, retain or assignment of a number.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ask(audience: &Audience, voter: &str, text: &str, now: Instant) -> Result<(), &'static str> {
        let new = NewRemark { text: text.to_owned(), voter: voter.to_owned() };
        audience.ask(&new, now).map_err(|problem| problem.code())
    }

    #[test]
    fn a_presence_counts_once_and_goes_with_its_follower() {
        let audience = Audience::default();
        let (nothing, hand) = (Presence::default(), Presence { roaming: true, hand: true, screen: false });
        audience.change(nothing, hand);
        audience.change(hand, hand);
        audience.change(nothing, Presence { screen: true, ..nothing });
        assert_eq!(audience.present(), Present { roaming: 1, hands: 1, screens: 1 });
        audience.change(hand, nothing);
        assert_eq!(audience.present(), Present { roaming: 0, hands: 0, screens: 1 });
    }

    #[test]
    fn questions_are_bounded_in_length_in_number_and_in_how_fast_they_come() {
        let audience = Audience::default();
        let start = Instant::now();
        assert_eq!(ask(&audience, "a", "  ", start), Err("invalid-remark"));
        assert_eq!(ask(&audience, "a", &"x".repeat(MAX_REMARK + 1), start), Err("invalid-remark"));
        assert_eq!(ask(&audience, "", "Why?", start), Err("invalid-question"));
        ask(&audience, "a", " Why is λ negative? ", start).expect("the first");
        assert_eq!(ask(&audience, "a", "And here?", start + PAUSE / 2), Err("remark-too-soon"));
        ask(&audience, "a", "And here?", start + PAUSE).expect("after the pause");
        // Names are made up: all together are bounded too.
        let mut now = start + 3 * PAUSE;
        let mut taken = 2;
        for voter in 0..MOST_IN_PAUSE {
            ask(&audience, &format!("v{voter}"), "Why?", now).expect("one of many");
            taken += 1;
        }
        assert_eq!(ask(&audience, "another", "Why?", now), Err("remark-too-soon"));
        while taken < MAX_REMARKS {
            now += PAUSE;
            ask(&audience, "a", "Why?", now).expect("there is room");
            taken += 1;
        }
        assert_eq!(ask(&audience, "a", "one more", now + PAUSE), Err("too-many-remarks"));
        audience.done(1);
        ask(&audience, "a", "again", now + PAUSE).expect("there is room again");
        let last = audience.waiting().last().map(|remark| remark.number);
        assert_eq!(last, Some(MAX_REMARKS as u64 + 1), "numbers are not used again");
    }

    #[test]
    fn the_presenter_chooses_which_question_everybody_sees() {
        let audience = Audience::resume(vec![Remark { number: 4, text: "Why?".into(), shown: false }]);
        assert_eq!(audience.shown(), None);
        ask(&audience, "a", "How?", Instant::now()).expect("a question");
        audience.show(4, true).expect("it waits");
        audience.show(5, true).expect("it waits");
        assert_eq!(audience.shown().map(|remark| remark.text), Some("How?".into()), "one at a time");
        audience.show(5, false).expect("it waits");
        assert_eq!(audience.shown(), None);
        assert_eq!(audience.show(9, true).map_err(|problem| problem.code()), Err("unknown-remark"));
    }
}
