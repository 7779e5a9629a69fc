//! The few system calls: signals, opening beneath a folder, the folders of the user, processes and sockets. All of it
//! through `rustix` and `signal-hook`; nothing here is `unsafe`.

use std::io::{self, Seek, Write};
use std::os::fd::AsFd;

pub mod beneath;
pub mod folders;
pub mod process;
pub mod signals;

/// For `OpenOptions::custom_flags`: opening fails where the last name of the path is a link.
pub fn no_follow() -> i32 {
    rustix::fs::OFlags::NOFOLLOW.bits() as i32
}

/// Gives one file the extended attributes of another (notes, labels, access lists), as far as the system lets us.
#[cfg(target_os = "linux")]
pub fn copy_attributes(from: impl AsFd, to: impl AsFd) {
    /// No list of names and no value is longer on Linux.
    const MOST: usize = 64 << 10;
    let (mut names, mut value) = (vec![0; MOST], vec![0; MOST]);
    let Ok(length) = rustix::fs::flistxattr(&from, &mut names[..]) else { return };
    for name in names[..length].split(|byte| *byte == 0).filter(|name| !name.is_empty()) {
        if let Ok(length) = rustix::fs::fgetxattr(&from, name, &mut value[..]) {
            // Some attributes are reserved for the system; losing them does no harm.
            let _ = rustix::fs::fsetxattr(&to, name, &value[..length], rustix::fs::XattrFlags::empty());
        }
    }
}

/// Gives one file the extended attributes of another: not known here.
#[cfg(not(target_os = "linux"))]
pub fn copy_attributes(_: impl AsFd, _: impl AsFd) {}

/// A file that is in memory alone, read from its beginning.
///
/// # Errors
/// If there is no memory for it.
#[cfg(target_os = "linux")]
pub fn in_memory(bytes: &[u8]) -> io::Result<std::fs::File> {
    let file = rustix::fs::memfd_create("plica", rustix::fs::MemfdFlags::CLOEXEC)?;
    from_its_beginning(file.into(), bytes)
}

/// A file that nothing names, read from its beginning.
///
/// # Errors
/// If there is no space for it.
#[cfg(not(target_os = "linux"))]
pub fn in_memory(bytes: &[u8]) -> io::Result<std::fs::File> {
    use std::sync::atomic::{AtomicU64, Ordering};
    static MADE: AtomicU64 = AtomicU64::new(0);
    let name = format!("plica-{}-{}", std::process::id(), MADE.fetch_add(1, Ordering::Relaxed));
    let path = std::env::temp_dir().join(name);
    let file = std::fs::File::options().read(true).write(true).create_new(true).open(&path)?;
    std::fs::remove_file(&path)?;
    from_its_beginning(file, bytes)
}

fn from_its_beginning(mut file: std::fs::File, bytes: &[u8]) -> io::Result<std::fs::File> {
    file.write_all(bytes)?;
    file.rewind()?;
    Ok(file)
}

/// Whether this user may not write the file, by its owner and mode.
pub fn is_denied_to_write(path: &std::path::Path) -> bool {
    let (access, flags) = (rustix::fs::Access::WRITE_OK, rustix::fs::AtFlags::EACCESS);
    rustix::fs::accessat(rustix::fs::CWD, path, access, flags) == Err(rustix::io::Errno::ACCESS)
}

/// For `OpenOptions::custom_flags`: opening a FIFO never blocks, and no terminal becomes ours.
pub fn no_wait() -> i32 {
    (rustix::fs::OFlags::NONBLOCK | rustix::fs::OFlags::NOCTTY).bits() as i32
}

/// Opens a special file (FIFO, device) for writing, without waiting for a reader.
///
/// # Errors
/// `WouldBlock` if nobody reads the FIFO; otherwise the error of opening it.
pub fn open_special(path: &std::path::Path) -> io::Result<std::fs::File> {
    use rustix::fs::{Mode, OFlags};
    let flags = OFlags::WRONLY | OFlags::CLOEXEC | OFlags::NOCTTY;
    let opened = rustix::fs::open(path, flags | OFlags::NONBLOCK, Mode::empty());
    let file = opened.map_err(|error| -> io::Error {
        match error {
            rustix::io::Errno::NXIO => io::ErrorKind::WouldBlock.into(),
            error => error.into(),
        }
    })?;
    // Once it is open, writing waits for the reader.
    rustix::fs::fcntl_setfl(&file, flags)?;
    Ok(file.into())
}

/// Whether a process with this number is there (it may belong to somebody else).
pub fn process_lives(pid: u32) -> bool {
    let Some(pid) = i32::try_from(pid).ok().and_then(rustix::process::Pid::from_raw) else { return false };
    !matches!(rustix::process::test_kill_process(pid), Err(rustix::io::Errno::SRCH))
}

