//! The one table of formats: what each output is for, and what of a scene it keeps. `plica render --help`, the manual, the
//! documentation (docs/outputs.md) and messages are made from it.

use self::ffmpeg::Codec;
use crate::base::error::Result;
use crate::export::animation::{Out, Show, Sink};
use crate::files::outputs::{self, Existing, Kind};

mod apng;
mod delta;
mod dither;
pub(super) mod ffmpeg;
mod gif;
mod palette;
mod raw;
mod webp;

/// What an output keeps of a scene, in a few words each.
pub struct Keeps {
    /// How transparent a pixel is.
    pub alpha: &'static str,
    /// Its color.
    pub colors: &'static str,
    /// How long a frame is shown.
    pub timing: &'static str,
    /// What follows the end.
    pub ending: &'static str,
}

/// Begins an animation.
pub(super) type Begin = fn(Out, Show) -> Result<Box<dyn Sink>>;

/// How a format is encoded.
#[derive(Clone, Copy)]
pub enum Writer {
    /// By an encoder of our own.
    Own(Begin),
    /// By the person's ffmpeg.
    Ffmpeg(&'static Codec),
}

/// One row of the table of formats.
pub struct Format {
    /// Its name for `--format`.
    pub name: &'static str,
    /// File name extensions that mean it, lower case.
    pub extensions: &'static [&'static str],
    /// What it is good for, one line.
    pub help: &'static str,
    /// Whether it can be written to standard output.
    pub streams: bool,
    /// What it keeps.
    pub keeps: Keeps,
    /// What messages call a file of it, and how one is recognized.
    pub kind: Kind,
    /// Whether it is Y'CbCr, which has a matrix.
    pub(super) matrix: bool,
    pub(super) writer: Writer,
    /// Bytes that its encoder keeps at the most, besides the frame that it is given.
    pub(super) memory: fn(&Show) -> u64,
}

/// Bare pixels have no signature: a file with their extension that begins like nothing else.
const BARE: Kind = Kind { name: "file of bare pixels", is: is_bare };

fn is_bare(found: &Existing) -> bool {
    let named = found.path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("rgba"));
    let others = FORMATS.iter().map(|format| format.kind).filter(|kind| *kind != BARE);
    named && found.length.is_multiple_of(4) && !others.chain(outputs::KINDS).any(|kind| (kind.is)(found))
}

const NO_ENDING: &str = "none: the player decides";

/// Every format of one file. A sequence of files is recognised by its pattern, see [`super::Target::file`].
pub const FORMATS: &[Format] = &[
    Format {
        name: "apng",
        extensions: &["apng"],
        help: "exact; browsers and most viewers play it",
        streams: false,
        keeps: Keeps { alpha: "kept", colors: "exact, tagged sRGB", timing: "exact", ending: "loop or once" },
        kind: outputs::PNG,
        matrix: false,
        writer: Writer::Own(apng::begin),
        memory: apng::memory,
    },
    Format {
        name: "webp",
        extensions: &["webp"],
        help: "exact, smaller than APNG",
        streams: false,
        keeps: Keeps {
            alpha: "kept",
            colors: "exact, tagged sRGB",
            timing: "whole ms, no drift",
            ending: "loop or once",
        },
        kind: webp::KIND,
        matrix: false,
        writer: Writer::Own(webp::begin),
        memory: webp::memory,
    },
    Format {
        name: "gif",
        extensions: &["gif"],
        help: "plays everywhere",
        streams: false,
        keeps: Keeps {
            alpha: "all or nothing",
            colors: "256, no tag",
            timing: "whole 1/100 s, no drift",
            ending: "loop or once",
        },
        kind: gif::KIND,
        matrix: false,
        writer: Writer::Own(gif::begin),
        memory: gif::memory,
    },
    Format {
        name: "mp4",
        extensions: &["mp4"],
        help: "H.264 by your ffmpeg, for everything that plays video",
        streams: false,
        keeps: Keeps { alpha: "lost, on black", colors: "lossy 4:2:0, tagged", timing: "exact", ending: NO_ENDING },
        kind: ffmpeg::MP4.kind,
        matrix: true,
        writer: Writer::Ffmpeg(&ffmpeg::MP4),
        memory: ffmpeg::memory,
    },
    Format {
        name: "webm",
        extensions: &["webm"],
        help: "VP9 by your ffmpeg, for web pages",
        streams: false,
        keeps: Keeps { alpha: "kept, lossy", colors: "lossy 4:2:0, tagged", timing: "whole ms", ending: NO_ENDING },
        kind: ffmpeg::WEBM.kind,
        matrix: true,
        writer: Writer::Ffmpeg(&ffmpeg::WEBM),
        memory: ffmpeg::memory,
    },
    Format {
        name: "mov",
        extensions: &["mov"],
        help: "ProRes 4444 by your ffmpeg, for video editors",
        streams: false,
        keeps: Keeps { alpha: "kept", colors: "10 bits 4:4:4, tagged", timing: "exact", ending: NO_ENDING },
        kind: ffmpeg::MOV.kind,
        matrix: true,
        writer: Writer::Ffmpeg(&ffmpeg::MOV),
        memory: ffmpeg::memory,
    },
    Format {
        name: "y4m",
        extensions: &["y4m"],
        help: "uncompressed video for ffmpeg and other encoders",
        streams: true,
        keeps: Keeps { alpha: "lost, on black", colors: "8 bits Y'CbCr 4:4:4", timing: "exact", ending: NO_ENDING },
        kind: raw::Y4M,
        matrix: true,
        writer: Writer::Own(raw::y4m),
        memory: raw::y4m_memory,
    },
    Format {
        name: "rgba",
        extensions: &["rgba"],
        help: "bare pixels, row after row, frame after frame",
        streams: true,
        keeps: Keeps { alpha: "kept, straight", colors: "exact, 8 bits sRGB", timing: "none", ending: "none" },
        kind: BARE,
        matrix: false,
        writer: Writer::Own(raw::rgba),
        memory: |_| 0,
    },
];

