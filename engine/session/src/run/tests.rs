use super::*;
use triad_engine::catalogue;

mod happened;

fn pendulum() -> Run {
    let scene = catalogue::scene("simple-pendulum").expect("a scene");
    let source = SceneSource::Builtin("simple-pendulum".into());
    Run::start("one".into(), scene, &SceneChange::default(), source, 1 << 20).expect("runs")
}

/// Goes to where the run should be at `now`.
fn tick(run: &mut Run, now: f64) {
    let Some(target) = run.due(now) else { return };
    let mut reached = Ok(true);
    while let Ok(true) = reached {
        reached = run.advance(target);
    }
    run.played(target, now, reached.map(drop));
}

#[test]
fn a_playing_run_follows_its_owners_clock_at_any_ticks() {
    let (mut one, mut other) = (pendulum(), pendulum());
    one.play(1.0, 10.0);
    other.play(1.0, 3.0);
    for k in 1..=40 {
        tick(&mut one, 10.0 + 0.033 * f64::from(k));
    }
    tick(&mut other, 3.0 + 0.033 * 40.0);
    assert_eq!(one.time(), other.time());
    assert!((one.time() - 1.32).abs() < 0.011, "{}", one.time());
    let [one, other] = [one, other].map(|run| run.state(Streamed::default(), String::new));
    assert_eq!((one.q, one.q_dot, one.frames), (other.q, other.q_dot, other.frames));
}

#[test]
fn a_run_that_cannot_keep_up_plays_slower_and_not_in_leaps() {
    let mut run = pendulum();
    run.play(1.0, 0.0);
    let target = run.due(1.0).expect("it plays");
    run.advance(target).expect("runs");
    run.played(target, 1.0, Ok(()));
    let reached = run.time();
    assert!(reached < 0.5);
    let next = run.due(1.1).expect("it plays");
    assert!((next - reached).abs() <= 0.1, "{next} {reached}");
}

#[test]
fn a_run_that_stopped_says_why_and_starts_over() {
    let mut run = pendulum();
    run.play(1.0, 0.0);
    run.stop(Refusal::new(StatusCode::UNPROCESSABLE_ENTITY, "x", "why", "h"));
    assert!(!run.playing());
    let state = run.state(Streamed::default(), || "t".into());
    assert_eq!(state.error.map(|error| (error.code, error.trace_id)), Some(("x".into(), "t".into())));
    assert_eq!(run.ready().map_err(|refusal| refusal.code()), Err("session-stopped"));
    assert_eq!(run.drag(None, 0.0).map_err(|refusal| refusal.code()), Err("session-stopped"));
    run.reset();
    assert_eq!(run.ready(), Ok(()));
}

#[test]
fn a_time_that_the_run_has_not_reached_has_no_answer_and_each_answer_tells_its_time() {
    let mut run = pendulum();
    while let Ok(true) = run.advance(0.5) {}
    let now = run.time();
    for time in [now + 0.1, f64::INFINITY, f64::NAN, -0.1] {
        assert_eq!(
            run.at(Some(time)).map(|state| state.time()).map_err(|refusal| refusal.code()),
            Err("unknown-time")
        );
    }
    assert_eq!(run.at(Some(now)).expect("now").time(), now);
    let before = run.at(Some(0.234_5)).expect("is kept");
    assert!(before.time() <= 0.234_5 && before.time() > 0.2, "{}", before.time());
    let told = serde_json::to_value(crate::forces::MultipliersList::of(&before)).expect("JSON");
    assert_eq!(told[0]["time"], before.time());
    for (about, good) in [("0,1,0", true), ("0,x,1,0", false), ("0,1,0,", false)] {
        let asked = serde_json::from_value(serde_json::json!({ "about": about })).expect("a query");
        assert_eq!(crate::forces::ReactionsView::of(&before, &asked).is_ok(), good, "{about}");
    }
}

#[test]
fn errors_go_on_with_other_numbers_and_say_so() {
    let mut run = pendulum();
    let noted = |run: &Run| {
        let notes = run.state(Streamed::default(), String::new).notes;
        notes.iter().any(|note| note.starts_with("the numbers of the run were changed at t = 0.5"))
    };
    while let Ok(true) = run.advance(0.5) {}
    assert!(!noted(&run));
    let other = serde_json::json!({ "places": { "/gravity/1": -3.0 }, "then": "continue" });
    run.change(&serde_json::from_value(other).expect("a change"), 0.0).expect("goes on");
    assert!(noted(&run));
    run.reset();
    assert!(!noted(&run));
}

