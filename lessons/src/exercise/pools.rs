//! Pools: questions of which each student gets some. Which ones is drawn from the seed, like the numbers.

use std::collections::{BTreeMap, BTreeSet};

use super::context::QuestionError;
use super::question::{Exercise, QuantityQuestion, Question, QuestionBody};
use crate::files::earlier_value;
use crate::random::SeededRandom;

impl Exercise {
    /// Leaves of each pool as many questions as it deals, in the author's order: a student's own, and the same for ever. Where
    /// an earlier version of the lesson has dealt already, its hand stays, as long as all of it is still there.
    ///
    /// Each question draws a number of its own, so that one that is added later changes as few hands as possible.
    pub(crate) fn draw_own(&mut self, lesson: &str, drawn_from: &str, earlier: Option<&Self>) {
        let hand = earlier.map(|earlier| earlier.dealt(lesson, drawn_from));
        let is_here = |id: &String| self.questions.iter().any(|q| q.id == *id && q.pool.is_some());
        let dealt = match hand.filter(|hand| hand.iter().all(is_here)) {
            Some(hand) => hand,
            None => self.dealt(lesson, drawn_from),
        };
        self.questions.retain(|question| question.pool.is_none() || dealt.contains(&question.id));
    }

    /// The questions that the pools deal.
    fn dealt(&self, lesson: &str, drawn_from: &str) -> BTreeSet<String> {
        let mut dealt: BTreeSet<String> = BTreeSet::new();
        for (pool, count) in &self.draw {
            let luck = |question: &Question| {
                let text = format!("{lesson}/{}/pool/{drawn_from}", question.id);
                (SeededRandom::new(&text).unit(), question.id.clone())
            };
            let mut drawn: Vec<(f64, String)> = self.pool(pool).map(luck).collect();
            drawn.sort_by(|a, b| a.0.total_cmp(&b.0));
            dealt.extend(drawn.into_iter().take(*count).map(|(_, id)| id));
        }
        dealt
    }

    /// The points that a program gives at most, whichever questions the pools deal. Those of explanations come on top of them.
    pub fn possible(&self) -> f64 {
        let is_common = |q: &&Question| q.pool.is_none() && !q.is_judged_by_people();
        let common = self.questions.iter().filter(is_common).map(|q| q.points).sum::<f64>();
        let dealt = self.draw.iter().map(|(pool, count)| {
            let points = self.pool(pool).map(|q| q.points);
            points.take(*count).sum::<f64>()
        });
        common + dealt.sum::<f64>()
    }

    /// The points that people give at most.
    pub fn by_people(&self) -> f64 {
        self.questions.iter().filter(|q| q.is_judged_by_people()).map(|q| q.points).sum()
    }

    /// The largest number of points that such questions can have in anybody's hand.
    pub(crate) fn at_most(&self, such: impl Fn(&Question) -> bool) -> f64 {
        let common =
            self.questions.iter().filter(|q| q.pool.is_none() && such(q)).map(|q| q.points).sum::<f64>();
        let dealt = self.draw.iter().map(|(pool, count)| {
            self.pool(pool).filter(|q| such(q)).take(*count).map(|q| q.points).sum::<f64>()
        });
        common + dealt.sum::<f64>()
    }

    fn pool<'a>(&'a self, pool: &str) -> impl Iterator<Item = &'a Question> {
        let pool = pool.to_owned();
        self.questions.iter().filter(move |q| q.pool.as_deref() == Some(pool.as_str()))
    }
}

/// Whether each pool can deal what it promises, with as many points for everybody, and nothing hangs on what may not be there.
pub(super) fn usable(draw: &BTreeMap<String, usize>, questions: &[Question]) -> Result<(), QuestionError> {
    let refused = |question: &str, problem: String, remedy: &str| {
        let (question, remedy) = (question.to_owned(), remedy.to_owned());
        Err(QuestionError { question, in_reference: false, problem, remedy })
    };
    for question in questions {
        if let Some(pool) = question.pool.as_ref().filter(|pool| !draw.contains_key(*pool)) {
            let problem = format!("nothing is drawn from its pool {pool}");
            return refused(&question.id, problem, "say under [draw] how many of the pool each student gets");
        }
        let QuestionBody::Quantity(QuantityQuestion { follows: Some(follows), .. }) = &question.body else {
            continue;
        };
        let may_be_missing = |id: &str| questions.iter().any(|q| q.id == id && q.pool.is_some());
        if let Some(id) = follows.from.values().map(|v| earlier_value(v).0).find(|id| may_be_missing(id)) {
            let problem = format!("it follows {id}, which is in a pool");
            return refused(&question.id, problem, "follow a question that everybody gets");
        }
    }
    for (pool, count) in draw {
        let own: Vec<&Question> =
            questions.iter().filter(|q| q.pool.as_deref() == Some(pool.as_str())).collect();
        if *count < 1 || *count > own.len() {
            let name = own.first().map_or(pool.as_str(), |q| q.id.as_str());
            let problem = format!("{count} of the {} questions of the pool {pool} are drawn", own.len());
            return refused(name, problem, "draw at least one, and no more than there are");
        }
        if let Some(other) = own.iter().find(|q| q.points != own[0].points) {
            let problem = format!("it has other points than {} of the same pool", own[0].id);
            return refused(&other.id, problem, "give all questions of a pool the same points");
        }
    }
    Ok(())
}
