//! The checks of the fuzz targets (`fuzz/checks.rs`), on their seeds and on a few changes of each. `scripts/fuzz
//! SECONDS` goes further.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::PathBuf;

use proptest::prelude::{Strategy, any};
use proptest::test_runner::{Config, TestRunner};

#[path = "../fuzz/checks.rs"]
mod checks;

/// A change of a seed: where (as a share of its length), how many bytes are removed, and what replaces them.
type Change = (f64, usize, Vec<u8>);

fn seeds(name: &str) -> Vec<Vec<u8>> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("fuzz/seeds").join(name);
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths.into_iter().map(|path| std::fs::read(path).unwrap()).collect()
}

fn changed(seed: &[u8], (place, gone, put): &Change) -> Vec<u8> {
    let at = (place * seed.len() as f64) as usize;
    let end = (at + gone).min(seed.len());
    [&seed[..at], put, &seed[end..]].concat()
}

#[test]
fn seeds_and_what_is_like_them_hold() {
    for (name, check) in checks::CHECKS {
        let seeds = seeds(name);
        assert!(!seeds.is_empty(), "{name}");
        seeds.iter().for_each(|seed| check(seed));
        let config = Config { cases: 150, failure_persistence: None, ..Config::default() };
        let bytes = proptest::collection::vec(any::<u8>(), 0..6);
        let change = (0.0..1.0f64, 0..8usize, bytes);
        let strategy = (0..seeds.len(), proptest::collection::vec(change, 1..3));
        let run = TestRunner::new_with_rng(
            config,
            proptest::test_runner::TestRng::deterministic_rng(proptest::test_runner::RngAlgorithm::ChaCha),
        )
        .run(
            &strategy.prop_map(|(seed, changes)| {
                changes.iter().fold(seeds[seed].clone(), |bytes, change| changed(&bytes, change))
            }),
            |bytes| {
                check(&bytes);
                Ok(())
            },
        );
        run.unwrap_or_else(|failure| panic!("{name}: {failure}"));
    }
}

#[test]
fn every_check_is_a_fuzz_target() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("fuzz");
    let names = |folder: PathBuf| {
        let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let mut names: Vec<String> =
            entries.map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned()).collect();
        names.sort();
        names
    };
    let mut checked: Vec<String> = checks::CHECKS.iter().map(|(name, _)| (*name).to_owned()).collect();
    checked.sort();
    assert_eq!(names(folder.join("fuzz_targets")), checked, "the files of fuzz_targets");
    assert_eq!(names(folder.join("seeds")), checked, "the folders of seeds");
    let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).unwrap();
    let bins = manifest.split("[[bin]]").skip(1);
    let field = |bin: &str, field: &str| {
        let value = bin.lines().find_map(|line| line.strip_prefix(field)?.strip_prefix(" = "));
        value.unwrap_or_default().trim_matches('"').to_owned()
    };
    let mut listed: Vec<(String, String)> = bins.map(|bin| (field(bin, "name"), field(bin, "path"))).collect();
    listed.sort();
    let expected = checked.iter().map(|name| (name.clone(), format!("fuzz_targets/{name}.rs")));
    assert_eq!(listed, expected.collect::<Vec<_>>(), "the programs of Cargo.toml");
}
