"""How time grows with what a field is made of: the exponent of a line through measured times, both as logarithms."""
import numpy

from . import scenes
from .machine import Row, cells

METHODS = ["shepard", "msm", "msm-random", "tps", "rigid"]
SIZES = [(480, 270), (960, 540), (1920, 1080)]
ANCHORS = [100, 300, 1000, 3000]
REGIONS = [1, 4, 16, 64]
MIDDLE = (960, 540)


def rows():
    for method in METHODS:
        by = {
            "pixels": [(w * h, lambda size=(w, h): scenes.interpolated(size, 94, method)) for w, h in SIZES],
            "anchors": [(n, lambda n=n: scenes.interpolated(MIDDLE, n, method)) for n in ANCHORS if method != "tps" or n <= 1000],
            "regions": [(n, lambda n=n: scenes.interpolated(MIDDLE, 94, method, fold=scenes.regions(MIDDLE, n))) for n in REGIONS],
        }
        for what, cases in by.items():
            yield Row(f"growth with {what}", method, "", lambda programs, cases=cases: exponent(programs, cases))


def exponent(programs, cases):
    counts = [count for count, _ in cases]
    made = [scene() for _, scene in cases]
    taken = [min(programs.each("field", scene) for _ in range(programs.rounds)) for scene in made]
    slope = numpy.polyfit(numpy.log(counts), numpy.log(numpy.maximum(taken, 1e-3)), 1)[0]
    return cells(f"^{slope:.2f}", more=", ".join(f"{count}: {time:.1f} ms" for count, time in zip(counts, taken)))
