//! The same camera from every kind of list, and what is refused.

use std::fs;

use glam::{DMat3, DQuat, DVec3};
use serde_json::json;
use tempfile::{TempDir, tempdir};

use super::*;
use crate::files::Limits;
use crate::layers::parts::shots::Shot;

/// The camera that every list here holds: at (1, 2, 3), turned a little.
fn camera() -> Shot {
    let turn = DMat3::from_rotation_x(2.9) * DMat3::from_rotation_y(0.4);
    let shift = -(turn * DVec3::new(1.0, 2.0, 3.0));
    Shot { turn, shift, focal_px: [50.0, 52.0], center_px: Some([20.5, 10.0]), size_px: Some([40, 20]) }
}

fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

fn read_in(folder: &TempDir, name: &str, all: bool) -> Result<Cameras> {
    read(&folder.path().join(name), &Reading { images: None, all, limits: &Limits::default() })
}

fn message(folder: &TempDir, name: &str) -> String {
    let error = read_in(folder, name, false).unwrap_err().to_string();
    error.replace(&folder.path().display().to_string(), "")
}

fn same(a: &Shot, b: &Shot) -> bool {
    let turned = (a.turn - b.turn).to_cols_array().iter().all(|off| off.abs() < 1e-12);
    turned
        && (a.shift - b.shift).length() < 1e-12
        && (a.focal_px, a.center_px, a.size_px) == (b.focal_px, b.center_px, b.size_px)
}

fn our_view() -> Value {
    let [a, b, c] = camera().rows();
    let row = |row: [f64; 4]| [row[0], row[1], row[2]];
    json!({ "file": "images/a.png", "width": 40, "height": 20, "fx": 50, "fy": 52, "cx": 20.5, "cy": 10, "R": [row(a), row(b), row(c)], "t": [a[3], b[3], c[3]] })
}

fn frame() -> Value {
    let to_world = camera().turn.transpose() * DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0));
    let [x, y, z] = [to_world.x_axis, to_world.y_axis, to_world.z_axis];
    let rows = [[x.x, y.x, z.x, 1.0], [x.y, y.y, z.y, 2.0], [x.z, y.z, z.z, 3.0], [0.0, 0.0, 0.0, 1.0]];
    json!({ "file_path": "images/a", "transform_matrix": rows })
}

fn transforms(change: impl Fn(&mut Value, &mut Value)) -> String {
    let mut list = json!({ "fl_x": 50, "fl_y": 52, "cx": 20.5, "cy": 10, "w": 40, "h": 20 });
    let mut frame = frame();
    change(&mut list, &mut frame);
    list["frames"] = json!([frame]);
    list.to_string()
}

fn colmap(camera_line: &str) -> TempDir {
    let DQuat { x, y, z, w } = DQuat::from_mat3(&camera().turn);
    let DVec3 { x: tx, y: ty, z: tz } = camera().shift;
    let images = format!(
        "# two lines a picture\n7 {} {} {} {} {tx} {ty} {tz} 3 a b.png\n1 2 -1 3 4 5\n8 1 0 0 0 0 0 1 3 b.png\n\n",
        2.0 * w,
        2.0 * x,
        2.0 * y,
        2.0 * z
    );
    folder(&[("sparse/images.txt", &images), ("sparse/cameras.txt", camera_line), ("images/x", "")])
}

