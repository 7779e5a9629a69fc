//! ICC profiles, versions 2 and 4: matrix and curves, or tables (RGB, gray, CMYK). moxcms parses the profile; the
//! colors are computed here in double precision, because that crate has no black point compensation and its results
//! depend on the processor. The rendering intent is relative colorimetric, as everywhere in a scene.

use moxcms::{
    ColorProfile, DataColorSpace, LutDataType, LutMultidimensionalType, LutStore, LutWarehouse, ProfileClass,
};
use moxcms::{LutType, ToneReprCurve, Xyzd};

use super::conversion::{Curve, D50, MOST, Profile, Shaper, Table, between, from_lab, from_lightness, mix, multiply};
use super::decoded::Model;

/// Nodes per side of the table made from a profile's table, by the number of samples per pixel.
const NODES: [usize; MOST] = [256, 65, 33, 17];

/// The conversion for pixels of `model`.
///
/// # Errors
/// Why it cannot be applied, as a sentence about the picture.
pub(super) fn understand(bytes: &[u8], model: Model) -> Result<Profile, String> {
    let broken = |_| "its color profile is broken and was not applied".to_owned();
    let profile = ColorProfile::new_from_slice(bytes).map_err(broken)?;
    let space = match (model, profile.color_space) {
        (Model::Grey | Model::GreyAlpha, DataColorSpace::Gray) => 1,
        (Model::Grey | Model::GreyAlpha | Model::Rgb | Model::Rgba, DataColorSpace::Rgb) => 3,
        (Model::Cmyk, DataColorSpace::Cmyk) => 4,
        (_, other) => {
            return Err(format!("its color profile is for {}, and was not applied", name(other)));
        }
    };
    let lut = profile.lut_a_to_b_colorimetric.as_ref().or(profile.lut_a_to_b_perceptual.as_ref());
    match lut {
        // A gray picture has one sample instead of the three that such a table needs: the curves must do.
        Some(lut) if space != 3 || model.count() >= 3 => table(&profile, lut, space).map(Profile::Table),
        _ => shaper(&profile, space).map(|shaper| Profile::Shaper(Box::new(shaper))),
    }
    .ok_or_else(|| "its color profile is of a kind that is not known, and was not applied".to_owned())
}

fn name(space: DataColorSpace) -> &'static str {
    match space {
        DataColorSpace::Rgb => "RGB",
        DataColorSpace::Gray => "grey",
        DataColorSpace::Cmyk => "CMYK",
        DataColorSpace::Lab => "Lab",
        _ => "other colors",
    }
}

fn shaper(profile: &ColorProfile, space: usize) -> Option<Shaper> {
    if space == 1 {
        // The curve gives lightness if the connection space is Lab, otherwise light.
        let grey = curve(profile.gray_trc.as_ref()?)?;
        let curve = if profile.pcs == DataColorSpace::Lab { Curve::Lightness(Box::new(grey)) } else { grey };
        return Some(Shaper { curves: [curve.clone(), curve.clone(), curve], matrix: None });
    }
    let trc = [&profile.red_trc, &profile.green_trc, &profile.blue_trc];
    let [red, green, blue] = trc.map(|trc| trc.as_ref().and_then(curve));
    let column = |c: Xyzd| [c.x, c.y, c.z];
    let columns = [profile.red_colorant, profile.green_colorant, profile.blue_colorant].map(column);
    if columns.iter().flatten().all(|&c| c == 0.0) || columns.iter().flatten().any(|c| !c.is_finite()) {
        return None;
    }
    let matrix = std::array::from_fn(|row| std::array::from_fn(|c| columns[c][row]));
    Some(Shaper { curves: [red?, green?, blue?], matrix: Some(matrix) })
}

