//! The painter's tools: a canvas in display colors, masks that can be blurred (the airbrush), tapered strokes (hair,
//! lashes, cracks). Shapes are SVG paths; all results are the same to the bit on every machine.

use kurbo::{BezPath, ParamCurve, PathEl, PathSeg, Point, Vec2};
use plica::base::maths::smoothstep;

/// A color as displayed, 0 to 1 per channel.
pub type Rgb = [f32; 3];

/// The color 0xRRGGBB.
pub fn rgb(hex: u32) -> Rgb {
    [16, 8, 0].map(|shift| ((hex >> shift) & 255) as f32 / 255.0)
}

/// The color between two others, at `t`.
pub fn mix(a: Rgb, b: Rgb, t: f32) -> Rgb {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t)
}

/// A color made lighter (above 1) or darker.
pub fn times(a: Rgb, factor: f32) -> Rgb {
    a.map(|c| c * factor)
}

/// The Hermite step from 0 at `from` to 1 at `to`, which may lie to the left.
pub fn ramp(from: f64, to: f64, x: f64) -> f64 {
    if from <= to { smoothstep(from, to, x) } else { 1.0 - smoothstep(to, from, x) }
}

/// The path of an SVG path string.
pub fn path(svg: &str) -> BezPath {
    BezPath::from_svg(svg).expect("the drawings' own paths are well formed")
}

/// The first segment of an SVG path string.
pub fn curve(svg: &str) -> PathSeg {
    path(svg).segments().next().expect("a drawing's curve has a segment")
}

/// Coverage, 0 to 1, of every pixel of a canvas.
#[derive(Clone)]
pub struct Mask {
    width: usize,
    cells: Vec<f32>,
}

impl Mask {
    /// The coverage of a closed path (nonzero rule), anti-aliased.
    pub fn path(canvas: &Canvas, svg: &str) -> Mask {
        Mask::bez(canvas, &path(svg))
    }

    /// As [`Mask::path`].
    pub fn bez(canvas: &Canvas, bez: &BezPath) -> Mask {
        let mut mask = tiny_skia::Mask::new(canvas.width as u32, canvas.height as u32).expect("a canvas is not empty");
        if let Some(path) = skia(bez) {
            mask.fill_path(&path, tiny_skia::FillRule::Winding, true, tiny_skia::Transform::identity());
        }
        Mask { width: canvas.width, cells: mask.data().iter().map(|&c| f32::from(c) / 255.0).collect() }
    }

    /// An ellipse.
    pub fn ellipse(canvas: &Canvas, center: (f64, f64), radii: (f64, f64)) -> Mask {
        use kurbo::Shape;
        Mask::bez(canvas, &kurbo::Ellipse::new(center, radii, 0.0).to_path(0.01))
    }

    /// `value` at every pixel center.
    pub fn from_fn(canvas: &Canvas, value: impl Fn(f64, f64) -> f64) -> Mask {
        let cells = canvas.centers().map(|(x, y)| value(x, y).clamp(0.0, 1.0) as f32).collect();
        Mask { width: canvas.width, cells }
    }

    /// The mask blurred, approximately by a Gaussian with a standard deviation of `radius` pixels.
    pub fn blur(mut self, radius: f64) -> Mask {
        let height = self.cells.len() / self.width;
        for _ in 0..3 {
            box_blur(&mut self.cells, radius, self.width, height, 1, self.width);
            box_blur(&mut self.cells, radius, height, self.width, self.width, 1);
        }
        self
    }

    /// The intersection of both.
    pub fn and(mut self, other: &Mask) -> Mask {
        self.cells.iter_mut().zip(&other.cells).for_each(|(a, b)| *a *= b);
        self
    }

    /// The coverage of the pixel that contains a point; 0 outside.
    pub fn at(&self, p: Point) -> f32 {
        let (x, y) = (p.x as usize, p.y as usize);
        let within = p.x >= 0.0 && p.y >= 0.0 && x < self.width;
        if within { self.cells.get(y * self.width + x).copied().unwrap_or(0.0) } else { 0.0 }
    }
}

/// A box filter along `lines` lines, `next` apart, each of `length` cells, `step` apart.
fn box_blur(cells: &mut [f32], radius: f64, length: usize, lines: usize, step: usize, next: usize) {
    let r = radius.round().max(1.0) as usize;
    let mut line = vec![0.0f32; length];
    for start in (0..lines).map(|l| l * next) {
        for (i, cell) in line.iter_mut().enumerate() {
            *cell = cells[start + i * step];
        }
        let at = |i: isize| f64::from(line[i.clamp(0, length as isize - 1) as usize]);
        let mut sum: f64 = (-(r as isize)..=r as isize).map(at).sum();
        for i in 0..length {
            cells[start + i * step] = (sum / (2 * r + 1) as f64) as f32;
            sum += at((i + r + 1) as isize) - at(i as isize - r as isize);
        }
    }
}

