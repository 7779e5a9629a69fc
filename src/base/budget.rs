//! The memory that work may take, counted before it is taken and in sum: pictures, vector fields, equations and frames of
//! one piece of work share one [`Budget`]. What is taken is a [`Share`], which gives it back when it is dropped, so that
//! nothing is counted longer than it is kept.

use std::fmt::Display;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::error::{Error, Result};
use super::problem::Problem;

/// How many bytes may be kept at once; copies count together. The default has no bound.
#[derive(Clone, Debug, Default)]
pub struct Budget(Option<Arc<Account>>);

#[derive(Debug)]
struct Account {
    most: u64,
    taken: AtomicU64,
}

/// Bytes taken from a budget, given back when this is dropped.
#[derive(Debug, Default)]
#[must_use = "the bytes are given back when this is dropped"]
pub struct Share {
    account: Option<Arc<Account>>,
    bytes: u64,
}

/// More was asked for than is left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Short {
    wanted: u64,
    /// Whether it may turn out that less is needed.
    at_most: bool,
    taken: u64,
    most: u64,
}

impl Budget {
    /// A budget of `most` bytes.
    pub fn new(most: u64) -> Self {
        Budget(Some(Arc::new(Account { most, taken: AtomicU64::new(0) })))
    }

    /// Takes `bytes` for `place` (a file, an option), to be kept as long as the share is.
    ///
    /// # Errors
    /// When more would be kept than the budget allows; the message names `place` and the cure.
    pub fn take(&self, bytes: u64, place: impl Display) -> Result<Share> {
        self.try_take(bytes).map_err(|short| short.at(place))
    }

    /// As [`Budget::take`], for callers that can name a better place.
    ///
    /// # Errors
    /// When more would be kept than the budget allows.
    pub fn try_take(&self, bytes: u64) -> std::result::Result<Share, Short> {
        let Some(account) = &self.0 else { return Ok(Share::default()) };
        let sum = |taken: u64| taken.checked_add(bytes).filter(|&sum| sum <= account.most);
        match account.taken.fetch_update(Ordering::Relaxed, Ordering::Relaxed, sum) {
            Ok(_) => Ok(Share { account: Some(account.clone()), bytes }),
            Err(taken) => Err(Short { wanted: bytes, at_most: false, taken, most: account.most }),
        }
    }

    /// Bytes that may still be taken.
    pub fn left(&self) -> u64 {
        self.0.as_ref().map_or(u64::MAX, |account| account.most.saturating_sub(self.taken()))
    }

    /// Bytes kept now.
    pub fn taken(&self) -> u64 {
        self.0.as_ref().map_or(0, |account| account.taken.load(Ordering::Relaxed))
    }
}

impl Share {
    /// Both as one; they are of one budget.
    pub fn and(mut self, mut other: Share) -> Share {
        self.bytes += std::mem::take(&mut other.bytes);
        self
    }

    /// Keeps only `bytes` of it, if that is less: what was needed on the way is given back.
    pub fn shrink(&mut self, bytes: u64) {
        let less = self.bytes.saturating_sub(bytes);
        self.bytes -= less;
        if let Some(account) = &self.account {
            account.taken.fetch_sub(less, Ordering::Relaxed);
        }
    }
}

impl Drop for Share {
    fn drop(&mut self) {
        self.shrink(0);
    }
}

impl Short {
    /// The same where then up to so many bytes are needed.
    pub fn then(self, bytes: u64) -> Short {
        if bytes > self.wanted { Short { wanted: bytes, at_most: true, ..self } } else { self }
    }

    /// As an error about a file or an option.
    pub fn at(self, place: impl Display) -> Error {
        Error::at(place, self.what()).cure(self.cure())
    }

    /// As a problem at a place in the scene.
    pub fn problem(self, path: impl Into<String>) -> Problem {
        Problem::error(path, self.what()).hint(self.cure())
    }

    /// The same; `smaller` is how to make it smaller.
    pub fn problem_of(self, path: impl Into<String>, smaller: &str) -> Problem {
        Problem::error(path, self.what()).hint(self.cure_or(smaller))
    }

    /// How many bytes are left.
    pub fn left(&self) -> u64 {
        self.most.saturating_sub(self.taken)
    }

    fn what(self) -> String {
        let besides = if self.taken > 0 { format!(" besides {} in use", size(self.taken)) } else { String::new() };
        let up_to = if self.at_most { "up to " } else { "" };
        let [wanted, most] = [self.wanted, self.most].map(size);
        format!("needs {up_to}{wanted} of memory{besides}, and at most {most} are allowed")
    }

    fn cure(self) -> String {
        self.cure_or("make it smaller")
    }

    fn cure_or(self, smaller: &str) -> String {
        const MIB: u64 = 1 << 20;
        const GIB: u64 = 1 << 30;
        let enough = self.wanted.saturating_add(self.taken);
        let (unit, letter) = if enough < 4 * GIB { (MIB, 'M') } else { (GIB, 'G') };
        format!("{smaller}, or give --limit memory={}{letter}", enough.div_ceil(unit))
    }
}

/// A number of bytes in the unit that leaves two or three digits.
pub fn size(bytes: u64) -> String {
    const UNITS: [(u32, &str); 3] = [(30, "GiB"), (20, "MiB"), (10, "KiB")];
    match UNITS.iter().find(|(shift, _)| bytes >> shift >= 1) {
        Some((shift, unit)) => {
            let whole = bytes as f64 / (1_u64 << shift) as f64;
            if whole < 10.0 { format!("{whole:.1} {unit}") } else { format!("{whole:.0} {unit}") }
        }
        None => format!("{bytes} bytes"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_counts_in_sum_and_no_longer() {
        let budget = Budget::new(100);
        let first = budget.take(60, "a").unwrap();
        let refused = budget.clone().take(41, "b.png").unwrap_err().to_string();
        assert_eq!(
            refused,
            "b.png: needs 41 bytes of memory besides 60 bytes in use, and at most 100 bytes are allowed \
             (make it smaller, or give --limit memory=1M)"
        );
        let mut second = budget.take(40, "b").unwrap();
        drop(first);
        assert_eq!(budget.taken(), 40);
        second.shrink(10);
        second.shrink(30);
        assert_eq!(budget.taken(), 10);
        assert!(budget.take(u64::MAX, "c").is_err() && budget.take(91, "c").is_err());
        let both = second.and(budget.take(20, "d").unwrap());
        assert_eq!(budget.taken(), 30);
        drop(both);
        assert_eq!(budget.taken(), 0);
        for (bytes, enough) in
            [(1 << 20, "memory=1M"), (18_900_000, "memory=19M"), (3 << 30, "=3072M"), (5 << 30, "=5G")]
        {
            let problem = budget.try_take(bytes).unwrap_err().problem("/layers/0");
            assert_eq!(problem.path, "/layers/0");
            assert!(problem.hint.unwrap().ends_with(enough), "{enough}");
        }
    }

    #[test]
    fn no_budget_is_no_bound() {
        let budget = Budget::default();
        let _much = budget.take(u64::MAX, "a").unwrap();
        assert!(budget.take(u64::MAX, "b").is_ok());
        assert_eq!(budget.taken(), 0);
    }

    #[test]
    fn sizes_are_read_at_a_glance() {
        for (bytes, text) in [
            (0, "0 bytes"),
            (1023, "1023 bytes"),
            (1024, "1.0 KiB"),
            (10 << 20, "10 MiB"),
            (4 << 30, "4.0 GiB"),
            (80_097_629_696, "75 GiB"),
        ] {
            assert_eq!(size(bytes), text);
        }
    }
}
