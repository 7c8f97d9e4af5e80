//! Wrong answers as people give them: nearly all get words of their own, none is sent back for its digits.

use std::collections::BTreeMap;

use crate::answers::tolerance::norm;
use crate::answers::{Answer, TypedValue};
use crate::exercise::{QuantityQuestion, Question, QuestionBody, numbers};
use crate::grading::{formula, quantity};
use crate::lesson::Lesson;
use crate::mistakes::ALL;
use crate::random::SeededRandom;
use crate::verdict::Mark;
use crate::verdict::feedback::Judgement;

use super::course;

/// Share of all mistakes that must get words of their own.
const RECOGNISED: f64 = 0.95;
/// The same of those that were written by hand.
const WRITTEN: f64 = 0.93;
/// Share of random numbers that may be taken for a mistake.
const MISTAKEN: f64 = 0.2;
/// Students whose draws no mistake may fit.
const STUDENTS: usize = 40;
/// Random numbers for each question.
const DRAWS: usize = 200;

/// Share of the mistakes with a known slip that may get words of another one: one student in twenty who hears something looks in
/// the wrong place first. Set after measuring, 112 of 2361, which are listed. Most of them are a missing factor or term that another slip
/// leads to, too, with the numbers of the text; no words can tell these apart.
const MISDIRECTED: f64 = 0.05;

/// What may be said of a slip by what a question knows by itself: words that are true of it. What an author writes about a value
/// is meant for this value, and is true of it by that.
const TRUE_OF: &[(&[&str], &[&str])] = &[
    (
        &["sign", "one sign"],
        &[
            "opposite-sign",
            "component-sign",
            "entry-sign",
            "term-sign",
            "gravity-up",
            "other-side",
            "one-component",
        ],
    ),
    (
        &["factor", "twice", "half"],
        &[
            "factor-two",
            "part-factor-two",
            "factor-pi",
            "factor-root-two",
            "factor-small",
            "factor-missing",
            "given-factor",
            "constant-factor",
            "length",
            "moment-of-inertia",
            "count",
            "power-of-ten",
            "angle-unit",
            "period",
            "missing-symbol",
        ],
    ),
    (&["thousand", "thousandth", "unit"], &["power-of-ten"]),
    (&["one left out"], &["component-missing", "zero", "one-component"]),
    (&["exchanged", "swapped"], &["component-order", "entry-order", "other-number", "transposed"]),
    (&["zero"], &["zero", "count"]),
    (&["one more", "one less", "off-by-one"], &["off-by-one", "other-count", "count", "zero"]),
    (&["sine-cosine"], &["sine-cosine"]),
    (&["degrees"], &["angle-unit"]),
    (&["gravity"], &["other-gravity", "mass-and-weight", "no-gravity", "factor-missing", "nearly"]),
    (
        &["power"],
        &[
            "power",
            "symbol-power",
            "factor-missing",
            "given-factor",
            "missing-symbol",
            "function-missing",
            "part-result",
        ],
    ),
    (&["reciprocal", "upside-down"], &["upside-down", "symbol-power", "period"]),
    (
        &["term-missing"],
        &[
            "term-missing",
            "component-missing",
            "symbols-missing",
            "missing-symbol",
            "function-missing",
            "factor-missing",
            "part-result",
            "no-gravity",
            "at-rest",
            "one-component",
            "mass-and-weight",
            "count",
            "zero",
            "moment-of-inertia",
            "given-number",
            "given-factor",
        ],
    ),
    (
        &["wrong-inertia"],
        &[
            "moment-of-inertia",
            "factor-two",
            "factor-small",
            "factor-missing",
            "given-number",
            "other-number",
        ],
    ),
    (
        &["count", "counted-twice"],
        &["count", "off-by-one", "other-count", "term-missing", "term-sign", "zero", "opposite-sign"],
    ),
];

/// Values by lesson, question and cause.
type Corpus = BTreeMap<String, BTreeMap<String, BTreeMap<String, Vec<TypedValue>>>>;

