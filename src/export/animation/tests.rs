//! Every format decoded again, by decoders that know nothing of how it was written.

use std::fs;
use std::io::{self, Cursor};
use std::sync::{Arc, Mutex};

use image::AnimationDecoder;

use super::rate::Rate;
use super::*;
use crate::base::pixels::{Frame, Grid};

/// A bright square that wanders over a slope, with a transparent corner that comes and goes.
fn frames(width: usize, height: usize, count: u64) -> Vec<Frame> {
    let cell = |k: usize, x: usize, y: usize| match () {
        () if x.abs_diff(3 + 2 * k) < 2 && y.abs_diff(height / 2) < 3 => [250, (40 * k) as u8, 20, 255],
        () if k % 3 == 1 && x + y < 6 => [0, 0, 0, 0],
        () => [(x * 7 % 256) as u8, (y * 11 % 256) as u8, ((x + y) * 3 % 256) as u8, 255],
    };
    let frame = |k: u64| {
        let cells = (0..width * height).map(|i| cell(k as usize, i % width, i / width)).collect();
        Grid::from_cells(width, height, cells)
    };
    (0..count).map(frame).collect()
}

fn begin(path: &Path, show: Show) -> Result<Box<dyn Sink>> {
    let numbers: Vec<u64> = (0..20).take(if show.frames == 1 { 1 } else { 20 }).collect();
    Target::file(path, &numbers, &mut Guard::new(true))?.begin(show)
}

fn show(frames: &[Frame], fps: f64, once: bool) -> Show {
    let (width, height) = (frames[0].width(), frames[0].height());
    Show {
        place: "test".into(),
        width,
        height,
        frames: frames.len() as u64,
        rate: Rate::from_fps(fps),
        once,
        matrix: None,
        command: "plica render s".into(),
        cancel: Arc::default(),
    }
}

/// Writes the frames to a file of that name in a fresh folder and returns the file's bytes and the notes.
fn written(name: &str, frames: &[Frame], fps: f64, once: bool) -> (Vec<u8>, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    let mut sink = begin(&path, show(frames, fps, once)).unwrap();
    for (k, frame) in frames.iter().enumerate() {
        assert!(!path.exists(), "{name} is there before it is whole");
        sink.frame(k as u64, frame.clone()).unwrap();
    }
    let notes = sink.finish().unwrap();
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "{name} leaves a temporary");
    (fs::read(path).unwrap(), notes)
}

/// Frames as an image decoder gives them, and their delays in milliseconds.
fn decoded<'a>(decoder: impl AnimationDecoder<'a>) -> (Vec<Frame>, Vec<f64>) {
    let frames = decoder.into_frames().collect_frames().unwrap();
    let delay = |frame: &image::Frame| {
        let (num, den) = frame.delay().numer_denom_ms();
        f64::from(num) / f64::from(den)
    };
    let cells = |frame: &image::Frame| {
        let buffer = frame.buffer();
        let cells = buffer.pixels().map(|p| p.0).collect();
        Frame::from_cells(buffer.width() as usize, buffer.height() as usize, cells)
    };
    (frames.iter().map(cells).collect(), frames.iter().map(delay).collect())
}

fn same(name: &str, wanted: &[Frame], got: &[Frame]) {
    assert_eq!(got.len(), wanted.len(), "{name}: number of frames");
    for (k, (wanted, got)) in wanted.iter().zip(got).enumerate() {
        let differs = wanted.cells().iter().zip(got.cells()).position(|(wanted, got)| wanted != got);
        assert_eq!(differs, None, "{name}: frame {k}, by its first pixel");
    }
}

#[test]
fn apng_is_exact() {
    for (width, height) in [(31, 17), (2, 2), (1, 9)] {
        let wanted = frames(width, height, 7);
        let (bytes, _) = written("a.apng", &wanted, 29.97, false);
        let decoder = image::codecs::png::PngDecoder::new(Cursor::new(&bytes)).unwrap().apng().unwrap();
        same("apng", &wanted, &decoded(decoder).0);
        let reader = png::Decoder::new(Cursor::new(&bytes)).read_info().unwrap();
        assert!(reader.info().srgb.is_some() && reader.info().coding_independent_code_points.is_some());
        let (frame, animation) = (reader.info().frame_control.unwrap(), reader.info().animation_control.unwrap());
        assert_eq!((frame.delay_num, frame.delay_den), (100, 2997));
        assert_eq!((animation.num_frames, animation.num_plays), (7, 0));
    }
}

fn webp_profile(bytes: &[u8]) -> Option<Vec<u8>> {
    use image::ImageDecoder;
    image::codecs::webp::WebPDecoder::new(Cursor::new(bytes)).unwrap().icc_profile().unwrap()
}