/// What frames keep as light, see [`crate::export::passes`].
const LIGHT: Keeps =
    Keeps { alpha: "kept, premultiplied", colors: "32-bit floats, linear", timing: "none", ending: "none" };

/// Numbered files and a single picture, which have a row but are not formats of their own.
const STILLS: [(&str, &str, Keeps); 4] = [
    (
        "%04d.png",
        "one numbered file per frame, each written as soon as it is done",
        Keeps { alpha: "kept", colors: "exact, tagged sRGB", timing: "none", ending: "none" },
    ),
    (".png", "a single frame", Keeps { alpha: "kept", colors: "exact, tagged sRGB", timing: "none", ending: "none" }),
    ("%04d.exr", "the same as light, for compositing: OpenEXR", LIGHT),
    (".exr", "a single frame as light", LIGHT),
];

/// Every output: how it is named, what it is for, what it keeps.
fn rows() -> impl Iterator<Item = (String, &'static str, &'static Keeps)> {
    let stills = STILLS.iter().map(|(what, help, keeps)| ((*what).to_owned(), *help, keeps));
    let dotted = |format: &Format| format.extensions.iter().map(|e| format!(".{e}")).collect::<Vec<_>>().join(" ");
    stills.chain(FORMATS.iter().map(move |format| (dotted(format), format.help, &format.keeps)))
}

/// The outputs as lines for people: what each is for.
pub fn table() -> String {
    rows().map(|(what, help, _)| format!("  {what:<9} {help}")).collect::<Vec<_>>().join("\n")
}

const HEAD: [&str; 5] = ["output", "alpha", "colors", "timing", "end"];

fn cells() -> Vec<[String; 5]> {
    let row = |(what, _, keeps): (String, &str, &Keeps)| {
        let Keeps { alpha, colors, timing, ending } = keeps;
        [what, (*alpha).into(), (*colors).into(), (*timing).into(), (*ending).into()]
    };
    std::iter::once(HEAD.map(str::to_owned)).chain(rows().map(row)).collect()
}

/// What each output keeps of a scene, as lines for people.
pub fn kept() -> String {
    let cells = cells();
    let width = |column: usize| cells.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths = [0, 1, 2, 3, 4].map(width);
    let line = |row: &[String; 5]| {
        let cells = row.iter().zip(widths).map(|(cell, width)| format!("{cell:<width$}"));
        format!("  {}", cells.collect::<Vec<_>>().join("  ")).trim_end().to_owned()
    };
    cells.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// The same table in Markdown, including what each is for.
#[cfg(test)]
pub fn markdown() -> String {
    let help = std::iter::once("for").chain(rows().map(|(_, help, _)| help));
    let line = |([what, rest @ ..], help): ([String; 5], &str)| {
        let what = if what == HEAD[0] { what } else { format!("`{what}`") };
        format!("| {what} | {help} | {} |\n", rest.join(" | "))
    };
    let mut lines: Vec<String> = cells().into_iter().zip(help).map(line).collect();
    lines.insert(1, format!("|{}\n", " --- |".repeat(6)));
    lines.concat()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn each_kind_of_file_is_recognized_as_itself_only() {
        let heads: [(&[u8], Option<&str>); 10] = [
            (b"\x89PNG\r\n\x1a\n and more", Some("PNG")),
            (b"GIF89a..", Some("GIF")),
            (b"RIFF\0\0\0\0WEBPVP8X", Some("WebP")),
            (b"RIFF\0\0\0\0WAVEfmt ", None),
            (b"YUV4MPEG2 W3 H2 ", Some("y4m video")),
            (b"\0\0\0\x18ftypisom", Some("MP4 video")),
            (b"\0\0\0\x14ftypqt  ", Some("QuickTime video")),
            (b"\x1a\x45\xdf\xa3....webm", Some("WebM video")),
            (b"\x76\x2f\x31\x01....", Some("OpenEXR picture")),
            (b"{\"plica\": 1}", None),
        ];
        for (head, name) in heads {
            let length = head.len() as u64;
            for kind in FORMATS.iter().map(|format| format.kind).chain(outputs::KINDS) {
                let (path, bare) = (Path::new("there.rgba"), name.is_none() && length.is_multiple_of(4));
                let wanted = if kind == BARE { bare } else { name == Some(kind.name) };
                assert_eq!((kind.is)(&Existing { path, length, head }), wanted, "{} over {head:?}", kind.name);
            }
            assert!(!is_bare(&Existing { path: Path::new("there.png"), length, head }));
        }
    }
}
