//! All file access: scenes, pictures, the journal and recovery, watching. Nothing is opened, written or trusted
//! elsewhere.

mod beside;
pub mod cache;
pub mod cameras;
pub mod clips;
pub mod disk;
pub mod draft;
pub mod fields;
pub mod hash;
pub mod holder;
pub mod journal;
pub mod kept;
pub mod limits;
pub mod lines;
pub mod log;
pub mod materials;
pub mod mesh;
pub mod models;
mod options;
pub mod originals;
pub mod outputs;
pub mod paths;
pub mod picture;
pub mod profiles;
pub mod recovery;
pub mod scene;
pub mod session;
pub mod sources;
pub mod styles;
pub mod temporary;
mod through;
pub mod video;
pub mod watch;
pub mod write;

pub use limits::Limits;
pub use options::Options;
pub use write::write_atomic;

use std::time::{SystemTime, UNIX_EPOCH};

/// The current time, in milliseconds since the epoch.
pub(crate) fn now_ms() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.map_or(0, |since| since.as_millis().try_into().unwrap_or(u64::MAX))
}
