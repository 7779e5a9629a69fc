//! What a waterfall layer gives once it is ready.

use std::sync::Arc;

use glam::DVec3;

use super::check::carried;
use super::frame::WaterfallAt;
use super::synth::Synth;
use super::{album, lines, marks, picking, plan};
use crate::base::reduce::Reduced;
use crate::layers::parts::album::Album;
use crate::layers::parts::marks::{Mark, View};
use crate::layers::parts::moment::Moment;
use crate::layers::parts::picking::{Picking, Subject};
use crate::layers::parts::plan::Plan;
use crate::layers::parts::readout::Fact;
use crate::layers::ready::{Ready, Still};

impl Ready for Synth {
    fn at<'a>(&'a self, moment: &'a Moment) -> Box<dyn Still + 'a> {
        Box::new(WaterfallAt::new(self, moment))
    }

    fn plan(&self, moment: &Moment) -> Plan {
        plan::plan(self, moment)
    }

    fn has_sprites(&self) -> bool {
        true
    }

    fn unmoved(self: Arc<Self>) -> Arc<dyn Ready> {
        Arc::new(Synth { still: true, ..(*self).clone() })
    }

    fn reduced(&self, _pictures: &mut Reduced) -> Arc<dyn Ready> {
        Arc::new(self.clone())
    }

    fn marks(&self, view: &View, moment: &Moment) -> Vec<Mark> {
        marks::marks(self, view, moment)
    }

    fn reach(&self, _t: f64, ways: &[DVec3]) -> Option<Vec<f64>> {
        lines::reach(&self.values, &self.lines, ways)
    }

    /// What cannot be seen in a single frame: the measure of all that is automatic, how long water is on its way, and how
    /// much there is to draw.
    fn facts(&self) -> Vec<Fact> {
        let life = self.lines.iter().filter(|line| !line.foam).map(|line| line.life).fold(0.0, f64::max);
        let fact = |name, value, unit| Fact { name, value, unit };
        let sprites = carried(&self.lines, &self.births).round();
        vec![fact("h", self.values.height, "m"), fact("life", life, "s"), fact("sprites", sprites, "")]
    }

    fn album(&self, between: usize) -> Option<Album> {
        Some(album::album(self, between))
    }

    fn picking(&self, sight: Subject) -> Option<Picking> {
        picking::picking(self, sight)
    }

    fn largest_texture(&self) -> usize {
        self.pictures.side
    }
}
