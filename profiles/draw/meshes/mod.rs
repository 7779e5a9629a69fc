//! The meshes of the demo scenes, by the file they are committed as: OBJ text with texture coordinates and normals. The
//! front is +z, and the middle of a picture is there.

use std::fmt::Write;

mod terrain;
mod turned;

use plica::base::maths::{TAU, cos, sin};

/// The file, relative to the project's root, and the function that writes it.
pub const MESHES: &[(&str, fn() -> String)] = &[
    ("profiles/ball/ball.obj", ball),
    ("profiles/mug/mug.obj", mug),
    ("profiles/mug/print.obj", print),
    ("profiles/vase/vase.obj", turned::vase),
    ("profiles/fish/fish.obj", turned::fish),
    ("profiles/falls/cliff.obj", terrain::cliff),
    ("profiles/falls/pool.obj", terrain::pool),
    ("profiles/falls/stones.obj", terrain::stones),
];

/// Half a turn.
const HALF: f64 = TAU / 2.0;

type Xyz = [f64; 3];

/// A corner: its position, texture coordinates and normal.
#[derive(Clone, Copy)]
struct Vertex {
    position: Xyz,
    uv: [f64; 2],
    normal: Xyz,
}

/// A mesh in the making.
#[derive(Default)]
struct Obj {
    vertices: Vec<Vertex>,
    faces: String,
}

impl Obj {
    /// Adds a sheet of rows and columns of faces; `vertex` gives its corners, by row and column.
    fn sheet(&mut self, rows: usize, columns: usize, vertex: impl Fn(usize, usize) -> Vertex) {
        let first = self.vertices.len();
        self.vertices.extend((0..=rows).flat_map(|i| (0..=columns).map(move |j| (i, j))).map(|(i, j)| vertex(i, j)));
        let at = |i: usize, j: usize| first + i * (columns + 1) + j;
        for (i, j) in (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))) {
            self.face([at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]);
        }
    }

    /// Adds a face, counter-clockwise as seen from where its normals point. Corners at one place are one corner.
    fn face(&mut self, corners: [usize; 4]) {
        let place = |corner: usize| self.vertices[corner].position.map(short);
        let mut corners: Vec<usize> =
            (0..4).filter(|&i| place(corners[i]) != place(corners[(i + 1) % 4])).map(|i| corners[i]).collect();
        let [a, b, c] = [corners[0], corners[1], corners[2]].map(|corner| self.vertices[corner].position);
        let facing = cross(less(b, a), less(c, a));
        if dot(facing, self.vertices[corners[0]].normal) < 0.0 {
            corners.reverse();
        }
        let named = corners.iter().map(|corner| corner + 1).map(|n| format!(" {n}/{n}/{n}")).collect::<String>();
        let _ = writeln!(self.faces, "f{named}");
    }

    fn text(self) -> String {
        let row = |key: &str, numbers: &[f64]| {
            let numbers = numbers.iter().map(|&number| format!(" {}", short(number)));
            format!("{key}{}\n", numbers.collect::<String>())
        };
        let positions = self.vertices.iter().map(|vertex| row("v", &vertex.position));
        let uvs = self.vertices.iter().map(|vertex| row("vt", &vertex.uv));
        let normals = self.vertices.iter().map(|vertex| row("vn", &vertex.normal.map(|v| (v * 1e3).round() / 1e3)));
        positions.chain(uvs).chain(normals).collect::<String>() + &self.faces
    }
}

/// A number with few digits.
fn short(number: f64) -> f64 {
    // With 0 added, -0 is 0.
    (number * 1e5).round() / 1e5 + 0.0
}

fn less(a: Xyz, b: Xyz) -> Xyz {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Xyz, b: Xyz) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Xyz, b: Xyz) -> Xyz {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: Xyz) -> Xyz {
    let length = dot(a, a).sqrt();
    a.map(|v| v / length)
}

fn share(i: usize, of: usize) -> f64 {
    i as f64 / of as f64
}

