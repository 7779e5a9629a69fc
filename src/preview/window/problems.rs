//! The list of what is wrong: all of it, wrapped, the place first, above the bar and over the picture.

use kurbo::{Point, Rect};

use super::canvas::Canvas;
use super::state::State;
use super::style::{DIM, MARGIN_PX, PANEL, TEXT_PX, WARNING};
use super::text::Letters;

/// The list takes at most this share of the area.
const MOST: f64 = 0.6;
/// Between two problems, and the stripe beside them, in logical pixels.
const GAP_PX: f64 = 7.0;
const STRIPE_PX: f64 = 3.0;

/// Draws the list if there is one; returns the part of the area that is still free.
pub fn draw(canvas: &mut Canvas, state: &State, letters: &Letters) -> Rect {
    let (area, scale) = (state.area().to_rect(), state.scale);
    let listed = state.words.listed();
    if listed.is_empty() {
        return area;
    }
    let [margin, gap, height] = [MARGIN_PX, GAP_PX, TEXT_PX].map(|length| length * scale);
    let room = (area.width() - 2.5 * margin).max(4.0 * height);
    let mut texts: Vec<_> = listed.iter().map(|p| (letters.wrapped(&p.to_string(), height, room), WARNING)).collect();
    let tall = |texts: &[(std::rc::Rc<super::text::Text>, _)]| {
        texts.iter().map(|(text, _)| text.height() + gap).sum::<f64>() - gap + 2.0 * margin
    };
    if tall(&texts) > MOST * area.height() {
        while texts.len() > 1 && tall(&texts) + gap + height > MOST * area.height() {
            texts.pop();
        }
        let left_out = listed.len() - texts.len();
        if left_out > 0 {
            texts.push((letters.line(&format!("and {left_out} more: plica check lists all"), height), DIM));
        }
    }
    let top = (area.y1 - tall(&texts)).max(0.0).round();
    canvas.rect(Rect::new(area.x0, top, area.x1, area.y1), 0.0, PANEL);
    canvas.rect(Rect::new(area.x0, top, area.x0 + STRIPE_PX * scale, area.y1), 0.0, WARNING);
    let mut y = top + margin;
    for (text, color) in &texts {
        canvas.text(text, Point::new(area.x0 + margin, y), *color);
        y += text.height() + gap;
    }
    Rect { y1: top, ..area }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::problem::Problem;
    use kurbo::Size;

    #[test]
    fn all_problems_are_listed_within_the_window_as_long_as_there_is_room() {
        let letters = Letters::default();
        let long =
            Problem::error("/layers/0/zones/0/motion/0/tool", "there is no tool \"curvy\"").hint("did you mean curve?");
        for (size, count, taken) in [
            (Size::new(960.0, 640.0), 1, 20.0..60.0),
            (Size::new(320.0, 434.0), 1, 40.0..90.0),
            (Size::new(480.0, 434.0), 4, 60.0..100.0),
            (Size::new(480.0, 434.0), 90, 150.0..241.0),
        ] {
            let mut state = State::default();
            state.resize(size, 1.0);
            state.words.follow_link(vec![long.clone(); count]);
            let mut canvas = Canvas::default();
            let free = draw(&mut canvas, &state, &letters);
            assert!(taken.contains(&(state.area().height - free.y1)), "{size:?} {count}: {free:?}");
            let (width, bottom) = (size.width as f32, state.area().height as f32);
            assert!(canvas.strokes.iter().all(|s| s.b[0] <= width && s.b[1] <= bottom && s.a[1] >= free.y1 as f32));
            state.words.put_away();
            assert_eq!(draw(&mut canvas, &state, &letters), state.area().to_rect());
        }
    }
}
