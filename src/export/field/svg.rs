//! A plot as SVG, complete in itself: the picture is in it.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;

use super::strokes::PlotMark;
use super::{FAINT, Plot};
use crate::base::error::{Error, Result};
use crate::base::text::{self, hex};
use crate::export::still;

/// The plot as an SVG document.
///
/// # Errors
/// Returns the error of the picture's encoder.
pub fn svg(plot: &Plot) -> Result<String> {
    let (width, height) = (short(plot.width), short(plot.height));
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n\
         <title>{}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        plot.title
    );
    if let Some((frame, place)) = &plot.picture {
        let bytes = still::frame(frame).map_err(|e| Error::at("the picture in the plot", e))?;
        let [x, y, w, h] = [place.x0, place.y0, place.width(), place.height()].map(short);
        text += &format!(
            "<image x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" opacity=\"{FAINT}\" preserveAspectRatio=\"none\" \
             href=\"data:image/png;base64,{}\"/>\n",
            BASE64.encode(&bytes)
        );
    }
    text += "<g stroke-linecap=\"round\" stroke-linejoin=\"round\" fill-rule=\"evenodd\">\n";
    plot.marks.iter().for_each(|mark| draw(mark, &mut text));
    text += "</g>\n</svg>\n";
    Ok(text)
}

fn draw(mark: &PlotMark, text: &mut String) {
    let [r, g, b, a] = mark.color;
    *text += "<path d=\"";
    for (i, point) in mark.points.iter().enumerate() {
        let command = if i == 0 { 'M' } else { 'L' };
        let _ = write!(text, "{command}{} {}", short(point.x), short(point.y)); // a String takes all
    }
    *text += if mark.closed { "Z\"" } else { "\"" };
    let color = format!("#{}", hex(&[r, g, b]));
    let opacity = if a == 255 { String::new() } else { format!(" opacity=\"{}\"", short(f64::from(a) / 255.0)) };
    *text += &match mark.stroke {
        Some(width) => format!(" fill=\"none\" stroke=\"{color}\" stroke-width=\"{}\"{opacity}", short(width)),
        None => format!(" fill=\"{color}\"{opacity}"),
    };
    if let Some((on, off)) = mark.dash {
        *text += &format!(" stroke-dasharray=\"{} {}\"", short(on), short(off));
    }
    *text += "/>\n";
}

/// Coordinates to a hundredth of a pixel.
fn short(value: f64) -> String {
    text::short(value, 2)
}
