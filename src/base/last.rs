//! What was made last, kept for whoever wants the same next.

use std::sync::{Arc, Mutex, PoisonError};

/// The last thing made, with what it was made of. Copies share it.
#[derive(Debug)]
pub struct Last<K, T>(Slot<K, T>);

type Slot<K, T> = Arc<Mutex<Option<(K, Arc<T>)>>>;

impl<K, T> Clone for Last<K, T> {
    fn clone(&self) -> Self {
        Last(self.0.clone())
    }
}

impl<K, T> Default for Last<K, T> {
    fn default() -> Self {
        Last(Arc::default())
    }
}

impl<K, T> Last<K, T> {
    /// What is kept if it `fits`; otherwise what is made now, which is kept under its key if it has one.
    ///
    /// Nothing is locked while it is made: what makes it may work on all cores, and a thread that waits for others there takes
    /// on work that may ask for the same. Two that ask at once make it twice.
    pub fn get(
        &self,
        fits: impl Fn(&K, &T) -> bool,
        make: impl FnOnce() -> T,
        key: impl FnOnce() -> Option<K>,
    ) -> Arc<T> {
        {
            let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            if let Some((_, made)) = kept.as_ref().filter(|(key, made)| fits(key, made)) {
                return made.clone();
            }
            *kept = None; // room for the next, before that is made
        }
        let made = Arc::new(make());
        if let Some(key) = key() {
            *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some((key, made.clone()));
        }
        made
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_fits_is_made_once_and_may_ask_for_others_meanwhile() {
        let last = Last::default();
        let of = |key: i32, keep: bool| last.get(|kept, _| *kept == key, || key * 10, || keep.then_some(key));
        assert_eq!(*of(1, true), 10);
        assert!(Arc::ptr_eq(&of(1, true), &of(1, true)));
        assert!(!Arc::ptr_eq(&of(2, false), &of(2, false)), "not kept");
        // With a lock held, this would wait forever.
        assert_eq!(*last.get(|_, _| false, || *of(3, true) + 1, || Some(4)), 31);
        assert_eq!(*of(4, true), 31);
    }
}
