//! What students did at the questions of a lesson, as it is kept.

use std::collections::{BTreeMap, HashMap};

use serde_json::Value;
use triad_lessons::{Mark, Verdict};

use crate::policy::Moment;
use crate::problem::Problem;
use crate::store::{Recorded, Role, Store};

/// One answer to a question, judged or sent back.
#[derive(Debug, Clone, PartialEq)]
pub struct Try {
    /// The submission.
    pub submission: String,
    /// When it came.
    pub at: Moment,
    /// How it was judged.
    pub mark: Mark,
    /// Share of the points, from 0 to 1.
    pub share: f64,
    /// The mistake that was recognised.
    pub mistake: Option<String>,
    /// How many different answers there were up to this one.
    pub different: usize,
    /// What was answered, as it was sent.
    pub answer: Value,
    /// What was said about it, as safe HTML.
    pub message_html: String,
}

impl Try {
    /// Whether it counts as an answer that a program judged.
    pub fn is_judged(&self) -> bool {
        matches!(self.mark, Mark::Right | Mark::Wrong)
    }

    /// The mistake of a wrong answer: empty if it was not recognised; none of a right one.
    pub fn wrong(&self) -> Option<&str> {
        (self.mark == Mark::Wrong).then(|| self.mistake.as_deref().unwrap_or_default())
    }
}

/// One student's work at one question.
#[derive(Debug, Clone, PartialEq)]
pub struct Work {
    /// The person's id.
    pub person: String,
    /// The name.
    pub name: String,
    /// What the person's numbers are drawn from; never told.
    pub seed: String,
    /// The numbers.
    pub numbers: BTreeMap<String, f64>,
    /// Points of the question; none where people give them.
    pub possible: f64,
    /// The answers, the oldest first.
    pub tries: Vec<Try>,
    /// Share of the points of all other questions of the lesson that the first answers to them earned; none if there are none.
    pub rest: Option<f64>,
}

impl Work {
    /// The answers that were judged.
    pub fn judged(&self) -> impl DoubleEndedIterator<Item = &Try> {
        self.tries.iter().filter(|one| one.is_judged())
    }

    /// Whether there is an answer that was judged or kept.
    pub fn has_answered(&self) -> bool {
        self.tries.iter().any(|one| one.mark != Mark::Invalid)
    }

    /// What the first answer earned, if there is one.
    pub fn first(&self) -> Option<f64> {
        self.judged().next().map(|one| one.share)
    }

    /// What the best answer earned.
    pub fn best(&self) -> Option<f64> {
        self.judged().map(|one| one.share).max_by(f64::total_cmp)
    }

    /// How many different answers it took until all points were earned.
    pub fn until_right(&self) -> Option<usize> {
        // The last digits of shares are rounding.
        self.judged().find(|one| one.share >= 1.0 - 1e-12).map(|one| one.different)
    }
}

/// The students of a class at the questions of one lesson.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Class {
    /// Work by the question's id; who was not dealt the question has none.
    pub questions: HashMap<String, Vec<Work>>,
    /// How many students handed in.
    pub students: usize,
}

impl Class {
    /// Reads what the students of a course handed in to a lesson, by the verdicts in force.
    ///
    /// Errors if the gradebook or a verdict cannot be read.
    pub async fn open(store: &Store, course: &str, lesson: &str) -> Result<Self, Problem> {
        let people = store.people(course).await?;
        let students = people.into_iter().filter(|one| one.role == Role::Student);
        let names: HashMap<String, String> = students.map(|one| (one.id, one.name)).collect();
        let recorded = store.recorded(course, Some(lesson)).await?;
        crate::blocking(move || Self::read(&names, recorded)).await
    }

    /// The same of records in the order in which verdicts were given.
    ///
    /// Errors if a verdict cannot be read.
    pub fn read(names: &HashMap<String, String>, recorded: Vec<Recorded>) -> Result<Self, Problem> {
        let mut newest: HashMap<String, usize> = HashMap::new();
        for (place, one) in recorded.iter().enumerate() {
            newest.insert(one.id.clone(), place);
        }
        let in_force =
            recorded.into_iter().enumerate().filter(|(place, one)| newest.get(&one.id) == Some(place));
        let mut by_person: BTreeMap<(String, String), Vec<Recorded>> = BTreeMap::new();
        for (_, one) in in_force {
            if let Some(name) = names.get(&one.person) {
                by_person.entry((name.clone(), one.person.clone())).or_default().push(one);
            }
        }
        let mut class = Self { students: by_person.len(), ..Self::default() };
        for ((name, person), mut own) in by_person {
            own.sort_by_key(|one| one.at);
            class.add(&name, &person, &own)?;
        }
        Ok(class)
    }

    fn add(&mut self, name: &str, person: &str, own: &[Recorded]) -> Result<(), Problem> {
        let mut works: BTreeMap<String, Work> = BTreeMap::new();
        for one in own {
            let verdict: Verdict = serde_json::from_str(&one.body).map_err(Problem::internal)?;
            let answers: Value = serde_json::from_str(&one.answers).map_err(Problem::internal)?;
            for question in verdict.questions {
                let work = works.entry(question.id.clone()).or_insert_with(|| Work {
                    person: person.to_owned(),
                    name: name.to_owned(),
                    seed: one.seed.clone(),
                    numbers: verdict.provenance.parameters.clone(),
                    possible: question.possible,
                    tries: Vec::new(),
                    rest: None,
                });
                if matches!(question.verdict, Mark::Blank | Mark::Waiting) {
                    continue;
                }
                let before = work.tries.len();
                work.tries.push(Try {
                    submission: one.id.clone(),
                    at: one.at,
                    mark: question.verdict,
                    share: if question.possible > 0.0 { question.earned / question.possible } else { 0.0 },
                    mistake: question.misconception,
                    different: question.standing.map_or(before + 1, |standing| standing.attempts),
                    answer: answers.get(&question.id).cloned().unwrap_or_default(),
                    message_html: question.message_html,
                });
            }
        }
        let firsts: Vec<(f64, f64)> =
            works.values().map(|work| (work.first().unwrap_or(0.0) * work.possible, work.possible)).collect();
        for (place, (id, mut work)) in works.into_iter().enumerate() {
            let others = firsts.iter().enumerate().filter(|(other, _)| *other != place);
            let (earned, possible) =
                others.fold((0.0, 0.0), |sum, (_, (earned, possible))| (sum.0 + earned, sum.1 + possible));
            work.rest = (possible > 0.0).then(|| earned / possible);
            self.questions.entry(id).or_default().push(work);
        }
        Ok(())
    }
}
