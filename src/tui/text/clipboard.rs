//! Copies text to the clipboard of the terminal in front of the person, with the escape sequence OSC 52. That works through
//! ssh, and through tmux and screen if they allow it. The clipboard is never read.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// The longest text that is sent to a terminal's clipboard, in bytes.
pub const MOST_BYTES: usize = 100_000;

/// A multiplexer between the editor and the terminal, which needs escape sequences wrapped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Through {
    /// Nothing.
    Plain,
    /// tmux, which handles the sequence itself if `set-clipboard` is on, and passes it through if `allow-passthrough` is.
    Tmux,
    /// GNU screen, which accepts only short strings.
    Screen,
}

impl Through {
    /// As the environment variables say.
    pub fn of(get: impl Fn(&str) -> Option<String>) -> Through {
        let set = |name| get(name).is_some_and(|value| !value.is_empty());
        match (set("TMUX"), set("STY")) {
            (true, _) => Through::Tmux,
            (_, true) => Through::Screen,
            _ => Through::Plain,
        }
    }
}

/// The escape sequence that puts `text` on the terminal's clipboard.
pub fn sequence(text: &str, through: Through) -> String {
    let plain = format!("\x1b]52;c;{}\x07", STANDARD.encode(text));
    match through {
        Through::Plain => plain,
        Through::Tmux => format!("{plain}\x1bPtmux;{}\x1b\\", plain.replace('\x1b', "\x1b\x1b")),
        Through::Screen => {
            const CHUNK: usize = 76;
            let chunks = (0..plain.len()).step_by(CHUNK).map(|at| &plain[at..(at + CHUNK).min(plain.len())]);
            chunks.map(|chunk| format!("\x1bP{chunk}\x1b\\")).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_terminal_is_handed_the_text_as_it_wants_it() {
        assert_eq!(sequence("[1,2]", Through::Plain), "\x1b]52;c;WzEsMl0=\x07");
        let tmux = "\x1b]52;c;WzEsMl0=\x07\x1bPtmux;\x1b\x1b]52;c;WzEsMl0=\x07\x1b\\";
        assert_eq!(sequence("[1,2]", Through::Tmux), tmux);
        let long = "7".repeat(200);
        let screen = sequence(&long, Through::Screen);
        assert!(screen.split("\x1b\\").all(|chunk| chunk.len() <= 78), "{screen:?}");
        assert_eq!(screen.replace("\x1b\\", "").replace("\x1bP", ""), sequence(&long, Through::Plain));
    }

    #[test]
    fn the_environment_says_what_stands_between() {
        for (name, through) in [("TMUX", Through::Tmux), ("STY", Through::Screen), ("TERM", Through::Plain)] {
            assert_eq!(Through::of(|asked| (asked == name).then(|| "x".to_string())), through);
        }
    }
}
