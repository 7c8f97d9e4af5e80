//! A network between a program and PostgreSQL that a test holds up or cuts.

use std::io::{Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::time::Duration;

/// How often a quiet connection looks whether it is cut.
const LOOK: Duration = Duration::from_millis(20);

/// One cable: what goes through it, comes late while it is held up, and is lost as it is cut.
#[derive(Debug)]
pub struct Cable {
    /// Where programs find PostgreSQL at its other end.
    pub port: u16,
    state: Arc<State>,
}

#[derive(Debug, Default)]
struct State {
    held: AtomicBool,
    /// How often it was cut: connections of before are over.
    cuts: AtomicU32,
}

impl Cable {
    /// From a port of this machine to a socket of PostgreSQL.
    pub fn to(socket: PathBuf) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = listener.local_addr().unwrap().port();
        let state = Arc::new(State::default());
        let shared = Arc::clone(&state);
        std::thread::spawn(move || {
            for stream in listener.incoming().filter_map(Result::ok) {
                connect(stream, &socket, &shared);
            }
        });
        Self { port, state }
    }

    /// Lets nothing through for a time; nobody is told.
    pub fn hold_up(&self, time: Duration) {
        self.state.held.store(true, Ordering::Relaxed);
        std::thread::sleep(time);
        self.state.held.store(false, Ordering::Relaxed);
    }

    /// Ends all connections; new ones can be made.
    pub fn cut(&self) {
        self.state.cuts.fetch_add(1, Ordering::Relaxed);
    }
}

fn connect(near: TcpStream, socket: &Path, state: &Arc<State>) {
    let Ok(far) = UnixStream::connect(socket) else { return };
    let (near_back, far_back) = (near.try_clone().unwrap(), far.try_clone().unwrap());
    near.set_read_timeout(Some(LOOK)).unwrap();
    far.set_read_timeout(Some(LOOK)).unwrap();
    let (there, back) = (Arc::clone(state), Arc::clone(state));
    std::thread::spawn(move || {
        carry(&near, &far, &there);
        let _ = (near.shutdown(Shutdown::Both), far.shutdown(Shutdown::Both));
    });
    std::thread::spawn(move || {
        carry(&far_back, &near_back, &back);
        let _ = (near_back.shutdown(Shutdown::Both), far_back.shutdown(Shutdown::Both));
    });
}

/// Carries what comes, until one side ends or the cable is cut.
fn carry(mut from: impl Read, mut to: impl Write, state: &State) {
    let cuts = state.cuts.load(Ordering::Relaxed);
    let mut part = [0; 16_384];
    while state.cuts.load(Ordering::Relaxed) == cuts {
        let length = match from.read(&mut part) {
            Ok(0) => return,
            Ok(length) => length,
            Err(error)
                if matches!(error.kind(), std::io::ErrorKind::WouldBlock | std::io::ErrorKind::TimedOut) =>
            {
                continue;
            }
            Err(_) => return,
        };
        while state.held.load(Ordering::Relaxed) {
            std::thread::sleep(LOOK);
        }
        if to.write_all(&part[..length]).is_err() {
            return;
        }
    }
}