fn told(run: &Run) -> SessionState {
    run.state(Streamed::default(), String::new)
}

fn change(run: &mut Run, change: serde_json::Value) -> Result<(), Refusal> {
    run.change(&serde_json::from_value(change).expect("a change"), 0.0)
}

/// A run as it is taken up again from what was kept of it.
fn taken_up(run: &Run) -> Run {
    let kept = serde_json::to_string(&run.kept()).expect("JSON");
    Run::resume(serde_json::from_str(&kept).expect("what was kept"), 1 << 20, 0.0)
        .expect("runs")
        .expect("of this program")
}

#[test]
fn a_run_that_is_taken_up_again_keeps_its_errors_its_drag_and_what_was_said() {
    let mut scene = catalogue::scene("spatial-double-pendulum").expect("a scene").duration(5.0);
    scene.simulation.tolerance = 1e-4;
    let source = SceneSource::Scene("it".into());
    let mut run = Run::start("one".into(), scene, &SceneChange::default(), source, 1 << 20).expect("runs");
    while let Ok(true) = run.advance(1.0) {}
    let drag =
        serde_json::json!({ "body": told(&run).bodies[0].name, "to": [0.0, 0.0, 0.0], "stiffness": 5.0 });
    run.drag(serde_json::from_value(drag).expect("a drag"), 0.0).expect("goes on");
    while let Ok(true) = run.advance(2.5) {}
    let before = told(&run);
    let position = |state: &SessionState| state.accuracy.as_ref().map(|accuracy| accuracy.position);
    assert!(position(&before) > Some(1e-6), "{:?}", before.accuracy);
    let mut again = taken_up(&run);
    let after = told(&again);
    assert_eq!((&after.pull, after.time, &after.q), (&before.pull, before.time, &before.q));
    assert!(after.pull.is_some());
    assert_eq!(after.energy, before.energy);
    assert!((after.energy_drift - before.energy_drift).abs() < 1e-12);
    assert!(position(&after) >= position(&before));
    let added = |notes: &[String]| {
        let known = |note: &String| before.notes.contains(note);
        assert_eq!(notes.iter().filter(|note| known(note)).count(), before.notes.len(), "{notes:?}");
        let new: Vec<String> = notes.iter().filter(|note| !known(note)).cloned().collect();
        new
    };
    let new = added(&after.notes);
    assert!(new.len() == 1 && new[0].starts_with("the run was taken up again at t = 2.500 s"), "{new:?}");
    // Twice is as once, and what comes then is added.
    while let Ok(true) = again.advance(2.6) {}
    let then = position(&told(&again));
    assert!(then > position(&after));
    let twice = told(&taken_up(&taken_up(&again)));
    assert!(position(&twice) >= then && added(&twice.notes).len() == 1, "{:?}", twice.notes);
    again.reset();
    let anew = told(&again).notes;
    assert!(!anew.iter().any(|note| note.contains("taken up") || note.contains("were changed")), "{anew:?}");
}

#[test]
fn what_is_not_known_of_errors_is_not_known_with_other_numbers_either() {
    let mut scene = catalogue::scene("spatial-double-pendulum").expect("a scene").duration(20.0);
    scene.simulation.tolerance = 1e-4;
    let source = SceneSource::Scene("it".into());
    let mut run = Run::start("one".into(), scene, &SceneChange::default(), source, 1 << 20).expect("runs");
    let heavier = |run: &mut Run, g: f64| {
        change(run, serde_json::json!({ "places": { "/gravity/2": g }, "then": "continue" }))
            .expect("goes on");
    };
    while let Ok(true) = run.advance(1.0) {}
    let before = told(&run).accuracy.expect("is known");
    heavier(&mut run, -9.0);
    let after = told(&run).accuracy.expect("is known");
    assert!(before.position > 1e-9 && after.position >= before.position, "{before:?} {after:?}");
    while let Ok(true) = run.advance(20.0) {}
    let lost = told(&run).error_unknown_from;
    assert!(lost.is_some_and(|time| time < 20.0), "{lost:?}");
    run.reset();
    while let Ok(true) = run.advance(19.9) {}
    assert_eq!(told(&run).accuracy, None);
    // A drag is a change a frame: what was said does not pile up.
    for k in 0..20 {
        let to = [0.1 * f64::from(k), 0.0, 0.0];
        let drag = serde_json::json!({ "body": told(&run).bodies[0].name, "to": to, "stiffness": 5.0 });
        run.drag(serde_json::from_value(drag).expect("a drag"), 0.0).expect("goes on");
        while let Ok(true) = run.advance(19.9 + 1e-3 * f64::from(k)) {}
    }
    let state = told(&run);
    assert_eq!(state.accuracy, None);
    assert!(state.error_unknown_from.is_some_and(|time| time < 19.9), "{:?}", state.error_unknown_from);
    assert!(state.notes.len() < 5, "{:?}", state.notes);
    run.reset();
    assert!(told(&run).accuracy.is_some());
}

