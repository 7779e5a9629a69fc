//! Sampled vector fields from files, for the `field` tool: Middlebury `.flo`, KITTI optical flow (16-bit PNG) and
//! OpenEXR (R and G, u and v, or those of a layer such as forward.u and forward.v, are x and y, in pixels). A vector
//! that is unknown or invalid according to the file, or not finite, is zero: that place stays still.

use std::fs::File;
use std::io::{Read, Seek};

use super::limits::within;
use super::{Limits, picture};
use crate::base::budget::{Budget, Share};
use crate::base::error::{Error, Result};
use crate::base::pixels::Grid;

/// A vector for every pixel, x right and y down, in pixels.
pub type VectorField = Grid<[f32; 2]>;

const FLO: &[u8] = b"PIEH";
const PNG: &[u8] = b"\x89PNG";
const EXR: &[u8] = b"\x76\x2f\x31\x01";

/// Components of a `.flo` beyond this are unknown.
const FLO_KNOWN: f32 = 1e9;

/// The vector field in an open file, whose format is recognized by its first bytes; `place` is its name in messages.
///
/// # Errors
/// If it is none of the three formats, is broken, or is larger than the limits allow.
pub fn decode(mut file: File, place: &str, limits: &Limits, budget: &Budget) -> Result<(VectorField, Share)> {
    let mut magic = Vec::new();
    (&mut file).take(4).read_to_end(&mut magic).map_err(|error| Error::at(place, error))?;
    file.rewind().map_err(|error| Error::at(place, error))?;
    match magic.as_slice() {
        FLO => flo(file, place, limits, budget),
        PNG => from_kitti(file, place, limits, budget),
        EXR => from_exr(file, place, limits, budget),
        _ => {
            Err(Error::at(place, "is not a vector field").cure("give a .flo, a KITTI PNG with 16 bits, or an OpenEXR"))
        }
    }
}

/// 4 bytes PIEH, width and height as i32, then x and y as f32 by rows; little-endian.
fn flo(mut file: File, place: &str, limits: &Limits, budget: &Budget) -> Result<(VectorField, Share)> {
    let mut header = [0; 12];
    file.read_exact(&mut header).map_err(|_| cut_short(place))?;
    let side = |at: usize| i32::from_le_bytes(std::array::from_fn(|i| header[at + i]));
    let (Ok(width), Ok(height)) = (u64::try_from(side(4)), u64::try_from(side(8))) else {
        return Err(Error::at(place, format!("has a wrong size: {} x {}", side(4), side(8))));
    };
    if width == 0 || height == 0 {
        return Err(Error::at(place, format!("has no vectors: it is {width} x {height}")));
    }
    let size = format!("is {width} x {height}:");
    within(place, &size, "pixels wide or high", "side", width.max(height), limits.side)?;
    within(place, &size, "pixels", "pixels", width * height, limits.pixels)?;
    // The length first: a header alone must not cost the memory that it claims.
    if file.metadata().map_err(|error| Error::at(place, error))?.len() < 12 + width * height * 8 {
        return Err(cut_short(place));
    }
    let share = budget.take(width * height * 8, place)?;
    // Row by row: the whole file is never in memory beside the vectors.
    let mut row = vec![0; (width * 8) as usize];
    let mut vectors = Vec::with_capacity((width * height) as usize);
    for _ in 0..height {
        file.read_exact(&mut row).map_err(|_| cut_short(place))?;
        vectors.extend(row.as_chunks::<8>().0.iter().map(|&[a, b, c, d, e, f, g, h]| {
            known([f32::from_le_bytes([a, b, c, d]), f32::from_le_bytes([e, f, g, h])], FLO_KNOWN)
        }));
    }
    Ok((Grid::from_cells(width as usize, height as usize, vectors), share))
}

fn from_kitti(file: File, place: &str, limits: &Limits, budget: &Budget) -> Result<(VectorField, Share)> {
    let mut share = Share::default();
    // The decoded picture and the vectors are both in memory for a moment.
    let allow = |bytes: u64| {
        share = budget.take(bytes.saturating_mul(7) / 3, place)?;
        Ok(())
    };
    let ((width, height), words) = picture::words(file, place, limits, allow)?;
    let vectors: Vec<[f32; 2]> = words.into_iter().map(vector_of_kitti).collect();
    share.shrink(size_of_val(&vectors[..]) as u64);
    Ok((Grid::from_cells(width, height, vectors), share))
}