/// A ball for a picture of 480 x 360: undistorted in front, and pressed together towards its edges behind, so that nothing
/// repeats.
fn ball() -> String {
    const PX_PER_RADIAN: f64 = 172.0;
    // How much of a side of the picture is used, from its middle.
    let pressed = |px: f64, most: f64| most * sin((px / most).clamp(-HALF / 2.0, HALF / 2.0));
    let mut obj = Obj::default();
    let (rows, columns) = (24, 56);
    obj.sheet(rows, columns, |i, j| {
        let (away, round) = (HALF * share(i, rows), TAU * share(j, columns));
        let (across, up) = (cos(round), sin(round));
        let position = [sin(away) * across, sin(away) * up, cos(away)];
        let px = PX_PER_RADIAN * away;
        let uv = [0.5 + pressed(px * across, 236.0) / 480.0, 0.5 + pressed(px * up, 176.0) / 360.0];
        Vertex { position, uv, normal: position }
    });
    obj.text()
}

/// The mug's radius and height, and the thickness of its wall, in meters.
const RADIUS: f64 = 0.04;
const HEIGHT: f64 = 0.095;
const WALL: f64 = 0.004;

/// A mug with its handle to the right.
fn mug() -> String {
    let mut obj = Obj::default();
    let (profile, columns) = (profile(), 56);
    obj.sheet(profile.len() - 1, columns, |i, j| {
        let ([r, y], [out, up]) = profile[i];
        let (x, z) = (sin(TAU * share(j, columns)), cos(TAU * share(j, columns)));
        Vertex { position: [r * x, y, r * z], uv: [share(j, columns), y / HEIGHT], normal: [out * x, up, out * z] }
    });
    // A tube of half an ellipse; its ends are in the wall.
    let (rows, columns) = (20, 14);
    obj.sheet(rows, columns, |i, j| {
        let (along, round) = (HALF * (share(i, rows) - 0.5), TAU * share(j, columns));
        let (width, height, thick, broad) = (0.026, 0.029, 0.0042, 0.0058);
        let out = unit([cos(along) / width, sin(along) / height, 0.0]);
        let middle = [RADIUS - 0.002 + width * cos(along), HEIGHT / 2.0 + height * sin(along)];
        let (across, aside) = (cos(round), sin(round));
        let position = [middle[0] + thick * across * out[0], middle[1] + thick * across * out[1], broad * aside];
        let normal = unit([out[0] * across / thick, out[1] * across / thick, aside / broad]);
        Vertex { position, uv: [share(i, rows), share(j, columns)], normal }
    });
    obj.text()
}

/// The mug from the middle of its bottom, up its side, over its rim and down to the middle inside: places by distance from
/// the axis and height, and normals.
fn profile() -> Vec<([f64; 2], [f64; 2])> {
    let (foot, floor, corner) = (0.006, 0.006, 0.012);
    // Arcs: the middle, the radius, which side is outside, from and to in quarters, and in how many steps.
    let arcs = [
        ([RADIUS - foot, foot], foot, 1.0, [-1.0, 0.0], 4),
        ([RADIUS - WALL / 2.0, HEIGHT - WALL / 2.0], WALL / 2.0, 1.0, [0.0, 2.0], 6),
        ([RADIUS - WALL - corner, floor + corner], corner, -1.0, [0.0, -1.0], 4),
    ];
    let mut all = vec![([0.0, 0.0], [0.0, -1.0])];
    for (middle, radius, side, [from, to], steps) in arcs {
        all.extend((0..=steps).map(|i| {
            let angle = TAU / 4.0 * (from + (to - from) * share(i, steps));
            let (c, s) = (cos(angle), sin(angle));
            ([middle[0] + radius * c, middle[1] + radius * s], [side * c, side * s])
        }));
    }
    all.push(([0.0, floor], [0.0, 1.0]));
    all
}

/// Two prints for a picture of 480 x 400, in front and behind, a little off the mug's side.
fn print() -> String {
    const BOTTOM: f64 = 0.014;
    const TOP: f64 = 0.083;
    let radius = RADIUS + 0.0003;
    let wide = (TOP - BOTTOM) * 480.0 / 400.0 / radius;
    let mut obj = Obj::default();
    for turn in [0.0, HALF] {
        let columns = 32;
        obj.sheet(1, columns, |i, j| {
            let angle = turn + wide * (share(j, columns) - 0.5);
            let normal = [sin(angle), 0.0, cos(angle)];
            let position = [radius * normal[0], if i == 0 { BOTTOM } else { TOP }, radius * normal[2]];
            Vertex { position, uv: [share(j, columns), i as f64], normal }
        });
    }
    obj.text()
}
