//! Draws the pictures of the demo scenes: `cargo run --example draw-profiles [NAME...]`. They are made by arithmetic
//! alone, so that anyone can see where they come from and change them; a test checks the committed files against this
//! program.

use std::path::Path;

mod pictures;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let only: Vec<String> = std::env::args().skip(1).collect();
    for (path, draw) in pictures::PICTURES {
        if only.is_empty() || only.iter().any(|name| path.contains(name.as_str())) {
            let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
            std::fs::write(file, draw().to_png()?)?;
        }
    }
    Ok(())
}
