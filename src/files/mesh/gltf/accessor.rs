//! The numbers of a glTF file: every accessor is checked against its view, and every view against its buffer, before
//! anything is read from it.

use super::document::{Accessor, Part, Sparse};
use super::source::Source;
use crate::base::error::Result;
use crate::base::text::{counted, there_are};
use crate::files::limits::within;

/// What a number is stored as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

/// By their number in the file.
const COMPONENTS: [(u32, Component); 6] = [
    (5120, Component::I8),
    (5121, Component::U8),
    (5122, Component::I16),
    (5123, Component::U16),
    (5125, Component::U32),
    (5126, Component::F32),
];

impl Component {
    fn size(self) -> usize {
        match self {
            Component::I8 | Component::U8 => 1,
            Component::I16 | Component::U16 => 2,
            Component::U32 | Component::F32 => 4,
        }
    }

    /// The number in the first bytes; integers that are normalized go from -1 or 0 to 1.
    fn number(self, bytes: &[u8], normalized: bool) -> f64 {
        let [a, b, c, d] = std::array::from_fn(|at| bytes.get(at).copied().unwrap_or_default());
        let (number, most) = match self {
            Component::I8 => (f64::from(a as i8), 127.0),
            Component::U8 => (f64::from(a), 255.0),
            Component::I16 => (f64::from(i16::from_le_bytes([a, b])), 32767.0),
            Component::U16 => (f64::from(u16::from_le_bytes([a, b])), 65535.0),
            Component::U32 => (f64::from(u32::from_le_bytes([a, b, c, d])), f64::from(u32::MAX)),
            Component::F32 => return f64::from(f32::from_le_bytes([a, b, c, d])),
        };
        if normalized { (number / most).max(-1.0) } else { number }
    }
}

/// Elements at equal distances in a buffer.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    component: Component,
    normalized: bool,
}

impl Elements<'_> {
    fn get<const N: usize>(&self, at: usize) -> [f64; N] {
        let bytes = &self.bytes[at * self.stride..];
        std::array::from_fn(|i| self.component.number(&bytes[i * self.component.size()..], self.normalized))
    }
}

/// Where the numbers of an accessor are.
pub(super) struct Stored<'a> {
    pub(super) count: u64,
    /// All zero without them.
    all: Option<Elements<'a>>,
    /// How many differ from those, their indices, and what they are.
    differ: Option<(u64, Elements<'a>, Elements<'a>)>,
}

/// The shape of elements of so many numbers.
fn shape(numbers: usize) -> &'static str {
    ["SCALAR", "VEC2", "VEC3", "VEC4"][numbers.clamp(1, 4) - 1]
}

