//! The color atlas: the parts of pictures that samplers can reach, over the whole range of s of their position
//! functions, packed into one texture. A pure function; nothing is encoded here.

use std::sync::Arc;

use kurbo::{Point, Rect, Vec2};

use super::synth::ZoneSynth;
use crate::base::packing::{Packed, pack};
use crate::base::picture::Picture;
use crate::base::pixels::{Beyond, Frame, Grid, Linear, Rgba};

/// A part of a picture: columns `x0..x1`, rows `y0..y1`. If reads beyond the edge give nothing, it may include one
/// column or row beyond the edge, which is transparent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    /// First column.
    pub x0: i64,
    /// First row.
    pub y0: i64,
    /// The column after the last.
    pub x1: i64,
    /// The row after the last.
    pub y1: i64,
}

impl Area {
    /// The whole of a picture.
    pub fn whole(picture: &Picture) -> Self {
        Area { x0: 0, y0: 0, x1: picture.width() as i64, y1: picture.height() as i64 }
    }

    /// The number of columns.
    pub fn width(&self) -> i64 {
        self.x1 - self.x0
    }

    /// The number of rows.
    pub fn height(&self) -> i64 {
        self.y1 - self.y0
    }

    fn union(self, other: Area) -> Self {
        Area {
            x0: self.x0.min(other.x0),
            y0: self.y0.min(other.y0),
            x1: self.x1.max(other.x1),
            y1: self.y1.max(other.y1),
        }
    }

    fn texels(&self) -> i64 {
        self.width() * self.height()
    }
}

/// A part of a picture that samplers read.
#[derive(Clone, Debug)]
pub struct Need {
    /// The picture's name in the scene.
    pub image: String,
    /// The picture.
    pub picture: Arc<Picture>,
    /// The result of a read beyond its edge.
    pub beyond: Beyond,
    /// The part.
    pub area: Area,
}

/// A need and its place in the atlas.
#[derive(Clone, Debug)]
pub struct Piece {
    /// The need.
    pub need: Need,
    /// The atlas column of the first column of its area.
    pub x: usize,
    /// The atlas row of the first row of its area.
    pub y: usize,
}

/// The packed pieces. If there are several, each has a border of one texel that repeats its edge.
#[derive(Clone, Debug)]
pub struct Atlas {
    /// The texels.
    pub colors: Linear,
    /// The pieces.
    pub pieces: Vec<Piece>,
}

/// The texels that the samplers of a zone can read over the whole range of s of its position function, including the
/// extra texel for bilinear reads. `None` for a zone without pixels.
pub fn reach(zone: &ZoneSynth) -> Option<Area> {
    let field = &*zone.field;
    let (low, high) = zone.clock.position.range();
    // Under `cover`, a sampler may wait anywhere between its init-position and where it would be.
    let (low, high) = if field.folds.is_some() { (low.min(0.0), high.max(0.0)) } else { (low, high) };
    let width = field.inside.width();
    let pixels = field.inside.cells().iter().zip(field.jumps.cells()).enumerate().filter(|(_, (inside, _))| **inside);
    let path = |(i, (_, &[x, y])): (usize, (&bool, &[f32; 2]))| {
        let q = Point::new((field.x0 + i % width) as f64 + 0.5, (field.y0 + i / width) as f64 + 0.5);
        let (q, jump) = (q + zone.source.offset, Vec2::new(x.into(), y.into()));
        Rect::from_points(q + jump * low, q + jump * high)
    };
    let all = pixels.map(path).reduce(|a, b| a.union(b))?;
    // The texels within the picture, and one beyond the edge if it differs from the edge.
    let margin = if zone.source.beyond == Beyond::Transparent { 1 } else { 0 };
    let clip = |from: f64, to: f64, n: usize| {
        let within = |at: f64| (at.floor() as i64).clamp(-margin, n as i64 - 1 + margin);
        (within(from - 0.5), within(to - 0.5).saturating_add(1).min(n as i64 - 1 + margin) + 1)
    };
    let (x0, x1) = clip(all.x0, all.x1, zone.source.picture.width());
    let (y0, y1) = clip(all.y0, all.y1, zone.source.picture.height());
    Some(Area { x0, y0, x1, y1 })
}

