//! Files of a scene on another machine: which are wanted, which are here, which pieces are asked for. A piece is asked for
//! only while the link bears it, so that an edit has at most a piece or two before it on a slow one.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::base::error::Result;
use crate::base::text;
use crate::files::cache::{Cache, Incoming, MOST_FILES};
use crate::files::materials::Copies;
use crate::files::originals::{Contents, Original, PIECE};
use crate::preview::wire::message::ToEditor;

/// The copies, shared with the code that loads them.
pub type Shared = Arc<Mutex<Copies>>;

/// See the top of the file.
pub(super) struct Fetch {
    cache: Cache,
    copies: Shared,
    /// The most bytes of a file.
    most: u64,
    /// What is not here yet: contents, and the paths that have them.
    missing: BTreeMap<String, (Contents, Vec<String>)>,
    /// What is here, by path, by hash.
    have: BTreeMap<String, String>,
    incoming: Option<Incoming>,
    asked: u64,
    /// When each piece was requested that has not arrived.
    in_flight: VecDeque<Instant>,
    pace: Pace,
    /// Whether a list of the scene's files ever arrived.
    told: bool,
}

impl Fetch {
    pub fn new(cache: Cache, copies: Shared, most: u64) -> Fetch {
        Fetch {
            cache,
            copies,
            most,
            missing: BTreeMap::new(),
            have: BTreeMap::new(),
            incoming: None,
            asked: 0,
            in_flight: VecDeque::new(),
            pace: Pace::default(),
            told: false,
        }
    }

    /// Takes what the scene names now. Files that are here already are available at once; returns whether that changed
    /// anything.
    pub fn told(&mut self, originals: Vec<Original>) -> bool {
        self.told = true;
        self.missing.clear();
        let mut copies = self.copies.lock().unwrap_or_else(PoisonError::into_inner);
        let before = copies.clone();
        // All that one scene names is kept at once: together it must fit too.
        let mut counted = BTreeMap::new();
        let named: BTreeSet<&str> = originals.iter().map(|one| one.path.as_str()).collect();
        copies.retain(|path, _| named.contains(path.as_str()));
        self.have.retain(|path, _| named.contains(path.as_str()));
        for Original { path, file } in originals {
            let problem = match file {
                Err(why) => why,
                Ok(contents) if contents.bytes > self.most => {
                    format!(
                        "is {} long, at most {} are allowed (give --limit memory=BYTES)",
                        text::bytes(contents.bytes),
                        text::bytes(self.most)
                    )
                }
                Ok(contents) if !fits(&mut counted, &contents, self.cache.most()) => {
                    format!(
                        "the scene's files are more than {MOST_FILES}, or more than {} together (give --limit cache=BYTES)",
                        text::bytes(self.cache.most())
                    )
                }
                Ok(contents) if self.have.get(&path) == Some(&contents.hash) => continue,
                Ok(contents) => match self.cache.find(&contents) {
                    Some(copy) => {
                        self.have.insert(path.clone(), contents.hash);
                        copies.insert(path, Ok(copy));
                        continue;
                    }
                    None => {
                        let entry = self.missing.entry(contents.hash.clone()).or_insert((contents, Vec::new()));
                        entry.1.push(path.clone());
                        // A clip is as long as there are frames of it, here or on their way.
                        copies.entry(path).or_insert_with(|| Err("is not here yet".into()));
                        continue;
                    }
                },
            };
            self.have.remove(&path);
            copies.insert(path, Err(problem));
        }
        let stale = |incoming: &Incoming| !self.missing.contains_key(&incoming.wanted().hash);
        let changed = *copies != before;
        drop(copies);
        if self.incoming.as_ref().is_some_and(stale) {
            self.incoming = None;
        }
        changed
    }

    /// Whether every file that the scene names is here, or is known not to come.
    pub fn is_settled(&self) -> bool {
        self.told && self.missing.is_empty()
    }

    /// The connection was lost: pieces on their way are too.
    pub fn lost(&mut self) {
        self.in_flight.clear();
        self.asked = self.incoming.as_ref().map_or(0, Incoming::have);
        self.pace = Pace::default();
    }

    /// What to ask for now.
    ///
    /// # Errors
    /// The cache cannot be written.
    pub fn wants(&mut self, now: Instant) -> Result<Vec<ToEditor>> {
        let mut wants = Vec::new();
        if self.incoming.is_none() {
            // Pieces of what was given up are still to come and to be passed over.
            let Some((contents, _)) = self.missing.values().next().filter(|_| self.in_flight.is_empty()) else {
                return Ok(wants);
            };
            self.incoming = Some(self.cache.begin(contents)?);
            self.asked = 0;
        }
        let Some(incoming) = &self.incoming else { return Ok(wants) };
        let Contents { hash, bytes } = incoming.wanted();
        // An empty file has one piece too: the one that ends it.
        while self.in_flight.len() < self.pace.credit
            && (self.asked < *bytes || (*bytes == 0 && self.in_flight.is_empty()))
        {
            wants.push(ToEditor::Want { hash: hash.clone(), offset: self.asked });
            self.asked += PIECE as u64;
            self.in_flight.push_back(now);
        }
        Ok(wants)
    }

