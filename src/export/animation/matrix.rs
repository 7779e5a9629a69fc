//! How R'G'B' becomes Y'CbCr. Players take untagged video for BT.709 from 720 lines on and for BT.601 below, so that is the
//! default.

/// A matrix of Y'CbCr.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Matrix {
    /// ITU-R BT.601: what players take small video for.
    Bt601,
    /// ITU-R BT.709: what they take large video for.
    Bt709,
}

/// From this many lines on, video counts as large.
const LARGE: usize = 720;

impl Matrix {
    /// Their names on the command line.
    pub const NAMES: [&str; 2] = ["bt601", "bt709"];

    /// The one of this name.
    pub fn named(name: &str) -> Option<Matrix> {
        let at = Matrix::NAMES.iter().position(|known| *known == name)?;
        Some([Matrix::Bt601, Matrix::Bt709][at])
    }

    /// The one that players assume for video of `lines` lines.
    pub fn expected(lines: usize) -> Matrix {
        if lines < LARGE { Matrix::Bt601 } else { Matrix::Bt709 }
    }

    /// What the header of a y4m calls it.
    pub fn y4m(self) -> &'static str {
        match self {
            Matrix::Bt601 => "BT601",
            Matrix::Bt709 => "BT709",
        }
    }

    /// What ffmpeg calls it.
    pub fn ffmpeg(self) -> &'static str {
        match self {
            Matrix::Bt601 => "smpte170m",
            Matrix::Bt709 => "bt709",
        }
    }

    /// R'G'B' to Y'CbCr, 8 bits, limited range.
    pub fn yuv(self, color: [u8; 3]) -> [u8; 3] {
        let (kr, kb) = match self {
            Matrix::Bt601 => (0.299, 0.114),
            Matrix::Bt709 => (0.2126, 0.0722),
        };
        let [r, g, b] = color.map(|c| f64::from(c) / 255.0);
        let y = kr * r + (1.0 - kr - kb) * g + kb * b;
        let (cb, cr) = ((b - y) / (2.0 - 2.0 * kb), (r - y) / (2.0 - 2.0 * kr));
        [16.0 + 219.0 * y, 128.0 + 224.0 * cb, 128.0 + 224.0 * cr].map(|code| (code + 0.5) as u8)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_colors() {
        for (rgb, bt601, bt709) in [
            ([0, 0, 0], [16, 128, 128], [16, 128, 128]),
            ([255, 255, 255], [235, 128, 128], [235, 128, 128]),
            ([255, 0, 0], [81, 90, 240], [63, 102, 240]),
            ([0, 255, 0], [145, 54, 34], [173, 42, 26]),
            ([0, 0, 255], [41, 240, 110], [32, 240, 118]),
        ] {
            assert_eq!((Matrix::Bt601.yuv(rgb), Matrix::Bt709.yuv(rgb)), (bt601, bt709), "{rgb:?}");
        }
    }

    #[test]
    fn the_matrix_is_the_one_that_players_expect() {
        for (lines, matrix) in [(1, Matrix::Bt601), (719, Matrix::Bt601), (720, Matrix::Bt709), (2160, Matrix::Bt709)] {
            assert_eq!(Matrix::expected(lines), matrix, "{lines}");
        }
        assert_eq!(Matrix::NAMES.map(Matrix::named), [Some(Matrix::Bt601), Some(Matrix::Bt709)]);
        assert_eq!(Matrix::named("bt2020"), None);
    }
}
