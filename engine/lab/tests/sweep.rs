//! Sweeps: the same for any number of threads, each run that of the changed scene alone, errors listed, cancelled runs
//! left out.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use serde_json::json;
use std::sync::atomic::{AtomicUsize, Ordering};
use triad_engine::run::{Outputs, Simulation};
use triad_lab::sweep::{Sweep, SweepPlan, Unwatched, Values, Variation, Watch, svg, sweep};
use triad_scene::{Scene, catalogue};

fn pendulum() -> Scene {
    let mut scene = catalogue::scene("simple-pendulum").unwrap().duration(0.7).tolerance(1e-6);
    scene.simulation.outputs = ["joints", "reactions", "energy"].map(|word| word.parse().unwrap()).to_vec();
    scene
}

fn plan(varied: &[(&str, Values)], samples: usize) -> SweepPlan {
    let scene = pendulum();
    let vary = |(name, values): &(&str, Values)| Variation::new(&scene, name, values.clone()).unwrap();
    SweepPlan {
        varied: varied.iter().map(vary).collect(),
        samples,
        seed: 11,
        ..SweepPlan::new(scene.clone())
    }
}

fn both() -> SweepPlan {
    let mass = Values::Normal { mean: 2.0, deviation: 0.3 };
    plan(&[("/bodies/0/mass", mass), ("/gravity/1", Values::Grid { from: -9.81, to: -1.62, count: 4 })], 9)
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let plan = both();
    let one = sweep(&plan, 1, &Unwatched).unwrap();
    assert_eq!(one.runs.len(), 36);
    for threads in [2, 7] {
        assert_eq!(sweep(&plan, threads, &Unwatched).unwrap(), one, "{threads} threads");
    }
}

#[test]
fn each_run_is_that_of_the_changed_scene() {
    let found = sweep(&both(), 2, &Unwatched).unwrap();
    for run in &found.runs {
        let [mass, gravity] = [json!(run.values[0]), json!(run.values[1])];
        let scene = pendulum().changed([], [("/bodies/0/mass", &mass), ("/gravity/1", &gravity)]).unwrap();
        let mut alone = Simulation::new(&scene).unwrap();
        alone.advance_to(0.7).unwrap();
        let mut outputs = Vec::new();
        Outputs::new(&alone).write(&alone, &mut outputs);
        assert_eq!(run.result.as_ref().unwrap().outputs, outputs);
    }
    let ends: Vec<f64> = found.runs.iter().map(|run| run.values[1]).collect();
    assert_eq!(
        (ends[0], ends[8], ends[35]),
        (-9.81, -9.81, -1.62),
        "both ends exactly, samples within a point"
    );
}

#[test]
fn drawn_numbers_have_their_distribution_and_their_seed() {
    let plan = plan(
        &[
            ("/bodies/0/mass", Values::Normal { mean: 5.0, deviation: 0.5 }),
            ("/gravity/1", Values::Uniform { from: -10.0, to: -8.0 }),
        ],
        20_000,
    );
    let moments = |place: usize| {
        let values: Vec<f64> = (0..plan.samples).map(|index| plan.values(index)[place]).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let square = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / values.len() as f64;
        (mean, square.sqrt())
    };
    // Four times the standard errors.
    let (mean, deviation) = moments(0);
    assert!((mean - 5.0).abs() < 0.015 && (deviation - 0.5).abs() < 0.01, "{mean} {deviation}");
    let (mean, deviation) = moments(1);
    assert!((mean + 9.0).abs() < 0.017 && (deviation - 1.0 / 3f64.sqrt()).abs() < 0.01, "{mean} {deviation}");
    let other = SweepPlan { seed: 12, ..plan.clone() };
    assert_ne!(other.values(0), plan.values(0));
    assert_ne!(plan.values(0), plan.values(1));
}

#[test]
fn a_run_that_cannot_be_is_listed_and_ends_nothing_else() {
    let masses = Values::Grid { from: -1.0, to: 1.0, count: 5 };
    let found = sweep(&plan(&[("/bodies/0/mass", masses)], 1), 2, &Unwatched).unwrap();
    let codes: Vec<&str> = found
        .runs
        .iter()
        .map(|run| run.result.as_ref().map_or_else(triad_engine::EngineError::code, |_| ""))
        .collect();
    assert_eq!(codes, ["mass-not-positive", "mass-not-positive", "mass-not-positive", "", ""]);
    let lost = Values::Grid { from: -2.0, to: -1.0, count: 3 };
    let found = sweep(&plan(&[("/bodies/0/mass", lost)], 1), 1, &Unwatched).unwrap();
    assert_eq!(svg(&found, 0), None, "a picture of nothing");
}

