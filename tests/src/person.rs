//! Somebody of a class, by HTTP.

use crate::program::{HANG, Reply, Server};
use serde_json::{Value, json};
use std::time::Instant;

/// Somebody who is signed in.
#[derive(Debug)]
pub struct Person {
    cookie: String,
}

impl Person {
    /// Comes in: with a link or with the code of the class.
    pub fn enter(server: &Server, path: &str, body: &Value) -> Self {
        let reply = server.post(path, body);
        assert!(reply.status < 300, "{path}: {}", reply.text());
        let set = reply.head.lines().find_map(|line| line.strip_prefix("set-cookie: ")).unwrap();
        Self { cookie: format!("Cookie: {}\r\n", set.split(';').next().unwrap()) }
    }

    /// Asks, and is not refused.
    pub fn ask(&self, server: &Server, method: &str, path: &str, body: Option<&Value>) -> Reply {
        let body = body.map(Value::to_string);
        let reply = server.ask_with(method, path, &self.cookie, body.as_deref().map(str::as_bytes));
        assert!(reply.status < 300, "{method} {path}: {} {}", reply.status, reply.text());
        reply
    }

    /// What is at a path.
    pub fn get(&self, server: &Server, path: &str) -> Value {
        self.ask(server, "GET", path, None).json()
    }

    /// Sends JSON.
    pub fn post(&self, server: &Server, path: &str, body: &Value) -> Reply {
        self.ask(server, "POST", path, Some(body))
    }

    /// Hands in a number and waits for what is said of it; the submission's id.
    pub fn hand_in(
        &self,
        server: &Server,
        (lesson, question, unit): (&str, &str, &str),
        value: &str,
    ) -> String {
        let answers = json!({question: {"value": value, "unit": unit}});
        let path = format!("/api/v1/lessons/{lesson}/submissions");
        let mut told = self.post(server, &path, &json!({ "answers": answers })).json();
        let id = told["id"].as_str().unwrap().to_owned();
        let began = Instant::now();
        while told["state"] == "waiting" {
            assert!(began.elapsed() < HANG, "{told}");
            told = self.get(server, &format!("/api/v1/submissions/{id}?wait=8"));
        }
        assert_ne!(told["state"], "failed", "{told}");
        id
    }
}
