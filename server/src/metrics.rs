//! What the server counts, for Prometheus: requests by address and outcome, gradings by lesson, what lives.
//!
//! Labels have few values: templates of addresses, slugs of lessons, codes. No name, answer or secret is among them.

use std::fmt;
use std::sync::atomic::AtomicU64;
use std::time::Duration;

use prometheus_client::encoding::EncodeLabelSet;
use prometheus_client::encoding::text::encode;
use prometheus_client::metrics::counter::Counter;
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::gauge::Gauge;
use prometheus_client::metrics::histogram::Histogram;
use prometheus_client::registry::{Registry, Unit};

/// Upper ends of the classes of durations, s: from a page out of memory to a program that is run for a student.
const SECONDS: [f64; 10] = [0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0];

/// What a request was and what became of it.
#[derive(Debug, Clone, PartialEq, Eq, Hash, EncodeLabelSet)]
struct Asked {
    method: String,
    route: String,
    status: String,
    /// The code of the problem, empty where there was none.
    code: &'static str,
}

/// The address of a request.
#[derive(Debug, Clone, PartialEq, Eq, Hash, EncodeLabelSet)]
struct Route {
    route: String,
}

/// What was graded.
#[derive(Debug, Clone, PartialEq, Eq, Hash, EncodeLabelSet)]
struct Graded {
    lesson: String,
}

/// Histograms made by a function, one for each label.
type Durations<L> = Family<L, Histogram, fn() -> Histogram>;

/// What lives at this moment.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Living {
    /// Live simulations.
    pub sessions: usize,
    /// Those of them that wait for their turn to go on.
    pub sessions_waiting: usize,
    /// Bytes that are kept of what they have passed.
    pub sessions_bytes: usize,
    /// Lectures.
    pub lectures: usize,
    /// Callers that wait for something to be computed.
    pub waiting: usize,
    /// Submissions that wait for a grader or are with one, and those that ended three.
    pub queue: (i64, i64),
    /// Whether something can be handed in, or graded, now.
    pub ready: bool,
}

/// The counters of one server.
pub struct Metrics {
    registry: Registry,
    requests: Family<Asked, Counter>,
    seconds: Durations<Route>,
    gradings: Durations<Graded>,
    sessions: Gauge,
    sessions_waiting: Gauge,
    sessions_bytes: Gauge,
    lectures: Gauge,
    waiting: Gauge,
    queue: [Gauge; 2],
    ready: Gauge,
}

impl fmt::Debug for Metrics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Metrics").finish_non_exhaustive()
    }
}

impl Default for Metrics {
    fn default() -> Self {
        let mut registry = Registry::with_prefix("triad");
        let requests = Family::default();
        registry.register("requests", "Requests that were answered", requests.clone());
        let seconds = Durations::new_with_constructor(durations as fn() -> Histogram);
        let about = "Time to the head of an answer";
        registry.register_with_unit("request_duration", about, Unit::Seconds, seconds.clone());
        let gradings = Durations::new_with_constructor(durations as fn() -> Histogram);
        registry.register_with_unit("grading_duration", "Time to a verdict", Unit::Seconds, gradings.clone());
        let mut gauge = |name: &str, about: &str| {
            let gauge: Gauge = Gauge::default();
            registry.register(name, about, gauge.clone());
            gauge
        };
        let sessions = gauge("sessions", "Live simulations");
        let sessions_waiting =
            gauge("sessions_waiting", "Live simulations that wait for their turn to go on");
        let sessions_bytes = gauge("sessions_bytes", "Bytes kept of what live simulations have passed");
        let lectures = gauge("lectures", "Lectures");
        let waiting = gauge("waiting", "Callers that wait for something to be computed");
        let queue = [
            gauge("queue_waiting", "Submissions that wait for a grader or are with one"),
            gauge("queue_aside", "Submissions that ended three graders"),
        ];
        let ready = gauge("ready", "Whether something could be handed in, or graded, now");
        let started = Gauge::<f64, AtomicU64>::default();
        started.set(jiff::Timestamp::now().as_millisecond() as f64 / 1e3);
        let about = "When the server was started, in seconds since 1970";
        registry.register_with_unit("start_time", about, Unit::Seconds, started);
        Self {
            registry,
            requests,
            seconds,
            gradings,
            sessions,
            sessions_waiting,
            sessions_bytes,
            lectures,
            waiting,
            queue,
            ready,
        }
    }
}

fn durations() -> Histogram {
    Histogram::new(SECONDS)
}

impl Metrics {
    /// Counts a request: the template of its address, its method and status, the code of the problem that it met.
    pub fn answered(&self, method: &str, route: &str, status: u16, code: &'static str, took: Duration) {
        let (method, status) = (method.to_owned(), status.to_string());
        let asked = Asked { method, route: route.to_owned(), status, code };
        self.requests.get_or_create(&asked).inc();
        self.seconds.get_or_create(&Route { route: route.to_owned() }).observe(took.as_secs_f64());
    }

    /// Counts a grading.
    pub fn graded(&self, lesson: &str, took: Duration) {
        self.gradings.get_or_create(&Graded { lesson: lesson.to_owned() }).observe(took.as_secs_f64());
    }

    /// All of it as text for Prometheus.
    ///
    /// Errors never: a text takes what is written to it.
    pub fn text(&self, living: Living) -> Result<String, fmt::Error> {
        let count = |n: usize| i64::try_from(n).unwrap_or(i64::MAX);
        self.sessions.set(count(living.sessions));
        self.sessions_waiting.set(count(living.sessions_waiting));
        self.sessions_bytes.set(count(living.sessions_bytes));
        self.lectures.set(count(living.lectures));
        self.waiting.set(count(living.waiting));
        self.queue[0].set(living.queue.0);
        self.queue[1].set(living.queue.1);
        self.ready.set(i64::from(living.ready));
        let mut text = String::new();
        encode(&mut text, &self.registry)?;
        Ok(text)
    }
}
