//! The only owner of the device. A missing adapter, a lost device and all driver errors are results, never panics:
//! errors are captured and returned to the caller that asked for the work.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError, mpsc};

use crate::base::error::{Error, Result};
use crate::layers::ready::Ready;

/// The place in error messages about the GPU, and the hint if it fails.
const PLACE: &str = "GPU";
const CURE: &str = "frames can be rendered without a GPU: leave out --gpu";

/// A device and its queue; a clone is the same device.
#[derive(Clone)]
pub struct Device {
    /// The device.
    pub raw: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// The adapter that it was opened on.
    pub adapter: wgpu::Adapter,
    lost: Arc<AtomicBool>,
    uncaught: Arc<Mutex<Option<String>>>,
    submitting: Arc<Mutex<()>>,
}

impl Device {
    /// The fastest device, one that can present to `surface` if that is given. Vulkan if possible, otherwise OpenGL.
    pub fn open(instance: &wgpu::Instance, surface: Option<&wgpu::Surface<'_>>) -> Result<Device> {
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            compatible_surface: surface,
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options))
            .map_err(|e| failed(format!("no adapter was found: {}", one_line(&e))))?;
        let own = adapter.limits();
        let limits = wgpu::Limits {
            max_buffer_size: own.max_buffer_size,
            max_storage_buffer_binding_size: own.max_storage_buffer_binding_size,
            ..wgpu::Limits::downlevel_defaults()
        };
        let limits = limits.using_resolution(own.clone()).or_worse_values_from(&own);
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("plica"),
            required_features: adapter.features() & wgpu::Features::FLOAT32_BLENDABLE,
            required_limits: limits,
            memory_hints: wgpu::MemoryHints::MemoryUsage,
            ..Default::default()
        };
        let (raw, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|e| failed(format!("{} gave no device: {}", adapter.get_info().name, one_line(&e))))?;
        let (lost, uncaught, submitting) = Default::default();
        let device = Device { raw, queue, adapter, lost, uncaught, submitting };
        device.listen();
        Ok(device)
    }

    fn listen(&self) {
        let lost = self.lost.clone();
        self.raw.set_device_lost_callback(move |_, _| lost.store(true, Ordering::Release));
        let uncaught = self.uncaught.clone();
        self.raw.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            if let Ok(mut kept) = uncaught.lock() {
                kept.get_or_insert_with(|| one_line(&error));
            }
        }));
    }

    /// Whether the device is lost, so that a new one is needed. This polls the device, which reports a loss only then.
    pub fn is_lost(&self) -> bool {
        let _ = self.raw.poll(wgpu::PollType::Poll); // an error here is the loss that the callback reports
        self.lost.load(Ordering::Acquire)
    }

    /// Whether the processor draws what a GPU would.
    pub fn is_software(&self) -> bool {
        self.adapter.get_info().device_type == wgpu::DeviceType::Cpu
    }

    /// The adapter's name, for people.
    pub fn name(&self) -> String {
        self.adapter.get_info().name
    }

    /// The largest side of a picture, in pixels.
    pub fn max_side(&self) -> usize {
        self.raw.limits().max_texture_dimension_2d as usize
    }

    /// Whether floats of 32 bits can be blended.
    pub fn blends_floats(&self) -> bool {
        self.raw.features().contains(wgpu::Features::FLOAT32_BLENDABLE)
    }

    /// Why it cannot draw a layer; `None` if it can.
    pub fn cannot(&self, layer: &dyn Ready) -> Option<String> {
        let lacks = || format!("{} cannot compute strokes", self.name());
        let computed = layer.has_strokes() && !self.computes();
        layer.by_cpu().map(str::to_owned).or_else(|| computed.then(lacks))
    }

    /// Whether it computes what is drawn, and draws numbers that are read later.
    fn computes(&self) -> bool {
        let wanted = wgpu::DownlevelFlags::COMPUTE_SHADERS
            | wgpu::DownlevelFlags::INDIRECT_EXECUTION
            | wgpu::DownlevelFlags::VERTEX_STORAGE;
        let floats = self.adapter.get_texture_format_features(wgpu::TextureFormat::Rgba32Float).allowed_usages;
        let flags = self.adapter.get_downlevel_capabilities().flags;
        flags.contains(wanted) && floats.contains(wgpu::TextureUsages::RENDER_ATTACHMENT)
    }

    /// Waits for a buffer that everything needed was submitted for, and hands out what is in it.
    pub fn read<T>(&self, buffer: &wgpu::Buffer, take: impl FnOnce(&[u8]) -> T) -> Result<T> {
        let (done, mapped) = mpsc::channel();
        buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| {
            let _ = done.send(result); // the receiver is gone only if the wait failed
        });
        self.wait()?;
        mapped.try_recv().map_err(failed)?.map_err(failed)?;
        let bytes = buffer.slice(..).get_mapped_range().map_err(failed)?;
        Ok(take(&bytes))
    }

    /// Runs `work`; an error that it causes on the device becomes the result.
    pub fn checked<T>(&self, work: impl FnOnce() -> T) -> Result<T> {
        let memory = self.raw.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let validation = self.raw.push_error_scope(wgpu::ErrorFilter::Validation);
        let done = work();
        let validation = pollster::block_on(validation.pop());
        let memory = pollster::block_on(memory.pop());
        match memory.or(validation) {
            Some(error) => Err(failed(one_line(&error))),
            None => Ok(done),
        }
    }

    /// As [`Device::checked`], while no other thread does the same: an upload, or the configuration of a surface, which fails
    /// where more is submitted before the device has come to rest.
    pub fn alone<T>(&self, work: impl FnOnce() -> T) -> Result<T> {
        let _alone = self.submitting.lock().unwrap_or_else(PoisonError::into_inner);
        self.checked(work)
    }

    /// The first error since the last call that no check caught.
    pub fn take_uncaught(&self) -> Result<()> {
        match self.uncaught.lock().ok().and_then(|mut kept| kept.take()) {
            Some(error) => Err(failed(error)),
            None => Ok(()),
        }
    }

    /// Waits until everything that was submitted is done.
    pub fn wait(&self) -> Result<()> {
        self.raw.poll(wgpu::PollType::wait_indefinitely()).map(|_| ()).map_err(failed)
    }
}

/// The graphics libraries that lead to adapters; they are loaded at run time, so the program starts without them.
pub fn instance(display: Option<Box<dyn wgpu::wgt::WgpuHasDisplayHandle>>) -> wgpu::Instance {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.flags = wgpu::InstanceFlags::empty();
    descriptor.display = display;
    wgpu::Instance::new(descriptor)
}

/// A buffer of so many bytes to copy something into that is read back.
pub fn readable(device: &Device, size: u64) -> Result<wgpu::Buffer> {
    let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
    device.checked(|| {
        device.raw.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
    })
}

/// An error of the GPU.
pub fn failed(what: impl std::fmt::Display) -> Error {
    Error::at(PLACE, what).cure(CURE)
}

/// An error with its causes, as one line.
fn one_line(error: &dyn std::fmt::Display) -> String {
    let text = error.to_string();
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && *line != "Caused by:");
    lines.collect::<Vec<_>>().join(": ")
}
