//! A part of a frame at the size of a small screen. Only the pixels that it shows are computed: for a 4K picture in a
//! terminal pane, the cost depends only on the size of the pane.

use kurbo::{Point, Vec2};

use super::passes::{self, Asked};
use super::{Synth, cpu};
use crate::base::pixels::{Frame, Linear, Rgba, encode};
use crate::layers::parts::pass::Holds;

/// Which part of a picture is shown, on how many dots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// The place in the picture at the top left corner, in pixels.
    pub corner: Point,
    /// Pixels of the picture per dot, in each direction; above 0.
    pub scale: f64,
    /// Dots across and down.
    pub dots: (usize, usize),
}

/// The most pixels that are computed for one view; a dot gets more than one only if this is enough for all dots.
const MOST_PIXELS: usize = 1 << 20;
/// The most pixels that a dot is the mean of, in each direction.
const MOST_EACH_WAY: usize = 4;

impl Part {
    /// Where a place of the picture is, in dots from the corner.
    pub fn dot_of(&self, at: Point) -> Point {
        ((at - self.corner) / self.scale).to_point()
    }

    /// The place in the picture that is `dot` dots from the corner.
    pub fn place_of(&self, dot: Point) -> Point {
        self.corner + dot.to_vec2() * self.scale
    }

    /// Width and height of what is visible, in pixels of the picture.
    pub fn extent(&self) -> Vec2 {
        Vec2::new(self.dots.0 as f64, self.dots.1 as f64) * self.scale
    }

    /// The same part on fewer dots: `by` times fewer in each direction.
    pub fn reduced(&self, by: usize) -> Part {
        let (w, h) = self.dots;
        Part { scale: self.scale * by as f64, dots: (w.div_ceil(by), h.div_ceil(by)), ..*self }
    }

    /// How many pixels a dot has in each direction, as far as that can be afforded.
    fn every_pixel(&self) -> usize {
        let afford = (MOST_PIXELS as f64 / (self.dots.0 * self.dots.1).max(1) as f64).sqrt() as usize;
        (self.scale.ceil() as usize).clamp(1, afford.max(1))
    }

    /// How many pixels a dot is the mean of, in each direction.
    fn each_way(&self) -> usize {
        self.every_pixel().min(MOST_EACH_WAY)
    }
}

/// The part of the frame at `scene_time`. At a scale of 1 or less a dot is exactly the pixel in its middle; above, it
/// is the mean, in linear light, of up to 4 x 4 pixels spread evenly over it (in a small view, of all its pixels up to
/// a scale of 4). Dots beyond the picture are transparent.
pub fn frame(synth: &Synth, scene_time: f64, part: &Part) -> Frame {
    let each = part.each_way();
    let columns = Line::new(part.corner.x, part.scale, part.dots.0, each, synth.size.0);
    let rows = Line::new(part.corner.y, part.scale, part.dots.1, each, synth.size.1);
    let pixels = cpu::lattice(synth, scene_time, &columns.pixels, &rows.pixels);
    let dots = (0..part.dots.1).flat_map(|y| (0..part.dots.0).map(move |x| (x, y)));
    let cells = dots.map(|(x, y)| mean(&pixels, columns.of(x), rows.of(y))).collect();
    Frame::from_cells(part.dots.0, part.dots.1, cells)
}

/// As [`frame`], of a pass, to look at, over the dimmed frame where that helps: each dot is the pixel in its middle, since
/// numbers of triangles have no mean; of thin lines any pixel of the dot that is on one.
pub fn pass(synth: &Synth, scene_time: f64, part: &Part, asked: &Asked) -> Frame {
    let asked = asked.looked_at();
    let each = if asked.pass.holds == Holds::Speed { part.every_pixel() } else { 1 };
    let lines = |each: usize| {
        let columns = Line::new(part.corner.x, part.scale, part.dots.0, each, synth.size.0);
        (columns, Line::new(part.corner.y, part.scale, part.dots.1, each, synth.size.1))
    };
    let dots = || (0..part.dots.1).flat_map(|y| (0..part.dots.0).map(move |x| (x, y)));
    let sampled = |asked: &Asked, each: usize| {
        let (columns, rows) = lines(each);
        let pixels = asked.lattice(synth, scene_time, &columns.pixels, &rows.pixels);
        let cells = dots().map(|(x, y)| any(&pixels, columns.of(x), rows.of(y))).collect();
        Linear::from_cells(part.dots.0, part.dots.1, cells)
    };
    let seen = passes::view_over(&asked, &sampled(&asked, each), || sampled(&asked.in_color(), 1));
    let (columns, rows) = lines(1);
    let within = |x: usize, y: usize| columns.of(x)[0].is_some() && rows.of(y)[0].is_some();
    let cells = dots().map(|(x, y)| if within(x, y) { *seen.get(x, y) } else { [0; 4] }).collect();
    Frame::from_cells(part.dots.0, part.dots.1, cells)
}

/// The first of these pixels in which there is something.
fn any(pixels: &Linear, columns: &[Option<usize>], rows: &[Option<usize>]) -> Rgba {
    let all = rows.iter().flatten().flat_map(|&y| columns.iter().flatten().map(move |&x| *pixels.get(x, y)));
    all.into_iter().find(|cell| cell[3] != 0.0).unwrap_or_default()
}

