//! Input from the terminal as events: keys by their names in the table, pastes, clicks. It is read and cut into sequences here
//! (pieces.rs), because crossterm's reader takes the first part of a sequence for all of it.

use std::io::stdin;
use std::sync::mpsc;
use std::time::{Duration, Instant};

use terminput::{Event as Input, KeyEventKind, MouseEventKind, ScrollDirection};

use crate::base::{fault, system};
use crate::tui::events::Event;
use crate::tui::keys;

mod pieces;
pub use pieces::{Piece, Pieces};

/// Reads the terminal until it is gone, starting with input that has arrived already.
pub fn read(mut pieces: Pieces, sender: mpsc::Sender<Event>) {
    /// The longest wait; some systems allow no longer one.
    const LONG: Duration = Duration::from_secs(3600);
    std::thread::spawn(move || {
        loop {
            while let Some(piece) = pieces.take(Instant::now()) {
                // The panic itself is reported; the keys that follow still work.
                let said = fault::caught(|| event(&piece)).unwrap_or(None);
                if said.is_some_and(|event| sender.send(event).is_err()) {
                    return;
                }
            }
            let patience = pieces.patience(Instant::now()).unwrap_or(LONG);
            if system::readable(stdin(), patience) && !feed(&mut pieces) {
                break;
            }
        }
        // The terminal is gone; the signal thread usually notices first.
        let _ = sender.send(Event::End);
    });
}

/// Reads the available input; false at its end.
pub fn feed(pieces: &mut Pieces) -> bool {
    let mut bytes = [0; 8192];
    match system::read(stdin(), &mut bytes) {
        Ok(n @ 1..) => {
            pieces.feed(&bytes[..n], Instant::now());
            true
        }
        _ => false,
    }
}

/// The event for a piece of input; `None` if it means nothing to the editor.
pub fn event(piece: &Piece) -> Option<Event> {
    match piece {
        Piece::Paste(text) => Some(Event::Paste(text.clone())),
        Piece::Answer(_) => None,
        Piece::Alt(bytes) => match event(&Piece::Key(bytes.clone()))? {
            Event::Key(name) => Some(Event::Key(alt(&name))),
            other => Some(other),
        },
        Piece::Key(bytes) => said(bytes),
    }
}

/// The name of a key with Alt held, with modifiers in the order of the table.
fn alt(name: &str) -> String {
    match name.strip_prefix("Ctrl-").filter(|key| !key.is_empty()) {
        Some(key) => format!("Ctrl-Alt-{key}"),
        None => format!("Alt-{name}"),
    }
}