/// Sliders of the page bound runs: samples beyond their ranges were lost, and of places that they move together none could be varied alone.
#[test]
fn parameters_of_the_page_bind_no_run() {
    let ends = |name: &str, from: f64, to: f64| {
        let found = sweep(&plan(&[(name, Values::Grid { from, to, count: 2 })], 1), 1, &Unwatched).unwrap();
        found.runs.into_iter().map(|run| run.result.unwrap().outputs).collect::<Vec<_>>()
    };
    // What the run of the changed scene tells, which nobody is offered to change.
    let alone = |places: &[(&str, f64)]| {
        let values: Vec<_> = places.iter().map(|(place, number)| (*place, json!(number))).collect();
        let mut scene = pendulum();
        scene.parameters.clear();
        let scene = scene.changed([], values.iter().map(|(place, number)| (*place, number))).unwrap();
        let mut run = Simulation::new(&scene).unwrap();
        run.advance_to(0.7).unwrap();
        let mut outputs = Vec::new();
        Outputs::new(&run).write(&run, &mut outputs);
        outputs
    };
    let scene = pendulum();
    let of = |name: &str| scene.parameter(name).unwrap();
    assert_eq!((of("mass").low, of("mass").high), (0.1, 10.0));
    // A name and a pointer go beyond the range.
    for name in ["mass", "/bodies/0/mass"] {
        assert_eq!(
            ends(name, 0.05, 1000.0),
            [0.05, 1000.0].map(|mass| alone(&[("/bodies/0/mass", mass)])),
            "{name}"
        );
    }
    // All places of a parameter follow its name, a pointer changes its place alone.
    let places = of("length").places();
    assert!(places.len() > 1, "the built-in scene moves several numbers together");
    let together = |value: f64| {
        alone(&places.iter().map(|place| (place.pointer(), value * place.factor())).collect::<Vec<_>>())
    };
    assert_eq!(ends("length", 0.5, 40.0), [0.5, 40.0].map(together));
    let one = places[0].pointer();
    assert_eq!(ends(one, -1.5, -0.5), [-1.5, -0.5].map(|x| alone(&[(one, x)])));
    // They are no part of what is run.
    let low = Values::Grid { from: 1.0, to: 2.0, count: 2 };
    assert!(Variation::new(&scene, "/parameters/0/low", low).is_err());
}

/// Cancels after some runs.
struct Impatient(AtomicUsize);

impl Watch for Impatient {
    fn done(&self) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }

    fn cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed) >= 5
    }
}

#[test]
fn what_was_done_before_it_is_cancelled_is_kept() {
    let whole = sweep(&both(), 1, &Unwatched).unwrap();
    let part = sweep(&both(), 2, &Impatient(AtomicUsize::new(0))).unwrap();
    assert!((5..20).contains(&part.runs.len()), "{}", part.runs.len());
    for run in &part.runs {
        assert_eq!(*run, whole.runs[run.index]);
    }
}

#[test]
fn a_picture_has_a_mark_for_each_run() {
    let found: Sweep = sweep(&both(), 0, &Unwatched).unwrap();
    let picture = svg(&found, 1).unwrap();
    assert_eq!(picture.matches("<circle").count(), 36);
    assert!(picture.contains("pin.angle_rate, rad/s") && !picture.contains("NaN"), "{picture}");
}

#[test]
fn a_plan_whose_runs_would_not_differ_is_refused() {
    let mass = || Values::Grid { from: 1.0, to: 2.0, count: 3 };
    let twice = plan(&[("/bodies/0/mass", mass()), ("mass", mass())], 1).count().unwrap_err();
    assert_eq!(twice.to_string(), "/bodies/0/mass is varied twice, by /bodies/0/mass and by mass");
    let undrawn = plan(&[("/bodies/0/mass", mass())], 5).count().unwrap_err();
    assert!(undrawn.to_string().contains("5 samples of each point would be the same run"), "{undrawn}");
    assert_eq!(plan(&[("/bodies/0/mass", mass())], 1).count(), Ok(3));
}

/// The labels of the vertical axis of a picture, from below.
fn labels(picture: &str) -> Vec<String> {
    let texts = picture.lines().filter(|line| line.contains("text-anchor=\"end\""));
    texts
        .map(|line| line.split("currentColor\">").nth(1).unwrap().split('<').next().unwrap().to_owned())
        .collect()
}

/// Values that differ by rounding alone, or lie far from zero, once took all memory; small ones were all labelled 0.
#[test]
fn a_picture_is_drawn_of_any_values_and_its_labels_are_the_values_there() {
    let found =
        sweep(&plan(&[("/gravity/1", Values::Grid { from: -9.0, to: -1.0, count: 2 })], 1), 1, &Unwatched);
    let of = |values: [f64; 2]| {
        let mut found = found.clone().unwrap();
        for (run, value) in found.runs.iter_mut().zip(values) {
            run.result.as_mut().unwrap().outputs[0] = value;
        }
        svg(&found, 0).unwrap()
    };
    for values in [
        [1.0, 1.0 + f64::EPSILON],
        [1e17, 1e17],
        [-3e25, 3e25],
        [0.25, 0.25],
        [0.0, 0.0],
        [3e-14, 9e-13],
        [2e-7, 5e-6],
    ] {
        let picture = of(values);
        let labels = labels(&picture);
        assert!((4..=14).contains(&labels.len()), "{values:?}: {labels:?}");
        let numbers: Vec<f64> = labels.iter().map(|label| label.parse().unwrap()).collect();
        assert!(numbers.windows(2).all(|pair| pair[0] < pair[1]), "{values:?}: {labels:?}");
        // Between the first and the last line a mark stands where its value belongs.
        let (low, high) = (numbers[0], numbers[numbers.len() - 1]);
        let marks = picture
            .lines()
            .filter_map(|line| line.split("cy=\"").nth(1)?.split('"').next()?.parse::<f64>().ok());
        let marks: Vec<f64> = marks.collect();
        for (mark, value) in marks.iter().zip(values) {
            let part = (value - low) / (high - low);
            assert!((354.0 - part * 320.0 - mark).abs() < 0.06, "{values:?}: {mark}, {labels:?}");
        }
    }
}

#[test]
fn the_columns_are_known_before_anything_runs() {
    let plan = both();
    assert_eq!(plan.columns().unwrap(), sweep(&plan, 1, &Unwatched).unwrap().columns);
}