impl Atlas {
    /// Packs the needs. Also returns, for each need, the index of its piece: needs of the same picture share one if
    /// that takes no more room.
    pub fn new(needs: Vec<Need>) -> (Atlas, Vec<usize>) {
        let (merged, piece_of) = merge(needs);
        let gutter = usize::from(merged.len() > 1);
        let Packed { places, width, height } = packed(&merged, gutter);
        let place = |(need, (x, y)): (Need, (usize, usize))| Piece { need, x: x + gutter, y: y + gutter };
        let pieces: Vec<Piece> = merged.into_iter().zip(places).map(place).collect();
        let mut colors = Grid::filled(width, height, [0.0; 4]);
        for piece in &pieces {
            piece.draw(gutter as i64, &mut colors);
        }
        (Atlas { colors, pieces }, piece_of)
    }
}

impl Atlas {
    /// Gives fully transparent texels of the encoded atlas the colors that their pictures have there: engines that
    /// filter straight alpha blend them into edges.
    pub fn keep_clear_colors(&self, codes: &mut Frame) {
        let (width, gutter) = (codes.width(), i64::from(self.pieces.len() > 1));
        for piece in &self.pieces {
            let picture = &piece.need.picture;
            let within = |at: i64, n: usize| usize::try_from(at).ok().filter(|&at| at < n);
            piece.each(gutter, |(x, y), (column, row)| {
                let place = within(column, picture.width()).zip(within(row, picture.height()));
                picture.keep_clear_color(place, &mut codes.cells_mut()[y * width + x]);
            });
        }
    }
}

impl Piece {
    /// The whole-pixel offset from a position in the piece's picture to the position in the atlas.
    pub fn atlas_from_image(&self) -> Vec2 {
        Vec2::new(self.x as f64 - self.need.area.x0 as f64, self.y as f64 - self.need.area.y0 as f64)
    }

    fn draw(&self, gutter: i64, colors: &mut Linear) {
        let atlas_width = colors.width();
        self.each(gutter, |(x, y), (column, row)| colors.cells_mut()[y * atlas_width + x] = self.texel(column, row));
    }

    /// Calls `each` with every texel's place in the atlas and the column and row of the picture that it shows.
    fn each(&self, gutter: i64, mut each: impl FnMut((usize, usize), (i64, i64))) {
        let Area { x0, y0, x1, y1 } = self.need.area;
        for row in -gutter..y1 - y0 + gutter {
            for column in -gutter..x1 - x0 + gutter {
                let place = ((self.x as i64 + column) as usize, (self.y as i64 + row) as usize);
                each(place, ((column + x0).clamp(x0, x1 - 1), (row + y0).clamp(y0, y1 - 1)));
            }
        }
    }

    /// The texel of the picture, transparent beyond its edge.
    fn texel(&self, x: i64, y: i64) -> Rgba {
        let picture = &self.need.picture;
        let within = x >= 0 && y >= 0 && x < picture.width() as i64 && y < picture.height() as i64;
        if within { picture.texel(x as usize, y as usize) } else { [0.0; 4] }
    }
}

/// Joins needs of the same picture while one area around both is no larger than the two together.
fn merge(mut merged: Vec<Need>) -> (Vec<Need>, Vec<usize>) {
    let mut piece_of: Vec<usize> = (0..merged.len()).collect();
    while let Some((a, b)) = joinable(&merged) {
        merged[a].area = merged[a].area.union(merged[b].area);
        merged.remove(b);
        for piece in &mut piece_of {
            *piece = if *piece == b { a } else { *piece - usize::from(*piece > b) };
        }
    }
    (merged, piece_of)
}

fn joinable(needs: &[Need]) -> Option<(usize, usize)> {
    let fits = |a: &Need, b: &Need| {
        let same = a.image == b.image && a.beyond == b.beyond;
        same && a.area.union(b.area).texels() <= a.area.texels() + b.area.texels()
    };
    (0..needs.len()).flat_map(|a| (a + 1..needs.len()).map(move |b| (a, b))).find(|&(a, b)| fits(&needs[a], &needs[b]))
}