#[test]
fn one_camera_is_the_same_from_every_list() {
    let ours = folder(&[("cameras.json", &json!({ "views": [our_view()] }).to_string())]);
    let found = read_in(&ours, "cameras.json", false).unwrap();
    assert!(same(&found.shots[0].1, &camera()), "{:?}", found.shots);
    assert_eq!(found.shots[0].0, ours.path().join("images/a.png"));

    for (line, count) in [("3 PINHOLE 40 20 50 52 20.5 10", 2), ("# a\n3 OPENCV 40 20 50 52 20.5 10 0 0 0 0\n", 2)] {
        let model = colmap(line);
        for name in ["sparse", "sparse/images.txt", "sparse/cameras.txt"] {
            let found = read_in(&model, name, false).unwrap();
            assert_eq!(found.shots.len(), count);
            assert!(same(&found.shots[0].1, &camera()), "{:?}", found.shots);
            assert_eq!(found.shots[0].0, model.path().join("images/a b.png"));
        }
    }

    let plain = folder(&[("transforms.json", &transforms(|_, _| ())), ("images/a.jpg", "")]);
    let found = read_in(&plain, "transforms.json", false).unwrap();
    assert!(same(&found.shots[0].1, &camera()), "{:?}", found.shots);
    assert_eq!(found.shots[0].0, plain.path().join("images/a.jpg"));
    // What a frame says itself counts; a scale is divided out and told.
    let own = transforms(|list, frame| {
        for row in frame["transform_matrix"].as_array_mut().unwrap().iter_mut().take(3) {
            for number in row.as_array_mut().unwrap().iter_mut().take(3) {
                *number = json!(number.as_f64().unwrap() * 2.0);
            }
        }
        list["fl_x"] = json!(1);
        list["fl_y"] = json!(1);
        frame["fl_x"] = json!(50);
        frame["fl_y"] = json!(52);
    });
    let found = read_in(&folder(&[("transforms.json", &own)]), "transforms.json", false).unwrap();
    assert!(same(&found.shots[0].1, &camera()), "{:?}", found.shots);
    assert_eq!(found.notes, ["the matrices have a scale of 2.0000, which is divided out"]);
}

#[test]
fn a_field_of_view_is_of_the_size_of_the_picture() {
    let text = transforms(|list, frame| {
        *list = json!({ "camera_angle_x": std::f64::consts::FRAC_PI_2 });
        frame["file_path"] = json!("a.png");
    });
    let found = folder(&[("transforms.json", &text)]);
    image::RgbImage::new(6, 4).save(found.path().join("a.png")).unwrap();
    let shot = read_in(&found, "transforms.json", false).unwrap().shots[0].1;
    assert_eq!((shot.center_px, shot.size_px), (None, Some([6, 4])));
    assert!(shot.focal_px.iter().all(|focal| (focal - 3.0).abs() < 1e-12), "{:?}", shot.focal_px);
}

#[test]
fn numbers_that_a_list_leaves_out_come_from_the_picture() {
    let folder = folder(&[]);
    image::RgbImage::new(6, 4).save(folder.path().join("a.png")).unwrap();
    let shot = |list: Value, own: Value| {
        let text = transforms(|whole, frame| {
            *whole = list.clone();
            frame["file_path"] = json!("a.png");
            frame.as_object_mut().unwrap().extend(own.as_object().unwrap().clone());
        });
        fs::write(folder.path().join("t.json"), text).unwrap();
        let Shot { focal_px, center_px, size_px, .. } = read_in(&folder, "t.json", false).unwrap().shots[0].1;
        (focal_px, center_px, size_px.unwrap())
    };
    for (list, own, expected) in [
        (json!({ "fl_x": 9, "cx": 2 }), json!({}), ([9.0, 9.0], Some([2.0, 2.0]), [6, 4])),
        (json!({ "fl_x": 9, "cy": 1 }), json!({}), ([9.0, 9.0], Some([3.0, 1.0]), [6, 4])),
        (json!({ "fl_x": 9, "w": 12 }), json!({}), ([9.0, 9.0], None, [12, 4])),
        (json!({ "fl_x": 9, "h": 8, "cx": 2 }), json!({}), ([9.0, 9.0], Some([2.0, 4.0]), [6, 8])),
        // A frame's own numbers win, each in the place of the list's.
        (json!({ "fl_x": 9, "fl_y": 8 }), json!({ "fl_y": 7 }), ([9.0, 7.0], None, [6, 4])),
        (json!({ "fl_x": 9, "fl_y": 8 }), json!({ "fl_x": 7 }), ([7.0, 7.0], None, [6, 4])),
        (json!({ "fl_y": 8, "cx": 1, "cy": 1 }), json!({ "cx": 5 }), ([8.0, 8.0], Some([5.0, 1.0]), [6, 4])),
    ] {
        assert_eq!(shot(list.clone(), own.clone()), expected, "{list} {own}");
    }
}

