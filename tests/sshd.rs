//! Across a real ssh: an sshd on 127.0.0.1 with throw-away keys, an editor in a terminal through it, and a window
//! opened by the line that the editor shows. If sshd is missing the reason is printed; in CI that is a failure.
#![cfg(all(feature = "tui", feature = "window"))]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use portable_pty::{CommandBuilder, PtySize, native_pty_system};

mod display;
use display::{BAR, Display, PATIENCE};

fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let began = Instant::now();
    while !holds() {
        assert!(began.elapsed() < PATIENCE, "waited in vain for {what}");
        std::thread::sleep(Duration::from_millis(30));
    }
}

fn find(tool: &str) -> Option<PathBuf> {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::env::split_paths(&folders).chain(["/usr/sbin".into(), "/sbin".into()]);
    let found = folders.map(|folder| folder.join(tool)).find(|path| path.exists());
    if found.is_none() {
        assert!(std::env::var_os("CI").is_none(), "in CI {tool} has to be installed");
        let _ = writeln!(std::io::stderr(), "not run: {tool} is not installed");
    }
    found
}

/// A process that is killed when the value is dropped.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The remote machine: its sshd, its scene, and the program that connects to it.
struct Far {
    folder: tempfile::TempDir,
    _sshd: Running,
    ssh: PathBuf,
    scene: PathBuf,
}

fn far() -> Option<Far> {
    let (sshd, _, _) = (find("sshd")?, find("ssh")?, find("ssh-keygen")?);
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    // sshd started by root needs the folder that its service would have made.
    let _ = std::fs::create_dir_all("/run/sshd");
    for key in ["host", "user"] {
        let made = Command::new("ssh-keygen").args(["-q", "-t", "ed25519", "-N", "", "-f", &at(key)]).status();
        assert!(made.unwrap().success());
    }
    std::fs::create_dir(at("run")).unwrap();
    let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let config = format!(
        "Port {port}\nListenAddress 127.0.0.1\nHostKey {}\nAuthorizedKeysFile {}\nPidFile none\nUsePAM no\nStrictModes no\n\
         PasswordAuthentication no\nPermitRootLogin prohibit-password\nSetEnv XDG_RUNTIME_DIR={} XDG_STATE_HOME={}\n",
        at("host"),
        at("user.pub"),
        at("run"),
        at("state")
    );
    std::fs::write(at("config"), config).unwrap();
    let log = std::fs::File::create(at("log")).unwrap();
    let process = Command::new(sshd).args(["-D", "-e", "-f", &at("config")]).stderr(log).spawn().unwrap();
    let sshd = Running(process);
    let host_key = std::fs::read_to_string(at("host.pub")).unwrap();
    std::fs::write(at("known"), format!("[127.0.0.1]:{port} {host_key}")).unwrap();
    let options = format!(
        "-F /dev/null -i '{}' -o IdentitiesOnly=yes -o BatchMode=yes -o UserKnownHostsFile='{}'",
        at("user"),
        at("known")
    );
    std::fs::write(at("ssh"), format!("#!/bin/sh\nexec ssh {options} -p {port} \"$@\"\n")).unwrap();
    std::fs::set_permissions(at("ssh"), std::fs::Permissions::from_mode(0o755)).unwrap();
    until("sshd", || TcpStream::connect(("127.0.0.1", port)).is_ok());
    let (ssh, scene) = (at("ssh").into(), folder.path().join("a scene.plica.json"));
    Some(Far { folder, _sshd: sshd, ssh, scene })
}

impl Far {
    fn paint(&self, name: &str, color: [u8; 3]) {
        image::RgbImage::from_pixel(64, 64, image::Rgb(color)).save(self.folder.path().join(name)).unwrap();
    }

