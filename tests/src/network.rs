//! A machine of its own on a network of its own, as far as Linux makes one within another: a network namespace, joined to this machine
//! by a link that a test cuts.

use std::net::Ipv4Addr;
use std::path::Path;
use std::process::{Command, Stdio};

/// A namespace with an address of its own; gone as this is dropped.
#[derive(Debug)]
pub struct Namespace {
    name: String,
    /// The end of its link that is plugged in here.
    link: String,
    /// What that is plugged into. It keeps this machine's address while the link is cut, so that nothing is sent elsewhere and nobody
    /// is told.
    bridge: String,
    /// This machine, seen from there.
    pub here: String,
    /// That machine, seen from here.
    pub there: String,
}

impl Namespace {
    /// Makes one.
    ///
    /// # Errors
    /// What is missing: it takes root and iproute2.
    pub fn make() -> Result<Self, String> {
        let id = std::process::id();
        // Four addresses of those that are set aside for tests of networks, 198.18.0.0/15.
        let block = Ipv4Addr::from_bits(0xc612_0000 + id % 0x8000 * 4);
        let address = |last| Ipv4Addr::from_bits(block.to_bits() + last).to_string();
        let made = Self {
            name: format!("triad{id}"),
            link: format!("tl{id}"),
            bridge: format!("tb{id}"),
            here: address(1),
            there: address(2),
        };
        let Self { name, link, bridge, here, there } = &made;
        for words in [
            format!("netns add {name}"),
            format!("link add {bridge} type bridge"),
            format!("link add {link} type veth peer name eth0 netns {name}"),
            format!("link set {link} master {bridge}"),
            format!("addr add {here}/30 dev {bridge}"),
            format!("link set {bridge} up"),
            format!("link set {link} up"),
            format!("-n {name} addr add {there}/30 dev eth0"),
            format!("-n {name} link set lo up"),
            format!("-n {name} link set eth0 up"),
        ] {
            ip(&words)?;
        }
        Ok(made)
    }

    /// A command that runs a program there, as one process.
    pub fn command(&self, program: &Path) -> Command {
        let mut command = Command::new("ip");
        command.args(["netns", "exec", &self.name]).arg(program);
        command
    }

    /// Cuts the link: what is sent is lost, in both directions, and connections are not ended.
    pub fn cut(&self) {
        ip(&format!("link set {} down", self.link)).unwrap();
    }

    /// Mends it.
    pub fn mend(&self) {
        ip(&format!("link set {} up", self.link)).unwrap();
    }
}

impl Drop for Namespace {
    fn drop(&mut self) {
        // Its end of the link goes with it.
        for words in [format!("netns del {}", self.name), format!("link del {}", self.bridge)] {
            drop(ip(&words));
        }
    }
}

fn ip(words: &str) -> Result<(), String> {
    let done = Command::new("ip").args(words.split(' ')).stdin(Stdio::null()).output();
    let done = done.map_err(|error| format!("ip: {error} (Debian: apt-get install iproute2)"))?;
    let said = String::from_utf8_lossy(&done.stderr);
    done.status.success().then_some(()).ok_or_else(|| format!("ip {words}: {}", said.trim()))
}
