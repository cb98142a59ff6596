//! Power series of the motion in a step: how many terms they have.

/// Most terms of a power series: `7^n / n!` is below rounding from there on. Pinned: ÷ 4,
/// `responses_agree_with_quadrature_in_every_regime`.
pub const TERMS: usize = 48;

/// Terms of a power series below this are left out, 1. A thousandth of rounding. Pinned: × 1e10,
/// `responses_agree_with_quadrature_in_every_regime`.
pub const NEGLIGIBLE: f64 = 1e-19;
