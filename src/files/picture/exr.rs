//! OpenEXR: chooses channels by their names. A path may name a layer after a `#` (`a.exr#beauty`); without one, red,
//! green and blue outside layers are used, otherwise those of the only layer that has them, otherwise the only one or
//! two channels.

use std::fs::File;
use std::io::BufReader;

use exr::block::reader::{ChunksReader, Reader};
use exr::error::Error as ExrError;
use exr::meta::attribute::SampleType;
use exr::meta::header::Header;

use super::decoded::{Color, Decoded, Model, Raw, Undecoded};
use super::limits::{self, check_size};
use crate::base::error::{Error, Result};
use crate::files::{Limits, paths};

type Exr = Reader<BufReader<File>>;

/// Reads the header.
pub(super) fn open(file: File, place: &str, limits: &Limits) -> Result<Undecoded> {
    let reader = reader(file, place)?;
    let chosen = choose(reader.headers(), place, &picture_of)?;
    let size = window(&reader, &chosen);
    check_size(place, size, limits)?;
    let count = chosen.channels.len();
    let model = Model::of(count).unwrap_or(Model::Grey);
    let bytes = (size.0 * size.1 * count) as u64 * if chosen.half { 2 } else { 4 };
    let place = place.to_owned();
    let decode = Box::new(move || {
        let samples = samples(reader, &chosen, size, &place)?;
        Ok(Decoded { size, model, samples, color: Color::Untagged, notes: Vec::new() })
    });
    Ok(Undecoded { size, orientation: 1, bytes, decode })
}

/// Two channels of an OpenEXR, as vectors are stored; `allow` is asked first for the bytes that this takes.
pub(in crate::files) fn vectors(
    file: File,
    place: &str,
    limits: &Limits,
    allow: impl FnOnce(u64) -> Result<()>,
) -> Result<((usize, usize), Vec<[f32; 2]>)> {
    let reader = reader(file, place)?;
    let mut chosen = choose(reader.headers(), place, &vector_of)?;
    chosen.half = false;
    let size = window(&reader, &chosen);
    check_size(place, size, limits)?;
    allow((size.0 * size.1 * 8) as u64)?;
    match samples(reader, &chosen, size, place)? {
        Raw::Floats(all) => Ok((size, all.as_chunks::<2>().0.to_vec())),
        _ => Err(Error::at(place, "is not a vector field")),
    }
}

fn reader(file: File, place: &str) -> Result<Exr> {
    exr::block::read(BufReader::new(file), false).map_err(|error| explain(place, error))
}

fn explain(place: &str, error: ExrError) -> Error {
    match error {
        ExrError::Io(error) => limits::reading(place, &error),
        ExrError::NotSupported(what) => super::kinds::other_kind(place, what),
        error => limits::broken(place, &error),
    }
}

/// Channels that belong together.
struct Chosen {
    header: usize,
    /// Indices of its channels, in the order of samples; a missing one counts as 0 everywhere.
    channels: Vec<Option<usize>>,
    /// Whether all of them are half floats.
    half: bool,
}

/// Chooses channels by their names without the layer; returns their indices in the order of samples.
type Roles = dyn Fn(&[String]) -> Option<Vec<usize>>;

/// The channels of a row, each by any of several names; all of them or `None`.
fn named(names: &[String], row: &[&[&str]]) -> Option<Vec<usize>> {
    let find = |any: &&[&str]| names.iter().position(|name| any.iter().any(|one| name.eq_ignore_ascii_case(one)));
    row.iter().map(find).collect()
}

const RED: &[&str] = &["R", "red"];
const GREEN: &[&str] = &["G", "green"];
const BLUE: &[&str] = &["B", "blue"];
const ALPHA: &[&str] = &["A", "alpha"];

fn picture_of(names: &[String]) -> Option<Vec<usize>> {
    let rgb = named(names, &[RED, GREEN, BLUE]);
    let grey = || named(names, &[&["Y"]]).or_else(|| (names.len() == 1).then(|| vec![0]));
    let found = rgb.or_else(grey);
    let alpha = named(names, &[ALPHA]);
    found.map(|found| match alpha {
        Some(alpha) if found != alpha => [found, alpha].concat(),
        _ => found,
    })
}

