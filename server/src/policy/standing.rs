//! Where a person stands in an exercise: one function of what was handed in, judged, allowed and decided.

use schemars::JsonSchema;
use serde::Serialize;

use super::admission::next_attempt;
use super::moment::Moment;
use super::rules::{Extension, Policy, Times, When};

/// What somebody handed in, and what it earned by its verdict in force.
#[derive(Debug, Clone, PartialEq)]
pub struct Handed {
    /// The submission.
    pub id: String,
    /// Its place in the log: of two at the same moment the first.
    pub n: i64,
    /// When it came.
    pub at: Moment,
    /// Whether it could be judged: what could not is no attempt.
    pub judged: bool,
    /// Points that it earned.
    pub earned: f64,
    /// Points that are enough to pass by the lesson that judged it; `None`: as many as now.
    pub pass: Option<f64>,
}

/// What somebody decided about the points.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Decided {
    /// The points that count; left out: those that were earned.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<f64>,
    /// Why.
    pub reason: String,
    /// Who decided.
    pub by: String,
    /// When.
    pub at: Moment,
}

/// All that a standing follows from.
#[derive(Debug, Clone, Copy)]
pub struct Case<'a> {
    /// What is set for everybody.
    pub policy: &'a Policy,
    /// When the results were released, if they were.
    pub released: Option<Moment>,
    /// What is allowed to this person.
    pub extension: Option<&'a Extension>,
    /// What this person handed in, in any order.
    pub handed: &'a [Handed],
    /// What was decided about it, in any order.
    pub decided: &'a [Decided],
    /// Points that are enough to pass, as the lesson is now.
    pub pass: f64,
}

/// Whether an exercise can be handed in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    /// Not yet.
    NotOpen,
    /// It counts in full.
    Open,
    /// It counts in part.
    Late,
    /// It earns nothing any more.
    Practice,
    /// Not any more.
    Closed,
}

/// What of the verdicts a student is told.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Revealed {
    /// Points, and what is right.
    pub points: bool,
    /// What is said about wrong answers.
    pub messages: bool,
    /// The right answers.
    pub reference: bool,
}

impl Revealed {
    /// Everything: what teachers see, and everybody at home.
    pub const ALL: Self = Self { points: true, messages: true, reference: true };
    /// Nothing: what students see where it is not known what they may.
    pub const NOTHING: Self = Self { points: false, messages: false, reference: false };
}

/// What an attempt counts.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Credit {
    /// The submission.
    pub id: String,
    /// When it came.
    pub at: Moment,
    /// Which attempt it is, from 1.
    pub attempt: u32,
    /// Points that it earned.
    pub earned: f64,
    /// The share that counts at that moment.
    pub on_time: f64,
    /// The share that counts of this attempt.
    pub of_attempt: f64,
    /// The points that count: the product.
    pub points: f64,
}

/// Where a person stands in an exercise.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Standing {
    /// Whether and until when it can be handed in.
    #[serde(flatten)]
    pub turn: Turn,
    /// The points.
    #[serde(flatten)]
    pub score: Score,
    /// When the last submission came.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub last: Option<Moment>,
}

/// Whether a person can hand in, until when, and what is told of it: held back from nobody.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Turn {
    /// Whether it can be handed in.
    pub phase: Phase,
    /// Until when it counts in full for this person.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub due: Option<Moment>,
    /// Until when this person can hand in.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closes: Option<Moment>,
    /// What share of its points an attempt would count now.
    pub worth: f64,
    /// Attempts that were made.
    pub attempts: u32,
    /// Attempts that are left.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub attempts_left: Option<u32>,
    /// From when the next attempt can be made, where one has to wait.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub next_attempt: Option<Moment>,
    /// What the student is told.
    pub revealed: Revealed,
}

/// The points of a person in an exercise.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Score {
    /// Those that count.
    pub points: f64,
    /// Most points of an attempt, as its verdict says.
    pub earned: f64,
    /// Whether they are enough to pass.
    pub passed: bool,
    /// Whether the attempt that counts came late.
    pub late: bool,
    /// The decision that holds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub decided: Option<Decided>,
    /// What each attempt counts, the first at the beginning.
    pub credits: Vec<Credit>,
}

