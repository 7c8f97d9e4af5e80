//! `triad serve`.

use std::future::pending;
use std::net::{IpAddr, SocketAddr, UdpSocket};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use axum::Router;
use axum::http::StatusCode;
use clap::Args;
use tokio::net::TcpListener;
use tokio::task::JoinHandle;
use tokio::time::sleep;
use triad_lessons::Course;
use url::Url;

use super::logging::Log;
use super::oidc::Institution;
use super::stops::Stops;
use super::terminal::{Outcome, print_line};
use crate::access::Access;
use crate::app::{App, REPORTS};
use crate::dealing;
use crate::grader::{Grader, LEASE};
use crate::limits::Limits;
use crate::live::{self, Which};
use crate::lti::Lti;
use crate::nodes::Node;
use crate::oidc::Oidc;
use crate::problem::Problem;
use crate::store::{CLASS, Location, Quotas, Role, Store};

/// How long the end of the program waits for the gradebook.
const CLOSING: Duration = Duration::from_secs(5);

#[derive(Debug, Args)]
pub(in crate::cli) struct Serve {
    /// A file with settings in TOML; the command line and the environment go before it.
    #[arg(long, value_name = "FILE", env = "TRIAD_CONFIG")]
    pub(in crate::cli) config: Option<PathBuf>,
    /// Address to listen at; 0.0.0.0 lets the whole network in, which takes --class or --open.
    #[arg(long, default_value = "127.0.0.1", env = "TRIAD_HOST")]
    pub(in crate::cli) host: IpAddr,
    /// Port to listen at; 0 takes any free one.
    #[arg(long, default_value_t = 8080, env = "TRIAD_PORT")]
    pub(in crate::cli) port: u16,
    /// The gradebook: a file, made if it is not there, or a database of a PostgreSQL server, as postgres://user@host/name.
    #[arg(long, default_value = "triad.db", value_name = "PLACE", env = "TRIAD_DATABASE")]
    pub(in crate::cli) database: Location,
    /// Live simulations at a time.
    #[arg(long, default_value_t = 64, value_name = "N", env = "TRIAD_MAX_SESSIONS")]
    pub(in crate::cli) max_sessions: usize,
    /// Bodies that a live simulation may have.
    #[arg(long, default_value_t = 500, value_name = "N", env = "TRIAD_MAX_BODIES")]
    pub(in crate::cli) max_bodies: usize,
    /// Megabytes of answers and files that are kept of one person.
    #[arg(long, default_value_t = 64, value_name = "MB", env = "TRIAD_PERSON_QUOTA")]
    pub(in crate::cli) person_quota: u64,
    /// Megabytes that the whole gradebook may have, if it is a file.
    #[arg(long, default_value_t = 16_384, value_name = "MB", env = "TRIAD_QUOTA")]
    pub(in crate::cli) quota: u64,
    /// The folder with the reports of `triad bench` and `triad stress`, shown at /bench and /stress.
    #[arg(long, default_value = REPORTS, value_name = "DIR", env = "TRIAD_REPORTS")]
    pub(in crate::cli) reports: PathBuf,
    /// Milliseconds in which a submission is graded in its request; what takes longer waits in the database for any grader; with 0
    /// everything does. With a gradebook on a server only.
    #[arg(long, default_value_t = 300, value_name = "MS", env = "TRIAD_AT_ONCE")]
    pub(in crate::cli) at_once: u64,
    /// Lecture rooms at a time.
    #[arg(long, default_value_t = 16, value_name = "N", env = "TRIAD_MAX_ROOMS")]
    pub(in crate::cli) max_rooms: usize,
    /// Followers of one lecture.
    #[arg(long, default_value_t = 500, value_name = "N", env = "TRIAD_MAX_FOLLOWERS")]
    pub(in crate::cli) max_followers: usize,
    /// With accounts: students join with a code, and what is kept or secret belongs to who is signed in. Prints a link for
    /// the teacher until there is one.
    #[arg(long, env = "TRIAD_CLASS")]
    pub(in crate::cli) class: bool,
    /// Let others in without accounts: whoever reaches the server reads everybody's submissions and hands in under any name.
    #[arg(long, env = "TRIAD_OPEN")]
    pub(in crate::cli) open: bool,
    /// With --class: print a link that makes whoever follows it an owner of the class.
    #[arg(long)]
    pub(in crate::cli) new_owner: bool,
    /// Where the class finds the server, as https://triad.example.org behind a proxy that encrypts.
    #[arg(long, value_name = "URL", env = "TRIAD_URL")]
    pub(in crate::cli) url: Option<String>,
    #[command(flatten)]
    pub(in crate::cli) institution: Institution,
    /// The path below which everything stands, where a proxy hands on a part of another site, as /triad.
    #[arg(long, default_value = "", value_name = "PATH", value_parser = base_path, env = "TRIAD_BASE_PATH")]
    pub(in crate::cli) base_path: String,
    /// Address of a proxy that says for whom it asks (X-Forwarded-For); may be given more than once.
    #[arg(long, value_name = "ADDRESS", value_delimiter = ',', env = "TRIAD_PROXY")]
    pub(in crate::cli) proxy: Vec<IpAddr>,
    /// What is logged on the standard error.
    #[arg(long, default_value = "faults", value_name = "WHAT", env = "TRIAD_LOG")]
    pub(in crate::cli) log: Log,
    /// Address for counters (/metrics) and probes (/livez, /readyz), as 127.0.0.1:9464; a port alone is one of this machine.
    #[arg(long, value_name = "ADDRESS", value_parser = admin_address, env = "TRIAD_ADMIN_ADDRESS")]
    pub(in crate::cli) admin_address: Option<SocketAddr>,
    /// Seconds from the request to stop until the server goes: it answers, and says at /readyz that it is going.
    #[arg(long, default_value_t = 0, value_name = "S", env = "TRIAD_DRAIN")]
    pub(in crate::cli) drain: u64,
    /// Host and port at which the other servers of the same database reach this one, as 10.0.0.5:8080; where it listens if it is not
    /// given. They hand on to it what lives in it.
    #[arg(long, value_name = "ADDRESS", value_parser = node_address, env = "TRIAD_NODE_ADDRESS")]
    pub(in crate::cli) node_address: Option<String>,
    /// Another name by which the server may be asked for without --class; may be given more than once.
    #[arg(long, value_name = "NAME", value_delimiter = ',', env = "TRIAD_ALLOW_HOST")]
    pub(in crate::cli) allow_host: Vec<String>,
}

