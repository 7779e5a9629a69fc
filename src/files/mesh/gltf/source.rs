//! A glTF file taken apart: its JSON, and the bytes of its buffers, which are read when they are first asked for.

use std::borrow::Cow;
use std::cell::OnceCell;
use std::cmp::Ordering;
use std::fmt::Display;
use std::path::{Component, Path};

use base64::alphabet;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use base64::{DecodeError, Engine};

use super::document::{Asset, Buffer, Document, Text};
use crate::base::budget::{Budget, Share};
use crate::base::error::{Error, Result};
use crate::base::text::{byte_of_hex, counted, there_are};
use crate::files::Limits;
use crate::files::mesh::input::{self, Opener};
use crate::files::picture::kinds::command;

/// Files of some programs leave the padding out.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Extensions that change nothing about a mesh: where their names begin. Quantized numbers are read.
const HARMLESS: [&str; 8] = [
    "KHR_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "MSFT_texture_",
    "KHR_lights_",
    "EXT_lights_",
    "KHR_xmp",
    "KHR_mesh_quantization",
];

/// Extensions that pack the numbers of a mesh, which a command undoes.
const PACKED: [&str; 3] = ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"];

/// What a file is read with.
#[derive(Clone, Copy)]
pub(in crate::files::mesh) struct With<'a> {
    pub(in crate::files::mesh) place: &'a str,
    pub(in crate::files::mesh) limits: &'a Limits,
    pub(in crate::files::mesh) budget: &'a Budget,
    pub(in crate::files::mesh) sibling: Opener<'a>,
    /// Whether it may name files outside its folder.
    pub(in crate::files::mesh) outside: bool,
}

/// A file taken apart.
pub(super) struct Source<'a> {
    pub(super) document: Document<'a>,
    pub(super) with: With<'a>,
    /// The second chunk of a `.glb`.
    binary: Option<&'a [u8]>,
    buffers: Vec<OnceCell<(Cow<'a, [u8]>, Share)>>,
    _share: Share,
}

