//! Numbers that were dealt stay when a lesson is mended: a misconception that is added, a question more in a pool.

use std::path::Path;

use super::add_files;
use crate::files::Files;
use crate::{Lesson, Mark, grade, reference_submission};

/// Students whose numbers are compared.
const STUDENTS: usize = 200;

/// A lesson with one of its files as its author edited it.
fn edited(folder: &str, path: &str, edit: impl Fn(&str) -> String) -> Lesson {
    let mut files = Files::new();
    add_files(&mut files, &Path::new(env!("CARGO_MANIFEST_DIR")).join("course").join(folder), "");
    let mut files: Files =
        files.into_iter().map(|(path, bytes)| (path.trim_start_matches('/').to_owned(), bytes)).collect();
    let text = edit(std::str::from_utf8(&files[path]).unwrap());
    files.insert(path.to_owned(), text.into_bytes());
    Lesson::from_files(folder, files).unwrap()
}

fn own(lesson: &Lesson, k: usize) -> Lesson {
    lesson.variant_in(&format!("student-{k}"), "secret").unwrap()
}

/// Students whose numbers or questions differ between two versions.
fn differ(one: &Lesson, other: &Lesson) -> Vec<usize> {
    let hand = |lesson: &Lesson| lesson.exercise.questions.iter().map(|q| q.id.clone()).collect::<Vec<_>>();
    let same = |a: &Lesson, b: &Lesson| a.parameters == b.parameters && hand(a) == hand(b);
    (0..STUDENTS).filter(|k| !same(&own(one, *k), &own(other, *k))).collect()
}

const PENDULUM: &str = "02-simple-pendulum";

/// The pendulum knows one mistake more, which is the right answer for those with 2 kg.
fn with_a_misconception(words: &str) -> Lesson {
    edited(PENDULUM, "exercise.toml", |text| {
        let (head, tail) = text.split_once("id = \"tension-bottom\"").unwrap();
        let at = tail.find("[[question.misconception]]").unwrap();
        let new = format!(
            "[[question.misconception]]\nid = \"of-the-text\"\nvalue = 58.86\nfeedback = \"{words}\"\n\n"
        );
        format!("{head}id = \"tension-bottom\"{}{new}{}", &tail[..at], &tail[at..])
    })
}

#[test]
fn who_has_numbers_keeps_them_when_a_misconception_is_added() {
    let before = edited(PENDULUM, "exercise.toml", str::to_owned);
    let plain = with_a_misconception("These are the numbers of the text.");
    let hurt = differ(&before, &plain);
    assert!((2..STUDENTS / 10).contains(&hurt.len()), "{hurt:?}");
    let now = plain.dealing_as(&before);
    assert!(differ(&before, &now).is_empty());
    assert_eq!((now.hash.as_str(), now.dealer_hash()), (plain.hash.as_str(), before.hash.as_str()));
    // Also by whoever reads it as it is kept, and in the version after it.
    assert!(differ(&before, &Lesson::from_bundle(&now.bundle()).unwrap()).is_empty());
    assert_eq!(Lesson::from_bundle(&now.bundle()).unwrap().bundle(), now.bundle());
    let later = with_a_misconception("Whose numbers are these?").dealing_as(&now);
    assert_eq!((differ(&before, &later), later.dealer_hash()), (Vec::new(), before.hash.as_str()));
    // What was right stays right; without the earlier version it would be an answer to other numbers.
    for k in hurt {
        let answers = reference_submission(&own(&before, k));
        let tension = |lesson: &Lesson| {
            let verdict = grade(&own(lesson, k), &answers).unwrap();
            verdict.questions.into_iter().find(|q| q.id == "tension-bottom").unwrap().verdict
        };
        assert_eq!((tension(&now), tension(&plain)), (Mark::Right, Mark::Wrong));
    }
}

#[test]
fn numbers_are_dealt_anew_where_the_ranges_are_others() {
    let before = edited(PENDULUM, "exercise.toml", str::to_owned);
    let finer = edited(PENDULUM, "exercise.toml", |text| text.replacen("step = 0.01", "step = 0.02", 1));
    assert!(!finer.deals_from_the_same(&before));
    assert_eq!(finer.dealing_as(&before).dealer_hash(), finer.hash);
    assert!(differ(&finer, &finer.dealing_as(&before)).is_empty());
}

#[test]
fn who_has_a_hand_keeps_it_when_a_question_joins_the_pool() {
    const EXAM: &str = "31-find-the-mistake";
    let before = edited(EXAM, "exercise.toml", str::to_owned);
    let new = "\n[[question]]\nid = \"see-more\"\npool = \"glance\"\nkind = \"choice\"\npoints = 1\nprompt = \"And now?\"\nhints = [\"Look.\"]\n\
        [[question.option]]\nid = \"a\"\ntext = \"This.\"\nreason = \"So.\"\n[[question.option]]\nid = \"b\"\ntext = \"That.\"\nreason = \"No.\"\n";
    let mut files = Files::new();
    add_files(&mut files, &Path::new(env!("CARGO_MANIFEST_DIR")).join("course").join(EXAM), "");
    let files: Files = files
        .into_iter()
        .map(|(path, bytes)| {
            let more = match path.trim_start_matches('/') {
                "exercise.toml" => new,
                "reference/answers.toml" => {
                    "\n[see-more]\nvalue = \"a\"\nprovenance = \"argument\"\nsource = \"So.\"\n"
                }
                _ => "",
            };
            (path.trim_start_matches('/').to_owned(), [bytes.as_slice(), more.as_bytes()].concat())
        })
        .collect();
    let plain = Lesson::from_files(EXAM, files).unwrap();
    assert!(differ(&before, &plain).len() > STUDENTS / 10);
    assert!(differ(&before, &plain.dealing_as(&before)).is_empty());
    // A question that is gone cannot be dealt any more: those who had it get another one.
    let back = before.dealing_as(&plain);
    let had = differ(&plain, &back);
    assert!(had.iter().all(|k| own(&plain, *k).question("see-more").is_some()) && !had.is_empty());
}