/// Where a person stands at a moment. What comes later does not count; the order of what is given does not matter.
pub fn standing(case: &Case<'_>, now: Moment) -> Standing {
    let Case { policy, extension, .. } = *case;
    let times = policy.times(extension);
    let most = policy.attempts(extension);
    let mut handed: Vec<&Handed> = case.handed.iter().filter(|one| one.at <= now).collect();
    handed.sort_by_key(|one| (one.at, one.n));
    let last = handed.last().map(|one| one.at);
    let judged: Vec<&Handed> = handed.into_iter().filter(|one| one.judged).collect();
    let credits: Vec<Credit> =
        (1..).zip(&judged).map(|(k, one)| credit(policy, &times, most, k, one)).collect();
    let best = credits.iter().fold(None::<&Credit>, |best, one| match best {
        Some(best) if best.points >= one.points => Some(best),
        _ => Some(one),
    });
    let counted = best.map_or(0.0, |best| best.points);
    let decided = case.decided.iter().filter(|one| one.at <= now).max_by_key(|one| one.at);
    // A decision that names no points takes the one of before back.
    let decided = decided.filter(|one| one.points.is_some());
    let points = decided.and_then(|one| one.points).unwrap_or(counted);
    let enough = |one: Option<&Credit>| {
        let of =
            |one: &Credit| judged.iter().find(|handed| handed.id == one.id).and_then(|handed| handed.pass);
        one.and_then(of).unwrap_or(case.pass)
    };
    let attempts = u32::try_from(judged.len()).unwrap_or(u32::MAX);
    let made: Vec<Moment> = judged.iter().map(|one| one.at).collect();
    let turn = Turn {
        phase: phase(&times, now),
        due: times.due,
        closes: times.closes,
        worth: times.share(now) * share_of(policy, most, attempts.saturating_add(1)),
        attempts,
        attempts_left: most.map(|most| most.saturating_sub(attempts)),
        next_attempt: next_attempt(policy, &made).filter(|next| *next > now),
        revealed: revealed(case, &times, now),
    };
    let score = Score {
        points,
        earned: judged.iter().map(|one| one.earned).fold(0.0, f64::max),
        passed: match decided {
            Some(_) => points >= enough(best),
            None if credits.is_empty() => last.is_some() && points >= case.pass,
            None => credits.iter().any(|one| one.points >= enough(Some(one))),
        },
        late: best.is_some_and(|best| best.on_time < 1.0),
        decided: decided.cloned(),
        credits,
    };
    Standing { turn, score, last }
}

fn credit(policy: &Policy, times: &Times, most: Option<u32>, attempt: u32, one: &Handed) -> Credit {
    let on_time = times.share(one.at);
    let of_attempt = share_of(policy, most, attempt);
    let points = one.earned * (on_time * of_attempt);
    Credit { id: one.id.clone(), at: one.at, attempt, earned: one.earned, on_time, of_attempt, points }
}

/// What share an attempt counts; one beyond those that are allowed counts nothing.
fn share_of(policy: &Policy, most: Option<u32>, attempt: u32) -> f64 {
    if most.is_some_and(|most| attempt > most) {
        return 0.0;
    }
    policy.of_attempt(usize::try_from(attempt).unwrap_or(usize::MAX).saturating_sub(1))
}

fn phase(times: &Times, now: Moment) -> Phase {
    if times.opens.is_some_and(|opens| now < opens) {
        return Phase::NotOpen;
    }
    if times.closes.is_some_and(|closes| now > closes) {
        return Phase::Closed;
    }
    match times.share(now) {
        _ if times.due.is_none_or(|due| now <= due) => Phase::Open,
        share if share > 0.0 => Phase::Late,
        _ => Phase::Practice,
    }
}

fn revealed(case: &Case<'_>, times: &Times, now: Moment) -> Revealed {
    let told = |when: When| match when {
        When::AtOnce => true,
        When::AfterDue => times.last_credit().is_some_and(|last| now > last),
        When::WhenReleased => case.released.is_some_and(|released| released <= now),
        When::Never => false,
    };
    let reveal = case.policy.reveal;
    let points = told(reveal.points);
    // A remark on a wrong answer tells that it is wrong, and a right answer that opens by itself that one was right.
    let messages = points && told(reveal.messages);
    let reference = told(reveal.reference) && (points || reveal.reference != When::AtOnce);
    Revealed { points, messages, reference }
}
