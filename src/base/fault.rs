//! Faults of our own. A panic ends what was being done and nothing more: whatever starts work on a thread catches the panic
//! at the border of that work, reports it, and goes on. Only a panic of the main thread ends the process.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Does `work`; a panic becomes an error. What the work was changing may be half changed: throw it away.
///
/// # Errors
/// The panic, in one line.
pub fn caught<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|payload| told(&*payload))
}

/// A panic in one line.
pub fn told(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("no reason is known");
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    format!("a fault of its own: {line} (see the log)")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_a_line() {
        assert_eq!(caught(|| 5), Ok(5));
        let of = |work: fn()| caught(work).unwrap_err();
        assert_eq!(of(|| panic!("two\n  lines")), "a fault of its own: two lines (see the log)");
        assert_eq!(of(|| panic!("number {}", 7)), "a fault of its own: number 7 (see the log)");
        assert!(of(|| std::panic::panic_any(7)).contains("no reason is known"));
    }
}
