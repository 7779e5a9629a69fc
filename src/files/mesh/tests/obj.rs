//! OBJ: each form of a line, and each message.

use glam::{DVec2, DVec3};

use super::*;

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const LISTS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvn 0 0 -2\n";

#[test]
fn every_form_of_a_face_is_read() {
    // The face, its texture coordinates, and whether its normals are those of the file, which look away.
    let u = |u: [f64; 3]| Some(u.map(|u| DVec2::new(u, 0.0)));
    for (face, uvs, own) in [
        ("f 1 2 3", None, false),
        ("f 1/1 2/2 3/2", u([0.0, 1.0, 1.0]), false),
        ("f 1//1 2//1 3//1", None, true),
        ("f 1/1/1 2/2/1 3/1/1", u([0.0, 1.0, 0.0]), true),
        ("f -3 -2 -1", None, false),
        ("f -3/-2/-1 -2/-1/-1 -1/-1/-1", u([0.0, 1.0, 1.0]), true),
        ("f 1/ 2/ 3/", None, false),
        ("f 1// 2// 3//", None, false),
        ("f 1//1 2//1 3", None, false),
    ] {
        let (mesh, notes) = read("a.obj", format!("{LISTS}{face}\n").as_bytes()).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2]], "{face}");
        assert_eq!(mesh.without_uv, if uvs.is_some() { None } else { Some(0) }, "{face}");
        let found: Vec<DVec2> = mesh.vertices.iter().map(|vertex| vertex.uv).collect();
        assert_eq!(found, uvs.unwrap_or([DVec2::ZERO; 3]), "{face}");
        let normal = if own { DVec3::NEG_Z } else { DVec3::Z };
        assert!(mesh.vertices.iter().all(|vertex| vertex.normal == normal), "{face}");
        assert_eq!(notes, [""; 0]);
    }
    let (mesh, _) = read("a.obj", format!("{LISTS}vn 3 0 4\nf 1//2 2//2 3//2").as_bytes()).unwrap();
    assert!(mesh.vertices.iter().all(|vertex| vertex.normal.abs_diff_eq(DVec3::new(0.6, 0.0, 0.8), 1e-15)));
}

#[test]
fn lines_are_read_as_people_and_programs_write_them() {
    let plain = read("a.obj", format!("{SQUARE}f 1 2 3 4\n").as_bytes()).unwrap();
    assert_eq!(plain.0.triangles, [[0, 1, 2], [0, 2, 3]]);
    for text in [
        format!("{SQUARE}f 1 2 3 4"),
        format!("\u{feff}{SQUARE}f 1 2 3 4\n"),
        format!("{SQUARE}f 1 2 3 4\n").replace('\n', "\r\n"),
        format!("{SQUARE}f 1 2 3 4\n").replace('\n', "\r"),
        format!("{SQUARE}f 1 2 3 4\n").replace(' ', "\t"),
        format!("{SQUARE}f 1 2 3 4\n").replace('\n', "  \n\n   "),
        format!("{SQUARE}f 1 2 \\\n3 \\\r\n 4\n"),
        format!("{SQUARE}f 1 2\\\n 3 4 # a square\n"),
        format!("# from C:\\models\\\n{SQUARE}# f 4 3 2\nf 1 2 3 4 # five 5\n"),
        format!("o a b\ng\ns off\nmtllib a.mtl\nusemtl \u{e9}\nfoo nan\n{SQUARE}vp 0.5\nf 1 2 3 4\n"),
        format!("f 1 2 3 4\n{SQUARE}"),
        format!("{SQUARE}f -4 -3 -2 -1\nv 5 5 5\nv 6 6 6\n"),
        "v 0 0 0 1.0\nv 1e0 .0 +0 0.1 0.2 0.3\nv 1. 1 -0 nan\nv 0 10E-1 0\nf 1 2 3 4\n".to_owned(),
    ] {
        assert_eq!(read("a.obj", text.as_bytes()).as_ref(), Ok(&plain), "{text}");
    }
    let (mesh, notes) = read("a.obj", format!("{SQUARE}l 1 2\nf 1 2 3\nf 1 1 2\nf 2 2 2\n").as_bytes()).unwrap();
    assert_eq!(mesh.degenerate, 2);
    assert_eq!(notes, ["its points and lines are not drawn", "2 of 3 triangles have no area and are never seen"]);
    let (mesh, _) = read("a.obj", format!("{SQUARE}vt 0.25\nvt 1 0.5 0\nf 1/1 2/2 3/2").as_bytes()).unwrap();
    assert_eq!([mesh.vertices[0].uv, mesh.vertices[1].uv], [DVec2::new(0.25, 0.0), DVec2::new(1.0, 0.5)]);
}

