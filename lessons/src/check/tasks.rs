//! Trying out the questions that are answered by work: right, with every slip, and with nothing done.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde_json::json;

use super::Found;
use super::answers::reference_answer;
use crate::exercise::{Body, Implement, Question, Trajectory};
use crate::files::Part;
use crate::grade::grade;
use crate::implement::{Deal, Grid, recognise, seed, slipped};
use crate::lesson::Lesson;
use crate::measure::with_error;
use crate::starter::Language;
use crate::submission::{Answer, Submission};
use crate::trajectory::{Track, reference_csv};
use crate::verdict::{Mark, QuestionVerdict};

/// Seeds of the students whose states are tried out.
const SEEDS: usize = 200;
/// Seeds whose answers are also sent and read as a student's are.
const WHOLE: usize = 3;
/// Share of them in which a slip must be recognised as itself.
const RECOGNISED: f64 = 0.95;

/// One question of these kinds.
pub(super) fn task(question: &Question, found: &mut Found) {
    let id = question.id.as_str();
    let done = match &question.body {
        Body::Implement(task) => implement(found, id, task),
        Body::Trajectory(task) => trajectory(found, id, task),
        Body::Tuning(task) => with_error(&task.scene, &task.watch).map(|(_, error)| {
            if 10.0 * error > task.error {
                let what = format!("it asks for {:e}, its reference is off by up to {error:e}", task.error);
                found.question(id, what, "ask for at least ten times the error of the reference");
            }
        }),
        Body::Model(task) => {
            for watch in task.watches().iter().filter(|w| w.feedback.trim().is_empty()) {
                found.question(
                    id,
                    format!("the watch \u{201c}{}\u{201d} has no feedback", watch.what),
                    "write it",
                );
            }
            let known = |kind: &str| {
                let written = serde_json::Value::String(kind.to_owned());
                serde_json::from_value::<triad_engine::scene::JointKind>(written).is_ok()
            };
            for kind in task.demands.joints.keys().filter(|kind| !known(kind)) {
                found.question(id, format!("there is no joint {kind}"), "name a type such as revolute");
            }
            Ok(())
        }
        Body::Quantity(_) | Body::Choice { .. } | Body::Formula(_) => Ok(()),
    };
    if let Err(problem) = done {
        found.question(id, problem, "correct the question or its scene");
    }
}

/// Grades one answer of a lesson.
pub(super) fn judged(lesson: &Lesson, id: &str, answer: Answer) -> Option<QuestionVerdict> {
    let answers = BTreeMap::from([(id.to_owned(), answer)]);
    let verdict = grade(lesson, &Submission { answers, ..Submission::default() }).ok()?;
    verdict.questions.into_iter().find(|v| v.id == id)
}

fn file(text: String) -> Answer {
    Answer { file: Some(text), ..Answer::default() }
}

/// Every seed's reference passes, zeros do not, and every slip is recognised.
fn implement(found: &mut Found, id: &str, task: &Implement) -> Result<(), String> {
    let mut recognised: BTreeMap<String, [usize; 2]> = BTreeMap::new();
    for k in 0..SEEDS {
        let lesson = found.lesson.variant(&format!("check-{k}")).map_err(|e| e.to_string())?;
        let question = lesson.question(id).ok_or("the question is gone")?;
        let Body::Implement(own) = &question.body else { return Ok(()) };
        let mut deal = Deal::new(own, &seed(&lesson, id))?;
        for part in &own.asks {
            let right = deal.answers(*part)?;
            let slips = slipped(own, &mut deal, *part)?;
            for slip in &slips {
                let got = recognise(&slip.grids, &right, &slips, own.tolerance);
                let count = recognised.entry(format!("{}-{}", part.key(), slip.id)).or_default();
                count[0] += usize::from(got.is_some_and(|got| got.id == slip.id));
                count[1] += 1;
            }
        }
        if k < WHOLE {
            whole_way(&lesson, question, own, &mut deal)?;
        }
    }
    for (name, [n, of]) in recognised {
        if (n as f64) < RECOGNISED * of as f64 {
            found.question(
                id,
                format!("the slip {name} is recognised in {n} of {of} cases"),
                "take another mechanism",
            );
        }
    }
    let zeros: BTreeMap<Part, Vec<Grid>> = {
        let deal = Deal::new(task, &seed(found.lesson, id))?;
        let blank = |grids: Vec<Grid>| -> Vec<Grid> {
            grids.into_iter().map(|g| Grid { values: vec![0.0; g.values.len()], ..g }).collect()
        };
        task.asks.iter().map(|p| Ok((*p, blank(deal.answers(*p)?)))).collect::<Result<_, String>>()?
    };
    let starter = judged(found.lesson, id, file(written(&zeros, task.states)));
    if starter.is_none_or(|v| v.earned > 0.0) {
        found.question(id, "what the starter writes earns points", "ask for something that is not zero");
    }
    if Language::ALL.iter().any(|l| found.lesson.starter(id, *l).is_none_or(|text| text.contains("{{"))) {
        found.question(id, "a starter has an open place", "correct the starters");
    }
    Ok(())
}

