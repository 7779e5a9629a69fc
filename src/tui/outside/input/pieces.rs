//! Cuts the bytes of a terminal into complete pieces: a character, an escape sequence, a paste. A slow link delivers a sequence
//! in parts, and if its Esc were taken for a key, the rest of an arrow key would run commands. So an incomplete sequence is
//! held for a while, the longer the less likely it is that a person has typed it; a paste is held until its end.

use std::ops::Range;
use std::time::{Duration, Instant};

/// After this time an Esc alone is a key. Parts of a sequence may arrive 80 ms apart.
const ESCAPE: Duration = Duration::from_millis(120);
/// For `Esc [` and the like, which a person can type, but hardly within the time above.
const PAIR: Duration = Duration::from_millis(300);
/// For what nobody types.
const SEQUENCE: Duration = Duration::from_secs(1);
/// After this silence Ctrl-c ends a paste, because its end may be lost.
const SILENCE: Duration = Duration::from_secs(2);
/// The longest sequence, except for answers with text.
const MOST_SEQUENCE: usize = 256;
const MOST_ANSWER: usize = 64 * 1024;
/// The most bytes of a paste that are held. A much smaller one is already refused later.
const MOST_PASTE: usize = 256 << 20;

const PASTE: &[u8] = b"\x1b[200~";
const PASTED: &[u8] = b"\x1b[201~";

/// A complete piece.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Piece {
    /// A character, or the sequence of a key or a click; or an answer without text.
    Key(Vec<u8>),
    /// The same after an Esc: Alt with that key, or the two keys in a row.
    Alt(Vec<u8>),
    /// An answer with text, as of kitty's protocol or about colors.
    Answer(Vec<u8>),
    /// A paste.
    Paste(String),
}

/// What the held bytes begin with.
#[derive(Debug, PartialEq, Eq)]
enum Shape {
    Key(usize),
    /// An Esc before a piece of so many bytes.
    Alt(usize),
    Answer(usize),
    Paste,
    /// This many bytes without a meaning.
    Broken(usize),
    /// Incomplete; if nothing follows within this time, it is the second.
    Begun(Duration, Box<Shape>),
}

/// Cuts bytes into pieces.
#[derive(Debug)]
pub struct Pieces {
    held: Vec<u8>,
    /// The paste so far.
    paste: Option<Vec<u8>>,
    /// When the last bytes arrived.
    last: Instant,
}

impl Pieces {
    /// No bytes yet.
    pub fn new() -> Self {
        Pieces { held: Vec::new(), paste: None, last: Instant::now() }
    }

    /// Adds bytes that arrived together.
    pub fn feed(&mut self, bytes: &[u8], now: Instant) {
        let silent = now.saturating_duration_since(self.last);
        self.last = now;
        match &mut self.paste {
            Some(_) if bytes == [0x03] && silent >= SILENCE => self.paste = None,
            Some(paste) => {
                let known = paste.len().saturating_sub(PASTED.len());
                paste.extend_from_slice(bytes);
                self.end_paste(known);
            }
            None => self.held.extend_from_slice(bytes),
        }
    }

    /// Looks for the end of the paste from this byte on, and holds what follows it.
    fn end_paste(&mut self, from: usize) {
        let Some(paste) = &mut self.paste else { return };
        let end = paste[from..].windows(PASTED.len()).position(|some| some == PASTED).map(|at| from + at);
        if let Some(end) = end {
            let rest = paste.split_off(end);
            let text = std::mem::take(paste);
            // The paste keeps its place among the held bytes, so that pieces keep the order in which they were sent.
            self.held = [PASTE, &text, &rest].concat();
            self.paste = None;
        } else if paste.len() > MOST_PASTE {
            let kept = paste.len() - PASTED.len();
            paste.drain(MOST_PASTE / 2..kept);
        }
    }

    /// How long to wait for more bytes before `take` treats the held ones as complete; `None` if there are none.
    pub fn patience(&self, now: Instant) -> Option<Duration> {
        match shape(&self.held)? {
            Shape::Begun(patience, _) => Some((self.last + patience).saturating_duration_since(now)),
            _ => Some(Duration::ZERO),
        }
    }

    /// The next complete piece, if there is one by now.
    pub fn take(&mut self, now: Instant) -> Option<Piece> {
        loop {
            let shape = match shape(&self.held)? {
                Shape::Begun(patience, _) if now < self.last + patience => return None,
                Shape::Begun(_, other) => *other,
                shape => shape,
            };
            match shape {
                Shape::Key(n) => return Some(Piece::Key(self.cut(0..n))),
                Shape::Alt(n) => return Some(Piece::Alt(self.cut(1..n))),
                Shape::Answer(n) => return Some(Piece::Answer(self.cut(0..n))),
                Shape::Broken(n) => drop(self.cut(0..n)),
                Shape::Begun(..) => return None,
                Shape::Paste => match self.held.windows(PASTED.len()).position(|some| some == PASTED) {
                    Some(end) => {
                        let text = String::from_utf8_lossy(&self.held[PASTE.len()..end]).into_owned();
                        self.held.drain(..end + PASTED.len());
                        return Some(Piece::Paste(text));
                    }
                    None => {
                        self.paste = Some(self.held.split_off(PASTE.len()));
                        self.held.clear();
                        return None;
                    }
                },
            }
        }
    }

