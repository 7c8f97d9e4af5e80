//! The connections of the server: how many, how long one may say nothing, and how they end.

use std::collections::HashMap;
use std::future::Future;
use std::net::{IpAddr, SocketAddr};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use axum::Router;
use axum::extract::ConnectInfo;
use axum::http::Request;
use hyper::body::Incoming;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::io::AsyncWriteExt;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{mpsc, watch};
use tokio::time::{sleep, timeout};
use tower::ServiceExt;

/// Connections at a time, if the system allows as many files; the default of most systems, 1024, is less than a class.
const CONNECTIONS: usize = 4096;
/// Files that are not connections: the gradebook, reports, the runtime's own.
const OTHER_FILES: usize = 128;
/// A connection on which no request arrives whole for this long is closed; browsers open another.
const SILENCE: Duration = Duration::from_secs(30);
/// How long requests under way may take to end when the server is stopped.
const FAREWELL: Duration = Duration::from_secs(10);
/// What one connection too many is told.
const FULL: &[u8] =
    b"HTTP/1.1 503 Service Unavailable\r\nretry-after: 5\r\ncontent-length: 0\r\nconnection: close\r\n\r\n";
/// How long accepting pauses where the system refuses, as when there are no more files.
const PAUSE: Duration = Duration::from_millis(100);

/// Serves until `stop` is over, and on for as long as `draining` takes; then, after `ending`, requests under way have ten
/// seconds. A second `stop` ends each of these at once.
pub async fn serve<S: Future<Output = ()>, D: Future<Output = ()>, E: Future<Output = ()>>(
    listener: TcpListener,
    app: Router,
    stop: impl Fn() -> S,
    draining: impl FnOnce() -> D,
    ending: impl FnOnce() -> E,
) {
    serve_and_part(listener, app, stop, draining, ending, FAREWELL).await;
}

/// The same, with so long a farewell.
async fn serve_and_part<S: Future<Output = ()>, D: Future<Output = ()>, E: Future<Output = ()>>(
    listener: TcpListener,
    app: Router,
    stop: impl Fn() -> S,
    draining: impl FnOnce() -> D,
    ending: impl FnOnce() -> E,
    farewell: Duration,
) {
    let places = Arc::new(Places::new());
    let (stopping, stopped) = watch::channel(());
    // Each connection holds a sender: nothing more can come when the last one has ended.
    let (alive, mut ended) = mpsc::channel::<()>(1);
    tokio::select! {
        () = stop() => {}
        () = accept(&listener, &app, &stopped, &alive, &places) => {}
    }
    tokio::select! {
        () = draining() => {}
        () = stop() => {}
        () = accept(&listener, &app, &stopped, &alive, &places) => {}
    }
    drop((listener, alive));
    ending().await;
    stopping.send_replace(());
    tokio::select! {
        _ = ended.recv() => {}
        () = sleep(farewell) => {}
        () = stop() => {}
    }
}

/// Takes connections for ever, each served by a task of its own.
async fn accept(
    listener: &TcpListener,
    app: &Router,
    stopped: &watch::Receiver<()>,
    alive: &mpsc::Sender<()>,
    places: &Arc<Places>,
) {
    loop {
        let Ok((mut socket, from)) = listener.accept().await else {
            sleep(PAUSE).await;
            continue;
        };
        // A socket that hears both kinds of addresses names the older ones in the words of the newer.
        let from = SocketAddr::new(from.ip().to_canonical(), from.port());
        let Some(place) = Places::take(places, from) else {
            // It fits into the socket's buffer, so that nothing waits here.
            drop(timeout(PAUSE, socket.write_all(FULL)).await);
            continue;
        };
        let held = (place, alive.clone());
        let (app, stopped) = (app.clone(), stopped.clone());
        tokio::spawn(async move {
            connection(socket, from, app, SILENCE, stopped).await;
            drop(held);
        });
    }
}

/// Serves one connection to its end, or until no request arrives whole for as long as `silence`; what it is about to answer when
/// the server stops is answered.
async fn connection(
    socket: TcpStream,
    from: SocketAddr,
    app: Router,
    silence: Duration,
    mut stopped: watch::Receiver<()>,
) {
    let app = app.map_request(move |mut request: Request<Incoming>| {
        request.extensions_mut().insert(ConnectInfo(from));
        request
    });
    let mut protocol = http1::Builder::new();
    protocol.timer(TokioTimer::new()).header_read_timeout(silence);
    let served = protocol.serve_connection(io(socket), TowerToHyperService::new(app)).with_upgrades();
    tokio::pin!(served);
    // How a connection ended is the business of the other side.
    tokio::select! {
        result = served.as_mut() => drop(result),
        _ = stopped.changed() => {
            served.as_mut().graceful_shutdown();
            drop(served.await);
        }
    }
}

fn io(socket: TcpStream) -> TokioIo<TcpStream> {
    // Answers are short and wanted at once; where the system refuses they come a little later.
    drop(socket.set_nodelay(true));
    TokioIo::new(socket)
}

/// The connections that there are. One address has at most half of them, so that nobody takes all; the machine itself
/// is exempt, as a proxy on it speaks for everybody.
struct Places {
    most: usize,
    taken: AtomicUsize,
    from: Mutex<HashMap<IpAddr, usize>>,
}

impl Places {
    fn new() -> Self {
        let files = rlimit::increase_nofile_limit((CONNECTIONS + OTHER_FILES) as u64).unwrap_or(256);
        let most = usize::try_from(files).unwrap_or(CONNECTIONS).saturating_sub(OTHER_FILES);
        Self { most: most.clamp(64, CONNECTIONS), taken: AtomicUsize::new(0), from: Mutex::default() }
    }

