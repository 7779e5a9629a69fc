//! Whether a window can be opened here, and what to do instead.

use std::path::Path;

use crate::base::system;
use crate::preview::remote::address;

/// Whether the editor should open a window unasked: if there is a display, and not one that is reached through ssh.
pub fn opens_by_itself() -> bool {
    has_display() && !system::over_ssh()
}

/// Whether there is a display here.
pub fn has_display() -> bool {
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    cfg!(target_os = "macos") || set("DISPLAY") || set("WAYLAND_DISPLAY")
}

/// Why no window can be opened here, and what to do instead.
pub(super) fn no_window(scene: &Path) -> Option<String> {
    if !cfg!(feature = "window") {
        return Some("this plica was built without the window".into());
    }
    let home = || {
        way_home(scene)
            .map_or("plica view where there is one (or ssh -X) joins".into(), |line| format!("at home: {line}"))
    };
    (!has_display()).then(|| format!("no display here; {}", home()))
}

/// The command to type on the local machine to see `scene` there; `None` if this is not an ssh session.
pub fn way_home(scene: &Path) -> Option<String> {
    let address = address::of_scene_here(scene, |name| std::env::var(name).ok())?;
    Some(format!("plica view {address}"))
}
