//! The real binary in its own folder, with nothing of the user's: no state, no settings, no input.

use std::ffi::OsStr;
use std::path::Path;
use std::process::{Command, Stdio};

/// `plica` with these arguments in `folder`, where it also keeps its state, settings and sockets.
pub fn plica(folder: &Path, arguments: impl IntoIterator<Item = impl AsRef<OsStr>>) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_plica"));
    command.args(arguments).current_dir(folder).env("HOME", folder).env("TERM", "dumb").stdin(Stdio::null());
    for (name, place) in [("STATE_HOME", "state"), ("CONFIG_HOME", "config"), ("RUNTIME_DIR", "run")] {
        command.env(format!("XDG_{name}"), folder.join(place));
    }
    command
}
