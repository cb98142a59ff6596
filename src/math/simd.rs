//! Instruction set, selected once. The kernel of a step is compiled twice from the same source: for the generic
//! processor, and for processors with vectors of four numbers and fused multiply-add (AVX2 and FMA).

#[cfg(target_arch = "x86_64")]
use fearless_simd::Avx2;

/// Width of the vectors of a kernel.
pub const LANES: usize = 4;

/// Instruction set of the kernel of a step.
#[derive(Clone, Copy, Debug)]
pub enum Simd {
    Portable,
    /// AVX2 and FMA; the token proves that the processor has them.
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
}

impl Simd {
    /// The best for this processor; generic with the feature `portable`.
    pub fn detect() -> Self {
        #[cfg(all(target_arch = "x86_64", not(feature = "portable")))]
        if let Some(token) = fearless_simd::Level::new().as_avx2() {
            return Self::Avx2(token);
        }
        Self::Portable
    }
}

/// Multiply-add, the one operation to be chosen explicitly: the compiler never fuses on its own, and without the
/// instruction [`f64::mul_add`] is a slow library call.
pub trait Arithmetic {
    /// `a b + c`.
    fn mul_add(a: f64, b: f64, c: f64) -> f64;
}

/// Separate multiplication and addition: rounds twice.
#[derive(Clone, Copy, Debug)]
pub struct Separate;

/// Fused multiply-add: rounds once.
#[cfg(any(target_arch = "x86_64", test))]
#[derive(Clone, Copy, Debug)]
pub struct Fused;

impl Arithmetic for Separate {
    #[inline(always)]
    fn mul_add(a: f64, b: f64, c: f64) -> f64 {
        a * b + c
    }
}

#[cfg(any(target_arch = "x86_64", test))]
impl Arithmetic for Fused {
    #[inline(always)]
    fn mul_add(a: f64, b: f64, c: f64) -> f64 {
        a.mul_add(b, c)
    }
}

/// `compiled_for!(simd, A => body)`: evaluates the body compiled for the instruction set `simd`, with its
/// [`Arithmetic`] as
/// `A`. Only functions inlined into the body are compiled for it.
macro_rules! compiled_for {
    ($simd:expr, $arithmetic:ident => $body:expr) => {
        match $simd {
            $crate::math::simd::Simd::Portable => {
                type $arithmetic = $crate::math::simd::Separate;
                // A frame of its own, as the other compilation has: the stack holds one of them.
                $crate::math::simd::apart(
                    #[inline(always)]
                    || $body,
                )
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

#[inline(never)]
pub(crate) fn apart<R>(function: impl FnOnce() -> R) -> R {
    function()
}

pub(crate) use compiled_for;
