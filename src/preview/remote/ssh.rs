//! The way to another machine: the person's own ssh, with all its configuration, starts the far end there, and its two pipes
//! are the connection. Whatever goes wrong is one line that also says what to do.

use std::io::Write;
use std::process::{Child, ChildStderr, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex, PoisonError, mpsc};
use std::thread::JoinHandle;
use std::time::Duration;

use super::address::{Address, quoted};
use crate::base::error::{Error, Result};
use crate::files::Options;
use crate::preview::editor::keeper::tail;
use crate::preview::wire::connection::{HangUp, SILENCE, Wire};
use crate::preview::wire::frame::NOT_PLICA;
use crate::preview::wire::handshake::{self, LEFT};
use crate::preview::wire::message::{FromEditor, Role};

/// How long it may take until the far end says hello: somebody may be typing a password.
const PATIENCE: Duration = Duration::from_secs(120);
/// How long the process may take to end by itself once its pipes are closed.
const ENDING: Duration = Duration::from_secs(2);

/// A way to a scene on another machine.
#[derive(Clone, Debug)]
pub struct Way {
    /// The scene.
    pub address: Address,
    /// The program that goes there, as `ssh` does.
    pub program: String,
    /// What plica is called there.
    pub remote_plica: String,
    /// What the scene may take and name, there and here.
    pub options: Options,
}

impl Way {
    /// To `address`, with what the person's environment says: PLICA_SSH is another program than ssh, PLICA_REMOTE where
    /// plica lies there.
    pub fn to(address: Address, remote_plica: Option<String>, options: &Options) -> Way {
        let set = |name: &str| std::env::var(name).ok().filter(|value| !value.is_empty());
        let remote_plica = remote_plica.or_else(|| set("PLICA_REMOTE")).unwrap_or_else(|| "plica".into());
        Way {
            address,
            program: set("PLICA_SSH").unwrap_or_else(|| "ssh".into()),
            remote_plica,
            options: options.clone(),
        }
    }

    fn command(&self) -> Command {
        let mut command = Command::new(&self.program);
        command.arg("-T");
        if let Some(port) = self.address.port {
            command.args(["-p", &port.to_string()]);
        }
        command.args([&self.address.destination(), "--", &self.far_line()]);
        command
    }

    /// What the shell there is to run.
    fn far_line(&self) -> String {
        let options: String = self.options.arguments().iter().map(|word| format!("{} ", quoted(word))).collect();
        // As it is, so that ~ may be in it; a space is the person's own to quote.
        format!("{} attach --stdio {options}{}", self.remote_plica, self.address.quoted_path())
    }

    /// Connects and shakes hands. Blocks as long as ssh has something to ask; `going` receives what gives up the attempt.
    ///
    /// # Errors
    /// One line that says why not and what to do.
    pub fn connect(&self, going: impl FnOnce(HangUp)) -> Result<(FromEditor, Wire)> {
        let mut command = self.command();
        let started = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
        let mut child = started.map_err(|error| {
            Error::at(&self.program, format!("cannot be started: {error}")).cure("install OpenSSH's client")
        })?;
        let (stdin, stdout, stderr) = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        let invariant = "a pipe that was asked for";
        let (mut stdin, mut stdout) = (stdin.expect(invariant), stdout.expect(invariant));
        let process = Arc::new(Process::new(child, stderr.expect(invariant)));
        let ended = process.clone();
        let hang_up = HangUp::new(move || ended.kill());
        going(hang_up.clone());
        let (answered, waiting) = mpsc::channel::<()>();
        let late = hang_up.clone();
        std::thread::spawn(move || {
            if waiting.recv_timeout(PATIENCE) == Err(mpsc::RecvTimeoutError::Timeout) {
                late.now();
            }
        });
        let hello = handshake::shake_hands(&mut stdin, &mut stdout, Role::Window, self.options.limits.message);
        drop(answered);
        match hello {
            Ok(hello) => {
                let writer: Box<dyn Write + Send> = Box::new(stdin);
                Ok((hello, Wire { reader: Box::new(stdout), writer, hang_up }.watched(SILENCE)))
            }
            Err(error) => {
                drop((stdin, stdout));
                let (status, said) = process.end();
                Err(self.explain(status, &said, error))
            }
        }
    }

    /// Why there is no connection, by how ssh ended and what was said on the way.
    fn explain(&self, status: Option<ExitStatus>, said: &str, error: Error) -> Error {
        let Address { host, .. } = &self.address;
        let version = env!("CARGO_PKG_VERSION");
        let own = said.lines().rev().find_map(|line| line.trim().strip_prefix("plica: "));
        let last = said.lines().rev().map(str::trim).find(|line| !line.is_empty());
        let code = status.and_then(|status| status.code());
        let error_text = error.to_string();
        match (code, own, last) {
            (Some(127), ..) => Error::at(host, format!("there is no {} there", self.remote_plica)).cure(format!(
                "install plica {version} there, or tell where it is: --remote-plica PATH or PLICA_REMOTE"
            )),
            (Some(126), _, last) => Error::at(host, last.unwrap_or("plica cannot be run there")),
            (Some(2), _, Some(_)) if said.contains("unrecognized subcommand") => {
                Error::at(host, "the plica there is too old to be looked at from here")
                    .cure(format!("install plica {version} there"))
            }
            (Some(255), None, Some(last)) => Error::at(&self.program, last.trim_start_matches("ssh: ")),
            _ if error_text.contains("of the protocol") => {
                let what = error_text.trim_start_matches("link: ").to_owned();
                Error::at(host, format!("{what}; here is plica {version}"))
            }
            (_, Some(own), _) => Error::at(host, own),
            _ if error_text.contains(NOT_PLICA) => Error::at(host, "something there speaks before plica does")
                .cure("look for a shell's start-up file that prints, and let it print to a terminal only"),
            (_, _, Some(last)) => Error::at(host, last),
            _ if error_text.contains(LEFT) => Error::at(host, "the connection ended before anything was said"),
            _ => Error::at(host, error_text.trim_start_matches("link: ")),
        }
    }
}

/// The running ssh, and the end of what it says on standard error.
struct Process {
    child: Mutex<Child>,
    said: Mutex<Option<JoinHandle<String>>>,
}

impl Process {
    fn new(child: Child, stderr: ChildStderr) -> Process {
        let said = std::thread::spawn(move || tail(stderr));
        Process { child: Mutex::new(child), said: Mutex::new(Some(said)) }
    }

    fn kill(&self) {
        let mut child = self.child.lock().unwrap_or_else(PoisonError::into_inner);
        // It may be gone already.
        drop(child.kill());
        drop(child.wait());
    }

    /// Waits for the end, or makes it; returns how it ended by itself and what it said.
    fn end(&self) -> (Option<ExitStatus>, String) {
        let step = ENDING / 40;
        let look = || self.child.lock().unwrap_or_else(PoisonError::into_inner).try_wait().ok().flatten();
        let status = (0..40).find_map(|_| {
            look().or_else(|| {
                std::thread::sleep(step);
                None
            })
        });
        self.kill();
        let said = self.said.lock().unwrap_or_else(PoisonError::into_inner).take();
        let said = said.and_then(|said| said.join().ok()).unwrap_or_default();
        (status, said.chars().filter(|c| !c.is_control() || *c == '\n').collect())
    }
}
