//! Which process this is, so that another one can find out whether it still runs. A process number alone says little:
//! numbers are reused, containers have their own, and other machines see the same folders.

use std::sync::OnceLock;
use std::time::{Duration, SystemTime};

/// Ends this process now: nothing that was to run at the exit does. The exit functions of a graphics driver would take away
/// what its threads still use, and two threads may end the process at the same time.
pub fn end(status: u8) -> ! {
    signal_hook::low_level::exit(status.into())
}

/// A process.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Identity {
    /// Its machine's name: letters, digits, dots and hyphens.
    pub host: String,
    /// That machine's boot, in hexadecimal; `0` where the system does not tell.
    pub boot: String,
    /// The namespace in which the process number counts; 0 where there is only one.
    pub namespace: u64,
    /// Its number there.
    pub pid: u32,
    /// When it began, in the system's ticks since the boot; 0 where the system does not tell.
    pub start: u64,
}

/// The longest host name that is told.
const MOST_HOST: usize = 40;

impl Identity {
    /// This process.
    pub fn own() -> &'static Identity {
        static OWN: OnceLock<Identity> = OnceLock::new();
        OWN.get_or_init(|| {
            let plain = |c: char| if c.is_ascii_alphanumeric() || c == '-' { c } else { '.' };
            let host: String = super::host_name().chars().map(plain).take(MOST_HOST).collect();
            Identity {
                host: if host.is_empty() { ".".into() } else { host },
                boot: boot(),
                namespace: namespace(),
                pid: std::process::id(),
                start: start_of(std::process::id()).unwrap_or(0),
            }
        })
    }

    /// Whether it runs; `None` if that cannot be told from here.
    pub fn runs(&self) -> Option<bool> {
        let own = Identity::own();
        if (&self.host, &self.boot, self.namespace) != (&own.host, &own.boot, own.namespace) {
            return None;
        }
        let lives = super::process_lives(self.pid);
        Some(lives && start_of(self.pid).is_none_or(|start| self.start == 0 || start == self.start))
    }

    /// Whether it belongs to the same boot of the same machine.
    pub fn same_boot(&self) -> bool {
        self.boot != "0" && self.boot == Identity::own().boot
    }
}

fn boot() -> String {
    let id = std::fs::read_to_string("/proc/sys/kernel/random/boot_id").unwrap_or_default();
    let id: String = id.chars().filter(char::is_ascii_hexdigit).take(32).collect();
    if id.is_empty() { "0".into() } else { id }
}

/// The number in a link such as `pid:[4026531836]`.
fn namespace() -> u64 {
    let link = std::fs::read_link("/proc/self/ns/pid").unwrap_or_default();
    let digits: String = link.to_string_lossy().chars().filter(char::is_ascii_digit).collect();
    digits.parse().unwrap_or(0)
}

/// When a process began; `None` if the system does not tell, and for a zombie.
fn start_of(pid: u32) -> Option<u64> {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
    // The name of the program stands in parentheses and may hold anything.
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace();
    let ended = matches!(fields.next()?, "Z" | "X");
    let start = fields.nth(18)?.parse().ok()?;
    Some(if ended { u64::MAX } else { start })
}

/// When this machine was started, to the accuracy of the clock.
pub fn boot_time() -> Option<SystemTime> {
    let uptime = std::fs::read_to_string("/proc/uptime").ok()?;
    let seconds: f64 = uptime.split_whitespace().next()?.parse().ok()?;
    SystemTime::now().checked_sub(Duration::try_from_secs_f64(seconds).ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_process_runs_as_long_as_it_is_the_same() {
        let own = Identity::own();
        assert_eq!(own.runs(), Some(true));
        let mut child = std::process::Command::new("true").spawn().unwrap();
        let dead = Identity { pid: child.id(), ..own.clone() };
        child.wait().unwrap();
        assert_eq!(dead.runs(), Some(false));
        if cfg!(target_os = "linux") {
            // Another process has the number now.
            assert_eq!(Identity { start: own.start + 1, ..own.clone() }.runs(), Some(false));
            assert!(own.start > 0 && own.namespace > 0 && own.boot.len() == 32, "{own:?}");
            assert!(boot_time().unwrap() < SystemTime::now());
        }
        for other in [
            Identity { host: "far".into(), ..own.clone() },
            Identity { boot: "1".into(), ..own.clone() },
            Identity { namespace: 1, ..own.clone() },
        ] {
            assert_eq!(other.runs(), None, "{other:?}");
        }
    }
}