    /// Removes the bytes up to the end of a range, and returns the range.
    fn cut(&mut self, range: Range<usize>) -> Vec<u8> {
        let mut piece: Vec<u8> = self.held.drain(..range.end).collect();
        piece.drain(..range.start);
        piece
    }
}

/// What `bytes` begin with; `None` if there are none.
fn shape(bytes: &[u8]) -> Option<Shape> {
    let (&first, rest) = bytes.split_first()?;
    if first != 0x1b {
        return Some(character(bytes));
    }
    let begun = |patience, other| Shape::Begun(patience, Box::new(other));
    let third = rest.get(1);
    Some(match rest.first() {
        None => begun(ESCAPE, Shape::Key(1)),
        // The second Esc begins another sequence.
        Some(0x1b) => Shape::Key(1),
        Some(b'[') => control(bytes),
        Some(b'O') => keypad(bytes),
        // Only if it can be the beginning of an answer; else a person has typed Esc and a letter.
        Some(b']' | b'P' | b'_') if third.is_none() => begun(PAIR, Shape::Alt(2)),
        Some(b']') if third.is_some_and(u8::is_ascii_digit) => answer(bytes),
        Some(b'P') if third.is_some_and(|c| c.is_ascii_digit() || b">!$+=?".contains(c)) => answer(bytes),
        Some(b'_') if third == Some(&b'G') => answer(bytes),
        Some(_) => match character(rest) {
            Shape::Key(n) => Shape::Alt(1 + n),
            Shape::Begun(patience, _) => begun(patience, Shape::Broken(bytes.len())),
            _ => Shape::Key(1),
        },
    })
}

/// A character in UTF-8.
fn character(bytes: &[u8]) -> Shape {
    let wide = match bytes[0] {
        0x00..=0x7f => 1,
        0xc2..=0xdf => 2,
        0xe0..=0xef => 3,
        0xf0..=0xf4 => 4,
        _ => return Shape::Broken(1),
    };
    match std::str::from_utf8(&bytes[..wide.min(bytes.len())]) {
        Ok(_) => Shape::Key(wide),
        Err(error) if error.error_len().is_none() => {
            Shape::Begun(SEQUENCE, Box::new(Shape::Broken(bytes.len().min(wide))))
        }
        Err(error) => Shape::Broken(error.error_len().unwrap_or(1)),
    }
}

/// A control sequence: `Esc [`, parameters, a final byte.
fn control(bytes: &[u8]) -> Shape {
    if bytes.starts_with(PASTE) {
        return Shape::Paste;
    }
    let begun = |patience, other| Shape::Begun(patience, Box::new(other));
    let body = &bytes[2..];
    match body.first() {
        None => return begun(PAIR, Shape::Alt(2)),
        // In the oldest protocol for clicks three arbitrary bytes follow the final one.
        Some(b'M') if body.len() < 4 => return begun(SEQUENCE, Shape::Broken(bytes.len())),
        Some(b'M') => return Shape::Key(6),
        // Function keys of the console.
        Some(b'[') if body.len() < 2 => return begun(PAIR, Shape::Alt(2)),
        Some(b'[') if (b'A'..=b'E').contains(&body[1]) => return Shape::Key(4),
        Some(b'[') => return Shape::Alt(2),
        Some(_) => {}
    }
    match body.iter().position(|byte| !(0x20..=0x3f).contains(byte)) {
        Some(at) if (0x40..=0x7e).contains(&body[at]) => Shape::Key(2 + at + 1),
        Some(0) => Shape::Alt(2),
        // Another key has interrupted the sequence.
        Some(at) => Shape::Broken(2 + at),
        None if body.len() > MOST_SEQUENCE => Shape::Broken(bytes.len()),
        None => begun(SEQUENCE, Shape::Broken(bytes.len())),
    }
}

/// A key of the keypad or a function key: `Esc O`, perhaps a modifier, a letter.
fn keypad(bytes: &[u8]) -> Shape {
    let body = &bytes[2..];
    let digits = body.iter().take_while(|byte| byte.is_ascii_digit()).count();
    match body.get(digits) {
        Some(b'A'..=b'F' | b'H' | b'I' | b'M' | b'P'..=b'S' | b'X' | b'j'..=b'y') => Shape::Key(2 + digits + 1),
        Some(_) => Shape::Alt(2),
        None if body.is_empty() => Shape::Begun(PAIR, Box::new(Shape::Alt(2))),
        None => Shape::Begun(PAIR, Box::new(Shape::Broken(bytes.len()))),
    }
}

/// An answer with text, up to its terminator.
fn answer(bytes: &[u8]) -> Shape {
    let bell = bytes.iter().position(|&byte| byte == 0x07).filter(|_| bytes[1] == b']').map(|at| at + 1);
    let string = bytes.windows(2).position(|two| two == b"\x1b\\").map(|at| at + 2);
    match bell.into_iter().chain(string).min() {
        Some(end) => Shape::Answer(end),
        None if bytes.len() > MOST_ANSWER => Shape::Broken(bytes.len()),
        None => Shape::Begun(SEQUENCE, Box::new(Shape::Broken(bytes.len()))),
    }
}
