//! Nothing acknowledged is lost, and a scene file is always the old one or the new one: a process that edits and saves
//! is killed at random, is killed at every system call of an edit and a save, and has each of those calls fail once.
//!
//! The process is this test binary again, run as the test `child`. System calls are intercepted by strace, one thread
//! at a time; where tracing is forbidden or strace is missing, only the file layer's injected faults (`files::disk`) do
//! the same. The run says which.

#![allow(clippy::unwrap_used, reason = "a test fails where its helpers do")]

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Read, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use plica::files::disk::{self, Fault};
use plica::files::session::{Mode, Overwrite, Session};
use plica::files::{self, Options, journal};
use plica::scene::Edit;

const TASK: &str = "PLICA_TEST_TASK";
const SCENE: &str = "PLICA_TEST_SCENE";
const FAULT: &str = "PLICA_TEST_FAULT";

/// System calls that a program cannot live without, or that are not about files: the process is killed at them, but
/// they do not fail. (The standard library panics if closing a folder fails; what matters was synced before any close.)
const NEVER_FAIL: [&str; 17] = [
    "close",
    "futex",
    "uname",
    "geteuid",
    "mmap",
    "munmap",
    "mprotect",
    "mremap",
    "brk",
    "madvise",
    "rt_sigprocmask",
    "sigaltstack",
    "sched_yield",
    "getrandom",
    "exit",
    "exit_group",
    "restart_syscall",
];

// What the child does.

#[test]
#[ignore = "run by the others, in a process of its own"]
fn child() {
    let Ok(task) = std::env::var(TASK) else { return };
    let scene = PathBuf::from(std::env::var_os(SCENE).unwrap());
    gate("OPENING");
    if let Ok(fault) = std::env::var(FAULT) {
        let (kind, n) = fault.split_once(' ').unwrap();
        disk::inject(n.parse().unwrap(), if kind == "kill" { Fault::Kill } else { Fault::Error });
    }
    let before = disk::operations();
    let mut session = match Session::open(&scene, &Options::default(), Mode::Edit) {
        Ok(session) => session,
        Err(error) => return say(&format!("REFUSED {error}")),
    };
    session.recover();
    if task == "look" {
        return look(&session);
    }
    gate("OPENED");
    let first = number(&session) + 1;
    match task.as_str() {
        "forever" => {
            for n in first.. {
                step(&mut session, n, n % 3 == 0);
            }
        }
        _ => (1..=3).for_each(|n| step(&mut session, n, n < 3)),
    }
    drop(session);
    say(&format!("OPERATIONS {}", disk::operations() - before));
}

fn step(session: &mut Session, n: u64, save: bool) {
    say(&format!("EDIT {n}"));
    session.apply(title(n), false).unwrap();
    // A failure happens once: the second try is like the person's next edit, or the writer's next attempt.
    let journal = || std::fs::metadata(journal::path_beside(session.path())).map_or(0, |found| found.ino());
    let before = journal();
    if let Err(reason) = session.flush() {
        let again = session.flush();
        say(&format!("FAILING {reason}, then {again:?} with another file: {}", before != journal()));
    }
    if session.flush().is_ok() {
        say(&format!("ACKNOWLEDGED {n}"));
    }
    if save {
        say(&format!("SAVING {n}"));
        if session.save(Overwrite::No).or_else(|_| session.save(Overwrite::No)).is_ok() {
            say(&format!("SAVED {n}"));
        }
        // Whether this succeeds is checked by the next edit.
        let _ = session.flush();
    }
}

/// Prints what is left: the document's number, how many steps undo has, and the number where it ends.
fn look(session: &Session) {
    let mut history = session.history().clone();
    let steps = std::iter::from_fn(|| history.undo()).count();
    say(&format!("LEFT {} {steps} {}", number(session), history.document().scene().title));
}

fn title(n: u64) -> Edit {
    let operation = serde_json::json!([{ "op": "add", "path": "/title", "value": n.to_string() }]);
    Edit(serde_json::from_value(operation).unwrap())
}

fn number(session: &Session) -> u64 {
    session.document().scene().title.parse().unwrap()
}

fn say(line: &str) {
    // This write may be the one that fails: once.
    let mut out = std::io::stdout();
    let written = (0..2).any(|_| out.write_all(format!("{line}\n").as_bytes()).and_then(|()| out.flush()).is_ok());
    assert!(written);
}

