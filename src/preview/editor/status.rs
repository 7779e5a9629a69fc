//! How the windows are doing, for the editor's status line.

use std::fmt;

/// How the windows are doing; `Display` makes it the words of the status line.
#[derive(Clone, Debug, PartialEq)]
pub enum Status {
    /// There is no window, and none is wanted.
    Off,
    /// A window was started and has not joined yet.
    Starting,
    /// Windows are connected. The rest is from the window that reported last.
    Connected {
        /// The number of windows.
        windows: usize,
        /// What synthesis took, in milliseconds.
        synth_ms: Option<f64>,
        /// Frames a second.
        fps: Option<f64>,
        /// Name of the graphics adapter.
        adapter: String,
        /// What the window complains about; empty if nothing.
        notice: String,
    },
    /// There is no window, and this is why.
    OffBecause(String),
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Status::Off => write!(f, "off"),
            Status::Starting => write!(f, "starting"),
            Status::OffBecause(reason) => write!(f, "off: {reason}"),
            Status::Connected { windows, fps, notice, .. } => {
                match windows {
                    1 => write!(f, "connected")?,
                    many => write!(f, "{many} connected")?,
                }
                if !notice.is_empty() {
                    return write!(f, ", {notice}");
                }
                fps.filter(|fps| *fps > 0.0).map_or(Ok(()), |fps| write!(f, " {fps:.0} fps"))
            }
        }
    }
}