/// An address, or a port of this machine.
pub(super) fn admin_address(text: &str) -> Result<SocketAddr, String> {
    let here = text.trim_start_matches(':').parse().map(|port| SocketAddr::from(([127, 0, 0, 1], port)));
    here.or_else(|_| text.parse())
        .map_err(|_| "write an address and a port, as 127.0.0.1:9464, or a port".to_owned())
}

/// A path without a slash at its end; empty for the root.
fn base_path(text: &str) -> Result<String, String> {
    let path = text.trim_end_matches('/');
    let plain = |part: &str| {
        !matches!(part, "" | "." | "..")
            && part.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.'))
    };
    let is_path = path.is_empty() || path.strip_prefix('/').is_some_and(|rest| rest.split('/').all(plain));
    is_path.then(|| path.to_owned()).ok_or_else(|| "write a path of plain words, as /triad".to_owned())
}

/// A host and a port.
fn node_address(text: &str) -> Result<String, String> {
    let port = text.rsplit_once(':').filter(|(host, _)| !host.is_empty()).map(|(_, port)| port);
    let is_address = port.is_some_and(|port| port.parse::<u16>().is_ok());
    is_address.then(|| text.to_owned()).ok_or_else(|| "write a host and a port, as 10.0.0.5:8080".to_owned())
}

/// What is said once where settings contradict each other, wherever each comes from.
fn check(options: &Serve) -> Result<(), Problem> {
    let refused = |detail: &str, hint: &str| {
        Err(Problem::new(StatusCode::UNPROCESSABLE_ENTITY, "settings-contradict", detail, hint))
    };
    if options.class && options.open {
        return refused(
            "class and open are both set",
            "a class has accounts; to let everybody in leave class out",
        );
    }
    if !options.class && (options.new_owner || options.url.is_some()) {
        return refused("new-owner and url belong to a class, and class is not set", "add --class");
    }
    let path = options.url.as_deref().and_then(|url| Url::parse(url).ok()).map(|url| url.path().to_owned());
    if path.is_some_and(|path| path.trim_end_matches('/') != options.base_path) {
        return refused(
            "url and base-path name different paths",
            "write the same path in both, as --url https://school.example/triad --base-path /triad",
        );
    }
    if !(options.host.is_loopback() || options.class || options.open) {
        return Err(Problem::new(
            StatusCode::UNPROCESSABLE_ENTITY,
            "open-to-all",
            format!(
                "{} is reached from other machines, and without accounts everybody there could do everything",
                options.host
            ),
            "add --class for accounts; --open lets everybody in: they read all submissions and hand in under any name",
        ));
    }
    Ok(())
}

