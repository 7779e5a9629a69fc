//! Opens a picture of the scene in another program: the person's choice, else GIMP, else the desktop's default. The editor
//! watches every picture, so what is saved there appears by itself.

use std::io::ErrorKind;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::preview::editor::has_display;

/// The environment variable that names the program, with arguments if needed.
const VARIABLE: &str = "PLICA_IMAGE_EDITOR";

/// Starts the program and returns at once with a message: which program it was, or why there is none.
pub fn open(picture: &Path) -> Result<String, String> {
    open_with(&std::env::var(VARIABLE).unwrap_or_default(), has_display(), picture)
}

fn open_with(chosen: &str, display: bool, picture: &Path) -> Result<String, String> {
    let chosen: Vec<&str> = chosen.split_whitespace().collect();
    if chosen.is_empty() && !display {
        return Err(format!("no display here to edit a picture on; {VARIABLE} can name a program that needs none"));
    }
    let table: &[&[&str]] = if chosen.is_empty() { &[&["gimp"], &["xdg-open"]] } else { &[&chosen] };
    for words in table {
        match start(words, picture) {
            Ok(()) => return Ok(format!("{} has the picture; what it saves shows here", words[0])),
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            Err(error) => return Err(format!("{}: {error}", words[0])),
        }
    }
    let names: Vec<&str> = table.iter().map(|words| words[0]).collect();
    Err(format!("there is no {} here; {VARIABLE} can name another program", names.join(" and no ")))
}

/// Starts it in a process group of its own, so that signals from the terminal do not reach it.
fn start(words: &[&str], picture: &Path) -> std::io::Result<()> {
    let mut command = Command::new(words[0]);
    command.args(&words[1..]).arg(picture).process_group(0);
    let mut child = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn()?;
    // Only reaps the process: how it ends does not matter here.
    std::thread::spawn(move || drop(child.wait()));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_persons_own_choice_gets_the_picture() {
        let folder = tempfile::tempdir().unwrap();
        let (picture, copy) = (folder.path().join("-a b.png"), folder.path().join("copy"));
        std::fs::write(&picture, "picture").unwrap();
        // `install` as an editor: it takes its own arguments before the picture.
        let chosen = format!("install -D -t {}", copy.display());
        assert!(open_with(&chosen, false, &picture).unwrap().starts_with("install has the picture"));
        while !std::fs::read(copy.join("-a b.png")).is_ok_and(|bytes| bytes == b"picture") {
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        for (chosen, display, part) in [("/no/editor", true, "no /no/editor here"), ("", false, "no display here")] {
            let why = open_with(chosen, display, &picture).unwrap_err();
            assert!(why.contains(part) && why.contains(VARIABLE), "{why}");
        }
    }
}
