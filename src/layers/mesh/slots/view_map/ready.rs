//! A view map ready for any time, as the surface of a mesh.

use std::sync::Arc;

use serde_json::Value;

use super::arrays::Arrays;
use super::blend::Points;
use super::looked::{Filled, Looked, base};
use super::map::{Map, Wanted};
use super::{again, bundle, marks, painted, passes, plan, probe, round, told, upload, view};
use crate::base::budget::Share;
use crate::base::error::Error;
use crate::base::last::Last;
use crate::base::number;
use crate::base::pixels::Linear;
use crate::base::problem::Problem;
use crate::base::progress::Watch;
use crate::base::reduce::Reduced;
use crate::layers::mesh::pose::Placed;
use crate::layers::mesh::surface::{Look, Reader, ReadySurface, StillSurface, SurfacePoint};
use crate::layers::parts::bundle::Sink;
use crate::layers::parts::marks::{Mark, View};
use crate::layers::parts::moment::Moment;
use crate::layers::parts::pass::Pass;
use crate::layers::parts::readout::Entry;
use crate::layers::parts::shots::{Painted, Put};
use crate::layers::space::eye::Ray;

/// A view map ready for any time.
#[derive(Clone, Debug)]
pub struct Ready {
    /// The cells and what they show.
    pub map: Arc<Map>,
    /// The arrays of directions, if it has some.
    pub arrays: Option<Arc<Arrays>>,
    /// From where the base coat alone is seen.
    pub points: Points,
    /// The memory of it all.
    pub kept: Arc<Share>,
    /// How many directions there are to be along a side, if not exact ones.
    pub side: Option<usize>,
    /// What is not there, as there was too little memory for it.
    pub lacks: Option<Problem>,
    /// What the camera of the view of this number sees, once that was asked for.
    pub seen: Last<usize, Linear>,
}

impl Ready {
    /// The map with its arrays.
    pub fn filled(&self) -> Filled<'_> {
        (&self.map, self.arrays.as_deref())
    }

    fn view(&self, number: usize) -> Option<&view::View> {
        self.map.wanted.views.iter().find(|view| view.number == number)
    }

    /// What the camera of a view sees. That of one is kept.
    fn seen(&self, view: &view::View) -> Arc<Linear> {
        let make = || again::seen(self.filled(), &self.points, view, &Watch::NONE);
        self.seen.get(|number, _| *number == view.number, make, || Some(view.number))
    }

    /// Whether it is the map that is wanted, with arrays of so many directions a side.
    pub fn is_of(&self, wanted: &Wanted, side: Option<usize>) -> bool {
        self.map.wanted.same(wanted) && self.side == side
    }
}

impl ReadySurface for Ready {
    fn at<'a>(&'a self, moment: &'a Moment, placed: &Placed) -> Box<dyn StillSurface + 'a> {
        Box::new(Looked::new(self.filled(), &self.points, moment, placed))
    }

    fn plan(&self, moment: &Moment, placed: &Placed) -> Look {
        let Some(eye) = moment.eye.filter(|_| self.by_cpu().is_none()) else { return Look::Color([0.0; 4]) };
        let focal_px = eye.focal_px / f64::from(moment.magnified.max(1));
        plan::look((&self.map, self.arrays.as_ref()), base(&self.points, &eye, placed), focal_px)
    }

    fn lying(&self, compare: Option<&Watch>) -> Option<Vec<Value>> {
        Some(told::told(self.filled(), compare))
    }

    fn guide(&self, view: usize, watch: &Watch) -> Option<Linear> {
        again::without(self.filled(), &self.points, view, watch)
    }

    fn lacks(&self) -> Option<Problem> {
        self.lacks.clone()
    }

    fn laid_px(&self, view: usize) -> Option<(usize, usize)> {
        self.view(view).map(|view| view.camera.size_px)
    }

    fn painted(&self, view: usize, share: f64) -> Option<Painted> {
        let view = self.view(view)?;
        Some(painted::painted(view, &self.seen(view), share))
    }

    fn put_round(&self, view: usize, put: Put, ray: &Ray, placed: &Placed) -> Result<(String, Value), String> {
        round::put(&self.map, view, put, ray, placed)
    }

    fn balanced(&self) -> Option<Vec<(String, Value)>> {
        let gains = told::balanced(&self.map).into_iter();
        let set = |(view, gain): (usize, [f64; 3])| {
            (format!("/views/{view}/gain"), gain.map(number::json).into_iter().collect())
        };
        Some(gains.map(set).collect())
    }

    fn marks(&self, view: &View, moment: &Moment, placed: &Placed) -> Vec<Mark> {
        marks::marks(&self.map, &self.points, view, moment, placed)
    }

    fn bundle(&self, layer: &str, to: &mut dyn Sink) -> Result<Option<Value>, Error> {
        bundle::write(self.filled(), &self.points, layer, to).map(Some)
    }

    fn by_cpu(&self) -> Option<&'static str> {
        (!upload::fits(self.filled())).then_some("a view map has more cells and entries than textures hold")
    }

    fn takes_long(&self) -> bool {
        true
    }

    fn unmoved(self: Arc<Self>) -> Arc<dyn ReadySurface> {
        self
    }

    fn reduced(self: Arc<Self>, _pictures: &mut Reduced) -> Arc<dyn ReadySurface> {
        self
    }
}

impl StillSurface for Looked<'_> {
    fn reader(&self) -> Reader<'_> {
        let (mut spots, mut reader) = (self.spots(), self.sampler());
        Box::new(move |place| {
            let Some(spot) = spots(place) else { return [0.0; 4] };
            let [r, g, b] = reader.at(&spot, None).shown(self.base()).map(|light| light as f32);
            [r, g, b, 1.0]
        })
    }

    fn is_lit(&self) -> bool {
        false
    }

    fn told(&self, place: &SurfacePoint) -> Option<Entry> {
        probe::entry(self, place)
    }

    fn pass(&self, pass: &Pass) -> Option<Reader<'_>> {
        passes::reader(self, pass)
    }
}
