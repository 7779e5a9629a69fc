//! Where the picture stands on the screen: zoom and pan. Lengths on the screen are physical pixels.

use kurbo::{Point, Size, Vec2};

use crate::base::maths::{ln, pow};

/// Smallest and largest zoom, in pixels of the screen a pixel of the picture.
const ZOOMS: (f64, f64) = (1.0 / 64.0, 256.0);

/// Zoom and place.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Pixels of the screen a pixel of the picture.
    pub zoom: f64,
    /// The place in the picture that stands in the middle of the area.
    pub center: Point,
    /// Whether the picture is kept fitted while the window changes its size.
    fitted: bool,
}

impl Default for Camera {
    fn default() -> Self {
        Camera { zoom: 1.0, center: Point::ZERO, fitted: true }
    }
}

impl Camera {
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

    /// Fits a picture into the area. Enlarged pictures keep whole pixels.
    pub fn fit(&mut self, picture: Size, area: Size) {
        let zoom = (area.width / picture.width.max(1.0)).min(area.height / picture.height.max(1.0));
        self.zoom = if zoom >= 1.0 { zoom.floor() } else { zoom }.clamp(ZOOMS.0, ZOOMS.1);
        self.center = (picture.to_vec2() / 2.0).to_point();
        self.fitted = true;
    }

    /// One pixel a pixel, around the place in the middle; a picture that has room is shown whole.
    pub fn one(&mut self, picture: Size, area: Size) {
        if picture.width <= area.width && picture.height <= area.height {
            self.fit(picture, area);
        }
        (self.zoom, self.fitted) = (1.0, false);
    }

    /// Follows a change of the area or the picture.
    pub fn resized(&mut self, picture: Size, area: Size) {
        if self.fitted {
            self.fit(picture, area);
        }
    }

    /// Steps larger or smaller, keeping the place at `about` on the screen. Two steps double; 1:1 is one of them.
    pub fn zoom_step(&mut self, steps: i32, about: Point, area: Size) {
        let place = 2.0 * ln(self.zoom) / ln(2.0);
        let next = if steps > 0 { (place + 1e-6).floor() } else { (place - 1e-6).ceil() } + f64::from(steps);
        let kept = self.center + (about.to_vec2() - area.to_vec2() / 2.0) / self.zoom;
        self.zoom = pow(2.0, next / 2.0).clamp(ZOOMS.0, ZOOMS.1);
        self.fitted = false;
        self.center = kept + (area.to_vec2() / 2.0 - about.to_vec2()) / self.zoom;
    }

    /// Moves what is seen by a distance on the screen.
    pub fn pan(&mut self, by: Vec2) {
        self.center += by / self.zoom;
        self.fitted = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: Size = Size::new(640.0, 400.0);
    const PICTURE: Size = Size::new(300.0, 200.0);

    #[test]
    fn fitting_shows_all_and_keeps_whole_pixels() {
        let mut camera = Camera::default();
        camera.fit(PICTURE, AREA);
        assert_eq!((camera.zoom, camera.origin(AREA)), (2.0, Vec2::new(20.0, 0.0)));
        camera.resized(PICTURE, Size::new(150.0, 400.0));
        assert_eq!(camera.zoom, 0.5);
    }

    #[test]
    fn zooming_keeps_the_place_under_the_pointer_and_meets_one_to_one() {
        let mut camera = Camera::default();
        camera.fit(PICTURE, AREA);
        let about = Point::new(100.0, 50.0);
        camera.one(PICTURE, AREA);
        let kept = camera.image_from_screen(about, AREA);
        for _ in 0..12 {
            camera.zoom_step(1, about, AREA);
            let off = (camera.screen_from_image(kept, AREA) - about).hypot();
            assert!(off <= camera.zoom * 0.75 + 0.75, "{off} at {}", camera.zoom);
        }
        let mut seen = Vec::new();
        for _ in 0..16 {
            camera.zoom_step(-1, about, AREA);
            seen.push(camera.zoom);
        }
        assert!(seen.contains(&1.0), "{seen:?}");
    }

    #[test]
    fn places_round_trip() {
        let mut camera = Camera::default();
        camera.fit(PICTURE, AREA);
        camera.pan(Vec2::new(7.0, -3.0));
        let at = Point::new(12.25, 80.5);
        let back = camera.image_from_screen(camera.screen_from_image(at, AREA), AREA);
        assert!((back - at).hypot() < 1e-9);
    }
}