/// Prints `name` and waits for a line, so that a tracer can attach.
fn gate(name: &str) {
    say(&format!("{name} {}", std::process::id()));
    // This read may be the one that fails.
    let _ = std::io::stdin().read_line(&mut String::new());
}

// What the parent does.

/// How many names (hard links) the scene's file has. A file with two is written in place.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Names {
    One,
    Two,
}

struct Place {
    folder: tempfile::TempDir,
    scene: PathBuf,
    names: Names,
}

fn place(names: Names) -> Place {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("cat.plica.json");
    std::fs::write(&scene, "{ \"plica\": 1, \"title\": \"0\" }\n").unwrap();
    let place = Place { folder, scene, names };
    if names == Names::Two {
        std::fs::hard_link(&place.scene, place.other_name()).unwrap();
    }
    place
}

impl Place {
    fn other_name(&self) -> PathBuf {
        self.folder.path().join("other")
    }
}

struct Running {
    child: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
}

/// What a child reported.
#[derive(Debug, Default)]
struct Said {
    edited: u64,
    acknowledged: u64,
    saving: u64,
    saved: u64,
    operations: u64,
    left: String,
    refused: Option<String>,
    failing: Option<String>,
}

fn start(task: &str, place: &Place, fault: Option<String>) -> Running {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--exact", "child", "--ignored", "--nocapture", "--test-threads=1"]);
    command.env(TASK, task).env(SCENE, &place.scene).env("XDG_STATE_HOME", place.folder.path().join("state"));
    command.envs(fault.map(|fault| (FAULT, fault)));
    let mut child =
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("a child");
    let (to, from) = (child.stdin.take().unwrap(), BufReader::new(child.stdout.take().unwrap()));
    Running { child, to, from }
}

impl Running {
    fn wait_for(&mut self, gate: &str) {
        let mut line = String::new();
        while !line.contains(gate) {
            line.clear();
            assert!(self.from.read_line(&mut line).unwrap() > 0, "the child ended before {gate}");
        }
    }

    fn go(&mut self) {
        // A child that has been killed does not read it.
        let _ = self.to.write_all(b"\n");
    }

    fn end(mut self) -> (Said, ExitStatus) {
        let mut said = Said::default();
        let mut all = String::new();
        self.from.read_to_string(&mut all).unwrap();
        for line in all.lines() {
            let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
            let number = || rest.parse().unwrap_or(0);
            match word {
                "EDIT" => said.edited = number(),
                "ACKNOWLEDGED" => said.acknowledged = number(),
                "SAVING" => said.saving = number(),
                "SAVED" => said.saved = number(),
                "OPERATIONS" => said.operations = number(),
                "FAILING" => said.failing = Some(rest.to_owned()),
                "LEFT" => said.left = rest.to_owned(),
                "REFUSED" => said.refused = Some(rest.to_owned()),
                _ => {}
            }
        }
        (said, self.child.wait().unwrap())
    }
}

/// Checks that the file is complete, old or new, and that the journal has everything acknowledged. Returns what is
/// left: the document's number, the steps of undo, and the number that they lead to.
fn check(place: &Place, said: &Said, before: u64, context: &str) -> [u64; 3] {
    let document = files::scene::open(&place.scene, &Options::default());
    let in_file: u64 = document.unwrap_or_else(|error| panic!("{context}: {error}")).scene().title.parse().unwrap();
    let old_or_new = in_file == said.saved || in_file == said.saving || (said.saved == 0 && in_file <= before);
    assert!(old_or_new, "{context}: the file has {in_file}; {said:?}");
    let mut looking = start("look", place, None);
    looking.go();
    let (found, status) = looking.end();
    assert!(status.success() && found.refused.is_none(), "{context}: {found:?}");
    let left: Vec<u64> = found.left.split(' ').map(|number| number.parse().unwrap()).collect();
    if place.names == Names::Two {
        let [one, other] = [&place.scene, &place.other_name()].map(|path| std::fs::metadata(path).unwrap().ino());
        assert_eq!(one, other, "{context}: the names are parted");
        let text = std::fs::read_to_string(place.other_name()).unwrap();
        assert!(
            serde_json::from_str::<serde_json::Value>(&text).is_ok(),
            "{context}: {text} stays after the next opening"
        );
    }
    let recovered = left[0];
    assert!(recovered >= said.acknowledged.max(in_file), "{context}: {recovered} is left of {said:?}");
    assert!(recovered <= said.edited.max(before), "{context}: {recovered} was never made; {said:?}");
    left.try_into().unwrap()
}