/// The reference and every slip, sent as a program sends them.
fn whole_way(lesson: &Lesson, question: &Question, task: &Implement, deal: &mut Deal) -> Result<(), String> {
    let id = &question.id;
    let mark = judged(lesson, id, reference_answer(lesson, question)).map(|v| v.verdict);
    if mark != Some(Mark::Right) {
        return Err(format!("its own reference is judged {mark:?} for the seed {}", lesson.seed));
    }
    let right: BTreeMap<Part, Vec<Grid>> =
        task.asks.iter().map(|p| Ok((*p, deal.answers(*p)?))).collect::<Result<_, String>>()?;
    for part in &task.asks {
        for slip in slipped(task, deal, *part)? {
            let mut parts = right.clone();
            let name = format!("{}-{}", part.key(), slip.id);
            parts.insert(*part, slip.grids);
            let got = judged(lesson, id, file(written(&parts, task.states))).and_then(|v| v.slip);
            if got.as_deref() != Some(name.as_str()) {
                return Err(format!("the slip {name} is taken for {got:?} with the seed {}", lesson.seed));
            }
        }
    }
    Ok(())
}

/// Grids as a program writes them.
pub(super) fn written(parts: &BTreeMap<Part, Vec<Grid>>, states: usize) -> String {
    let state = |k: usize| {
        let entry = |(part, grids): (&Part, &Vec<Grid>)| {
            let grid = &grids[k];
            let lines: Vec<&[f64]> = grid.values.chunks(grid.columns.max(1)).collect();
            let value = if grid.columns == 1 { json!(grid.values) } else { json!(lines) };
            (part.key().to_owned(), value)
        };
        parts.iter().map(entry).collect::<serde_json::Map<_, _>>()
    };
    json!({ "states": (0..states).map(state).collect::<Vec<_>>() }).to_string()
}

/// The error of the reference, and delays and factors that must be told apart.
fn trajectory(found: &mut Found, id: &str, task: &Trajectory) -> Result<(), String> {
    let track = Track::new(task)?;
    let (best, worst) =
        (task.bands.first().map_or(0.0, |b| b.error), task.bands.last().map_or(0.0, |b| b.error));
    if 10.0 * track.error > best {
        let what = format!("its best band is {best:e}, its reference is off by up to {:e}", track.error);
        found.question(id, what, "a band is at least ten times the error of the reference");
    }
    let table = |late: f64, factor: f64| {
        let mut text = format!("t,{}\n", task.columns.keys().cloned().collect::<Vec<_>>().join(","));
        for k in 0..=777 {
            let t = task.end * f64::from(k) / 777.0;
            let _ = write!(text, "{t}");
            for column in 0..task.columns.len() {
                let mean =
                    (0..=400).map(|k| track.at(column, task.end * f64::from(k) / 400.0)).sum::<f64>() / 401.0;
                let _ = write!(text, ",{}", mean + factor * (track.at(column, t - late) - mean));
            }
            text.push('\n');
        }
        text
    };
    let thin = reference_csv(task, 400)?;
    let cases = [
        (thin, None, "the reference with 400 rows"),
        (table(0.02 * task.end, 1.0), Some("phase"), "a delay"),
        (table(0.0, 1.0 + 3.0 * worst + 0.05), Some("amplitude"), "a factor"),
        (table(0.0, -1.0), Some("opposite-sign"), "the opposite sign"),
    ];
    for (text, slip, what) in cases {
        let Some(verdict) = judged(found.lesson, id, file(text)) else { continue };
        // The opposite of a motion may be the motion half a period later: then it is called so.
        let fits = match slip {
            None => verdict.verdict == Mark::Right,
            Some("opposite-sign") => verdict.verdict == Mark::Wrong,
            Some(slip) => verdict.slip.as_deref() == Some(slip),
        };
        if !fits {
            let got = verdict.slip.unwrap_or_else(|| format!("{:?}", verdict.verdict));
            found.question(id, format!("{what} is judged {got}"), "take another motion or other bands");
        }
    }
    Ok(())
}