/// Ends all processes of a group at once, whatever they do.
pub fn end_group(leader: u32) {
    let leader = i32::try_from(leader).ok().and_then(rustix::process::Pid::from_raw);
    // It may have ended by itself.
    let _ = leader.map(|leader| rustix::process::kill_process_group(leader, rustix::process::Signal::KILL));
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

/// The name of that user; the number where it has none.
pub fn user_name() -> String {
    let told = ["USER", "LOGNAME"].into_iter().filter_map(|name| std::env::var(name).ok());
    let listed = || std::fs::read_to_string("/etc/passwd").ok().and_then(|list| name_in(&list, user()));
    told.into_iter().find(|name| !name.is_empty()).or_else(listed).unwrap_or_else(|| format!("user {}", user()))
}

/// The name of a user in a list like `/etc/passwd`: `name:password:number:...`, one per line.
fn name_in(list: &str, user: u32) -> Option<String> {
    let of = |line: &str| {
        let mut fields = line.split(':');
        let (name, number) = (fields.next()?, fields.nth(1)?);
        (!name.is_empty() && number.parse() == Ok(user)).then(|| name.to_owned())
    };
    list.lines().find_map(of)
}

/// The name of this machine.
pub fn host_name() -> String {
    rustix::system::uname().nodename().to_string_lossy().into_owned()
}

/// Whether other machines may have the folder too, so that locks there tell nothing about them: a network's, or one that
/// a program keeps.
#[cfg(target_os = "linux")]
pub fn is_shared(folder: &std::path::Path) -> bool {
    /// NFS, SMB (three of them), 9P, Ceph, FUSE, AFS.
    const SHARED: [u32; 8] =
        [0x6969, 0x517b, 0xff53_4d42, 0xfe53_4d42, 0x0102_1997, 0x00c3_6400, 0x6573_5546, 0x5346_414f];
    rustix::fs::statfs(folder).is_ok_and(|found| SHARED.contains(&(found.f_type as u32)))
}

/// Whether other machines may have the folder too: not known here, so they may.
#[cfg(not(target_os = "linux"))]
pub fn is_shared(_: &std::path::Path) -> bool {
    true
}

/// The terminal at the other end of `stream`, opened once more, so that writing to it never waits.
pub fn open_terminal(stream: impl AsFd) -> io::Result<std::fs::File> {
    use rustix::fs::{Mode, OFlags};
    let name = rustix::termios::ttyname(stream, Vec::new())?;
    let flags = OFlags::WRONLY | OFlags::NONBLOCK | OFlags::NOCTTY | OFlags::CLOEXEC;
    Ok(rustix::fs::open(name, flags, Mode::empty())?.into())
}

/// Whether a terminal is at the other end.
pub fn is_terminal(stream: impl AsFd) -> bool {
    rustix::termios::isatty(stream)
}

/// Whether there is something to read (or the end), or comes to be within this time.
pub fn readable(stream: impl AsFd, within: std::time::Duration) -> bool {
    let mut one = [rustix::event::PollFd::new(&stream, rustix::event::PollFlags::IN)];
    let within = rustix::event::Timespec::try_from(within).ok();
    rustix::event::poll(&mut one, within.as_ref()).is_ok_and(|ready| ready > 0)
}

/// Reads what is available, at most as much as there is room for; 0 at the end. Nothing is left behind in a buffer of the
/// standard library, because there is none.
pub fn read(stream: impl AsFd, into: &mut [u8]) -> io::Result<usize> {
    Ok(rustix::io::retry_on_intr(|| rustix::io::read(&stream, &mut *into))?)
}

/// Whether this process was started from an SSH session.
pub fn over_ssh() -> bool {
    ["SSH_CONNECTION", "SSH_TTY"].iter().any(|name| std::env::var_os(name).is_some_and(|v| !v.is_empty()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_user_has_the_name_that_the_list_gives() {
        let list = "root:x:0:0:root:/root:/bin/sh\nann:x:1000:1000::/home/ann:/bin/sh\nbad\n:x:7:7";
        for (user, name) in [(0, Some("root")), (1000, Some("ann")), (7, None), (100, None)] {
            assert_eq!(name_in(list, user).as_deref(), name, "{user}");
        }
    }

    #[test]
    fn a_socket_pair_has_our_own_user() {
        let (a, _b) = std::os::unix::net::UnixStream::pair().unwrap();
        if cfg!(target_os = "linux") {
            assert_eq!(peer_user(&a).unwrap(), user());
        }
        assert!(!is_terminal(&a));
        assert!(!readable(&a, std::time::Duration::ZERO));
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
