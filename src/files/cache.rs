//! Files of scenes on other machines, kept in the user's cache by content hash, so that nothing is transferred twice. A
//! file is checked against its hash before it is used; the least recently used are evicted when the cache grows too
//! large.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use sha2::{Digest, Sha256};

use super::hash::{Contents, contents};
use super::write::Atomic;
use super::{Limits, paths, temporary};
use crate::base::error::{Error, Result};
use crate::base::system::folders;
use crate::base::text::hex;

/// The most files in the cache, and the most that one scene may name.
pub const MOST_FILES: usize = 4096;

/// A folder of files named by their hash.
#[derive(Clone, Debug)]
pub struct Cache {
    folder: PathBuf,
    most: u64,
}

impl Cache {
    /// The user's cache: `plica/images` in the cache folder.
    ///
    /// # Errors
    /// If there is no home, or the folder cannot be created.
    pub fn of_user(limits: &Limits) -> Result<Cache> {
        let folder =
            folders::cache().ok_or_else(|| Error::at("cache", "there is no home").cure("set XDG_CACHE_HOME"))?;
        Cache::at(folder.join("images"), limits.cache)
    }

    /// A cache in `folder`, of at most `most` bytes.
    ///
    /// # Errors
    /// If the folder cannot be created.
    pub fn at(folder: PathBuf, most: u64) -> Result<Cache> {
        fs::create_dir_all(&folder)
            .map_err(|error| Error::at(folder.display(), error).cure("set XDG_CACHE_HOME to a folder of yours"))?;
        temporary::remove_stale(&folder);
        Ok(Cache { folder, most })
    }

    /// The file with these contents, if it is in the cache and intact; a damaged one is removed.
    pub fn find(&self, wanted: &Contents) -> Option<PathBuf> {
        let path = self.path(&wanted.hash)?;
        let mut file = paths::open_named(&path).ok()?;
        if contents(&mut file).ok().as_ref() != Some(wanted) {
            // It will be transferred again; if it cannot be removed now, it is replaced then.
            drop(fs::remove_file(&path));
            return None;
        }
        // The modification time is when it was last used; if it cannot be set, the file is only evicted earlier.
        drop(File::options().write(true).open(&path).and_then(|file| file.set_modified(SystemTime::now())));
        Some(path)
    }

    /// Begins to receive a file.
    ///
    /// # Errors
    /// If the hash is not a hash, or the folder cannot be written.
    pub fn begin(&self, wanted: &Contents) -> Result<Incoming> {
        let path = self.path(&wanted.hash).ok_or_else(|| Error::at("link", "an invalid hash"))?;
        Ok(Incoming { file: Atomic::create(&path)?, path, wanted: wanted.clone(), hash: Sha256::new(), have: 0 })
    }

    /// The most bytes in the cache.
    pub fn most(&self) -> u64 {
        self.most
    }

    /// Evicts the least recently used files until the rest fits; those in `used` (hashes) stay.
    pub fn trim(&self, used: &BTreeSet<String>) {
        let entries = fs::read_dir(&self.folder).into_iter().flatten().flatten();
        let mut files: Vec<_> = entries
            .filter_map(|entry| {
                let found = entry.metadata().ok().filter(fs::Metadata::is_file)?;
                Some((found.modified().ok()?, found.len(), entry.path()))
            })
            .collect();
        files.sort();
        let (mut all, mut count) = (files.iter().map(|(_, bytes, _)| bytes).sum::<u64>(), files.len());
        let unused = |path: &Path| !path.file_name().is_some_and(|name| used.contains(&*name.to_string_lossy()));
        for (_, bytes, path) in files.iter().filter(|(_, _, path)| unused(path)) {
            if all <= self.most && count <= MOST_FILES {
                return;
            }
            // Another window may have removed it already.
            drop(fs::remove_file(path));
            (all, count) = (all - bytes, count - 1);
        }
    }

    fn path(&self, hash: &str) -> Option<PathBuf> {
        let is_hash = hash.len() == 64 && hash.bytes().all(|b| b.is_ascii_digit() || (b'a'..=b'f').contains(&b));
        is_hash.then(|| self.folder.join(hash))
    }
}

