//! A view's picture over what its camera sees of the map, to look at while it is painted.

use std::sync::Arc;

use kurbo::Point;

use super::view::View;
use crate::base::picture::Picture;
use crate::base::pixels::{Linear, Rgba};
use crate::layers::parts::marks::{Look, Mark, Shape};
use crate::layers::parts::shots::Painted;

/// The border of the part of a picture that counts.
static BORDER: Look = Look::new("what of a view counts", 32, [255, 220, 90, 240], 1.2);

/// The most lines of the border that are drawn: the longest.
const MOST: usize = 20_000;

/// The picture of a view, so much of it, over what its camera sees.
pub fn painted(view: &View, seen: &Linear, share: f64) -> Painted {
    let own = view.paint.picture.to_linear();
    let (width, height, share) = (own.width(), own.height(), share as f32);
    let laid = |(over, under): (&Rgba, &Rgba)| {
        let over = over.map(|channel| channel * share);
        std::array::from_fn(|k| over[k] + under[k] * (1.0 - over[3]))
    };
    let cells = own.cells().iter().zip(seen.cells()).map(laid).collect();
    let counts: Vec<bool> = view.paint.pixels().iter().map(|[.., counts]| *counts >= 0.5).collect();
    let mut lines = borders((width, height), |x, y| counts[y * width + x]);
    lines.extend(borders((height, width), |y, x| counts[y * width + x]).into_iter().map(|line| line.map(swapped)));
    lines.sort_by(|[a, b], [c, d]| d.distance(*c).total_cmp(&b.distance(*a)));
    lines.truncate(MOST);
    let mark = |ends: [Point; 2]| {
        let shape = Shape::Line { points: ends.into(), closed: false };
        Mark::new(&BORDER, format!("/surface/views/{}", view.number), shape)
    };
    Painted {
        picture: Arc::new(Picture::from_cells(width, height, cells)),
        marks: lines.into_iter().map(mark).collect(),
    }
}

fn swapped(at: Point) -> Point {
    Point::new(at.y, at.x)
}

/// The level lines between pixels of which one counts and the other does not, each as long as it can be.
fn borders((width, height): (usize, usize), counts: impl Fn(usize, usize) -> bool) -> Vec<[Point; 2]> {
    let mut lines = Vec::new();
    for y in 1..height {
        let mut from = None;
        for x in 0..=width {
            let is_border = x < width && counts(x, y - 1) != counts(x, y);
            match from {
                None if is_border => from = Some(x),
                Some(first) if !is_border => {
                    lines.push([first, x].map(|x| Point::new(x as f64, y as f64)));
                    from = None;
                }
                _ => {}
            }
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::mesh::slots::view_map::tests::view;

    #[test]
    fn a_picture_lies_over_what_is_seen_with_what_counts_outlined() {
        let mut view = view([0.0, 0.0, 4.0], 3);
        let cell = |i: usize| if (1..3).contains(&(i % 4)) && i / 4 == 1 { [0.5, 0.0, 0.0, 1.0] } else { [0.0; 4] };
        view.paint.picture = Arc::new(Picture::from_cells(4, 3, (0..12).map(cell).collect()));
        let seen = Linear::filled(4, 3, [0.0, 0.0, 1.0, 1.0]);
        let found = painted(&view, &seen, 0.25);
        assert_eq!(found.picture.texel(0, 0), [0.0, 0.0, 1.0, 1.0]);
        assert_eq!(found.picture.texel(2, 1), [0.125, 0.0, 0.75, 1.0]);
        let lines: Vec<Vec<[f64; 2]>> = found
            .marks
            .iter()
            .map(|mark| match &mark.shape {
                Shape::Line { points, .. } => points.iter().map(|at| [at.x, at.y]).collect(),
                other => panic!("{other:?}"),
            })
            .collect();
        let expected =
            [[[1.0, 1.0], [3.0, 1.0]], [[1.0, 2.0], [3.0, 2.0]], [[1.0, 1.0], [1.0, 2.0]], [[3.0, 1.0], [3.0, 2.0]]];
        assert_eq!(lines, expected.map(|line| line.to_vec()));
        assert!(found.marks.iter().all(|mark| &*mark.path == "/surface/views/3"));
    }
}
