//! What the mouse drags by a grip: it goes with the pointer, and not before that has moved so far that it is no click.

use kurbo::Point;

use super::state::State;
use crate::base::number;
use crate::scene::grips::Grip;

/// A click may move the pointer by this much, in logical pixels.
pub const CLICK_PX: f64 = 3.0;
/// The border of before and after, and grips, can be grabbed from this distance, in logical pixels.
pub const REACH_PX: f64 = 7.0;
/// With Ctrl what is dragged moves by this share of what the pointer does.
const FINE: f64 = 0.1;

/// The keys that change what the mouse does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Held {
    pub shift: bool,
    pub alt: bool,
    pub ctrl: bool,
}

impl Held {
    /// Alt, or Ctrl and Shift: a vector without length is drawn out.
    pub fn draws_out(self) -> bool {
        self.alt || self.ctrl && self.shift
    }

    /// Alt or Ctrl: window managers often take Alt for themselves.
    pub fn goes_round(self) -> bool {
        self.alt || self.ctrl
    }
}

/// See the top of the file.
#[derive(Clone, Debug)]
pub struct Grasp {
    grip: Grip,
    /// Where the pointer was when the button went down: on the screen, and in the picture.
    pressed: (Point, Point),
    /// Whether it has moved so far that it is no click.
    pub moves: bool,
    /// Where it is to be told to go, if it has moved since that was told last.
    untold: Option<Point>,
}

impl Grasp {
    /// The button goes down on a grip at a place on the screen.
    pub fn new(grip: &Grip, at: Point, state: &State) -> Grasp {
        let pressed = (at, state.viewport.image_from_screen(at, state.area()));
        Grasp { grip: grip.clone(), pressed, moves: false, untold: None }
    }

    /// JSON pointer of what is dragged.
    pub fn pointer(&self) -> &str {
        &self.grip.pointer
    }

    /// Where it has moved to, if that has not been told yet.
    pub fn untold(&mut self) -> Option<Point> {
        self.untold.take()
    }

    /// The pointer is somewhere on the screen: with Shift what is dragged goes only across or only up and down, with Ctrl little
    /// by little. Places are those that people write.
    pub fn follow(&mut self, state: &mut State, held: Held, to: Point) {
        let (area, (on_screen, in_picture)) = (state.area(), self.pressed);
        self.moves |= on_screen.distance(to) > CLICK_PX * state.scale;
        if !self.moves || !area.to_rect().contains(to) {
            return;
        }
        let mut by = state.viewport.image_from_screen(to, area) - in_picture;
        if held.ctrl {
            by *= FINE;
        }
        if held.shift {
            *if by.x.abs() > by.y.abs() { &mut by.y } else { &mut by.x } = 0.0;
        }
        let decimals = if held.ctrl { 2 } else { 1 };
        let rounded = |from: f64, by: f64| if by == 0.0 { from } else { number::rounded(from + by, decimals) };
        let at = Point::new(rounded(self.grip.at.x, by.x), rounded(self.grip.at.y, by.y));
        let dragged = Some((self.grip.pointer.clone(), at));
        if state.dragged != dragged {
            state.dragged = dragged;
            self.untold = Some(at);
        }
    }
}

/// The nearest grip within reach of a place on the screen; of several one that is selected. Vectors without length, as missing
/// handles, are only drawn out if that is asked for, the last one first.
pub fn grip_at(state: &State, at: Point, draws_out: bool) -> Option<&Grip> {
    let far = |grip: &Grip| state.viewport.screen_from_image(grip.at, state.area()).distance(at);
    let grips = state.grips.iter().map(|grip| (grip, far(grip)));
    let near = grips.filter(|(_, far)| *far <= REACH_PX * state.scale && at.y < state.area().height);
    let near: Vec<(&Grip, f64)> = near.collect();
    if let Some((grip, _)) = near.iter().rfind(|(grip, _)| draws_out && grip.is_drawn_in()) {
        return Some(grip);
    }
    let near = near.into_iter().filter(|(grip, _)| !grip.is_drawn_in());
    near.min_by(|(a, near), (b, far)| state.selects(b).cmp(&state.selects(a)).then(near.total_cmp(far)))
        .map(|(grip, _)| grip)
}
