//! `plica attach --stdio`: the far end of a window on another machine. It is started there by `plica view ssh://...`,
//! through the person's own ssh, and serves the scene over standard input and output until that ends.

use std::path::PathBuf;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

use super::Context;
use super::scene_options::SceneOptions;
use crate::base::error::{Error, Result};
use crate::preview::remote::attach;
use crate::preview::wire::connection::{HangUp, Wire};

/// How often to check for a signal.
const LOOK: Duration = Duration::from_millis(250);

/// Serve a scene to a window on another machine (plica view ssh://... starts this)
#[derive(clap::Args)]
pub struct Args {
    /// The scene
    pub scene: PathBuf,
    /// Speak the window's protocol on standard input and output
    #[arg(long)]
    pub stdio: bool,
    #[command(flatten)]
    options: SceneOptions,
}

/// Serves the scene until the pipe ends.
///
/// # Errors
/// If there is no such scene, or no window of this version at the other end.
pub fn run(args: Args, context: &mut Context) -> Result<()> {
    if !args.stdio || context.open.is_some() {
        return Err(Error::Usage(
            "attach is what plica view ssh://HOST/SCENE starts on HOST; by hand it needs --stdio".into(),
        ));
    }
    let options = args.options.options()?;
    let (sender, ended) = mpsc::channel();
    let hung_up = sender.clone();
    let wire = Wire {
        reader: Box::new(std::io::stdin()),
        writer: Box::new(std::io::stdout()),
        // A blocked read of standard input cannot be interrupted: it ends with this process.
        hang_up: HangUp::new(move || drop(hung_up.send(Ok(())))),
    };
    std::thread::spawn(move || drop(sender.send(attach::serve(&args.scene, &options, wire))));
    loop {
        match ended.recv_timeout(LOOK) {
            Ok(ended) => return ended,
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
            Err(RecvTimeoutError::Timeout) => context.check_cancelled()?,
        }
    }
}