fn check_once(place: &Place, said: &Said, context: &str) {
    let [recovered, steps, first] = check(place, said, 0, context);
    if said.acknowledged == recovered {
        assert_eq!((steps, first), (recovered, 0), "{context}: undo leads back");
    }
    let left: Vec<_> = std::fs::read_dir(place.folder.path()).unwrap().flatten().map(|e| e.file_name()).collect();
    assert!(!left.iter().any(|name| name.to_string_lossy().ends_with(".tmp")), "{context}: {left:?}");
}

#[test]
fn killed_at_random_nothing_acknowledged_is_lost() {
    const KILLS: u32 = 60;
    let place = place(Names::One);
    let (mut before, mut acknowledged) = (0, 0);
    // Any sequence of pauses will do; this one is the same in every run.
    let mut random = 1u64;
    for round in 0..KILLS {
        let mut running = start("forever", &place, None);
        running.wait_for("OPENING");
        running.go();
        running.wait_for("OPENED");
        running.go();
        random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        std::thread::sleep(Duration::from_micros((random >> 33) % 30_000));
        running.child.kill().unwrap();
        let (said, _) = running.end();
        acknowledged += u64::from(said.acknowledged > 0);
        [before, ..] = check(&place, &said, before, &format!("round {round}"));
    }
    assert!(acknowledged > 10, "the child hardly ever got to an edit");
}

#[test]
fn every_file_operation_killed_at_and_failing_once() {
    for names in [Names::One, Names::Two] {
        let count = run_once(names, "whole", None).operations;
        assert!(count >= 20, "{count} operations");
        for n in 0..count {
            for kind in ["kill", "error"] {
                run_once(names, &format!("{names:?}: {kind} at operation {n}"), Some(format!("{kind} {n}")));
            }
        }
        tell(&format!(
            "{count} file operations of an open, edits and saves (names: {names:?}): killed at and failing once each, \
             by the file layer"
        ));
    }
}

fn run_once(names: Names, context: &str, fault: Option<String>) -> Said {
    let place = place(names);
    let kills = fault.as_ref().is_some_and(|fault| fault.starts_with("kill"));
    let mut running = start("once", &place, fault);
    running.go();
    running.go();
    let (said, status) = running.end();
    assert!(status.success() || kills, "{context}: {said:?}");
    check_once(&place, &said, context);
    said
}

#[test]
fn every_system_call_killed_at_and_failing_once() {
    if !may_trace() {
        return tell("strace is missing or tracing is forbidden: file operations met by the file layer alone");
    }
    let mut cases = Vec::new();
    // The journal is the same for a scene with two names.
    for (thread, names) in [(Thread::Main, Names::One), (Thread::Main, Names::Two), (Thread::Journal, Names::One)] {
        let place = place(names);
        let log = place.folder.path().join("log");
        traced(&place, thread, &["-o", log.to_str().unwrap()]);
        let calls = calls(&std::fs::read_to_string(log).unwrap());
        assert!(calls.contains_key(if thread == Thread::Main { "fsync" } else { "fdatasync" }), "{calls:?}");
        for (call, count) in calls {
            for n in 1..=count {
                cases.push((thread, names, format!("inject={call}:signal=KILL:when={n}")));
                if !NEVER_FAIL.contains(&call.as_str()) {
                    cases.push((thread, names, format!("inject={call}:error=EIO:when={n}")));
                }
            }
        }
    }
    let next = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                while let Some((thread, names, inject)) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let place = place(*names);
                    let (said, status) = traced(&place, *thread, &["-o", "/dev/null", "-e", inject]);
                    let context = format!("{thread:?} {names:?} {inject}");
                    assert!(status.success() || inject.contains("KILL"), "{context}: {said:?}");
                    check_once(&place, &said, &context);
                }
            });
        }
    });
    tell(&format!(
        "{} runs: every system call of an open, edits and saves killed at and failing once, by strace",
        cases.len()
    ));
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Thread {
    Main,
    Journal,
}

fn may_trace() -> bool {
    let plain = Command::new("strace").args(["-o", "/dev/null", "true"]).stderr(Stdio::null()).status();
    plain.is_ok_and(|status| status.success())
}