fn curve(trc: &ToneReprCurve) -> Option<Curve> {
    match trc {
        ToneReprCurve::Lut(values) => match values[..] {
            [] => Some(Curve::Power(1.0)),
            [gamma] => Some(Curve::Power(f64::from(gamma) / 256.0)),
            _ => Some(Curve::Points(values.clone())),
        },
        ToneReprCurve::Parametric(p) => {
            let p: Vec<f64> = p.iter().map(|&v| f64::from(v)).collect();
            // g, a, b, c, d, e, f: (a x + b)^g + e for x >= d, c x + f below.
            let all = match p[..] {
                [g] => [g, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
                [g, a, b] if a != 0.0 => [g, a, b, 0.0, -b / a, 0.0, 0.0],
                [g, a, b, c] if a != 0.0 => [g, a, b, 0.0, -b / a, c, c],
                [g, a, b, c, d] => [g, a, b, c, d, 0.0, 0.0],
                [g, a, b, c, d, e, f] => [g, a, b, c, d, e, f],
                _ => return None,
            };
            all.iter().all(|v| v.is_finite()).then_some(Curve::Parametric(all))
        }
    }
}

/// The profile's table, converted to one that gives sRGB codes.
fn table(profile: &ColorProfile, lut: &LutWarehouse, inputs: usize) -> Option<Table> {
    let lut = Lut::of(lut, profile.pcs)?;
    if lut.sizes() != (inputs, 3) {
        return None;
    }
    let black = black_point(profile, &lut, inputs);
    Some(Table::of(inputs, NODES[inputs - 1], |device| {
        let xyz = lut.color(device);
        // Black point compensation: the darkest color of the device becomes black, white stays white.
        std::array::from_fn(|c| {
            let scale = D50[c] / (D50[c] - black[c]);
            (xyz[c] - black[c]) * scale
        })
    }))
}

/// The darkest color of a device, found as in Little CMS: for inks what the profile's inverse table makes of black,
/// otherwise that of zero device values; made neutral gray, and no lighter than L* 50.
fn black_point(profile: &ColorProfile, lut: &Lut, inputs: usize) -> [f64; 3] {
    let darkest = if inputs == 4 && profile.profile_class == ProfileClass::OutputDevice {
        let back = profile.lut_b_to_a_perceptual.as_ref().and_then(|back| Lut::of(back, profile.pcs));
        match back.filter(|back| back.sizes() == (3, 4) && profile.lut_a_to_b_perceptual.is_some()) {
            Some(back) => {
                let mut inks = [0.0; MOST];
                back.run(&back.connection([0.0, 0.0, 0.0]), &mut inks);
                inks
            }
            None => return [0.0; 3],
        }
    } else if profile.lut_a_to_b_colorimetric.is_none() {
        // Little CMS uses none if the profile has no colorimetric table.
        return [0.0; 3];
    } else if inputs == 4 {
        [1.0; MOST]
    } else {
        [0.0; MOST]
    };
    let [_, y, _] = lut.color(&darkest[..inputs]);
    let y = y.clamp(0.0, from_lightness(50.0));
    D50.map(|white| white * y)
}

/// A table of a profile.
struct Lut<'a> {
    lut: &'a LutWarehouse,
    /// Its connection space, on the side that is not the device.
    pcs: DataColorSpace,
}

impl<'a> Lut<'a> {
    /// `None` if its numbers are inconsistent.
    fn of(lut: &'a LutWarehouse, pcs: DataColorSpace) -> Option<Self> {
        let sound = match lut {
            LutWarehouse::Lut(lut) => old_is_sound(lut),
            LutWarehouse::Multidimensional(lut) => new_is_sound(lut),
        };
        (sound && matches!(pcs, DataColorSpace::Lab | DataColorSpace::Xyz)).then_some(Lut { lut, pcs })
    }

    fn sizes(&self) -> (usize, usize) {
        match self.lut {
            LutWarehouse::Lut(lut) => (lut.num_input_channels.into(), lut.num_output_channels.into()),
            LutWarehouse::Multidimensional(lut) => (lut.num_input_channels.into(), lut.num_output_channels.into()),
        }
    }

    /// XYZ of device values.
    fn color(&self, device: &[f64]) -> [f64; 3] {
        let mut out = [0.0; MOST];
        self.run(device, &mut out);
        let [x, y, z, _] = out;
        match self.pcs {
            DataColorSpace::Lab if self.is_old_16() => {
                let scale = 65535.0 / 65280.0;
                from_lab([x * scale * 100.0, y * scale * 255.0 - 128.0, z * scale * 255.0 - 128.0])
            }
            DataColorSpace::Lab => from_lab([x * 100.0, y * 255.0 - 128.0, z * 255.0 - 128.0]),
            _ => [x, y, z].map(|v| v * 65535.0 / 32768.0),
        }
    }

    /// Lab, encoded as input of the table (XYZ tables are only asked for black, which is 0).
    fn connection(&self, [l, a, b]: [f64; 3]) -> [f64; 3] {
        if self.pcs != DataColorSpace::Lab {
            return [0.0; 3];
        }
        let scale = if self.is_old_16() { 65280.0 / 65535.0 } else { 1.0 };
        [l / 100.0 * scale, (a + 128.0) / 255.0 * scale, (b + 128.0) / 255.0 * scale]
    }

    /// Whether it is a 16-bit table of version 2, which encodes Lab differently.
    fn is_old_16(&self) -> bool {
        matches!(self.lut, LutWarehouse::Lut(lut) if lut.lut_type == LutType::Lut16)
    }

    fn run(&self, input: &[f64], out: &mut [f64; MOST]) {
        match self.lut {
            LutWarehouse::Lut(lut) => run_old(lut, input, out),
            LutWarehouse::Multidimensional(lut) => run_new(lut, input, out),
        }
    }
}

