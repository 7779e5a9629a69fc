//! Plain loops for the widest vectors that the processor has.

/// Runs `work`, compiled for AVX2 where the processor has it. The bits are those that it gives elsewhere: the compiler
/// never fuses a product and a sum. What `work` calls is compiled for the same vectors only if it is inlined.
#[inline(always)]
pub fn vectorised<R>(work: impl FnOnce() -> R) -> R {
    pulp::Arch::new().dispatch(work)
}
