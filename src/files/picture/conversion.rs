//! What a declared color is made of, and the arithmetic with it: curves, matrices between XYZ and the light of sRGB, tables.

use std::sync::LazyLock;

use rayon::prelude::*;

use crate::base::maths::{exp, pow};
use crate::base::picture::{Light, table};
use crate::base::pixels::{linear_from_srgb, srgb_from_linear};

/// The most samples per pixel, and values per color.
pub(super) const MOST: usize = 4;

/// The white of the profile connection space, XYZ.
pub(super) const D50: [f64; 3] = [0.9642, 1.0, 0.8249];

/// x and y of white, red, green and blue.
type Primaries = [[f64; 2]; 4];

const D65: [f64; 2] = [0.3127, 0.329];
const SRGB: Primaries = [D65, [0.64, 0.33], [0.3, 0.6], [0.15, 0.06]];

/// Primaries and a curve, declared without a profile.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Spoken {
    pub transfer: Transfer,
    /// `None`: those of sRGB.
    pub primaries: Option<Primaries>,
    /// Whether black and white are at 16 and 235 of 255.
    pub narrow: bool,
}

/// From codes to light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Transfer {
    Srgb,
    /// The code to this power.
    Power(f64),
    Bt709,
    Smpte240,
    /// Logarithmic, over this many decades.
    Log(f64),
    /// The curves of HDR: 203 cd/m² is white.
    Pq,
    Hlg,
    Smpte428,
}

/// A curve of a profile.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Curve {
    Power(f64),
    Points(Vec<u16>),
    Parametric([f64; 7]),
    Transfer(Transfer, bool),
    /// The inner curve gives L*, as 0 to 1.
    Lightness(Box<Curve>),
}

/// Curves, then a matrix to D50 XYZ; without a matrix the primaries are those of sRGB.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Shaper {
    pub curves: [Curve; 3],
    pub matrix: Option<[[f64; 3]; 3]>,
}

/// sRGB codes, 0 to 1, at the nodes of a grid over device values.
pub(super) struct Table {
    pub inputs: usize,
    nodes: usize,
    codes: Vec<[f32; 3]>,
}

/// The conversion that a profile defines.
pub(super) enum Profile {
    Shaper(Box<Shaper>),
    Table(Table),
}

impl Spoken {
    /// What the numbers in a cICP chunk mean (ITU-T H.273); `None` if they are reserved or not RGB.
    pub fn of_cicp(primaries: u8, transfer: u8, matrix: u8, full: bool) -> Option<Self> {
        const BT601: [[f64; 2]; 3] = [[0.63, 0.34], [0.31, 0.595], [0.155, 0.07]];
        let with = |white, [r, g, b]: [[f64; 2]; 3]| Some([white, r, g, b]);
        let primaries = match primaries {
            1 => None,
            4 => with([0.31, 0.316], [[0.67, 0.33], [0.21, 0.71], [0.14, 0.08]]),
            5 => with(D65, [[0.64, 0.33], [0.29, 0.6], [0.15, 0.06]]),
            6 | 7 => with(D65, BT601),
            8 => with([0.31, 0.316], [[0.681, 0.319], [0.243, 0.692], [0.145, 0.049]]),
            9 => with(D65, [[0.708, 0.292], [0.17, 0.797], [0.131, 0.046]]),
            10 => with([1.0 / 3.0, 1.0 / 3.0], [[1.0, 1e-9], [0.0, 1.0], [0.0, 1e-9]]),
            11 => with([0.314, 0.351], [[0.68, 0.32], [0.265, 0.69], [0.15, 0.06]]),
            12 => with(D65, [[0.68, 0.32], [0.265, 0.69], [0.15, 0.06]]),
            22 => with(D65, [[0.63, 0.34], [0.295, 0.605], [0.155, 0.077]]),
            _ => return None,
        };
        let transfer = match transfer {
            1 | 6 | 11 | 14 | 15 => Transfer::Bt709,
            4 => Transfer::Power(2.2),
            5 => Transfer::Power(2.8),
            7 => Transfer::Smpte240,
            8 => Transfer::Power(1.0),
            9 => Transfer::Log(2.0),
            10 => Transfer::Log(2.5),
            13 => Transfer::Srgb,
            16 => Transfer::Pq,
            17 => Transfer::Smpte428,
            18 => Transfer::Hlg,
            _ => return None,
        };
        (matrix == 0).then_some(Spoken { transfer, primaries, narrow: !full })
    }

    pub fn shaper(&self) -> Option<Shaper> {
        let curve = Curve::Transfer(self.transfer, self.narrow);
        let matrix = match self.primaries {
            None => None,
            Some(primaries) => Some(to_xyz(primaries)?),
        };
        Some(Shaper { curves: [curve.clone(), curve.clone(), curve], matrix })
    }
}

