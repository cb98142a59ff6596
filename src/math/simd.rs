//! The instructions of the processor, chosen once. The kernel of a step is compiled twice from the same source: for any
//! processor, and for those with vectors of four numbers and a fused multiply-add (AVX2 and FMA).

#[cfg(target_arch = "x86_64")]
use fearless_simd::Avx2;

/// Numbers that a kernel computes side by side.
pub const LANES: usize = 4;

/// What the kernel of a step is compiled for.
#[derive(Clone, Copy, Debug)]
pub enum Simd {
    /// Any processor.
    Portable,
    /// This one has AVX2 and FMA, which the token proves.
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
}

impl Simd {
    /// The best for this processor; any processor's where the feature `portable` is on.
    pub fn detect() -> Self {
        #[cfg(all(target_arch = "x86_64", not(feature = "portable")))]
        if let Some(token) = fearless_simd::Level::new().as_avx2() {
            return Self::Avx2(token);
        }
        Self::Portable
    }
}

/// The one operation that has to be asked for: the compiler never fuses on its own, and without the instruction
/// [`f64::mul_add`] is a slow library call.
pub trait Arithmetic {
    /// `a b + c`.
    fn mul_add(a: f64, b: f64, c: f64) -> f64;
}

/// Rounds twice.
#[derive(Clone, Copy, Debug)]
pub struct Separate;

/// Rounds once, by an instruction of its own.
#[derive(Clone, Copy, Debug)]
pub struct Fused;

impl Arithmetic for Separate {
    #[inline(always)]
    fn mul_add(a: f64, b: f64, c: f64) -> f64 {
        a * b + c
    }
}

impl Arithmetic for Fused {
    #[inline(always)]
    fn mul_add(a: f64, b: f64, c: f64) -> f64 {
        a.mul_add(b, c)
    }
}

/// `compiled_for!(simd, A => body)`: the body in the compilation for the simd, whose [`Arithmetic`] it knows as
/// `A`. Only what is inlined into the body is compiled for the simd.
macro_rules! compiled_for {
    ($simd:expr, $arithmetic:ident => $body:expr) => {
        match $simd {
            $crate::math::simd::Simd::Portable => {
                type $arithmetic = $crate::math::simd::Separate;
                $body
            }
            #[cfg(target_arch = "x86_64")]
            $crate::math::simd::Simd::Avx2(token) => fearless_simd::Simd::vectorize(
                token,
                #[inline(always)]
                || {
                    type $arithmetic = $crate::math::simd::Fused;
                    $body
                },
            ),
        }
    };
}

pub(crate) use compiled_for;
