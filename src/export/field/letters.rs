//! The letters that legends need, as strokes on a grid 4 wide and 6 high, the base line at 6: plots look the same
//! everywhere and need no font.

use kurbo::{Point, Vec2};

use super::strokes::{PlotMark, line};

/// The size of a grid step, in pixels of the plot.
const STEP: f64 = 1.55;
/// From letter to letter, in grid steps.
const ADVANCE: f64 = 6.0;

/// A letter and its strokes: pairs of digits x, y; a space begins another stroke.
const LETTERS: [(char, &str); 28] = [
    ('0', "103041453616050110"),
    ('1', "112026 1636"),
    ('2', "01103041420646"),
    ('3', "0110304142334445361605 2333"),
    ('4', "36300444"),
    ('5', "400003334445361605"),
    ('6', "30100105163645443303"),
    ('7', "004016"),
    ('8', "103041423313020110 1304051636454433"),
    ('9', "43130201103041453616"),
    ('.', "1616"),
    ('-', "1434"),
    ('c', "4332120305163645"),
    ('d', "4046 4332120305163645"),
    ('e', "04444332120305163645"),
    ('g', "4247381807 4332120305163645"),
    ('h', "0006 0312324346"),
    ('i', "2226 2020"),
    ('j', "22271808 2020"),
    ('l', "2026"),
    ('m', "0206 03122326 23324346"),
    ('n', "0206 0312324346"),
    ('p', "0208 0312324345361605"),
    ('r', "0206 031232"),
    ('t', "20253646 1232"),
    ('u', "0205163645 4246"),
    ('v', "022642"),
    ('x', "0246 4206"),
];

/// How wide a text is.
pub fn width(text: &str) -> f64 {
    text.chars().count() as f64 * ADVANCE * STEP
}

/// Writes `text` from `at` on, the left end of its base line. Letters that are not in the table are left out.
pub fn write(text: &str, at: Point, color: [u8; 4], marks: &mut Vec<PlotMark>) {
    for (k, c) in text.chars().enumerate() {
        let Some((_, strokes)) = LETTERS.iter().find(|(letter, _)| *letter == c) else { continue };
        let corner = at + Vec2::new(k as f64 * ADVANCE * STEP, -6.0 * STEP);
        for stroke in strokes.split(' ') {
            let digits: Vec<f64> = stroke.bytes().map(|b| f64::from(b - b'0')).collect();
            let mut points: Vec<Point> =
                digits.chunks_exact(2).map(|xy| corner + Vec2::new(xy[0], xy[1]) * STEP).collect();
            if points.windows(2).all(|pair| pair[0] == pair[1]) {
                points.truncate(1);
                points.extend(points.first().map(|&p| p + Vec2::new(0.0, 0.8))); // a dot
            }
            marks.push(line(points, 1.2, color));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Plot, png};
    use super::*;

    #[test]
    fn letters_lie_on_their_grid() {
        for (letter, _) in LETTERS {
            let mut marks = Vec::new();
            write(&letter.to_string(), Point::ZERO, [0; 4], &mut marks);
            assert!(!marks.is_empty(), "{letter}");
            for point in marks.iter().flat_map(|m| &m.points) {
                let (x, y) = (point.x / STEP, point.y / STEP);
                assert!((0.0..=4.0).contains(&x) && (-6.0..=2.0).contains(&y), "{letter}: {point:?}");
            }
        }
    }

    /// Every letter in the order of the table, against `tests/golden/letters.png`.
    #[test]
    fn the_alphabet_is_golden() {
        let text: String = LETTERS.iter().map(|(letter, _)| letter).collect();
        let mut marks = Vec::new();
        write(&text, Point::new(4.0, 16.0), [0, 0, 0, 255], &mut marks);
        let width = text.chars().count() as f64 * ADVANCE * STEP + 8.0;
        let plot = Plot { width, height: 24.0, picture: None, marks, title: String::new() };
        let drawn = image::load_from_memory(&png(&plot).unwrap()).unwrap().to_rgba8();
        let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/letters.png");
        if std::env::var_os("PLICA_UPDATE").is_some() {
            drawn.save(&file).unwrap();
        }
        let kept = image::open(&file).unwrap().to_rgba8();
        assert_eq!(kept.dimensions(), drawn.dimensions());
        let worst = kept.as_raw().iter().zip(drawn.as_raw()).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
        assert!(worst <= 1, "letters differ from tests/golden by {worst}: PLICA_UPDATE=1 writes them anew");
    }
}
