//! Colors as people write them.

use super::text::byte_of_hex;

/// Red, green, blue and straight alpha of `#rrggbb` or `#rrggbbaa`, in sRGB.
pub fn parse(text: &str) -> Option<[u8; 4]> {
    let digits = text.strip_prefix('#')?.as_bytes();
    let code = |i: usize| byte_of_hex(digits.get(2 * i..2 * i + 2)?);
    match digits.len() {
        6 => Some([code(0)?, code(1)?, code(2)?, 255]),
        8 => Some([code(0)?, code(1)?, code(2)?, code(3)?]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_are_six_or_eight_digits() {
        for (text, color) in [
            ("#20304a", Some([0x20, 0x30, 0x4a, 255])),
            ("#20304A80", Some([0x20, 0x30, 0x4a, 0x80])),
            ("20304a", None),
            ("#20304", None),
            ("#20304ag0", None),
            ("#+1+1+1", None),
            ("#äöü", None),
        ] {
            assert_eq!(parse(text), color, "{text}");
        }
    }
}