impl<'a> Source<'a> {
    /// Takes a `.glb` or `.gltf` apart.
    pub(super) fn of(bytes: &'a [u8], with: With<'a>) -> Result<Source<'a>> {
        let (json, binary) = if bytes.starts_with(b"glTF") { chunks(bytes, with.place)? } else { (bytes, None) };
        let json = input::text(json);
        // What is skipped of a document is not looked at by its reader.
        if let Err(error) = std::str::from_utf8(json) {
            let what = format!("its JSON is no text from byte {} on: that is not UTF-8", error.valid_up_to());
            return Err(Error::at(with.place, what).cure("export it again"));
        }
        let share = with.budget.take(most_bytes(json), with.place)?;
        let document: Document = serde_json::from_slice(json).map_err(|error| explain(with.place, &error, json))?;
        let buffers = document.buffers.iter().map(|_| OnceCell::new()).collect();
        let source = Source { document, with, binary, buffers, _share: share };
        source.check_version()?;
        source.check_extensions()?;
        Ok(source)
    }

    fn check_version(&self) -> Result<()> {
        let Asset { version: Text(version), min_version: Text(least) } = &self.document.asset;
        let what = match (&**version, &**least) {
            ("", _) => "is not a glTF file: it has no asset.version".to_owned(),
            (version, _) if !version.starts_with("2.") => format!("is glTF {version}"),
            (_, "" | "2.0") => return Ok(()),
            (_, least) => format!("needs a reader of glTF {least}"),
        };
        Err(Error::at(self.with.place, what).cure("Plica reads glTF 2.0: export it again as .glb"))
    }

    fn check_extensions(&self) -> Result<()> {
        let required = self.document.extensions_required.iter().map(|Text(name)| name);
        let mut unknown = required.filter(|name| !HARMLESS.iter().any(|known| name.starts_with(known)));
        let Some(name) = unknown.next() else { return Ok(()) };
        let place = self.with.place;
        let cure = match PACKED.contains(&&**name) {
            true => format!("unpack it: {}", command("gltf-transform cp IN OUT-plain.glb", place)),
            false => "export it again without that extension".to_owned(),
        };
        Err(Error::at(place, format!("needs the extension {name}, which Plica does not read")).cure(cure))
    }

    /// An error about this file.
    pub(super) fn wrong(&self, what: impl Display) -> Error {
        Error::at(self.with.place, what).cure("export it again")
    }

    /// What an index in the JSON means.
    pub(super) fn get<'t, T>(&self, list: &'t [T], index: usize, name: &str) -> Result<&'t T> {
        list.get(index).ok_or_else(|| self.wrong(format!("there is no {name} {index}: {}", there_are(list.len()))))
    }

    /// The bytes of a buffer.
    pub(super) fn buffer(&self, index: usize) -> Result<&[u8]> {
        let buffer = self.get(&self.document.buffers, index, "buffer")?;
        let known = &self.buffers[index];
        let bytes = match known.get() {
            Some((bytes, _)) => bytes,
            None => {
                let read = self.read(index, buffer)?;
                &known.get_or_init(|| read).0
            }
        };
        match usize::try_from(buffer.byte_length).ok().and_then(|length| bytes.get(..length)) {
            Some(bytes) => Ok(bytes),
            None => Err(self.short_buffer(index, buffer, bytes.len())),
        }
    }

    /// What is said of a buffer that is shorter than the file says.
    fn short_buffer(&self, index: usize, buffer: &Buffer, found: usize) -> Error {
        let beside =
            buffer.uri.as_ref().filter(|Text(uri)| !uri.starts_with("data:")).and_then(|Text(uri)| self.path(uri).ok());
        let (called, cure) = match beside {
            Some(path) => (path.clone(), format!("copy {path} again from where it came")),
            None => (index.to_string(), "copy it again from where it came, or export it again".to_owned()),
        };
        let what = format!("its buffer {called} has {found} bytes, and is to have {}", buffer.byte_length);
        Error::at(self.with.place, what).cure(cure)
    }

    fn read(&self, index: usize, buffer: &Buffer<'a>) -> Result<(Cow<'a, [u8]>, Share)> {
        let With { place, limits, budget, sibling, .. } = self.with;
        let Some(Text(uri)) = &buffer.uri else {
            let binary = self.binary.filter(|_| index == 0);
            let missing = || self.wrong(format!("buffer {index} is not in the file"));
            return Ok((Cow::Borrowed(binary.ok_or_else(missing)?), Share::default()));
        };
        if uri.starts_with("data:") {
            return data(uri, &format!("buffer {index}"), place, budget)
                .map(|(bytes, share)| (Cow::Owned(bytes), share));
        }
        let path = self.path(uri)?;
        let of_model = |error| Error::at(place, format!("its buffer {error}"));
        let file = sibling(&path).map_err(of_model)?;
        let (bytes, share) = input::whole(file, &path, limits, budget).map_err(of_model)?;
        Ok((Cow::Owned(bytes), share))
    }

    /// The path, relative to the file, that an address means; it is in the folder of the file or below, unless others are
    /// allowed.
    pub(super) fn path(&self, uri: &str) -> Result<String> {
        let path = self.any_path(uri)?;
        let stays = |part| matches!(part, Component::Normal(_) | Component::CurDir);
        match self.with.outside || Path::new(&path).components().all(stays) {
            true => Ok(path),
            false => {
                let what = format!("has a part at {uri}, which is not in the model's folder");
                let cure = "give --allow-outside, or copy the file beside the model and mend its uri";
                Err(Error::at(self.with.place, what).cure(cure))
            }
        }
    }

    /// The same, wherever it leads.
    pub(super) fn any_path(&self, uri: &str) -> Result<String> {
        let scheme = uri.split_once(':').map(|(scheme, _)| scheme).filter(|scheme| !scheme.contains('/'));
        if scheme.is_some() {
            let what = format!("has a part at {uri}, which Plica does not fetch");
            return Err(Error::at(self.with.place, what).cure("export it as .glb, which is one file"));
        }
        let path = unescaped(uri).filter(|path| !path.contains('\0'));
        path.ok_or_else(|| self.wrong(format!("has a part at {}, which is no path", uri.escape_debug())))
    }
}

/// The JSON and the binary chunk of a `.glb`.
fn chunks<'a>(bytes: &'a [u8], place: &str) -> Result<(&'a [u8], Option<&'a [u8]>)> {
    let wrong = |what: &str| Error::at(place, what).cure("export it again");
    let number = |at: usize| bytes.get(at..)?.first_chunk().copied().map(u32::from_le_bytes);
    let short = || cut_short(place);
    let version = number(4).ok_or_else(short)?;
    if version != 2 {
        let what = format!("is a .glb of version {version}");
        return Err(Error::at(place, what).cure("Plica reads glTF 2.0: export it again as .glb"));
    }
    let (whole, found) = (number(8).ok_or_else(short)? as usize, bytes.len());
    match found.cmp(&whole) {
        Ordering::Less => {
            let what = format!("is cut short: it has {found} bytes, and is to have {whole}");
            return Err(Error::at(place, what).cure("copy it again from where it came"));
        }
        Ordering::Greater => return Err(wrong(&format!("has {found} bytes, and says that it has {whole}"))),
        Ordering::Equal => {}
    }
    let chunk = |at: usize, name: &str| {
        let parts =
            bytes.get(at + 4..at + 8).zip(number(at).and_then(|long| bytes.get(at + 8..)?.get(..long as usize)));
        parts.ok_or_else(|| wrong(&format!("its chunk {name} reaches beyond its end, {whole} bytes")))
    };
    let (kind, json) = chunk(12, "0")?;
    if kind != b"JSON" {
        return Err(wrong("is not a glTF file: it does not begin with its JSON"));
    }
    let after = 20 + json.len();
    if after >= whole {
        return Ok((json, None));
    }
    let (kind, binary) = chunk(after, "1")?;
    Ok((json, (kind == b"BIN\0").then_some(binary)))
}

