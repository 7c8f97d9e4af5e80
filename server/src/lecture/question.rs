//! A question to all followers: asked, answered once by each voter, revealed.

use std::collections::HashMap;

use axum::http::StatusCode;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::problem::Problem;

/// Longest question, characters.
const MAX_TEXT: usize = 400;
/// Longest choice, characters.
const MAX_CHOICE: usize = 160;
/// Longest name of a voter, bytes; the page makes names of 24.
const MAX_VOTER: usize = 64;
/// Numbers of choices that a question may have.
const CHOICES: std::ops::RangeInclusive<usize> = 2..=8;

/// A question to be asked.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NewQuestion {
    /// What is asked.
    #[schemars(example = "Which sign has Fx of the pin at this moment?")]
    pub text: String,
    /// What can be answered, two to eight choices.
    pub choices: Vec<String>,
    /// The choice that is right, as an index, if one is; a secret before the reveal.
    #[serde(default)]
    pub right: Option<usize>,
}

/// A follower's answer.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Vote {
    /// The question's number.
    pub question: u64,
    /// A name that the follower's browser made up: the same voter votes anew, not twice.
    pub voter: String,
    /// The choice, as an index.
    pub choice: usize,
}

/// A question as everybody sees it.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct LectureQuestion {
    /// Its number.
    pub number: u64,
    /// What is asked.
    pub text: String,
    /// What can be answered.
    pub choices: Vec<String>,
    /// Whether it was asked before: those who have talked it over vote again.
    pub again: bool,
    /// How the answers stand and which is right; nothing before the reveal.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub result: Option<Tally>,
}

/// How the answers stand.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
#[schemars(rename = "Tally")]
pub struct Tally {
    /// The question's number.
    pub number: u64,
    /// Answers for each choice.
    pub counts: Vec<usize>,
    /// Answers for each choice when it was asked before, if this is a second vote.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub before: Option<Vec<usize>>,
    /// The choice that is right.
    pub right: Option<usize>,
    /// Whether the answer is open to everybody.
    pub revealed: bool,
}

/// A question with its answers; kept over a restart as it is.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct PosedQuestion {
    number: u64,
    asked: NewQuestion,
    votes: HashMap<String, usize>,
    max_votes: usize,
    revealed: bool,
    /// The counts of the vote before.
    before: Option<Vec<usize>>,
}

impl PosedQuestion {
    pub(super) fn new(number: u64, asked: NewQuestion, max_votes: usize) -> Result<Self, Problem> {
        let wrong = |pointer: &str, detail: String| Err(refused(pointer, detail));
        if asked.text.trim().is_empty() || asked.text.chars().count() > MAX_TEXT {
            return wrong("/text", format!("the question must have 1 to {MAX_TEXT} characters"));
        }
        if !CHOICES.contains(&asked.choices.len()) {
            return wrong("/choices", "a question has two to eight choices".to_owned());
        }
        for (index, choice) in asked.choices.iter().enumerate() {
            if choice.trim().is_empty() || choice.chars().count() > MAX_CHOICE {
                let detail = format!("a choice must have 1 to {MAX_CHOICE} characters");
                return wrong(&format!("/choices/{index}"), detail);
            }
        }
        if asked.right.is_some_and(|right| right >= asked.choices.len()) {
            return wrong("/right", format!("right must be an index below {}", asked.choices.len()));
        }
        Ok(Self { number, asked, votes: HashMap::new(), max_votes, revealed: false, before: None })
    }

    pub(super) fn count(&mut self, vote: &Vote) -> Result<(), Problem> {
        if vote.question != self.number || self.revealed {
            return Err(Problem::new(
                StatusCode::CONFLICT,
                "question-over",
                "this question no longer takes answers",
                "answer the question that is asked now",
            ));
        }
        if vote.choice >= self.asked.choices.len() {
            let detail = format!("choice must be an index below {}", self.asked.choices.len());
            return Err(refused("/choice", detail));
        }
        check_voter(&vote.voter)?;
        if self.votes.len() >= self.max_votes && !self.votes.contains_key(&vote.voter) {
            return Err(Problem::new(
                StatusCode::SERVICE_UNAVAILABLE,
                "too-many-answers",
                format!("{} have answered, as many as this room takes", self.max_votes),
                "watch the result; your answer was not counted",
            ));
        }
        self.votes.insert(vote.voter.clone(), vote.choice);
        Ok(())
    }