impl Transfer {
    /// The gAMA chunk of PNG; its usual value, 45455, means sRGB, which is what every writer means by it.
    pub fn of_png_gamma(gamma: u32) -> Self {
        if gamma.abs_diff(45455) <= 50 { Transfer::Srgb } else { Transfer::Power(100_000.0 / f64::from(gamma)) }
    }

    fn light(self, x: f64) -> f64 {
        match self {
            Transfer::Srgb => linear_from_srgb(x),
            Transfer::Power(gamma) => pow(x, gamma),
            Transfer::Bt709 if x < 0.081 => x / 4.5,
            Transfer::Bt709 => pow((x + 0.099) / 1.099, 1.0 / 0.45),
            Transfer::Smpte240 if x < 0.0913 => x / 4.0,
            Transfer::Smpte240 => pow((x + 0.1115) / 1.1115, 1.0 / 0.45),
            Transfer::Log(_) if x <= 0.0 => 0.0,
            Transfer::Log(decades) => pow(10.0, (x - 1.0) * decades),
            Transfer::Smpte428 => 52.37 / 48.0 * pow(x, 2.6),
            Transfer::Pq => {
                let p = pow(x, 32.0 / 2523.0);
                let below = (p - 0.8359375).max(0.0);
                pow(below / (18.8515625 - 18.6875 * p), 8192.0 / 1305.0) * 10_000.0 / 203.0
            }
            // White is the light of code 0.75.
            Transfer::Hlg if x <= 0.5 => x * x / 3.0 / 0.265,
            Transfer::Hlg => (exp((x - 0.559_910_73) / 0.178_832_77) + 0.284_668_92) / 12.0 / 0.265,
        }
    }
}

impl Curve {
    /// The light of a code, both 0 to 1.
    pub fn at(&self, x: f64) -> f64 {
        match self {
            Curve::Power(gamma) => pow(x, *gamma),
            Curve::Points(values) => between(x, values.len(), |i| f64::from(values[i]) / 65535.0),
            Curve::Parametric([g, a, b, c, d, e, f]) => {
                let light = if x >= *d { pow((a * x + b).max(0.0), *g) + e } else { c * x + f };
                if light.is_finite() { light.clamp(0.0, 1.0) } else { 0.0 }
            }
            Curve::Transfer(transfer, false) => transfer.light(x).min(1.0),
            Curve::Transfer(transfer, true) => transfer.light(((x * 255.0 - 16.0) / 219.0).clamp(0.0, 1.0)).min(1.0),
            Curve::Lightness(curve) => from_lightness(curve.at(x) * 100.0),
        }
    }
}

impl Shaper {
    /// The matrix from the light of its channels to that of sRGB; `None` if they are the same.
    fn to_srgb(&self) -> Option<[[f64; 3]; 3]> {
        let rows = times(&FROM_XYZ, &self.matrix?);
        let same = (0..9).all(|i| (rows[i / 3][i % 3] - f64::from(u8::from(i / 3 == i % 3))).abs() < 1e-3);
        (!same).then_some(rows)
    }

    /// Whether its codes are those of sRGB, to within 0.75 of 255.
    pub fn is_srgb(&self) -> bool {
        let near = |curve: &Curve| {
            (0..=255).all(|code| {
                let x = f64::from(code) / 255.0;
                (srgb_from_linear(curve.at(x)) - x).abs() * 255.0 <= 0.75
            })
        };
        self.to_srgb().is_none() && self.curves.iter().all(near)
    }

    /// The light of every code.
    pub fn light<const CODES: usize>(&self) -> Light<CODES> {
        let [red, green, blue] = &self.curves;
        let first = table(|x| red.at(x));
        let other = |curve: &Curve| if curve == red { first.clone() } else { table(|x| curve.at(x)) };
        let matrix = self.to_srgb().map(|rows| rows.map(|row| row.map(|v| v as f32)));
        Light { curves: [first.clone(), other(green), other(blue)], matrix }
    }
}

impl Table {
    /// A table with `nodes` per side, of the colors `xyz` of device values.
    pub fn of(inputs: usize, nodes: usize, xyz: impl Fn(&[f64]) -> [f64; 3] + Sync) -> Self {
        let code = |i: usize| {
            let mut device = [0.0; 4];
            let mut rest = i;
            for c in (0..inputs).rev() {
                device[c] = (rest % nodes) as f64 / (nodes - 1) as f64;
                rest /= nodes;
            }
            multiply(&FROM_XYZ, xyz(&device[..inputs])).map(|light| srgb_from_linear(light.clamp(0.0, 1.0)) as f32)
        };
        let codes = (0..nodes.pow(inputs as u32)).into_par_iter().map(code).collect();
        Table { inputs, nodes, codes }
    }

