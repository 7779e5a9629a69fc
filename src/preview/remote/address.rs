//! A scene on another machine, `ssh://[user@]host[:port]/path`: taken apart and put together, in one place, since what the
//! editor prints there is typed here.

use std::fmt;
use std::path::Path;

use crate::base::error::{Error, Result};
use crate::base::text::byte_of_hex;

/// How an address begins.
pub const SCHEME: &str = "ssh://";

/// Where a scene is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Address {
    /// The user name there; `None` leaves it to ssh.
    pub user: Option<String>,
    /// The machine, by a name that ssh knows.
    pub host: String,
    /// The port of ssh; `None` leaves it to ssh.
    pub port: Option<u16>,
    /// The scene there: absolute, or from the home of the user.
    pub path: String,
}

impl Address {
    /// Takes an address apart. `%20` and the like in the path are what they stand for; `/~/a` is `a` from home.
    ///
    /// # Errors
    /// What is no such address, or would reach ssh as an option, is a wrong command line.
    pub fn parse(text: &str) -> Result<Address> {
        let wrong = |what: &str| Error::Usage(format!("{text}: {what}; write ssh://[user@]host[:port]/path"));
        let rest = text.strip_prefix(SCHEME).ok_or_else(|| wrong("this is no address of a scene"))?;
        let (machine, path) = rest.split_once('/').ok_or_else(|| wrong("the path is missing"))?;
        let (user, machine) = machine.rsplit_once('@').map_or((None, machine), |(user, host)| (Some(user), host));
        let (host, port) = split_port(machine).ok_or_else(|| wrong("the port is no number"))?;
        let path = decoded(path).ok_or_else(|| wrong("the path is not UTF-8"))?;
        let path = path.strip_prefix("~/").map_or_else(|| format!("/{path}"), str::to_owned);
        if user.is_some_and(|user| user.contains(':')) {
            return Err(wrong("a password is not taken here, ssh asks for it"));
        }
        if [Some(host), user].into_iter().flatten().any(|name| name.is_empty() || name.starts_with('-')) {
            return Err(wrong("host and user have a name, and none that begins with -"));
        }
        if text.chars().chain(path.chars()).any(char::is_control) || machine.contains(char::is_whitespace) {
            return Err(wrong("there are control characters or spaces in it"));
        }
        if path.is_empty() || path.ends_with('/') {
            return Err(wrong("the path names no file"));
        }
        Ok(Address { user: user.map(str::to_owned), host: host.to_owned(), port, path })
    }

    /// Host and user as ssh takes them.
    pub fn destination(&self) -> String {
        self.user.as_ref().map_or_else(|| self.host.clone(), |user| format!("{user}@{}", self.host))
    }

    /// The path as one word for the shell there; it never looks like an option.
    pub fn quoted_path(&self) -> String {
        let dot = if self.path.starts_with('/') { "" } else { "./" };
        quoted(&format!("{dot}{}", self.path))
    }

    /// The name of the scene's file.
    pub fn file_name(&self) -> &str {
        self.path.rsplit('/').next().unwrap_or(&self.path)
    }
}

/// The address, to be typed; no shell needs quotes around it.
impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{SCHEME}")?;
        self.user.iter().try_for_each(|user| write!(f, "{user}@"))?;
        if self.host.contains(':') {
            write!(f, "[{}]", self.host)?
        } else {
            write!(f, "{}", self.host)?
        }
        self.port.iter().try_for_each(|port| write!(f, ":{port}"))?;
        let home = if self.path.starts_with('/') { "" } else { "/~/" };
        write!(f, "{home}{}", encoded(&self.path))
    }
}

/// The address of a scene on this machine as an ssh client would write it; `environment` has the variables that sshd set.
pub fn of_scene_here(scene: &Path, environment: impl Fn(&str) -> Option<String>) -> Option<Address> {
    let connection = environment("SSH_CONNECTION")?;
    let [_, _, host, port] = connection.split_whitespace().collect::<Vec<_>>()[..] else { return None };
    let user = ["USER", "LOGNAME"].iter().find_map(|name| environment(name)).filter(|user| !user.is_empty());
    let scene = std::path::absolute(scene).ok()?;
    let from_home = environment("HOME").and_then(|home| Some(scene.strip_prefix(home).ok()?.to_owned()));
    let path = from_home.unwrap_or(scene).to_str()?.to_owned();
    let port = port.parse().ok().filter(|&port| port != 22);
    let address = Address { user, host: host.to_owned(), port, path };
    // What cannot be typed is not worth printing.
    Address::parse(&address.to_string()).ok()
}

