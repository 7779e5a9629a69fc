//! Text in any script: laid out and drawn into pixels by `cosmic-text`, kept in an atlas from which the shader reads them. A
//! glyph stands on whole pixels at the size that the screen asks for, so that it is crisp at every scale.
//!
//! The window's own font is enough for most text. Those of the system are looked through only once a text needs them, beside
//! the event loop ([`Letters::asks_for_fonts`]): that can take a second.

use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

use cosmic_text::{
    Attrs, Buffer, CacheKey, Ellipsize, EllipsizeHeightLimit, Family, FontSystem, Hinting, Metrics, Shaping,
    SwashCache, Wrap,
};

use super::stroke::{Color, Stroke};
use atlas::Spot;
use fonts::OWN;

mod atlas;
mod fonts;

pub use atlas::{Atlas, WIDTH as ATLAS_WIDTH};
pub use fonts::{Fonts, of_system};

/// Height of a capital of the window's own font, as a share of the font's size.
const CAPITAL: f64 = 0.729;
/// From one base line to the next, in heights of a capital.
pub const LINE: f64 = 1.9;
/// So many texts are remembered; then all are laid out anew.
const MOST_TEXTS: usize = 4096;

/// All that text needs; clones are the same.
#[derive(Clone)]
pub struct Letters(Rc<RefCell<Inner>>);

struct Inner {
    fonts: FontSystem,
    raster: SwashCache,
    atlas: Atlas,
    spots: HashMap<CacheKey, Option<Spot>>,
    texts: HashMap<(String, Manner, u64), Rc<Text>>,
    fallback: Fallback,
    /// Counts how often places in the atlas became void.
    generation: u64,
}

/// Whether the fonts of the system are here.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Fallback {
    NotNeeded,
    Needed,
    Asked,
    Here,
}

/// How a text is brought into its room, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Manner {
    Line,
    /// On one line, with an ellipsis for what does not fit.
    Within(u32),
    /// On as many lines as it takes.
    Wrapped(u32),
}

/// A text laid out.
#[derive(Debug)]
pub struct Text {
    /// Its width, in pixels.
    pub width: f64,
    /// Its lines.
    pub lines: usize,
    /// From one base line to the next, in pixels.
    line: f64,
    height: f64,
    glyphs: Vec<Glyph>,
}

/// A glyph of a text, from the left end of the first base line.
#[derive(Debug)]
struct Glyph {
    at: [i32; 2],
    spot: Spot,
}

impl Text {
    /// From the top of the first line's capitals to the base of the last line.
    pub fn height(&self) -> f64 {
        self.height + self.line * (self.lines.max(1) - 1) as f64
    }

    /// The strokes of the text with the top of its capitals at `at`.
    pub(super) fn strokes(&self, at: kurbo::Point, color: Color) -> impl Iterator<Item = Stroke> + '_ {
        let (x, y) = (at.x.round() as i32, (at.y + self.height).round() as i32);
        self.glyphs.iter().map(move |glyph| {
            let (left, top) = ((x + glyph.at[0]) as f32, (y + glyph.at[1]) as f32);
            let [width, height] = glyph.spot.size.map(f32::from);
            Stroke::glyph([left, top], [left + width, top + height], glyph.spot.texel, color)
        })
    }
}

impl Default for Letters {
    /// With the window's own font.
    fn default() -> Letters {
        Letters(Rc::new(RefCell::new(Inner {
            fonts: fonts::own().into(),
            raster: SwashCache::new(),
            atlas: Atlas::default(),
            spots: HashMap::new(),
            texts: HashMap::new(),
            fallback: Fallback::NotNeeded,
            generation: 0,
        })))
    }
}

impl Letters {
    /// On one line. `height` is that of the capitals, in pixels.
    pub fn line(&self, text: &str, height: f64) -> Rc<Text> {
        self.0.borrow_mut().text(text, Manner::Line, height)
    }

