//! The sides of a polygon in nested chains, so that most of a fine curve is passed over at a glance: four sides make a
//! chain, four chains a longer one, up to the whole polygon. A chain has a box, a straight axis, and a band: no part of the
//! chain is farther from the axis than the band. A line that keeps clear of both crosses none of its sides; the parts of a
//! chain, and at the end the sides themselves, are looked at only where a line meets or grazes it. A chain that bends one way
//! only, by less than half a turn, is crossed once by a line that separates its ends, in a side found by halving. The result
//! is the same as if every side had been looked at.

use std::ops::Range;

use kurbo::{Point, Rect, Vec2};

/// Sides in a shortest chain, and chains in one that is longer.
const FAN: usize = 4;

/// As a share of the lengths involved: more than any rounding error.
const ROUNDING: f64 = 1e-12;

/// Shorter lines skip no chains: their products could underflow.
const SHORT: f64 = 1e-100;

/// Every chain of a polygon, level by level: first those of sides; the last level is the whole.
#[derive(Clone, Debug, PartialEq)]
pub struct Chains {
    levels: Vec<Vec<Chain>>,
}

#[derive(Clone, Debug, PartialEq)]
struct Chain {
    bounds: Rect,
    axis: (Point, Point),
    band: f64,
    /// Whether it bends one way only, by less than half a turn.
    is_arc: bool,
}

/// One of a polygon's chains.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    level: usize,
    index: usize,
}

impl Part {
    /// The numbers of its sides, if it is one of the shortest chains.
    pub fn few(self) -> Option<Range<usize>> {
        (self.level == 0).then(|| self.index * FAN..(self.index + 1) * FAN)
    }

    fn parts(self, below: usize) -> impl Iterator<Item = Part> {
        let (first, level) = (self.index * FAN, self.level - 1);
        (first..(first + FAN).min(below)).map(move |index| Part { level, index })
    }
}

/// The line q + s d.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Where s is 0.
    pub q: Point,
    /// From s = 0 to s = 1.
    pub d: Vec2,
    /// The length of `d`; infinite where it is too short to decide anything.
    length: f64,
}

impl Line {
    /// The line through `q` along `d`.
    pub fn new(q: Point, d: Vec2) -> Self {
        let length = d.hypot2().sqrt();
        Line { q, d, length: if length > SHORT { length } else { f64::INFINITY } }
    }

    /// On which side of the line `p` is, and how far, in lengths of `d`: positive on its left with the y axis pointing up.
    pub fn side(&self, p: Point) -> f64 {
        self.d.cross(p - self.q)
    }

    /// Whether a point with this [`Line::side`] counts as left of the line. Ties are decided as if the line lay a hair lower and
    /// to the right, which is the half-open rule: along a left or top edge it is in, and a vertex counts with one of its two
    /// sides.
    pub fn is_left(&self, side: f64) -> bool {
        let rightward = if self.d.x != 0.0 { self.d.x > 0.0 } else { self.d.y < 0.0 };
        if rightward { side > 0.0 } else { side >= 0.0 }
    }
}

impl Chain {
    fn of(vertices: impl Iterator<Item = Point> + Clone, first: Point, last: Point) -> Self {
        let corner = |r: Rect, p: Point| r.union_pt(p);
        let bounds = vertices.clone().fold(Rect::from_points(first, first), corner);
        let farthest = |a: Point, b: Point| {
            let squares = vertices.clone().map(|p| distance2_to_segment(p, a, b));
            squares.fold(0.0, |most, d: f64| if d > most { d } else { most }).sqrt()
        };
        let center = bounds.center();
        let (chord, disc) = (farthest(first, last), farthest(center, center));
        let (axis, band) = if chord <= disc { ((first, last), chord) } else { ((center, center), disc) };
        Chain { bounds, axis, band, is_arc: is_arc(vertices) }
    }

    /// Whether all of it is clearly on one side of the line.
    fn is_beside(&self, line: &Line) -> bool {
        let (a, b) = (self.axis.0 - line.q, self.axis.1 - line.q);
        let lengths = a.x.abs() + a.y.abs() + b.x.abs() + b.y.abs() + self.band;
        let slack = line.length * (self.band + ROUNDING * lengths);
        let (ca, cb) = (line.d.cross(a), line.d.cross(b));
        (ca > slack && cb > slack) || (ca < -slack && cb < -slack)
    }

    /// Whether no point of it is as near to `q` as the root of `nearest2`.
    fn is_beyond(&self, q: Point, nearest2: f64) -> bool {
        let away = distance2_to_segment(q, self.axis.0, self.axis.1).sqrt() * (1.0 - ROUNDING) - self.band;
        away > 0.0 && away * away * (1.0 - ROUNDING) > nearest2
    }
}

