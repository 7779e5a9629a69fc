//! A pass in place of the frame, or a frame that the CPU draws. It is what the reference is made from, and made again only
//! where something that it shows has changed: what takes long beside the event loop.

use std::borrow::Cow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver};
use std::sync::{Arc, LazyLock};
use std::time::{Duration, Instant};

use rayon::{ThreadPool, ThreadPoolBuilder};
use winit::event_loop::EventLoopProxy;

use super::own_view::OwnView;
use super::worker::Event;
use crate::base::error::{Error, Result};
use crate::base::fault;
use crate::base::pixels::{Frame, decode, encode};
use crate::render::Synth;
use crate::render::gpu::Gpu;
use crate::render::passes::{self, Asked};

/// At most so many pixels are computed; larger frames are thinned out.
const MOST: usize = 1 << 22;

/// What is not made within this time is not waited for: overlays are drawn over what was there before.
const SHORT: Duration = Duration::from_millis(50);
/// What has taken this long is given up where the scene is another, or is seen from elsewhere, by then.
const PATIENCE: Duration = Duration::from_secs(1);

/// The textures of a pass, and what they were made for.
#[derive(Default)]
pub struct KeptPasses {
    made_for: Option<For>,
    textures: Option<Textures>,
    /// Pixels of the frame a pixel of the textures.
    pub each: usize,
    making: Option<Making>,
    /// How long the newest took, until that is asked for.
    took: Option<Duration>,
}

/// Of the frame, and of the one that it is shown beside or compared with.
pub type Textures = (wgpu::Texture, Option<wgpu::Texture>);
/// The same as colors to look at, and how many pixels of the frame one of them stands for.
type Pictures = (Frame, Option<Frame>, usize);
/// A scene and its time.
type At<'a> = (&'a Synth, f64);

/// What the textures of a pass depend on.
#[derive(Clone, PartialEq)]
pub struct For {
    /// The pass.
    pub asked: Asked,
    /// The number of scenes so far.
    pub revision: u64,
    /// Where the window looks from, if that is not where the scene's camera does.
    pub own: Option<OwnView>,
    /// The scene times of the frame and of what it is compared with, and whether the frame is the still picture.
    pub times: (f64, Option<f64>, bool),
    /// How many sprites are left out after each that is shown.
    pub left_out: u32,
}

impl KeptPasses {
    /// The textures; those from before as long as others are being made, if there were any. Where that ends later,
    /// `wake` is told.
    pub fn follow(
        &mut self,
        gpu: &Gpu,
        wanted: &For,
        (frame, other): (At, Option<(Cow<'_, Synth>, f64)>),
        wake: &EventLoopProxy<Event>,
    ) -> Result<Option<Textures>> {
        if self.made_for.as_ref() == Some(wanted) {
            self.making = None;
        } else {
            self.making.take_if(|making| making.gives_way_to(wanted));
            let other = || other.as_ref().map(|(synth, time)| (&**synth, *time));
            let making = self.making.get_or_insert_with(|| Making::start(wanted, (frame, other()), wake));
            if let Some((made_for, (pictures, took))) = making.ended() {
                self.making = None;
                self.took = Some(took);
                self.take(gpu, made_for, &pictures?)?;
            }
            if self.making.is_none() && self.made_for.as_ref() != Some(wanted) {
                self.making = Some(Making::start(wanted, (frame, other()), wake));
            }
        }
        Ok(self.textures.clone())
    }

    /// Whether something is being made.
    pub fn is_making(&self) -> bool {
        self.making.is_some()
    }

    /// How long what was made since this was asked last took, if something was.
    pub fn took(&mut self) -> Option<Duration> {
        self.took.take()
    }

    fn take(&mut self, gpu: &Gpu, made_for: For, (frame, other, each): &Pictures) -> Result<()> {
        let frame = upload(gpu, frame)?;
        let other = other.as_ref().map(|other| upload(gpu, other)).transpose()?;
        (self.textures, self.each, self.made_for) = (Some((frame, other)), *each, Some(made_for));
        Ok(())
    }
}

fn pictures(asked: &Asked, (synth, time): At, other: Option<At>) -> Pictures {
    let asked = asked.looked_at();
    let seen = |(synth, time): At| {
        let (picture, each) = passes::thinned(&asked, synth, time, MOST);
        let frame = || passes::thinned(&asked.in_color(), synth, time, MOST).0;
        (passes::view_over(&asked, &picture, frame), each)
    };
    let (frame, each) = seen((synth, time));
    (frame, other.map(|other| seen(other).0), each)
}

/// Runs work on threads of its own. Those of all other work come to nothing new before a view map is filled, say.
fn beside<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    static THREADS: LazyLock<Option<ThreadPool>> = LazyLock::new(|| ThreadPoolBuilder::new().build().ok());
    match &*THREADS {
        Some(threads) => threads.install(work),
        None => work(),
    }
}

/// Pictures that are being made beside the event loop.
struct Making {
    made_for: For,
    begun: Instant,
    stop: Arc<AtomicBool>,
    made: Receiver<(Result<Pictures>, Duration)>,
}

impl Making {
    fn start(wanted: &For, (frame, other): (At, Option<At>), wake: &EventLoopProxy<Event>) -> Making {
        let (stop, (sender, made)) = (Arc::new(AtomicBool::new(false)), mpsc::channel());
        let own = |(synth, time): At| (synth.stoppable(&stop), time);
        let (frame, other, asked, wake) = (own(frame), other.map(own), wanted.asked.clone(), wake.clone());
        std::thread::spawn(move || {
            let begun = Instant::now();
            let other = other.as_ref().map(|(synth, time)| (synth, *time));
            let made = fault::caught(|| beside(|| pictures(&asked, (&frame.0, frame.1), other)));
            // Nobody listens where something else is wanted by now, or once the window is gone.
            let _ = sender.send((made.map_err(|fault| Error::at("window", fault)), begun.elapsed()));
            let _ = wake.send_event(Event::Drawn);
        });
        Making { made_for: wanted.clone(), begun: Instant::now(), stop, made }
    }