    /// On one line of at most `room` pixels.
    pub fn within(&self, text: &str, height: f64, room: f64) -> Rc<Text> {
        let line = self.line(text, height);
        if line.width <= room { line } else { self.0.borrow_mut().text(text, Manner::Within(room as u32), height) }
    }

    /// On lines of at most `room` pixels.
    pub fn wrapped(&self, text: &str, height: f64, room: f64) -> Rc<Text> {
        let line = self.line(text, height);
        if line.width <= room { line } else { self.0.borrow_mut().text(text, Manner::Wrapped(room as u32), height) }
    }

    /// Width on one line, in pixels.
    pub fn width(&self, text: &str, height: f64) -> f64 {
        self.line(text, height).width
    }

    /// Begins a drawing: an atlas that is full is emptied, and what was laid out before is void.
    pub fn begin(&self) {
        let mut inner = self.0.borrow_mut();
        if inner.atlas.is_full() {
            inner.atlas = Atlas::default();
            inner.forget();
        }
    }

    /// Changes when what was laid out before is void.
    pub fn generation(&self) -> u64 {
        self.0.borrow().generation
    }

    /// Whether a text needs fonts of the system: once.
    pub fn asks_for_fonts(&self) -> bool {
        let mut inner = self.0.borrow_mut();
        let asks = inner.fallback == Fallback::Needed;
        if asks {
            inner.fallback = Fallback::Asked;
        }
        asks
    }

    /// Takes the fonts of the system.
    pub fn take_fonts(&self, fonts: Fonts) {
        let mut inner = self.0.borrow_mut();
        (inner.fonts, inner.fallback) = (fonts.into(), Fallback::Here);
        inner.raster = SwashCache::new();
        inner.forget();
    }

    /// Gives the atlas to who shows it.
    pub fn atlas<T>(&self, show: impl FnOnce(&mut Atlas) -> T) -> T {
        show(&mut self.0.borrow_mut().atlas)
    }
}

impl Inner {
    fn forget(&mut self) {
        self.spots.clear();
        self.texts.clear();
        self.generation += 1;
    }

    fn text(&mut self, text: &str, manner: Manner, height: f64) -> Rc<Text> {
        let key = (text.to_owned(), manner, height.to_bits());
        if let Some(text) = self.texts.get(&key) {
            return text.clone();
        }
        if self.texts.len() >= MOST_TEXTS {
            self.texts.clear();
        }
        let laid = Rc::new(self.lay_out(text, manner, height));
        self.texts.insert(key, laid.clone());
        laid
    }

    fn lay_out(&mut self, text: &str, manner: Manner, height: f64) -> Text {
        let (size, line) = (height / CAPITAL, (height * LINE).round().max(1.0));
        let mut buffer = Buffer::new_empty(Metrics::new(size.max(1.0) as f32, line as f32));
        let (wrap, room) = match manner {
            Manner::Line => (Wrap::None, None),
            Manner::Within(room) => (Wrap::None, Some(room)),
            Manner::Wrapped(room) => (Wrap::WordOrGlyph, Some(room)),
        };
        if matches!(manner, Manner::Within(_)) {
            buffer.set_ellipsize(Ellipsize::End(EllipsizeHeightLimit::Lines(1)));
        }
        buffer.set_wrap(wrap);
        buffer.set_hinting(Hinting::Enabled);
        buffer.set_size(room.map(|room| room as f32), None);
        let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        buffer.set_text(&text, &Attrs::new().family(Family::Name(OWN)), Shaping::Advanced, None);
        buffer.shape_until_scroll(&mut self.fonts, false);
        let mut laid = Text { width: 0.0, lines: 0, line, height, glyphs: Vec::new() };
        for run in buffer.layout_runs() {
            laid.width = laid.width.max(f64::from(run.line_w));
            let down = (laid.lines as f64 * line) as i32;
            laid.lines += 1;
            for glyph in run.glyphs {
                if glyph.glyph_id == 0 && self.fallback == Fallback::NotNeeded {
                    self.fallback = Fallback::Needed;
                }
                let placed = glyph.physical((0.0, 0.0), 1.0);
                let Some(spot) = self.spot(placed.cache_key) else { continue };
                let at = [placed.x + spot.left, placed.y + down - spot.top];
                laid.glyphs.push(Glyph { at, spot });
            }
        }
        laid
    }

