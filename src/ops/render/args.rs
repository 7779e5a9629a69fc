//! The arguments of `plica render`, and what follows from them for frames and passes alike.

use std::path::PathBuf;

use crate::base::error::Result;
use crate::base::pixels::Rgba;
use crate::export::animation::formats::{kept, table};
use crate::export::animation::matrix::Matrix;
use crate::export::animation::range;
use crate::export::numbered::is_one_picture;
use crate::ops::scene_options::SceneOptions;
use crate::ops::writing::Replacing;
use crate::scene::{Scene, check, compared};

/// Render frames to numbered files, an animation or a stream
#[derive(clap::Args)]
#[command(after_help = outputs_help())]
pub struct Args {
    /// The scene; - is standard input
    pub(super) scene: PathBuf,
    /// Where to: the extension names the format, %04d numbers files, - is standard output
    #[arg(short, long, value_name = "OUT")]
    pub(super) output: PathBuf,
    /// Which frames, for example 0,5,10-20:2 or 20-10 [default: all]
    #[arg(long, value_name = "RANGE", allow_hyphen_values = true)]
    pub(super) frames: Option<String>,
    /// Number the files N, N+1, ... in the order of the frames, not as the scene numbers them
    #[arg(long, value_name = "N")]
    pub(super) start_number: Option<u32>,
    /// Skip numbered files that exist already, complete and of the right size
    #[arg(long)]
    pub(super) skip_existing: bool,
    /// Scale finished frames; 0 for one side keeps the aspect ratio
    #[arg(long, value_name = "WxH", allow_hyphen_values = true)]
    pub(super) size: Option<String>,
    /// Render what frames are made from, to .exr files (or .png, to look at); NAME:LAYER renders one layer only
    #[arg(long, value_name = "NAME")]
    pub(super) pass: Option<String>,
    /// Render what is drawn on meshes with each anchor, or in each style, side by side
    #[arg(long, value_name = "BY", value_parser = compared::names(), conflicts_with = "pass")]
    pub(super) compare: Option<String>,
    /// N x N samples per pixel, at most 16 x 16: smooth edges of folds and meshes
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=16))]
    pub(super) samples: u32,
    /// Draw with the GPU instead of the reference renderer
    #[arg(long)]
    pub(super) gpu: bool,
    /// Format on standard output: y4m or rgba
    #[arg(long)]
    pub(super) format: Option<String>,
    /// Matrix of y4m and video [default: bt709 from 720 lines up, bt601 below, as players assume]
    #[arg(long, value_name = "NAME", value_parser = Matrix::NAMES)]
    pub(super) matrix: Option<String>,
    #[command(flatten)]
    pub(super) replacing: Replacing,
    #[command(flatten)]
    pub(super) options: SceneOptions,
}

fn outputs_help() -> String {
    format!(
        "Outputs:\n{}\n  -         y4m or rgba for another program, by --format\n\nWhat they keep:\n{}\n\nPasses:\n{}\n\n{LINE}",
        table(),
        kept(),
        crate::render::passes::table()
    )
}

const LINE: &str = "Video by a line of your own (from 720 lines on; below them smpte170m in the place of bt709, twice):
  plica render SCENE -o - --format y4m | ffmpeg -i pipe:0 \\
    -vf format=yuv420p,setparams=colorspace=bt709:color_primaries=bt709:color_trc=iec61966-2-1:range=tv \\
    -colorspace bt709 -color_primaries bt709 -color_trc iec61966-2-1 -color_range tv \\
    -c:v libx264 -crf 16 out.mp4";

/// The frames that are asked for; of a scene in which nothing moves its one picture, where there is room for one alone, and
/// that this is so.
pub(super) fn wanted(args: &Args, scene: &Scene) -> Result<(Vec<u64>, Option<String>)> {
    let all = scene.timeline.frames();
    match &args.frames {
        Some(text) => Ok((range::parse(text, all)?, None)),
        None if all > 1 && !check::moves(scene) => Ok(match is_one_picture(&args.output) {
            true => (vec![0], Some("nothing moves in the scene: this is its one picture".into())),
            false => ((0..all).collect(), Some(format!("nothing moves in the scene: all {all} frames are the same"))),
        }),
        None => Ok(((0..all).collect(), None)),
    }
}

/// A frame of the scene, and the number of its file.
pub(super) type Numbered = (u64, u64);

/// The frames, each with the number of its file.
pub(super) fn numbered(args: &Args, frames: &[u64]) -> Vec<Numbered> {
    let number = |(at, &frame): (usize, &u64)| match args.start_number {
        Some(first) => (frame, u64::from(first) + at as u64),
        None => (frame, frame),
    };
    frames.iter().enumerate().map(number).collect()
}

/// Bytes that a frame of `own` size takes while it is rendered and scaled to `size`: as light and as color codes.
pub(super) fn frame_bytes(own: (usize, usize), size: (usize, usize), samples: usize, band: usize) -> u64 {
    const LIGHT: u64 = size_of::<Rgba>() as u64;
    const COLORS: u64 = size_of::<[u8; 4]>() as u64;
    let pixels = |(width, height): (usize, usize)| width as u64 * height as u64;
    // The mean of several samples is summed up beside the sample being rendered.
    let copies = if samples > 1 { 2 } else { 1 };
    if own == size {
        // Only a few rows are in memory as light.
        let band = (band.max(own.0) as u64).min(pixels(own));
        return pixels(own) * COLORS + band * LIGHT * copies;
    }
    // Scaling needs copies of both.
    pixels(own) * (copies + 1) * LIGHT + pixels(size) * (2 * LIGHT + COLORS)
}
