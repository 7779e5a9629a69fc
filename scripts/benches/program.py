"""The program as a whole: animations, edits, how soon it is there, its memory and its size."""
import fcntl
import os
import pty
import select
import shutil
import signal
import statistics
import struct
import subprocess
import termios
import time

import common  # of the peers
import cv2
import numpy
from PIL import Image, ImageSequence

from . import scenes
from .machine import PLACE, ROOT, Row, cells
from .pairs import FULL_HD, named

# File, peer, goal.
ANIMATIONS = [
    ("clip.gif", "gifski", "1/4 peer"),
    ("clip.gif", "ffmpeg_gif", ""),
    ("clip.%04d.png", "cv2_png", "1/9 peer"),
    ("clip.apng", "ffmpeg_apng", "1.15"),
    ("clip.webp", "ffmpeg_webp_lossless", "1.15"),
]
CLIP, FRAMES = (640, 480), 60

# What is edited, and the number that goes up and down.
EDITS = [
    ("an anchor", "/layers/0/zones/0/motion/0/at/0"),
    ("the radius", "/layers/0/zones/0/interpolation/radius"),
    ("a region's point", "/layers/0/zones/0/fold/regions/0/points/0/0"),
]
EDITED = [((512, 512), 16), (FULL_HD, 40)]

# Sides of a picture, its file, and the goal in MiB.
HUGE = [((12000, 9000), "huge.jpg", 1200), ((16384, 16384), "huge.png", 3072)]


def rows():
    for file, peer, goal in ANIMATIONS:
        yield Row(f"60 frames as {file.split('.')[-1]}", named(CLIP), goal, lambda p, row=(file, peer): animation(p, *row))
    for size, goal in EDITED:
        for name, pointer in EDITS:
            yield Row(f"edit of {name}, p95", named(size), str(goal), lambda p, row=(size, pointer): edit(p, *row))
    yield Row("start: --version", "", "5", lambda p: waited(lambda: p.run([p.plica, "--version"])))
    yield Row("start: editor", "blink", "60", editor)
    yield Row("start: a frame", "blink", "150", first_frame)
    for size, file, goal in HUGE:
        yield Row("memory of a frame, MiB", named(size), str(goal), lambda p, row=(size, file): memory(p, *row))
    yield Row("size of plica, MB", "", "20", lambda p: cells(os.path.getsize(p.plica) / 1e6))


def animation(programs, file, peer):
    """CPU time of the whole command. Beside it what the peer takes for ready frames, and what drawing adds to encoding."""
    width, height = CLIP
    x, y = numpy.meshgrid(numpy.arange(width) / width - 0.5, numpy.arange(height) / height - 0.5)
    weak = numpy.clip(1.2 - 2.4 * numpy.hypot(x, y), 0, 1)[..., None]
    scene = scenes.scene("clip", CLIP, {"position": {"function": "cosine"}}, common.image(*CLIP), common.smooth_jump(*CLIP) * weak,
                         {"duration": FRAMES / 25, "fps": 25})
    for old in scene.parent.glob("clip.*"):
        old.unlink()
    render = lambda name: programs.run([programs.plica, "render", scene, "-o", scene.with_name(name), "--force"])[0] * 1e3  # noqa: E731
    bare = min(render("frames.rgba") for _ in range(programs.rounds))
    said = {}

    def theirs():
        said.update(programs.peer("encode.py", peer, CLIP, "--frames", FRAMES))
        return float(said["cpu_min_s"]) * 1e3 if "cpu_min_s" in said else None

    taken = []
    line = programs.paired(lambda: taken.append(render(file)) or taken[-1], peer, theirs)
    made = list(scene.parent.glob(file.replace("%04d", "*")))
    mine = f"{sum(path.stat().st_size for path in made) / 1e6:.2f} MB{quality(made[0], scene) if file.endswith('gif') else ''}"
    other = f"{float(said['bytes']) / 1e6:.2f} MB" + (f" {float(said['psnr_db']):.1f} dB" if "psnr_db" in said else "") if said else "?"
    least = min(taken)
    return f"{line}; {mine}, theirs {other}; {least / max(least - bare, 1e-9):.2f} of the encoder's own"