fn length(store: &LutStore) -> usize {
    match store {
        LutStore::Store8(all) => all.len(),
        LutStore::Store16(all) => all.len(),
    }
}

fn value(store: &LutStore, i: usize) -> f64 {
    match store {
        LutStore::Store8(all) => all.get(i).map_or(0.0, |&v| f64::from(v) / 255.0),
        LutStore::Store16(all) => all.get(i).map_or(0.0, |&v| f64::from(v) / 65535.0),
    }
}

fn old_is_sound(lut: &LutDataType) -> bool {
    let (inputs, outputs) = (usize::from(lut.num_input_channels), usize::from(lut.num_output_channels));
    let grid = usize::from(lut.num_clut_grid_points);
    (1..=MOST).contains(&inputs)
        && (1..=MOST).contains(&outputs)
        && grid >= 1
        && lut.num_input_table_entries >= 2
        && lut.num_output_table_entries >= 2
        && length(&lut.input_table) >= inputs * usize::from(lut.num_input_table_entries)
        && length(&lut.output_table) >= outputs * usize::from(lut.num_output_table_entries)
        && length(&lut.clut_table) >= grid.pow(inputs as u32) * outputs
}

fn new_is_sound(lut: &LutMultidimensionalType) -> bool {
    let (inputs, outputs) = (usize::from(lut.num_input_channels), usize::from(lut.num_output_channels));
    if !(1..=MOST).contains(&inputs) || !(1..=MOST).contains(&outputs) {
        return false;
    }
    let curves = [&lut.a_curves, &lut.b_curves, &lut.m_curves];
    let known = curves.iter().all(|curves| curves.iter().all(|one| curve(one).is_some()));
    let nodes: usize = lut.grid_points[..inputs].iter().map(|&n| usize::from(n)).product();
    let table = lut.clut.as_ref().map_or(inputs == outputs, |clut| nodes > 0 && length(clut) >= nodes * outputs);
    known && table
}

fn run_old(lut: &LutDataType, input: &[f64], out: &mut [f64; MOST]) {
    let curve = |table: &LutStore, entries: u16, channel: usize, x: f64| {
        let entries = usize::from(entries);
        between(x, entries, |i| value(table, channel * entries + i))
    };
    let inputs = input.len();
    let mut values = [0.0; MOST];
    for (c, x) in input.iter().enumerate() {
        values[c] = curve(&lut.input_table, lut.num_input_table_entries, c, *x);
    }
    let outputs = usize::from(lut.num_output_channels);
    let nodes = [usize::from(lut.num_clut_grid_points); MOST];
    let mut mixed = [0.0; MOST];
    mix(&values[..inputs], &nodes, |i, weight| {
        (0..outputs).for_each(|c| mixed[c] += weight * value(&lut.clut_table, i * outputs + c));
    });
    for (c, out) in out.iter_mut().take(outputs).enumerate() {
        *out = curve(&lut.output_table, lut.num_output_table_entries, c, mixed[c]);
    }
}

/// From the device the order is A, table, M, matrix, B; to the device it is reversed.
fn run_new(lut: &LutMultidimensionalType, input: &[f64], out: &mut [f64; MOST]) {
    let (inputs, outputs) = (input.len(), usize::from(lut.num_output_channels));
    let mut v = [0.0; MOST];
    v[..inputs].copy_from_slice(input);
    let curves = |curves: &[ToneReprCurve], v: &mut [f64; MOST]| {
        for (v, trc) in v.iter_mut().zip(curves) {
            *v = curve(trc).map_or(*v, |curve| curve.at(v.clamp(0.0, 1.0)));
        }
    };
    let matrix = |v: &mut [f64; MOST]| {
        if !lut.m_curves.is_empty() {
            let [x, y, z] = multiply(&lut.matrix.v, [v[0], v[1], v[2]]);
            v[..3].copy_from_slice(&[x + lut.bias.v[0], y + lut.bias.v[1], z + lut.bias.v[2]]);
        }
    };
    let table = |v: &mut [f64; MOST]| {
        let Some(clut) = &lut.clut else { return };
        let nodes = std::array::from_fn(|c| usize::from(lut.grid_points[c]));
        let mut mixed = [0.0; MOST];
        mix(&v[..inputs], &nodes, |i, weight| {
            (0..outputs).for_each(|c| mixed[c] += weight * value(clut, i * outputs + c));
        });
        *v = mixed;
    };
    if outputs == 3 {
        curves(&lut.a_curves, &mut v);
        table(&mut v);
        curves(&lut.m_curves, &mut v);
        matrix(&mut v);
        curves(&lut.b_curves, &mut v);
    } else {
        curves(&lut.b_curves, &mut v);
        matrix(&mut v);
        curves(&lut.m_curves, &mut v);
        table(&mut v);
        curves(&lut.a_curves, &mut v);
    }
    *out = v;
}
