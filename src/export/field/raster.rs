//! A plot as PNG, drawn by tiny-skia.

use kurbo::Rect;
use tiny_skia::{
    Color, FillRule, FilterQuality, LineCap, LineJoin, Paint, PathBuilder, Pixmap, PixmapPaint, PremultipliedColorU8,
    Stroke, StrokeDash, Transform,
};

use super::strokes::PlotMark;
use super::{FAINT, Plot};
use crate::base::error::{Error, Result};
use crate::base::pixels::Frame;
use crate::export::still;

/// The plot as a PNG file.
///
/// # Errors
/// If the plot is too large; otherwise the encoder's error.
pub fn png(plot: &Plot) -> Result<Vec<u8>> {
    let failed = |what: &str| Error::at("the plot", what);
    let (width, height) = (plot.width.ceil() as u32, plot.height.ceil() as u32);
    let mut pixmap = Pixmap::new(width, height).ok_or_else(|| failed("is too large for a PNG"))?;
    pixmap.fill(Color::WHITE);
    if let Some((frame, place)) = &plot.picture {
        draw_picture(frame, *place, &mut pixmap).ok_or_else(|| failed("has too large a picture"))?;
    }
    for mark in &plot.marks {
        draw(mark, &mut pixmap);
    }
    // White fills all of it, so that nothing is transparent and the pixels are the colors.
    still::pixels((width as usize, height as usize), pixmap.data()).map_err(|e| failed(&e.to_string()))
}

fn draw_picture(frame: &Frame, place: Rect, pixmap: &mut Pixmap) -> Option<()> {
    let mut picture = Pixmap::new(frame.width() as u32, frame.height() as u32)?;
    for (pixel, &[r, g, b, a]) in picture.pixels_mut().iter_mut().zip(frame.cells()) {
        let by = |c: u8| ((u16::from(c) * u16::from(a) + 127) / 255) as u8;
        *pixel = PremultipliedColorU8::from_rgba(by(r), by(g), by(b), a)?;
    }
    let scale = (place.width() / frame.width() as f64) as f32;
    let paint = PixmapPaint { opacity: FAINT as f32, quality: FilterQuality::Bilinear, ..PixmapPaint::default() };
    let transform = Transform::from_row(scale, 0.0, 0.0, scale, place.x0 as f32, place.y0 as f32);
    pixmap.draw_pixmap(0, 0, picture.as_ref(), &paint, transform, None);
    Some(())
}

fn draw(mark: &PlotMark, pixmap: &mut Pixmap) {
    let mut builder = PathBuilder::new();
    for (i, point) in mark.points.iter().enumerate() {
        let (x, y) = (point.x as f32, point.y as f32);
        if i == 0 { builder.move_to(x, y) } else { builder.line_to(x, y) }
    }
    if mark.closed {
        builder.close();
    }
    let Some(path) = builder.finish() else { return };
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    let [r, g, b, a] = mark.color;
    paint.set_color_rgba8(r, g, b, a);
    match mark.stroke {
        None => pixmap.fill_path(&path, &paint, FillRule::EvenOdd, Transform::identity(), None),
        Some(width) => {
            let dash = mark.dash.and_then(|(on, off)| StrokeDash::new(vec![on as f32, off as f32], 0.0));
            let (line_cap, line_join) = (LineCap::Round, LineJoin::Round);
            let stroke = Stroke { width: width as f32, dash, line_cap, line_join, ..Stroke::default() };
            pixmap.stroke_path(&path, &paint, &stroke, Transform::identity(), None);
        }
    }
}
