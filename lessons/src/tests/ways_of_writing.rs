//! Right answers as people write them: `tests/data/ways-of-writing.toml`. None may be marked wrong, and nearly all are read.

use std::collections::BTreeMap;

use serde::Deserialize;
use triad_engine::scene::expression::Expression;

use crate::answers::tolerance::{Tolerance, ValueShape};
use crate::answers::units::Unit;
use crate::answers::{Answer, TypedValue};
use crate::exercise::derivation::Derivation;
use crate::exercise::{ChoiceOption, Formula, QuantityQuestion};
use crate::grading::{closed, formula, quantity};
use crate::verdict::Mark;
use crate::verdict::feedback::Judgement;

/// Share of all ways that must be accepted.
const ACCEPTED: f64 = 0.97;

#[derive(Deserialize)]
struct Corpus {
    number: Vec<Quantity<f64>>,
    vector: Vec<Quantity<Vec<f64>>>,
    matrix: Vec<Quantity<Vec<Vec<f64>>>>,
    formula: Vec<Formulas>,
    choice: Vec<Choices>,
}

type Ways = BTreeMap<String, Vec<String>>;

#[derive(Deserialize)]
struct Quantity<T> {
    value: T,
    unit: String,
    asks_unit: bool,
    relative: f64,
    ways: Ways,
}

#[derive(Deserialize)]
struct Formulas {
    reference: String,
    symbols: Vec<String>,
    ways: Ways,
}

#[derive(Deserialize)]
struct Choices {
    options: Vec<String>,
    right: String,
    ways: Ways,
}

/// What became of the ways of one cause.
#[derive(Default)]
struct Count {
    accepted: usize,
    returned: Vec<String>,
    wrong: Vec<String>,
}

impl Count {
    fn add(&mut self, text: &str, judged: Result<Judgement, String>) {
        match judged {
            Ok(judgement) if judgement.mark == Mark::Right => self.accepted += 1,
            Ok(_) => self.wrong.push(text.to_owned()),
            Err(reason) => self.returned.push(format!("{text:?}: {reason}")),
        }
    }
}

fn question(
    shape: ValueShape,
    size: [usize; 2],
    reference: Vec<f64>,
    of: (&str, bool, f64),
) -> QuantityQuestion {
    let (unit, asks_unit, relative) = of;
    QuantityQuestion {
        shape,
        size,
        unit: Unit::parse(unit).unwrap(),
        asks_unit,
        frame: None,
        tolerance: Tolerance { absolute: 0.0, relative },
        reference,
        error: 0.0,
        misconceptions: Vec::new(),
        derivation: Derivation::default(),
        follows: None,
    }
}

fn typed(text: &str) -> Answer {
    Answer { value: Some(TypedValue::Text(text.to_owned())), ..Answer::default() }
}

fn judge_all() -> BTreeMap<String, Count> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/ways-of-writing.toml");
    let corpus: Corpus = toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let mut counts: BTreeMap<String, Count> = BTreeMap::new();
    let mut add = |kind: &str, ways: &Ways, judge: &dyn Fn(&str) -> Result<Judgement, String>| {
        for (cause, texts) in ways {
            let count = counts.entry(format!("{kind}, {cause}")).or_default();
            for text in texts {
                count.add(text, judge(text));
            }
        }
    };
    let quantity = |question: QuantityQuestion| {
        move |text: &str| quantity::judge(&question, "", &typed(text), false).map_err(|e| e.to_string())
    };
    for of in &corpus.number {
        let asked = (of.unit.as_str(), of.asks_unit, of.relative);
        add("number", &of.ways, &quantity(question(ValueShape::Number, [1, 1], vec![of.value], asked)));
    }
    for of in &corpus.vector {
        let asked = (of.unit.as_str(), of.asks_unit, of.relative);
        let size = [of.value.len(), 1];
        add("vector", &of.ways, &quantity(question(ValueShape::Vector, size, of.value.clone(), asked)));
    }
    for of in &corpus.matrix {
        let asked = (of.unit.as_str(), of.asks_unit, of.relative);
        let size = [of.value.len(), of.value[0].len()];
        add("matrix", &of.ways, &quantity(question(ValueShape::Matrix, size, of.value.concat(), asked)));
    }
    for of in &corpus.formula {
        let names: Vec<&str> = of.symbols.iter().map(String::as_str).collect();
        let asked = Formula {
            symbols: of.symbols.clone(),
            ranges: vec![[0.5, 1.5]; names.len()],
            reference: Expression::parse(&of.reference, &names).unwrap(),
            reference_text: of.reference.clone(),
            misconceptions: Vec::new(),
        };
        add("formula", &of.ways, &|text| {
            formula::judge(&asked, "seed", "", &typed(text)).map_err(|e| e.to_string())
        });
    }
    for of in &corpus.choice {
        let option =
            |id: &String| ChoiceOption { id: id.clone(), text: String::new(), reason: String::new() };
        let options: Vec<ChoiceOption> = of.options.iter().map(option).collect();
        add("choice", &of.ways, &|text| {
            let chosen = Answer { choice: Some(text.to_owned()), ..Answer::default() };
            closed::choice(&options, &of.right, &chosen).map_err(|e| e.to_string())
        });
    }
    counts
}

#[test]
fn right_answers_are_read_however_they_are_written() {
    let counts = judge_all();
    let (mut accepted, mut all) = (0u32, 0u32);
    println!("{:<42} accepted  sent back  wrong", "kind, cause");
    for (cause, count) in &counts {
        println!("{cause:<42} {:>8}  {:>9}  {:>5}", count.accepted, count.returned.len(), count.wrong.len());
        count.returned.iter().for_each(|text| println!("    sent back {text}"));
        count.wrong.iter().for_each(|text| println!("    WRONG {text:?}"));
        accepted += u32::try_from(count.accepted).unwrap();
        all += u32::try_from(count.accepted + count.returned.len() + count.wrong.len()).unwrap();
    }
    let share = f64::from(accepted) / f64::from(all);
    println!("{accepted} of {all} accepted: {:.1} %", 100.0 * share);
    assert!(all >= 600, "{all} ways");
    assert!(counts.values().all(|count| count.wrong.is_empty()), "right answers are marked wrong");
    assert!(share >= ACCEPTED, "{share}");
}
