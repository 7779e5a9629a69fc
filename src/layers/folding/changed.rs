//! Which jump vectors of a field an edit leaves as they were. Those are taken over from the field before, with the bits that
//! they would have if all were made anew.

use kurbo::Point;

use super::interpolation::area::Area;
use super::interpolation::cells::LEAF;
use super::thresholds::Paths;

/// Where jump vectors may differ from those that were made before.
pub struct Changed<'a> {
    before: Paths<'a>,
    /// Anchors that are new or gone, and how far they reach, in pixels.
    anchors: Vec<Point>,
    reach_px: f64,
    /// Around the pixels that belong to the zone only now.
    joined: Option<Area>,
}

impl<'a> Changed<'a> {
    /// Only near these anchors, and at pixels that belong to the zone only now.
    pub fn new(before: Paths<'a>, (anchors, reach_px): (Vec<Point>, f64)) -> Self {
        Changed { before, anchors, reach_px, joined: None }
    }

    /// The jump vectors from before at the pixels of `area` that belonged to the zone and still do, 0 at others.
    pub fn take_over(&mut self, area: &Area, inside: &[bool]) -> Vec<[f32; 2]> {
        let before = self.before;
        let both = area.and(&before.area);
        let width = (area.to[0] - area.from[0]) as usize;
        let mut jumps = Vec::with_capacity(inside.len());
        for (y, inside) in (area.from[1]..).zip(inside.chunks_exact(width)) {
            let row = jumps.len();
            jumps.resize(row + width, [0.0; 2]);
            let both = both.filter(|both| (both.from[1]..both.to[1]).contains(&y));
            let was = both.map(|both| {
                let (first, columns) = ((both.from[0] - area.from[0]) as usize, (both.to[0] - both.from[0]) as usize);
                let i = before.index([both.from[0], y]);
                jumps[row + first..][..columns].copy_from_slice(&before.jumps[i..][..columns]);
                (first, &before.inside[i..][..columns])
            });
            let (first, was) = was.unwrap_or_default();
            if inside[first..][..was.len()] == *was && was.len() == width {
                continue;
            }
            for (k, inside) in inside.iter().enumerate() {
                let belonged = k >= first && was.get(k - first) == Some(&true);
                if !inside {
                    jumps[row + k] = [0.0; 2];
                } else if !belonged {
                    self.join([area.from[0] + k as u32, y]);
                }
            }
        }
        jumps
    }

    /// Notes a pixel that belongs to the zone only now.
    fn join(&mut self, pixel: [u32; 2]) {
        let all = self.joined.unwrap_or(Area { from: pixel, to: pixel });
        let from = [0, 1].map(|k| all.from[k].min(pixel[k]));
        self.joined = Some(Area { from, to: [0, 1].map(|k| all.to[k].max(pixel[k] + 1)) });
    }

    /// Whether any jump vector of `part` may differ: told of whole cells of [`LEAF`] pixels, since how a cell is made depends
    /// on all anchors that are near it.
    pub fn touches(&self, part: &Area) -> bool {
        let (from, to) = (part.from.map(|k| k / LEAF * LEAF), part.to.map(|k| k.next_multiple_of(LEAF)));
        let cells = Area { from, to };
        let near = |anchor: &Point| {
            let apart = |k: usize, at: f64| (f64::from(from[k]) - at).max(at - f64::from(to[k])).max(0.0);
            let [x, y] = [apart(0, anchor.x), apart(1, anchor.y)];
            x * x + y * y < self.reach_px * self.reach_px
        };
        self.joined.is_some_and(|joined| joined.and(&cells).is_some()) || self.anchors.iter().any(near)
    }
}