fn vector_of(names: &[String]) -> Option<Vec<usize>> {
    let rows: [[&[&str]; 2]; 3] = [[RED, GREEN], [&["u"], &["v"]], [&["x"], &["y"]]];
    rows.iter().find_map(|row| named(names, row))
}

/// Splits a channel's name into its layer and its own name.
fn parted(header: &Header, name: &str) -> (String, String) {
    let part = header.own_attributes.layer_name.as_ref().map(ToString::to_string).unwrap_or_default();
    match name.rsplit_once('.') {
        Some((layer, own)) => (layer.to_owned(), own.to_owned()),
        None => (part, name.to_owned()),
    }
}

/// A layer: its name, whether its channels have no layer in their names, its header, and its channels with their names.
struct Layer {
    name: String,
    plain: bool,
    header: usize,
    channels: Vec<(usize, String)>,
}

fn layers(headers: &[Header]) -> Vec<Layer> {
    let mut layers: Vec<Layer> = Vec::new();
    for (h, header) in headers.iter().enumerate().filter(|(_, header)| !header.deep) {
        for (c, channel) in header.channels.list.iter().enumerate() {
            let full = channel.name.to_string();
            let (name, own) = parted(header, &full);
            let plain = !full.contains('.');
            match layers.iter_mut().find(|l| l.header == h && l.name == name && l.plain == plain) {
                Some(layer) => layer.channels.push((c, own)),
                None => layers.push(Layer { name, plain, header: h, channels: vec![(c, own)] }),
            }
        }
    }
    layers
}

fn choose(headers: &[Header], place: &str, roles: &Roles) -> Result<Chosen> {
    let layers = layers(headers);
    let wanted = paths::layer_of(place);
    let take = |layer: &Layer| {
        let names: Vec<String> = layer.channels.iter().map(|(_, name)| name.clone()).collect();
        let found = roles(&names)?;
        Some((layer.header, found.iter().map(|&i| layer.channels[i].0).collect::<Vec<_>>()))
    };
    let found = match wanted {
        Some(wanted) => layers.iter().filter(|layer| layer.name == wanted).find_map(take).or_else(|| {
            // A single channel by its own name, with or without the layer.
            let mut all = layers.iter().flat_map(|layer| layer.channels.iter().map(move |(c, own)| (layer, *c, own)));
            let named = |layer: &Layer, own: &str| own == wanted || format!("{}.{own}", layer.name) == wanted;
            all.find(|(layer, _, own)| named(layer, own))
                .filter(|_| roles(&["Y".into()]).is_some())
                .map(|(layer, c, _)| (layer.header, vec![c]))
        }),
        None => {
            let plain = layers.iter().filter(|layer| layer.plain).find_map(take);
            let mut others = layers.iter().filter_map(|layer| take(layer).map(|found| (layer, found)));
            plain.or_else(|| match (others.next(), others.next()) {
                (Some((_, only)), None) => Some(only),
                (Some((first, found)), Some(_)) if first.name == "forward" => Some(found),
                (_, second) => second.and_then(|_| layers.iter().find(|layer| layer.name == "forward").and_then(take)),
            })
        }
    };
    let found = found.map(|(header, channels)| (header, channels.into_iter().map(Some).collect::<Vec<_>>()));
    let (header, channels) =
        found.or_else(|| two(&layers, wanted, roles)).ok_or_else(|| none(&layers, place, wanted))?;
    let list = &headers[header].channels.list;
    if channels.iter().flatten().any(|&c| list[c].sampling.x() != 1 || list[c].sampling.y() != 1) {
        return Err(super::kinds::other_kind(place, "its channels have fewer samples than it has pixels"));
    }
    let half = channels.iter().flatten().all(|&c| list[c].sample_type == SampleType::F16);
    Ok(Chosen { header, channels, half })
}

/// Two channels if there are no others: red and green of a picture without blue, whatever their names.
fn two(layers: &[Layer], wanted: Option<&str>, roles: &Roles) -> Option<(usize, Vec<Option<usize>>)> {
    let mut fit = layers.iter().filter(|layer| wanted.is_none_or(|wanted| layer.name == wanted));
    let layer = fit.next().filter(|_| fit.next().is_none())?;
    let is_picture = roles(&["Y".into()]).is_some();
    match &layer.channels[..] {
        [(first, _), (second, _)] if is_picture => {
            let green_first = layer.channels[1].1.eq_ignore_ascii_case("R");
            let (red, green) = if green_first { (*second, *first) } else { (*first, *second) };
            Some((layer.header, vec![Some(red), Some(green), None]))
        }
        _ => None,
    }
}

