//! A PNG file a frame, numbered by a pattern such as `%04d.png`. As many frames as there are threads are compressed at
//! once, so that memory stays bounded; the set appears in its folder when it is whole.

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::{Show, Sink};
use crate::base::error::{Error, Result};
use crate::base::pixels::Frame;
use crate::export::still;
use crate::files::draft::DraftFolder;

/// A file name with one frame number in it.
#[derive(Debug, PartialEq)]
pub struct Pattern {
    folder: PathBuf,
    before: String,
    digits: usize,
    after: String,
}

impl Pattern {
    /// The pattern in the file name of `path`: `%d`, or `%04d` for at least four digits; `%%` is a `%`. None where the
    /// name has no `%`.
    pub fn parse(path: &Path) -> Result<Option<Self>> {
        let wrong = |what: &str| Error::Usage(format!("{}: {what} (as in frame-%04d.png)", path.display()));
        let name = path.file_name().map(|n| n.to_string_lossy()).unwrap_or_default();
        let (mut texts, mut digits) = (vec![String::new()], None);
        let mut rest = name.chars();
        while let Some(c) = rest.next() {
            let last = texts.len() - 1;
            if c != '%' {
                texts[last].push(c);
                continue;
            }
            let mut spec = String::new();
            for c in rest.by_ref() {
                spec.push(c);
                if !c.is_ascii_digit() {
                    break;
                }
            }
            match spec.strip_suffix('d') {
                _ if spec == "%" => texts[last].push('%'),
                Some(_) if digits.is_some() => return Err(wrong("the name holds two frame numbers")),
                Some(width) => {
                    digits = Some(width.parse().unwrap_or(0).clamp(1, 20));
                    texts.push(String::new());
                }
                None => return Err(wrong(&format!("\"%{spec}\" is no frame number"))),
            }
        }
        let Some(digits) = digits else { return Ok(None) };
        let [before, after] = <[String; 2]>::try_from(texts).unwrap_or_default();
        if !after.to_lowercase().ends_with(".png") {
            return Err(wrong("numbered frames are PNG files and end in .png"));
        }
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Ok(Some(Pattern { folder: folder.to_path_buf(), before, digits, after }))
    }

    fn name(&self, number: u64) -> String {
        format!("{}{number:0digits$}{}", self.before, self.after, digits = self.digits)
    }
}

/// Begins a sequence.
pub fn begin(pattern: Pattern, show: Show) -> Result<Box<dyn Sink>> {
    if !pattern.folder.is_dir() {
        let error = Error::at(pattern.folder.display(), "the folder is not there");
        return Err(error.cure("make it first"));
    }
    let draft = DraftFolder::create(&pattern.folder)?;
    Ok(Box::new(Sequence { pattern, draft, show, waiting: Vec::new(), names: Vec::new() }))
}

struct Sequence {
    pattern: Pattern,
    draft: DraftFolder,
    show: Show,
    waiting: Vec<(String, Frame)>,
    names: Vec<String>,
}

impl Sequence {
    fn write(&mut self) -> Result<()> {
        let (draft, show) = (&self.draft, &self.show);
        let write = |(name, frame): &(String, Frame)| {
            let bytes = still::frame(frame).map_err(|e| show.failed(e))?;
            draft.write(name, &bytes)
        };
        self.waiting.par_iter().map(write).collect::<Result<()>>()?;
        self.names.extend(self.waiting.drain(..).map(|(name, _)| name));
        Ok(())
    }
}

impl Sink for Sequence {
    fn frame(&mut self, number: u64, frame: Frame) -> Result<()> {
        self.waiting.push((self.pattern.name(number), frame));
        if self.waiting.len() >= rayon::current_num_threads() { self.write() } else { Ok(()) }
    }

    fn finish(mut self: Box<Self>) -> Result<Vec<String>> {
        self.write()?;
        self.draft.keep(&self.names)?;
        Ok(Vec::new())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns() {
        for (path, number, name) in [
            ("%04d.png", 7, "0007.png"),
            ("out/a-%d.PNG", 12, "a-12.PNG"),
            ("100%%-%3d.png", 5, "100%-005.png"),
            ("%02d.png", 12345, "12345.png"),
        ] {
            assert_eq!(Pattern::parse(Path::new(path)).unwrap().unwrap().name(number), name);
        }
        assert_eq!(Pattern::parse(Path::new("a.gif")).unwrap(), None);
        assert_eq!(Pattern::parse(Path::new("100%%.png")).unwrap(), None);
    }

    #[test]
    fn wrong_patterns_say_what_is_wrong() {
        for (path, what) in [
            ("%04x.png", "\"%04x\" is no frame number"),
            ("%.png", "\"%.\" is no frame number"),
            ("%d-%d.png", "two frame numbers"),
            ("%04d.gif", "end in .png"),
            ("50%", "\"%\" is no frame number"),
        ] {
            let error = Pattern::parse(Path::new(path)).unwrap_err().to_string();
            assert!(error.contains(what), "{path}: {error}");
        }
    }
}
