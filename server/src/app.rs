//! What all parts of the server share.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use tokio::sync::Semaphore;
use triad_lessons::Course;

use crate::access::Access;
use crate::analysis::Near;
use crate::aside::Streams;
use crate::glance::Presence;
use crate::lecture::Lectures;
use crate::limits::Limits;
use crate::lti::Lti;
use crate::metrics::Metrics;
use crate::motion::Shelf;
use crate::nodes::Node;
use crate::oidc::Oidc;
use crate::regrade::Previews;
use crate::session::Registry;
use crate::store::Store;
use crate::variants::Variants;
use crate::work::Work;

/// Where commands write reports and the workbench looks for them, unless the command line says otherwise.
pub const REPORTS: &str = "reports";

/// The server's state; cheap to clone.
#[derive(Debug, Clone)]
pub struct App {
    /// The lessons, with their answers: they stay in here.
    pub course: Arc<Course>,
    /// The lessons with students' own numbers.
    pub variants: Arc<Variants>,
    /// Which wrong answers are almost right.
    pub near: Arc<Near>,
    /// The gradebook.
    pub store: Arc<Store>,
    /// Which of several servers this is.
    pub node: Arc<Node>,
    /// The live simulations.
    pub sessions: Arc<Registry>,
    /// The lectures.
    pub lectures: Arc<Lectures>,
    /// Threads for those who watch.
    pub streams: Arc<Streams>,
    /// Places for what is computed on request.
    pub work: Arc<Work>,
    /// Recorded runs that were asked for.
    pub motions: Arc<Shelf>,
    /// Places for grading what is answered at once.
    pub at_once: Arc<Semaphore>,
    /// Regrades that were looked at and not applied yet.
    pub regrades: Arc<Previews>,
    /// Who of the class was here a moment ago.
    pub presence: Arc<Presence>,
    /// What is counted.
    pub metrics: Arc<Metrics>,
    /// Whether the server is about to go: it still answers, and is no longer ready.
    pub draining: Arc<AtomicBool>,
    /// Who may do what.
    pub access: Arc<Access>,
    /// What learning platforms reach; nothing where they reach nothing.
    pub lti: Option<Arc<Lti>>,
    /// Sign-in with the account of an institution; nothing where no provider is known.
    pub oidc: Option<Arc<Oidc>>,
    /// What this server allows.
    pub limits: Arc<Limits>,
    /// The path below which everything stands, as `/triad`; empty at the root of a name.
    pub base: Arc<str>,
    /// The folder with the reports of commands.
    pub reports: Arc<Path>,
    /// The file in which sessions and rooms outlive the server; nothing if they do not.
    pub live: Option<Arc<Path>>,
}

impl App {
    /// A server with a course, a gradebook and its bounds; no session yet.
    pub fn new(course: Course, store: Store, limits: Limits) -> Self {
        Self {
            course: Arc::new(course),
            variants: Arc::default(),
            near: Arc::default(),
            store: Arc::new(store),
            node: Arc::default(),
            sessions: Arc::default(),
            lectures: Arc::default(),
            streams: Arc::default(),
            work: Arc::default(),
            motions: Arc::default(),
            at_once: Arc::new(Semaphore::new(std::thread::available_parallelism().map_or(1, usize::from))),
            regrades: Arc::default(),
            presence: Arc::default(),
            metrics: Arc::default(),
            draining: Arc::default(),
            access: Arc::new(Access::home(false, [])),
            lti: None,
            oidc: None,
            limits: Arc::new(limits),
            base: "".into(),
            reports: Path::new(REPORTS).into(),
            live: None,
        }
    }

    /// The same server, one of several; no session yet.
    #[must_use]
    pub fn with_node(self, node: Node) -> Self {
        let (sessions, lectures) = (Registry::of(node.clone()), Lectures::of(node.clone()));
        Self { node: node.into(), sessions: sessions.into(), lectures: lectures.into(), ..self }
    }

    /// The same server, used in another way than at home.
    #[must_use]
    pub fn with_access(self, access: Access) -> Self {
        Self { access: Arc::new(access), ..self }
    }

    /// The same server, which learning platforms reach.
    #[must_use]
    pub fn with_lti(self, lti: Lti) -> Self {
        Self { lti: Some(Arc::new(lti)), ..self }
    }

    /// The same server, at which people of the class sign in with the account of their institution.
    #[must_use]
    pub fn with_oidc(self, oidc: Oidc) -> Self {
        Self { oidc: Some(Arc::new(oidc)), ..self }
    }

    /// The same server, whose sessions and rooms outlive it in a file.
    #[must_use]
    pub fn with_live(self, file: &Path) -> Self {
        Self { live: Some(file.into()), ..self }
    }

    /// The same server, below a path, as `/triad`.
    #[must_use]
    pub fn below(self, base: &str) -> Self {
        Self { base: base.into(), ..self }
    }

    /// The same server, with reports in another folder.
    #[must_use]
    pub fn with_reports(self, folder: &Path) -> Self {
        Self { reports: folder.into(), ..self }
    }
}
