//! What explains a view map: the cameras of its views, how far the selected one is seen, and blend points.

use glam::{DVec2, DVec3};

use super::blend::Points;
use super::gauge::Gauges;
use super::map::Map;
use super::view::{Extremes, View};
use crate::base::maths::{TAU, cos, sin};
use crate::base::pointer::Pointer;
use crate::layers::mesh::pose::Placed;
use crate::layers::parts::marks::{self, Dot, Look, Mark, Overlay, Shape, When};
use crate::layers::parts::moment::Moment;
use crate::layers::space::eye::Eye;
use crate::layers::space::marks::{line, spot};

const VIEWS: &str = "view-views";

/// The overlay.
pub const OVERLAY: Overlay = Overlay {
    selects: true,
    ..Overlay::new(VIEWS, "V", "Cameras of view maps, how far the selected one is seen, blend points", When::EveryFrame)
};

/// The camera of a view.
pub static CAMERA: Look = Look::new("view", 28, [120, 200, 255, 230], 1.3);
/// Where a view begins to fade.
pub static WHOLE: Look = Look::new("where a view is whole", 29, [120, 200, 255, 230], 1.5).dashed(4.0, 3.0);
/// Where a view is gone.
pub static GONE: Look =
    Look::new("where a view is gone", 30, [230, 130, 60, 240], 1.7).dots(Dot::Square, 3.5).stroke("*");
/// A blend point.
pub static BLEND: Look = Look::new("blend point", 31, [200, 150, 240, 240], 1.1).dots(Dot::Diamond, 4.5).stroke("-");

/// How deep a camera is drawn, as a share of the way to what it looks at.
const DEEP: f64 = 0.12;
/// How many places of the line where a view is gone are looked at.
const ROUND: usize = 96;
/// How far from the middle of a view its gauge is asked for; it grows evenly from there.
const ASIDE: f64 = 1e-3;

/// The marks of a map on a mesh that is placed so.
pub fn marks(map: &Map, points: &Points, shown: &marks::View, moment: &Moment, placed: &Placed) -> Vec<Mark> {
    let Some(eye) = moment.eye.filter(|_| shown.shows(VIEWS)) else { return Vec::new() };
    // What lies round the mesh does not bend with it.
    let mut drawn = Drawn { moment, eye, placed: Placed { bend_radians: 0.0, ..*placed }, marks: Vec::new() };
    let views = &map.wanted.views;
    for view in views {
        drawn.camera(view);
    }
    let selected = shown.selection.as_deref().and_then(|path| Pointer(path).item_of("/surface/views"));
    let selected = selected.map(|(index, _)| index);
    if let Some(number) = views.iter().position(|view| Some(view.number) == selected) {
        drawn.reach(views, number);
    }
    points.points.iter().enumerate().for_each(|(i, (at, way, _))| drawn.blend(i, *at, *way));
    drawn.marks
}

/// Marks in the making.
struct Drawn<'a> {
    moment: &'a Moment,
    eye: Eye,
    placed: Placed,
    marks: Vec<Mark>,
}

impl Drawn<'_> {
    fn world(&self, model: DVec3) -> DVec3 {
        self.placed.point(model, DVec3::ZERO).0
    }

    fn line(&mut self, look: &'static Look, path: &str, ends: [DVec3; 2]) {
        if let Some(points) = line(self.moment, &self.eye, ends.map(|end| self.world(end))) {
            self.marks.push(Mark::new(look, path, Shape::Line { points: points.into(), closed: false }));
        }
    }

    fn dot(&mut self, look: &'static Look, path: &str, at: DVec3) {
        if let Some(at) = spot(self.moment, &self.eye, self.world(at)) {
            self.marks.push(Mark::new(look, path, Shape::Dot(at)));
        }
    }

    fn label(&mut self, look: &'static Look, path: &str, at: DVec3, text: String) {
        if let Some([at, _]) = line(self.moment, &self.eye, [self.world(at); 2]) {
            self.marks.push(Mark::new(look, path, Shape::Label(at, text)));
        }
    }

    /// A pyramid from the camera to its picture, with a roof that shows which side is up, and its name.
    fn camera(&mut self, view: &View) {
        let (camera, path) = (&view.camera, format!("/surface/views/{}", view.number));
        let deep = camera.position.distance(view.target) * DEEP;
        let (width, height) = (camera.size_px.0 as f64, camera.size_px.1 as f64);
        let at = |x: f64, y: f64| {
            let way = (DVec2::new(x, y) - camera.middle_px) / camera.focal_px;
            camera.position + camera.turn.transpose() * (DVec3::new(way.x, -way.y, -1.0) * deep)
        };
        let corners = [at(0.0, 0.0), at(width, 0.0), at(width, height), at(0.0, height)];
        for (i, corner) in corners.into_iter().enumerate() {
            self.line(&CAMERA, &path, [camera.position, corner]);
            self.line(&CAMERA, &path, [corner, corners[(i + 1) % 4]]);
        }
        let roof = at(width / 2.0, -height / 4.0);
        self.line(&CAMERA, &path, [corners[0], roof]);
        self.line(&CAMERA, &path, [corners[1], roof]);
        self.label(&CAMERA, &path, camera.position, view.name.clone());
    }

    /// How far a view is seen, on the sphere round what it looks at through its camera, as it is where it looks.
    fn reach(&mut self, views: &[View], number: usize) {
        let view = &views[number];
        if !view.dependent {
            return;
        }
        let path = format!("/surface/views/{}/extremes", view.number);
        for (look, share) in [(&GONE, 1.0), (&WHOLE, view.fade.hold)].into_iter().filter(|(_, share)| *share > 0.0) {
            let places: Vec<Option<DVec3>> = around(views, number, share);
            for (i, place) in places.iter().enumerate() {
                let ends = place.zip(places[(i + 1) % places.len()]);
                ends.into_iter().for_each(|(from, to)| self.line(look, &path, [from, to]));
            }
        }
        if let Extremes::Points(places) = &view.extremes {
            for (i, place) in places.iter().enumerate() {
                self.dot(&GONE, &path, *place);
                self.label(&GONE, &path, *place, (i + 1).to_string());
            }
        }
    }

    /// Where one stands, and a little of the way one looks.
    fn blend(&mut self, i: usize, at: DVec3, way: DVec3) {
        let path = format!("/surface/blend/points/{i}");
        self.dot(&BLEND, &path, at);
        self.line(&BLEND, &path, [at, at + way * (at.length() * DEEP)]);
        self.label(&BLEND, &path, at, format!("blend {}", i + 1));
    }
}

