//! Live sessions whose scene is changed.

use serde_json::{Value, json};

use crate::{get, post, send, server};
use axum::Router;
use axum::body::Body;
use axum::http::{Request, header};

async fn start(server: &Router, body: Value) -> String {
    let reply = post(server, "/api/v1/sessions", body).await;
    assert_eq!(reply.status, 201, "{}", reply.json());
    reply.headers["location"].to_str().expect("text").to_owned()
}

async fn put(server: &Router, path: &str, body: Value) -> crate::Reply {
    let request = Request::put(path).header(header::CONTENT_TYPE, "application/json");
    send(server, request.body(Body::from(body.to_string())).expect("a request")).await
}

#[tokio::test]
async fn a_parameter_is_changed_while_it_runs_and_brought_back() {
    let server = server();
    let path = start(&server, json!({"builtin": "simple-pendulum"})).await;
    let view = get(&server, &format!("{path}/scene")).await.json();
    let gravity = view["parameters"].as_array().expect("a list").iter().find(|p| p["name"] == "gravity");
    let gravity = gravity.expect("gravity is offered");
    assert_eq!((&gravity["value"], &gravity["on_change"]), (&json!(9.81), &json!("continue")));

    let before = post(&server, &format!("{path}/step"), json!({"seconds": 0.5})).await.json();
    let change = json!({"values": {"gravity": 1.62}});
    let after = post(&server, &format!("{path}/parameters"), change).await.json();
    assert_eq!((&after["time"], &after["changes"]), (&json!(0.5), &json!(1)), "the run goes on");
    assert_eq!(after["energy_drift"], 0.0);
    assert_ne!(after["energy"], before["energy"]);
    assert_eq!(after["frames"], before["frames"], "the recording goes on");
    let view = get(&server, &format!("{path}/scene")).await.json();
    assert_eq!(view["scene"]["gravity"][1], -1.62);
    assert_eq!(view["original"]["gravity"][1], -9.81);

    let change = json!({"places": {"/bodies/0/mass": 2.0, "/coordinates": "reduced"}});
    let state = post(&server, &format!("{path}/parameters"), change).await.json();
    assert_eq!((&state["time"], &state["frames"]), (&json!(0.0), &json!(1)), "other numbers start over");
    assert_eq!(state["q"].as_array().map(Vec::len), Some(9));
    let change = json!({"values": {"gravity": 9.81}, "then": "restart"});
    let state = post(&server, &format!("{path}/parameters"), change).await.json();
    assert_eq!((&state["time"], &state["changes"]), (&json!(0.0), &json!(3)));
}

#[tokio::test]
async fn a_refused_change_leaves_the_run_as_it_was() {
    let server = server();
    let path = start(&server, json!({"builtin": "simple-pendulum"})).await;
    let state = post(&server, &format!("{path}/step"), json!({"seconds": 0.5})).await.json();
    let at = format!("{path}/parameters");
    post(&server, &at, json!({})).await.problem(422, "nothing-to-change");
    post(&server, &at, json!({"values": {"wind": 1}})).await.problem(422, "unknown-parameter");
    post(&server, &at, json!({"values": {"gravity": 1e9}})).await.problem(422, "outside-parameter");
    let problem =
        post(&server, &at, json!({"places": {"/bodies/0/mas": 1}})).await.problem(422, "no-such-number");
    assert_eq!(problem["errors"][0]["pointer"], "#/bodies/0/mas");
    post(&server, &at, json!({"places": {"/bodies/0/mass": -1}})).await.problem(422, "mass-not-positive");
    let far = json!({"places": {"/bodies/0/position/0": -3}, "then": "continue"});
    post(&server, &at, far).await.problem(422, "cannot-continue");
    let now = get(&server, &path).await.json();
    assert_eq!((&now["time"], &now["q"], &now["changes"]), (&state["time"], &state["q"], &json!(0)));
    let beyond = json!({"places": {"/gravity/1": -100}, "then": "continue"});
    let beyond = post(&server, &at, beyond).await.json();
    assert_eq!(beyond["changes"], 1, "an expert may leave the range of a slider");
    let on = post(&server, &format!("{path}/step"), json!({"seconds": 0.1})).await;
    assert_eq!(on.status, 200);
}

#[tokio::test]
async fn a_session_may_start_with_changes_and_lead_back_to_its_scene() {
    let server = server();
    let path = start(&server, json!({"builtin": "simple-pendulum", "change": {"values": {"mass": 3}}})).await;
    let view = get(&server, &format!("{path}/scene")).await.json();
    assert_eq!(
        (&view["scene"]["bodies"][0]["mass"], &view["original"]["bodies"][0]["mass"]),
        (&json!(3.0), &json!(1.0))
    );
}

