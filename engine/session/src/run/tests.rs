use super::*;
use triad_engine::catalogue;

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
fn errors_that_begin_anew_with_other_numbers_say_so() {
    let mut run = pendulum();
    let noted = |run: &Run| {
        let notes = run.state(Streamed::default(), String::new).notes;
        notes.iter().any(|note| note.starts_with("estimated errors count from t = 0.5"))
    };
    while let Ok(true) = run.advance(0.5) {}
    assert!(!noted(&run));
    let other = serde_json::json!({ "places": { "/gravity/1": -3.0 }, "then": "continue" });
    run.change(&serde_json::from_value(other).expect("a change"), 0.0).expect("goes on");
    assert!(noted(&run));
    run.reset();
    assert!(!noted(&run));
}
