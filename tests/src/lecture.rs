//! Followers of a lecture on loopback sockets: what each receives, and when.

use crate::program::{HANG, Server};
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// A message of a WebSocket.
#[derive(Debug)]
pub enum Message {
    /// JSON.
    Text(Value),
    /// A block of the recording, so many bytes.
    Block(usize),
    /// The other side closes.
    Close,
    /// Pings and the like.
    Other,
}

/// As little of a WebSocket client as a follower needs.
#[derive(Debug)]
pub struct FollowerPage {
    reader: BufReader<TcpStream>,
    /// Bytes received, heads of messages included.
    pub bytes: usize,
}

impl FollowerPage {
    /// Joins a room.
    pub fn join(address: &str, code: &str, recording: bool) -> Self {
        Self::open(address, &format!("/api/v1/rooms/{code}/stream?recording={recording}"))
    }

    /// Opens a stream.
    pub fn open(address: &str, path: &str) -> Self {
        let mut socket = TcpStream::connect(address).unwrap();
        socket.set_read_timeout(Some(HANG)).unwrap();
        write!(
            socket,
            "GET {path} HTTP/1.1\r\nHost: {address}\r\nUpgrade: websocket\r\n\
             Connection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n"
        )
        .unwrap();
        let mut reader = BufReader::new(socket);
        let mut line = String::new();
        reader.read_line(&mut line).unwrap();
        assert!(line.contains("101"), "{line}");
        while !line.trim().is_empty() {
            line.clear();
            reader.read_line(&mut line).unwrap();
        }
        Self { reader, bytes: 0 }
    }

    /// The connection, for whoever ends it from outside.
    pub fn socket(&self) -> TcpStream {
        self.reader.get_ref().try_clone().unwrap()
    }

    /// Tells the server something short, as a page does: masked, by zeros.
    pub fn tell(&mut self, text: &str) {
        let length = u8::try_from(text.len()).ok().filter(|length| *length < 126).unwrap();
        let head = [0x81, 0x80 | length, 0, 0, 0, 0];
        self.reader.get_mut().write_all(&[&head, text.as_bytes()].concat()).unwrap();
    }

    /// Waits for the next message.
    pub fn read(&mut self) -> Message {
        let (kind, payload) = self.frame().unwrap();
        match kind {
            1 => Message::Text(serde_json::from_slice(&payload).unwrap()),
            2 => Message::Block(payload.len()),
            8 => Message::Close,
            _ => Message::Other,
        }
    }

    /// Waits for the next message and throws it away; whether there was one before the connection ended.
    pub fn skim(&mut self) -> bool {
        self.frame().is_ok_and(|(kind, _)| kind != 8)
    }

    /// The next message: its kind and what it says.
    fn frame(&mut self) -> std::io::Result<(u8, Vec<u8>)> {
        let mut head = [0_u8; 2];
        self.reader.read_exact(&mut head)?;
        let mut long = [0_u8; 8];
        let length = match head[1] {
            126 => {
                self.reader.read_exact(&mut long[6..])?;
                self.bytes += 2;
                u64::from_be_bytes(long)
            }
            127 => {
                self.reader.read_exact(&mut long)?;
                self.bytes += 8;
                u64::from_be_bytes(long)
            }
            short => u64::from(short),
        };
        let mut payload = vec![0; usize::try_from(length).unwrap()];
        self.reader.read_exact(&mut payload)?;
        self.bytes += 2 + payload.len();
        Ok((head[0] & 15, payload))
    }

    /// Reads on until a text of that type satisfies `wanted`.
    pub fn until(&mut self, kind: &str, wanted: impl Fn(&Value) -> bool) -> Value {
        loop {
            match self.read() {
                Message::Text(text) if text["type"] == kind && wanted(&text) => return text,
                Message::Close => panic!("the stream was closed before {kind}"),
                _ => {}
            }
        }
    }
}

/// A lecture of a built-in scene.
#[derive(Debug)]
pub struct LectureRun {
    /// The session that is shown.
    pub session: String,
    /// What followers type.
    pub code: String,
    /// What shows that somebody is the presenter.
    pub key: String,
}

impl LectureRun {
    /// Opens a room for a scene.
    pub fn open(server: &Server, scene: &str) -> Self {
        let session = server.post("/api/v1/sessions", &json!({ "builtin": scene })).json();
        let session = session["id"].as_str().unwrap().to_owned();
        let room = server.post("/api/v1/rooms", &json!({ "session": session })).json();
        let text = |member: &str| room[member].as_str().unwrap().to_owned();
        Self { session, code: text("code"), key: text("key") }
    }

    /// A request of the presenter.
    pub fn lead(&self, server: &Server, method: &str, what: &str, body: &Value) -> crate::program::Reply {
        let path = format!("/api/v1/rooms/{}/{what}", self.code);
        let authorization = format!("Authorization: Bearer {}\r\n", self.key);
        server.ask_with(method, path.trim_end_matches('/'), &authorization, Some(body.to_string().as_bytes()))
    }
}

/// What one follower saw of a lecture.
#[derive(Debug, Clone, Default)]
pub struct Seen {
    /// States.
    pub states: usize,
    /// Blocks of the recording.
    pub blocks: usize,
    /// Bytes, everything included.
    pub bytes: usize,
    /// How long each mark that the presenter set took to arrive.
    pub delays: Vec<Duration>,
    /// The newest time of the run that it was told, s.
    pub time: f64,
}

/// Follows until it is enough; marks carry the time at which they were set, counted from `start`.
pub fn follow(mut follower: FollowerPage, start: Instant, enough: impl Fn(&Seen) -> bool) -> Seen {
    let mut seen = Seen::default();
    while !enough(&seen) {
        match follower.read() {
            Message::Text(text) if text["type"] == "state" => {
                seen.states += 1;
                seen.time = text["time"].as_f64().unwrap();
            }
            Message::Text(text) => {
                if let Some(set) = text["view"]["mark"].as_f64() {
                    seen.delays.push(start.elapsed().saturating_sub(Duration::from_secs_f64(set)));
                }
            }
            Message::Block(_) => seen.blocks += 1,
            Message::Close => break,
            Message::Other => {}
        }
    }
    seen.bytes = follower.bytes;
    seen
}