    pub(super) fn reveal(&mut self) {
        self.revealed = true;
    }

    /// Another vote on the same question, under another number; the counts so far are kept.
    pub(super) fn again(&mut self, number: u64) {
        self.before = Some(self.counts());
        self.votes.clear();
        self.revealed = false;
        self.number = number;
    }

    fn counts(&self) -> Vec<usize> {
        let mut counts = vec![0; self.asked.choices.len()];
        for &choice in self.votes.values() {
            // What was kept in a file may be damaged.
            if let Some(count) = counts.get_mut(choice) {
                *count += 1;
            }
        }
        counts
    }

    pub(super) fn tally(&self) -> Tally {
        Tally {
            number: self.number,
            counts: self.counts(),
            before: self.before.clone(),
            right: self.asked.right,
            revealed: self.revealed,
        }
    }

    pub(super) fn view(&self) -> LectureQuestion {
        LectureQuestion {
            number: self.number,
            text: self.asked.text.clone(),
            choices: self.asked.choices.clone(),
            again: self.before.is_some(),
            result: self.revealed.then(|| self.tally()),
        }
    }
}

/// Errors unless a name is one that a browser may make up.
pub(super) fn check_voter(voter: &str) -> Result<(), Problem> {
    if voter.is_empty() || voter.len() > MAX_VOTER {
        return Err(refused("/voter", format!("voter must have 1 to {MAX_VOTER} characters")));
    }
    Ok(())
}

fn refused(pointer: &str, detail: String) -> Problem {
    let hint = "compare with the request's schema in /api/openapi.json";
    Problem::new(StatusCode::UNPROCESSABLE_ENTITY, "invalid-question", detail.clone(), hint)
        .at(pointer, detail)
}

pub(super) fn none() -> Problem {
    Problem::new(
        StatusCode::CONFLICT,
        "no-question",
        "no question is asked in this room",
        "the presenter asks one with PUT /api/v1/rooms/CODE/question",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn question() -> PosedQuestion {
        let asked = NewQuestion {
            text: "Which sign has Fx?".into(),
            choices: vec!["+".into(), "−".into(), "zero".into()],
            right: Some(1),
        };
        PosedQuestion::new(7, asked, 3).expect("a question")
    }

    fn vote(voter: &str, choice: usize) -> Vote {
        Vote { question: 7, voter: voter.into(), choice }
    }

    #[test]
    fn each_voter_counts_once_and_the_number_of_voters_is_bounded() {
        let mut asked = question();
        for (voter, choice) in [("a", 0), ("a", 1), ("b", 1), ("c", 2)] {
            asked.count(&vote(voter, choice)).expect("counts");
        }
        assert_eq!(asked.tally().counts, [0, 2, 1]);
        assert_eq!(asked.count(&vote("d", 0)).map_err(|p| p.code()), Err("too-many-answers"));
        assert_eq!(asked.count(&vote("a", 3)).map_err(|p| p.code()), Err("invalid-question"));
        asked.count(&vote("a", 0)).expect("a change of mind");
        assert_eq!(asked.tally().counts, [1, 1, 1]);
    }

    #[test]
    fn a_second_vote_counts_anew_and_keeps_the_first_beside_it() {
        let mut asked = question();
        asked.count(&vote("a", 0)).expect("counts");
        asked.reveal();
        asked.again(8);
        assert_eq!(asked.view().result, None, "hidden again");
        assert_eq!(asked.count(&vote("a", 1)).map_err(|p| p.code()), Err("question-over"));
        asked.count(&Vote { question: 8, ..vote("a", 1) }).expect("counts");
        let tally = asked.tally();
        assert_eq!((tally.counts, tally.before), (vec![0, 1, 0], Some(vec![1, 0, 0])));
    }

    #[test]
    fn the_result_is_hidden_before_the_reveal() {
        let mut asked = question();
        asked.count(&vote("a", 0)).expect("counts");
        let before = serde_json::to_value(asked.view()).expect("JSON");
        assert_eq!(
            before.as_object().map(|all| all.keys().cloned().collect::<Vec<_>>()),
            Some(vec!["again".into(), "choices".into(), "number".into(), "text".into()])
        );
        asked.reveal();
        assert_eq!(
            asked.view().result.map(|tally| (tally.counts, tally.right)),
            Some((vec![1, 0, 0], Some(1)))
        );
        assert_eq!(asked.count(&vote("b", 0)).map_err(|p| p.code()), Err("question-over"));
    }
}