/// Serves until it is stopped.
pub(super) fn serve(options: &Serve, course: Course) -> Result<Outcome, Problem> {
    check(options)?;
    let limits = Limits {
        sessions: options.max_sessions,
        bodies: options.max_bodies,
        lectures: options.max_rooms,
        at_once: Duration::from_millis(options.at_once),
        followers: options.max_followers,
        ..Limits::default()
    };
    let runtime =
        tokio::runtime::Builder::new_multi_thread().enable_all().build().map_err(Problem::internal)?;
    let served = runtime.block_on(async {
        let listener = bind(SocketAddr::new(options.host, options.port)).await?;
        let app = prepare(options, course, limits, &listener).await?;
        listen(options, app, listener).await
    });
    // What still computes for callers that are gone is not waited for.
    runtime.shutdown_background();
    served.map(|()| Outcome::Done)
}

/// The server as it is set up, with what lived in it before.
async fn prepare(
    options: &Serve,
    mut course: Course,
    limits: Limits,
    listener: &TcpListener,
) -> Result<App, Problem> {
    let quotas = Quotas {
        person_bytes: options.person_quota.saturating_mul(1 << 20),
        file_bytes: options.quota.saturating_mul(1 << 20),
        ..Quotas::default()
    };
    let store = Store::at(&options.database).await?.with_quotas(quotas);
    let mut lti = None;
    let access = if options.class {
        let class = store.ensure_course(CLASS, &course.title).await?;
        course = dealing::as_before(&store, course).await?;
        // Where browsers would not bring back what they are given, platforms send nobody: `triad lti tool` says so.
        lti = options.url.as_deref().and_then(|url| Lti::at(url, &class.secret).ok());
        Access::class(&class, options.url.as_ref().is_some_and(|url| url.starts_with("https://")))
    } else {
        Access::home(options.open, options.allow_host.iter().cloned())
    };
    let access = access.behind(options.proxy.iter().copied()).below(&options.base_path);
    let live = live_file(options);
    let mut app = App::new(course, store, limits).with_reports(&options.reports).with_access(access);
    app = app.below(&options.base_path);
    if app.store.is_shared() {
        let here = reached_at(listener.local_addr().map_err(Problem::internal)?);
        let address = options.node_address.clone().unwrap_or_else(|| here.to_string());
        let before = live.as_deref().and_then(live::name);
        app = Node::among(&app.store, before, address).await.map(|node| app.with_node(node))?;
    }
    if let Some(file) = live {
        app = app.with_live(&file);
    }
    let provider = options.institution.provider(lti.is_some())?;
    if let Some(lti) = lti {
        app = app.with_lti(lti);
    }
    if let Some((provider, lti)) = provider.zip(app.lti.clone()) {
        app = app.with_oidc(Oidc::new(provider, lti));
    }
    let coming = app.clone();
    crate::blocking(move || {
        Ok(coming
            .live
            .map(|path| live::bring_back(&path, &coming.sessions, &coming.lectures, &coming.limits)))
    })
    .await?;
    Ok(app)
}

/// Where sessions and rooms outlive the server: beside the gradebook, or, where that is on another machine, in a file of this
/// port.
fn live_file(options: &Serve) -> Option<PathBuf> {
    match &options.database {
        Location::File(path) => Some(live::beside(path)),
        Location::Server(_) if options.port == 0 => None,
        Location::Server(_) => Some(format!("triad-{}.live", options.port).into()),
    }
}

