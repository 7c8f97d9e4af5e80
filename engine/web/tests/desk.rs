//! What the page asks of its engine, natively: answers, streams, and that a pause never waits.

#![allow(clippy::unwrap_used, clippy::expect_used)] // a test that cannot go on says so

use serde_json::{Value, json};
use triad_web::desk::{Desk, Work};

/// A desk with a clock of its own, and the messages that were not read yet.
#[derive(Default)]
struct Page {
    desk: Desk,
    now: f64,
    asked: u32,
    streamed: Vec<(Value, Vec<u8>)>,
    answered: Vec<(u32, u16, Value)>,
}

impl Page {
    fn send(&mut self, method: &str, path: &str, body: &Value) -> u32 {
        self.asked += 1;
        let request = json!({"id": self.asked, "method": method, "path": path, "body": body});
        self.desk.take(request.to_string().as_bytes(), self.now);
        self.read();
        self.asked
    }

    fn read(&mut self) {
        while let Some(message) = self.desk.next_message() {
            let end = message.iter().position(|byte| *byte == b'\n').unwrap();
            let head: Value = serde_json::from_slice(&message[..end]).unwrap();
            let body = &message[end + 1..];
            match head["answer"].as_u64() {
                Some(id) => {
                    let status = u16::try_from(head["status"].as_u64().unwrap()).unwrap();
                    let body = serde_json::from_slice(body).unwrap_or_default();
                    self.answered.push((u32::try_from(id).unwrap(), status, body));
                }
                None => self.streamed.push((head, body.to_vec())),
            }
        }
    }

    /// Works until the answer to a request is there.
    fn answer(&mut self, id: u32) -> (u16, Value) {
        loop {
            if let Some(at) = self.answered.iter().position(|(answered, ..)| *answered == id) {
                let (_, status, body) = self.answered.remove(at);
                return (status, body);
            }
            let left = self.desk.work(self.now);
            let before = self.answered.len();
            self.read();
            assert!(left != Work::None || self.answered.len() > before, "there is nothing to wait for");
        }
    }

    fn ask(&mut self, method: &str, path: &str, body: &Value) -> (u16, Value) {
        let id = self.send(method, path, body);
        self.answer(id)
    }

    /// A run of a built-in scene, and its address.
    fn run(&mut self, name: &str) -> String {
        let (status, state) = self.ask("POST", "/sessions", &json!({"builtin": name}));
        assert_eq!(status, 200, "{state}");
        format!("/sessions/{}", state["id"].as_str().unwrap())
    }
}

#[test]
fn a_run_is_stepped_changed_asked_and_left() {
    let mut page = Page::default();
    let run = page.run("simple-pendulum");
    let (_, state) = page.ask("POST", &format!("{run}/step"), &json!({"seconds": 0.5}));
    assert_eq!(state["time"], 0.5);
    assert!(state["accuracy"]["position"].as_f64().unwrap() < 1e-6);
    let (_, past) = page.ask("GET", &format!("{run}/reactions?at=0.2&about=0%2C1%2C0&in=body"), &Value::Null);
    assert_eq!(past["time"], 0.2);
    let (_, changed) =
        page.ask("POST", &format!("{run}/parameters"), &json!({"places": {"/bodies/0/mass": 3}}));
    assert_eq!((&changed["changes"], &changed["bodies"][0]["mass"]), (&json!(1), &json!(3.0)));
    let (status, refused) = page.ask("POST", &format!("{run}/parameters"), &json!({"values": {"no": 3}}));
    assert_eq!(status, 422, "{refused}");
    assert!(refused["hint"].as_str().is_some_and(|hint| !hint.is_empty()));
    for view in ["jacobian", "augmented", "schur", "multipliers", "scene"] {
        assert_eq!(page.ask("GET", &format!("{run}/{view}"), &Value::Null).0, 200, "{view}");
    }
    assert_eq!(page.ask("DELETE", &run, &Value::Null).0, 200);
    assert_eq!(page.ask("GET", &run, &Value::Null).0, 404);
    assert_eq!(page.ask("GET", "/lessons", &Value::Null).0, 404);
}

