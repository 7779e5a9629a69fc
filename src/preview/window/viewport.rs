//! Where the picture stands on the screen: zoom and pan. Lengths on the screen are physical pixels.

use kurbo::{Point, Size, Vec2};

use crate::base::maths::{ln, pow};

/// Smallest and largest zoom, in pixels of the screen a pixel of the picture.
const ZOOMS: (f64, f64) = (1.0 / 64.0, 256.0);
/// A fitted picture may stay behind the window by this share, for the sake of a whole factor.
const ALMOST: f64 = 0.01;
/// So much of the picture is always in sight, in pixels of the screen.
const IN_SIGHT_PX: f64 = 64.0;

/// Zoom and place.
#[derive(Clone, Debug, PartialEq)]
pub struct Viewport {
    /// Pixels of the screen a pixel of the picture.
    pub zoom: f64,
    /// The place in the picture that stands in the middle of the area.
    pub center: Point,
    /// How the picture is kept fitted while the window changes its size.
    fitted: Option<Fit>,
}

/// How a picture is fitted into the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fit {
    /// As large as the window lets it be.
    Window,
    /// The same, by a whole factor where that is 1 or more: every pixel is as large as the others.
    Whole,
}

impl Default for Viewport {
    fn default() -> Self {
        Viewport { zoom: 1.0, center: Point::ZERO, fitted: Some(Fit::Window) }
    }
}

impl Viewport {
    /// Where the picture's origin stands on the screen: always a whole pixel, so that 1:1 is exact.
    pub fn origin(&self, area: Size) -> Vec2 {
        let corner = area.to_vec2() / 2.0 - self.center.to_vec2() * self.zoom;
        Vec2::new(corner.x.round(), corner.y.round())
    }

    /// A place in the picture, on the screen.
    pub fn screen_from_image(&self, at: Point, area: Size) -> Point {
        (at.to_vec2() * self.zoom + self.origin(area)).to_point()
    }

    /// A place on the screen, in the picture.
    pub fn image_from_screen(&self, at: Point, area: Size) -> Point {
        ((at.to_vec2() - self.origin(area)) / self.zoom).to_point()
    }

    /// The pixels of a frame that a window shows, `scale` of them a pixel of the picture: left, top, width, height.
    pub fn seen(&self, window: Size, frame: (usize, usize), scale: f64) -> [u32; 4] {
        // One of the screen is the mean of those around it.
        let around = scale / self.zoom + 1.0;
        let origin = self.origin(window);
        let range = |origin: f64, window: f64, frame: usize| {
            let at = |place: f64| (place - origin) / self.zoom * scale;
            let most = (frame as f64 - 1.0).max(0.0);
            let first = (at(0.0) - around).floor().clamp(0.0, most);
            let last = (at(window) + around).ceil().clamp(first + 1.0, most + 1.0);
            [first as u32, (last - first) as u32]
        };
        let ([left, width], [top, height]) =
            (range(origin.x, window.width, frame.0), range(origin.y, window.height, frame.1));
        [left, top, width, height]
    }

    /// Fits a picture into the area.
    pub fn fit(&mut self, picture: Size, area: Size, fit: Fit) {
        let zoom = (area.width / picture.width.max(1.0)).min(area.height / picture.height.max(1.0));
        // What is hardly more than a whole factor stays crisp at that factor.
        let whole = zoom >= 1.0 && (fit == Fit::Whole || zoom < zoom.floor() * (1.0 + ALMOST));
        self.zoom = if whole { zoom.floor() } else { zoom }.clamp(ZOOMS.0, ZOOMS.1);
        self.center = (picture.to_vec2() / 2.0).to_point();
        self.fitted = Some(fit);
    }

    /// Takes the first picture: fitted, or in the middle where a zoom was asked for before it came.
    pub fn first(&mut self, picture: Size, area: Size) {
        self.center = (picture.to_vec2() / 2.0).to_point();
        self.resized(picture, area);
    }

    /// Whether the picture is kept fitted.
    pub fn is_fitted(&self) -> bool {
        self.fitted.is_some()
    }

    /// Shows a place of the picture in the middle.
    pub fn show(&mut self, zoom: f64, center: Point, picture: Size, area: Size) {
        (self.zoom, self.center, self.fitted) = (zoom.clamp(ZOOMS.0, ZOOMS.1), center, None);
        self.keep_in_sight(picture, area);
    }

    /// Actual size (1:1), around the place in the middle; a picture that has room is shown whole.
    pub fn one(&mut self, picture: Size, area: Size) {
        if picture.width <= area.width && picture.height <= area.height {
            self.center = (picture.to_vec2() / 2.0).to_point();
        }
        (self.zoom, self.fitted) = (1.0, None);
        self.keep_in_sight(picture, area);
    }

    /// Follows a change of the area or the picture.
    pub fn resized(&mut self, picture: Size, area: Size) {
        match self.fitted {
            Some(fit) => self.fit(picture, area, fit),
            None => self.keep_in_sight(picture, area),
        }
    }

    /// Steps larger or smaller, keeping the place at `about` on the screen. Two steps double; 1:1 is one of them.
    pub fn zoom_step(&mut self, steps: i32, about: Point, picture: Size, area: Size) {
        let place = 2.0 * ln(self.zoom) / ln(2.0);
        let next = if steps > 0 { (place + 1e-6).floor() } else { (place - 1e-6).ceil() } + f64::from(steps);
        let kept = self.center + (about.to_vec2() - area.to_vec2() / 2.0) / self.zoom;
        self.zoom = pow(2.0, next / 2.0).clamp(ZOOMS.0, ZOOMS.1);
        self.fitted = None;
        self.center = kept + (area.to_vec2() / 2.0 - about.to_vec2()) / self.zoom;
        self.keep_in_sight(picture, area);
    }

