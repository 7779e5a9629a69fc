//! Wavefront OBJ: v, vt, vn and f are read, the rest is skipped. Three passes over the text: one that counts, so that
//! memory is taken before it is used; one for the numbers; and one for the faces, which may precede what they name.

use std::fmt::Display;
use std::io::BufRead;

use glam::{DVec2, DVec3};

use super::input;
use crate::base::budget::Budget;
use crate::base::error::{Error, Result};
use crate::base::mesh::builder::{Builder, Corner, Counts};
use crate::base::mesh::normals::unit;
use crate::base::text::{counted, there_are};
use crate::files::Limits;
use crate::files::limits::within;

/// How a line begins.
const KEYS: [&[u8]; 10] = [b"v", b"vt", b"vn", b"f", b"o", b"g", b"s", b"mtllib", b"usemtl", b"vp"];

/// Whether the first line that says something is one of an OBJ.
pub(super) fn begins(text: &[u8]) -> bool {
    let mut lines = text.split(|byte| matches!(byte, b'\n' | b'\r')).map(<[u8]>::trim_ascii);
    let first = lines.find(|line| !line.is_empty() && !line.starts_with(b"#")).unwrap_or_default();
    let mut words = first.split(u8::is_ascii_whitespace);
    words.next().is_some_and(|word| KEYS.contains(&word)) && words.next().is_some()
}

/// The lists and the polygons of a file, and what in it is not drawn.
pub(super) fn read(text: &[u8], place: &str, limits: &Limits, budget: &Budget) -> Result<(Builder, Vec<String>)> {
    let text = input::text(text);
    if text.contains(&0) {
        return Err(input::not_text(place));
    }
    let Contents { counts, others, known, unknown } = count(text, place)?;
    within(place, "has", "triangles", "triangles", counts.triangles, limits.triangles)?;
    if counts.triangles == 0 {
        let cure = match () {
            () if unknown > known => "it may not be an OBJ: name a mesh with faces",
            () if others => "its points and lines are not drawn: export it with its faces",
            () if counts.positions > 0 => "it has vertices alone: export it with its faces",
            () => "name a mesh with faces",
        };
        return Err(Error::at(place, "has no triangles").cure(cure));
    }
    let mut builder = Builder::new(counts, place, budget)?;
    for line in Lines::of(text, place) {
        match line.key {
            b"v" => builder.positions.push(DVec3::from_array(line.numbers("a vertex", 3)?)),
            b"vt" => builder.uvs.push(DVec2::from_array(line.numbers("a texture coordinate", 1)?)),
            b"vn" => builder.normals.push(unit(DVec3::from_array(line.numbers("a normal", 3)?))),
            _ => {}
        }
    }
    faces(text, place, counts, &mut builder)?;
    Ok((builder, others.then(|| "its points and lines are not drawn".to_owned()).into_iter().collect()))
}

/// What a text has.
#[derive(Default)]
struct Contents {
    counts: Counts,
    /// Whether there are points or lines.
    others: bool,
    /// How many lines begin as one of an OBJ does, and how many do not.
    known: u64,
    unknown: u64,
}

fn count(text: &[u8], place: &str) -> Result<Contents> {
    let mut found = Contents::default();
    let counts = &mut found.counts;
    for line in Lines::of(text, place) {
        found.known += 1;
        match line.key {
            b"v" => counts.positions += 1,
            b"vt" => counts.uvs += 1,
            b"vn" => counts.normals += 1,
            b"f" => {
                let corners = line.words().count() as u64;
                if corners < 3 {
                    return Err(line.wrong(format!("a face has at least 3 corners, here are {corners}")));
                }
                counts.corners += corners;
                counts.triangles += corners - 2;
            }
            b"p" | b"l" => found.others = true,
            key if KEYS.contains(&key) => {}
            _ => {
                found.known -= 1;
                found.unknown += 1;
            }
        }
    }
    Ok(found)
}

fn faces(text: &[u8], place: &str, counts: Counts, builder: &mut Builder) -> Result<()> {
    let mut lists = Lists {
        positions: List { name: "vertex", total: counts.positions, read: 0 },
        uvs: List { name: "texture coordinate", total: counts.uvs, read: 0 },
        normals: List { name: "normal", total: counts.normals, read: 0 },
    };
    let mut corners = Vec::new();
    for line in Lines::of(text, place) {
        match line.key {
            b"v" => lists.positions.read += 1,
            b"vt" => lists.uvs.read += 1,
            b"vn" => lists.normals.read += 1,
            b"f" => {
                corners.clear();
                for word in line.words() {
                    corners.push(lists.corner(word).map_err(|what| line.wrong(what))?);
                }
                builder.polygon(&corners);
            }
            _ => {}
        }
    }
    Ok(())
}

/// What the numbers of a face count.
struct Lists {
    positions: List,
    uvs: List,
    normals: List,
}

struct List {
    /// What one of it is called.
    name: &'static str,
    /// How many the file has.
    total: u64,
    /// How many precede the present line.
    read: u64,
}

impl Lists {
    /// `1`, `1/2`, `1//3` or `1/2/3`; or what is wrong with it.
    fn corner(&self, word: &[u8]) -> std::result::Result<Corner, String> {
        let mut parts = word.split(|&byte| byte == b'/');
        let mut part = || parts.next().filter(|part| !part.is_empty());
        let (position, uv, normal) = (part(), part(), part());
        let (Some(position), None) = (position, parts.next()) else {
            return Err(format!("{} is not a corner: write it as 1, 1/2, 1//3 or 1/2/3", quoted(word)));
        };
        Ok(Corner {
            position: self.positions.index(position)?,
            uv: uv.map(|uv| self.uvs.index(uv)).transpose()?,
            normal: normal.map(|normal| self.normals.index(normal)).transpose()?,
        })
    }
}