#[test]
fn a_pause_does_not_wait_for_the_end_of_a_stretch_and_what_comes_after_it_does() {
    let mut page = Page::default();
    let run = page.run("n-four-bar:2");
    let long = page.send("POST", &format!("{run}/step"), &json!({"seconds": 1e4}));
    for _ in 0..3 {
        assert_eq!(page.desk.work(0.0), Work::AtOnce);
    }
    let camera = page.send("PUT", &format!("{run}/camera"), &json!({"from": "front"}));
    page.read();
    assert!(page.answered.is_empty(), "the stretch is under way, and the camera waits for it");
    let looked = page.send("GET", &run, &Value::Null);
    assert_eq!(page.answer(looked).0, 200, "a question does not wait");
    let pause = page.send("POST", &format!("{run}/pause"), &Value::Null);
    let order: Vec<u32> = page.answered.iter().map(|(id, ..)| *id).collect();
    assert_eq!(order, [long, pause]);
    let (status, state) = page.answer(long);
    assert!(status == 200 && state["time"].as_f64().unwrap() > 0.0 && state["finished"] == false);
    page.desk.work(0.0);
    page.read();
    assert_eq!(page.answer(camera).1["drawing"]["camera"], "front");
}

#[test]
fn a_watcher_gets_each_frame_once_and_states_at_most_ten_times_a_second() {
    let mut page = Page::default();
    let run = page.run("simple-pendulum");
    page.ask("OPEN", &run, &Value::Null);
    page.ask("POST", &format!("{run}/play"), &json!({"speed": 1.0}));
    page.streamed.clear();
    for _ in 0..200 {
        page.now += 0.01;
        page.desk.work(page.now);
        page.read();
    }
    let states = page.streamed.iter().filter(|(head, _)| head["binary"] == false).count();
    assert!((10..=20).contains(&states), "{states} states in 2 s");
    let mut times = Vec::new();
    for (_, block) in page.streamed.iter().filter(|(head, _)| head["binary"] == true) {
        let frames = u32::from_le_bytes(block[8..12].try_into().unwrap());
        times.extend(
            (0..frames as usize)
                .map(|k| f64::from_le_bytes(block[16 + 8 * k..24 + 8 * k].try_into().unwrap())),
        );
    }
    assert!(times.is_sorted_by(|a, b| a < b), "each once, in order");
    assert!(times.len() > 150 && times[0] > 0.0, "{}", times.len());
    page.ask("POST", &format!("{run}/reset"), &Value::Null);
    let resets = page.streamed.iter().filter(|(_, text)| text == br#"{"type":"reset"}"#).count();
    assert_eq!(resets, 1, "the page forgets the motion before");
    page.ask("CLOSE", &run, &Value::Null);
    page.streamed.clear();
    page.ask("POST", &format!("{run}/step"), &json!({"steps": 3}));
    assert!(page.streamed.is_empty(), "nobody watches");
}

#[test]
fn what_the_page_sends_by_mistake_is_refused() {
    let mut page = Page::default();
    page.desk.take(b"{", 0.0);
    page.read();
    assert_eq!(page.answered.pop().map(|(id, status, _)| (id, status)), Some((0, 400)));
    let large = json!({"scene": {"name": "x", "bodies": vec![json!({"name": "b", "mass": 1}); 501]}});
    for (body, status) in
        [(json!({}), 422), (json!({"builtin": "no"}), 404), (json!({"builtin": 1}), 422), (large, 422)]
    {
        assert_eq!(page.ask("POST", "/sessions", &body).0, status, "{body}");
    }
    for _ in 0..8 {
        page.run("free-fall");
    }
    assert_eq!(page.ask("POST", "/sessions", &json!({"builtin": "free-fall"})).0, 503);
}
