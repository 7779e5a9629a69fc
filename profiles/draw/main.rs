//! Makes the pictures and meshes of the demo scenes: `cargo run --example draw-profiles [NAME...]`. They are made
//! by arithmetic alone, so that anyone can see where they come from and change them; a test checks the committed files
//! against this program.

use std::path::Path;

mod meshes;
mod pictures;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let only: Vec<String> = std::env::args().skip(1).collect();
    let wanted = |path: &str| only.is_empty() || only.iter().any(|name| path.contains(name.as_str()));
    let file = |path: &str| Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    for (path, draw) in pictures::PICTURES.iter().filter(|(path, _)| wanted(path)) {
        std::fs::write(file(path), draw().to_png()?)?;
    }
    for (pattern, count, draw) in pictures::CLIPS.iter().filter(|(path, ..)| wanted(path)) {
        for number in 0..*count {
            std::fs::write(file(&pictures::frame_file(pattern, number)), draw(number).to_png()?)?;
        }
    }
    for (path, write) in meshes::MESHES.iter().filter(|(path, _)| wanted(path)) {
        std::fs::write(file(path), write())?;
    }
    Ok(())
}