#[test]
fn what_is_wrong_is_told_with_its_line() {
    for (text, expected) in [
        ("f 1 1 1\nv 0 0 x\n", "line 2: \"x\" is not a number"),
        ("f 1 1 1\nv 0 0 1,5\n", "line 2: \"1,5\" is not a number"),
        ("f 1 1 1\n\n\nv 0 NaN 0\n", "line 4: \"NaN\" is not a finite number"),
        ("f 1 1 1\r\nvt inf\r\n", "line 2: \"inf\" is not a finite number"),
        ("f 1 1 \\\n1\nvn 0 \\\n0 1e999\n", "line 3: \"1e999\" is not a finite number"),
        ("f 1 1 1\nv 0 \\\n 0\nvn 0\n", "line 2: a vertex has at least 3 numbers, here are 2"),
        ("f 1 1 1\nvn 0\n", "line 2: a normal has at least 3 numbers, here is 1"),
        ("f 1 1 1\nvt\n", "line 2: a texture coordinate has at least 1 number, here are 0"),
        ("f 1 2\n", "line 1: a face has at least 3 corners, here are 2"),
        ("f\n", "line 1: a face has at least 3 corners, here are 0"),
        ("v 0 0 0\nf 1 0 1\n", "line 2: there is no vertex 0: they are counted from 1"),
        ("v 0 0 0\nf 1 1 2\n", "line 2: there is no vertex 2: there is 1"),
        ("v 0 0 0\nf 1 -2 1\nv 0 0 0\n", "line 2: there is no vertex -2: there is 1 before this line"),
        ("v 0 0 0\nf 1/1 1/1 1/1\n", "line 2: there is no texture coordinate 1: there are 0"),
        ("v 0 0 0\nvn 1 1 1\nf 1//1 1//1 1//-2\n", "line 3: there is no normal -2: there is 1 before this line"),
        ("v 0 0 0\nf 1 1 1.5\n", "line 2: \"1.5\" is not a whole number"),
        ("v 0 0 0\nf 1 1 -\n", "line 2: \"-\" is not a whole number"),
        ("v 0 0 0\nf 1 1 99999999999999999999\n", "line 2: \"99999999999999999999\" is out of range: there is 1"),
        ("v 0 0 0\nf 1 1 1/1/1/1\n", "line 2: \"1/1/1/1\" is not a corner: write it as 1, 1/2, 1//3 or 1/2/3"),
        ("v 0 0 0\nf 1 1 /1\n", "line 2: \"/1\" is not a corner: write it as 1, 1/2, 1//3 or 1/2/3"),
        ("v 0 0 0\nf 1 1 -99999999999999999999\n", "line 2: \"-99999999999999999999\" is out of range: there is 1"),
        ("v 0 0 0\n", "has no triangles (it has vertices alone: export it with its faces)"),
        ("o nothing\n", "has no triangles (name a mesh with faces)"),
        (
            "hello world\nv 0 0 0\nl 1 1\n",
            "has no triangles (its points and lines are not drawn: export it with its faces)",
        ),
        ("hello world\n", "has no triangles (it may not be an OBJ: name a mesh with faces)"),
        (
            "f 1 1 1\nv 0 0 0\n\0\0",
            "is not text: it holds NUL bytes (copy it again from where it came, or export it again)",
        ),
        (
            "v 0 0 0\nf 1 1",
            "line 2: a face has at least 3 corners, here are 2 \
             (the file seems to be cut short: copy it again from where it came)",
        ),
    ] {
        // Each has a cure; most have the same.
        let cure = if expected.ends_with(')') { "" } else { " (mend the line, or export the mesh anew)" };
        assert_eq!(read("a.obj", text.as_bytes()).unwrap_err(), format!("a.obj: {expected}{cure}"), "{text}");
    }
    let long = format!("v 0 0 0\nf 1 1 {}\n", "a".repeat(1000));
    assert!(read("a.obj", long.as_bytes()).unwrap_err().len() < 200);
}
