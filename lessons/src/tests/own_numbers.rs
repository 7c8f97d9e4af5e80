//! Numbers of one's own: enough of them, equally hard, and of no use to somebody else.

use std::collections::{BTreeMap, BTreeSet};
use std::thread;

use super::course;
use crate::answers::tolerance::norm;
use crate::check::copied::{self, Copied, Hand};
use crate::exercise::{QuantityQuestion, QuestionBody};
use crate::recognition::slips;
use crate::{Lesson, Submission, grade, reference_submission};

/// Sets of right answers that each lesson must deal.
const SETS: usize = 200;
/// Students of whom so many sets are found: of 200 equally likely ones the last is met after 1200.
const DRAWS: usize = 4000;
/// Students whose numbers are compared.
const STUDENTS: usize = 60;
/// How much larger the largest answer to a question may be than the smallest.
const SPREAD: f64 = 40.0;
/// Share of simulated students who make one slip in a question.
const CARELESS: f64 = 0.4;
/// How much easier a lesson may be for one student than for another, as a share of its points: 0.08 is a fifth of what the simulated
/// students lose at all, or one slip of five that somebody makes and another is spared. Set after measuring: the least even are those
/// on two links (0.079), on singular positions (0.076) and on one body (0.064), the other 26 lie below 0.04.
const EASIER: f64 = 0.08;
/// The same of a single question, which has few slips to choose from: a slip that changes little with some numbers (a square of what
/// is nearly one) is let pass. Set after measuring: the least even question has 0.104.
const EASIER_QUESTION: f64 = 0.11;
/// Students who hand in what the program gives for their name at home.
const COPIERS: usize = 3;
/// Share of their hands that may pass because two draws lie within one tolerance by chance: as the check has it.
const LUCK: f64 = copied::LUCKY_AT_ONCE;
/// Students of a class who take answers from each other.
const CLASS: usize = 200;

/// The lesson as a student of a class gets it.
fn own(lesson: &Lesson, k: usize) -> Lesson {
    lesson.variant_in(&format!("student-{k}"), "secret").unwrap()
}

/// Something done with each lesson, on two threads.
fn of_each<T: Send>(work: impl Fn(&Lesson) -> T + Sync) -> Vec<(String, T)> {
    let course = course();
    let halves: Vec<Vec<&Lesson>> =
        (0..2).map(|half| course.lessons().iter().skip(half).step_by(2).collect()).collect();
    thread::scope(|scope| {
        let work = &work;
        let of = |half: Vec<&Lesson>| half.into_iter().map(|l| (l.slug.clone(), work(l))).collect::<Vec<_>>();
        let running: Vec<_> = halves.into_iter().map(|half| scope.spawn(move || of(half))).collect();
        running.into_iter().flat_map(|one| one.join().unwrap()).collect()
    })
}

/// The right answers that a student has to find, as far as they are numbers or programs.
fn right_answers(lesson: &Lesson) -> String {
    let of = |q: &crate::exercise::Question| match &q.body {
        QuestionBody::Quantity(body) => format!("{} {:.9?}", q.id, body.reference),
        // A program is asked for the equations in states of one's own.
        QuestionBody::Implement(_) => format!("{} {:?}", q.id, lesson.instances(&q.id)),
        _ => q.id.clone(),
    };
    lesson.exercise.questions.iter().map(of).collect::<Vec<_>>().join("; ")
}

/// Counted by drawing: what is refused after it was drawn is dealt to nobody.
#[test]
fn every_lesson_deals_two_hundred_sets_of_right_answers() {
    let counted = of_each(|lesson| {
        let mut sets = BTreeSet::new();
        let drawn = (0..DRAWS).find(|k| {
            sets.insert(right_answers(&own(lesson, *k)));
            sets.len() >= SETS
        });
        (sets.len(), drawn)
    });
    for (slug, (sets, drawn)) in &counted {
        println!("{slug:26} {sets} sets after {} students", drawn.map_or(DRAWS, |k| k + 1));
    }
    let few: Vec<_> = counted.iter().filter(|(_, (sets, _))| *sets < SETS).collect();
    assert!(few.is_empty(), "{few:?}");
}

/// Nobody's numbers are much easier: no answer vanishes, and all are of the same size.
#[test]
fn no_answer_is_much_larger_for_one_student_than_for_another() {
    for lesson in course().lessons() {
        let mut sizes: BTreeMap<String, Vec<f64>> = BTreeMap::new();
        for k in 0..STUDENTS {
            for question in &own(lesson, k).exercise.questions {
                let QuestionBody::Quantity(q) = &question.body else { continue };
                if !q.tolerance.is_exact() {
                    sizes.entry(question.id.clone()).or_default().push(norm(&q.reference));
                }
            }
        }
        for (id, sizes) in sizes {
            let (least, most) = sizes.iter().fold((f64::MAX, 0.0f64), |(a, b), x| (a.min(*x), b.max(*x)));
            assert!(least > 0.0 && most <= SPREAD * least, "{}/{id}: {least} to {most}", lesson.slug);
        }
    }
}

/// The share of one slip in the expression of a right answer that nobody would notice, since the answer stays right.
fn unnoticed(question: &QuantityQuestion) -> Option<f64> {
    let derivation = &question.derivation;
    let ([node], false) = (derivation.entries.as_slice(), question.tolerance.is_exact()) else { return None };
    let slips = slips(node, &derivation.symbols);
    let right = slips.iter().filter(|x| question.tolerance.accepts(&[**x], &question.reference)).count();
    (!slips.is_empty()).then(|| right as f64 / slips.len() as f64)
}