/// `text` as one word for a POSIX shell.
pub fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', r"'\''"))
}

/// Host and port; an IPv6 address stands in brackets.
fn split_port(machine: &str) -> Option<(&str, Option<u16>)> {
    let (host, port) = match machine.strip_prefix('[') {
        Some(rest) => rest.split_once(']').map(|(host, rest)| (host, rest.strip_prefix(':')))?,
        None => machine.split_once(':').map_or((machine, None), |(host, port)| (host, Some(port))),
    };
    Some((host, port.map(str::parse).transpose().ok()?))
}

fn decoded(text: &str) -> Option<String> {
    let (mut bytes, mut rest) = (Vec::new(), text.as_bytes());
    while let [first, after @ ..] = rest {
        match after.get(..2).filter(|_| *first == b'%').and_then(byte_of_hex) {
            Some(byte) => (bytes, rest) = ([bytes, vec![byte]].concat(), &after[2..]),
            None => {
                bytes.push(*first);
                rest = after;
            }
        }
    }
    String::from_utf8(bytes).ok()
}

fn encoded(path: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"/._-+,:@=".contains(&byte);
    path.bytes().map(|byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_taken_apart_and_put_together() {
        let table = [
            ("ssh://host/a/b.plica.json", "host", None, "'/a/b.plica.json'"),
            ("ssh://me@host:2222/~/b.json", "me@host", Some(2222), "'./b.json'"),
            ("ssh://me@[fe80::1]:2222/b", "me@fe80::1", Some(2222), "'/b'"),
            ("ssh://host/~/-o%20it%27s%20%C3%A9", "host", None, r"'./-o it'\''s é'"),
            ("ssh://me@corp@host/%25a%2", "me@corp@host", None, "'/%a%2'"),
            ("ssh://host//~/x", "host", None, "'//~/x'"),
        ];
        for (text, destination, port, path) in table {
            let address = Address::parse(text).unwrap();
            assert_eq!((address.destination(), address.port), (destination.to_owned(), port), "{text}");
            assert_eq!(address.quoted_path(), path, "{text}");
            let again = Address::parse(&address.to_string()).unwrap();
            assert_eq!(again, address, "{text}: {address}");
        }
    }

    #[test]
    fn what_is_no_address_is_refused() {
        for (text, part) in [
            ("http://host/a", "no address"),
            ("ssh://host", "path is missing"),
            ("ssh://host/", "no file"),
            ("ssh://host/~/", "no file"),
            ("ssh://host/a/", "no file"),
            ("ssh:///a", "have a name"),
            ("ssh://@host/a", "have a name"),
            ("ssh://-oProxyCommand=x/a", "begins with -"),
            ("ssh://-l@host/a", "begins with -"),
            ("ssh://me:secret@host/a", "password"),
            ("ssh://host:x/a", "port"),
            ("ssh://host:99999/a", "port"),
            ("ssh://[::1/a", "port"),
            ("ssh://host/a%0Ab", "control"),
            ("ssh://ho st/a", "spaces"),
            ("ssh://host/%FF", "UTF-8"),
        ] {
            let error = Address::parse(text).unwrap_err();
            assert!(error.to_string().contains(part) && error.exit_status() == 2, "{text}: {error}");
        }
    }

    #[test]
    fn a_shell_reads_a_quoted_word_as_it_was() {
        for text in ["a b", "it's", "$(touch x)`x`\\", "\"", "~/a*?;&|<>", "é\u{202e}"] {
            let line = format!("printf %s {}", quoted(text));
            let out = std::process::Command::new("sh").args(["-c", &line]).output().unwrap();
            assert_eq!(String::from_utf8(out.stdout).unwrap(), text);
        }
    }

    #[test]
    fn who_came_through_ssh_is_told_the_way_back() {
        let environment = |connection: &'static str| {
            move |name: &str| match name {
                "SSH_CONNECTION" => Some(connection.to_owned()),
                "USER" => Some("me".into()),
                "HOME" => Some("/home/me".into()),
                _ => None,
            }
        };
        for (connection, scene, line) in [
            ("10.0.0.1 5000 10.0.0.2 22", "/home/me/a b.json", Some("ssh://me@10.0.0.2/~/a%20b.json")),
            ("::1 5000 ::1 2222", "/srv/a.json", Some("ssh://me@[::1]:2222/srv/a.json")),
            ("", "/srv/a.json", None),
        ] {
            let address = of_scene_here(Path::new(scene), environment(connection)).map(|a| a.to_string());
            assert_eq!(address.as_deref(), line, "{connection}");
        }
        assert_eq!(of_scene_here(Path::new("/a"), |_| None), None);
    }
}
