//! Uncompressed frames for other programs: YUV4MPEG2 and bare RGBA.
//!
//! y4m is 4:4:4, 8 bits, BT.601 in limited range: what ffmpeg and most readers take an unmarked stream for, whatever its
//! size. The header says so too.

use std::io::Write;

use super::{Out, Show, Sink};
use crate::base::error::Result;
use crate::base::pixels::{Frame, decode, encode};

/// Begins bare pixels: sRGB with straight alpha, 4 bytes a pixel.
pub fn rgba(out: Out, show: Show) -> Result<Box<dyn Sink>> {
    Ok(Box::new(Rgba { out, show }))
}

struct Rgba {
    out: Out,
    show: Show,
}

impl Sink for Rgba {
    fn frame(&mut self, _: u64, frame: Frame) -> Result<()> {
        self.out.write_all(frame.cells().as_flattened()).map_err(|e| self.show.failed(e))
    }

    fn finish(self: Box<Self>) -> Result<Vec<String>> {
        self.out.keep(&self.show)?;
        Ok(Vec::new())
    }
}

/// Begins a YUV4MPEG2 stream.
pub fn y4m(mut out: Out, show: Show) -> Result<Box<dyn Sink>> {
    let Show { width, height, rate, .. } = &show;
    let header = format!(
        "YUV4MPEG2 W{width} H{height} F{}:{} Ip A1:1 C444 XYSCSS=444 XCOLORRANGE=LIMITED XMATRIX=BT601\n",
        rate.num, rate.den
    );
    out.write_all(header.as_bytes()).map_err(|e| show.failed(e))?;
    Ok(Box::new(Y4m { out, show, transparent: false }))
}

struct Y4m {
    out: Out,
    show: Show,
    transparent: bool,
}

impl Sink for Y4m {
    fn frame(&mut self, _: u64, frame: Frame) -> Result<()> {
        self.transparent |= frame.cells().iter().any(|c| c[3] < 255);
        let yuv: Vec<[u8; 3]> = frame.cells().iter().map(|&c| bt601(opaque(c))).collect();
        let planes = (0..3).flat_map(|plane| yuv.iter().map(move |c| c[plane]));
        let bytes: Vec<u8> = b"FRAME\n".iter().copied().chain(planes).collect();
        self.out.write_all(&bytes).map_err(|e| self.show.failed(e))
    }

    fn finish(self: Box<Self>) -> Result<Vec<String>> {
        self.out.keep(&self.show)?;
        let note = format!("{}: y4m has no alpha; transparent parts lie on black", self.show.place);
        Ok(self.transparent.then_some(note).into_iter().collect())
    }
}

/// The colour laid on black in linear light.
fn opaque(color: [u8; 4]) -> [u8; 3] {
    if color[3] == 255 {
        return [color[0], color[1], color[2]];
    }
    let [r, g, b, _] = decode(color);
    let [r, g, b, _] = encode([r, g, b, 1.0]);
    [r, g, b]
}

/// R'G'B' to Y'CbCr of ITU-R BT.601, 8 bits, limited range.
fn bt601(color: [u8; 3]) -> [u8; 3] {
    let [r, g, b] = color.map(|c| f64::from(c) / 255.0);
    let y = 0.299 * r + 0.587 * g + 0.114 * b;
    let (cb, cr) = ((b - y) / 1.772, (r - y) / 1.402);
    [16.0 + 219.0 * y, 128.0 + 224.0 * cb, 128.0 + 224.0 * cr].map(|code| (code + 0.5) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_colours() {
        for (rgb, yuv) in [
            ([0, 0, 0], [16, 128, 128]),
            ([255, 255, 255], [235, 128, 128]),
            ([255, 0, 0], [81, 90, 240]),
            ([0, 255, 0], [145, 54, 34]),
            ([0, 0, 255], [41, 240, 110]),
        ] {
            assert_eq!(bt601(rgb), yuv, "{rgb:?}");
        }
        assert_eq!(opaque([255, 255, 255, 0]), [0, 0, 0]);
        assert_eq!(opaque([255, 10, 0, 255]), [255, 10, 0]);
    }
}
