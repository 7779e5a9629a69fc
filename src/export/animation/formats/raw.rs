//! Uncompressed frames for other programs: YUV4MPEG2 and bare RGBA.
//!
//! y4m is 4:4:4, 8 bits, in limited range, by the matrix that players assume for its size. The header says all of it, but
//! few readers look at the matrix there: whoever encodes it should say it again (docs/outputs.md has the commands).

use std::io::Write;

use crate::base::error::Result;
use crate::base::pixels::{Frame, decode, encode};
use crate::export::animation::{Out, Show, Sink};
use crate::files::outputs::Kind;

/// What messages call a file of YUV4MPEG2, and how one is recognized.
pub const Y4M: Kind = Kind { name: "y4m video", is: |found| found.head.starts_with(b"YUV4MPEG2 ") };

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
        self.out.write_all(frame.cells().as_flattened()).map_err(|e| self.show.unwritten(e))
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
        "YUV4MPEG2 W{width} H{height} F{}:{} Ip A1:1 C444 XYSCSS=444 XCOLORRANGE=LIMITED XMATRIX={}\n",
        rate.num,
        rate.den,
        show.matrix().y4m()
    );
    out.write_all(header.as_bytes()).map_err(|e| show.unwritten(e))?;
    Ok(Box::new(Y4m { out, show, transparent: false }))
}

/// Bytes that [`y4m`] keeps: the planes, and the room in which they grow.
pub fn y4m_memory(show: &Show) -> u64 {
    9 * show.pixels()
}

struct Y4m {
    out: Out,
    show: Show,
    transparent: bool,
}

impl Sink for Y4m {
    fn frame(&mut self, _: u64, frame: Frame) -> Result<()> {
        self.transparent |= frame.cells().iter().any(|c| c[3] < 255);
        let matrix = self.show.matrix();
        let yuv: Vec<[u8; 3]> = frame.cells().iter().map(|&c| matrix.yuv(opaque(c))).collect();
        let planes = (0..3).flat_map(|plane| yuv.iter().map(move |c| c[plane]));
        let bytes: Vec<u8> = b"FRAME\n".iter().copied().chain(planes).collect();
        self.out.write_all(&bytes).map_err(|e| self.show.unwritten(e))
    }

    fn finish(self: Box<Self>) -> Result<Vec<String>> {
        self.out.keep(&self.show)?;
        let note = format!("{}: y4m has no alpha; transparent parts lie on black", self.show.place);
        Ok(self.transparent.then_some(note).into_iter().collect())
    }
}

/// The color laid on black in linear light.
pub fn opaque(color: [u8; 4]) -> [u8; 3] {
    if color[3] == 255 {
        return [color[0], color[1], color[2]];
    }
    let [r, g, b, _] = decode(color);
    let [r, g, b, _] = encode([r, g, b, 1.0]);
    [r, g, b]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transparent_parts_lie_on_black() {
        assert_eq!(opaque([255, 255, 255, 0]), [0, 0, 0]);
        assert_eq!(opaque([255, 10, 0, 255]), [255, 10, 0]);
    }
}