    /// A window here, by the line that a person would type where ssh is set up.
    fn window(&self, display: &Display, address: &str) -> Running {
        let window = Command::new(env!("CARGO_BIN_EXE_plica"))
            .args(["view", address, "--remote-plica", env!("CARGO_BIN_EXE_plica")])
            .env("PLICA_SSH", &self.ssh)
            .env("DISPLAY", &display.name)
            .env("XDG_CACHE_HOME", self.folder.path().join("cache"))
            .env("XDG_RUNTIME_DIR", self.folder.path().join("here"))
            .env_remove("WAYLAND_DISPLAY")
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .spawn();
        Running(window.unwrap())
    }
}

/// An editor on the remote machine, in a terminal here, through ssh.
struct Editor {
    child: Box<dyn portable_pty::Child + Send + Sync>,
    keys: Box<dyn Write + Send>,
    seen: Arc<Mutex<vt100::Parser>>,
    _master: Box<dyn portable_pty::MasterPty + Send>,
}

impl Editor {
    fn open(far: &Far) -> Editor {
        let size = PtySize { rows: 24, cols: 160, pixel_width: 0, pixel_height: 0 };
        let pair = native_pty_system().openpty(size).unwrap();
        let mut command = CommandBuilder::new(&far.ssh);
        command.env("TERM", "xterm-256color");
        let line = format!("env -u DISPLAY {} edit '{}'", env!("CARGO_BIN_EXE_plica"), far.scene.display());
        command.args(["-tt", "127.0.0.1", "--", &line]);
        let child = pair.slave.spawn_command(command).unwrap();
        let seen = Arc::new(Mutex::new(vt100::Parser::new(24, 160, 0)));
        let (mut output, parser) = (pair.master.try_clone_reader().unwrap(), seen.clone());
        std::thread::spawn(move || {
            let mut bytes = [0; 4096];
            while let Ok(n @ 1..) = output.read(&mut bytes) {
                parser.lock().unwrap().process(&bytes[..n]);
            }
        });
        Editor { child, keys: pair.master.take_writer().unwrap(), seen, _master: pair.master }
    }

    /// Where the editor says that its scene is, once it is there.
    fn address(&self) -> String {
        let screen = self.wait_for("plica view ssh://");
        let (_, address) = screen.split_once("plica view ").unwrap();
        address.split([' ', ';']).next().unwrap().to_owned()
    }

    fn press(&mut self, keys: &str) {
        self.keys.write_all(keys.as_bytes()).unwrap();
        self.keys.flush().unwrap();
    }

    fn wait_for(&self, text: &str) -> String {
        let screen = || self.seen.lock().unwrap().screen().contents();
        let began = Instant::now();
        while !screen().contains(text) {
            assert!(began.elapsed() < PATIENCE, "no {text:?} on the screen:\n{}", screen());
            std::thread::sleep(Duration::from_millis(20));
        }
        screen()
    }
}