fn mean(pixels: &Linear, columns: &[Option<usize>], rows: &[Option<usize>]) -> [u8; 4] {
    let (mut sum, mut count): (Rgba, f32) = ([0.0; 4], 0.0);
    for &y in rows.iter().flatten() {
        for &x in columns.iter().flatten() {
            let color = pixels.get(x, y);
            sum = std::array::from_fn(|i| sum[i] + color[i]);
            count += 1.0;
        }
    }
    if count > 0.0 { encode(sum.map(|v| v / count)) } else { [0; 4] }
}

/// The pixels that a view uses along one axis.
struct Line {
    /// The pixels, ascending, without duplicates.
    pixels: Vec<usize>,
    /// For every dot, `each` indices into `pixels`; `None` beyond the picture.
    places: Vec<Option<usize>>,
    each: usize,
}

impl Line {
    fn new(corner: f64, scale: f64, dots: usize, each: usize, size: usize) -> Line {
        let mut pixels: Vec<usize> = Vec::new();
        let places = (0..dots * each).map(|k| {
            let at = (corner + (k as f64 + 0.5) / each as f64 * scale).floor();
            let pixel = (at >= 0.0 && at < size as f64).then_some(at as usize)?;
            if pixels.last() != Some(&pixel) {
                pixels.push(pixel);
            }
            Some(pixels.len() - 1)
        });
        let places = places.collect();
        Line { pixels, places, each }
    }

    fn of(&self, dot: usize) -> &[Option<usize>] {
        &self.places[dot * self.each..][..self.each]
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::base::picture::Picture;
    use crate::layers::parts::materials::Materials;
    use crate::render::synth;

    fn moving() -> Synth {
        let cell = |i: usize| [(i % 40) as f32 / 40.0, (i / 40) as f32 / 30.0, 0.25, 1.0];
        let picture = Arc::new(Picture::from_cells(40, 30, (0..40 * 30).map(cell).collect()));
        let materials = Materials { pictures: [("a".to_owned(), picture)].into(), ..Materials::default() };
        let scene = serde_json::from_str(
            r#"{"plica": 1, "layers": [{"kind": "picture", "name": "l", "image": "a", "zones": [{"name": "z",
              "outline": {"kind": "ellipse", "center": [20, 15], "radii": [14, 10]},
              "motion": [{"tool": "point", "at": [18, 14], "jump": [6, 3]}],
              "fold": {"rule": "cover", "regions": [{"kind": "rectangle", "x": 22, "y": 12, "width": 6, "height": 8}]}}]}]}"#,
        )
        .unwrap();
        synth(&scene, &materials, None).unwrap()
    }

    #[test]
    fn a_thin_line_has_no_gaps_on_few_dots() {
        let cell = |i: usize| if (i % 60) / 2 == i / 60 { [1.0; 4] } else { [0.0; 4] };
        let picture = Linear::from_cells(60, 30, (0..60 * 30).map(cell).collect());
        let part = Part { corner: Point::ZERO, scale: 7.5, dots: (8, 4) };
        let whole = |dots: usize, size: usize| Line::new(0.0, part.scale, dots, part.every_pixel(), size);
        let (columns, rows) = (whole(8, 60), whole(4, 30));
        assert_eq!((columns.pixels.len(), rows.pixels.len()), (60, 30), "no pixel is left out");
        let crossed = |x: usize| (0..4).any(|y| any(&picture, columns.of(x), rows.of(y)) != [0.0; 4]);
        assert!((0..8).all(crossed));
    }

    #[test]
    fn pixel_for_pixel_it_is_the_frame() {
        let synth = moving();
        let frame_there = cpu::frame(&synth, 0.6);
        for (corner, scale) in [((0.0, 0.0), 1.0), ((13.0, 7.0), 1.0), ((-4.0, -3.0), 1.0), ((10.0, 8.0), 0.25)] {
            let part = Part { corner: corner.into(), scale, dots: (24, 20) };
            let view = frame(&synth, 0.6, &part);
            for (x, y) in (0..20).flat_map(|y| (0..24).map(move |x| (x, y))) {
                let at = part.place_of(Point::new(x as f64 + 0.5, y as f64 + 0.5));
                let inside = at.x >= 0.0 && at.y >= 0.0;
                let expected = if inside { *frame_there.get(at.x as usize, at.y as usize) } else { [0; 4] };
                assert_eq!(*view.get(x, y), expected, "{corner:?} {scale} {x},{y}");
            }
        }
    }

    #[test]
    fn reduced_it_is_the_mean_of_the_pixels() {
        let synth = moving();
        let part = Part { corner: Point::ZERO, scale: 2.0, dots: (20, 15) };
        let (view, linear) = (frame(&synth, 0.6, &part), cpu::linear(&synth, 0.6));
        for (x, y) in [(0, 0), (10, 7), (12, 8), (19, 14)] {
            let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| *linear.get(x * 2 + i, y * 2 + j));
            let mean = std::array::from_fn(|c| (four[0][c] + four[1][c] + four[2][c] + four[3][c]) / 4.0);
            assert_eq!(*view.get(x, y), encode(mean), "{x},{y}");
        }
    }

    #[test]
    fn a_large_picture_costs_what_is_seen_of_it() {
        let part = Part { corner: Point::ZERO, scale: 64.0, dots: (60, 40) };
        assert_eq!(part.each_way(), 4);
        let large = Part { scale: 3.0, dots: (1200, 800), ..part };
        assert_eq!(large.each_way(), 1);
        assert_eq!(part.reduced(3).dots, (20, 14));
        assert_eq!(part.dot_of(part.place_of(Point::new(3.5, 2.25))), Point::new(3.5, 2.25));
    }
}
