//! Which frames: `A`, `A-B`, `A-B:S` and comma lists of them, like the range expressions of Open Job Description; `B-A` counts
//! down.

use crate::base::error::{Error, Result};

/// The frames of `text` out of a scene's `count` frames, in the order named, each once.
///
/// # Errors
///
/// A wrong command line: what stands where, what was expected, and which frames there are.
pub fn parse(text: &str, count: u64) -> Result<Vec<u64>> {
    let mut frames = Vec::new();
    let mut named = vec![false; count as usize];
    for part in text.split(',') {
        let (first, last, step) = parse_part(part.trim()).map_err(|what| wrong(text, what))?;
        let largest = first.max(last);
        if largest >= count {
            let scene = format!("frame {largest} is not there: the scene has frames 0 to {}", count - 1);
            return Err(wrong(text, scene));
        }
        let steps = (0..=first.abs_diff(last)).step_by(usize::try_from(step).unwrap_or(usize::MAX));
        let numbers = steps.map(|k| if first <= last { first + k } else { first - k });
        frames.extend(numbers.filter(|&k| !std::mem::replace(&mut named[k as usize], true)));
    }
    Ok(frames)
}

/// The even step from frame to frame, up or down, if there is one; 1 for a single frame.
pub fn step(frames: &[u64]) -> Option<u64> {
    let mut steps = frames.windows(2).map(|pair| i128::from(pair[1]) - i128::from(pair[0]));
    let first = steps.next().unwrap_or(1);
    let even = steps.all(|step| step == first);
    u64::try_from(first.unsigned_abs()).ok().filter(|_| even)
}

fn parse_part(part: &str) -> std::result::Result<(u64, u64, u64), String> {
    let number = |text: &str| {
        let text = text.trim();
        text.parse::<u64>().map_err(|_| match text {
            "" => format!("a frame number is missing in \"{part}\""),
            _ => format!("\"{text}\" is no frame number"),
        })
    };
    let (range, step) = match part.split_once(':') {
        Some((range, step)) => (range, number(step)?),
        None => (part, 1),
    };
    let (first, last) = match range.split_once('-') {
        Some((first, last)) => (number(first)?, number(last)?),
        None if part.contains(':') => return Err(format!("\"{part}\" has a step but no last frame")),
        None => (number(range)?, number(range)?),
    };
    if step == 0 { Err(format!("the step in \"{part}\" is 0")) } else { Ok((first, last, step)) }
}

fn wrong(text: &str, what: impl std::fmt::Display) -> Error {
    Error::Usage(format!("--frames {text}: {what} (as in 5, 0-59, 59-0, 0-59:2, 0,5,10-20:2)"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges() {
        for (text, frames) in [
            ("0", &[0][..]),
            ("2-4", &[2, 3, 4]),
            ("0-9:4", &[0, 4, 8]),
            ("0-9:100", &[0]),
            ("0,5,7-9:2", &[0, 5, 7, 9]),
            (" 1 , 3 - 4 ", &[1, 3, 4]),
            ("5,0-2", &[5, 0, 1, 2]),
            ("1,0-2,1", &[1, 0, 2]),
            ("9-9", &[9]),
            ("9-0:3", &[9, 6, 3, 0]),
            ("4-1", &[4, 3, 2, 1]),
            ("9-0:4", &[9, 5, 1]),
            ("3-1,0-4", &[3, 2, 1, 0, 4]),
        ] {
            assert_eq!(parse(text, 10).unwrap(), frames, "{text}");
        }
    }

    #[test]
    fn wrong_ranges_say_what_is_wrong() {
        for (text, what) in [
            ("", "a frame number is missing"),
            ("1,", "a frame number is missing"),
            ("-3", "a frame number is missing"),
            ("x", "\"x\" is no frame number"),
            ("1-2-3", "\"2-3\" is no frame number"),
            ("1:2", "has a step but no last frame"),
            ("0-4:0", "the step in \"0-4:0\" is 0"),
            ("10-4", "frame 10 is not there"),
            ("10", "frame 10 is not there: the scene has frames 0 to 9"),
            ("0-18446744073709551615", "is not there"),
            ("0-99999999999999999999", "is no frame number"),
        ] {
            let error = parse(text, 10).unwrap_err();
            assert_eq!(error.exit_status(), 2);
            assert!(error.to_string().contains(what), "{text}: {error}");
        }
    }

    #[test]
    fn even_steps() {
        for (frames, even) in [
            (&[3][..], Some(1)),
            (&[0, 1, 2], Some(1)),
            (&[0, 2, 4], Some(2)),
            (&[0, 2, 3], None),
            (&[2, 1], Some(1)),
            (&[9, 6, 3], Some(3)),
            (&[2, 1, 2], None),
        ] {
            assert_eq!(step(frames), even, "{frames:?}");
        }
    }
}
