//! Parts of a picture.

/// Pixels: columns and rows from the first to before the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    /// First column and row.
    pub from: [u32; 2],
    /// Column and row behind the last.
    pub to: [u32; 2],
}

impl Area {
    /// What is in both; `None` if nothing is.
    pub fn and(&self, other: &Area) -> Option<Area> {
        let from = [0, 1].map(|k| self.from[k].max(other.from[k]));
        let to = [0, 1].map(|k| self.to[k].min(other.to[k]));
        (from[0] < to[0] && from[1] < to[1]).then_some(Area { from, to })
    }

    /// How many pixels it has.
    pub fn count(&self) -> u64 {
        let [columns, rows] = [0, 1].map(|k| u64::from(self.to[k] - self.from[k]));
        columns * rows
    }
}

/// Jump vectors of neighboring pixels in a row.
pub struct Stretch<'a> {
    /// Column and row of the first.
    pub pixel: [u32; 2],
    /// x in pixels.
    pub x: &'a mut [f64],
    /// y in pixels.
    pub y: &'a mut [f64],
}
