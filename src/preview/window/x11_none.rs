//! Stands in for `x11.rs` on systems without an X server.

use winit::window::Window;

use super::grasp::Held;

/// Never there.
pub enum Desk {}

impl Desk {
    /// None.
    pub fn of(_: &Window) -> Option<Desk> {
        None
    }

    /// See `x11.rs`.
    pub fn leave_the_keyboard(&self) {
        match *self {}
    }

    /// See `x11.rs`.
    pub fn take_the_keyboard(&self) {
        match *self {}
    }

    /// See `x11.rs`.
    pub fn held(&self) -> Option<Held> {
        match *self {}
    }

    /// See `x11.rs`.
    pub fn is_seen(&self) -> bool {
        match *self {}
    }

    /// See `x11.rs`.
    pub fn wheel_is_a_button(&self) -> bool {
        match *self {}
    }
}