    /// Takes a piece; returns whether it completed a file.
    ///
    /// # Errors
    /// It cannot be written, or the whole file is not the one announced. It is not requested again until it is announced
    /// again.
    pub fn piece(&mut self, hash: &str, offset: u64, bytes: &[u8], now: Instant) -> Result<bool> {
        if let Some(asked) = self.in_flight.pop_front() {
            self.pace.arrived(now.saturating_duration_since(asked));
        }
        let fits = |incoming: &&mut Incoming| incoming.wanted().hash == hash && incoming.have() == offset;
        let Some(incoming) = self.incoming.as_mut().filter(fits) else { return Ok(false) };
        let whole = incoming.wanted().bytes;
        let taken = incoming.add(bytes);
        if taken.is_ok() && incoming.have() < whole {
            if bytes.is_empty() {
                // The file is gone; what takes its place will be announced.
                self.give_up(hash);
            }
            return Ok(false);
        }
        let Some(incoming) = self.incoming.take() else { return Ok(false) };
        let Some((_, paths)) = self.missing.remove(hash) else { return Ok(false) };
        let copy = taken.and_then(|()| incoming.finish());
        let mut copies = self.copies.lock().unwrap_or_else(PoisonError::into_inner);
        for path in paths {
            match &copy {
                Ok(copy) => {
                    self.have.insert(path.clone(), hash.to_owned());
                    copies.insert(path, Ok(copy.clone()));
                }
                Err(error) => {
                    let copy = copies.entry(path).or_insert_with(|| Err(String::new()));
                    *copy = copy.clone().map_err(|_| error.to_string());
                }
            }
        }
        self.cache.trim(&self.have.values().cloned().collect());
        copy.map(|_| true)
    }

    fn give_up(&mut self, hash: &str) {
        self.incoming = None;
        self.missing.remove(hash);
    }

    /// How far it is, for the person; `None` if nothing is on its way.
    pub fn progress(&self) -> Option<String> {
        let incoming = self.incoming.as_ref()?;
        let Contents { hash, bytes } = incoming.wanted();
        let path = self.missing.get(hash)?.1.first()?;
        let percent = incoming.have() * 100 / (*bytes).max(1);
        Some(format!("fetching {path}: {percent} % of {}", text::bytes(*bytes)))
    }
}

/// Counts a file, each once, unless there are too many or they are too large together.
fn fits(counted: &mut BTreeMap<String, u64>, contents: &Contents, most: u64) -> bool {
    let before: u64 = counted.values().sum();
    let more = counted.len() < MOST_FILES && before.checked_add(contents.bytes).is_some_and(|all| all <= most);
    let fits = counted.contains_key(&contents.hash) || more;
    if fits {
        counted.entry(contents.hash.clone()).or_insert(contents.bytes);
    }
    fits
}

/// How many pieces may be on their way: more while they come as fast as the first did, fewer once they wait for one another.
#[derive(Debug)]
struct Pace {
    credit: usize,
    fastest: Duration,
}

impl Pace {
    /// 512 KiB on their way fill any link worth filling.
    const MOST: usize = 64;
    const SHORT: Duration = Duration::from_millis(100);
    const LONG: Duration = Duration::from_millis(200);

    /// A piece came, this long after it was asked for.
    fn arrived(&mut self, after: Duration) {
        self.fastest = self.fastest.min(after);
        let waited = after.saturating_sub(self.fastest);
        if waited < Pace::SHORT {
            self.credit = (self.credit + 1).min(Pace::MOST);
        } else if waited > Pace::LONG {
            self.credit = (self.credit - 1).max(1);
        }
    }
}

