"""Work that others do too."""
import common  # of the peers
import numpy

from . import scenes
from .machine import Row

FULL_HD, UHD = (1920, 1080), (3840, 2160)

# Name, size, anchors, method as the peers call it, peer, goal in ms of CPU time on one thread.
FIELDS = [
    ("exact Shepard", FULL_HD, 94, "shepard", "numba", 5),
    ("exact Shepard", FULL_HD, 1000, "shepard", "numba", 10),
    ("exact Shepard", FULL_HD, 10000, "shepard", "numba", 40),
    ("exact Shepard", UHD, 94, "shepard", "numba", 18),
    ("modified Shepard", FULL_HD, 94, "msm", "numba", 7),
    ("modified Shepard, random", FULL_HD, 94, "msm-random", None, 7),
    ("thin plate", FULL_HD, 94, "tps", None, 30),
    ("thin plate", FULL_HD, 1000, "tps", None, 60),
    ("rigid", FULL_HD, 94, "rigid", None, 15),
]
FRAMES = [("frame, every pixel moves", FULL_HD, 9), ("frame, every pixel moves", UHD, 35)]
CORNERS = 24


def rows():
    yield from (Row(name, f"{named(size)} {anchors}", str(goal), lambda p, row=(size, anchors, method, peer): field(p, *row))
                for name, size, anchors, method, peer, goal in FIELDS)
    yield Row("zone mask", f"{named(FULL_HD)} {CORNERS}", "0.5", mask)
    yield Row("thresholds", f"{named(FULL_HD)} {CORNERS}", "3", thresholds)
    yield from (Row(name, named(size), str(goal), lambda p, size=size: frame(p, size)) for name, size, goal in FRAMES)


def named(size):
    return "x".join(map(str, size))


def field(programs, size, anchors, method, peer):
    scene = scenes.interpolated(size, anchors, method)
    wrong = check(programs, scene, size, anchors, method)
    more = ["--n", anchors, "--method", method]
    return wrong or paired(programs, lambda: programs.each("field", scene), "field.py", peer, size, *more)


def check(programs, scene, size, anchors, method):
    """What is wrong with our field, by the formula in float64; "" if nothing is, or the peers' reference does not know it."""
    if method not in ("shepard", "msm"):
        return ""
    raw = scene.with_name("field.raw")
    programs.run([programs.work, "field", scene, 1, raw])
    made = numpy.fromfile(raw, "<f4").reshape(size[1], size[0], 2)
    off = common.field_diff(made, *common.anchors(*size, anchors), method, common.radius(*size, anchors))
    return "" if off <= 1e-3 else f"  wrong by {off:.2g} px"


def mask(programs):
    scene = scenes.scene("mask", FULL_HD, {"outline": scenes.star(FULL_HD, CORNERS, 0.45)})
    ours = lambda: programs.each("mask", scene, 200)  # noqa: E731
    return paired(programs, ours, "zone.py", "cv2_fillpoly", FULL_HD, "--n", CORNERS)


def thresholds(programs):
    """What a field takes longer with a region than without."""
    jumps = common.smooth_jump(*FULL_HD)
    fold = {"fold": {"rule": "cover", "regions": [scenes.star(FULL_HD, CORNERS, 0.25)]}}
    without, with_it = (scenes.scene(f"thresholds-{len(more)}", FULL_HD, more, field=jumps) for more in ({}, fold))
    ours = lambda: programs.each("field", with_it, 21) - programs.each("field", without, 21)  # noqa: E731
    return paired(programs, ours, "zone.py", "numba_cross", FULL_HD, "--n", CORNERS)


def frame(programs, size):
    scene = scenes.scene(f"frame-{named(size)}", size, {}, common.image(*size, 4), common.smooth_jump(*size))
    return paired(programs, lambda: programs.each("frame", scene), "gather.py", "cv2_frame", size, "--ch", 4)


def paired(programs, ours, script, peer, size, *more):
    def theirs():
        said = programs.peer(script, peer, size, *more)
        return float(said["cpu_min_s"]) * 1e3 if "cpu_min_s" in said else None

    return programs.paired(ours, peer, theirs)
