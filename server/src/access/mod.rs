//! Who may do what: at home everybody everything, in a class each by their role.

pub mod phrase;
pub mod rights;

use std::collections::BTreeSet;
use std::net::IpAddr;
use std::num::NonZeroU32;

use axum::http::StatusCode;
use governor::clock::DefaultClock;
use governor::state::keyed::HashMapStateStore;
use governor::{Quota, RateLimiter};

use crate::problem::Problem;
use crate::store::hash::sha256;
use crate::store::{CourseRow, Member};

/// Secrets and codes that one address may try at once, and in a second after that: a hall that joins is one address.
const TRIES: (u32, u32) = (600, 10);
/// Words that one address may try for one name at once; one a minute after that.
const WORDS: u32 = 10;
/// Submissions that one person may hand in at once; one in three seconds after that.
const SUBMISSIONS: u32 = 20;

type Limiter<K> = RateLimiter<K, HashMapStateStore<K>, DefaultClock>;

/// How the server is used, and what bounds those who use it.
#[derive(Debug)]
pub struct Access {
    class: Option<Class>,
    /// Whether any name of the server is taken for its own.
    any_host: bool,
    hosts: BTreeSet<String>,
    /// Whether everything stands below a path of another site's name.
    below: bool,
    /// Proxies that say for whom they ask.
    proxies: BTreeSet<IpAddr>,
    tries: Limiter<IpAddr>,
    words: Limiter<(IpAddr, String)>,
    submissions: Limiter<String>,
}

/// What a server with accounts knows of itself.
#[derive(Debug)]
struct Class {
    /// Enters every seed.
    secret: String,
    /// Whether it is reached by an encrypted connection.
    encrypted: bool,
}

impl Access {
    /// Everybody may do everything and types a name: for oneself. `any_host`: under whatever name the server is asked for.
    pub fn home(any_host: bool, hosts: impl IntoIterator<Item = String>) -> Self {
        Self::new(None, any_host, hosts)
    }

    /// Each by their role. A page of another site is without a cookie here: any name of the server will do.
    pub fn class(course: &CourseRow, encrypted: bool) -> Self {
        Self::new(Some(Class { secret: course.secret.clone(), encrypted }), true, [])
    }

    fn new(class: Option<Class>, any_host: bool, hosts: impl IntoIterator<Item = String>) -> Self {
        let quota =
            |(burst, per_second)| Quota::per_second(positive(per_second)).allow_burst(positive(burst));
        let hosts = hosts.into_iter().map(|host| host.to_ascii_lowercase()).collect();
        Self {
            class,
            any_host,
            hosts,
            below: false,
            proxies: BTreeSet::new(),
            tries: RateLimiter::hashmap(quota(TRIES)),
            words: RateLimiter::hashmap(Quota::per_minute(positive(1)).allow_burst(positive(WORDS))),
            submissions: RateLimiter::hashmap(
                Quota::per_minute(positive(20)).allow_burst(positive(SUBMISSIONS)),
            ),
        }
    }

    /// The same, believing these proxies for whom they ask.
    #[must_use]
    pub fn behind(self, proxies: impl IntoIterator<Item = IpAddr>) -> Self {
        Self { proxies: proxies.into_iter().map(|address| address.to_canonical()).collect(), ..self }
    }

    /// The same, below a path of another site's name.
    #[must_use]
    pub fn below(self, base: &str) -> Self {
        Self { below: !base.is_empty(), ..self }
    }

    /// Who asks, by address: `peer` itself, or, where that is a proxy of ours, the last address that it forwards for and that
    /// is no proxy of ours. What anybody else says of itself is not believed.
    pub fn client(&self, peer: IpAddr, forwarded_for: &str) -> IpAddr {
        let mut client = peer.to_canonical();
        for address in forwarded_for.rsplit(',') {
            if !self.proxies.contains(&client) {
                break;
            }
            let Ok(before) = address.trim().parse::<IpAddr>() else { break };
            client = before.to_canonical();
        }
        client
    }

    /// Whether there are accounts.
    pub fn is_class(&self) -> bool {
        self.class.is_some()
    }

    /// The head of the cookie that holds a session, and what follows its value.
    pub fn cookie(&self) -> (&'static str, &'static str) {
        match (self.class.as_ref().is_some_and(|class| class.encrypted), self.below) {
            (true, false) => ("__Host-triad", "; Path=/; HttpOnly; SameSite=Lax; Secure"),
            // What belongs to the whole host cannot be held to a path.
            (true, true) => ("__Secure-triad", "; Path=/; HttpOnly; SameSite=Lax; Secure"),
            (false, _) => ("triad", "; Path=/; HttpOnly; SameSite=Lax"),
        }
    }

    /// What a member's numbers are drawn from: the course's secret keeps others from computing them.
    pub fn seed_of(&self, member: &Member) -> String {
        let secret = self.class.as_ref().map_or("", |class| class.secret.as_str());
        let mut seed = sha256(&serde_json::json!(["seed", secret, member.seed]).to_string());
        seed.truncate(32);
        seed
    }

