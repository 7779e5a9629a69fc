//! Opens a picture of the scene in another program: the person's choice, else GIMP, else what the desktop takes for it. What
//! is saved there shows by itself, since every picture is watched.

use std::io::ErrorKind;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::preview::editor::has_display;

/// The variable that names the program, with arguments where it needs any.
const VARIABLE: &str = "PLICA_IMAGE_EDITOR";

/// Starts the program and returns at once; says which it was, or why there is none.
pub fn open(picture: &Path) -> Result<String, String> {
    open_with(&std::env::var(VARIABLE).unwrap_or_default(), has_display(), picture)
}

fn open_with(chosen: &str, display: bool, picture: &Path) -> Result<String, String> {
    let chosen: Vec<&str> = chosen.split_whitespace().collect();
    if chosen.is_empty() && !display {
        return Err(format!("no display here to edit a picture on; {VARIABLE} names a program that needs none"));
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
    Err(format!("there is no {} here; {VARIABLE} names another program", names.join(" and no ")))
}

/// In a group of its own: what the terminal does to the editor's is not meant for it.
fn start(words: &[&str], picture: &Path) -> std::io::Result<()> {
    let mut command = Command::new(words[0]);
    command.args(&words[1..]).arg(picture).process_group(0);
    let mut child = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn()?;
    // How it ends is between it and the person.
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
