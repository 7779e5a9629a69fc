//! Asks the terminal once, before anything else reads its input, which graphics protocol it understands. The first question
//! is one that every terminal answers and whose late answers do no harm; only then it is asked for kitty's protocol.

use std::io::{Write, stdin, stdout};
use std::time::{Duration, Instant};

use ratatui::crossterm::terminal;

use super::input;
use super::input::{Piece, Pieces};
use crate::base::system;
use crate::tui::graphics::{Graphics, Protocol};

/// How long a terminal has to answer, here and on a remote machine.
const HERE: Duration = Duration::from_millis(400);
const FAR: Duration = Duration::from_millis(1500);
/// Asks for the kind of terminal, the size of a cell, and a report that every terminal sends, which ends the answers.
const KIND: &str = "\x1b[c\x1b[16t\x1b[5n";
/// Asks whether it would take a picture of one pixel, by kitty's protocol.
const KITTY: &str = "\x1b_Gi=31,s=1,v=1,a=q,t=d,f=24;AAAA\x1b\\\x1b[5n";
/// Terminals that understand iTerm2's images, by the names that they report.
const ITERM2: [&str; 4] = ["iTerm", "WezTerm", "mintty", "rio"];

/// What the terminal understands, and what was typed and pasted meanwhile. Incomplete input stays in `pieces`.
pub fn ask(
    forced: Option<Protocol>,
    pieces: &mut Pieces,
    get: impl Fn(&str) -> Option<String>,
) -> (Graphics, Vec<Piece>) {
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
    let mut answers = Answers::default();
    answers.wait_for(KIND, patience, pieces);
    if answers.complete && forced.is_none() && !takes_half_of_kitty(get) {
        answers.wait_for(KITTY, FAR, pieces);
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
    (graphics, answers.typed)
}

/// The size of a cell in pixels, if the system knows it.
pub fn cell() -> Option<(u16, u16)> {
    let size = terminal::window_size().ok()?;
    let cell = (size.width.checked_div(size.columns)?, size.height.checked_div(size.rows)?);
    (cell.0 > 0 && cell.1 > 0).then_some(cell)
}

/// Whether a control sequence is an answer to one of the questions. No key and no click ends in the same way.
fn is_answer(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x1b[") && matches!(bytes.last(), Some(b'c' | b't' | b'n'))
}

/// Terminals that claim kitty's protocol but do not draw its placeholders.
fn takes_half_of_kitty(get: impl Fn(&str) -> Option<String>) -> bool {
    ["WEZTERM_EXECUTABLE", "KONSOLE_VERSION"].iter().any(|name| get(name).is_some())
}

/// What the terminal has sent.
#[derive(Debug, Default, PartialEq)]
struct Answers {
    /// Its answers: control sequences without the first escape.
    sequences: Vec<String>,
    /// What was typed in between.
    typed: Vec<Piece>,
    /// Whether the last answer has arrived.
    complete: bool,
}

impl Answers {
    /// Asks, and waits for the last answer.
    fn wait_for(&mut self, question: &str, patience: Duration, pieces: &mut Pieces) {
        let mut out = stdout();
        // If the question cannot be written, there is no answer to wait for.
        let asked = out.write_all(question.as_bytes()).and_then(|()| out.flush());
        let end = Instant::now() + patience;
        self.complete = false;
        while asked.is_ok() && !self.complete {
            let left = end.saturating_duration_since(Instant::now());
            if left.is_zero() || !system::readable(stdin(), left) || !input::feed(pieces) {
                break;
            }
            self.take(pieces, Instant::now());
        }
    }

    /// Takes the complete pieces.
    fn take(&mut self, pieces: &mut Pieces, now: Instant) {
        while let Some(piece) = pieces.take(now) {
            let sequence = match &piece {
                Piece::Key(bytes) if is_answer(bytes) => bytes,
                Piece::Answer(bytes) => bytes,
                _ => {
                    self.typed.push(piece);
                    continue;
                }
            };
            let text = String::from_utf8_lossy(&sequence[1..]);
            self.complete |= text == "[0n";
            self.sequences.push(text.trim_end_matches("\x1b\\").to_owned());
        }
    }

    fn has(&self, answer: &str) -> bool {
        self.sequences.iter().any(|one| one == answer)
    }

    /// Whether the device attributes contain a 4, for sixels.
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

    fn answers(bytes: &[u8]) -> (Answers, Pieces) {
        let (mut found, mut pieces) = (Answers::default(), Pieces::new());
        for byte in bytes {
            pieces.feed(&[*byte], Instant::now());
            found.take(&mut pieces, Instant::now());
        }
        (found, pieces)
    }

    #[test]
    fn answers_are_told_from_what_was_typed() {
        let (found, mut pieces) =
            answers(b"j\x1b[?64;4;6c:w\x1b[6;20;10t\x1b[B\x1b_Gi=31;OK\x1b\\\x1b[200~:q!\r\x1b[201~\x1b[0n\x1bOA\x1b[");
        let key = |bytes: &[u8]| Piece::Key(bytes.to_vec());
        let typed = [key(b"j"), key(b":"), key(b"w"), key(b"\x1b[B"), Piece::Paste(":q!\r".into()), key(b"\x1bOA")];
        assert_eq!(found.typed, typed);
        assert!(found.complete && found.sixel() && found.has("_Gi=31;OK"));
        assert_eq!(found.cell(), Some((10, 20)));
        pieces.feed(b"A", Instant::now());
        assert_eq!(pieces.take(Instant::now()), Some(key(b"\x1b[A")), "what has begun goes on");
    }

    #[test]
    fn silence_and_halves_are_no_answers() {
        for bytes in [&b""[..], b"\x1b[?6", b"\x1b[?62;22c\x1b[6;0;0t", b"\x1b_Gi=31;EINVAL\x1b\\"] {
            let (found, _) = answers(bytes);
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
            let (graphics, typed) = ask(None, &mut Pieces::new(), get);
            assert_eq!((graphics.found, graphics.tmux, typed.len()), (Protocol::Blocks, tmux, 0), "{environment:?}");
        }
    }
}