fn skia(bez: &BezPath) -> Option<tiny_skia::Path> {
    let mut builder = tiny_skia::PathBuilder::new();
    let f = |p: Point| (p.x as f32, p.y as f32);
    for el in bez.elements() {
        match *el {
            PathEl::MoveTo(p) => builder.move_to(f(p).0, f(p).1),
            PathEl::LineTo(p) => builder.line_to(f(p).0, f(p).1),
            PathEl::QuadTo(a, p) => builder.quad_to(f(a).0, f(a).1, f(p).0, f(p).1),
            PathEl::CurveTo(a, b, p) => builder.cubic_to(f(a).0, f(a).1, f(b).0, f(b).1, f(p).0, f(p).1),
            PathEl::ClosePath => builder.close(),
        }
    }
    builder.finish()
}

/// A tapered stroke: along a quadratic curve, from one width to the other.
pub struct Stroke {
    /// Start, control point, end.
    pub points: [Point; 3],
    /// Widths in pixels at both ends.
    pub widths: (f64, f64),
}

impl Stroke {
    /// A stroke from `from` along `by`, bent sideways by `bend` times its length.
    pub fn new(from: impl Into<Point>, by: impl Into<Vec2>, bend: f64, widths: (f64, f64)) -> Stroke {
        let (from, by) = (from.into(), by.into());
        let middle = from + by * 0.5 + Vec2::new(by.y, -by.x) * bend;
        Stroke { points: [from, middle, from + by], widths }
    }
}

/// A picture being painted: display colors, premultiplied by alpha.
pub struct Canvas {
    width: usize,
    height: usize,
    cells: Vec<[f32; 4]>,
}

impl Canvas {
    /// A canvas of one color.
    pub fn new(width: usize, height: usize, [r, g, b]: Rgb) -> Canvas {
        Canvas { width, height, cells: vec![[r, g, b, 1.0]; width * height] }
    }

    /// A transparent canvas.
    pub fn clear(width: usize, height: usize) -> Canvas {
        Canvas { width, height, cells: vec![[0.0; 4]; width * height] }
    }

    fn centers(&self) -> impl Iterator<Item = (f64, f64)> + use<> {
        let (w, h) = (self.width, self.height);
        (0..h).flat_map(move |y| (0..w).map(move |x| (x as f64 + 0.5, y as f64 + 0.5)))
    }

    /// Changes every pixel's color; alpha stays.
    pub fn shade(&mut self, change: impl Fn(f64, f64, Rgb) -> Rgb) {
        for ((x, y), cell) in self.centers().zip(&mut self.cells) {
            let [r, g, b] = change(x, y, [cell[0], cell[1], cell[2]]);
            *cell = [r, g, b, cell[3]];
        }
    }

    /// Paints one color through a mask.
    pub fn paint(&mut self, mask: &Mask, color: Rgb, alpha: f64) {
        self.paint_with(mask, |_, _, _| (color, alpha));
    }

    /// Multiplies by a color through a mask: shadow and glaze.
    pub fn glaze(&mut self, mask: &Mask, color: Rgb, alpha: f64) {
        self.paint_with(mask, |_, _, below| (std::array::from_fn(|i| below[i] * color[i]), alpha));
    }

    /// Lightens towards a color through a mask: the inverse product.
    pub fn light(&mut self, mask: &Mask, color: Rgb, alpha: f64) {
        self.paint_with(mask, |_, _, below| {
            (std::array::from_fn(|i| 1.0 - (1.0 - below[i]) * (1.0 - color[i])), alpha)
        });
    }

    /// Paints through a mask; `color` gives the color and its alpha from the place and the color beneath.
    pub fn paint_with(&mut self, mask: &Mask, color: impl Fn(f64, f64, Rgb) -> (Rgb, f64)) {
        for (((x, y), cell), &cover) in self.centers().zip(&mut self.cells).zip(&mask.cells) {
            if cover > 0.0 {
                let (color, alpha) = color(x, y, [cell[0], cell[1], cell[2]]);
                lay(cell, color, cover * alpha as f32);
            }
        }
    }

