//! Vector instructions, chosen when the program runs.

/// Does `work` with the widest vectors of the processor. It is plain Rust, compiled once for each kind of processor:
/// products and sums are never fused, so that the bits are those of one number at a time. What it calls in its loops must
/// be inlined, and so must it: write `#[inline(always)]` before the closure.
#[inline(always)]
pub fn simd<R>(work: impl FnOnce() -> R) -> R {
    pulp::Arch::new().dispatch(work)
}
