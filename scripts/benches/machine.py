"""Where things are, the programs that are measured, and the time and memory that they take."""
import json
import os
import pathlib
import re
import resource
import subprocess
import sys
from dataclasses import dataclass
from typing import Callable

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PEERS = pathlib.Path(os.environ.get("PLICA_PEERS", ROOT.parent / "shared/bench/peers"))
PLACE = ROOT / "target/peers"
PACKAGES = ["numpy", "numba", "opencv-python-headless<5", "pillow"]


@dataclass
class Row:
    """One line: what is done, to what, the goal, and what measures it and gives the rest of the line."""
    name: str
    of: str
    goal: str
    measure: Callable[["Programs"], str]


def cells(ours, peer="-", more=""):
    """The rest of a line."""
    shown = [f"{value:.1f}" if isinstance(value, float) else str(value) for value in (ours, peer)]
    return f"{shown[0]:>9}{shown[1]:>9}  {more}".rstrip()


def python():
    """Goes on in an environment that has numpy and the peers' packages."""
    wanted = PLACE / "bin/python"
    if not PEERS.is_dir():
        sys.exit(f"scripts/bench: no peers in {PEERS} (PLICA_PEERS names their folder)")
    if pathlib.Path(sys.prefix) != PLACE:
        if not wanted.exists():
            subprocess.run([sys.executable, "-m", "venv", PLACE], check=True)
        subprocess.run([wanted, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *PACKAGES], check=True)
        os.execv(wanted, [str(wanted), *sys.argv])
    sys.path.insert(0, str(PEERS))


class Programs:
    """What is measured: benches/work.rs and plica itself, in release."""

    def __init__(self, threads, rounds):
        self.threads, self.rounds = threads, rounds
        command = ["cargo", "build", "--release", "--locked", "--bench", "work", "--bin", "plica", "--message-format", "json-render-diagnostics"]
        out = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout
        built = [json.loads(line) for line in out.splitlines() if '"compiler-artifact"' in line]
        found = {one["target"]["name"]: one["executable"] for one in built if one["executable"]}
        self.work, self.plica = found["work"], found["plica"]

    def run(self, command):
        """Runs a program of ours; CPU seconds, and the most memory that it had, in bytes."""
        child = subprocess.Popen(list(map(str, command)), env={**os.environ, "RAYON_NUM_THREADS": str(self.threads)},
                                 stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        said = child.stderr.read()
        _, status, used = os.wait4(child.pid, 0)
        if status:
            sys.exit(f"scripts/bench: {' '.join(map(str, command))}\n{said}")
        return used.ru_utime + used.ru_stime, used.ru_maxrss * 1024

    def each(self, kind, scene, many=6):
        """Milliseconds of CPU time of one piece of work, without what it takes to open the scene."""
        few = 1
        taken = [self.run([self.work, kind, scene, count])[0] for count in (many, few)]
        return (taken[0] - taken[1]) / (many - few) * 1e3

    def peer(self, script, name, size, *more):
        """What a peer says of itself; empty if it is not there, or too slow."""
        command = [sys.executable, PEERS / script, "--peer", name, "--size", "x".join(map(str, size)), "--threads", self.threads, *more]
        done = subprocess.run(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        return dict(re.findall(r"(\w+)=(\S+)", done.stdout))

    def paired(self, ours, peer_name, peer):
        """Both in turns, in milliseconds; the peer's is None if it did not run, or there is none."""
        taken = [(ours(), peer() if peer_name else None) for _ in range(self.rounds)]
        least = min(mine for mine, _ in taken)
        others = [other for _, other in taken if other]
        if not others:
            return cells(least, more=f"{peer_name} did not run" if peer_name else "no peer of this")
        ratios = sorted(other / mine for mine, other in taken if other)
        return cells(least, min(others), f"{ratios[0]:.2f} .. {ratios[-1]:.2f} ({peer_name})")
