//! The few system calls: signals, opening beneath a folder, the folders of the user, processes and sockets. All of it
//! through `rustix` and `signal-hook`; nothing here is `unsafe`.

use std::io;
use std::os::fd::AsFd;

pub mod beneath;
pub mod folders;
pub mod signals;

/// For `OpenOptions::custom_flags`: opening fails where the last name of the path is a link.
pub fn no_follow() -> i32 {
    rustix::fs::OFlags::NOFOLLOW.bits() as i32
}

/// Whether a process with this number is there (it may belong to somebody else).
pub fn process_lives(pid: u32) -> bool {
    let Some(pid) = i32::try_from(pid).ok().and_then(rustix::process::Pid::from_raw) else { return false };
    !matches!(rustix::process::test_kill_process(pid), Err(rustix::io::Errno::SRCH))
}

/// The user at the other end of a connected Unix socket.
#[cfg(target_os = "linux")]
pub fn peer_user(socket: impl AsFd) -> io::Result<u32> {
    Ok(rustix::net::sockopt::socket_peercred(socket)?.uid.as_raw())
}

/// The user at the other end of a connected Unix socket: not known here, so nobody is let in by it.
#[cfg(not(target_os = "linux"))]
pub fn peer_user(_: impl AsFd) -> io::Result<u32> {
    Err(io::ErrorKind::Unsupported.into())
}

/// The user that this process acts for.
pub fn user() -> u32 {
    rustix::process::geteuid().as_raw()
}

/// Whether a terminal is at the other end.
pub fn is_terminal(stream: impl AsFd) -> bool {
    rustix::termios::isatty(stream)
}

/// Whether this process was started from an SSH session.
pub fn over_ssh() -> bool {
    ["SSH_CONNECTION", "SSH_TTY"].iter().any(|name| std::env::var_os(name).is_some_and(|v| !v.is_empty()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_socket_pair_has_our_own_user() {
        let (a, _b) = std::os::unix::net::UnixStream::pair().unwrap();
        if cfg!(target_os = "linux") {
            assert_eq!(peer_user(&a).unwrap(), user());
        }
        assert!(!is_terminal(&a));
    }

    #[test]
    fn processes_live_or_do_not() {
        assert!(process_lives(std::process::id()));
        let mut child = std::process::Command::new("true").spawn().unwrap();
        child.wait().unwrap();
        for pid in [child.id(), 0, u32::MAX] {
            assert!(!process_lives(pid), "{pid}");
        }
    }
}
