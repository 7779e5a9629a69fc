//! OpenEXR: channels and layers by their names.

use ::exr::prelude::*;

use super::super::vectors;
use super::*;

/// An OpenEXR of one pixel whose channels are 0.5, 1.5, 2.5, …, in the order of their names.
fn write(path: &Path, names: &[&str]) {
    let channel = |(i, name): (usize, &&str)| AnyChannel::new(*name, FlatSamples::F32(vec![i as f32 + 0.5]));
    let channels = AnyChannels::sort(names.iter().enumerate().map(channel).collect());
    Image::from_channels((1, 1), channels).write().to_file(path).unwrap();
}

fn texel(folder: &Path, part: &str) -> std::result::Result<Rgba, String> {
    let place = format!("{}{part}", folder.join("a.exr").display());
    let file = File::open(folder.join("a.exr")).unwrap();
    let limits = Limits::default();
    let found = decode(file, &place, &limits, &limits.budget());
    found.map(|(found, _)| found.picture.texel(0, 0)).map_err(|error| error.to_string())
}

#[test]
fn channels_are_found_by_their_names() {
    let folder = folder();
    let cases: [(&[&str], &str, Rgba); 11] = [
        (&["R", "G", "B"], "", [0.5, 1.5, 2.5, 1.0]),
        (&["R", "G", "B", "A"], "", [0.5, 1.5, 2.5, 1.0]),
        (&["B", "G", "R", "beauty.R", "beauty.G", "beauty.B"], "", [2.5, 1.5, 0.5, 1.0]),
        (&["B", "G", "R", "beauty.R", "beauty.G", "beauty.B"], "#beauty", [3.5, 4.5, 5.5, 1.0]),
        (&["beauty.R", "beauty.G", "beauty.B"], "", [0.5, 1.5, 2.5, 1.0]),
        (&["Y"], "", [0.5, 0.5, 0.5, 1.0]),
        (&["Z"], "", [0.5, 0.5, 0.5, 1.0]),
        (&["R", "G"], "", [0.5, 1.5, 0.0, 1.0]),
        (&["u", "v"], "", [0.5, 1.5, 0.0, 1.0]),
        (&["R", "G", "B", "Z"], "#Z", [3.5, 3.5, 3.5, 1.0]),
        (&["R", "G", "B", "left.deep.Y"], "#left.deep", [3.5, 3.5, 3.5, 1.0]),
    ];
    for (names, part, expected) in cases {
        write(&folder.path().join("a.exr"), names);
        assert_eq!(texel(folder.path(), part), Ok(expected), "{names:?} {part}");
    }
    write(&folder.path().join("a.exr"), &["one.R", "one.G", "one.B", "two.R", "two.G", "two.B"]);
    for (part, said) in [("", "a.exr#one"), ("#three", "it has one, two")] {
        let error = texel(folder.path(), part).unwrap_err();
        assert!(error.contains(said), "{error}");
    }
}

#[test]
fn vectors_are_two_channels() {
    let folder = folder();
    let path = folder.path().join("a.exr");
    for (names, part) in [
        (&["R", "G"][..], ""),
        (&["R", "G", "B"], ""),
        (&["u", "v"], ""),
        (&["forward.u", "forward.v"], ""),
        (&["forward.u", "forward.v", "backward.u", "backward.v"], ""),
        (&["forward.u", "forward.v", "backward.u", "backward.v"], "#forward"),
    ] {
        write(&path, names);
        let place = format!("a.exr{part}");
        let found = vectors(File::open(&path).unwrap(), &place, &Limits::default(), |_| Ok(())).unwrap();
        assert_eq!(found, ((1, 1), vec![[0.5, 1.5]]), "{names:?} {part}");
    }
    write(&path, &["Z"]);
    let error = vectors(File::open(&path).unwrap(), "a.exr", &Limits::default(), |_| Ok(())).unwrap_err();
    assert!(error.to_string().contains("the channels Z"), "{error}");
}

#[test]
fn one_that_is_cut_short_is_called_so() {
    let folder = folder();
    let path = folder.path().join("a.exr");
    write(&path, &["R", "G", "B"]);
    let whole = std::fs::read(&path).unwrap();
    for cut in [30, whole.len() / 2, whole.len() - 5] {
        std::fs::write(&path, &whole[..cut]).unwrap();
        let error = refusal(&path, &Limits::default());
        assert!(error.contains("is cut short (copy it again"), "cut at {cut}: {error}");
    }
}