impl List {
    /// The index, from 0, that a number in a face means: from 1, or backward from what has been read.
    fn index(&self, word: &[u8]) -> std::result::Result<u32, String> {
        let List { name, total, read } = self;
        let (digits, back) = word.strip_prefix(b"-").map_or((word, false), |digits| (digits, true));
        let number = whole(digits).ok_or_else(|| format!("{} is not a whole number", quoted(word)))?;
        match (number, back) {
            (u64::MAX, _) => Err(format!("{} is out of range: {}", quoted(word), there_are(total))),
            (0, _) => Err(format!("there is no {name} 0: they are counted from 1")),
            (1.., false) if number <= *total => Ok((number - 1) as u32),
            (1.., true) if number <= *read => Ok((read - number) as u32),
            (1.., false) => Err(format!("there is no {name} {number}: {}", there_are(total))),
            (1.., true) => Err(format!("there is no {name} -{number}: {} before this line", there_are(read))),
        }
    }
}

/// The lines of a text that begin with a word.
struct Lines<'a> {
    rest: &'a [u8],
    /// How lines end: `\n`, which a `\r` may precede; in a text without one, `\r`.
    end: u8,
    place: &'a str,
    number: usize,
}

/// A line: its number from 1, its first word, and the rest.
struct Line<'a> {
    number: usize,
    key: &'a [u8],
    rest: &'a [u8],
    place: &'a str,
    /// Whether it ends with the file and without a line end.
    open: bool,
}

impl<'a> Lines<'a> {
    fn of(text: &'a [u8], place: &'a str) -> Self {
        Lines { rest: text, end: if text.contains(&b'\n') { b'\n' } else { b'\r' }, place, number: 0 }
    }

    /// Takes the next line, which goes on where a `\` precedes its end; and whether it has none.
    fn take_line(&mut self) -> (&'a [u8], bool) {
        let text = self.rest;
        let mut next = 0;
        loop {
            self.number += 1;
            let from = next;
            // The fastest search that the standard library has; reading memory does not fail.
            next += (&text[from..]).skip_until(self.end).unwrap_or_default();
            self.rest = &text[next..];
            let line = text[from..next].trim_ascii_end();
            // A comment may end with a path of Windows.
            if !line.ends_with(b"\\") || line.contains(&b'#') || self.rest.is_empty() {
                return (&text[..next], !text[from..next].ends_with(&[self.end]));
            }
        }
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        while !self.rest.is_empty() {
            let number = self.number + 1;
            let (text, open) = self.take_line();
            let mut words = Words(text);
            if let Some(key) = words.next() {
                return Some(Line { number, key, rest: words.0, place: self.place, open });
            }
        }
        None
    }
}

impl<'a> Line<'a> {
    fn words(&self) -> Words<'a> {
        Words(self.rest)
    }

    /// The numbers of a line, of which there are at least `least`; those that are left out are 0, those too many are
    /// skipped: some files have colors there.
    fn numbers<const N: usize>(&self, what: &str, least: usize) -> Result<[f64; N]> {
        let mut numbers = [0.0; N];
        let mut words = self.words();
        for (at, number) in numbers.iter_mut().enumerate() {
            match words.next() {
                Some(word) => *number = finite(word).map_err(|what| self.wrong(what))?,
                None if at < least => {
                    let expected = counted(least, "number");
                    let found = if at == 1 { "is".to_owned() } else { "are".to_owned() };
                    return Err(self.wrong(format!("{what} has at least {expected}, here {found} {at}")));
                }
                None => {}
            }
        }
        Ok(numbers)
    }

    fn wrong(&self, what: impl Display) -> Error {
        let cure = match self.open {
            true => "the file seems to be cut short: copy it again from where it came",
            false => "mend the line, or export the mesh anew",
        };
        Error::at(self.place, format!("line {}: {what}", self.number)).cure(cure)
    }
}

/// A number of digits alone: a million of them are read. One too large is the largest there is.
fn whole(digits: &[u8]) -> Option<u64> {
    let add = |number: u64, &byte: &u8| {
        let digit = byte.is_ascii_digit().then(|| u64::from(byte - b'0'))?;
        Some(number.saturating_mul(10).saturating_add(digit))
    };
    digits.iter().try_fold(0, add).filter(|_| !digits.is_empty())
}

fn finite(word: &[u8]) -> std::result::Result<f64, String> {
    let number = std::str::from_utf8(word).ok().and_then(|word| word.parse::<f64>().ok());
    match number {
        Some(number) if number.is_finite() => Ok(number),
        Some(_) => Err(format!("{} is not a finite number", quoted(word))),
        None => Err(format!("{} is not a number", quoted(word))),
    }
}

/// A word as it is shown, not too long.
fn quoted(word: &[u8]) -> String {
    const LONGEST: usize = 40;
    let text = String::from_utf8_lossy(word);
    let more = if text.chars().count() > LONGEST { "..." } else { "" };
    format!("\"{}{more}\"", text.chars().take(LONGEST).collect::<String>())
}

/// The words of a line up to its comment.
struct Words<'a>(&'a [u8]);

impl<'a> Iterator for Words<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        // A `\` is blank where the line goes on behind it.
        let blank = |byte: &u8| *byte <= b' ' || *byte == b'\\';
        let from = self.0.iter().position(|byte| !blank(byte)).filter(|&from| self.0[from] != b'#');
        let rest = from.map_or(&[][..], |from| &self.0[from..]);
        let (word, rest) = rest.split_at(rest.iter().position(blank).unwrap_or(rest.len()));
        self.0 = rest;
        (!word.is_empty()).then_some(word)
    }
}
