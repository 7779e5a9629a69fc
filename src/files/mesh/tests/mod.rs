//! What is read from files with meshes, and what is said of those that are none.

use std::fs::File;
use std::io::{Seek, Write};
use std::path::PathBuf;

use super::*;

mod built;
mod gltf;
mod gltf_refused;
mod obj;
mod pictures;

/// Reads a file of this name; those beside it are in `siblings`.
fn read_with(
    name: &str,
    bytes: &[u8],
    siblings: &[(&str, &[u8])],
    limits: &Limits,
) -> std::result::Result<(Mesh, Vec<String>), String> {
    let sibling = |path: &str| match siblings.iter().find(|(name, _)| *name == path) {
        Some((_, bytes)) => Ok(file(bytes)),
        None => Err(Error::at(path, "there is no such file")),
    };
    let budget = limits.budget();
    let options = Options { limits: limits.clone(), ..Options::default() };
    let read = decode(file(bytes), name, &options, &budget, &sibling);
    let read = read.map(|(mesh, notes, share)| {
        assert_eq!(budget.taken(), mesh.bytes());
        drop(share);
        (mesh, notes)
    });
    assert_eq!(budget.taken(), 0);
    read.map_err(|error| error.to_string())
}

fn read(name: &str, bytes: &[u8]) -> std::result::Result<(Mesh, Vec<String>), String> {
    read_with(name, bytes, &[], &Limits::default())
}

fn file(bytes: &[u8]) -> File {
    let mut file = tempfile::tempfile().unwrap();
    file.write_all(bytes).unwrap();
    file.rewind().unwrap();
    file
}

#[test]
fn what_is_no_mesh_says_what_it_is() {
    const READ: &str = "(Plica reads Wavefront OBJ (.obj) and glTF 2.0 (.glb, .gltf))";
    const EXPORT: &str = "(export it as .glb or .obj, with Blender for example)";
    const RENAME: &str = "(rename it if it is to be shown as a picture; \
        Plica reads Wavefront OBJ (.obj) and glTF 2.0 (.glb, .gltf))";
    const COPY: &str = "(copy it again from where it came, or export it again)";
    for (name, bytes, expected) in [
        ("a.obj", &b"\x89PNG\r\n\x1a\n"[..], format!("is a PNG picture, not a mesh {RENAME}")),
        ("a.json", br#"{ "plica": 1 }"#, "is a Plica scene, not a mesh (plica edit opens it)".into()),
        ("a.glb", b"\xff\xd8\xff\xe0", format!("is a JPEG picture, not a mesh {RENAME}")),
        ("a.obj", b"\0\0\0\x20ftypavif\0\0\0\0", format!("is an AVIF picture, not a mesh {RENAME}")),
        ("a.obj", b"ply\nformat ascii 1.0\n", format!("is a PLY mesh, which Plica does not read {EXPORT}")),
        ("a.stl", b"\0\0\0\0", format!("is an STL mesh, which Plica does not read {EXPORT}")),
        ("a.fbx", b"Kaydara FBX Binary  \0", format!("is an FBX scene, which Plica does not read {EXPORT}")),
        ("a.obj", b"#usda 1.0\n", format!("is a USD scene, which Plica does not read {EXPORT}")),
        ("a.obj", b"\x4c\x01\0\0", format!("is not text: it holds NUL bytes {COPY}")),
        ("a.gltf", b"\0{}", format!("is not text: it holds NUL bytes {COPY}")),
        ("a.glb", b"\0\0\0\0", format!("is not a mesh {READ}")),
        ("a.obj", b"<!DOCTYPE html>", format!("is not a mesh {READ}")),
        ("a.txt", b"v", format!("is not a mesh {READ}")),
        ("a.glb", b"", format!("is empty {COPY}")),
        ("a.obj", b"", format!("is empty {COPY}")),
        ("a.obj", b"\n", "has no triangles (name a mesh with faces)".to_owned()),
    ] {
        assert_eq!(read(name, bytes).unwrap_err(), format!("{name}: {expected}"));
        // Its beginning is enough: what follows, here nothing that is stored, is neither read nor counted.
        if bytes.contains(&0) {
            let long = file(bytes);
            long.set_len(1 << 40).unwrap();
            let options = Options::default();
            let error = decode(long, name, &options, &options.limits.budget(), &alone).unwrap_err();
            assert_eq!(error.to_string(), format!("{name}: {expected}"));
        }
    }
    assert_eq!(read("a.txt", b"# a comment\r\n\n\tv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3").unwrap().0.triangles.len(), 1);
}

#[test]
fn limits_hold_before_memory_is_taken() {
    let text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\n";
    for (limits, expected) in [
        (
            Limits { triangles: 1, ..Limits::default() },
            "has 2 triangles, at most 1 are allowed (make it smaller, or give --limit triangles=2)",
        ),
        (
            Limits { mesh: 39, ..Limits::default() },
            "has 40 bytes, at most 39 are allowed (make it smaller, or give --limit mesh=40)",
        ),
        (
            Limits { memory: 39, ..Limits::default() },
            "needs 40 bytes of memory, and at most 39 bytes are allowed (make it smaller, or give --limit memory=1M)",
        ),
        (
            Limits { memory: 100, ..Limits::default() },
            "needs 204 bytes of memory besides 40 bytes in use, and at most 100 bytes are allowed \
             (make it smaller, or give --limit memory=1M)",
        ),
    ] {
        assert_eq!(read_with("a.obj", text, &[], &limits).unwrap_err(), format!("a.obj: {expected}"));
    }
}

#[test]
fn scans_and_models_are_read_whole() {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let Some(folder) = root.ancestors().map(|folder| folder.join("shared/data/meshes")).find(|f| f.is_dir()) else {
        println!("skipped: there is no shared/data/meshes above {}", root.display());
        return;
    };
    // Vertices, triangles, and whether they have texture coordinates.
    for (name, vertices, triangles, uv) in [
        ("hand", 7993, 15982, false),
        ("nefertiti_40k", 20002, 40000, false),
        ("pitcher", 6348, 12120, true),
        ("room", 23355, 44072, true),
        ("spot", 3225, 5856, true),
        ("teapot", 3644, 6320, false),
        ("vase", 5621, 10800, true),
    ] {
        let bytes = std::fs::read(folder.join(name).with_extension("obj")).unwrap();
        let limits = Limits { memory: 4 * bytes.len() as u64, ..Limits::default() };
        let (mesh, notes) = read_with("a.obj", &bytes, &[], &limits).unwrap();
        assert_eq!((mesh.vertices.len(), mesh.triangles.len()), (vertices, triangles), "{name}");
        assert_eq!(mesh.without_uv.is_none(), uv, "{name}");
        assert!(mesh.vertices.iter().all(|vertex| (vertex.normal.length() - 1.0).abs() < 1e-12), "{name}");
        assert_eq!(notes, [""; 0], "{name}");
    }
}
