//! Noise: numbers without a pattern, for tests.

/// Numbers between 0 and 1, always the same ones.
pub(super) fn noise() -> impl FnMut() -> f64 {
    let mut state = 1_u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}
