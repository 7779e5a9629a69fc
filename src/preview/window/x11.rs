//! What winit does not do on X11, over a connection of our own: a window that opens without taking the keyboard, and takes it
//! where no window manager gives it; whether the window can be seen at all, and how wheel events are reported.

use winit::raw_window_handle::{HasWindowHandle, RawWindowHandle};
use winit::window::Window;
use x11rb::protocol::xinput::{ConnectionExt as _, DeviceClassData, DeviceType};
use x11rb::protocol::xproto::{AtomEnum, ConnectionExt as _, InputFocus, KeyButMask, MapState, PropMode};
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;

use super::grasp::Held;

/// A window on an X server.
pub struct Desk {
    server: RustConnection,
    window: u32,
}

/// All master devices, for XIQueryDevice.
const ALL_MASTERS: u16 = 1;

impl Desk {
    /// The window as its server knows it; `None` if it is no window of an X server.
    pub fn of(window: &Window) -> Option<Desk> {
        let window = match window.window_handle().ok()?.as_raw() {
            RawWindowHandle::Xlib(handle) => u32::try_from(handle.window).ok()?,
            RawWindowHandle::Xcb(handle) => handle.window.get(),
            _ => return None,
        };
        let (server, _) = x11rb::connect(None).ok()?;
        Some(Desk { server, window })
    }

    /// The window, which is not shown yet, is to open without the keyboard: window managers hold back who says that nobody
    /// asked for it (`_NET_WM_USER_TIME` 0). Where that fails it opens as others do.
    pub fn leave_the_keyboard(&self) {
        let ask = || -> Result<(), Box<dyn std::error::Error>> {
            let atom = self.server.intern_atom(false, b"_NET_WM_USER_TIME")?.reply()?.atom;
            let kind = AtomEnum::CARDINAL;
            self.server.change_property32(PropMode::REPLACE, self.window, atom, kind, &[0])?.check()?;
            Ok(())
        };
        if let Err(error) = ask() {
            tracing::info!("the window may take the keyboard: {error}");
        }
    }

    /// Takes the keyboard where no window manager (`_NET_SUPPORTING_WM_CHECK`) gives it to the window that is clicked.
    pub fn take_the_keyboard(&self) {
        let ask = || -> Result<(), Box<dyn std::error::Error>> {
            let root = self.server.query_tree(self.window)?.reply()?.root;
            let atom = self.server.intern_atom(false, b"_NET_SUPPORTING_WM_CHECK")?.reply()?.atom;
            let managed = self.server.get_property(false, root, atom, AtomEnum::WINDOW, 0, 1)?.reply()?.length > 0;
            if !managed {
                self.server.set_input_focus(InputFocus::POINTER_ROOT, self.window, x11rb::CURRENT_TIME)?.check()?;
            }
            Ok(())
        };
        if let Err(error) = ask() {
            tracing::info!("the window may have no keyboard: {error}");
        }
    }

    /// The keys that are held with the mouse: who has the keyboard is told, but a window may be dragged in without it.
    pub fn held(&self) -> Option<Held> {
        let held = u16::from(self.server.query_pointer(self.window).ok()?.reply().ok()?.mask);
        let is_held = |key: KeyButMask| held & u16::from(key) != 0;
        let [shift, alt, ctrl] = [KeyButMask::SHIFT, KeyButMask::MOD1, KeyButMask::CONTROL].map(is_held);
        Some(Held { shift, alt, ctrl })
    }

    /// Whether the window is there to be seen: neither minimised nor on another desktop.
    pub fn is_seen(&self) -> bool {
        let attributes = self.server.get_window_attributes(self.window).ok().and_then(|asked| asked.reply().ok());
        attributes.is_none_or(|attributes| attributes.map_state == MapState::VIEWABLE)
    }

    /// Whether a notch of the wheel comes as a button that goes down and up, which winit tells of twice: so do virtual
    /// pointers (XTEST, as of VNC and xrdp). Real wheels have axes.
    pub fn wheel_is_a_button(&self) -> bool {
        let masters = self.server.xinput_xi_query_device(ALL_MASTERS).ok().and_then(|asked| asked.reply().ok());
        let pointer =
            masters.and_then(|all| all.infos.into_iter().find(|info| info.type_ == DeviceType::MASTER_POINTER));
        // The master has the classes of the device that moved last.
        pointer.is_some_and(|pointer| {
            !pointer.classes.iter().any(|class| matches!(class.data, DeviceClassData::Scroll(_)))
        })
    }
}
