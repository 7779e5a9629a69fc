//! Several ways of one scene side by side, as a single layer that the CPU draws.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::made::LastMade;
use super::reduce::reduced;
use super::stage::{Group, Stage};
use super::{Synth, cpu};
use crate::base::last::Last;
use crate::base::pixels::{Linear, Rgba, side_by_side};
use crate::base::reduce::Reduced;
use crate::layers::parts::moment::{Columns, Moment};
use crate::layers::parts::plan::Plan;
use crate::layers::ready::{Ready, Still};

/// The ways, from left to right; frames of all have the same size.
#[derive(Clone, Debug)]
pub struct Beside {
    /// Their syntheses.
    pub ways: Vec<Synth>,
    /// The last frame, with its time: whoever wants some of its pixels wants others next.
    last: Last<f64, Linear>,
}

impl Beside {
    /// A scene whose frames are theirs, side by side.
    pub fn synth(ways: Vec<Synth>) -> Synth {
        let size = (ways.iter().map(|way| way.size.0).sum(), ways.first().map_or(0, |way| way.size.1));
        let stop = ways.iter().find_map(|way| way.stop.clone());
        let stage = Arc::new(Stage { groups: vec![Group::Plane(0)], ..Stage::default() });
        Synth { size, layers: vec![Beside::of(ways)], stage, stop, kept: LastMade::default() }
    }

    fn of(ways: Vec<Synth>) -> Arc<dyn Ready> {
        Arc::new(Beside { ways, last: Last::default() })
    }

    fn each(&self, way: impl Fn(&Synth) -> Synth) -> Arc<dyn Ready> {
        Beside::of(self.ways.iter().map(way).collect())
    }

    fn frame(&self, t: f64) -> Arc<Linear> {
        let make = || side_by_side(&self.ways.iter().map(|way| cpu::linear(way, t)).collect::<Vec<_>>());
        self.last.get(|time, _| *time == t, make, || (!self.ways.iter().any(Synth::is_stopped)).then_some(t))
    }
}

impl Ready for Beside {
    fn at<'a>(&'a self, moment: &'a Moment) -> Box<dyn Still + 'a> {
        Box::new(Frames(self.frame(moment.t)))
    }

    fn plan(&self, _moment: &Moment) -> Plan {
        Plan::default()
    }

    fn stoppable(&self, stop: &Arc<AtomicBool>) -> Option<Arc<dyn Ready>> {
        Some(self.each(|way| way.stoppable(stop)))
    }

    fn by_cpu(&self) -> Option<&'static str> {
        Some("several ways are compared")
    }

    fn takes_long(&self) -> bool {
        true
    }

    fn unmoved(self: Arc<Self>) -> Arc<dyn Ready> {
        self.each(Synth::unmoved)
    }

    fn reduced(&self, pictures: &mut Reduced) -> Arc<dyn Ready> {
        self.each(|way| reduced(way, pictures.by))
    }

    fn largest_texture(&self) -> usize {
        0
    }
}

/// All ways at one time.
struct Frames(Arc<Linear>);

impl Still for Frames {
    fn row(&self, y: usize, columns: Columns, out: &mut [Rgba]) {
        let row = self.0.row(y);
        match columns {
            Columns::All => out.copy_from_slice(row),
            Columns::Some(columns) => out.iter_mut().zip(columns).for_each(|(out, &x)| *out = row[x]),
        }
    }
}