/// Places for the areas with a border of `gutter` each.
fn packed(needs: &[Need], gutter: usize) -> Packed {
    let size = |need: &Need| (need.area.width() as usize + 2 * gutter, need.area.height() as usize + 2 * gutter);
    pack(&needs.iter().map(size).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(width: usize, height: usize, shade: f32) -> Arc<Picture> {
        let cells = (0..width * height).map(|i| [shade, (i % width) as f32, (i / width) as f32, 1.0]);
        Arc::new(Picture::from_cells(width, height, cells.collect()))
    }

    fn need(image: &str, picture: &Arc<Picture>, beyond: Beyond, area: [i64; 4]) -> Need {
        let [x0, y0, x1, y1] = area;
        Need { image: image.into(), picture: picture.clone(), beyond, area: Area { x0, y0, x1, y1 } }
    }

    #[test]
    fn one_picture_alone_is_the_atlas() {
        let only = picture(7, 5, 0.5);
        let (atlas, piece_of) = Atlas::new(vec![
            need("a", &only, Beyond::Clamp, [0, 0, 7, 5]),
            need("a", &only, Beyond::Clamp, [2, 2, 4, 4]),
        ]);
        assert_eq!((atlas.colors, piece_of), (only.to_linear(), vec![0, 0]));
    }

    #[test]
    fn pieces_never_bleed_into_a_neighbour() {
        let pictures: Vec<_> = (0..6).map(|k| picture(5 + 3 * k, 20 - 2 * k, 0.1 * k as f32)).collect();
        let whole = |(k, p): (usize, &Arc<Picture>)| {
            need(&k.to_string(), p, Beyond::Clamp, [0, 0, p.width() as i64, p.height() as i64])
        };
        let (atlas, piece_of) = Atlas::new(pictures.iter().enumerate().map(whole).collect());
        assert_eq!(piece_of, [0, 1, 2, 3, 4, 5]);
        for (piece, picture) in atlas.pieces.iter().zip(&pictures) {
            let (w, h) = (picture.width() as f64, picture.height() as f64);
            for (x, y) in [(0.0, 0.0), (w, 0.0), (0.0, h), (w, h), (w / 2.0, 0.0), (1.3, 2.7)] {
                let at = Point::new(x, y) + piece.atlas_from_image();
                assert_eq!(atlas.colors.read(at.x, at.y, Beyond::Clamp), picture.read(x, y, Beyond::Clamp), "{x} {y}");
            }
        }
        let packed = atlas.colors.width() * atlas.colors.height();
        let needed: usize = pictures.iter().map(|p| p.width() * p.height()).sum();
        assert!(packed < 2 * needed, "{packed} texels for {needed}");
    }

    #[test]
    fn beyond_a_named_picture_lies_nothing() {
        let (own, named) = (picture(9, 9, 0.1), picture(4, 4, 0.9));
        let (atlas, _) = Atlas::new(vec![
            need("own", &own, Beyond::Clamp, [0, 0, 9, 9]),
            need("named", &named, Beyond::Transparent, [-1, 1, 3, 4]),
        ]);
        let at = Point::new(0.0, 2.5) + atlas.pieces[1].atlas_from_image();
        assert_eq!(atlas.colors.read(at.x, at.y, Beyond::Clamp), named.read(0.0, 2.5, Beyond::Transparent));
    }

    #[test]
    fn far_parts_of_one_picture_stay_apart() {
        let only = picture(100, 100, 0.5);
        let (atlas, piece_of) = Atlas::new(vec![
            need("a", &only, Beyond::Clamp, [0, 0, 5, 5]),
            need("a", &only, Beyond::Clamp, [90, 90, 99, 99]),
            need("a", &only, Beyond::Clamp, [2, 0, 7, 5]),
        ]);
        assert_eq!((atlas.pieces.len(), piece_of), (2, vec![0, 1, 0]));
    }
}