impl Default for Pace {
    fn default() -> Self {
        Pace { credit: 1, fastest: Duration::MAX }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::hash;

    /// A link of this many bytes a second and this delay, played in its own time: how long all takes, and the most pieces
    /// that an edit would have before it.
    fn play(bytes: u64, rate: f64, delay: Duration) -> (Duration, usize) {
        let folder = tempfile::tempdir().unwrap();
        let content = vec![7; bytes as usize];
        let mut fetch = Fetch::new(Cache::at(folder.path().into(), u64::MAX).unwrap(), Shared::default(), u64::MAX);
        let contents = Contents { hash: hash::of(&content), bytes };
        let told = |path: &str| Original { path: path.into(), file: Ok(contents.clone()) };
        fetch.told(vec![told("a.png"), told("b.png")]);
        let began = Instant::now();
        let (mut now, mut free, mut most) = (began, began, 0);
        let mut queue = VecDeque::new();
        while !fetch.is_settled() {
            for want in fetch.wants(now).unwrap() {
                let ToEditor::Want { offset, .. } = want else { panic!("{want:?}") };
                let length = PIECE.min((bytes - offset) as usize);
                free = free.max(now + delay / 2) + Duration::from_secs_f64(length as f64 / rate);
                queue.push_back((free + delay / 2, offset, length));
            }
            let waiting = free.saturating_duration_since(now).as_secs_f64() * rate / PIECE as f64;
            most = most.max(waiting.ceil() as usize);
            let (at, offset, length) = queue.pop_front().unwrap();
            now = at;
            fetch.piece(&contents.hash, offset, &content[..length], now).unwrap();
        }
        let copies = fetch.copies.lock().unwrap().clone();
        assert!(
            copies["a.png"] == copies["b.png"] && std::fs::read(copies["a.png"].as_ref().unwrap()).unwrap() == content
        );
        (now - began, most)
    }

    #[test]
    fn a_slow_link_stays_free_for_edits_and_a_fast_one_is_filled() {
        let (_, waiting) = play(400_000, 20e3, Duration::from_millis(50));
        assert!(waiting <= 3, "{waiting} pieces on a link of 20 kB/s");
        let (took, _) = play(40_000_000, 10e6, Duration::from_millis(20));
        assert!(took < Duration::from_secs(6), "{took:?} for 4 s worth of bytes");
        let (took, _) = play(4_000_000, 10e6, Duration::from_millis(200));
        assert!(took < Duration::from_secs(6), "{took:?} far away");
    }

    #[test]
    fn all_files_of_a_scene_fit_together() {
        let folder = tempfile::tempdir().unwrap();
        let mut fetch = Fetch::new(Cache::at(folder.path().into(), 10).unwrap(), Shared::default(), 100);
        let told = |path: &str, content: &[u8]| Original {
            path: path.into(),
            file: Ok(Contents { hash: hash::of(content), bytes: content.len() as u64 }),
        };
        fetch.told(vec![told("a", b"123456"), told("b", b"123456"), told("c", b"78901"), told("d", b"2345")]);
        assert_eq!(fetch.missing.len(), 2, "a is b; c is too much; d fits again");
        let copies = fetch.copies.lock().unwrap().clone();
        let why = |path: &str| copies[path].as_ref().unwrap_err().as_str();
        assert_eq!(["a", "b", "d"].map(why), ["is not here yet"; 3], "all that the scene names is listed");
        assert!(why("c").contains("--limit cache"));
    }

    #[test]
    fn what_is_told_decides() {
        let folder = tempfile::tempdir().unwrap();
        let mut fetch = Fetch::new(Cache::at(folder.path().into(), u64::MAX).unwrap(), Shared::default(), 100);
        let told = |path: &str, content: &[u8]| Original {
            path: path.into(),
            file: Ok(Contents { hash: hash::of(content), bytes: content.len() as u64 }),
        };
        let now = Instant::now();
        assert!(!fetch.is_settled(), "nothing was told yet");
        fetch.told(vec![]);
        assert!(fetch.is_settled());
        fetch.told(vec![
            Original { path: "gone".into(), file: Err("no such file".into()) },
            told("huge", &[0; 101]),
            told("a", b"abc"),
        ]);
        assert_eq!(fetch.wants(now).unwrap().len(), 1);
        assert!(fetch.progress().unwrap().contains("fetching a: 0 %"));
        // Saved again meanwhile: the old piece is passed over, the new file asked for once it has come.
        fetch.told(vec![told("a", b"new")]);
        assert!(fetch.wants(now).unwrap().is_empty());
        assert!(!fetch.piece(&hash::of(b"abc"), 0, b"abc", now).unwrap());
        assert_eq!(fetch.wants(now).unwrap(), [ToEditor::Want { hash: hash::of(b"new"), offset: 0 }]);
        // Lost, told again, and wrong.
        fetch.lost();
        fetch.told(vec![told("a", b"new")]);
        assert_eq!(fetch.wants(now).unwrap().len(), 1);
        assert!(fetch.piece(&hash::of(b"new"), 0, b"not", now).is_err());
        assert!(fetch.is_settled(), "not asked for again");
        fetch.told(vec![told("a", b"new"), told("empty", b"")]);
        for _ in 0..2 {
            let wants = fetch.wants(now).unwrap();
            let [ToEditor::Want { hash: wanted, .. }] = &wants[..] else { panic!("{wants:?}") };
            let content: &[u8] = if *wanted == hash::of(b"") { b"" } else { b"new" };
            assert!(fetch.piece(wanted, 0, content, now).unwrap());
        }
        assert!(fetch.is_settled());
        let again = Fetch::new(fetch.cache.clone(), Shared::default(), 100).told(vec![told("other", b"new")]);
        assert!(again, "what is in the cache is here at once");
    }
}