    /// The code of device values between the nodes.
    pub fn code(&self, device: &[f64]) -> [u16; 3] {
        let mut sum = [0.0; 3];
        mix(&device[..self.inputs], &[self.nodes; 4], |i, weight| {
            (0..3).for_each(|c| sum[c] += weight * f64::from(self.codes[i][c]));
        });
        sum.map(|code| (code * 65535.0 + 0.5) as u16)
    }
}

/// Y from L*.
pub(super) fn from_lightness(l: f64) -> f64 {
    from_lab([l, 0.0, 0.0])[1]
}

/// CIE L*a*b* to XYZ, both relative to D50.
pub(super) fn from_lab([l, a, b]: [f64; 3]) -> [f64; 3] {
    let y = (l + 16.0) / 116.0;
    let back = |t: f64| if t > 24.0 / 116.0 { t * t * t } else { (t - 16.0 / 116.0) * 108.0 / 841.0 };
    [back(y + a / 500.0) * D50[0], back(y) * D50[1], back(y - b / 200.0) * D50[2]]
}

/// The value at `x` between `count` values that are evenly spaced from 0 to 1.
pub(super) fn between(x: f64, count: usize, value: impl Fn(usize) -> f64) -> f64 {
    let at = x.clamp(0.0, 1.0) * (count - 1) as f64;
    let below = (at as usize).min(count - 1);
    let above = (below + 1).min(count - 1);
    value(below) + (value(above) - value(below)) * (at - below as f64)
}

/// The nodes around a place in a grid, each with its weight (the corners of the simplex that contains it; in three
/// dimensions a tetrahedron). The first coordinate varies slowest.
pub(super) fn mix(place: &[f64], nodes: &[usize; MOST], mut each: impl FnMut(usize, f64)) {
    let count = place.len();
    let (mut at, mut parts) = (0, [(0.0, 0); MOST]);
    let mut stride = 1;
    for c in (0..count).rev() {
        let last = nodes[c] - 1;
        let x = place[c].clamp(0.0, 1.0) * last as f64;
        let below = (x as usize).min(last);
        at += below * stride;
        // The last node has no next one; the weight of that would be 0.
        parts[c] = (x - below as f64, if below < last { stride } else { 0 });
        stride *= nodes[c];
    }
    let parts = &mut parts[..count];
    parts.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut before = 1.0;
    for &(part, step) in parts.iter() {
        each(at, before - part);
        at += step;
        before = part;
    }
    each(at, before);
}

/// From D50 XYZ to linear sRGB.
pub(super) static FROM_XYZ: LazyLock<[[f64; 3]; 3]> =
    LazyLock::new(|| to_xyz(SRGB).and_then(|matrix| inverse(&matrix)).unwrap_or_default());

/// From primaries to XYZ, with white adapted to D50 by the Bradford transform; `None` if they span no area.
fn to_xyz([white, red, green, blue]: Primaries) -> Option<[[f64; 3]; 3]> {
    const BRADFORD: [[f64; 3]; 3] = [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]];
    let xyz = |[x, y]: [f64; 2]| [x / y, 1.0, (1.0 - x - y) / y];
    let columns = [red, green, blue].map(xyz);
    let own: [[f64; 3]; 3] = std::array::from_fn(|row| std::array::from_fn(|c| columns[c][row]));
    let scale = multiply(&inverse(&own)?, xyz(white));
    let own = own.map(|row| std::array::from_fn(|c| row[c] * scale[c]));
    let (from, to) = (multiply(&BRADFORD, xyz(white)), multiply(&BRADFORD, D50));
    let cones = std::array::from_fn(|row| std::array::from_fn(|c| if row == c { to[c] / from[c] } else { 0.0 }));
    let turned = times(&inverse(&BRADFORD)?, &times(&cones, &times(&BRADFORD, &own)));
    turned.iter().flatten().all(|v| v.is_finite()).then_some(turned)
}

pub(super) fn multiply(rows: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    rows.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

fn times(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    a.map(|row| std::array::from_fn(|c| row[0] * b[0][c] + row[1] * b[1][c] + row[2] * b[2][c]))
}

fn inverse(m: &[[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    let minor = |r: usize, c: usize| {
        let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
        m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
    };
    let all = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
    (all.abs() > 1e-12).then(|| std::array::from_fn(|r| std::array::from_fn(|c| minor(c, r) / all)))
}
