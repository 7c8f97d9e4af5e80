//! The numbers that students get, as they were recorded.

use super::course;

/// Recorded once: after a release a change would give every student other numbers, and last year's grades other questions.
#[test]
fn variants_never_change() {
    let numbers = |slug: &str, seed: &str| {
        let lesson = course().lesson(slug).unwrap().variant(seed).unwrap();
        lesson.parameters.iter().map(|(name, x)| format!("{name}={x}")).collect::<Vec<_>>().join(" ")
    };
    let of_now: Vec<_> = GOLDEN.iter().map(|(slug, seed, _)| (*slug, *seed, numbers(slug, seed))).collect();
    let recorded: Vec<_> =
        GOLDEN.iter().map(|(slug, seed, golden)| (*slug, *seed, (*golden).to_owned())).collect();
    assert!(of_now == recorded, "{of_now:#?}");
    let states =
        course().lesson("jacobian").unwrap().variant("ada").unwrap().instances("program").unwrap().unwrap();
    assert_eq!((states.seed.as_str(), states.rows.len(), states.columns.len()), ("ada", 21, 24));
    assert_eq!(states.states[0].q[..4], GOLDEN_STATE, "the first numbers of the first state");
}

/// Lesson, seed and its numbers.
const GOLDEN: &[(&str, &str, &str)] = &[
    ("spherical-joint", "ada", "m=3.5 phi=68.5"),
    ("spherical-joint", "emmy", "m=3 phi=51.5"),
    ("inverse-dynamics", "ada", "m=3.1"),
    ("inverse-dynamics", "emmy", "m=6.2"),
    ("equations-of-motion", "ada", "d=1.13 m=1.15"),
    ("equations-of-motion", "emmy", "d=0.65 m=4.35"),
    ("joint-reactions", "ada", "m=1.25 v=5"),
    ("joint-reactions", "emmy", "m=2.75 v=4.2"),
    ("generic-rigid-body", "ada", "a=2 b=1.5 c=3.25"),
    ("generic-rigid-body", "emmy", "a=1 b=1.5 c=3"),
    ("points-and-vectors", "ada", "s=2.45 x=0.5"),
    ("points-and-vectors", "emmy", "s=2.05 x=1.1"),
    ("reduced-body", "ada", "a=1.75 b=2.35 c=2.25"),
    ("reduced-body", "emmy", "a=1 b=2.6 c=2.25"),
    ("composing-joints", "ada", "n=10.62 p=0.8 r=0.56"),
    ("composing-joints", "emmy", "n=16 p=0.76 r=0.44"),
    ("mass-matrix", "ada", "s=3.8 t=2.4 u=1.25 w=0.085"),
    ("mass-matrix", "emmy", "s=3.6 t=3 u=3.25 w=0.08"),
    ("forces-and-moments", "ada", "f=16.25 q=7.3"),
    ("forces-and-moments", "emmy", "f=11.95 q=5.4"),
    ("singular-positions", "ada", "w=2.316"),
    ("singular-positions", "emmy", "w=0.808"),
    ("redundant-constraints", "ada", "h=1.7 m=16.5"),
    ("redundant-constraints", "emmy", "h=1.1 m=27.5"),
    ("screw", "ada", "m=2.65 p=0.45"),
    ("screw", "emmy", "m=3.1 p=0.405"),
];
/// The first coordinates of the first state that a seed gets.
const GOLDEN_STATE: [f64; 4] = [0.968, -0.938, 0.385, -0.472];
