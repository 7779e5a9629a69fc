"""Scenes with the peers' input. Their pixels are at whole coordinates, ours half a pixel on."""
import json

import common  # of the peers
import cv2
import numpy

from .machine import PLACE


def scene(name, size, zone, picture=None, field=None, timeline=None, picture_name="picture.png"):
    """The file of a scene of one zone over a picture, which is black if none is given; `field` are jumps pixel by pixel."""
    folder = PLACE / "scenes" / name
    folder.mkdir(parents=True, exist_ok=True)
    width, height = size
    if field is not None:
        head = b"PIEH" + numpy.array([width, height], "<i4").tobytes()
        (folder / "field.flo").write_bytes(head + field.astype("<f4").tobytes())
        zone = {**zone, "motion": [{"tool": "field", "path": "field.flo"}]}
    cv2.imwrite(str(folder / picture_name), numpy.zeros((height, width, 3), numpy.uint8) if picture is None else picture)
    whole = {"kind": "rectangle", "x": 0, "y": 0, "width": width, "height": height}
    zone = {"name": "all", "outline": whole, "position": {"function": "linear"}, **zone}
    scene = {"plica": 1, "timeline": timeline or {"duration": 1}, "images": {"picture": {"path": picture_name}},
             "layers": [{"kind": "picture", "name": "all", "image": "picture", "zones": [zone]}]}
    (folder / "scene.json").write_text(json.dumps(scene))
    return folder / "scene.json"


def points(size, anchors):
    """The peers' anchors."""
    places, jumps = common.anchors(*size, anchors)
    return [{"tool": "point", "at": [x + 0.5, y + 0.5], "jump": [u, v]}
            for (x, y), (u, v) in zip(places.tolist(), jumps.tolist())]


def interpolation(method, size, anchors):
    """A method by the name that the peers have for it."""
    radius = common.radius(*size, anchors)
    return {"shepard": {"method": "shepard"}, "tps": {"method": "thin-plate"}, "rigid": {"method": "rigid"},
            "msm": {"method": "modified-shepard", "radius": radius},
            "msm-random": {"method": "modified-shepard-random", "radius": radius, "ring": radius / 5}}[method]


def interpolated(size, anchors, method, **more):
    """A zone of anchors."""
    zone = {"motion": points(size, anchors), "interpolation": interpolation(method, size, anchors), **more}
    regions = len(more.get("fold", {}).get("regions", []))
    return scene(f"field-{size[0]}x{size[1]}-{anchors}-{method}-{regions}", size, zone)


def star(size, corners, scale):
    """The peers' polygon as an outline."""
    return {"kind": "polygon", "points": (common.star(*size, corners, scale) + 0.5).tolist()}


def regions(size, count):
    """So many circles, all of them together a ninth of the picture."""
    width, height = size
    side = int(numpy.ceil(numpy.sqrt(count)))
    radius = numpy.sqrt(width * height / 9 / count / numpy.pi)
    at = [(width * (k % side + 0.5) / side, height * (k // side + 0.5) / side) for k in range(count)]
    return {"rule": "cover", "regions": [{"kind": "ellipse", "center": [x, y], "radii": [radius, radius]} for x, y in at]}
