//! Addresses of a platform that may be asked.

use url::{Host, Url};

use crate::store::Platform;

/// An address that may be asked: encrypted, or of this machine itself, and without a name or a password in it.
pub fn safe(text: &str) -> Option<Url> {
    let url = Url::parse(text).ok()?;
    let is_here = match url.host()? {
        Host::Domain(name) => name == "localhost",
        Host::Ipv4(address) => address.is_loopback(),
        Host::Ipv6(address) => address.is_loopback(),
    };
    let is_safe = url.scheme() == "https" || (url.scheme() == "http" && is_here);
    (is_safe && url.username().is_empty() && url.password().is_none()).then_some(url)
}

/// The origin of an address that may be asked.
pub fn origin(text: &str) -> Option<String> {
    safe(text).map(|url| url.origin().ascii_serialization())
}

/// Whether an address is one of the platform's services: at an origin that was registered.
pub fn is_service(platform: &Platform, address: &str) -> bool {
    origin(address).is_some_and(|origin| platform.services.contains(&origin))
}