/// Places once round a view, on the sphere about its target: this share of the way from its direction to where it has faded
/// away. `None` in directions in which it never fades.
fn around(views: &[View], number: usize, share: f64) -> Vec<Option<DVec3>> {
    let view = &views[number];
    let front = view.camera.position - view.target;
    let (radius, front) = (front.length(), front.normalize_or_zero());
    let [right, ..] = view.camera.axes();
    let right = (right - front * right.dot(front)).normalize_or_zero();
    let up = front.cross(right);
    let mut gauges = Gauges::new(views);
    let place = |i: usize| {
        let angle = TAU * i as f64 / ROUND as f64;
        let aside = right * cos(angle) + up * sin(angle);
        // Stereographic from behind the view, as gauges are.
        let way = |far: f64| (front * (1.0 - far * far) + aside * (2.0 * far)) / (1.0 + far * far);
        gauges.set(view.target, way(ASIDE));
        let near = gauges.near().iter().find(|near| near.view == number)?;
        let gauge = gauges.gauge(near, |_| 1.0);
        (gauge > 0.0).then(|| view.target + radius * way(share * ASIDE / gauge))
    };
    (0..ROUND).map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::mesh::slots::view_map::tests::view;

    #[test]
    fn the_line_where_a_view_is_gone_is_where_its_extremes_say() {
        let degrees = |place: DVec3, view: &View| {
            (place - view.target).angle_between(view.camera.position - view.target).to_degrees()
        };
        let half = |degrees: f64| crate::base::maths::tan(f64::to_radians(degrees / 2.0));
        let cone = View { extremes: Extremes::Cone(half(50.0)), ..view([0.0, 0.0, 4.0], 0) };
        for place in around(std::slice::from_ref(&cone), 0, 1.0) {
            let found = degrees(place.unwrap(), &cone);
            assert!((found - 50.0).abs() < 1e-9, "{found}");
        }
        // Half of the way by the tangent of half the angle.
        let found = degrees(around(std::slice::from_ref(&cone), 0, 0.5)[7].unwrap(), &cone);
        assert!((half(found) - half(50.0) / 2.0).abs() < 1e-12, "{found}");
        // To the right of it is another, 40 degrees away.
        let at = f64::to_radians(40.0);
        let own = View { extremes: Extremes::Auto(half(80.0)), ..cone };
        let places = around(&[own.clone(), view([4.0 * sin(at), 0.0, 4.0 * cos(at)], 1)], 0, 1.0);
        let found = [0, ROUND / 2].map(|i| degrees(places[i].unwrap(), &own));
        assert!((found[0] - 40.0).abs() < 1e-9 && (found[1] - 80.0).abs() < 1e-9, "{found:?}");
        let square = [[30.0, 30.0], [-30.0, 30.0], [-30.0, -30.0], [30.0, -30.0]].map(DVec2::from);
        let own = View { extremes: Extremes::points(&own.camera, own.target, &square), ..own };
        let places = around(std::slice::from_ref(&own), 0, 1.0);
        let Extremes::Points(corners) = &own.extremes else { panic!() };
        let corner = places[ROUND / 8].unwrap();
        let nearest = corners.iter().map(|own| own.distance(corner)).fold(f64::INFINITY, f64::min);
        assert!(nearest < 0.5, "{nearest}");
    }
}