/// What became of the mistakes of one cause.
#[derive(Default)]
struct Count {
    all: usize,
    recognised: usize,
    unknown: Vec<String>,
    returned: Vec<String>,
    right: Vec<String>,
    codes: BTreeMap<String, usize>,
    /// What was recognised, by its code.
    told: Vec<(String, String)>,
}

impl Count {
    fn add(&mut self, what: String, judged: Result<Judgement, String>) {
        match judged {
            Err(reason) => self.returned.push(format!("{what}: {reason}")),
            Ok(judgement) if judgement.mark == Mark::Right => self.right.push(what),
            Ok(judgement) => {
                self.all += 1;
                match judgement.misconception {
                    Some(code) => {
                        self.recognised += 1;
                        *self.codes.entry(code.clone()).or_default() += 1;
                        self.told.push((what, code));
                    }
                    None => self.unknown.push(what),
                }
            }
        }
    }
}

/// A value as a student writes it: four digits, or as many as are asked for; a whole number whole.
fn typed(question: &QuantityQuestion, value: f64) -> String {
    let digits = question.tolerance.digits().unwrap_or(4).max(4) as usize;
    if value == value.round() && value.abs() < 1e7 {
        value.to_string()
    } else {
        format!("{value:.*e}", digits - 1)
    }
}

fn answer(question: &QuantityQuestion, values: &[f64]) -> Answer {
    let cells: Vec<TypedValue> = values.iter().map(|x| TypedValue::Text(typed(question, *x))).collect();
    let value = match question.size {
        [1, 1] => cells[0].clone(),
        [_, 1] => TypedValue::List(cells),
        [_, columns] => {
            TypedValue::List(cells.chunks(columns).map(|row| TypedValue::List(row.to_vec())).collect())
        }
    };
    Answer { value: Some(value), unit: Some(question.unit.text().to_owned()), ..Answer::default() }
}

fn judge_values(question: &QuantityQuestion, values: &[f64]) -> Result<Judgement, String> {
    quantity::judge(question, "", &answer(question, values), false).map_err(|e| e.to_string())
}

fn judge(lesson: &Lesson, question: &Question, value: &TypedValue) -> Result<Judgement, String> {
    match &question.body {
        QuestionBody::Formula(body) => {
            let answer = Answer { value: Some(value.clone()), ..Answer::default() };
            formula::judge(body, &question.id, "", &answer).map_err(|e| e.to_string())
        }
        QuestionBody::Quantity(body) => {
            let values = numbers(&as_rows(value), body.shape, &lesson.parameters);
            let values = values.unwrap_or_else(|_| panic!("{} cannot be evaluated", question.id));
            judge_values(body, &values.values)
        }
        _ => Err("no typed answer".to_owned()),
    }
}

/// Rows that are written as texts with blanks, as lists.
fn as_rows(value: &TypedValue) -> TypedValue {
    let row = |row: &TypedValue| match row {
        TypedValue::Text(text)
            if text.trim().contains(' ') && text.split(' ').all(|x| x.parse::<f64>().is_ok()) =>
        {
            TypedValue::List(text.split(' ').map(|x| TypedValue::Text(x.to_owned())).collect())
        }
        other => other.clone(),
    };
    match value {
        TypedValue::List(rows) => TypedValue::List(rows.iter().map(row).collect()),
        other => other.clone(),
    }
}

/// What any question invites: signs, factors, powers of ten, components left out or exchanged.
fn mechanical(question: &QuantityQuestion) -> Vec<(&'static str, Vec<f64>)> {
    let right = &question.reference;
    let scaled = |k: f64| right.iter().map(|x| k * x).collect::<Vec<f64>>();
    let mut list = vec![("sign", scaled(-1.0)), ("twice", scaled(2.0)), ("zero", scaled(0.0))];
    if question.tolerance.is_exact() {
        list.extend([("one more", vec![right[0] + 1.0]), ("one less", vec![right[0] - 1.0])]);
        return list;
    }
    list.extend([("half", scaled(0.5)), ("thousand", scaled(1e3)), ("thousandth", scaled(1e-3))]);
    for k in (0..right.len()).filter(|_| right.len() > 1) {
        let with = |x: f64| {
            let mut other = right.clone();
            other[k] = x;
            other
        };
        list.extend([("one sign", with(-right[k])), ("one left out", with(0.0))]);
        let mut exchanged = right.clone();
        exchanged.swap(k, (k + 1) % right.len());
        list.push(("exchanged", exchanged));
    }
    list
}

