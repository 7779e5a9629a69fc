#!/usr/bin/env python3
"""The editor in a terminal of its own: how soon a key is on the screen, and how many bytes a second playing sends.

    scripts/benches/screen.py               # builds plica in release
    scripts/benches/screen.py PLICA         # measures this one

The goals: a key at 200x60 in a scene of 10,000 anchors within 10 ms (95 of 100 keys); playing a demo at 120x40 in half
blocks below 60 kB a second. Needs python3 alone.
"""
import fcntl
import json
import os
import pathlib
import pty
import select
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent

# Output that pauses for so long has come to its end.
PAUSE_S = 0.003

# Keys in the table of anchors, and what they are.
KEYS = [("j", "next row"), ("\x04", "half a page"), ("+", "step a number"), ("l", "next column"), ("u", "undo")]


class Editor:
    """The editor on a scene, in a terminal that answers what it is asked for and has no graphics."""

    def __init__(self, plica, scene, columns, rows):
        self.pid, self.terminal = pty.fork()
        if self.pid == 0:
            os.environ.update(TERM="xterm-256color", COLORTERM="truecolor", XDG_STATE_HOME=str(scene.parent / "state"))
            os.execv(plica, [plica, "edit", "--no-view", str(scene)])
        fcntl.ioctl(self.terminal, termios.TIOCSWINSZ, struct.pack("4H", rows, columns, 0, 0))

    def read(self, patience_s):
        """What comes within so long; nothing if nothing does."""
        if not select.select([self.terminal], [], [], patience_s)[0]:
            return b""
        said = os.read(self.terminal, 1 << 16)
        for _ in range(said.count(b"\x1b[5n")):
            os.write(self.terminal, b"\x1b[?62c\x1b[0n")
        return said

    def settle(self, patience_s):
        """Reads until nothing comes for so long."""
        while self.read(patience_s):
            pass

    def press(self, keys):
        os.write(self.terminal, keys.encode())

    def answered_ms(self, key):
        """How long after a key the screen is drawn."""
        begun = time.perf_counter()
        self.press(key)
        shown, patience_s = begun, 1.0
        while self.read(patience_s):
            shown, patience_s = time.perf_counter(), PAUSE_S
        return (shown - begun) * 1e3

    def played(self, seconds):
        """Bytes that come meanwhile."""
        end, count = time.perf_counter() + seconds, 0
        while (left := end - time.perf_counter()) > 0:
            count += len(self.read(left))
        return count

    def end(self):
        os.kill(self.pid, signal.SIGKILL)
        os.close(self.terminal)
        os.waitpid(self.pid, 0)


def anchors(folder, count):
    """A scene of so many anchors."""
    shutil.copy(ROOT / "profiles/cat/cat.png", folder)
    points = [{"tool": "point", "at": [4 * (i % 120), 4 * (i // 120)], "jump": [i % 7 - 3, i % 5 - 2]} for i in range(count)]
    outline = {"kind": "rectangle", "x": 0, "y": 0, "width": 480, "height": 400}
    layer = {"kind": "picture", "name": "cat", "image": "cat", "zones": [{"name": "all", "outline": outline, "motion": points}]}
    scene = folder / "anchors.plica.json"
    scene.write_text(json.dumps({"plica": 1, "images": {"cat": {"path": "cat.png"}}, "layers": [layer]}))
    return scene


def keys(plica, folder):
    editor = Editor(plica, anchors(folder, 10_000), 200, 60)
    editor.settle(3)
    editor.press(":go layers.cat.zones.all.motion\r")
    editor.settle(3)
    for key, name in KEYS:
        taken = []
        for _ in range(60):
            taken.append(editor.answered_ms(key))
            editor.settle(0.15)
        taken.sort()
        print(f"{name:<16} {taken[len(taken) // 2]:6.1f} ms median, {taken[len(taken) * 95 // 100]:6.1f} ms of 95 in 100", flush=True)
    editor.end()


def playing(plica, folder):
    for demo in ["blink", "waves", "fire"]:
        shutil.copytree(ROOT / "profiles" / demo, folder / demo)
        editor = Editor(plica, folder / demo / f"{demo}.plica.json", 120, 40)
        editor.settle(3)
        editor.press("P")
        editor.played(1)
        print(f"playing {demo:<8} {editor.played(5) / 5e3:6.1f} kB a second", flush=True)
        editor.end()


def main():
    plica = sys.argv[1] if len(sys.argv) > 1 else ROOT / "target/release/plica"
    if len(sys.argv) < 2:
        subprocess.run(["cargo", "build", "--release", "--locked", "--bin", "plica"], cwd=ROOT, check=True)
    with tempfile.TemporaryDirectory() as folder:
        keys(str(plica), pathlib.Path(folder))
        playing(str(plica), pathlib.Path(folder))


if __name__ == "__main__":
    main()
