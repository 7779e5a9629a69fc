//! Clips: which frames are read, what is kept, and what is wrong with the rest.

use std::path::PathBuf;

use serde_json::json;

use super::*;
use crate::files::Limits;

/// A folder with the scene's path, and the scene of one clip.
fn start(clip: serde_json::Value) -> (tempfile::TempDir, PathBuf, Scene) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("falls")).unwrap();
    let path = folder.path().join("scene.plica.json");
    let scene = json!({ "plica": 1, "clips": { "falls": clip } });
    (folder, path, serde_json::from_value(scene).unwrap())
}

/// Frame `number`, one pixel high; its width tells it apart where frames are not to be of one size.
fn frame(folder: &Path, number: u32, width: u32) {
    paint(folder, &format!("falls/{number:04}.png"), width);
}

/// Loads, and tells how many frames there are and what is wrong.
fn look(path: &Path, scene: &Scene, options: &Options, cache: &mut Cache) -> (Option<Arc<Clip>>, Vec<String>) {
    let (materials, problems) = gather(path, scene, options, cache);
    assert!(problems.iter().all(|problem| problem.path == "/clips/falls/path"), "{problems:?}");
    let told =
        problems.into_iter().map(|problem| format!("{} ({})", problem.message, problem.hint.unwrap_or_default()));
    (materials.clips.get("falls").cloned(), told.collect())
}

#[test]
fn frames_follow_one_another_from_the_first() {
    // Frames 2, 3, 4, 6 are there; whether it is told that later ones are.
    for (clip, count, fps, gap) in [
        (json!({ "path": "falls/%04d.png", "first": 2 }), 3, 25.0, true),
        (json!({ "path": "falls/%04d.png", "first": 3, "fps": 12.5 }), 2, 12.5, true),
        (json!({ "path": "falls/%04d.png", "first": 2, "count": 2 }), 2, 25.0, false),
        (json!({ "path": "falls/000%d.png", "first": 6 }), 1, 25.0, false),
    ] {
        let (folder, path, scene) = start(clip.clone());
        [2, 3, 4, 6].into_iter().for_each(|number| frame(folder.path(), number, 2));
        let mut cache = Cache::default();
        let (materials, problems) = load(&path, &scene, &Options::default(), &mut cache).unwrap();
        let found = materials.clip("falls", "").unwrap();
        assert_eq!((found.frames.len(), found.fps, found.size_px()), (count, fps, (2, 1)), "{clip}");
        let told: Vec<String> = problems.iter().map(ToString::to_string).collect();
        let expected = format!(
            "clips.falls.path: warning: ends at falls/0004.png, but falls/0006.png is there (put falls/0005.png there, or \
             set the clip's count to {count})"
        );
        assert_eq!(told, if gap { vec![expected] } else { vec![] }, "{clip}");
        assert_eq!(materials.budget.taken(), count as u64 * found.frames[0].bytes());
        assert_eq!(paths(&path, &scene).len(), count);
        let watched = Watched::default().files(&path, &scene, &Options::default()).len();
        assert_eq!(watched, count + usize::from(clip.get("count").is_none()), "one more would make it longer: {clip}");
        assert_eq!(sizes(&path, &scene, &Options::default()).1, []);
    }
}