#[test]
fn pictures_for_testing_are_left_out() {
    let mut test = our_view();
    test["split"] = json!("test");
    let list = folder(&[("cameras.json", &json!({ "mesh": "m.obj", "views": [our_view(), test] }).to_string())]);
    let found = read_in(&list, "cameras.json", false).unwrap();
    assert_eq!(found.shots.len(), 1);
    assert_eq!(
        found.notes,
        ["1 pictures for testing are left out; --all takes them", "its mesh \"m.obj\" is not there"]
    );
    assert_eq!(read_in(&list, "cameras.json", true).unwrap().shots.len(), 2);
}

#[test]
fn what_is_refused_names_its_place_and_the_cure() {
    let without = |name: &str| {
        let mut view = our_view();
        view.as_object_mut().unwrap().remove(name);
        folder(&[("a.json", &json!({ "views": [view] }).to_string())])
    };
    for name in ["width", "fy", "R", "t"] {
        let expected = format!("/a.json: views 0 (images/a.png): {name} is missing");
        assert_eq!(message(&without(name), "a.json"), expected);
    }
    assert_eq!(message(&without("file"), "a.json"), "/a.json: views 0: file is missing");

    let undistort = "undistort first: colmap image_undistorter";
    for (line, expected) in [
        ("3 OPENCV 40 20 50 52 20 10 0.1 0 0 0", undistort),
        ("3 FISHEYE 40 20 50 20 10 0", undistort),
        ("3 PINHOLE 40 20 50 52 20", "line 1: PINHOLE has 4 parameters, here are 3"),
        (
            "4 PINHOLE 40 20 50 52 20 10",
            "line 2: its camera \"3\" is not in cameras.txt (take both files from one model)",
        ),
    ] {
        let found = message(&colmap(line), "sparse");
        assert!(found.contains(expected), "{line}: {found}");
    }
    for (line, expected) in [("7 1 nan", "line 1: QX is no number: \"nan\""), ("7 1 0 0 0 0", "TY is no number: \"\"")]
    {
        let model = folder(&[("images.txt", line), ("cameras.txt", "")]);
        assert!(message(&model, "").contains(expected), "{}", message(&model, ""));
    }
    let binary = folder(&[("images.bin", "")]);
    for name in ["", "images.bin"] {
        assert!(message(&binary, name).contains("colmap model_converter --output_type TXT"), "{name}");
    }
    for (file, told) in [("0/images.bin", "sparse/0: is a binary model"), ("images.txt", "has no images.txt (name ")] {
        let project = folder(&[(&format!("sparse/{file}"), "")]);
        assert!(message(&project, "").contains(told), "{}", message(&project, ""));
    }
}

#[test]
fn transforms_that_are_no_pinholes_or_no_rotations_are_refused() {
    for (change, expected) in [
        (json!({ "k1": 0.1 }), "k1 is not 0: the camera has distortion"),
        (json!({ "is_fisheye": true }), "the list: is_fisheye: a fisheye is no pinhole"),
        (json!({ "camera_model": "OPENCV_FISHEYE" }), "camera_model: a fisheye is no pinhole"),
        (json!({ "fl_x": null, "camera_angle_x": 4 }), "camera_angle_x is not between 0 and pi radians: 4"),
        (json!({ "camera_model": "ORTHOGRAPHIC" }), "an orthographic camera is no pinhole"),
        (json!({ "camera_model": "EQUIRECTANGULAR" }), "camera_model: a panorama is no pinhole"),
        (json!({ "k6": 0.1 }), "k6 is not 0: the camera has distortion"),
        (json!({ "fl_x": -1 }), "a focal length is not above 0"),
    ] {
        let text = transforms(|list, _| list.as_object_mut().unwrap().extend(change.as_object().unwrap().clone()));
        let found = message(&folder(&[("a.json", &text)]), "a.json");
        assert!(found.contains(expected), "{found}");
    }
    for (row, column, expected) in [(0, 0, "is no rotation"), (3, 3, "the last row of transform_matrix is not 0 0 0 1")]
    {
        let stretched = transforms(|_, frame| frame["transform_matrix"][row][column] = json!(5));
        let found = message(&folder(&[("a.json", &stretched)]), "a.json");
        assert!(found.contains(expected), "{found}");
    }
}

#[test]
fn other_lists_are_told_as_ones_that_are_not_known() {
    for text in ["{}", "a,b\n", "[1]"] {
        assert!(
            message(&folder(&[("a.txt", text)]), "a.txt").contains("is no list of cameras that is known"),
            "{text}"
        );
    }
}