fn said(bytes: &[u8]) -> Option<Event> {
    if let [0x1b, b'O', key @ b'j'..=b'y'] = bytes {
        const KEYPAD: &str = "*+,-./0123456789";
        return KEYPAD.chars().nth(usize::from(key - b'j')).map(|key| Event::Key(key.into()));
    }
    if bytes == b"\x1bOM" {
        return Some(Event::Key("Enter".into()));
    }
    // Columns and rows count from 1, so 0 is not a click.
    let clicked = bytes.starts_with(b"\x1b[") && matches!(bytes.last(), Some(b'M' | b'm')) && bytes.len() != 6;
    if clicked
        && bytes[2..bytes.len() - 1].split(|&byte| byte == b';').skip(1).any(|one| one.iter().all(|&b| b == b'0'))
    {
        return None;
    }
    // A report of the cursor's place looks like F3.
    if bytes.ends_with(b"R") && bytes.starts_with(b"\x1b[") && !bytes.starts_with(b"\x1b[1;") && bytes.len() > 3 {
        return None;
    }
    match Input::parse_from(bytes).ok()?? {
        Input::Key(key) if key.kind != KeyEventKind::Release => keys::name(key).map(Event::Key),
        Input::Mouse(mouse) => match mouse.kind {
            MouseEventKind::Scroll(ScrollDirection::Down) => Some(Event::Key("Down".into())),
            MouseEventKind::Scroll(ScrollDirection::Up) => Some(Event::Key("Up".into())),
            MouseEventKind::Down(_) => Some(Event::Click(mouse.column, mouse.row)),
            _ => None,
        },
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The events for bytes that arrive in these parts, with pauses in between.
    fn said_in_parts(parts: &[&[u8]], gap: Duration) -> Vec<String> {
        let mut now = Instant::now();
        let mut pieces = Pieces::new();
        let mut all = Vec::new();
        let mut take = |pieces: &mut Pieces, now| {
            while let Some(piece) = pieces.take(now) {
                all.extend(event(&piece).map(|event| match event {
                    Event::Key(name) => name,
                    Event::Paste(text) => format!("paste {text}"),
                    Event::Click(x, y) => format!("click {x} {y}"),
                    _ => "other".into(),
                }));
            }
        };
        for part in parts {
            pieces.feed(part, now);
            take(&mut pieces, now);
            now += gap;
            take(&mut pieces, now);
        }
        take(&mut pieces, now + Duration::from_secs(60));
        all
    }

    /// What terminals send, and its events.
    const SENT: &[(&[u8], &[&str])] = &[
        (b"\x1b[A", &["Up"]),
        (b"\x1b[B", &["Down"]),
        (b"\x1bOC", &["Right"]),
        (b"\x1b[D", &["Left"]),
        (b"\x1b[H", &["Home"]),
        (b"\x1b[4~", &["End"]),
        (b"\x1b[3~", &["Delete"]),
        (b"\x1b[5~", &["Ctrl-u"]),
        (b"\x1b[Z", &["Shift-Tab"]),
        (b"\x1b[1;5C", &["Ctrl-Right"]),
        (b"\x1b[1;3D", &["Alt-Left"]),
        (b"\x1bOP", &["F1"]),
        (b"\x1b[15~", &["F5"]),
        (b"\x1b[[A", &["F1"]),
        (b"\x1bOj", &["*"]),
        (b"\x1bOM", &["Enter"]),
        (b"\x1b[97;5u", &["Ctrl-a"]),
        (b"\x1b[97;2u", &["A"]),
        (b"\x1b[27u", &["Esc"]),
        (b"\x1b[13;1:1u", &["Enter"]),
        (b"\x1b[97;1:3u", &[]),
        (b"\x1b[<0;10;5M", &["click 9 4"]),
        (b"\x1b[<0;10;5m", &[]),
        (b"\x1b[<65;10;5M", &["Down"]),
        (b"\x1b[<0;0;0M", &[]),
        (b"\x1b[M !!", &["click 0 0"]),
        (b"\x1b[32;10;5M", &["click 9 4"]),
        (b"\x1b[I", &[]),
        (b"\x1b[O", &[]),
        (b"\x1b[?62;22c", &[]),
        (b"\x1b[0n", &[]),
        (b"\x1b[6;20;10t", &[]),
        (b"\x1b[12;40R", &[]),
        (b"\x1b]11;rgb:ffff/dddd/0000\x1b\\", &[]),
        (b"\x1b]11;rgb:ffff/dddd/0000\x07", &[]),
        (b"\x1bP>|xterm(390)\x1b\\", &[]),
        (b"\x1b_Gi=31;OK\x1b\\", &[]),
        (b"\x1b[200~dd:q!\r\x1b[A\x1b\xc3\xa4\x1b[201~", &["paste dd:q!\r\x1b[A\x1bä"]),
        (b"\x1b[200~\x1b[201~", &["paste "]),
        ("ä".as_bytes(), &["ä"]),
        ("目".as_bytes(), &["目"]),
        ("👁".as_bytes(), &["👁"]),
        (b"\x1bj", &["Alt-j"]),
        ("\x1bä".as_bytes(), &["Alt-ä"]),
        (b"\x1b\x7f", &["Alt-Backspace"]),
        (b"\x1b\x0c", &["Ctrl-Alt-l"]),
        (b"\x1b\x1b[B", &["Esc", "Down"]),
        (b"j", &["j"]),
        (b" ", &["Space"]),
        (b"\r", &["Enter"]),
        (b"\x08", &["Backspace"]),
    ];

    #[test]
    fn a_sequence_is_one_key_however_it_is_cut() {
        for (bytes, expected) in SENT {
            for gap in [0, 20, 80].map(Duration::from_millis) {
                for cut in 0..=bytes.len() {
                    let (a, b) = bytes.split_at(cut);
                    assert_eq!(
                        said_in_parts(&[a, b], gap),
                        *expected,
                        "{} cut at {cut}, {gap:?}",
                        bytes.escape_ascii()
                    );
                    let [a, b, c] = [&bytes[..cut / 2], &bytes[cut / 2..cut], &bytes[cut..]];
                    assert_eq!(said_in_parts(&[a, b, c], gap), *expected, "{} cut at {cut}", bytes.escape_ascii());
                }
                let single: Vec<&[u8]> = bytes.chunks(1).collect();
                assert_eq!(said_in_parts(&single, gap), *expected, "{} byte by byte", bytes.escape_ascii());
            }
        }
    }

    #[test]
    fn sequences_that_follow_one_another_stay_apart() {
        for (first, a) in SENT {
            for (second, b) in SENT {
                let all = [*first, b"x", *second, b"y"].concat();
                let expected: Vec<&str> = a.iter().chain(&["x"]).chain(*b).chain(&["y"]).copied().collect();
                assert_eq!(said_in_parts(&[&all], Duration::ZERO), expected, "{}", all.escape_ascii());
            }
        }
    }

    #[test]
    fn an_escape_is_a_key_once_nothing_follows_it() {
        let ms = Duration::from_millis;
        for (parts, gap, expected) in [
            (&[&b"\x1b"[..]][..], ms(0), &["Esc"][..]),
            (&[b"\x1b", b"j"], ms(130), &["Esc", "j"]),
            (&[b"\x1b", b"\x1b"], ms(10), &["Esc", "Esc"]),
            (&[b"\x1b["], ms(0), &["Alt-["]),
            (&[b"\x1bO"], ms(0), &["Alt-O"]),
            (&[b"\x1bP"], ms(0), &["Alt-P"]),
            (&[b"\x1bPj"], ms(0), &["Alt-P", "j"]),
            (&[b"\x1b[[j"], ms(0), &["Alt-[", "[", "j"]),
            // What is cut off means nothing, and what follows is as it is.
            (&[b"\x1b[1;", b"j"], ms(1500), &["j"]),
            (&[b"\x1b]11;rgb:ff", b"j"], ms(1500), &["j"]),
            (&[b"\xc3", b"j"], ms(1500), &["j"]),
            (&[b"\xff\xfej"], ms(0), &["j"]),
        ] {
            assert_eq!(said_in_parts(parts, gap), expected, "{parts:?}");
        }
        let mut pieces = Pieces::new();
        let now = Instant::now();
        pieces.feed(b"\x1b", now);
        let patience = pieces.patience(now).unwrap();
        assert!((ms(100)..ms(150)).contains(&patience), "{patience:?}");
    }

    #[test]
    fn a_paste_is_held_until_its_end() {
        let end: &[u8] = b"\x1b[201~";
        for cut in 0..=end.len() {
            let parts: [&[u8]; 4] = [b"\x1b[200~d", b"d:q!\r", &end[..cut], &end[cut..]];
            assert_eq!(said_in_parts(&parts, Duration::from_secs(5)), ["paste dd:q!\r"], "cut at {cut}");
        }
        // Its end is lost: Ctrl-c, alone and after a silence, ends it.
        let parts: [&[u8]; 4] = [b"\x1b[200~dd", b"x\x03", b"\x03", b"j"];
        assert_eq!(said_in_parts(&parts, Duration::from_secs(3)), ["j"]);
        assert_eq!(said_in_parts(&parts, Duration::from_millis(50)), [""; 0]);
    }
}