#[test]
fn nothing_is_told_of_errors_before_a_run_was_kept_by_a_program_that_did_not_keep_them() {
    let mut run = pendulum();
    while let Ok(true) = run.advance(0.5) {}
    let mut kept = serde_json::to_value(run.kept()).expect("JSON");
    for key in ["since", "drag"] {
        kept.as_object_mut().expect("an object").remove(key).expect("is kept");
    }
    let again = Run::resume(serde_json::from_value(kept).expect("what was kept"), 1 << 20, 0.0);
    let state = told(&again.expect("runs").expect("of this program"));
    assert_eq!((state.accuracy, state.error_unknown_from), (None, Some(state.time)));
}

#[test]
fn a_run_does_not_go_on_in_a_scene_that_ends_before() {
    let mut run = pendulum();
    while let Ok(true) = run.advance(1.5) {}
    let before = told(&run);
    let shorter =
        |end: f64| serde_json::json!({ "places": { "/simulation/duration": end }, "then": "continue" });
    let refused = change(&mut run, shorter(1.0)).expect_err("it is later than that");
    assert_eq!(refused.code(), "cannot-continue");
    assert!(refused.to_string().contains("outside the run, which goes from 0 s to 1 s"), "{refused}");
    let after = told(&run);
    assert_eq!((after.time, after.q, after.changes), (1.5, before.q, 0));
    change(&mut run, shorter(1.5)).expect("it stands at the end");
    assert!(told(&run).finished);
}

#[test]
fn a_run_that_goes_on_tells_what_its_change_moved_and_not_what_the_start_would_have_needed() {
    let scene = catalogue::scene("crank-rocker").expect("a scene");
    let source = SceneSource::Builtin("crank-rocker".into());
    let mut run = Run::start("one".into(), scene, &SceneChange::default(), source, 1 << 20).expect("runs");
    while let Ok(true) = run.advance(1.0) {}
    let rate =
        |rate: f64| serde_json::json!({ "places": { "/drivers/0/motion/rate": rate }, "then": "continue" });
    change(&mut run, rate(5.4)).expect("goes on");
    let notes = told(&run).notes;
    assert!(!notes.iter().any(|note| note.contains("given for the start")), "{notes:?}");
    let moved = notes.iter().filter(|note| note.contains("bodies were moved by up to")).collect::<Vec<_>>();
    assert!(matches!(moved[..], [note] if note.starts_with("at t = 1.000 s, when ")), "{notes:?}");
    // Numbers that move nothing.
    change(&mut run, serde_json::json!({ "places": { "/bodies/0/mass": 2.0 }, "then": "continue" }))
        .expect("goes on");
    let notes = told(&run).notes;
    assert!(!notes.iter().any(|note| note.contains("were moved")), "{notes:?}");
    // From the start on, its start counts.
    change(&mut run, rate(5.4)).expect("goes on");
    run.reset();
    assert!(told(&run).notes.iter().any(|note| note.contains("given for the start")));
}

#[test]
fn seconds_that_are_added_up_end_at_the_end_and_at_output_times() {
    for (every, duration) in [(0.01, 1.0), (0.03, 1.0), (0.1, 1.0)] {
        let mut scene = catalogue::scene("simple-pendulum").expect("a scene").duration(duration);
        scene.simulation.every = every;
        let source = SceneSource::Scene("it".into());
        let mut run =
            Run::start("one".into(), scene, &SceneChange::default(), source, 1 << 20).expect("runs");
        for _ in 0..10 {
            let target = run.ahead(0.1);
            while let Ok(true) = run.advance(target) {}
        }
        let state = told(&run);
        assert_eq!((state.time, state.finished), (duration, true), "{every}");
        let outputs = (duration / every - 1e-6).ceil();
        assert!(state.frames as f64 <= outputs + 11.0, "{} frames every {every} s", state.frames);
    }
    // Few seconds are no rounding.
    let mut run = pendulum();
    while let Ok(true) = run.advance(0.3) {}
    let target = run.ahead(1e-9);
    while let Ok(true) = run.advance(target) {}
    assert!(run.time() > 0.3);
}