    /// Moves what is seen by a distance on the screen.
    pub fn pan(&mut self, by: Vec2, picture: Size, area: Size) {
        self.center += by / self.zoom;
        self.fitted = None;
        self.keep_in_sight(picture, area);
    }

    /// The picture never leaves the area wholly.
    fn keep_in_sight(&mut self, picture: Size, area: Size) {
        let bounded = |center: f64, picture: f64, area: f64| {
            let seen = IN_SIGHT_PX.min(picture * self.zoom).min(area);
            let (least, most) = (seen - area / 2.0, area / 2.0 + picture * self.zoom - seen);
            (center * self.zoom).clamp(least, most.max(least)) / self.zoom
        };
        self.center = Point::new(
            bounded(self.center.x, picture.width, area.width),
            bounded(self.center.y, picture.height, area.height),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: Size = Size::new(640.0, 400.0);
    const PICTURE: Size = Size::new(300.0, 200.0);

    #[test]
    fn a_window_shows_a_part_of_a_frame() {
        for (zoom, center, frame, scale, seen) in [
            (1.0, (150.0, 100.0), (300, 200), 1.0, [0, 0, 300, 200]),
            (8.0, (150.0, 100.0), (300, 200), 1.0, [108, 73, 84, 54]),
            (8.0, (300.0, 200.0), (300, 200), 1.0, [258, 173, 42, 27]),
            (1.0, (6000.0, 4500.0), (12000, 9000), 1.0, [5678, 4298, 644, 404]),
            (1.0, (6000.0, 4500.0), (1500, 1125), 0.125, [708, 536, 84, 53]),
            (1.0, (90000.0, -90000.0), (300, 200), 1.0, [299, 0, 1, 1]),
        ] {
            let viewport = Viewport { zoom, center: center.into(), ..Viewport::default() };
            assert_eq!(viewport.seen(AREA, frame, scale), seen, "{zoom} {center:?}");
        }
    }

    #[test]
    fn fitting_fills_the_window_or_keeps_whole_pixels() {
        let mut viewport = Viewport::default();
        viewport.fit(PICTURE, AREA, Fit::Whole);
        assert_eq!((viewport.zoom, viewport.origin(AREA)), (2.0, Vec2::new(20.0, 0.0)));
        viewport.resized(PICTURE, Size::new(150.0, 400.0));
        assert_eq!(viewport.zoom, 0.5);
        for (area, zoom) in
            [((960.0, 400.0), 2.0), ((480.0, 1000.0), 1.6), ((302.0, 400.0), 1.0), ((150.0, 90.0), 0.45)]
        {
            viewport.fit(PICTURE, area.into(), Fit::Window);
            assert_eq!(viewport.zoom, zoom, "{area:?}");
        }
        viewport.resized(PICTURE, Size::new(600.0, 600.0));
        assert_eq!(viewport.zoom, 2.0, "stays fitted");
    }

    #[test]
    fn the_picture_is_never_lost() {
        for zoom in [-12, 0, 12] {
            for way in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (1.0, 1.0)] {
                let mut viewport = Viewport::default();
                viewport.fit(PICTURE, AREA, Fit::Window);
                viewport.zoom_step(zoom, Point::new(320.0, 200.0), PICTURE, AREA);
                (0..90).for_each(|_| viewport.pan(Vec2::from(way) * 500.0, PICTURE, AREA));
                let corner = viewport.origin(AREA).to_point();
                let seen = kurbo::Rect::from_origin_size(corner, PICTURE * viewport.zoom).intersect(AREA.to_rect());
                let least = IN_SIGHT_PX.min(PICTURE.height * viewport.zoom) - 1.0;
                assert!(seen.width() >= least && seen.height() >= least, "{zoom} {way:?}: {seen:?}");
            }
        }
    }

    #[test]
    fn zooming_keeps_the_place_under_the_pointer_and_meets_one_to_one() {
        let mut viewport = Viewport::default();
        viewport.fit(PICTURE, AREA, Fit::Window);
        let about = Point::new(230.0, 150.0);
        viewport.one(PICTURE, AREA);
        let kept = viewport.image_from_screen(about, AREA);
        for _ in 0..12 {
            viewport.zoom_step(1, about, PICTURE, AREA);
            let off = (viewport.screen_from_image(kept, AREA) - about).hypot();
            assert!(off <= viewport.zoom * 0.75 + 0.75, "{off} at {}", viewport.zoom);
        }
        let mut seen = Vec::new();
        for _ in 0..16 {
            viewport.zoom_step(-1, about, PICTURE, AREA);
            seen.push(viewport.zoom);
        }
        assert!(seen.contains(&1.0), "{seen:?}");
    }

    #[test]
    fn places_round_trip() {
        let mut viewport = Viewport::default();
        viewport.fit(PICTURE, AREA, Fit::Window);
        viewport.pan(Vec2::new(7.0, -3.0), PICTURE, AREA);
        let at = Point::new(12.25, 80.5);
        let back = viewport.image_from_screen(viewport.screen_from_image(at, AREA), AREA);
        assert!((back - at).hypot() < 1e-9);
    }
}
