//! The libraries of the window system: which of them is missing, and in which package it is. They are opened at run time, and
//! winit says of each only that one of several is not there.

/// A library that is missing, and the Debian package that holds it.
#[derive(Debug, PartialEq, Eq)]
pub struct Missing {
    /// Its name, or the loader's words that name it.
    pub library: String,
    /// The package.
    pub package: &'static str,
}

/// The beginnings of library names, the longer ones first, and the Debian packages that hold them.
const PACKAGES: &[(&str, &str)] = &[
    ("libX11-xcb", "libx11-xcb1"),
    ("libX11", "libx11-6"),
    ("libXcursor", "libxcursor1"),
    ("libXi", "libxi6"),
    ("libXext", "libxext6"),
    ("libXfixes", "libxfixes3"),
    ("libXrender", "libxrender1"),
    ("libxcb", "libxcb1"),
    ("libXau", "libxau6"),
    ("libXdmcp", "libxdmcp6"),
    ("libxkbcommon-x11", "libxkbcommon-x11-0"),
    ("libxkbcommon", "libxkbcommon0"),
    ("libwayland-client", "libwayland-client0"),
];

/// The package of the first library that a text names.
fn named(text: &str) -> Option<Missing> {
    let words = text.split(|c: char| !(c.is_alphanumeric() || "-_.".contains(c)));
    words.filter(|word| word.starts_with("lib")).find_map(|word| {
        let (_, package) =
            PACKAGES.iter().find(|(name, _)| word.strip_prefix(name).is_some_and(|r| !r.starts_with('-')))?;
        Some(Missing { library: word.trim_end_matches('.').to_owned(), package })
    })
}

/// A library that keeps the window from opening, after winit said `said`.
pub fn missing(said: &str) -> Option<Missing> {
    if said.contains("NoWaylandLib") {
        return named("libwayland-client.so.0");
    }
    named(said).or_else(|| of_x11().and_then(|detail| named(&detail)))
}

/// What the loader says of the first library of X11 that cannot be opened.
#[cfg(all(unix, not(target_os = "macos")))]
fn of_x11() -> Option<String> {
    use x11_dl::error::OpenError;
    let opened: [Result<(), OpenError>; 4] = [
        x11_dl::xlib::Xlib::open().map(drop),
        x11_dl::xlib_xcb::Xlib_xcb::open().map(drop),
        x11_dl::xcursor::Xcursor::open().map(drop),
        x11_dl::xinput2::XInput2::open().map(drop),
    ];
    let of_keys = || {
        let name = match (xkbcommon_dl::xkbcommon_option(), xkbcommon_dl::x11::xkbcommon_x11_option()) {
            (None, _) => "libxkbcommon.so.0",
            (_, None) => "libxkbcommon-x11.so.0",
            _ => return None,
        };
        Some(name.to_owned())
    };
    opened.into_iter().find_map(|opened| opened.err()).map(|error| error.detail().to_owned()).or_else(of_keys)
}

#[cfg(not(all(unix, not(target_os = "macos"))))]
fn of_x11() -> Option<String> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_library_that_is_named_has_its_package() {
        for (said, library, package) in [
            ("libX11-xcb.so.1: file too short; libX11-xcb.so: not found", "libX11-xcb.so.1", "libx11-xcb1"),
            ("libxcb.so.1: cannot open shared object file", "libxcb.so.1", "libxcb1"),
            ("Library libxkbcommon-x11.so could not be loaded.", "libxkbcommon-x11.so", "libxkbcommon-x11-0"),
            ("/usr/lib/libXi.so.6: invalid ELF header", "libXi.so.6", "libxi6"),
            ("WaylandError(NoWaylandLib)", "libwayland-client.so.0", "libwayland-client0"),
        ] {
            assert_eq!(missing(said), Some(Missing { library: library.into(), package }), "{said}");
        }
        assert_eq!(named("the liberty of strangers: libfoo.so"), None);
    }
}
