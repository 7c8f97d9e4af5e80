//! Where requests come in: each finds its run, or is answered without one; and where the time for computing is shared out.

use std::collections::{BTreeMap, VecDeque};

use http::StatusCode;
use triad_engine::scene::Scene;
use triad_session::refusal::Refusal;
use triad_session::requests::NewSession;
use triad_session::{Run, SceneSource};

use crate::inquiry::{BOUNDS, TAKER, answer as inquire, builtin};
use crate::live::Live;
use crate::message::{self, Answer, Request, json};

/// Bytes of samples that a run keeps; half as many of states.
const RUN_BYTES: usize = 48 << 20;
/// Runs at a time: a page has one, and one more while it changes.
const MAX_RUNS: usize = 8;

/// What is left to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Work {
    /// Nothing.
    None,
    /// Something, at the next tick of a run that plays.
    AtTheNextTick,
    /// Something, at once.
    AtOnce,
}

/// All runs of a page.
#[derive(Default)]
pub struct Desk {
    runs: BTreeMap<String, Live>,
    /// How many runs there were.
    began: u32,
    /// Requests to runs that are busy, in their order.
    waiting: VecDeque<Request>,
    out: VecDeque<Vec<u8>>,
}

impl Desk {
    /// Takes a request as JSON; its answer is among the next messages, or comes after some work.
    pub fn take(&mut self, request: &[u8], now: f64) {
        match serde_json::from_slice::<Request>(request) {
            Ok(request) => self.handle(request, now),
            Err(error) => {
                let refusal = Refusal::new(
                    StatusCode::BAD_REQUEST,
                    "invalid-request",
                    error.to_string(),
                    "this is a mistake of the page: reload it",
                );
                self.out.push_back(message::answer(0, Err(refusal)));
            }
        }
    }

    /// The next message.
    pub fn next_message(&mut self) -> Option<Vec<u8>> {
        self.out.pop_front()
    }

    /// Lets each run that has something to do compute for a short while.
    pub fn work(&mut self, now: f64) -> Work {
        let mut out = Vec::new();
        let mut left = Work::None;
        for live in self.runs.values_mut().filter(|live| live.moving()) {
            let more = if live.work(now, &mut out) { Work::AtOnce } else { Work::AtTheNextTick };
            left = left.max(if live.moving() { more } else { Work::None });
        }
        self.out.extend(out);
        for request in std::mem::take(&mut self.waiting) {
            self.handle(request, now);
        }
        let begun = self.runs.values().any(Live::busy);
        if begun { Work::AtOnce } else { left }
    }

    fn handle(&mut self, request: Request, now: f64) {
        if let Some(answer) = inquire(&request) {
            return self.tell(&request, answer);
        }
        let words = request.words();
        match (request.method.as_str(), words.as_slice()) {
            ("POST", ["sessions"]) => {
                let answer = self.start(&request);
                self.tell(&request, answer);
            }
            ("DELETE", ["sessions", id]) => {
                let answer = self.runs.remove(*id).map(|_| Vec::new()).ok_or_else(|| unknown(id));
                self.tell(&request, answer);
            }
            (_, ["sessions", id, word @ ..]) if word.len() < 2 => {
                let (id, word) = ((*id).to_owned(), word.first().copied().unwrap_or_default().to_owned());
                self.ask(request, &id, &word, now);
            }
            _ => {
                let refusal = Refusal::new(
                    StatusCode::NOT_FOUND,
                    "not-here",
                    format!("the engine in this page does not answer {} {}", request.method, request.path),
                    "this needs the server",
                );
                self.tell(&request, Err(refusal));
            }
        }
    }

    fn tell(&mut self, request: &Request, answer: Answer) {
        self.out.push_back(message::answer(request.id, answer));
    }

    fn ask(&mut self, request: Request, id: &str, word: &str, now: f64) {
        let Some(live) = self.runs.get_mut(id) else {
            return self.tell(&request, Err(unknown(id)));
        };
        let mut out = Vec::new();
        let urgent = matches!(word, "pause" | "reset") && request.method == "POST";
        if urgent {
            live.interrupt(&mut out);
        } else if live.busy() && request.method != "GET" {
            self.waiting.push_back(request);
            return;
        }
        let answer = match request.method.as_str() {
            "OPEN" => {
                live.watch(&mut out);
                Some(json(&()))
            }
            "CLOSE" => {
                live.unwatch();
                Some(json(&()))
            }
            _ => {
                let answer = live.ask(&request, word, now);
                if answer.is_some() && request.method != "GET" {
                    live.stream(&mut out);
                }
                answer
            }
        };
        self.out.extend(out);
        if let Some(answer) = answer {
            self.tell(&request, answer);
        }
    }

    fn start(&mut self, request: &Request) -> Answer {
        let wanted: NewSession = request.body()?;
        if self.runs.len() >= MAX_RUNS {
            return Err(Refusal::new(
                StatusCode::SERVICE_UNAVAILABLE,
                "too-many-sessions",
                format!("{MAX_RUNS} runs are open in this page"),
                "close one of them, or reload the page",
            ));
        }
        let (mut scene, source) = match (wanted.builtin, wanted.scene) {
            (Some(name), None) => (builtin(&name)?, SceneSource::Builtin(name)),
            (None, Some(value)) => {
                let read = Scene::from_json(&value.to_string());
                let scene = read.map_err(|error| Refusal::from(error).within("/scene"))?;
                let source = match wanted.lesson {
                    Some(slug) => SceneSource::Lesson(slug),
                    None => SceneSource::Scene(scene.name.clone()),
                };
                (scene, source)
            }
            _ => {
                return Err(Refusal::new(
                    StatusCode::UNPROCESSABLE_ENTITY,
                    "what-to-simulate",
                    "a run in the page needs `builtin`, or `scene` with the `lesson` that it is of, if any",
                    r#"for example {"builtin": "simple-pendulum"}"#,
                ));
            }
        };
        wanted.overrides.apply(&mut scene);
        BOUNDS.hold(&scene, TAKER)?;
        self.began += 1;
        let id = format!("here-{}", self.began);
        let run = Run::start(id.clone(), scene, &wanted.change, source, RUN_BYTES)?;
        let live = Live::new(id.clone(), run);
        let answer = json(&live.state());
        self.runs.insert(id, live);
        answer
    }
}

fn unknown(id: &str) -> Refusal {
    Refusal::new(
        StatusCode::NOT_FOUND,
        "unknown-session",
        format!("there is no run {id} in this page"),
        "start another",
    )
}