async fn listen(options: &Serve, app: App, listener: TcpListener) -> Result<(), Problem> {
    let stops = Stops::listen();
    let admin = listen_aside(options.admin_address, crate::admin(app.clone())).await?;
    let address = listener.local_addr().map_err(Problem::internal)?;
    print_line(&format!(
        "Triad is at http://{address}{}  ({} lessons; Ctrl-C stops it)",
        app.base,
        app.course.lessons().len()
    ));
    print_line(&format!("Submissions are kept in {}", options.database));
    tell_use(options, &app, address).await?;
    let house = tokio::spawn(crate::api::keep_house(app.clone()));
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    let slots = processors.saturating_sub(1).max(1);
    let grader = Grader::new(app.store.clone(), app.variants.clone(), app.metrics.clone(), slots, LEASE);
    let grading = tokio::spawn(Arc::clone(&grader).run());
    let telling = tokio::spawn(crate::api::keep_told(app.clone()));
    let heard = tokio::spawn(crate::api::keep_heard(app.clone()));
    let listening = tokio::spawn(crate::api::keep_listening(app.clone()));
    let going_app = app.clone();
    let (sessions, lectures) = (app.sessions.clone(), app.lectures.clone());
    // Open streams end with their sessions; otherwise they would keep the server up.
    let live_at = app.live.clone();
    let ending = move || async move {
        // It would write what is left when everybody has gone.
        house.abort();
        drop(house.await);
        grading.abort();
        // A score under way is sent again by the next one who looks: the platform takes the same twice.
        telling.abort();
        drop(telling.await);
        listening.abort();
        heard.abort();
        drop(heard.await);
        drop(going_app.node.leaves(&going_app.store).await);
        if let Some(path) = live_at
            && let Err(error) = live::keep(&path, &sessions, &lectures, Which::All).await
        {
            let path = path.display().to_string();
            tracing::error!(target: "triad", path = path.as_str(), "sessions and rooms end with the server: {error}");
        }
        lectures.leave();
        sessions.clear();
    };
    // What is sent to watchers goes on to the end.
    let (store, _streams) = (app.store.clone(), app.streams.clone());
    let (going, patience) = (Arc::clone(&app.draining), Duration::from_secs(options.drain));
    let draining = move || async move {
        going.store(true, Ordering::Relaxed);
        sleep(patience).await;
    };
    crate::listen::serve(listener, crate::app(app), || stops.clone().next(), draining, ending).await;
    if let Some(admin) = admin {
        admin.abort();
    }
    drop(tokio::time::timeout(CLOSING, grader.finish(slots)).await);
    // What is being written is finished; whoever hangs beyond that has not been answered.
    drop(tokio::time::timeout(CLOSING, store.close()).await);
    Ok(())
}

async fn bind(wanted: SocketAddr) -> Result<TcpListener, Problem> {
    TcpListener::bind(wanted).await.map_err(|error| {
        Problem::new(
            StatusCode::INTERNAL_SERVER_ERROR,
            "port-unavailable",
            format!("cannot listen at {wanted}: {error}"),
            "another program may use that port: choose one with --port, or --port 0 for any free one",
        )
    })
}

/// Answers those who run the server at their own address, to the end of the process: probes are answered while it goes.
pub(super) async fn listen_aside(
    wanted: Option<SocketAddr>,
    admin: Router,
) -> Result<Option<JoinHandle<()>>, Problem> {
    let Some(wanted) = wanted else { return Ok(None) };
    let listener = bind(wanted).await?;
    let address = listener.local_addr().map_err(Problem::internal)?.to_string();
    tracing::info!(target: "triad", admin = address.as_str(), "counters and probes");
    Ok(Some(tokio::spawn(crate::listen::serve(listener, admin, pending, pending, pending))))
}

/// Says how the server is used, and how a teacher comes in.
async fn tell_use(options: &Serve, app: &App, address: SocketAddr) -> Result<(), Problem> {
    if options.open {
        print_line(
            "Open to all: whoever reaches this address reads every submission and hands in under any name.",
        );
        return Ok(());
    }
    if !options.class {
        print_line(
            "Without accounts: grades are for yourself. For a class: triad serve --class --host 0.0.0.0",
        );
        return Ok(());
    }
    let reached = options
        .url
        .as_ref()
        .map_or_else(|| format!("http://{}{}", reached_at(address), app.base), Clone::clone);
    let reached = reached.trim_end_matches('/');
    if options.new_owner || !app.store.has_owner(CLASS).await? {
        let token = app.store.invite(CLASS, "triad", Role::Owner).await?;
        print_line(&format!("Teacher: open {reached}/setup#{token}  (good for a week, once)"));
    }
    let class = app.store.course(CLASS).await?;
    print_line(&format!("Students: {reached}/join with the code {}", class.join_code));
    if address.ip().is_loopback() && options.url.is_none() && options.proxy.is_empty() {
        print_line("Only this machine reaches it: for others stop it and add --host 0.0.0.0");
    }
    if !reached.starts_with("https://") && !address.ip().is_loopback() {
        print_line(
            "Not encrypted: on a network you do not trust put a proxy with TLS before it, and name it with --url.",
        );
    }
    Ok(())
}

/// The address that other machines find: where all are listened at, the one towards the network.
fn reached_at(address: SocketAddr) -> SocketAddr {
    if !address.ip().is_unspecified() {
        return address;
    }
    // Nothing is sent: the system only says from where it would send to an address that nobody has (RFC 5737).
    let own = UdpSocket::bind("0.0.0.0:0").and_then(|socket| {
        socket.connect("192.0.2.1:9")?;
        socket.local_addr()
    });
    own.map_or(address, |own| SocketAddr::new(own.ip(), address.port()))
}