#[tokio::test]
async fn a_body_is_pulled_and_let_go() {
    let server = server();
    let scene = json!({"name": "ball", "gravity": [0, 0, 0], "bodies": [{"name": "ball", "mass": 2}]});
    let path = start(&server, json!({"scene": scene})).await;
    let at = format!("{path}/pull");
    put(&server, &at, json!({"body": "bal", "to": [1, 0, 0]})).await.problem(422, "cannot-pull");
    let held = put(&server, &at, json!({"body": "ball", "to": [1, 0, 0]})).await.json();
    assert_eq!(held["pull"]["body"], "ball");
    let near = post(&server, &format!("{path}/step"), json!({"seconds": 3})).await.json();
    let x = near["bodies"][0]["position"][0].as_f64().expect("a number");
    assert!((x - 1.0).abs() < 0.05, "{x}");
    let view = get(&server, &format!("{path}/scene")).await.json();
    assert!(view["scene"]["loads"].is_null(), "the hand is no part of the scene");
    let free = send(&server, Request::delete(&at).body(Body::empty()).expect("a request")).await.json();
    assert_eq!((&free["pull"], &free["time"]), (&Value::Null, &json!(3.0)));
}

#[tokio::test]
async fn reactions_say_which_of_their_numbers_are_unique() {
    let server = server();
    let path = start(&server, json!({"lesson": "redundant-constraints"})).await;
    let told = get(&server, &format!("{path}/reactions?on=j&about=joint&in=world")).await.json();
    let [lower, upper] = [0, 1].map(|k| told["reactions"][k].clone());
    assert_eq!((&lower["joint"], &lower["on"]), (&json!("lower"), &json!("door")));
    assert_eq!(lower["force"][2]["unique"], false, "two hinges share the weight");
    let shared = &told["redundancies"][0]["joints"];
    assert_eq!(shared, &json!(["lower", "upper"]));
    let other = get(&server, &format!("{path}/reactions?on=i")).await.json();
    assert_eq!(other["reactions"][1]["on"], "ground");
    let sum = |v: &Value| v["force"][2]["value"].as_f64().expect("a number");
    assert!((sum(&lower) + sum(&upper) - 20.0 * 9.81).abs() < 1e-6);
    get(&server, &format!("{path}/reactions?about=moon")).await.problem(400, "unknown-point");
}

#[tokio::test]
async fn a_run_is_written_as_a_table_with_the_chosen_outputs() {
    let server = server();
    let scene = get(&server, "/api/v1/scenes/simple-pendulum").await.json();
    let path = "/api/v1/analyses/table";
    let asked = json!({"scene": scene, "outputs": ["joints:pin", "energy"], "every": 0.25, "until": 0.6});
    let reply = post(&server, path, &asked).await;
    assert!(reply.status == 200 && reply.media().starts_with("text/csv"), "{}", reply.media());
    let text = String::from_utf8(reply.bytes.to_vec()).expect("text");
    let rows: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(rows[..2], ["time,pin.angle,pin.angle_rate,energy", "s,rad,rad/s,J"]);
    let times: Vec<&str> = rows[2..].iter().filter_map(|row| row.split(',').next()).collect();
    assert_eq!(times, ["0", "0.25", "0.5", "0.6"]);
    // A multiple that rounding puts right before the end is the end.
    let thirds = json!({"scene": scene, "outputs": ["energy"], "every": 0.3, "until": 0.9});
    let reply = post(&server, path, &thirds).await;
    let written = String::from_utf8(reply.bytes.to_vec()).expect("text");
    assert_eq!(written.lines().filter(|line| !line.starts_with('#')).count(), 2 + 4, "{written}");
    // The numbers are those of the run, to the last bit.
    let mut scene = triad_engine::Scene::from_json(&scene.to_string()).expect("a scene").duration(0.6);
    scene.simulation.outputs = vec!["joints:pin".parse().expect("an output")];
    let mut run = triad_engine::run::Simulation::new(&scene).expect("runs");
    run.advance_to(0.6).expect("runs");
    let mut here = vec![0.6];
    triad_engine::run::Outputs::new(&run).write(&run, &mut here);
    let last: Vec<f64> = rows[5].split(',').map(|number| number.parse().expect("a number")).collect();
    assert_eq!(last[..3], here);
    for (key, value, code) in
        [("until", json!(1e6), "table-too-long"), ("outputs", json!(["joints:pan"]), "output-invalid")]
    {
        let mut wrong = asked.clone();
        wrong[key] = value;
        post(&server, path, &wrong).await.problem(422, code);
    }
}

#[tokio::test]
async fn analyses_answer_for_a_scene() {
    let server = server();
    let scene = get(&server, "/api/v1/scenes/simple-pendulum").await.json();
    let asked = json!({"scene": scene});
    let rest = post(&server, "/api/v1/analyses/equilibrium", &asked).await.json();
    assert_eq!(rest["stable"], true);
    assert!((rest["bodies"][0]["position"][1].as_f64().expect("a number") + 1.0).abs() < 1e-9);
    let modes = post(&server, "/api/v1/analyses/modes", &asked).await.json();
    let frequency = modes["modes"][0]["frequency"].as_f64().expect("a number");
    assert!((frequency - 9.81_f64.sqrt() / std::f64::consts::TAU).abs() < 1e-6, "{frequency}");
    let assembly = post(&server, "/api/v1/analyses/assembly", &asked).await.json();
    assert_eq!(assembly["bodies"][0]["body"], "bob");
    post(&server, "/api/v1/analyses/kinematics", &asked).await.problem(422, "not-driven");
    let mut long = asked;
    long["scene"]["simulation"]["every"] = json!(1e-5);
    post(&server, "/api/v1/analyses/kinematics", &long).await.problem(422, "too-many-times");
}
