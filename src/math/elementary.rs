//! Exponential, sine and cosine of several numbers side by side, for vector arithmetic: without a branch on one of them.

use crate::math::simd::Arithmetic;

/// Added to a number below 2^51, it leaves its nearest integer in the last bits.
const NEAREST: f64 = 1.5 * (1_u64 << 52) as f64;

/// ln 2 and pi / 2 as sums of which the products with integers of up to 20 bits are exact but for the last one
/// (W. J. Cody, W. Waite, Software Manual for the Elementary Functions, 1980; digits of fdlibm, Sun Microsystems, 1993).
const LN_2: [f64; 2] = [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10];
const HALF_PI: [f64; 3] = [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21];

/// Largest angle, rad.
pub const LARGEST_ANGLE: f64 = 1e6;

/// Nearest integers of the numbers times `factor`: in the last bits, and as numbers.
#[inline(always)]
fn nearest<const N: usize>(x: &[f64; N], factor: f64) -> ([u64; N], [f64; N]) {
    let shifted = x.map(|x| x * factor + NEAREST);
    (shifted.map(f64::to_bits), shifted.map(|shifted| shifted - NEAREST))
}

/// `1 + x/(n+1) (1 + x/(n+2)/... )`: a series of which each term is the one before times `x` over the next of these divisors.
#[inline(always)]
fn series<const N: usize, A: Arithmetic>(x: &[f64; N], divisors: &[f64]) -> [f64; N] {
    let mut sum = [1.0; N];
    for divisor in divisors.iter().rev() {
        let inverse = 1.0 / divisor;
        for (sum, x) in sum.iter_mut().zip(x) {
            *sum = A::mul_add(*sum * inverse, *x, 1.0);
        }
    }
    sum
}

/// Exponentials of numbers between -700 and 700; that of -700 below. To two roundings.
#[inline(always)]
pub fn exp<const N: usize, A: Arithmetic>(x: &[f64; N]) -> [f64; N] {
    const DIVISORS: [f64; 13] = [1., 2., 3., 4., 5., 6., 7., 8., 9., 10., 11., 12., 13.];
    let x = x.map(|x| if x > -700.0 { x } else { -700.0 });
    let (bits, whole) = nearest(&x, std::f64::consts::LOG2_E);
    let mut rest = x;
    for (rest, whole) in rest.iter_mut().zip(&whole) {
        *rest = A::mul_add(-LN_2[1], *whole, A::mul_add(-LN_2[0], *whole, *rest));
    }
    let mut powers = series::<N, A>(&rest, &DIVISORS);
    for (power, bits) in powers.iter_mut().zip(&bits) {
        *power *= f64::from_bits((bits << 52).wrapping_add(1.0_f64.to_bits()));
    }
    powers
}

/// Sines and cosines of angles of at most [`LARGEST_ANGLE`]. To two roundings of 1.
#[inline(always)]
pub fn sin_cos<const N: usize, A: Arithmetic>(x: &[f64; N]) -> ([f64; N], [f64; N]) {
    const OF_SINE: [f64; 8] = [6., 20., 42., 72., 110., 156., 210., 272.];
    const OF_COSINE: [f64; 8] = [2., 12., 30., 56., 90., 132., 182., 240.];
    let (bits, quarters) = nearest(x, std::f64::consts::FRAC_2_PI);
    let mut rest = *x;
    for (rest, quarters) in rest.iter_mut().zip(&quarters) {
        for part in HALF_PI {
            *rest = A::mul_add(-part, *quarters, *rest);
        }
    }
    let squares = rest.map(|rest| -rest * rest);
    let (mut sin, mut cos) = (series::<N, A>(&squares, &OF_SINE), series::<N, A>(&squares, &OF_COSINE));
    for (((sin, cos), rest), bits) in sin.iter_mut().zip(&mut cos).zip(&rest).zip(&bits) {
        let pair = [(*sin * rest).to_bits(), cos.to_bits()];
        // In odd quarters they change places.
        let odd = (bits & 1).wrapping_neg();
        let change = (pair[0] ^ pair[1]) & odd;
        *sin = f64::from_bits(pair[0] ^ change ^ ((bits & 2) << 62));
        *cos = f64::from_bits(pair[1] ^ change ^ ((bits.wrapping_add(1) & 2) << 62));
    }
    (sin, cos)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::simd::{Fused, Separate};

    fn agree<A: Arithmetic>() {
        for k in -200_000..200_000 {
            let x = f64::from(k) * 3.497e-3 + 1e-7 * f64::from(k % 17);
            let [power] = exp::<1, A>(&[x]);
            assert!((power / x.exp() - 1.0).abs() < 2.0 * f64::EPSILON, "exp {x}");
            for x in [x, 1e3 * x, 1e-6 * x] {
                let ([sin], [cos]) = sin_cos::<1, A>(&[x]);
                let (exact_sin, exact_cos) = x.sin_cos();
                let wrong = (sin - exact_sin).abs().max((cos - exact_cos).abs());
                assert!(wrong < 2.0 * f64::EPSILON, "angle {x}: {wrong:e}");
            }
        }
        let [small] = exp::<1, A>(&[-1e9]);
        assert!(small > 0.0 && small < 1e-303);
        let ([sin], _) = sin_cos::<1, A>(&[1e-9]);
        assert!((sin - 1e-9).abs() < 1e-25);
    }

    #[test]
    fn they_agree_with_those_of_one_number() {
        agree::<Separate>();
        agree::<Fused>();
    }
}