fn report(name: &str, counts: &BTreeMap<String, Count>) -> f64 {
    let (mut all, mut recognised) = (0, 0);
    println!("{name}");
    for (cause, count) in counts {
        println!("  {cause}: {} of {} {:?}", count.recognised, count.all, count.codes);
        count.unknown.iter().for_each(|what| println!("      not recognised: {what}"));
        count.right.iter().for_each(|what| println!("      right: {what}"));
        count.returned.iter().for_each(|what| println!("      sent back: {what}"));
        (all, recognised) = (all + count.all, recognised + count.recognised);
    }
    println!("  all: {recognised} of {all}");
    recognised as f64 / f64::from(u32::try_from(all).unwrap())
}

fn corpus() -> Corpus {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/typical-mistakes.toml");
    toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// A mistake that happens to give the right number would be paid: no draw may be so kind (a missing square at 1 m/s).
#[test]
fn a_typical_mistake_is_right_for_nobody() {
    let course = course();
    let mut right = Vec::new();
    for (slug, questions) in &corpus() {
        let lesson = course.lesson(slug).unwrap();
        let own: Vec<Lesson> =
            (0..STUDENTS).map(|k| lesson.variant_in(&format!("student-{k}"), "secret").unwrap()).collect();
        let written = questions.iter().flat_map(|(id, causes)| {
            // A rounded constant is no slip where it changes less than the tolerance.
            let slips = causes.iter().filter(|(cause, _)| *cause != "gravity");
            slips.flat_map(move |(_, values)| values.iter().map(move |value| (id, value)))
        });
        for (id, value) in written {
            let of = |lesson: &Lesson| {
                let QuestionBody::Quantity(body) = &lesson.question(id)?.body else { return None };
                let values = numbers(&as_rows(value), body.shape, &lesson.parameters).ok()?.values;
                Some((body.tolerance.accepts(&values, &body.reference), values))
            };
            let all: Vec<_> = own.iter().filter_map(of).collect();
            // A number without parameters is a mistake for one draw only.
            let varies = all.iter().any(|(_, values)| *values != all[0].1);
            let lucky = all.iter().filter(|(accepted, _)| *accepted).count();
            if varies && lucky > 0 {
                let what = serde_json::to_string(value).unwrap();
                right.push(format!("{slug}.{id} {what}: {lucky} of {}", all.len()));
            }
        }
    }
    assert!(right.is_empty(), "{}", right.join("\n"));
}

#[test]
fn typical_mistakes_get_words_of_their_own() {
    let corpus = corpus();
    let course = course();
    let (mut written, mut made) = (BTreeMap::<String, Count>::new(), BTreeMap::<String, Count>::new());
    for (slug, questions) in &corpus {
        let lesson = course.lesson(slug).unwrap();
        for (id, causes) in questions {
            let question = lesson.question(id).unwrap_or_else(|| panic!("{slug} has no question {id}"));
            for (cause, values) in causes {
                for value in values {
                    let what = format!("{slug}.{id} {}", serde_json::to_string(value).unwrap());
                    written.entry(cause.clone()).or_default().add(what, judge(lesson, question, value));
                }
            }
        }
    }
    for lesson in course.lessons() {
        for question in &lesson.exercise.questions {
            let QuestionBody::Quantity(body) = &question.body else { continue };
            let typical = mechanical(body)
                .into_iter()
                .filter(|(_, values)| !body.tolerance.accepts(values, &body.reference));
            for (cause, values) in typical {
                let what = format!("{}.{} {values:?}", lesson.slug, question.id);
                made.entry(cause.to_owned()).or_default().add(what, judge_values(body, &values));
            }
        }
    }
    let shares = [report("written", &written), report("made", &made)];
    let (known, astray) = misdirected(written.iter().chain(&made));
    println!("{} of {known} are led astray:\n{}", astray.len(), astray.join("\n"));
    assert!(
        known >= 2000 && astray.len() as f64 <= MISDIRECTED * known as f64,
        "{} of {known}",
        astray.len()
    );
    let all = || written.values().chain(made.values());
    assert!(all().map(|count| count.all).sum::<usize>() >= 800);
    for count in all() {
        assert!(count.right.is_empty(), "not wrong: {:?}", count.right);
        // What is sent back is near enough to be a rounded right answer; what is far off never is.
        assert!(count.returned.iter().all(|what| what.contains("digits")), "sent back: {:?}", count.returned);
    }
    assert!(all().map(|count| count.returned.len()).sum::<usize>() <= 15);
    let of = |count: fn(&Count) -> usize| all().map(count).sum::<usize>() as f64;
    let share = of(|count| count.recognised) / of(|count| count.all);
    assert!(share >= RECOGNISED && shares[0] >= WRITTEN, "{share} {shares:?}");
}

/// Mistakes whose slip is known, and those among them that get words of another one.
fn misdirected<'a>(causes: impl Iterator<Item = (&'a String, &'a Count)>) -> (usize, Vec<String>) {
    let generic = |code: &str| ALL.iter().any(|m| m.code == code);
    let (mut all, mut led_astray) = (0, Vec::new());
    for (cause, count) in causes {
        let Some((_, fit)) = TRUE_OF.iter().find(|(causes, _)| causes.contains(&cause.as_str())) else {
            continue;
        };
        all += count.told.len();
        let astray = count.told.iter().filter(|(_, code)| generic(code) && !fit.contains(&code.as_str()));
        led_astray.extend(astray.map(|(what, code)| format!("{cause}: {what} is told {code}")));
    }
    (all, led_astray)
}