impl Source<'_> {
    /// The accessor with this index, which must have elements of `N` numbers.
    fn accessor<const N: usize>(&self, index: usize) -> Result<&Accessor> {
        let accessor = self.get(&self.document.accessors, index, "accessor")?;
        if accessor.shape != shape(N) {
            let what = format!("accessor {index} is {}, and {} was expected", accessor.shape, shape(N));
            return Err(self.wrong(what));
        }
        Ok(accessor)
    }

    /// Where the numbers of an accessor are, all of them there.
    pub(super) fn stored<const N: usize>(&self, index: usize) -> Result<Stored<'_>> {
        let Accessor { count, byte_offset, component_type, normalized, buffer_view, ref sparse, .. } =
            *self.accessor::<N>(index)?;
        let sparse = sparse.as_ref().filter(|sparse| sparse.count > 0);
        // Zeros that are not stored make a large mesh of a few bytes: no more of them than a mesh may have triangles.
        if buffer_view.is_none() {
            let (place, most) = (self.with.place, self.with.limits.triangles);
            let what = format!("accessor {index} has");
            within(place, &what, "elements that are not stored", "triangles", count, most)?;
        }
        let part = |buffer_view| Part { buffer_view, byte_offset, component_type };
        let all = buffer_view.map(|view| self.elements::<N>(index, &part(view), count, normalized)).transpose()?;
        let Some(Sparse { count: differ, indices, values }) = sparse else {
            return Ok(Stored { count, all, differ: None });
        };
        if *differ > count {
            return Err(self.wrong(format!("accessor {index}: {differ} of {count} elements differ")));
        }
        let indices = self.elements::<1>(index, indices, *differ, false)?;
        let values = self.elements::<N>(index, &Part { component_type, ..*values }, *differ, normalized)?;
        Ok(Stored { count, all, differ: Some((*differ, indices, values)) })
    }

    /// Hands the elements of an accessor to `put` with their indices; those that differ from the others come again. They
    /// are finite.
    pub(super) fn numbers<const N: usize>(&self, index: usize, mut put: impl FnMut(usize, [f64; N])) -> Result<()> {
        let Stored { count, all, differ } = self.stored::<N>(index)?;
        let mut put = |at: usize, numbers: [f64; N]| {
            if !numbers.iter().all(|number| number.is_finite()) {
                return Err(self.wrong(format!("accessor {index}: element {at} is not finite")));
            }
            put(at, numbers);
            Ok(())
        };
        if let Some(elements) = all {
            (0..count as usize).try_for_each(|at| put(at, elements.get(at)))?;
        }
        let Some((differ, indices, values)) = differ else { return Ok(()) };
        (0..differ as usize).try_for_each(|at| {
            let [element] = indices.get(at);
            if !(0.0..count as f64).contains(&element) {
                return Err(
                    self.wrong(format!("accessor {index}: there is no element {element}: {}", there_are(count)))
                );
            }
            put(element as usize, values.get(at))
        })
    }

    /// As [`Source::stored`], for indices.
    pub(super) fn stored_indices(&self, index: usize) -> Result<Stored<'_>> {
        let number = self.accessor::<1>(index)?.component_type;
        let unsigned = |&&(known, ref component): &&(u32, Component)| {
            known == number && matches!(component, Component::U8 | Component::U16 | Component::U32)
        };
        match COMPONENTS.iter().find(unsigned) {
            Some(_) => self.stored::<1>(index),
            None => Err(self.wrong(format!("accessor {index} is not of whole numbers"))),
        }
    }

    /// Where `count` elements of the accessor with this index are, all of them within their view.
    fn elements<const N: usize>(
        &self,
        index: usize,
        part: &Part,
        count: u64,
        normalized: bool,
    ) -> Result<Elements<'_>> {
        let known = COMPONENTS.iter().find(|(number, _)| *number == part.component_type);
        let &(_, component) = known.ok_or_else(|| {
            self.wrong(format!("accessor {index}: there is no type of numbers {}", part.component_type))
        })?;
        let view = self.get(&self.document.buffer_views, part.buffer_view, "buffer view")?;
        let size = N * component.size();
        let stride = view.byte_stride.filter(|&stride| stride > 0).unwrap_or(size as u64);
        if stride < size as u64 {
            let view = part.buffer_view;
            return Err(self.wrong(format!(
                "the byteStride of buffer view {view} is {stride}, and an element of accessor {index} has {size} bytes"
            )));
        }
        let needed = count.saturating_sub(1).saturating_mul(stride).saturating_add(size as u64);
        let needed = if count == 0 { 0 } else { needed };
        let bytes = self.view(part.buffer_view)?;
        let bytes = usize::try_from(part.byte_offset).ok().and_then(|offset| bytes.get(offset..));
        match bytes {
            Some(bytes) if needed <= bytes.len() as u64 => {
                Ok(Elements { bytes, stride: stride as usize, component, normalized })
            }
            _ => {
                let view = part.buffer_view;
                Err(self.wrong(format!(
                    "accessor {index} has {}: its buffer view {view} is too short",
                    counted(count, "element")
                )))
            }
        }
    }

    /// The bytes of a buffer view.
    pub(super) fn view(&self, index: usize) -> Result<&[u8]> {
        let view = self.get(&self.document.buffer_views, index, "buffer view")?;
        let range = usize::try_from(view.byte_offset).ok().zip(usize::try_from(view.byte_length).ok());
        let bytes = self.buffer(view.buffer)?;
        let within = range.and_then(|(offset, length)| bytes.get(offset..)?.get(..length));
        within.ok_or_else(|| self.wrong(format!("buffer view {index} reaches beyond its buffer")))
    }
}