    /// Lays another canvas of the same size over this one, through a mask.
    pub fn lay(&mut self, over: &Canvas, mask: &Mask) {
        for ((cell, over), &cover) in self.cells.iter_mut().zip(&over.cells).zip(&mask.cells) {
            let rest = 1.0 - over[3] * cover;
            *cell = std::array::from_fn(|i| over[i] * cover + cell[i] * rest);
        }
    }

    /// Paints a tapered stroke.
    pub fn stroke(&mut self, stroke: &Stroke, color: Rgb, alpha: f64) {
        self.draw(stroke, color, |_| alpha);
    }

    /// Paints a tapered stroke through a mask.
    pub fn stroke_within(&mut self, stroke: &Stroke, color: Rgb, alpha: f64, mask: &Mask) {
        self.draw(stroke, color, |cell| alpha * f64::from(mask.cells[cell]));
    }

    fn draw(&mut self, stroke: &Stroke, color: Rgb, alpha: impl Fn(usize) -> f64) {
        let [a, b, c] = stroke.points;
        let quad = kurbo::QuadBez::new(a, b, c);
        let length = (b - a).hypot2().sqrt() + (c - b).hypot2().sqrt();
        let pieces = ((length / 3.0).ceil() as usize).clamp(2, 24);
        let width = |t: f64| stroke.widths.0 + (stroke.widths.1 - stroke.widths.0) * t;
        let spine: Vec<(Point, f64)> =
            (0..=pieces).map(|i| i as f64 / pieces as f64).map(|t| (quad.eval(t), width(t))).collect();
        let reach = stroke.widths.0.max(stroke.widths.1) / 2.0 + 1.0;
        let min = spine.iter().fold(a, |m, (p, _)| Point::new(m.x.min(p.x), m.y.min(p.y)));
        let max = spine.iter().fold(a, |m, (p, _)| Point::new(m.x.max(p.x), m.y.max(p.y)));
        let columns = clip(min.x - reach, max.x + reach, self.width);
        for y in clip(min.y - reach, max.y + reach, self.height) {
            for x in columns.clone() {
                let cover = cover_at(&spine, Point::new(x as f64 + 0.5, y as f64 + 0.5));
                if cover > 0.0 {
                    let cell = y * self.width + x;
                    lay(&mut self.cells[cell], color, (cover * alpha(cell)) as f32);
                }
            }
        }
    }

    /// 8-bit sRGB with straight alpha, four bytes per pixel; three if everything is opaque.
    pub fn to_bytes(&self) -> (Vec<u8>, bool) {
        let code = |c: f32| (c.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
        let opaque = self.cells.iter().all(|c| c[3] >= 1.0);
        let mut bytes = Vec::new();
        for &[r, g, b, a] in &self.cells {
            let straight = if a > 0.0 { [r / a, g / a, b / a] } else { [0.0; 3] };
            bytes.extend(straight.map(code));
            if !opaque {
                bytes.push(code(a));
            }
        }
        (bytes, opaque)
    }

    /// The picture as a PNG file.
    pub fn to_png(&self) -> Result<Vec<u8>, png::EncodingError> {
        let (bytes, opaque) = self.to_bytes();
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, self.width as u32, self.height as u32);
        encoder.set_color(if opaque { png::ColorType::Rgb } else { png::ColorType::Rgba });
        encoder.set_compression(png::Compression::High);
        encoder.set_filter(png::Filter::Adaptive);
        encoder.write_header()?.write_image_data(&bytes)?;
        Ok(file)
    }
}

fn lay(cell: &mut [f32; 4], [r, g, b]: Rgb, alpha: f32) {
    for (below, over) in cell.iter_mut().zip([r, g, b, 1.0]) {
        *below = over * alpha + *below * (1.0 - alpha);
    }
}

fn clip(from: f64, to: f64, size: usize) -> std::ops::Range<usize> {
    (from.max(0.0) as usize)..((to.ceil().max(0.0) as usize).min(size))
}

/// How much of the pixel at `q` the spine's round pen covers; a pen thinner than a pixel covers in proportion.
fn cover_at(spine: &[(Point, f64)], q: Point) -> f64 {
    spine.windows(2).fold(0.0, |most: f64, pair| {
        let [(a, wa), (b, wb)] = [pair[0], pair[1]];
        let side = b - a;
        let along = if side.hypot2() > 0.0 { ((q - a).dot(side) / side.hypot2()).clamp(0.0, 1.0) } else { 0.0 };
        let width = wa + (wb - wa) * along;
        let gap = (q - (a + side * along)).hypot2().sqrt() - width.max(1.0) / 2.0;
        most.max((0.5 - gap).clamp(0.0, 1.0) * width.min(1.0))
    })
}
