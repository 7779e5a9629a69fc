//! What a mesh layer gives once it is ready.

use std::sync::Arc;

use super::frame::Seen;
use super::plan;
use super::synth::Synth;
use crate::base::reduce::Reduced;
use crate::layers::parts::moment::Moment;
use crate::layers::parts::plan::Plan;
use crate::layers::ready::{Ready, Still};

impl Ready for Synth {
    fn at<'a>(&'a self, moment: &'a Moment) -> Box<dyn Still + 'a> {
        Box::new(Seen::new(self, moment))
    }

    fn plan(&self, moment: &Moment) -> Plan {
        plan::plan(self, moment)
    }

    fn unmoved(self: Arc<Self>) -> Arc<dyn Ready> {
        Arc::new(Synth { still: true, surface: self.surface.clone().unmoved(), ..(*self).clone() })
    }

    fn reduced(&self, pictures: &mut Reduced) -> Arc<dyn Ready> {
        Arc::new(Synth { surface: self.surface.clone().reduced(pictures), ..self.clone() })
    }

    fn largest_texture(&self) -> usize {
        self.surface.largest_texture()
    }
}
