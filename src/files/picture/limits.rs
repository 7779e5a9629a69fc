//! What a picture may take, judged by its header; and the errors of decoders in our words.

use image::ImageError;

use super::kinds;
use crate::base::error::{Error, Result};
use crate::files::Limits;
use crate::files::limits::within;

/// Bytes that a file may take besides its pixels: profiles are read, converted to something small and dropped.
pub(super) const BESIDES_PIXELS: u64 = 32 << 20;

/// Checks the size in a header against the limits.
pub(super) fn check_size(place: &str, (width, height): (usize, usize), limits: &Limits) -> Result<()> {
    if width == 0 || height == 0 {
        return Err(Error::at(place, format!("has no pixels: it is {width} x {height}")));
    }
    let size = format!("is {width} x {height}:");
    within(place, &size, "pixels wide or high", "side", width.max(height) as u64, limits.side)?;
    within(place, &size, "pixels", "pixels", (width as u64).saturating_mul(height as u64), limits.pixels)
}

/// The limits for a decoder of the image crate.
pub(super) fn for_decoder(bytes: u64) -> image::Limits {
    let mut limits = image::Limits::no_limits();
    limits.max_alloc = Some(bytes);
    limits
}

/// Why a decoder of the image crate failed.
pub(super) fn explain(place: &str, error: ImageError) -> Error {
    match error {
        ImageError::Unsupported(error) => kinds::other_kind(place, one_line(&error)),
        ImageError::Limits(_) => Error::at(place, "takes more memory to decode than is allowed")
            .cure("give --limit memory=BYTES, or save it in a simpler way"),
        ImageError::IoError(error) => reading(place, &error),
        error => broken(place, &error),
    }
}

/// Why bytes could not be read.
pub(super) fn reading(place: &str, error: &std::io::Error) -> Error {
    if error.kind() == std::io::ErrorKind::UnexpectedEof { cut_short(place) } else { broken(place, error) }
}

pub(super) fn cut_short(place: &str) -> Error {
    Error::at(place, "is cut short").cure("copy it again from where it came")
}

/// How decoders say that bytes are missing at the end, where they do not say it by an I/O error.
const CUT: &[&str] = &[
    "unexpected end of",
    "image truncated",
    "unexpected input buffer end",
    "failed to fill whole buffer",
    "reference to missing bytes",
    "not enough data was provided",
];

/// What a decoder says of bytes that it can make nothing of: some are missing, or they are wrong.
pub(super) fn broken(place: &str, error: &dyn std::fmt::Display) -> Error {
    let said = one_line(error).to_lowercase();
    if CUT.iter().any(|words| said.contains(words)) {
        return cut_short(place);
    }
    Error::at(place, format!("cannot be decoded: {}", one_line(error))).cure("save it again from another program")
}

/// Some decoders end their message with a line end, or write several lines.
pub(super) fn one_line(text: &dyn std::fmt::Display) -> String {
    text.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}