fn none(layers: &[Layer], place: &str, wanted: Option<&str>) -> Error {
    let mut names: Vec<&str> = layers.iter().map(|layer| layer.name.as_str()).filter(|name| !name.is_empty()).collect();
    names.dedup();
    let channels: Vec<&str> = layers.iter().flat_map(|l| &l.channels).map(|(_, name)| name.as_str()).collect();
    let file = paths::file_of(place);
    match (wanted, &names[..]) {
        (_, []) => Error::at(place, format!("has the channels {}, and none to take for this", channels.join(", ")))
            .cure("name one, as a.exr#Z"),
        (Some(wanted), _) => {
            Error::at(place, format!("has no layer {wanted} that fits")).cure(format!("it has {}", names.join(", ")))
        }
        (None, [first, ..]) => Error::at(place, format!("has several layers: {}", names.join(", ")))
            .cure(format!("name one, as {file}#{first}")),
    }
}

fn window(reader: &Exr, chosen: &Chosen) -> (usize, usize) {
    let size = reader.headers()[chosen.header].shared_attributes.display_window.size;
    (size.width(), size.height())
}

/// The samples of the display window; outside the data window they are 0.
fn samples(reader: Exr, chosen: &Chosen, (width, height): (usize, usize), place: &str) -> Result<Raw> {
    let header = &reader.headers()[chosen.header];
    let offset = header.own_attributes.layer_position - header.shared_attributes.display_window.position;
    let types: Vec<SampleType> = header.channels.list.iter().map(|channel| channel.sample_type).collect();
    let count = chosen.channels.len();
    let total = width * height * count;
    let mut out = if chosen.half { Raw::Halves(vec![0; total]) } else { Raw::Floats(vec![0.0; total]) };
    let index = chosen.header;
    let chunks = reader
        .filter_chunks(false, |_, tile, block| {
            block.layer == index && tile.level_index.x() == 0 && tile.level_index.y() == 0
        })
        .map_err(|error| explain(place, error))?;
    let read = chunks.decompress_sequential(false, |meta, block| {
        for line in block.lines(&meta.headers[index].channels) {
            let Some(slot) = chosen.channels.iter().position(|&c| c == Some(line.location.channel)) else { continue };
            let y = line.location.position.y() as i64 + i64::from(offset.y());
            let x = line.location.position.x() as i64 + i64::from(offset.x());
            if y < 0 || y >= height as i64 {
                continue;
            }
            let at = |i: usize| {
                let x = x + i as i64;
                (x >= 0 && x < width as i64).then(|| (y as usize * width + x as usize) * count + slot)
            };
            put(&mut out, types[line.location.channel], line.value, at);
        }
        Ok(())
    });
    read.map_err(|error| explain(place, error))?;
    Ok(out)
}

/// Stores the samples of a line, in native byte order, at the indices that `at` gives.
fn put(out: &mut Raw, kind: SampleType, bytes: &[u8], at: impl Fn(usize) -> Option<usize>) {
    match (out, kind) {
        (Raw::Halves(out), _) => {
            let all = bytes.as_chunks::<2>().0.iter().enumerate();
            all.for_each(|(i, b)| at(i).into_iter().for_each(|at| out[at] = u16::from_ne_bytes(*b)));
        }
        (Raw::Floats(out), SampleType::F16) => {
            let value = |b: &[u8; 2]| crate::base::half::value_of_half(u16::from_ne_bytes(*b));
            let all = bytes.as_chunks::<2>().0.iter().enumerate();
            all.for_each(|(i, b)| at(i).into_iter().for_each(|at| out[at] = value(b)));
        }
        (Raw::Floats(out), kind) => {
            let value = |b: &[u8; 4]| match kind {
                SampleType::U32 => u32::from_ne_bytes(*b) as f32,
                _ => f32::from_ne_bytes(*b),
            };
            let all = bytes.as_chunks::<4>().0.iter().enumerate();
            all.for_each(|(i, b)| at(i).into_iter().for_each(|at| out[at] = value(b)));
        }
        _ => {}
    }
}