    /// The glyph in the atlas; `None` if there is nothing to see, or no room.
    fn spot(&mut self, key: CacheKey) -> Option<Spot> {
        if let Some(spot) = self.spots.get(&key) {
            return *spot;
        }
        let image = self.raster.get_image_uncached(&mut self.fonts, key);
        let spot = image.and_then(|image| self.atlas.put(&image));
        self.spots.insert(key, spot);
        spot
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEIGHT: f64 = 8.0;

    #[test]
    fn text_of_many_scripts_is_drawn_by_the_own_font() {
        let letters = Letters::default();
        for text in ["sea", "linke Dünung", "тень", "θάλασσα", "e\u{301}te\u{301}", "שלום", "بحر"] {
            let laid = letters.line(text, HEIGHT);
            assert!(laid.width > 8.0 && laid.lines == 1 && !laid.glyphs.is_empty(), "{text}: {laid:?}");
            assert!(laid.glyphs.iter().all(|glyph| glyph.at[0] >= -2 && f64::from(glyph.at[0]) < laid.width), "{text}");
        }
        assert!(!letters.asks_for_fonts(), "nothing was missing");
        assert_ne!(letters.line("ü", HEIGHT).glyphs[0].spot, letters.line("u", HEIGHT).glyphs[0].spot);
    }

    #[test]
    fn fonts_of_the_system_are_asked_for_once_and_void_what_was_laid_out() {
        let letters = Letters::default();
        letters.line("飛沫", HEIGHT);
        assert!(letters.asks_for_fonts() && !letters.asks_for_fonts());
        let before = letters.generation();
        letters.take_fonts(of_system());
        assert_ne!(letters.generation(), before);
        letters.line("飛沫", HEIGHT);
        assert!(!letters.asks_for_fonts());
    }

    #[test]
    fn what_does_not_fit_is_shortened_or_wrapped() {
        let letters = Letters::default();
        let text = "the scene cannot be read";
        let room = letters.width("the scene", HEIGHT) + 8.0;
        let (whole, short) = (letters.line(text, HEIGHT), letters.within(text, HEIGHT, room));
        assert!(short.width <= room && short.lines == 1 && short.glyphs.len() < whole.glyphs.len(), "{short:?}");
        assert_eq!(letters.within("the", HEIGHT, room).width, letters.width("the", HEIGHT));
        let wrapped = letters.wrapped(text, HEIGHT, room);
        assert!(wrapped.lines >= 3 && wrapped.width <= room, "{wrapped:?}");
        assert!(wrapped.height() > 2.0 * whole.height());
        let long = letters.wrapped(&"0123456789".repeat(40), HEIGHT, 100.0);
        assert!(long.lines > 10 && long.width <= 100.0, "a word that is too long is broken");
    }

    #[test]
    fn digits_are_equally_wide_and_lines_stay_one() {
        let letters = Letters::default();
        let width = |text: &str| letters.width(text, HEIGHT);
        assert!(('0'..='9').all(|digit| width(&digit.to_string()) == width("0")));
        assert_eq!(letters.line("a\nb\tc", HEIGHT).lines, 1);
        assert_eq!(width(""), 0.0);
    }

    #[test]
    fn a_full_atlas_begins_anew() {
        let letters = Letters::default();
        let before = letters.generation();
        for size in 0..200 {
            letters.line("WMQ@", 100.0 + f64::from(size));
            if letters.atlas(|atlas| atlas.is_full()) {
                letters.begin();
                assert_ne!(letters.generation(), before);
                assert!(!letters.line("WMQ@", HEIGHT).glyphs.is_empty());
                return;
            }
        }
        panic!("never full");
    }
}
