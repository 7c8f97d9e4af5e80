//! What a teacher sets for an exercise, and what is set for one person apart.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::moment::Moment;

/// Most late steps, and most attempts whose worth is named one by one.
const MOST_STEPS: usize = 50;
/// Longest pause between attempts, in minutes: a year.
const LONGEST_PAUSE: u32 = 525_600;
/// The first and the last moment that a date may name, 1970-01-01 and 2999-12-31: what follows from them can still be written.
const DATES: [Moment; 2] = [Moment(0), Moment(32_503_679_999_999)];

/// How an exercise is handed in. What is left out bounds nothing.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Policy {
    /// From when it can be handed in.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub opens: Option<Moment>,
    /// Until when it counts in full.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub due: Option<Moment>,
    /// What it counts after that, step by step; after the last it earns nothing, and is practice.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub late: Vec<LateStep>,
    /// Until when it can be handed in at all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closes: Option<Moment>,
    /// Attempts that each person has.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub most_attempts: Option<u32>,
    /// What share of its points the first, second, … attempt counts, from 0 to 1; the last holds for all that follow.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub falling: Vec<f64>,
    /// Minutes between an attempt and the next.
    pub cooldown_minutes: u32,
    /// What students are told of a verdict, and when.
    pub reveal: Reveal,
}

/// A step of lateness.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LateStep {
    /// Until when.
    pub until: Moment,
    /// What share of the points counts until then, from 0 to 1.
    pub share: f64,
}

/// What students are told of a verdict, and when.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Reveal {
    /// Points, and what is right.
    pub points: When,
    /// What is said about wrong answers.
    pub messages: When,
    /// The right answers. At once: as the course opens them, after a right answer or so many different ones.
    pub reference: When,
}

/// When something is told.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum When {
    /// With the verdict.
    #[default]
    AtOnce,
    /// When the person can earn nothing more: after the due date, late steps and extensions included.
    AfterDue,
    /// When a teacher releases it.
    WhenReleased,
    /// Never.
    Never,
}

/// What one person is allowed beyond the others.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Extension {
    /// Until when it counts in full; late steps and the end follow at the same distance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub until: Option<Moment>,
    /// Attempts beyond those of everybody.
    pub attempts: u32,
    /// Why.
    pub reason: String,
    /// Who gave it.
    pub by: String,
    /// When.
    pub at: Moment,
}

/// Why a policy is refused: the place in it, and a sentence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InvalidPolicy {
    /// As a JSON pointer.
    pub place: String,
    /// What is wrong.
    pub problem: String,
}

/// The dates that hold for one person.
#[derive(Debug, Clone, PartialEq)]
pub struct Times {
    /// From when it can be handed in.
    pub opens: Option<Moment>,
    /// Until when it counts in full.
    pub due: Option<Moment>,
    /// Steps of lateness.
    pub late: Vec<LateStep>,
    /// Until when it can be handed in.
    pub closes: Option<Moment>,
}

/// What is wrong with a date by itself; nothing where it lies within the years that can be named.
pub fn wrong_date(name: &str, at: Option<Moment>) -> Option<String> {
    at.filter(|at| *at < DATES[0] || *at > DATES[1])
        .map(|_| format!("{name} lies outside of the years 1970 to 2999"))
}

impl Policy {
    /// Errors if its dates or shares contradict each other, or lie outside of what can be written.
    pub fn check(&self) -> Result<(), InvalidPolicy> {
        let wrong = |place: String, problem: &str| Err(InvalidPolicy { place, problem: problem.to_owned() });
        self.check_dates()?;
        if self.due.is_none() && !self.late.is_empty() {
            return wrong("/late".to_owned(), "nothing is late without a due date");
        }
        let late = self.late.iter().map(|step| step.share).collect::<Vec<_>>();
        for (place, shares) in [("/late", &late), ("/falling", &self.falling)] {
            if shares.len() > MOST_STEPS {
                return wrong(place.to_owned(), "there are more than 50 steps");
            }
            if shares.iter().any(|share| !(0.0..=1.0).contains(share)) {
                return wrong(place.to_owned(), "shares go from 0 to 1");
            }
            if shares.windows(2).any(|pair| pair[1] > pair[0]) {
                return wrong(place.to_owned(), "a later one counts more than the one before it");
            }
        }
        if self.cooldown_minutes > LONGEST_PAUSE {
            let problem = format!("cooldown_minutes is more than {LONGEST_PAUSE}, a year");
            return wrong("/cooldown_minutes".to_owned(), &problem);
        }
        if self.most_attempts == Some(0) {
            return wrong("/most_attempts".to_owned(), "nobody could hand in");
        }
        let Reveal { points, messages, reference } = self.reveal;
        if self.due.is_none() && [points, messages, reference].contains(&When::AfterDue) {
            return wrong("/reveal".to_owned(), "there is no due date after which to tell it");
        }
        Ok(())
    }

    fn check_dates(&self) -> Result<(), InvalidPolicy> {
        let mut before = None;
        let named = |name: &str, at| (format!("/{name}"), at);
        let steps = (0..).zip(&self.late).map(|(k, step)| (format!("/late/{k}/until"), Some(step.until)));
        let first = [named("opens", self.opens), named("due", self.due)].into_iter();
        for (place, at) in first.chain(steps).chain([named("closes", self.closes)]) {
            let wrong = wrong_date(&place[1..], at);
            let early =
                (at.is_some() && at < before).then(|| "it lies before what should come first".to_owned());
            if let Some(problem) = wrong.or(early) {
                return Err(InvalidPolicy { place, problem });
            }
            before = at.or(before);
        }
        Ok(())
    }

    /// The dates that hold for somebody: an extension moves the due date, and with it whatever follows.
    pub fn times(&self, extension: Option<&Extension>) -> Times {
        let Self { opens, due, late, closes, .. } = self;
        let until = extension.and_then(|extension| extension.until);
        let longer = |at: Moment| until.map_or(0, |until| (until.0 - at.0).max(0));
        let by = due.map_or(0, longer);
        let late = late.iter().map(|step| LateStep { until: step.until.after(by), ..*step }).collect();
        // Whoever has more time can use it.
        let closes = closes.map(|closes| until.map_or(closes, |until| until.max(closes.after(by))));
        Times { opens: *opens, due: due.map(|due| due.after(by)), late, closes }
    }

    /// Attempts that somebody has.
    pub fn attempts(&self, extension: Option<&Extension>) -> Option<u32> {
        let more = extension.map_or(0, |extension| extension.attempts);
        self.most_attempts.map(|most| most.saturating_add(more))
    }

    /// What share the `k`th attempt counts; the first is 0.
    pub fn of_attempt(&self, k: usize) -> f64 {
        self.falling.get(k).or(self.falling.last()).copied().unwrap_or(1.0)
    }
}

impl Times {
    /// What share counts of what is handed in at this moment.
    pub fn share(&self, at: Moment) -> f64 {
        if self.closes.is_some_and(|closes| at > closes) {
            return 0.0;
        }
        match self.due {
            Some(due) if at > due => {
                self.late.iter().find(|step| at <= step.until).map_or(0.0, |step| step.share)
            }
            _ => 1.0,
        }
    }

    /// The last moment at which something can be earned, if there is one.
    pub fn last_credit(&self) -> Option<Moment> {
        let late = self.late.iter().rev().find(|step| step.share > 0.0).map(|step| step.until);
        match (late.or(self.due), self.closes) {
            (Some(last), Some(closes)) => Some(last.min(closes)),
            (last, closes) => last.or(closes),
        }
    }
}