fn from_exr(file: File, place: &str, limits: &Limits, budget: &Budget) -> Result<(VectorField, Share)> {
    let mut share = Share::default();
    let allow = |bytes: u64| {
        share = budget.take(bytes, place)?;
        Ok(())
    };
    let ((width, height), mut vectors) = picture::vectors(file, place, limits, allow)?;
    vectors.iter_mut().for_each(|vector| *vector = known(*vector, f32::MAX));
    Ok((Grid::from_cells(width, height, vectors), share))
}

/// x = (red - 2^15) / 64, y likewise from green; blue is 0 if they are invalid.
fn vector_of_kitti([r, g, valid]: [u16; 3]) -> [f32; 2] {
    if valid == 0 { [0.0; 2] } else { [r, g].map(|code| (f32::from(code) - 32768.0) / 64.0) }
}

fn known(vector: [f32; 2], most: f32) -> [f32; 2] {
    if vector.iter().all(|x| x.abs() <= most) { vector } else { [0.0; 2] }
}

fn cut_short(place: &str) -> Error {
    Error::at(place, "is cut short").cure("copy it again from where it came")
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{DynamicImage, ImageBuffer, Luma, Rgb};

    fn read(name: &str, bytes: &[u8], limits: &Limits) -> std::result::Result<VectorField, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        let decoded = decode(File::open(&path).unwrap(), name, limits, &limits.budget());
        decoded.map(|(field, _)| field).map_err(|error| error.to_string())
    }

    fn encoded(image: DynamicImage, format: image::ImageFormat) -> Vec<u8> {
        let mut bytes = Vec::new();
        image.write_to(&mut std::io::Cursor::new(&mut bytes), format).unwrap();
        bytes
    }

    fn flo_bytes(width: i32, height: i32, numbers: &[f32]) -> Vec<u8> {
        let mut bytes = [FLO, &width.to_le_bytes(), &height.to_le_bytes()].concat();
        bytes.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
        bytes
    }

    #[test]
    fn the_three_formats_are_read() {
        let limits = Limits::default();
        let flo = flo_bytes(2, 1, &[1.5, -2.0, 2e9, f32::NAN]);
        let kitti: DynamicImage =
            ImageBuffer::from_fn(2, 1, |x, _| Rgb([32768 + 96, 32768 - 128, 1 - x as u16])).into();
        let exr: DynamicImage =
            ImageBuffer::from_fn(2, 1, |x, _| Rgb([[1.5, -2.0, 0.0], [f32::INFINITY, 1.0, 0.0]][x as usize])).into();
        for (name, bytes) in [
            ("v.flo", flo),
            ("v.png", encoded(kitti, image::ImageFormat::Png)),
            ("v.exr", encoded(exr, image::ImageFormat::OpenExr)),
        ] {
            let field = read(name, &bytes, &limits).unwrap();
            assert_eq!(field.cells(), [[1.5, -2.0], [0.0, 0.0]], "{name}");
            let little = Limits { memory: 15, ..limits.clone() };
            assert!(read(name, &bytes, &little).unwrap_err().contains("--limit memory"), "{name}");
        }
    }

    #[test]
    fn what_is_no_field_says_so() {
        let picture: DynamicImage = ImageBuffer::from_pixel(1, 1, Luma([9u8])).into();
        for (bytes, part) in [
            (b"".to_vec(), "not a vector field"),
            (b"PIE".to_vec(), "not a vector field"),
            (FLO.to_vec(), "cut short"),
            (flo_bytes(2, 1, &[0.0; 3]), "cut short"),
            (flo_bytes(20000, 10000, &[]), "cut short"),
            (flo_bytes(-1, 1, &[]), "wrong size"),
            (flo_bytes(0, 1, &[]), "no vectors"),
            (flo_bytes(i32::MAX, 1, &[]), "--limit side"),
            (flo_bytes(65535, 65535, &[]), "--limit pixels"),
            (encoded(picture, image::ImageFormat::Png), "a picture, not a vector field"),
        ] {
            let error = read("v", &bytes, &Limits::default()).unwrap_err();
            assert!(error.contains(part), "{error}");
        }
    }
}