/// What a careless student may expect of each question, and of all of a lesson together, by points.
fn facility(lesson: &Lesson) -> (BTreeMap<String, f64>, Option<f64>) {
    let (mut each, mut earned, mut points) = (BTreeMap::new(), 0.0, 0.0);
    for question in &lesson.exercise.questions {
        let QuestionBody::Quantity(q) = &question.body else { continue };
        let Some(unnoticed) = unnoticed(q) else { continue };
        let expected = 1.0 - CARELESS * (1.0 - unnoticed);
        each.insert(question.id.clone(), expected);
        (earned, points) = (earned + expected * question.points, points + question.points);
    }
    (each, (points > 0.0).then(|| earned / points))
}

/// Students are simulated who make one slip now and then, of all that a right answer's expression invites. What a lesson is
/// worth to them, its facility, may not depend on the numbers that they were dealt.
#[test]
fn the_numbers_are_equally_hard_for_careless_students() {
    let measured = of_each(|lesson| {
        let mut ranges: BTreeMap<String, [f64; 2]> = BTreeMap::new();
        let mut seen = |of: &str, x: f64| {
            let [least, most] = ranges.entry(of.to_owned()).or_insert([f64::MAX, f64::MIN]);
            (*least, *most) = (least.min(x), most.max(x));
        };
        for k in 0..STUDENTS {
            let (each, whole) = facility(&own(lesson, k));
            for (id, x) in &each {
                seen(id, *x);
            }
            if let Some(x) = whole {
                seen("", x);
            }
        }
        ranges
    });
    let all = measured.iter().flat_map(|(slug, of)| of.iter().map(move |(id, range)| (slug, id, *range)));
    let mut all: Vec<_> =
        all.map(|(slug, id, [least, most])| (most - least, slug, id, least, most)).collect();
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (lessons, questions): (Vec<_>, Vec<_>) = all.into_iter().partition(|one| one.2.is_empty());
    println!("{} questions; the least even: {:?}", questions.len(), &questions[..8]);
    println!("{} lessons; the least even: {:?}", lessons.len(), &lessons[..8]);
    assert!(questions.len() >= 80 && lessons.len() >= 25);
    let uneven = |list: &[(f64, &String, &String, f64, f64)], most: f64| list.iter().any(|one| one.0 > most);
    assert!(!uneven(&lessons, EASIER), "{lessons:#?}");
    assert!(!uneven(&questions, EASIER_QUESTION), "{questions:#?}");
}

/// The program gives everybody the right answers of the built-in course. In a class with a secret they pass no lesson: numbers
/// are others there, and what is the same for all is worth less than it takes.
#[test]
fn what_the_program_tells_at_home_passes_no_lesson_of_a_class() {
    let measured = of_each(|lesson| {
        let mut shares = Vec::new();
        for k in 0..COPIERS {
            let own = own(lesson, k);
            let mut answers = reference_submission(&lesson.variant(&format!("student-{k}")).unwrap()).answers;
            answers.retain(|id, _| own.question(id).is_some());
            let verdict = grade(&own, &Submission { answers, ..Submission::default() }).unwrap();
            assert!(verdict.gradable, "{}", lesson.slug);
            shares.push((verdict.earned / verdict.possible, verdict.passed));
        }
        shares
    });
    for (slug, shares) in &measured {
        let mean = shares.iter().map(|(share, _)| share).sum::<f64>() / COPIERS as f64;
        println!("{slug:26} {:.0} % of the points", 100.0 * mean);
    }
    let always = measured.iter().filter(|(_, shares)| shares.iter().all(|(_, passed)| *passed)).count();
    let hands = measured.iter().flat_map(|(_, shares)| shares);
    let (all, lucky) = (hands.clone().count(), hands.filter(|(_, passed)| *passed).count());
    assert!(always == 0 && lucky as f64 <= LUCK * all as f64, "{lucky} of {all}: {measured:#?}");
}

/// What the check holds for the numbers of names, of a class with a secret. Work is not graded here, it counts as another's.
#[test]
fn what_others_have_found_passes_hardly_anybody() {
    let measured = of_each(|lesson| {
        let hands: Vec<Hand> = (0..CLASS).map(|k| Hand::of(own(lesson, k))).collect();
        copied::measured(&hands)
    });
    for (slug, Copied { earned, at_once, in_all }) in &measured {
        let [earned, at_once, in_all] = [earned, at_once, in_all].map(|share| 100.0 * share);
        println!("{slug:26} earns {earned:.0} %, passes {at_once:.1} % at once, {in_all:.1} % in all");
    }
    let (all, at_once) =
        (measured.len() as f64, measured.iter().map(|(_, copied)| copied.at_once).sum::<f64>());
    println!("on the average {:.2} % at once", 100.0 * at_once / all);
    for (slug, copied) in &measured {
        let bounds = [copied::MOST_EARNED, copied::LUCKY_AT_ONCE, copied::LUCKY_IN_ALL];
        let found = [copied.earned, copied.at_once, copied.in_all];
        assert!(found.iter().zip(bounds).all(|(found, bound)| *found <= bound), "{slug}: {copied:?}");
    }
}
