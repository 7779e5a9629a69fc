//! A frame of a fill layer on the CPU: the reference. frame.wgsl has the same names and structure.

use kurbo::Vec2;

use super::synth::Synth;
use crate::base::pixels::{Rgba, encode};
use crate::layers::parts::moment::Columns;
use crate::layers::parts::readout::{Entry, ReadOut, Value};
use crate::layers::ready::Still;

impl Still for &Synth {
    fn row(&self, y: usize, columns: Columns, out: &mut [Rgba]) {
        let place = |x: usize| Vec2::new(x as f64, y as f64) + self.place;
        match columns {
            Columns::All => out.iter_mut().enumerate().for_each(|(x, out)| *out = self.color(place(x))),
            Columns::Some(columns) => out.iter_mut().zip(columns).for_each(|(out, &x)| *out = self.color(place(x))),
        }
    }
}

impl Synth {
    /// What a pixel (column, row) shows of the layer of this name: its color, and how far along the gradient it is.
    pub fn read_out(&self, name: &str, (x, y): (usize, usize)) -> ReadOut {
        let at = Vec2::new(x as f64, y as f64) + self.place;
        let entry = |key, label, value| Entry { key, label, value };
        let along =
            (self.axis != Vec2::ZERO).then(|| entry("along", "along the gradient", Value::Number(self.along(at))));
        let entries = [
            entry("layer", "layer", Value::Of(Some(name.to_owned()))),
            entry("fill", "fill", Value::Color(encode(self.color(at)))),
        ];
        ReadOut { entries: entries.into_iter().chain(along).collect(), ..ReadOut::default() }
    }

    /// How far along the line a place of the frame is, in pixels: 0 where it begins, 1 where it ends.
    fn along(&self, at: Vec2) -> f64 {
        self.axis.dot(at - self.from)
    }

    /// The color at a place of the frame, in pixels.
    fn color(&self, at: Vec2) -> Rgba {
        let along = self.along(at);
        let after = self.stops.partition_point(|stop| stop.0 <= along);
        let (Some(before), Some(after)) = (after.checked_sub(1).map(|i| self.stops[i]), self.stops.get(after)) else {
            let end = if after == 0 { self.stops.first() } else { self.stops.last() };
            return end.map_or([0.0; 4], |stop| stop.1);
        };
        let share = ((along - before.0) / (after.0 - before.0)) as f32;
        std::array::from_fn(|i| before.1[i] + (after.1[i] - before.1[i]) * share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::pixels::decode;

    #[test]
    fn light_changes_evenly_between_stops_and_not_beyond_them() {
        let layer = serde_json::from_str(
            r##"{"name": "f", "gradient": {"from": [10, 0], "to": [30, 0],
                "stops": [[0, "#ff0000"], [0.5, "#00000000"]]}}"##,
        )
        .unwrap();
        let synth = Synth::new(&layer, Vec2::ZERO);
        let mut row = [[0.0; 4]; 40];
        (&synth).row(3, Columns::All, &mut row);
        let red = decode([255, 0, 0, 255]);
        for (x, color) in [(0, red), (10, red), (15, red.map(|c| c / 2.0)), (20, [0.0; 4]), (39, [0.0; 4])] {
            assert_eq!(row[x], color, "{x}");
        }
        let read = synth.read_out("f", (14, 3)).entries;
        let along = Value::Number(0.2);
        assert_eq!((read[0].value.clone(), read[2].value.clone()), (Value::Of(Some("f".into())), along));
        assert!(matches!(read[1].value, Value::Color([255, 0, 0, 153])), "{read:?}");
        let mut some = [[0.0; 4]; 2];
        (&synth).row(0, Columns::Some(&[13, 18]), &mut some);
        assert_eq!(some, [row[13], row[18]]);
    }
}