    /// Whether the server is meant: a page whose name was made to point here asks under that name.
    ///
    /// Errors if it is another's name.
    pub fn check_host(&self, host: &str) -> Result<(), Problem> {
        let name = match host.strip_prefix('[') {
            Some(rest) => rest.split(']').next().unwrap_or_default(),
            None => host.rsplit_once(':').map_or(host, |(name, _)| name),
        };
        let name = name.to_ascii_lowercase();
        let is_own = self.any_host || name == "localhost" || name.parse::<IpAddr>().is_ok();
        if is_own || self.hosts.contains(&name) {
            return Ok(());
        }
        Err(Problem::new(
            StatusCode::MISDIRECTED_REQUEST,
            "unknown-host",
            format!("this server does not know itself as {name}"),
            "ask for it by its number, as in http://127.0.0.1:8080, or start it with --allow-host NAME",
        ))
    }

    /// Errors if this address has tried too many codes and secrets.
    pub fn check_tries(&self, address: IpAddr) -> Result<(), Problem> {
        self.tries.check_key(&address).map_err(|_| too_often("codes and links"))
    }

    /// Errors if this address has tried too many words for this name.
    pub fn check_words(&self, address: IpAddr, name: String) -> Result<(), Problem> {
        self.words.check_key(&(address, name)).map_err(|_| too_often("words for this name"))
    }

    /// Errors if this person hands in too often.
    pub fn check_submissions(&self, person: &str) -> Result<(), Problem> {
        self.submissions.check_key(&person.to_owned()).map_err(|_| too_often("submissions"))
    }

    /// Forgets those who have not been here for a while.
    pub fn forget(&self) {
        self.tries.retain_recent();
        self.words.retain_recent();
        self.submissions.retain_recent();
    }
}

fn positive(n: u32) -> NonZeroU32 {
    NonZeroU32::new(n).unwrap_or(NonZeroU32::MIN)
}

fn too_often(what: &str) -> Problem {
    Problem::new(
        StatusCode::TOO_MANY_REQUESTS,
        "too-often",
        format!("too many {what} in a short time"),
        "wait a minute, then try again",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_server_at_home_answers_to_its_own_names() {
        let home = Access::home(false, ["Triad.Lab".to_owned()]);
        for own in [
            "127.0.0.1:8080",
            "localhost",
            "LOCALHOST:80",
            "[::1]:8080",
            "[::1]",
            "triad.lab:1",
            "192.168.1.7",
        ] {
            assert!(home.check_host(own).is_ok(), "{own}");
        }
        for other in ["rebound.evil.example", "rebound.evil.example:8080", "127.0.0.1.evil.example", ""] {
            assert!(home.check_host(other).is_err(), "{other}");
        }
        assert!(Access::home(true, []).check_host("any.example").is_ok());
    }

    #[test]
    fn only_a_proxy_of_ours_says_for_whom_it_asks() {
        let ip = |text: &str| text.parse::<IpAddr>().expect("an address");
        let (near, far) = (ip("127.0.0.1"), ip("10.0.0.9"));
        let behind = Access::home(false, []).behind([near, ip("10.0.0.2")]);
        for (peer, forwarded, client) in [
            (near, "", near),
            (near, "10.0.0.9", far),
            (near, "6.6.6.6, 10.0.0.9", far),
            (near, "10.0.0.9, 10.0.0.2", far),
            (near, "nonsense", near),
            (far, "127.0.0.1", far),
            // As a socket that hears both kinds of addresses names the older ones.
            (ip("::ffff:127.0.0.1"), "10.0.0.9", far),
            (ip("::1"), "10.0.0.9", ip("::1")),
            (near, "2001:db8::7", ip("2001:db8::7")),
        ] {
            assert_eq!(behind.client(peer, forwarded), client, "{peer} for {forwarded}");
        }
        assert_eq!(Access::home(false, []).client(near, "10.0.0.9"), near);
    }

    #[test]
    fn words_for_one_name_can_be_tried_ten_times() {
        let home = Access::home(false, []);
        let (here, there) = (IpAddr::from([10, 0, 0, 1]), IpAddr::from([10, 0, 0, 2]));
        let tried = |from, name: &str| home.check_words(from, name.to_owned()).is_ok();
        assert_eq!((0..20).filter(|_| tried(here, "ada")).count(), 10);
        assert!(tried(here, "emmy") && tried(there, "ada"));
    }

    #[test]
    fn codes_and_links_can_be_tried_by_a_hall_and_not_by_who_tries_them_all() {
        let home = Access::home(false, []);
        let tried = |from: [u8; 4]| home.check_tries(IpAddr::from(from)).is_ok();
        let most = TRIES.0 as usize;
        let passed = (0..10 * most).filter(|_| tried([10, 0, 0, 1])).count();
        assert!((most..2 * most).contains(&passed), "{passed}");
        assert!(tried([10, 0, 0, 2]), "others are not concerned");
    }
}
