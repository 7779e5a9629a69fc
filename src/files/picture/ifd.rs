//! The directories of a TIFF, read before its decoder sees them: which page is the picture and not a thumbnail, whether
//! it is really a raw photograph, and which values must be patched for the decoder so that it reads what it is able to
//! (palettes and Lab are samples like any others; their meaning is added afterwards).

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};

/// At most this many pages are looked at.
const MOST_PAGES: usize = 64;
/// At most this many values of an entry are read: more than the largest palette or any color profile has.
const MOST_VALUES: u64 = 4 << 20;

pub(super) const SUBFILE: u16 = 254;
pub(super) const BITS: u16 = 258;
pub(super) const COMPRESSION: u16 = 259;
pub(super) const PHOTOMETRIC: u16 = 262;
pub(super) const SAMPLES: u16 = 277;
pub(super) const PLANES: u16 = 284;
pub(super) const COLOR_MAP: u16 = 320;
pub(super) const SUB_PAGES: u16 = 330;
pub(super) const EXTRA_SAMPLES: u16 = 338;
pub(super) const PROFILE: u16 = 34675;
pub(super) const DNG: u16 = 50706;

/// How numbers are stored in the file.
#[derive(Clone, Copy)]
pub(super) struct Form {
    big_endian: bool,
    /// BigTIFF: offsets of 8 bytes.
    wide: bool,
}

/// A directory: a page of the file.
pub(super) struct Page {
    pub at: u64,
    entries: Vec<Entry>,
    next: u64,
}

struct Entry {
    tag: u16,
    kind: u16,
    count: u64,
    /// Where the entry's value, or the offset of its values, is.
    at: u64,
}

impl Form {
    fn number(self, bytes: &[u8]) -> u64 {
        let add = |sum: u64, byte: &u8| sum << 8 | u64::from(*byte);
        if self.big_endian { bytes.iter().fold(0, add) } else { bytes.iter().rev().fold(0, add) }
    }

    fn bytes(self, number: u64, count: usize) -> Vec<u8> {
        let all = number.to_be_bytes();
        let mut bytes = all[8 - count..].to_vec();
        if !self.big_endian {
            bytes.reverse();
        }
        bytes
    }

    /// Bytes of an offset.
    fn offset(self) -> usize {
        if self.wide { 8 } else { 4 }
    }

    /// Where the offset of the first page is.
    fn first(self) -> u64 {
        if self.wide { 8 } else { 4 }
    }
}

fn number(file: &mut File, form: Form, at: u64, count: usize) -> io::Result<u64> {
    let mut bytes = [0; 8];
    file.seek(SeekFrom::Start(at))?;
    file.read_exact(&mut bytes[..count])?;
    Ok(form.number(&bytes[..count]))
}

/// How the file stores numbers, and its pages with their subpages, as far as they can be read.
pub(super) fn pages(file: &mut File) -> io::Result<(Form, Vec<Page>)> {
    let mut start = [0; 4];
    file.rewind()?;
    file.read_exact(&mut start)?;
    let form = Form { big_endian: start[0] == b'M', wide: start.contains(&b'+') };
    let mut waiting = vec![number(file, form, form.first(), form.offset())?];
    let mut pages: Vec<Page> = Vec::new();
    while let Some(at) = waiting.pop() {
        if at == 0 || pages.len() == MOST_PAGES || pages.iter().any(|page| page.at == at) {
            continue;
        }
        let page = match page(file, form, at) {
            Ok(page) => page,
            Err(error) if pages.is_empty() => return Err(error),
            Err(_) => continue,
        };
        // The next page comes before the subpages of this one.
        waiting.extend(page.values(file, form, SUB_PAGES).into_iter().rev());
        waiting.push(page.next);
        pages.push(page);
    }
    Ok((form, pages))
}

fn page(file: &mut File, form: Form, at: u64) -> io::Result<Page> {
    let (head, size) = if form.wide { (8, 20) } else { (2, 12) };
    let count = number(file, form, at, head)?.min(4096);
    let mut bytes = vec![0; (count * size) as usize];
    file.seek(SeekFrom::Start(at.saturating_add(head as u64)))?;
    file.read_exact(&mut bytes)?;
    let entry = |(i, b): (usize, &[u8])| Entry {
        tag: form.number(&b[..2]) as u16,
        kind: form.number(&b[2..4]) as u16,
        count: form.number(&b[4..4 + form.offset()]),
        at: at + head as u64 + i as u64 * size + 4 + form.offset() as u64,
    };
    let entries = bytes.chunks_exact(size as usize).enumerate().map(entry).collect();
    let next = number(file, form, at + head as u64 + count * size, form.offset()).unwrap_or(0);
    Ok(Page { at, entries, next })
}

impl Page {
    fn entry(&self, tag: u16) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.tag == tag)
    }

    pub fn has(&self, tag: u16) -> bool {
        self.entry(tag).is_some()
    }

    /// The whole numbers of an entry; empty if there is no such entry.
    pub fn values(&self, file: &mut File, form: Form, tag: u16) -> Vec<u64> {
        let Some(entry) = self.entry(tag) else { return Vec::new() };
        let size = match entry.kind {
            1 | 6 | 7 => 1,
            3 | 8 => 2,
            4 | 9 | 13 => 4,
            16..=18 => 8,
            _ => return Vec::new(),
        };
        let count = entry.count.min(MOST_VALUES) as usize;
        let inside = count * size <= form.offset();
        let at = if inside { Ok(entry.at) } else { number(file, form, entry.at, form.offset()) };
        // An entry may claim more bytes than the file has.
        let mut bytes = Vec::new();
        let read = at.and_then(|at| file.seek(SeekFrom::Start(at)));
        let read = read.and_then(|_| file.take((count * size) as u64).read_to_end(&mut bytes));
        if read.is_err() || bytes.len() < count * size {
            return Vec::new();
        }
        bytes.chunks_exact(size).map(|b| form.number(b)).collect()
    }

    pub fn value(&self, file: &mut File, form: Form, tag: u16) -> Option<u64> {
        self.values(file, form, tag).first().copied()
    }

    /// The patch that sets `tag`, a short number, to `value`.
    pub fn told(&self, form: Form, tag: u16, value: u16) -> Option<(u64, Vec<u8>)> {
        let entry = self.entry(tag).filter(|entry| entry.kind == 3 && entry.count == 1)?;
        Some((entry.at, form.bytes(value.into(), 2)))
    }

    /// The patch that makes this page the first.
    pub fn first(&self, form: Form) -> (u64, Vec<u8>) {
        (form.first(), form.bytes(self.at, form.offset()))
    }
}

/// A file with some bytes patched.
pub(super) struct Patched {
    pub file: File,
    pub at: u64,
    pub changes: Vec<(u64, Vec<u8>)>,
}

impl Read for Patched {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.file.seek(SeekFrom::Start(self.at))?;
        let read = self.file.read(buffer)?;
        for (from, bytes) in &self.changes {
            for (i, byte) in bytes.iter().enumerate() {
                let place = (from + i as u64).checked_sub(self.at).filter(|&place| place < read as u64);
                place.into_iter().for_each(|place| buffer[place as usize] = *byte);
            }
        }
        self.at += read as u64;
        Ok(read)
    }
}

impl Seek for Patched {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.at = match to {
            SeekFrom::Start(at) => at,
            SeekFrom::Current(by) => self.at.checked_add_signed(by).ok_or(io::ErrorKind::InvalidInput)?,
            SeekFrom::End(_) => self.file.seek(to)?,
        };
        Ok(self.at)
    }
}