#[test]
fn webp_is_exact() {
    for (width, height) in [(31, 17), (2, 2), (1, 9)] {
        let wanted = frames(width, height, 7);
        let (bytes, _) = written("a.webp", &wanted, 30.0, false);
        assert_eq!(bytes.len(), 8 + u32::from_le_bytes(bytes[4..8].try_into().unwrap()) as usize);
        let (got, delays) = decoded(image::codecs::webp::WebPDecoder::new(Cursor::new(&bytes)).unwrap());
        same("webp by image", &wanted, &got);
        assert_eq!(delays.iter().sum::<f64>(), 233.0);
        assert_eq!(webp_profile(&bytes), Some(crate::export::icc::srgb()));
        let frames = ::webp::AnimDecoder::new(&bytes).decode().unwrap();
        assert_eq!(frames.loop_count, 0);
        for (k, wanted) in wanted.iter().enumerate() {
            let frame = frames.get_frame(k).unwrap();
            assert!(frame.get_image() == wanted.cells().as_flattened(), "webp by libwebp: frame {k}");
        }
    }
}

#[test]
fn a_gif_of_few_colors_is_exact() {
    for (width, height) in [(13, 17), (2, 2), (1, 9)] {
        let wanted = frames(width, height, 7);
        let (bytes, notes) = written("a.gif", &wanted, 30.0, false);
        let (got, delays) = decoded(image::codecs::gif::GifDecoder::new(Cursor::new(&bytes)).unwrap());
        same("gif", &wanted, &got);
        assert_eq!(delays, [30.0, 40.0, 30.0, 30.0, 40.0, 30.0, 30.0]);
        assert!(notes.is_empty(), "{notes:?}");
    }
}

#[test]
fn a_gif_of_many_colors_is_near() {
    let photo = |k: usize| {
        let cell = |i: usize| {
            let (x, y) = (i % 160, i / 160);
            [(x + k) as u8, (y * 2) as u8, (255 - x) as u8, 255]
        };
        Frame::from_cells(160, 120, (0..160 * 120).map(cell).collect())
    };
    let wanted: Vec<_> = (0..4).map(photo).collect();
    let (bytes, _) = written("a.gif", &wanted, 25.0, true);
    let (got, _) = decoded(image::codecs::gif::GifDecoder::new(Cursor::new(&bytes)).unwrap());
    for (wanted, got) in wanted.iter().zip(&got) {
        let squares = wanted.cells().as_flattened().iter().zip(got.cells().as_flattened());
        let error: f64 =
            squares.map(|(&a, &b)| f64::from(u32::from(a.abs_diff(b)).pow(2))).sum::<f64>() / (160.0 * 120.0 * 4.0);
        let psnr = 10.0 * (255.0 * 255.0 / error).log10();
        assert!(psnr > 30.0, "{psnr} dB");
    }
}

#[test]
fn what_does_not_move_is_not_written_again() {
    let mut still = frames(64, 64, 1);
    still.push(still[0].clone());
    still[1].cells_mut()[64 * 5 + 9] = [1, 2, 3, 255];
    let (bytes, _) = written("a.gif", &still, 10.0, false);
    let mut reader = ::gif::DecodeOptions::new().read_info(Cursor::new(bytes)).unwrap();
    reader.read_next_frame().unwrap().unwrap();
    let frame = reader.read_next_frame().unwrap().unwrap();
    assert_eq!((frame.left, frame.top, frame.width, frame.height), (9, 5, 1, 1));
}

#[test]
fn loops() {
    let frames = frames(5, 5, 3);
    for (once, plays) in [(false, 0), (true, 1)] {
        let (bytes, _) = written("a.apng", &frames, 10.0, once);
        let reader = png::Decoder::new(Cursor::new(&bytes)).read_info().unwrap();
        assert_eq!(reader.info().animation_control.unwrap().num_plays, plays);
        let (bytes, _) = written("a.webp", &frames, 10.0, once);
        assert_eq!(::webp::AnimDecoder::new(&bytes).decode().unwrap().loop_count, plays);
        let (bytes, _) = written("a.gif", &frames, 10.0, once);
        let mut reader = ::gif::DecodeOptions::new().read_info(Cursor::new(bytes)).unwrap();
        while reader.read_next_frame().unwrap().is_some() {}
        let wanted = if once { ::gif::Repeat::Finite(0) } else { ::gif::Repeat::Infinite };
        assert_eq!(reader.repeat(), wanted);
    }
}

#[test]
fn one_frame_is_a_still() {
    let frames = frames(31, 17, 1);
    for name in ["a.png", "a.apng", "a.webp"] {
        let (bytes, _) = written(name, &frames, 30.0, false);
        let image = image::load_from_memory(&bytes).unwrap().to_rgba8();
        assert!(image.as_raw() == frames[0].cells().as_flattened(), "{name}");
        if name == "a.webp" {
            assert_eq!(webp_profile(&bytes), Some(crate::export::icc::srgb()));
        }
    }
}