impl Chains {
    /// The chains of a closed polygon's sides.
    pub fn new(vertices: &[Point]) -> Self {
        let n = vertices.len();
        let mut levels = Vec::new();
        let mut size = FAN;
        loop {
            let chain = |start: usize| {
                let end = (start + size).min(n);
                let at = move |i: usize| vertices[i % n];
                Chain::of((start..=end).map(at), at(start), at(end))
            };
            levels.push((0..n).step_by(size).map(chain).collect());
            if size >= n {
                return Chains { levels };
            }
            size *= FAN;
        }
    }

    /// The whole polygon; `None` without vertices.
    pub fn whole(&self) -> Option<Part> {
        let level = self.levels.len().checked_sub(1)?;
        (!self.levels[level].is_empty()).then_some(Part { level, index: 0 })
    }

    fn chain(&self, part: Part) -> &Chain {
        &self.levels[part.level][part.index]
    }

    /// The ends of a straight line, and how far from it the sides of a chain may be.
    pub fn axis(&self, part: Part) -> ((Point, Point), f64) {
        let chain = self.chain(part);
        (chain.axis, chain.band)
    }

    fn below(&self, part: Part) -> impl Iterator<Item = Part> {
        part.parts(self.levels[part.level - 1].len())
    }

    /// Adds chains that together hold all sides of `part` that meet `area`, none of them much larger than `area`.
    pub fn near(&self, part: Part, area: Rect, found: &mut Vec<Part>) {
        let Rect { x0, y0, x1, y1 } = self.chain(part).bounds;
        if !meets(&self.chain(part).bounds, &area) {
            return;
        }
        let is_small = x1 - x0 <= area.width() && y1 - y0 <= area.height();
        if is_small || part.level == 0 {
            found.push(part);
        } else {
            self.below(part).for_each(|part| self.near(part, area, found));
        }
    }

    /// Calls back with the sides of `part` in chains whose box meets `area`, by the numbers of their first vertices.
    pub fn each_near(&self, part: Part, area: Rect, each: &mut impl FnMut(Range<usize>)) {
        if !meets(&self.chain(part).bounds, &area) {
            return;
        }
        match part.level {
            0 => part.few().into_iter().for_each(each),
            _ => self.below(part).for_each(|part| self.each_near(part, area, each)),
        }
    }

    /// Calls back with the sides of `part` that the line may cross, by the numbers of their first vertices.
    pub fn each_met(&self, part: Part, line: &Line, vertices: &[Point], each: &mut impl FnMut(Range<usize>)) {
        let chain = self.chain(part);
        if chain.is_beside(line) {
            return;
        }
        let n = vertices.len();
        let size = FAN.pow(part.level as u32 + 1);
        let (mut first, mut last) = (part.index * size, ((part.index + 1) * size).min(n));
        if chain.is_arc {
            let is_left = |i: usize| line.is_left(line.side(vertices[if i == n { 0 } else { i }]));
            let begins = is_left(first);
            if begins != is_left(last) {
                while last - first > 1 {
                    let middle = (first + last) / 2;
                    if is_left(middle) == begins { first = middle } else { last = middle }
                }
                return each(first..last);
            }
        }
        match part.level {
            0 => each(first..last),
            _ => self.below(part).for_each(|part| self.each_met(part, line, vertices, each)),
        }
    }

    /// The least of `nearest2` and the squared distances from `q` to the sides of `part`.
    pub fn nearest2(&self, part: Part, q: Point, nearest2: f64, vertices: &[Point]) -> f64 {
        if self.chain(part).is_beyond(q, nearest2) {
            return nearest2;
        }
        match part.level {
            0 => {
                let n = vertices.len();
                let sides = part.index * FAN..((part.index + 1) * FAN).min(n);
                let squares = sides.map(|i| distance2_to_segment(q, vertices[i], vertices[(i + 1) % n]));
                squares.fold(nearest2, f64::min)
            }
            _ => self.below(part).fold(nearest2, |nearest2, part| self.nearest2(part, q, nearest2, vertices)),
        }
    }
}

/// Whether the sides through these points bend one way only, each by less than a right angle, all by less than half a turn.
fn is_arc(points: impl Iterator<Item = Point> + Clone) -> bool {
    let sides = points.clone().zip(points.skip(1)).map(|(a, b)| b - a);
    let Some(start) = sides.clone().next() else { return false };
    let mut pairs = sides.clone().zip(sides.skip(1));
    let bends = |sign: f64| {
        move |(a, b): (Vec2, Vec2)| a.dot(b) > 0.0 && a.cross(b) * sign >= 0.0 && start.cross(b) * sign >= 0.0
    };
    pairs.clone().all(bends(1.0)) || pairs.all(bends(-1.0))
}

fn meets(r: &Rect, area: &Rect) -> bool {
    r.x0 <= area.x1 && area.x0 <= r.x1 && r.y0 <= area.y1 && area.y0 <= r.y1
}

/// The squared distance from `q` to the straight line between `a` and `b`.
pub fn distance2_to_segment(q: Point, a: Point, b: Point) -> f64 {
    let side = b - a;
    let length2 = side.hypot2();
    let along = if length2 > 0.0 { ((q - a).dot(side) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (q - (a + side * along)).hypot2()
}
