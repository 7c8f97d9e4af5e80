//! Events and passages of singular configurations, as a run tells them.

use super::*;
use triad_engine::run::SingularConfiguration;

/// A pendulum that tells its lowest position and ends at an angle.
fn told_of_events() -> serde_json::Value {
    let mut scene =
        serde_json::to_value(catalogue::scene("simple-pendulum").expect("a scene")).expect("JSON");
    let event = |name: &str, value: f64, stop: bool| serde_json::json!({ "name": name, "of": { "type": "angle", "joint": "pin" }, "value": value, "stop": stop });
    scene["events"] =
        serde_json::json!([event("lowest", std::f64::consts::FRAC_PI_2, false), event("halt", 2.5, true)]);
    scene
}

fn names(state: &SessionState) -> Vec<&str> {
    state.happened.events.iter().map(|event| event.name.as_str()).collect()
}

#[test]
fn events_are_told_as_they_happen_go_on_with_other_numbers_and_end_with_a_reset() {
    let mut run = of_text(&told_of_events());
    assert_eq!(told(&run).happened, Happened::default());
    while run.advance(0.59).expect("runs") {}
    assert_eq!(names(&told(&run)), Vec::<&str>::new(), "not before their time");
    while run.advance(0.7).expect("runs") {}
    let state = told(&run);
    assert_eq!(names(&state), ["lowest"]);
    let lowest = state.happened.events[0].clone();
    assert!((lowest.time - 0.591_960).abs() < 1e-6 && !lowest.stop, "{lowest:?}");
    assert!(lowest.error.is_some_and(|error| error < 1e-4), "{lowest:?}");
    // The earlier ones stay, as they were; of what comes then the error is not known.
    change(&mut run, serde_json::json!({ "places": { "/gravity/1": -12.0 }, "then": "continue" }))
        .expect("goes on");
    assert_eq!(told(&run).happened.events, std::slice::from_ref(&lowest));
    let mut again = taken_up(&run);
    while run.advance(5.0).expect("runs") {}
    let end = told(&run);
    assert_eq!((names(&end), end.finished), (vec!["lowest", "halt"], true));
    let halt = &end.happened.events[1];
    assert!(halt.stop && halt.error.is_none() && halt.time == end.time, "{halt:?}");
    assert_eq!(end.happened.events[0], lowest);
    // A restart of the server forgets none.
    while again.advance(5.0).expect("runs") {}
    assert_eq!(names(&told(&again)), ["lowest", "halt"]);
    run.reset();
    assert_eq!(told(&run).happened, Happened::default());
    while run.advance(0.7).expect("runs") {}
    assert_eq!(names(&told(&run)), ["lowest"]);
    change(&mut run, serde_json::json!({ "places": { "/gravity/1": -9.0 }, "then": "restart" }))
        .expect("starts over");
    assert_eq!(told(&run).happened, Happened::default());
}

#[test]
fn passages_are_those_of_the_run_and_none_is_ahead_of_it() {
    let scene = catalogue::scene("n-four-bar:2").expect("a scene");
    let mut alone = Simulation::new(&scene).expect("stands");
    alone.advance_to(2.0).expect("runs");
    let passed = alone.summary().singularities;
    assert!(passed.len() > 1, "{passed:?}");
    let source = SceneSource::Builtin("n-four-bar:2".into());
    let mut run = Run::start("one".into(), scene, &SceneChange::default(), source, 1 << 20).expect("runs");
    let mut seen = 0;
    while run.time() < 2.0 {
        run.advance(2.0).expect("runs");
        let state = told(&run);
        seen = seen.max(state.happened.passages.len());
        assert!(state.happened.passages.iter().all(|passage| passage.time <= state.time));
    }
    let state = told(&run);
    assert_eq!((state.happened.passages.len(), state.happened.earlier_passages), (seen, 0));
    let close = |(a, b): (&SingularConfiguration, &SingularConfiguration)| {
        (a.time - b.time).abs() < 1e-6 && a.joints == b.joints
    };
    let until: Vec<_> = passed.iter().filter(|passage| passage.time <= 2.0).collect();
    assert_eq!(until.len(), seen);
    assert!(state.happened.passages.iter().zip(until).all(close), "{passed:?}");
    run.reset();
    assert_eq!(told(&run).happened, Happened::default());
}
