//! Letters as strokes, so that text is drawn by the same anti-aliased lines as everything else, crisp at every scale and
//! without a font. On a grid: capitals are 6 high, small letters 4, the line 10.

use kurbo::Point;

/// Height of a line on the grid.
pub const LINE: f64 = 10.0;
/// The base line, from the top of the capitals.
pub const BASE: f64 = 6.0;
/// Between two letters.
const GAP: f64 = 2.0;
const SPACE: f64 = 3.0;
/// What stands for a letter that is not in the table.
const UNKNOWN: &str = "0040460600";

/// From `!` to `~`: strokes of points, two digits each (column, row); a stroke of one point is a dot.
const GLYPHS: [&str; 94] = [
    "0004 06",
    "0002 2022",
    "1016 3036 0242 0444",
    "413010010213334445361605 2027",
    "4006 0010110100 3545463635",
    "46121120310405162644",
    "0002",
    "10010516",
    "00111506",
    "2024 0143 4103",
    "2125 0343",
    "1607",
    "0333",
    "06",
    "0640",
    // digits
    "103041453616050110",
    "112026 1636",
    "01103041420646",
    "01103041423313 334445361605",
    "36300444",
    "400002324345361605",
    "30100105163645443303",
    "004016",
    "13020110304142331304051636454433",
    "16364541301001021343",
    "02 06",
    "02 1607",
    "310335",
    "0242 0444",
    "013305",
    "01103041422324 26",
    "4616050110304144242242",
    // capitals
    "062046 1434",
    "00063645443303 0030414233",
    "4130100105163645",
    "00062644422000",
    "40000646 0333",
    "400006 0333",
    "41301001051636454323",
    "0006 4046 0343",
    "0006",
    "3035261605",
    "0006 400346",
    "000646",
    "0600234046",
    "06004640",
    "103041453616050110",
    "06003041423303",
    "103041453616050110 2446",
    "06003041423303 2346",
    "413010010213334445361605",
    "0040 2026",
    "000516364540",
    "002640",
    "0016233640",
    "0046 4006",
    "002340 2326",
    "00400646",
    "10000616",
    "0046",
    "00101606",
    "022042",
    "0747",
    "0011",
    // small letters
    "0222333616051434",
    "00062635332202",
    "321203051636",
    "30361605031232",
    "043433221203051636",
    "201116 0222",
    "361605031232372808",
    "0006 02223336",
    "0206 00",
    "121708 10",
    "0006 320436",
    "000516",
    "0602324346 2226",
    "0602223336",
    "122233352616050312",
    "08022233352606",
    "38321203051636",
    "0602 031222",
    "3212031424352606",
    "101526 0222",
    "02051636 3236",
    "022642",
    "0216233642",
    "0236 3206",
    "02051636 32372808",
    "02320636",
    "20111203141526",
    "0007",
    "00111223141506",
    "04132433",
];

/// The strokes of a text whose capitals begin at `at`; `size` is the length of a grid step.
pub fn strokes(text: &str, at: Point, size: f64, mut draw: impl FnMut(&[Point])) {
    let mut x = 0.0;
    let mut stroke = Vec::new();
    for letter in text.chars() {
        for points in glyph(letter).split(' ') {
            stroke.clear();
            stroke.extend(
                points.as_bytes().chunks_exact(2).map(|p| {
                    Point::new(at.x + (x + f64::from(p[0] - b'0')) * size, at.y + f64::from(p[1] - b'0') * size)
                }),
            );
            draw(&stroke);
        }
        x += advance(letter);
    }
}

/// Width of a text on the grid.
pub fn width(text: &str) -> f64 {
    (text.chars().map(advance).sum::<f64>() - GAP).max(0.0)
}

fn glyph(letter: char) -> &'static str {
    match letter {
        ' ' => "",
        '!'..='~' => GLYPHS[letter as usize - '!' as usize],
        _ => UNKNOWN,
    }
}

fn advance(letter: char) -> f64 {
    let widest = glyph(letter).split(' ').flat_map(|s| s.as_bytes().iter().step_by(2)).max();
    widest.map_or(SPACE, |w| f64::from(w - b'0') + GAP)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_glyph_is_pairs_of_digits_within_the_grid() {
        for glyph in GLYPHS.iter().chain([&UNKNOWN]) {
            for stroke in glyph.split(' ') {
                assert!(!stroke.is_empty() && stroke.len() % 2 == 0, "{glyph}");
                let within = |p: &[u8]| (b'0'..=b'4').contains(&p[0]) && (b'0'..=b'8').contains(&p[1]);
                assert!(stroke.as_bytes().chunks_exact(2).all(within), "{glyph}");
            }
        }
    }

    #[test]
    fn digits_are_equally_wide() {
        assert!(('0'..='9').filter(|&d| d != '1').all(|d| advance(d) == advance('0')));
    }

    #[test]
    fn text_runs_to_the_right() {
        let mut right = 0.0;
        strokes("ab", Point::ZERO, 2.0, |stroke| right = stroke.iter().fold(right, |r: f64, p| r.max(p.x)));
        assert_eq!(right, width("ab") * 2.0);
    }
}