#[test]
fn only_frames_that_change_are_read_again() {
    let (folder, path, scene) = start(json!({ "path": "falls/%04d.png" }));
    (0..3).for_each(|number| frame(folder.path(), number, 2));
    let (options, mut cache) = (Options::default(), Cache::default());
    let mut again = || {
        let (clip, problems) = look(&path, &scene, &options, &mut cache);
        (clip.unwrap(), problems)
    };
    let (first, _) = again();
    assert!(Arc::ptr_eq(&first, &again().0), "nothing has changed");
    frame(folder.path(), 1, 2);
    let (second, _) = again();
    let same: Vec<bool> = second.frames.iter().zip(&first.frames).map(|(a, b)| Arc::ptr_eq(a, b)).collect();
    assert_eq!(same, [true, false, true]);
    frame(folder.path(), 3, 2);
    let (third, _) = again();
    assert_eq!(third.frames.len(), 4);
    // What cannot be read leaves the last good clip; once it can, the others are not read again.
    std::fs::write(folder.path().join("falls/0003.png"), "half a pict").unwrap();
    for _ in 0..2 {
        let (kept, problems) = again();
        assert!(Arc::ptr_eq(&kept, &third) && problems.len() == 1, "{problems:?}");
    }
    std::fs::remove_file(folder.path().join("falls/0003.png")).unwrap();
    let (fourth, problems) = again();
    assert!(fourth.frames.iter().zip(&second.frames).all(|(a, b)| Arc::ptr_eq(a, b)), "shorter again");
    assert_eq!((fourth.frames.len(), problems.len()), (3, 0));
}

#[test]
fn what_is_wrong_names_the_frame_and_the_cure() {
    // Widths of the frames from 0 on, `None` if there is no frame; the clip besides its path; a limit; what is said.
    let none = json!({});
    for (widths, more, limit, said) in [
        (vec![], none.clone(), None, "falls/0000.png: there is no such file (put it there"),
        (
            vec![0, 2, 2],
            json!({ "first": 7 }),
            None,
            "falls/0007.png: there is no such file (numbers 0 to 2 are there: set the clip's first to 0)",
        ),
        (
            vec![2],
            json!({ "first": 7 }),
            None,
            "falls/0007.png: there is no such file (number 0 is there: set the clip's first to 0)",
        ),
        (
            vec![2, 2],
            json!({ "count": 3 }),
            None,
            "falls/0002.png: there is no such file (lower the clip's count to 2, or put the frame there)",
        ),
        (vec![2, 2, 3], none.clone(), None, "falls/0002.png: is 3 x 1, and the clip's first frame 2 x 1 (make all"),
        (vec![2, 0, 2], none.clone(), None, "falls/0001.png: "),
        (vec![2, 2], json!({ "path": "falls" }), None, "falls: is a folder, not a file (write falls/%04d.png)"),
        (vec![2], json!({ "path": "falls/" }), None, "falls/: is a folder, not a file (write falls/%04d.png)"),
        (
            vec![2],
            json!({ "path": "falls/0000.png" }),
            None,
            "falls/0000.png: is a PNG picture, not a video (write falls/%04d.png)",
        ),
        (vec![2, 2, 2], none.clone(), Some("frames=2"), "falls/%04d.png: it has 3 frames, at most 2"),
        (vec![2, 2, 2], none.clone(), Some("clip=5"), "falls/%04d.png: its frames have 6 pixels together, at most 5"),
        (vec![2, 2, 2], none, Some("pixels=1"), "falls/0000.png: "),
        (vec![900, 900], json!({}), Some("memory=1500"), "falls/%04d.png: needs 900 bytes of memory besides"),
    ] {
        let mut clip = json!({ "path": "falls/%04d.png" });
        clip.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        let (folder, path, scene) = start(clip);
        for (number, width) in (0..).zip(widths) {
            match width {
                0 => std::fs::write(folder.path().join(format!("falls/{number:04}.png")), "no picture").unwrap(),
                width => frame(folder.path(), number, width),
            }
        }
        let limits = Limits::from_settings(&limit.iter().map(ToString::to_string).collect::<Vec<_>>()).unwrap();
        let options = Options { limits, ..Options::default() };
        let (clip, problems) = look(&path, &scene, &options, &mut Cache::default());
        assert!(clip.is_none() && problems.len() == 1, "{said}: {problems:?}");
        assert!(problems[0].starts_with(said), "{said}: {problems:?}");
    }
}

