//! How long a mesh takes to load. `cargo bench --bench meshes`

use std::fs::File;
use std::path::{Path, PathBuf};

use divan::Bencher;
use divan::counter::BytesCount;
use plica::base::error::Error;
use plica::files::{Options, mesh};

fn main() {
    divan::main();
}

/// A scan of 40,000 triangles, without normals: at most 40 ms. Skipped where the file is missing, as it is no part of
/// the project.
#[divan::bench(args = ["nefertiti_40k.obj"], sample_count = 50)]
fn load(bencher: Bencher, name: &str) {
    let Some(path) = shared(name) else {
        eprintln!("skipped: there is no shared/data/meshes/{name} above the project");
        return;
    };
    let bytes = path.metadata().map_or(0, |found| found.len());
    let options = Options::default();
    let alone = |path: &str| Err(Error::at(path, "is not there"));
    let budget = options.limits.budget();
    let load = || mesh::decode(File::open(&path).expect("it is there"), name, &options, &budget, &alone);
    bencher.counter(BytesCount::new(bytes)).bench(|| load().expect("it is a mesh"));
}

fn shared(name: &str) -> Option<PathBuf> {
    let above = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    above.map(|folder| folder.join("shared/data/meshes").join(name)).find(|path| path.is_file())
}