/// Small whole numbers meet by chance: a wrong count is not told of squares, halves or angles.
#[test]
fn a_wrong_count_gets_the_words_of_counts() {
    let counting =
        ["zero", "off-by-one", "count", "term-missing", "term-sign", "opposite-sign", "power-of-ten"];
    let mut strange = Vec::new();
    for lesson in course().lessons() {
        for question in &lesson.exercise.questions {
            let QuestionBody::Quantity(body) = &question.body else { continue };
            if !body.tolerance.is_exact() || question.id == "halving" {
                continue;
            }
            let own = |code: &str| body.misconceptions.iter().any(|m| m.id == code);
            for value in (0..40).map(f64::from) {
                let judged = judge_values(body, &[value]).unwrap();
                let code = judged.misconception.unwrap_or_default();
                let known = own(&code) || code == "other-count" || counting.contains(&&*code);
                if judged.mark == Mark::Wrong && !known {
                    strange.push(format!("{}.{} {value}: {code}", lesson.slug, question.id));
                }
            }
        }
    }
    assert!(strange.is_empty(), "{}", strange.join("\n"));
}

/// What somebody just guesses is not explained by a mistake that nobody made, as a rule.
#[test]
fn random_numbers_are_seldom_taken_for_a_mistake() {
    let (mut all, mut taken) = (0, 0);
    let mut codes: BTreeMap<String, usize> = BTreeMap::new();
    for lesson in course().lessons() {
        for question in &lesson.exercise.questions {
            let QuestionBody::Quantity(body) = &question.body else { continue };
            if body.size != [1, 1] || body.tolerance.is_exact() {
                continue;
            }
            let mut random = SeededRandom::new(&question.id);
            for _ in 0..DRAWS {
                let value = norm(&body.reference) * libm::exp(2.0 * (random.unit() - 0.5) * libm::log(4.0));
                let Ok(judgement) = judge_values(body, &[value]) else { continue };
                if judgement.mark == Mark::Wrong {
                    all += 1;
                    taken += usize::from(judgement.misconception.is_some());
                    *codes.entry(judgement.misconception.unwrap_or_default()).or_default() += 1;
                }
            }
        }
    }
    println!("{taken} of {all} random numbers: {codes:?}");
    assert!((taken as f64) < MISTAKEN * f64::from(all), "{taken} of {all}");
}