/// A file being received, piece by piece. If dropped before it is complete, it leaves nothing behind.
#[derive(Debug)]
pub struct Incoming {
    file: Atomic,
    path: PathBuf,
    wanted: Contents,
    hash: Sha256,
    have: u64,
}

impl Incoming {
    /// The contents that it should have.
    pub fn wanted(&self) -> &Contents {
        &self.wanted
    }

    /// How many bytes have been received.
    pub fn have(&self) -> u64 {
        self.have
    }

    /// Adds the next bytes.
    ///
    /// # Errors
    /// If there are more than announced, or they cannot be written.
    pub fn add(&mut self, bytes: &[u8]) -> Result<()> {
        self.have += bytes.len() as u64;
        if self.have > self.wanted.bytes {
            return Err(Error::at("link", "the file is longer than announced"));
        }
        self.hash.update(bytes);
        self.file.write_all(bytes).map_err(|error| Error::at(self.path.display(), error))
    }

    /// Checks the whole file and moves it into place.
    ///
    /// # Errors
    /// If it is not what was announced, or cannot be written.
    pub fn finish(self) -> Result<PathBuf> {
        if hex(&self.hash.finalize()) != self.wanted.hash {
            return Err(Error::at("link", "a file that is not what was announced"));
        }
        self.file.commit()?;
        Ok(self.path)
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::files::hash;

    fn told(bytes: &[u8]) -> Contents {
        Contents { hash: hash::of(bytes), bytes: bytes.len() as u64 }
    }

    fn keep(cache: &Cache, bytes: &[u8]) -> PathBuf {
        let mut incoming = cache.begin(&told(bytes)).unwrap();
        bytes.chunks(3).for_each(|piece| incoming.add(piece).unwrap());
        incoming.finish().unwrap()
    }

    #[test]
    fn what_is_whole_is_found_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::at(folder.path().join("plica/images"), 1 << 30).unwrap();
        assert_eq!(cache.find(&told(b"cat")), None);
        let path = keep(&cache, b"cat");
        assert_eq!(cache.find(&told(b"cat")), Some(path.clone()));
        fs::write(&path, "dog").unwrap();
        assert_eq!(cache.find(&told(b"cat")), None, "changed");
        assert!(!path.exists());
        drop(cache.begin(&told(b"half")));
        let mut wrong = cache.begin(&told(b"right")).unwrap();
        wrong.add(b"wrong").unwrap();
        assert!(wrong.finish().is_err());
        assert!(cache.begin(&told(b"short")).unwrap().add(b"longer").is_err());
        assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 0, "nothing half done stays");
        for hash in ["", "../../../etc/passwd", "ABCDEF", &"g".repeat(64)] {
            let told = Contents { hash: hash.to_owned(), bytes: 1 };
            assert!(cache.begin(&told).is_err() && cache.find(&told).is_none(), "{hash}");
        }
    }

    #[test]
    fn files_are_counted_too() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::at(folder.path().to_owned(), u64::MAX).unwrap();
        (0..MOST_FILES + 3).for_each(|i| fs::write(folder.path().join(i.to_string()), "").unwrap());
        cache.trim(&BTreeSet::new());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), MOST_FILES);
    }

    #[test]
    fn the_least_recently_used_go_first() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::at(folder.path().to_owned(), 8).unwrap();
        let paths: Vec<_> = [b"aaaa", b"bbbb", b"cccc"].map(|bytes| keep(&cache, bytes)).into();
        for (age, path) in paths.iter().enumerate() {
            let time = SystemTime::now() - Duration::from_secs(100 - age as u64);
            File::options().write(true).open(path).unwrap().set_modified(time).unwrap();
        }
        cache.find(&told(b"aaaa")).unwrap();
        cache.trim(&BTreeSet::new());
        assert_eq!(paths.iter().map(|path| path.exists()).collect::<Vec<_>>(), [true, false, true]);
        keep(&cache, b"dddd");
        cache.trim(&[hash::of(b"cccc"), hash::of(b"dddd")].into());
        assert_eq!(paths.iter().map(|path| path.exists()).collect::<Vec<_>>(), [false, false, true]);
    }
}