impl Drop for Editor {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The color in the middle of the display.
fn middle(display: &Display, shot: &Path) -> [u8; 3] {
    display.tool("import", &["-window", "root", &shot.display().to_string()]);
    let Ok(image) = image::open(shot) else { return [0; 3] };
    let search = ["search", "--onlyvisible", "--name", "plica", "getwindowgeometry", "--shell"];
    let found = String::from_utf8(display.tool("xdotool", &search)).unwrap();
    let number = |name: &str| found.lines().find_map(|line| line.strip_prefix(name)?.parse::<usize>().ok());
    let all = (number("X="), number("Y="), number("WIDTH="), number("HEIGHT="));
    let (Some(x), Some(y), Some(width), Some(height)) = all else { return [0; 3] };
    image.to_rgb8().get_pixel((x + width / 2) as u32, (y + (height - BAR) / 2) as u32).0
}

#[test]
fn an_edit_on_a_server_moves_the_window_here() {
    let (Some(far), Some(display)) = (far(), Display::open()) else { return };
    far.paint("red.png", [200, 30, 30]);
    far.paint("blue.png", [30, 30, 200]);
    let layer = serde_json::json!({"kind": "picture", "name": "l", "image": "cat"});
    let scene = serde_json::json!({"plica": 1, "images": {"cat": {"path": "red.png"}}, "layers": [layer]});
    std::fs::write(&far.scene, scene.to_string()).unwrap();
    let mut editor = Editor::open(&far);
    let address = &editor.address();
    assert!(address.contains("@127.0.0.1") && address.ends_with("a%20scene.plica.json"), "{address}");
    let cache = far.folder.path().join("cache");
    let _window = far.window(&display, address);
    let shot = far.folder.path().join("shot.png");
    until("red in the window", || middle(&display, &shot) == [200, 30, 30]);
    editor.wait_for("window: connected");
    editor.press(":set images.cat.path=blue.png\r");
    until("blue in the window", || middle(&display, &shot) == [30, 30, 200]);
    // Another program saves the picture on the remote machine.
    far.paint("new.png", [30, 200, 30]);
    std::fs::rename(far.folder.path().join("new.png"), far.folder.path().join("blue.png")).unwrap();
    until("green in the window", || middle(&display, &shot) == [30, 200, 30]);
    assert_eq!(std::fs::read_dir(cache.join("plica/images")).unwrap().count(), 3, "each picture once");
    editor.press(":q!\r");
    until("the end of the editor", || editor.child.try_wait().unwrap().is_some());
    let set =
        Command::new(env!("CARGO_BIN_EXE_plica")).arg("set").arg(&far.scene).arg("images.cat.path=red.png").status();
    assert!(set.unwrap().success());
    until("red again, by the file", || middle(&display, &shot) == [200, 30, 30]);
}

#[test]
fn the_camera_of_the_window_here_is_taken_there() {
    let (Some(far), Some(display)) = (far(), Display::open()) else { return };
    std::fs::write(far.folder.path().join("m.obj"), "v -2 -1 0\nv 2 -1 0\nv 0 3 0\nf 1 2 3\n").unwrap();
    let layer = serde_json::json!({"kind": "mesh", "name": "m", "mesh": "m", "sides": "both"});
    let scene = serde_json::json!({"plica": 1, "camera": {}, "meshes": {"m": {"path": "m.obj"}}, "layers": [layer]});
    std::fs::write(&far.scene, scene.to_string()).unwrap();
    let mut editor = Editor::open(&far);
    let _window = far.window(&display, &editor.address());
    let shot = far.folder.path().join("shot.png");
    editor.wait_for("window: connected");
    until("the mesh in the window", || middle(&display, &shot)[0] > 100);
    display.tool("xdotool", &["search", "--onlyvisible", "--name", "plica", "windowfocus", "--sync"]);
    display.tool("xdotool", &["key", "6"]);
    editor.press(":camera take\r");
    editor.wait_for("the window's camera is the scene's now");
    editor.press(":w\r");
    let camera = || {
        let text = std::fs::read(&far.scene).unwrap();
        serde_json::from_slice::<serde_json::Value>(&text).unwrap()["camera"].clone()
    };
    until("the camera in the file", || camera()["position"].is_array());
    assert!(camera()["position"][0].as_f64().unwrap().abs() > 0.1, "{}", camera());
    editor.press(":q\r");
    until("the end of the editor", || editor.child.try_wait().unwrap().is_some());
}

#[test]
fn no_plica_and_no_scene_there_are_told_in_one_line() {
    let Some(far) = far() else { return };
    for (remote, reason) in
        [("/no/such/plica", "--remote-plica"), (env!("CARGO_BIN_EXE_plica"), "there is no such scene")]
    {
        let view = Command::new(env!("CARGO_BIN_EXE_plica"))
            .args(["view", "ssh://127.0.0.1/no/such.plica.json", "--remote-plica", remote])
            .env("PLICA_SSH", &far.ssh)
            .env("XDG_CACHE_HOME", far.folder.path().join("cache"))
            .output()
            .unwrap();
        let said = String::from_utf8(view.stderr).unwrap();
        assert!(!view.status.success() && said.lines().count() == 1 && said.contains(reason), "{said}");
    }
}