    fn take(this: &Arc<Self>, from: SocketAddr) -> Option<Place> {
        if this.taken.fetch_add(1, Ordering::Relaxed) >= this.most {
            this.taken.fetch_sub(1, Ordering::Relaxed);
            return None;
        }
        let place = Place { places: Arc::clone(this), from: from.ip() };
        let mut each = this.from.lock().unwrap_or_else(PoisonError::into_inner);
        let count = each.entry(from.ip()).or_default();
        *count += 1;
        let allowed = from.ip().is_loopback() || *count <= this.most / 2;
        drop(each);
        allowed.then_some(place)
    }
}

/// One connection's place, given back when it ends.
struct Place {
    places: Arc<Places>,
    from: IpAddr,
}

impl Drop for Place {
    fn drop(&mut self) {
        self.places.taken.fetch_sub(1, Ordering::Relaxed);
        let mut each = self.places.from.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(count) = each.get_mut(&self.from) {
            *count -= 1;
            if *count == 0 {
                each.remove(&self.from);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tokio::io::AsyncReadExt;
    use tokio::sync::Notify;

    /// Ends a test that hangs, and decides nothing else.
    const HANG: Duration = Duration::from_mins(1);

    /// What a connection is told that says this and no more, until it is closed.
    async fn told(says: &str) -> String {
        let listener = TcpListener::bind("127.0.0.1:0").await.expect("a port");
        let mut socket =
            TcpStream::connect(listener.local_addr().expect("an address")).await.expect("connects");
        let (accepted, from) = listener.accept().await.expect("accepts");
        let (_stop, stopped) = watch::channel(());
        let app = Router::new().fallback(|| async { "answered" });
        tokio::spawn(connection(accepted, from, app, Duration::from_millis(50), stopped));
        socket.write_all(says.as_bytes()).await.expect("writes");
        let mut answer = String::new();
        let read = timeout(HANG, socket.read_to_string(&mut answer)).await;
        read.expect("the connection is closed").expect("text");
        answer
    }

    #[tokio::test]
    async fn who_says_half_a_request_or_nothing_is_not_waited_for() {
        let whole = "GET / HTTP/1.1\r\nHost: x\r\n\r\n";
        for half in ["", "GET / HT", "GET / HTTP/1.1\r\nHost: x\r\n"] {
            assert_eq!(told(half).await, "", "{half:?}");
            // Nor after a request that was answered.
            let answer = told(&format!("{whole}{half}")).await;
            assert!(answer.starts_with("HTTP/1.1 200") && answer.ends_with("answered"), "{answer}");
        }
    }

    /// A server that is stopped while something hangs, with so long a farewell; whether it is asked again.
    async fn stopped_while_it_answers(farewell: Duration, again: bool) {
        let listener = TcpListener::bind("127.0.0.1:0").await.expect("a port");
        let mut socket =
            TcpStream::connect(listener.local_addr().expect("an address")).await.expect("connects");
        let (asked, mut begun) = mpsc::channel::<()>(1);
        let hangs = move || {
            let asked = asked.clone();
            async move {
                asked.send(()).await.expect("somebody listens");
                std::future::pending::<()>().await;
            }
        };
        let stops = Arc::new(Notify::new());
        let next = {
            let stops = Arc::clone(&stops);
            move || Arc::clone(&stops).notified_owned()
        };
        let app = Router::new().fallback(hangs);
        let none = || std::future::ready(());
        let serving = tokio::spawn(serve_and_part(listener, app, next, none, none, farewell));
        socket.write_all(b"GET / HTTP/1.1\r\nHost: x\r\n\r\n").await.expect("writes");
        begun.recv().await.expect("it is answered");
        stops.notify_one();
        let ends = async {
            while !serving.is_finished() {
                if again {
                    stops.notify_one();
                }
                sleep(Duration::from_millis(1)).await;
            }
        };
        timeout(HANG, ends).await.expect("it ends");
    }

    #[tokio::test]
    async fn what_hangs_holds_up_a_server_that_is_stopped_for_its_farewell_alone() {
        stopped_while_it_answers(Duration::from_millis(50), false).await;
        // Asked again it waits for nobody.
        stopped_while_it_answers(Duration::from_hours(1), true).await;
    }

    /// What floods of its streams do was not tried: it is not spoken.
    #[tokio::test]
    async fn without_encryption_nobody_speaks_the_second_version_of_http() {
        let answer = told("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n").await;
        assert!(!answer.contains("answered"), "{answer:?}");
    }

    #[test]
    fn one_address_has_half_of_the_places_and_gives_them_back() {
        let most = 8;
        let places = Arc::new(Places { most, taken: AtomicUsize::new(0), from: Mutex::default() });
        let (far, near) = (SocketAddr::from(([10, 0, 0, 1], 1)), SocketAddr::from(([127, 0, 0, 1], 1)));
        let taken: Vec<_> = (0..20).filter_map(|_| Places::take(&places, far)).collect();
        assert_eq!(taken.len(), most / 2);
        let others: Vec<_> = (0..20).filter_map(|_| Places::take(&places, near)).collect();
        assert_eq!(others.len(), most / 2);
        drop((taken, others));
        assert_eq!(places.taken.load(Ordering::Relaxed), 0);
        assert!(places.from.lock().expect("whole").is_empty());
    }
}