#[test]
fn a_link_that_leads_out_is_refused() {
    let (folder, path, scene) = start(json!({ "path": "falls/%04d.png" }));
    let outside = tempfile::tempdir().unwrap();
    paint(outside.path(), "out.png", 2);
    std::os::unix::fs::symlink(outside.path().join("out.png"), folder.path().join("falls/0000.png")).unwrap();
    let (clip, problems) = look(&path, &scene, &Options::default(), &mut Cache::default());
    assert!(clip.is_none() && problems[0].contains("--allow-outside"), "{problems:?}");
    let options = Options { allow_outside: true, ..Options::default() };
    assert!(look(&path, &scene, &options, &mut Cache::default()).0.is_some());
}

#[test]
fn loading_ends_when_it_is_cancelled() {
    let (folder, path, scene) = start(json!({ "path": "falls/%04d.png" }));
    (0..3).for_each(|number| frame(folder.path(), number, 2));
    let mut cache = Cache::until(Arc::new(true.into()));
    let (clip, problems) = look(&path, &scene, &Options::default(), &mut cache);
    assert!(clip.is_none() && problems == ["interrupted ()"], "{problems:?}");
}

#[test]
fn reading_tells_how_far_it_is() {
    let (folder, path, scene) = start(json!({ "path": "falls/%04d.png" }));
    (0..5).for_each(|number| frame(folder.path(), number, 2));
    let told = Arc::new(std::sync::Mutex::new(Vec::new()));
    let heard = told.clone();
    let progress = Progress::new(move |percent| heard.lock().unwrap().push(percent));
    let mut cache = Cache { progress: Some(Arc::new(progress)), ..Cache::default() };
    assert!(look(&path, &scene, &Options::default(), &mut cache).0.is_some());
    let mut told = told.lock().unwrap().clone();
    told.sort_unstable();
    assert_eq!(told.last(), Some(&100), "{told:?}");
    assert!(told.iter().all(|percent| [25, 50, 75, 100].contains(percent)), "{told:?}");
}

#[test]
fn copies_of_frames_make_a_clip_once_all_are_here() {
    let (folder, _, scene) = start(json!({ "path": "falls/%04d.png" }));
    (0..3).for_each(|number| frame(folder.path(), number, 2));
    let here =
        |number: u32| (format!("falls/{number:04}.png"), Ok(folder.path().join(format!("falls/{number:04}.png"))));
    let mut copies: Copies = (0..3).map(here).collect();
    copies.insert("falls/0001.png".into(), Err("is not here yet".into()));
    let look = |copies: &Copies| {
        let (materials, problems) = gather_copies(copies, &scene, &Options::default(), &mut Cache::default());
        let told: Vec<String> = problems.into_iter().map(|problem| problem.message).collect();
        (materials.clips.get("falls").map(|clip| clip.frames.len()), told)
    };
    assert_eq!(look(&copies), (None, vec!["falls/0001.png: is not here yet".to_owned()]));
    copies.extend([here(1)]);
    assert_eq!(look(&copies), (Some(3), vec![]));
}

#[test]
fn real_clips_are_read() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let Some(data) = root.ancestors().map(|folder| folder.join("shared/data/clips")).find(|folder| folder.is_dir())
    else {
        println!("skipped: there is no shared/data/clips above {}", root.display());
        return;
    };
    for folder in std::fs::read_dir(&data).unwrap().map(|entry| entry.unwrap().path()) {
        let count = std::fs::read_dir(&folder).unwrap().count();
        let name = folder.file_name().unwrap().to_str().unwrap();
        let clip = json!({ "path": format!("{name}/%04d.jpg") });
        let scene = serde_json::from_value(json!({ "plica": 1, "clips": { "falls": clip } })).unwrap();
        let (clip, problems) = look(&data.join("s.plica.json"), &scene, &Options::default(), &mut Cache::default());
        assert_eq!((clip.unwrap().frames.len(), problems), (count, vec![]), "{name}");
    }
}