#[test]
fn a_sequence_is_numbered_by_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let wanted = frames(31, 17, 9);
    let mut sink = begin(&folder.path().join("f-%03d.png"), show(&wanted, 30.0, false)).unwrap();
    for (k, frame) in wanted.iter().enumerate() {
        sink.frame(1 + 2 * k as u64, frame.clone()).unwrap();
    }
    sink.finish().unwrap();
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 9);
    for (k, wanted) in wanted.iter().enumerate() {
        let image = image::open(folder.path().join(format!("f-{:03}.png", 1 + 2 * k))).unwrap();
        assert!(image.to_rgba8().as_raw() == wanted.cells().as_flattened(), "{k}");
    }
}

#[test]
fn what_is_dropped_leaves_nothing() {
    let frames = frames(31, 17, 3);
    for name in ["a.apng", "a.webp", "a.gif", "a.y4m", "a.rgba"] {
        let folder = tempfile::tempdir().unwrap();
        let mut sink = begin(&folder.path().join(name), show(&frames, 30.0, false)).unwrap();
        sink.frame(0, frames[0].clone()).unwrap();
        drop(sink);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "{name}");
    }
}

#[test]
fn numbered_frames_stay_whatever_becomes_of_the_rest() {
    let frames = frames(31, 17, 5);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("%d.png");
    let mut sink = begin(&path, show(&frames, 30.0, false)).unwrap();
    for (k, frame) in frames.iter().enumerate() {
        sink.frame(k as u64, frame.clone()).unwrap();
    }
    drop(sink);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 5);
    let target = Target::file(&path, &[0, 1, 2, 3, 4, 5], &mut Guard::new(false)).unwrap();
    assert!((0..5).all(|k| target.has(k, (31, 17)) && !target.has(k, (31, 18))));
    assert!(!target.has(5, (31, 17)) && !target.has(6, (31, 17)));
    let half = fs::read(folder.path().join("3.png")).unwrap();
    fs::write(folder.path().join("3.png"), &half[..half.len() - 1]).unwrap();
    assert!(!target.has(3, (31, 17)));
}

/// A stream that a test can look at.
#[derive(Clone, Default)]
struct Shared(Arc<Mutex<Vec<u8>>>);

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn streamed(name: &str, frames: &[Frame]) -> (Vec<u8>, Vec<String>) {
    let out = Shared::default();
    let mut sink = Target::stream(name, Box::new(out.clone())).unwrap().begin(show(frames, 29.97, false)).unwrap();
    for frame in frames {
        sink.frame(0, frame.clone()).unwrap();
    }
    let notes = sink.finish().unwrap();
    let bytes = out.0.lock().unwrap().clone();
    (bytes, notes)
}

#[test]
fn rgba_is_the_bytes() {
    let wanted = frames(5, 3, 2);
    let all: Vec<u8> = wanted.iter().flat_map(|f| f.cells().as_flattened().to_vec()).collect();
    assert_eq!(streamed("rgba", &wanted).0, all);
}

#[test]
fn y4m_holds_every_frame_of_an_odd_size() {
    let (bytes, notes) = streamed("y4m", &frames(5, 3, 2));
    let header = bytes.split(|&b| b == b'\n').next().unwrap();
    assert!(header.starts_with(b"YUV4MPEG2 W5 H3 F2997:100 Ip A1:1 C444 "), "{}", String::from_utf8_lossy(header));
    let frames = &bytes[header.len() + 1..];
    assert_eq!(frames.len(), 2 * (6 + 3 * 15));
    assert!(frames.starts_with(b"FRAME\n") && frames[6 + 45..].starts_with(b"FRAME\n"));
    assert_eq!(notes.len(), 1, "transparency is mentioned");
}

#[test]
fn an_unknown_extension_lists_the_table() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.avi", "a", "a.png"] {
        let error = begin(&folder.path().join(name), show(&frames(2, 2, 2), 30.0, false)).err().unwrap();
        let all = FORMATS.iter().all(|f| error.to_string().contains(f.help));
        assert!(error.exit_status() == 2 && (all || name == "a.png"), "{error}");
    }
    assert!(Target::stream("gif", Box::new(io::sink())).is_err());
}

#[test]
fn the_table_is_complete() {
    let mut seen = std::collections::HashSet::new();
    for format in FORMATS {
        assert!(!format.help.is_empty() && !format.extensions.is_empty());
        assert!(format.extensions.iter().all(|e| seen.insert(*e) && e.to_lowercase() == **e), "{}", format.name);
    }
}

#[test]
fn the_documentation_has_the_table() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/outputs.md");
    let text = fs::read_to_string(&path).unwrap();
    let (before, rest) = text.split_once("<!-- table -->\n").unwrap();
    let (_, after) = rest.split_once("<!-- end -->").unwrap();
    let new = format!("{before}<!-- table -->\n{}<!-- end -->{after}", formats::markdown());
    if std::env::var_os("PLICA_UPDATE").is_some() {
        fs::write(&path, &new).unwrap();
    }
    assert!(
        fs::read_to_string(&path).unwrap() == new,
        "docs/outputs.md is old: run the tests once with PLICA_UPDATE=1"
    );
}
