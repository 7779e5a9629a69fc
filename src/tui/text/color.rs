//! The colors of the terminal: 24 bits, 256, 16 or none, and the nearest color in each of them. Styles are named by their
//! role, so that only this file deals with light backgrounds and NO_COLOR.

use ratatui::style::{Color, Modifier, Style};

/// How many colors the terminal shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Depth {
    /// No colors: pictures are drawn as characters of different darkness.
    None,
    /// The 16 ANSI colors.
    #[default]
    Ansi,
    /// The 256 colors of xterm.
    Indexed,
    /// 24-bit colors.
    True,
}

impl Depth {
    /// As the environment variables NO_COLOR, COLORTERM and TERM say.
    pub fn of_environment(get: impl Fn(&str) -> Option<String>) -> Depth {
        let is = |name: &str, part: &str| get(name).is_some_and(|value| value.contains(part));
        if get("NO_COLOR").is_some_and(|value| !value.is_empty()) || get("TERM").is_some_and(|term| term == "dumb") {
            Depth::None
        } else if is("COLORTERM", "truecolor") || is("COLORTERM", "24bit") || is("TERM", "direct") {
            Depth::True
        } else if is("TERM", "256color") {
            Depth::Indexed
        } else {
            Depth::Ansi
        }
    }

    /// The nearest color that the terminal has; `None` if it shows no colors.
    pub fn color(self, [r, g, b]: [u8; 3]) -> Option<Color> {
        match self {
            Depth::None => None,
            Depth::Ansi => Some(ansi([r, g, b])),
            Depth::Indexed => Some(Color::Indexed(indexed([r, g, b]))),
            Depth::True => Some(Color::Rgb(r, g, b)),
        }
    }

    /// `style` with a foreground, if the terminal shows colors.
    pub fn ink(self, style: Style, color: Color) -> Style {
        if self == Depth::None { style } else { style.fg(color) }
    }
}

/// The style of what has the focus; it does not depend on colors.
pub fn focus() -> Style {
    Style::new().add_modifier(Modifier::REVERSED)
}

/// The style of what is less important.
pub fn faint() -> Style {
    Style::new().add_modifier(Modifier::DIM)
}

/// The style of headings.
pub fn strong() -> Style {
    Style::new().add_modifier(Modifier::BOLD)
}

/// Characters from dark to light, for terminals without colors.
const SHADES: [char; 10] = [' ', '.', ':', '-', '=', '+', '*', '#', '%', '@'];

/// The character for a color.
pub fn shade(color: [u8; 3]) -> char {
    SHADES[luminance(color) as usize * (SHADES.len() - 1) / 255]
}

/// Perceived brightness, 0 to 255 (Rec. 601 weights on the code values).
pub fn luminance([r, g, b]: [u8; 3]) -> u8 {
    ((u32::from(r) * 299 + u32::from(g) * 587 + u32::from(b) * 114) / 1000) as u8
}

/// xterm's 6 x 6 x 6 cube and its 24 grays.
fn indexed([r, g, b]: [u8; 3]) -> u8 {
    const STEPS: [u8; 6] = [0, 95, 135, 175, 215, 255];
    let nearest = |v: u8| (0..6).min_by_key(|&i| STEPS[i].abs_diff(v)).unwrap_or(0);
    let (i, j, k) = (nearest(r), nearest(g), nearest(b));
    let cube = [STEPS[i], STEPS[j], STEPS[k]];
    let grey = (u16::from(luminance([r, g, b])).saturating_sub(3) / 10).min(23) as u8;
    let level = 8 + 10 * grey;
    if distance([level; 3], [r, g, b]) < distance(cube, [r, g, b]) {
        232 + grey
    } else {
        (16 + 36 * i + 6 * j + k) as u8
    }
}

fn ansi(rgb: [u8; 3]) -> Color {
    const COLORS: [(Color, [u8; 3]); 16] = [
        (Color::Black, [0, 0, 0]),
        (Color::Red, [170, 0, 0]),
        (Color::Green, [0, 170, 0]),
        (Color::Yellow, [170, 85, 0]),
        (Color::Blue, [0, 0, 170]),
        (Color::Magenta, [170, 0, 170]),
        (Color::Cyan, [0, 170, 170]),
        (Color::Gray, [170, 170, 170]),
        (Color::DarkGray, [85, 85, 85]),
        (Color::LightRed, [255, 85, 85]),
        (Color::LightGreen, [85, 255, 85]),
        (Color::LightYellow, [255, 255, 85]),
        (Color::LightBlue, [85, 85, 255]),
        (Color::LightMagenta, [255, 85, 255]),
        (Color::LightCyan, [85, 255, 255]),
        (Color::White, [255, 255, 255]),
    ];
    COLORS.iter().min_by_key(|(_, known)| distance(*known, rgb)).map_or(Color::Reset, |&(color, _)| color)
}

fn distance(a: [u8; 3], b: [u8; 3]) -> u32 {
    a.iter().zip(b).map(|(&x, y)| u32::from(x.abs_diff(y)).pow(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_follows_the_environment() {
        for (environment, depth) in [
            (&[("TERM", "xterm-256color"), ("COLORTERM", "truecolor")][..], Depth::True),
            (&[("TERM", "screen-256color")], Depth::Indexed),
            (&[("TERM", "linux")], Depth::Ansi),
            (&[("TERM", "xterm-16color")], Depth::Ansi),
            (&[("TERM", "xterm-direct")], Depth::True),
            (&[("TERM", "dumb"), ("COLORTERM", "truecolor")], Depth::None),
            (&[("TERM", "screen-256color"), ("COLORTERM", "")], Depth::Indexed),
            (&[("TERM", "xterm-256color"), ("NO_COLOR", "1")], Depth::None),
            (&[("TERM", "linux"), ("NO_COLOR", "")], Depth::Ansi),
        ] {
            let get = |name: &str| environment.iter().find(|(key, _)| *key == name).map(|(_, v)| v.to_string());
            assert_eq!(Depth::of_environment(get), depth, "{environment:?}");
        }
    }

    #[test]
    fn reduced_colors_are_the_nearest() {
        assert_eq!(indexed([255, 0, 0]), 196);
        assert_eq!(indexed([128, 128, 128]), 244);
        assert_eq!(ansi([250, 250, 250]), Color::White);
        assert_eq!((shade([0; 3]), shade([255; 3])), (' ', '@'));
    }
}