def quality(gif, scene):
    """How near an animation is to the frames, as a peak ratio of signal to noise."""
    frames = numpy.fromfile(scene.with_name("frames.rgba"), numpy.uint8).reshape(FRAMES, CLIP[1], CLIP[0], 4)[..., :3]
    shown = [numpy.asarray(frame.convert("RGB")) for frame in ImageSequence.Iterator(Image.open(gif))]
    square = numpy.mean([((a.astype(numpy.float32) - b) ** 2).mean() for a, b in zip(shown, frames)])
    return f" {10 * numpy.log10(65025 / square):.1f} dB"


def edit(programs, size, pointer):
    """From an edit to new pixels, by the clock, of a zone of 94 anchors that folds at a polygon of 24 corners."""
    fold = {"rule": "cover", "regions": [scenes.star(size, 24, 0.25)]}
    scene = scenes.interpolated(size, 94, "msm", fold=fold)
    command = [programs.work, "edit", scene, 60, pointer]
    done = subprocess.run(list(map(str, command)), env={**os.environ, "RAYON_NUM_THREADS": str(programs.threads)},
                          stdout=subprocess.PIPE, text=True, check=True)
    taken = sorted(map(float, done.stdout.split()))
    return cells(taken[len(taken) * 95 // 100], more=f"median {statistics.median(taken):.1f}")


def waited(do, times=11):
    """How long something takes by the clock."""
    taken = []
    for _ in range(times):
        begun = time.perf_counter()
        do()
        taken.append((time.perf_counter() - begun) * 1e3)
    return cells(statistics.median(taken), more=f"{min(taken):.1f} .. {max(taken):.1f}")


def demo():
    """A copy of a demo, since the editor keeps a journal beside a scene."""
    folder = PLACE / "scenes/blink"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(ROOT / "profiles/blink", folder)
    return folder / "blink.plica.json"


def first_frame(programs):
    scene = demo()
    command = [programs.plica, "render", scene, "-o", scene.with_name("first.png"), "--frames", "0", "--force"]
    return waited(lambda: programs.run(command))


def editor(programs):
    """Until the screen of the editor shows the scene, in a terminal without graphics that answers at once."""
    scene = demo()

    def opened():
        pid, terminal = pty.fork()
        if pid == 0:
            os.environ.update(TERM="xterm-256color", XDG_STATE_HOME=str(PLACE / "state"))
            os.execv(programs.plica, [programs.plica, "edit", str(scene)])
        fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("4H", 40, 120, 0, 0))
        shown = b""
        while b"lashes" not in shown and select.select([terminal], [], [], 10)[0]:
            said = os.read(terminal, 1 << 16)
            os.write(terminal, b"\x1b[?62c\x1b[0n" * said.count(b"\x1b[5n"))
            shown += said
        os.kill(pid, signal.SIGKILL)
        os.close(terminal)
        os.waitpid(pid, 0)

    return waited(opened)


def memory(programs, size, file):
    """The most that rendering a frame of a picture of this size takes, of a zone in its middle."""
    width, height = size
    small = common.image(width // 16, height // 16)
    middle = {"kind": "ellipse", "center": [width / 2, height / 2], "radii": [width / 8, height / 8]}
    zone = {"outline": middle, "motion": [{"tool": "point", "at": [width / 2, height / 2], "jump": [200, 0]}]}
    scene = scenes.scene(f"huge-{width}", size, zone, cv2.resize(small, size), picture_name=file)
    command = [programs.plica, "render", scene, "-o", scene.with_name("frame.png"), "--frames", "0", "--force"]
    seconds, most = programs.run(command)
    return cells(most / 2**20, more=f"{seconds:.1f} s of CPU time")