/// Runs the child with one of its threads under strace.
fn traced(place: &Place, thread: Thread, arguments: &[&str]) -> (Said, ExitStatus) {
    let mut running = start("once", place, None);
    running.wait_for("OPENING");
    if thread == Thread::Journal {
        running.go();
        running.wait_for("OPENED");
    }
    let thread_id = thread_id(running.child.id(), thread);
    let mut strace = Command::new("strace");
    strace.args(arguments).args(["-p", &thread_id]).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut strace = strace.spawn().unwrap();
    let mut attached = String::new();
    let mut messages = BufReader::new(strace.stderr.take().unwrap());
    messages.read_line(&mut attached).unwrap();
    assert!(attached.contains("attached"), "{attached}");
    running.go();
    running.go();
    let ended = running.end();
    strace.wait().unwrap();
    ended
}

/// The id of a thread: the test's thread waits at a gate; the journal's has its own name.
fn thread_id(process: u32, thread: Thread) -> String {
    let tasks = PathBuf::from(format!("/proc/{process}/task"));
    let name = |id: &str| std::fs::read_to_string(tasks.join(id).join("comm")).unwrap_or_default();
    let ids = || -> Vec<String> {
        let entries = std::fs::read_dir(&tasks).unwrap().flatten();
        entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect()
    };
    match thread {
        // If tests run one at a time there is no other thread yet; otherwise the test's thread has the test's name.
        Thread::Main => ids().into_iter().find(|id| name(id).trim() == "child").unwrap_or(process.to_string()),
        // The thread sets its name a moment after it is started.
        Thread::Journal => loop {
            match ids().into_iter().find(|id| name(id).trim() == "journal") {
                Some(id) => break id,
                None => std::thread::sleep(Duration::from_millis(1)),
            }
        },
    }
}

/// How often each system call was made.
fn calls(log: &str) -> BTreeMap<String, usize> {
    let mut calls = BTreeMap::new();
    for line in log.lines().filter(|line| !line.contains(" resumed>")) {
        if let Some((name, _)) =
            line.split_once('(').filter(|(name, _)| name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_'))
        {
            *calls.entry(name.to_owned()).or_default() += 1;
        }
    }
    calls
}

/// Prints a line that the test harness does not capture.
fn tell(line: &str) {
    let _ = writeln!(std::io::stderr(), "durability: {line}");
}

#[test]
fn after_a_failed_sync_another_file_is_written() {
    if !may_trace() {
        return tell("strace is missing or tracing is forbidden: a failed sync of the journal was not seen alone");
    }
    // A writer that tries again before anybody asks has nothing to tell any more; that is rare.
    let told = (0..10).find_map(|_| {
        let place = place(Names::One);
        let inject = ["-o", "/dev/null", "-e", "inject=fdatasync:error=EIO:when=1"];
        let (said, _) = traced(&place, Thread::Journal, &inject);
        check_once(&place, &said, "a failed sync");
        said.failing
    });
    let failing = told.expect("the failure is told");
    assert!(failing.contains("Input/output") && failing.ends_with("then Ok(()) with another file: true"), "{failing}");
}

/// The order of a save: the new file is on the disk before it takes the old one's place, and its name after.
#[test]
fn a_save_syncs_before_and_after_the_rename() {
    if !may_trace() {
        return tell("strace is missing or tracing is forbidden: the order of a save was not seen");
    }
    let place = place(Names::One);
    let log = place.folder.path().join("log");
    traced(&place, Thread::Main, &["-y", "-o", log.to_str().unwrap()]);
    let log = std::fs::read_to_string(log).unwrap();
    let steps: Vec<&str> = log.lines().filter_map(|line| save_step(line, place.folder.path())).collect();
    let one = ["sync file", "rename", "sync folder"];
    assert!(steps.windows(3).filter(|w| *w == one).count() == 2, "{steps:?}");
}

fn save_step<'a>(line: &'a str, folder: &Path) -> Option<&'a str> {
    let folder = format!("<{}>", folder.canonicalize().unwrap().display());
    match line.split_once('(')?.0 {
        "rename" | "renameat" | "renameat2" => Some("rename"),
        "fsync" if line.contains(&folder) => Some("sync folder"),
        "fsync" if line.contains(".tmp>") => Some("sync file"),
        _ => None,
    }
}