/// The most bytes that a document of this JSON takes, by what it counts: a struct for each brace, a number or a text for
/// each comma, with room for lists to grow.
fn most_bytes(json: &[u8]) -> u64 {
    let cost = |byte: &u8| match byte {
        b'{' => 1024,
        b',' | b'[' => 128,
        _ => 0,
    };
    json.iter().map(cost).sum::<u64>()
}

fn explain(place: &str, error: &serde_json::Error, json: &[u8]) -> Error {
    if error.is_eof() {
        return cut_short(place);
    }
    let (line, column) = (error.line(), error.column());
    let message = error.to_string();
    let what = message.strip_suffix(&format!(" at line {line} column {column}")).unwrap_or(&message);
    let before =
        json.split_inclusive(|byte| *byte == b'\n').take(line.saturating_sub(1)).map(<[u8]>::len).sum::<usize>();
    let at = path_to(json, before + column);
    let what = format!("is not a glTF file: line {line}, column {column}{at}: {what}");
    Error::at(place, what).cure("export it again")
}

/// The keys and indices, in parentheses, that lead to what ends at a byte of a JSON text that is right until there.
fn path_to(json: &[u8], end: usize) -> String {
    let mut path: Vec<String> = Vec::new();
    let mut bytes = json.iter().take(end);
    let mut text = Vec::new();
    while let Some(byte) = bytes.next() {
        match byte {
            b'"' => {
                let mut escaped = false;
                let goes_on = |byte: &&u8| {
                    let escapes = **byte == b'\\' && !escaped;
                    std::mem::replace(&mut escaped, escapes) || **byte != b'"'
                };
                text = bytes.by_ref().take_while(goes_on).copied().collect();
            }
            b':' => {
                path.iter_mut().next_back().into_iter().for_each(|key| *key = String::from_utf8_lossy(&text).into())
            }
            b'{' => path.push(String::new()),
            b'[' => path.push("0".into()),
            b'}' | b']' => drop(path.pop()),
            b',' => path.iter_mut().next_back().into_iter().for_each(|step| {
                *step = step.parse().map_or_else(|_| String::new(), |index: usize| (index + 1).to_string());
            }),
            _ => {}
        }
    }
    let path: Vec<String> = path.into_iter().filter(|step| !step.is_empty()).collect();
    if path.is_empty() { String::new() } else { format!(" ({})", path.join(".")) }
}

/// The bytes of the `data:` address of a part that is called so, as `buffer 0`.
pub(super) fn data(uri: &str, part: &str, place: &str, budget: &Budget) -> Result<(Vec<u8>, Share)> {
    let broken = |why: &str| Error::at(place, format!("its {part} {why}")).cure("export it again as .glb");
    let text = uri.split_once(',').filter(|(head, _)| head.ends_with(";base64")).map(|(_, text)| text);
    let text = text.ok_or_else(|| broken("is in the file, but not in base64"))?;
    let share = budget.take(base64::decoded_len_estimate(text.len()) as u64, place)?;
    let bytes = BASE64.decode(text).map_err(|error| broken(&format!("is broken base64: {}", told(&error, text))))?;
    Ok((bytes, share))
}

/// Where base64 is broken, in words.
fn told(error: &DecodeError, text: &str) -> String {
    match *error {
        DecodeError::InvalidByte(at, _) | DecodeError::InvalidLastSymbol(at, _) => {
            let sign = text.get(at..).and_then(|rest| rest.chars().next()).unwrap_or_default();
            format!("{sign:?} at character {at} of {}", text.len())
        }
        DecodeError::InvalidLength(_) | DecodeError::InvalidPadding => {
            format!("its {} end within a byte", counted(text.len(), "character"))
        }
    }
}

/// A path whose `%20` and the like are undone; `None` if that is no text.
fn unescaped(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&byte, after)) = rest.split_first() {
        let digits = after.get(..2).filter(|_| byte == b'%');
        let escaped = digits.and_then(byte_of_hex);
        bytes.push(escaped.unwrap_or(byte));
        rest = if escaped.is_some() { &after[2..] } else { after };
    }
    String::from_utf8(bytes).ok()
}

fn cut_short(place: &str) -> Error {
    Error::at(place, "is cut short").cure("copy it again from where it came")
}
