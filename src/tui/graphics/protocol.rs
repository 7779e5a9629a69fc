//! How pictures reach the terminal, and which picture a pane wants.

use kurbo::Point;

use super::clip::ClipView;
use crate::layers::parts::marks::View;
use crate::render::part::Part;
use crate::render::passes::Asked;
use crate::render::sight::Sight;
use crate::tui::text::color::Depth;

/// How the picture reaches the terminal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Protocol {
    /// Half-blocks: two dots a cell, in any terminal.
    #[default]
    Blocks,
    /// The kitty graphics protocol.
    Kitty,
    /// iTerm2's inline images.
    Iterm2,
    /// Sixel graphics.
    Sixel,
}

impl Protocol {
    /// Every protocol by its name in commands and options; `auto` is none of them.
    pub const NAMES: [(&str, Protocol); 4] = [
        ("kitty", Protocol::Kitty),
        ("iterm2", Protocol::Iterm2),
        ("sixel", Protocol::Sixel),
        ("blocks", Protocol::Blocks),
    ];

    /// The protocol of that name; `None` for `auto`.
    pub fn named(name: &str) -> Option<Protocol> {
        Protocol::NAMES.iter().find(|(known, _)| *known == name).map(|(_, protocol)| *protocol)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        Protocol::NAMES.iter().find(|(_, one)| *one == self).map_or("", |(name, _)| name)
    }
}

/// How pictures are sent: what the terminal can do, and what the person has set.
#[derive(Clone, Debug, PartialEq)]
pub struct Graphics {
    /// The protocol that the person has set; `None` to use the one that was found.
    pub forced: Option<Protocol>,
    /// The protocol that the terminal understands, by its own answer.
    pub found: Protocol,
    /// Width and height of a cell, in pixels of the screen.
    pub cell: (u16, u16),
    /// Whether the editor runs in tmux, so that escape sequences must be wrapped.
    pub tmux: bool,
    /// The most bytes per frame: while playing, and for a still picture.
    pub bytes: (usize, usize),
    /// The most bytes a second while half-blocks play, on average.
    pub rate: usize,
}

/// The most bytes per frame while playing and still, unless `:graphics bytes` has set another limit.
const BYTES: (usize, usize) = (64_000, 256_000);
/// The same a second: what a slow line still takes, and keys beside it.
const RATE: usize = 55_000;

impl Default for Graphics {
    fn default() -> Self {
        Graphics { forced: None, found: Protocol::Blocks, cell: (8, 16), tmux: false, bytes: BYTES, rate: RATE }
    }
}

impl Graphics {
    /// The protocol in use. Kitty's placeholders name their picture by a color, so they need colors.
    pub fn protocol(&self, depth: Depth) -> Protocol {
        match self.forced.unwrap_or(self.found) {
            Protocol::Kitty if depth == Depth::None => Protocol::Blocks,
            protocol => protocol,
        }
    }

    /// Dots per cell, across and down.
    pub fn dots_a_cell(&self, protocol: Protocol) -> (usize, usize) {
        match protocol {
            Protocol::Blocks => (1, 2),
            Protocol::Kitty | Protocol::Iterm2 | Protocol::Sixel => {
                (self.cell.0.max(1).into(), self.cell.1.max(1).into())
            }
        }
    }

    /// Dots of a pane with so many cells. Sixels come in bands of six rows, and none may hang over the pane's edge.
    pub fn dots(&self, protocol: Protocol, (columns, rows): (u16, u16)) -> (usize, usize) {
        let (width, height) = self.dots_a_cell(protocol);
        let tall = usize::from(rows) * height;
        (usize::from(columns) * width, if protocol == Protocol::Sixel { (tall / 6 * 6).max(1) } else { tall })
    }
}

/// A picture that a pane wants to show.
#[derive(Clone, Debug, PartialEq)]
pub struct Wanted {
    /// Which part, on how many dots.
    pub part: Part,
    /// Columns and rows of the pane.
    pub cells: (u16, u16),
    /// How it reaches the terminal.
    pub protocol: Protocol,
    /// Whether the editor runs in tmux.
    pub tmux: bool,
    /// The most bytes.
    pub bytes: usize,
    /// Whether dots may keep the color that they had before if the difference is hardly visible, so that they are not sent.
    pub calm: bool,
    /// The pass to show in place of the frame.
    pub pass: Option<Asked>,
    /// What to show of a clip in place of the scene.
    pub clip: Option<ClipView>,
    /// What to show in place of what the scene's camera sees.
    pub sight: Option<Sight>,
    /// The overlays that need more than the document alone.
    pub over: View,
    /// The other marks drawn into the pixels; `None` for half-blocks, whose marks are drawn as characters.
    pub marks: Option<Marks>,
}

/// What is drawn over a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Marks {
    /// Which overlays, and what is selected.
    pub view: View,
    /// The cursor.
    pub cursor: Point,
    /// Where the jump vector that is being set begins.
    pub aim: Option<Point>,
}
