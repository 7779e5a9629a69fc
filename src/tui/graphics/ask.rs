//! What pictures the terminal takes: asked once, before anything else reads its answers. First what every terminal
//! answers and late answers do no harm to; only one that has answered is asked for kitty's protocol.

use std::io::{Read, Write, stdin, stdout};
use std::time::{Duration, Instant};

use ratatui::crossterm::terminal;

use super::{Graphics, Protocol};
use crate::base::system;

/// How long a terminal has to answer at all; further away it has longer.
const HERE: Duration = Duration::from_millis(400);
const FAR: Duration = Duration::from_millis(1500);
/// What kind of terminal it is, the size of a cell, and a report that all give and that therefore ends the answers.
const KIND: &str = "\x1b[c\x1b[16t\x1b[5n";
/// Whether it takes a picture of one pixel, without keeping it.
const KITTY: &str = "\x1b_Gi=31,s=1,v=1,a=q,t=d,f=24;AAAA\x1b\\\x1b[5n";
/// Terminals with iTerm2's images, by what they call themselves.
const ITERM2: [&str; 4] = ["iTerm", "WezTerm", "mintty", "rio"];

/// What the terminal takes, and the keys that were typed meanwhile.
pub fn ask(forced: Option<Protocol>, get: impl Fn(&str) -> Option<String>) -> (Graphics, Vec<String>) {
    let get = |name: &str| get(name).filter(|value| !value.is_empty());
    let term = get("TERM").unwrap_or_default();
    let between =
        get("TMUX").is_some() || get("STY").is_some() || term.starts_with("tmux") || term.starts_with("screen");
    let quiet = term == "dumb" || term.is_empty() || get("NO_COLOR").is_some() || between;
    let wants_pixels = forced.map_or(!quiet, |protocol| protocol != Protocol::Blocks);
    let mut graphics = Graphics { forced, tmux: get("TMUX").is_some(), ..Graphics::default() };
    let measured = cell();
    graphics.cell = measured.unwrap_or(graphics.cell);
    if !wants_pixels || between {
        return (graphics, Vec::new());
    }
    let patience = if system::over_ssh() { FAR } else { HERE };
    let mut answers = answers(KIND, patience);
    if answers.complete && forced.is_none() && !takes_half_of_kitty(get) {
        let more = self::answers(KITTY, FAR);
        answers.sequences.extend(more.sequences);
        answers.typed.extend(more.typed);
    }
    graphics.cell = measured.or(answers.cell()).unwrap_or(graphics.cell);
    let named = ["TERM_PROGRAM", "LC_TERMINAL"].iter().filter_map(|name| get(name)).collect::<Vec<_>>();
    let iterm2 = named.iter().any(|name| ITERM2.iter().any(|known| name.contains(known)));
    graphics.found = match () {
        () if answers.has("_Gi=31;OK") => Protocol::Kitty,
        () if iterm2 => Protocol::Iterm2,
        () if answers.sixel() => Protocol::Sixel,
        () => Protocol::Blocks,
    };
    (graphics, String::from_utf8_lossy(&answers.typed).chars().map(key).collect())
}

/// The name of a key in the table, by the character that the terminal sends.
fn key(c: char) -> String {
    match c {
        '\r' => "Enter".into(),
        '\t' => "Tab".into(),
        '\x1b' => "Esc".into(),
        '\x7f' => "Backspace".into(),
        ' ' => "Space".into(),
        '\x01'..='\x1a' => format!("Ctrl-{}", char::from(c as u8 + b'a' - 1)),
        c => c.to_string(),
    }
}

/// The size of a cell in pixels, where the system knows it.
pub fn cell() -> Option<(u16, u16)> {
    let size = terminal::window_size().ok()?;
    let cell = (size.width.checked_div(size.columns)?, size.height.checked_div(size.rows)?);
    (cell.0 > 0 && cell.1 > 0).then_some(cell)
}

/// Terminals that say they know kitty's protocol and do not draw its placeholders.
fn takes_half_of_kitty(get: impl Fn(&str) -> Option<String>) -> bool {
    ["WEZTERM_EXECUTABLE", "KONSOLE_VERSION"].iter().any(|name| get(name).is_some())
}

/// What came back.
#[derive(Debug, Default, PartialEq)]
struct Answers {
    /// Control sequences, without their first escape.
    sequences: Vec<String>,
    /// What was typed between them.
    typed: Vec<u8>,
    /// Whether the last answer is there.
    complete: bool,
}