fn of_text(value: &serde_json::Value) -> Run {
    let scene = Scene::from_json(&value.to_string()).expect("a scene");
    Run::start("one".into(), scene, &SceneChange::default(), SceneSource::Scene("it".into()), 1 << 20)
        .expect("runs")
}

#[test]
fn a_run_that_an_event_stops_has_ended() {
    let mut scene =
        serde_json::to_value(catalogue::scene("simple-pendulum").expect("a scene")).expect("JSON");
    let low = serde_json::json!({ "name": "low", "of": { "type": "angle", "joint": "pin" }, "value": 1.0, "stop": true });
    scene["events"] = serde_json::json!([low]);
    let (mut stepped, mut played) = (of_text(&scene), of_text(&scene));
    let mut calls = 0;
    while stepped.advance(5.0).expect("runs") {
        calls += 1;
        assert!(calls < 10_000, "it goes on for ever at {} s", stepped.time());
    }
    assert!(told(&stepped).finished && stepped.time() < 1.0, "{}", stepped.time());
    assert!(!stepped.advance(5.0).expect("runs") && !stepped.step().expect("runs"));
    played.play(1.0, 0.0);
    tick(&mut played, 5.0);
    assert!(!played.playing() && told(&played).finished);
}

/// A disk that a driver turns against a spring.
fn wound(start: f64, rate: f64) -> serde_json::Value {
    serde_json::json!({
        "name": "disk", "gravity": [0, 0, 0],
        "bodies": [{ "name": "d", "mass": 2, "inertia": { "principal": [0.2, 0.2, 0.3] } }],
        "joints": [{ "name": "p", "type": "revolute", "body_i": "ground", "body_j": "d", "point": [0, 0, 0], "axis": [0, 0, 1] }],
        "drivers": [{ "type": "angle", "name": "m", "joint": "p", "motion": { "kind": "ramp", "start": start, "rate": rate } }],
        "loads": [{ "name": "k", "type": "torsion", "joint": "p", "stiffness": 0.05 }],
        "simulation": { "duration": 20, "every": 0.01 },
    })
}

#[test]
fn turns_of_a_driver_count_where_its_numbers_are_changed_in_mid_run() {
    for (place, value, start, rate) in [
        ("rate", 5.5, 0.0, 5.5),
        ("start", std::f64::consts::TAU, std::f64::consts::TAU, 5.0),
        ("rate", 5.01, 0.0, 5.01),
    ] {
        let mut run = of_text(&wound(0.0, 5.0));
        while run.advance(12.5).expect("runs") {}
        let places = serde_json::json!({ "places": { format!("/drivers/0/motion/{place}"): value }, "then": "continue" });
        change(&mut run, places).expect("goes on");
        let turned = told(&run).notes.iter().any(|note| note.contains("its angle goes on at"));
        assert_eq!(turned, value != 5.01, "{:?}", told(&run).notes);
        while run.advance(13.5).expect("runs") {}
        let found = told(&run).forces.iter().find(|force| force.joint == "m").expect("a driver").moment[2];
        let right = 0.05 * (start + rate * 13.5);
        assert!((found - right).abs() < 1e-9, "{place} {value}: {found} instead of {right}");
    }
}

#[test]
fn a_pull_holds_its_point_where_the_centre_of_mass_is_another() {
    let mut run = of_text(&serde_json::json!({
        "name": "b", "gravity": [0, 0, 0],
        "bodies": [{ "name": "d", "mass": 2, "inertia": { "principal": [0.1, 0.2, 0.3] } }],
        "simulation": { "duration": 10, "every": 0.01 },
    }));
    let point = [0.3, 0.1, -0.2];
    let pull = Drag { body: "d".into(), point, to: point, stiffness: Some(100.0) };
    run.drag(Some(pull), 0.0).expect("it is held");
    for places in [
        serde_json::json!({ "/bodies/0/center_of_mass/0": 0.4 }),
        serde_json::json!({ "/bodies/0/inertia/principal/0": 0.25, "/bodies/0/center_of_mass/2": -0.1 }),
    ] {
        change(&mut run, serde_json::json!({ "places": places, "then": "continue" })).expect("goes on");
        let energy = told(&run).energy;
        assert!(energy.abs() < 1e-12, "the spring is stretched by nobody: {energy} J");
    }
}