    /// Whether it is given up for something else. While only the time runs on, it is not.
    fn gives_way_to(&self, wanted: &For) -> bool {
        let own = &self.made_for;
        let is_old = own.revision != wanted.revision || own.own != wanted.own;
        own.asked != wanted.asked || is_old && self.begun.elapsed() > PATIENCE
    }

    /// What was made, once it is, and how long that took.
    fn ended(&self) -> Option<(For, (Result<Pictures>, Duration))> {
        let rest = SHORT.saturating_sub(self.begun.elapsed());
        self.made.recv_timeout(rest).ok().map(|made| (self.made_for.clone(), made))
    }
}

impl Drop for Making {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

/// A pass as a texture to look at: sRGB, premultiplied in linear light.
fn upload(gpu: &Gpu, view: &Frame) -> Result<wgpu::Texture> {
    let premultiplied = |code: [u8; 4]| {
        let [r, g, b, a] = decode(code);
        let [r, g, b, _] = encode([r, g, b, 1.0]);
        [r, g, b, (a * 255.0).round() as u8]
    };
    let texel = |&code: &[u8; 4]| if matches!(code[3], 0 | 255) { code } else { premultiplied(code) };
    let texels: Vec<[u8; 4]> = view.cells().iter().map(texel).collect();
    let size = wgpu::Extent3d { width: view.width() as u32, height: view.height() as u32, depth_or_array_layers: 1 };
    let device = gpu.device();
    device.checked(|| {
        let texture = device.raw.create_texture(&wgpu::TextureDescriptor {
            label: Some("pass"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8UnormSrgb,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let layout = wgpu::TexelCopyBufferLayout { bytes_per_row: Some(4 * size.width), ..Default::default() };
        device.queue.write_texture(texture.as_image_copy(), bytemuck::cast_slice(&texels), layout, size);
        texture
    })
}

#[cfg(test)]
mod tests {
    use rayon::prelude::*;

    use super::*;

    #[test]
    fn pictures_do_not_wait_for_what_else_is_being_made() {
        // As a filling does, something has all threads until it ends.
        let end = Arc::new(AtomicBool::new(false));
        for _ in 0..rayon::current_num_threads() {
            let end = end.clone();
            rayon::spawn(move || {
                while !end.load(Ordering::Relaxed) {
                    std::thread::sleep(Duration::from_millis(1))
                }
            });
        }
        let (done, told) = mpsc::channel();
        std::thread::spawn(move || done.send(beside(|| (0..100_u64).into_par_iter().sum::<u64>())));
        let sum = told.recv_timeout(Duration::from_secs(20));
        end.store(true, Ordering::Relaxed);
        assert_eq!(sum, Ok(4950));
    }
}