fn answers(question: &str, patience: Duration) -> Answers {
    let mut out = stdout();
    let mut bytes = Vec::new();
    // Whoever cannot be asked does not answer.
    let asked = out.write_all(question.as_bytes()).and_then(|()| out.flush());
    let end = Instant::now() + patience;
    let mut input = stdin();
    while asked.is_ok() && !bytes.windows(4).any(|four| four == b"\x1b[0n") {
        let left = end.saturating_duration_since(Instant::now());
        if left.is_zero() || !system::readable(&input, left) {
            break;
        }
        // As much as the buffer of standard input: nothing may stay in it.
        let mut some = [0; 8192];
        match input.read(&mut some) {
            Ok(n @ 1..) => bytes.extend_from_slice(&some[..n]),
            _ => break,
        }
    }
    Answers::of(&bytes)
}

impl Answers {
    fn of(bytes: &[u8]) -> Answers {
        let mut found = Answers::default();
        let mut rest = bytes;
        while let Some((&first, after)) = rest.split_first() {
            let end = match (first, after.first()) {
                (0x1b, Some(b'[')) => after[1..].iter().position(|byte| (0x40..=0x7e).contains(byte)).map(|at| at + 2),
                (0x1b, Some(b'_' | b'P' | b']')) => after.windows(2).position(|two| two == b"\x1b\\").map(|at| at + 2),
                _ => {
                    found.typed.push(first);
                    rest = after;
                    continue;
                }
            };
            let Some(end) = end else { break };
            found.sequences.push(String::from_utf8_lossy(&after[..end]).trim_end_matches("\x1b\\").to_owned());
            rest = &after[end..];
        }
        found.complete = found.has("[0n");
        found
    }

    fn has(&self, answer: &str) -> bool {
        self.sequences.iter().any(|one| one == answer)
    }

    /// Device attributes with a 4 among them.
    fn sixel(&self) -> bool {
        let attributes = |one: &String| one.strip_prefix("[?")?.strip_suffix('c').map(str::to_owned);
        self.sequences.iter().filter_map(attributes).any(|list| list.split(';').skip(1).any(|one| one == "4"))
    }

    /// The size of a cell: `[6;height;widtht`.
    fn cell(&self) -> Option<(u16, u16)> {
        let size = self.sequences.iter().find_map(|one| one.strip_prefix("[6;")?.strip_suffix('t'))?;
        let (height, width) = size.split_once(';')?;
        let cell = (width.parse().ok()?, height.parse().ok()?);
        (cell.0 > 0 && cell.1 > 0).then_some(cell)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_are_told_from_what_was_typed() {
        let found = Answers::of(b"j\x1b[?64;4;6c:w\x1b[6;20;10t\x1b_Gi=31;OK\x1b\\\x1b[0nq");
        assert_eq!(found.typed, b"j:wq");
        assert_eq!(["\r", " ", "\x12", "z"].map(|c| key(c.chars().next().unwrap())), ["Enter", "Space", "Ctrl-r", "z"]);
        assert!(found.complete && found.sixel() && found.has("_Gi=31;OK"));
        assert_eq!(found.cell(), Some((10, 20)));
    }

    #[test]
    fn silence_and_halves_are_no_answers() {
        for bytes in [&b""[..], b"\x1b[?6", b"\x1b[?62;22c\x1b[6;0;0t", b"\x1b_Gi=31;EINVAL\x1b\\"] {
            let found = Answers::of(bytes);
            assert!(
                !found.complete && !found.sixel() && !found.has("_Gi=31;OK") && found.cell().is_none(),
                "{found:?}"
            );
        }
    }

    #[test]
    fn nobody_is_asked_who_could_not_answer() {
        let environments: [(&[(&str, &str)], bool); 4] = [
            (&[("TERM", "dumb")], false),
            (&[("TERM", "xterm-256color"), ("TMUX", "/tmp/tmux")], true),
            (&[("TERM", "screen-256color"), ("STY", "1.tty")], false),
            (&[("TERM", "xterm-kitty"), ("NO_COLOR", "1")], false),
        ];
        for (environment, tmux) in environments {
            let get = |name: &str| environment.iter().find(|(key, _)| *key == name).map(|(_, v)| v.to_string());
            let (graphics, typed) = ask(None, get);
            assert_eq!((graphics.found, graphics.tmux, typed.len()), (Protocol::Blocks, tmux, 0), "{environment:?}");
        }
    }
}
