//! Keys that arrive in pieces over a slow line.

use std::time::{Duration, Instant};

use serde_json::json;

use crate::support::{Editor, folder, json as read, on_motion};

/// Sends bytes in two pieces that are `apart`; false if this machine was too busy for that.
fn send_in_pieces(editor: &mut Editor, bytes: &str, cut: usize, apart: Duration) -> bool {
    let begun = Instant::now();
    editor.press(&bytes[..cut]);
    std::thread::sleep(apart);
    editor.press(&bytes[cut..]);
    begun.elapsed() < Duration::from_millis(85)
}

#[test]
fn a_key_or_a_paste_in_pieces_is_no_command() {
    let folder = folder();
    let scene = folder.path().join("photo.plica.json");
    let mut editor = on_motion(folder.path());
    editor.press("\r\x1b[200~1,1,0,0\r2,2,0,0\r3,3,0,0\r4,4,0,0\r\x1b[201~");
    editor.wait_for("4 rows pasted");
    // Down and up, again and again, cut at every byte; the cursor ends where it began, on the first row.
    let mut tries = 0;
    for (down, up) in [("\x1b[B", "\x1b[A"), ("\x1bOB", "\x1bOA"), ("\x1b[<65;5;5M", "\x1b[<64;5;5M")] {
        for cut in 1..down.len() {
            for keys in [down, up] {
                while !send_in_pieces(&mut editor, keys, cut, Duration::from_millis(25)) {
                    tries += 1;
                    if tries > 20 {
                        eprintln!("this machine is too busy to send keys in pieces: skipped");
                        return;
                    }
                    // It may have arrived as several keys: start again from the first row.
                    std::thread::sleep(Duration::from_millis(300));
                    editor.press(":go layers.0.zones.all.motion\rgegg");
                }
            }
        }
    }
    editor.press("d");
    // A paste whose markers arrive in pieces, with pauses, is one paste, and its lines are not commands.
    for part in ["\x1b[200", "~9,9,0,0\r:q!\r", "dd\x1b[2", "01~"] {
        editor.press(part);
        std::thread::sleep(Duration::from_millis(30));
    }
    editor.wait_for("line 2");
    editor.press(":wq\r");
    assert_eq!(editor.end(), 0);
    let points: Vec<_> = read(&scene)["layers"][0]["zones"][0]["motion"]
        .as_array()
        .unwrap()
        .iter()
        .map(|tool| tool["at"].clone())
        .collect();
    assert_eq!(points, [json!([2, 2]), json!([3, 3]), json!([4, 4])]);
}
