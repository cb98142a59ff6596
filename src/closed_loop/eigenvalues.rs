//! The eigenvalues: zeros of the secular equation ([`super::problem`]), in pairs.
//!
//! Without damping, and if beam and contact have the same damping time, each lies between two known poles. With
//! different damping times all are found together by the Ehrlich-Aberth iteration (O. Aberth, Mathematics of
//! Computation 27 (1973) 339) on the characteristic polynomial `f = s prod p_i`, `s` the secular function, which is
//! never expanded.

use nalgebra::Complex;

use crate::closed_loop::problem::{Number, Pair, Problem, Root};
use crate::math::roots;

/// Relative distance of two real zeros below which they are treated as a close pair; also half their distance over
/// their mean where it is known in closed form.
const CLOSE: f64 = 1e-1;
/// The same for the zeros that cluster at `-1 / beta`.
const CROWDED: f64 = 1e-2;
/// Relative imaginary part below which a zero is taken to be real or one of a close pair.
const REAL: f64 = 1e-4;
const ROUNDS: usize = 100;
/// Terms of the power series about a close pair.
const TERMS: usize = 12;

type Zero = Root<Complex<f64>>;

/// The zeros, a pair for each mode; `None` if they cannot be separated.
pub fn pairs(problem: &Problem) -> Option<Vec<Pair>> {
    let undamped = undamped(problem)?;
    if problem.contact_damping == problem.stiffness_damping {
        return Some(undamped.iter().map(|(nu, _)| damped_pair(problem, *nu)).collect());
    }
    damped_differently(problem, &undamped)
}

/// The zeros without damping, each `-l^2` with the square of its mode's tip displacement (modal mass 1 kg).
///
/// They interlace with the omega_i^2. Each is computed as its distance from the nearest of these, to full relative
/// accuracy.
fn undamped(problem: &Problem) -> Option<Vec<(f64, f64)>> {
    let softness = 1.0 / problem.contact_stiffness;
    let total: f64 = problem.modes.iter().map(|(_, tip)| tip * tip).sum();
    let rest = |pole: f64, distance: f64| {
        let others = problem.modes.iter().filter(|(omega, _)| *omega != pole);
        let parts = others.map(|(omega, tip)| tip * tip / ((omega - pole) - distance));
        parts.sum::<f64>() + softness
    };
    let mut found = Vec::with_capacity(problem.modes.len());
    for (n, &(low, tip)) in problem.modes.iter().enumerate() {
        let next = problem.modes.get(n + 1);
        let gap = next.map_or(problem.contact_stiffness * total, |(high, _)| 0.5 * (high - low));
        let left = |distance: f64| distance * rest(low, distance) - tip * tip;
        let (pole, pole_tip, distance) = match next {
            Some(&(high, tip)) if left(gap) < 0.0 => {
                let right = |distance: f64| distance * rest(high, distance) - tip * tip;
                (high, tip, roots::bracketed(right, -gap, 0.0)?)
            }
            _ => (low, tip, roots::bracketed(left, 0.0, gap * (1.0 + 1e-9))?),
        };
        // A mode of unit contact force has q_i = T_i / (omega_i^2 - nu), its tip moves by 1 / k.
        let squares = problem.modes.iter();
        let squares = squares.map(|(omega, tip)| (tip / ((omega - pole) - distance)).powi(2));
        let mass: f64 = squares.sum();
        if pole_tip == 0.0 || !mass.is_finite() {
            return None;
        }
        found.push((pole + distance, softness * softness / mass));
    }
    Some(found)
}

/// The pair of a mode if the contact has the damping time of the beam.
fn damped_pair(problem: &Problem, nu: f64) -> Pair {
    let mean = -0.5 * (problem.mass_damping + problem.stiffness_damping * nu);
    let square = mean * mean - nu;
    let w = square.max(0.0).sqrt();
    if w > CLOSE * mean.abs() {
        let fast = mean - w;
        let slow = nu / fast;
        // l (l + alpha) + nu h = 0.
        let root = |value: f64| {
            let beam = -value * (value + problem.mass_damping) / nu;
            Root { value, beam, contact: beam }
        };
        Pair::Apart(root(slow), root(fast))
    } else {
        let value = Number::new(mean, 1.0, square);
        let beam = value * problem.stiffness_damping + 1.0;
        Pair::Close(Root { value, beam, contact: beam })
    }
}

/// The zeros for different damping times, by the Ehrlich-Aberth iteration from the zeros without damping, each given
/// with the square of its mode's tip displacement.
fn damped_differently(problem: &Problem, undamped: &[(f64, f64)]) -> Option<Vec<Pair>> {
    let mut zeros: Vec<Zero> = undamped.iter().flat_map(|mode| first_guess(problem, *mode)).collect();
    let mut settled = vec![false; zeros.len()];
    for _ in 0..ROUNDS {
        for (n, settled) in settled.iter_mut().enumerate().filter(|(_, settled)| !**settled) {
            let zero = *zeros.get(n)?;
            let newton = newton(problem, &zero);
            let others = zeros.iter().enumerate().filter(|(other, _)| *other != n);
            let repulsion: Complex<f64> = others.map(|(_, other)| 1.0 / difference(problem, &zero, other)).sum();
            // Limit the change, or the zero may diverge.
            let change = newton / (1.0 - newton * repulsion);
            let farthest = 0.5 * zero.value.norm();
            let change = change * (farthest / change.norm()).min(1.0);
            // At a pole to rounding: converged.
            let change = if change.is_finite() { change } else { Complex::default() };
            let beam = zero.beam - change * problem.stiffness_damping;
            let contact = zero.contact - change * problem.contact_damping;
            *zeros.get_mut(n)? = at(problem, zero.value - change, beam, contact);
            *settled = change.norm() <= 1e-14 * resolution(problem, &zero);
        }
        if settled.iter().all(|settled| *settled) {
            break;
        }
    }
    paired(problem, zeros)
}

/// Initial guess for a pair: the mode alone, with the damping of beam and contact.
fn first_guess(problem: &Problem, (nu, tip): (f64, f64)) -> [Zero; 2] {
    let excess = problem.contact_damping - problem.stiffness_damping;
    let damping = problem.mass_damping + problem.stiffness_damping * nu + problem.contact_stiffness * excess * tip;
    let half = Complex::new(-0.5 * damping.max(0.0), 0.0);
    let w = (half * half - nu).sqrt();
    let fast = half - w;
    [(fast, -0.03), (nu / fast, 0.03)].map(|(value, part)| {
        let contact = value * problem.contact_damping + 1.0;
        let beam = -value * (value + (damping.max(0.0) - problem.stiffness_damping * nu)) / nu;
        let zero = at(problem, value, beam, contact);
        // Perturbed off the real axis, so that two real guesses can become complex; to opposite sides, so that equal
        // ones can separate.
        let aside = Complex::new(0.0, part * resolution(problem, &zero));
        let beam = zero.beam + aside * problem.stiffness_damping;
        at(problem, value + aside, beam, contact + aside * problem.contact_damping)
    })
}

/// The zero with its three parts consistent to all digits: `beam` and `contact` determine it where they are small.
fn at(problem: &Problem, value: Complex<f64>, beam: Complex<f64>, contact: Complex<f64>) -> Zero {
    let (beta, beta_c) = (problem.stiffness_damping, problem.contact_damping);
    let is_small = |part: Complex<f64>| part.norm() < 0.5;
    let direct = (value * beta + 1.0, value * beta_c + 1.0);
    let beam = if is_small(direct.0) { beam } else { direct.0 };
    let contact = if is_small(direct.0) {
        (beam * beta_c + (beta - beta_c)) / beta
    } else if is_small(direct.1) {
        contact
    } else {
        direct.1
    };
    Zero { value, beam, contact }
}

/// Length scale at the zero: its modulus, or less if it is close to `-1 / beta` or `-1 / beta_c`.
fn resolution(problem: &Problem, zero: &Zero) -> f64 {
    let size = zero.value.norm();
    let size = size.min(zero.beam.norm() / problem.stiffness_damping);
    size.min(zero.contact.norm() / problem.contact_damping)
}

fn difference(problem: &Problem, a: &Zero, b: &Zero) -> Complex<f64> {
    let beta = problem.stiffness_damping;
    if a.beam.norm() + b.beam.norm() < beta * (a.value.norm() + b.value.norm()) {
        (a.beam - b.beam) / beta
    } else {
        a.value - b.value
    }
}

/// Newton correction f / f'.
fn newton(problem: &Problem, zero: &Zero) -> Complex<f64> {
    let l = zero.value;
    let own = l * (l + problem.mass_damping);
    let none = Complex::new(0.0, 0.0);
    let (mut sum, mut slope, mut poles) = (none, none, none);
    for (omega, tip) in &problem.modes {
        let inverse = 1.0 / (own + zero.beam * *omega);
        let growth = (l * 2.0 + (problem.mass_damping + problem.stiffness_damping * omega)) * inverse;
        let part = inverse * (tip * tip);
        sum += part;
        slope -= part * growth;
        poles += growth;
    }
    let k = problem.contact_stiffness;
    let secular = zero.contact * sum * k + 1.0;
    secular / ((sum * problem.contact_damping + zero.contact * slope) * k + secular * poles)
}

/// Groups the zeros into pairs.
fn paired(problem: &Problem, zeros: Vec<Zero>) -> Option<Vec<Pair>> {
    let mut pairs = Vec::with_capacity(zeros.len() / 2);
    let mut real = Vec::new();
    let mut lower = 0_usize;
    for zero in zeros {
        let imaginary = zero.value.im / resolution(problem, &zero);
        if imaginary > REAL {
            let Complex { re, im } = zero.value;
            let value = Number::new(re, 1.0, -im * im);
            pairs.push(Pair::Close(Root {
                value,
                beam: Number::new(zero.beam.re, problem.stiffness_damping, -im * im),
                contact: Number::new(zero.contact.re, problem.contact_damping, -im * im),
            }));
        } else if imaginary < -REAL {
            lower += 1;
        } else {
            real.push(zero);
        }
    }
    if lower != pairs.len() || real.len() % 2 != 0 {
        return None;
    }
    real.sort_unstable_by(|a, b| b.value.re.total_cmp(&a.value.re).then(b.beam.re.total_cmp(&a.beam.re)));
    let mut single: Vec<Root<f64>> = Vec::new();
    let mut rest = real.as_slice();
    while let [a, others @ ..] = rest {
        rest = others;
        let close = if a.beam.norm() < 0.1 { CROWDED } else { CLOSE };
        if let [b, beyond @ ..] = others
            && difference(problem, a, b).norm() < close * resolution(problem, a)
        {
            rest = beyond;
            pairs.push(close_pair(problem, a, b));
        } else {
            single.push(Root { value: a.value.re, beam: a.beam.re, contact: a.contact.re });
        }
    }
    // Slowest with fastest, as for a strongly damped mode.
    let (slow, fast) = single.split_at(single.len() / 2);
    let apart = slow.iter().zip(fast.iter().rev());
    pairs.extend(apart.map(|(slow, fast)| Pair::Apart(*slow, *fast)));
    Some(pairs)
}

/// Two zeros so close that each alone is accurate to half the digits only. Accurate to all digits is the quadratic with
/// both zeros, a factor of the power series of the secular function about their midpoint.
fn close_pair(problem: &Problem, a: &Zero, b: &Zero) -> Pair {
    let centre = Zero {
        value: Complex::from(f64::midpoint(a.value.re, b.value.re)),
        beam: Complex::from(f64::midpoint(a.beam.re, b.beam.re)),
        contact: Complex::from(f64::midpoint(a.contact.re, b.contact.re)),
    };
    let series = series(problem, &centre);
    let half = 0.5 * difference(problem, a, b);
    // x^2 + p x + q, which leaves the other factor.
    let (mut p, mut q) = (0.0, -(half * half).re);
    for _ in 0..TERMS {
        let mut factor = [0.0; TERMS];
        let (mut above, mut above2) = (0.0, 0.0);
        for (entry, coefficient) in factor.iter_mut().zip(series.iter().skip(2)).rev() {
            *entry = coefficient - p * above - q * above2;
            (above, above2) = (*entry, above);
        }
        let [first, second, ..] = factor;
        let [constant, linear, ..] = series;
        q = constant / first;
        p = (linear - q * second) / first;
    }
    let square = 0.25 * p * p - q;
    let shift = -0.5 * p;
    let about = |value: Complex<f64>, slope: f64| Number::new(value.re + shift * slope, slope, square);
    Pair::Close(Root {
        value: about(centre.value, 1.0),
        beam: about(centre.beam, problem.stiffness_damping),
        contact: about(centre.contact, problem.contact_damping),
    })
}

/// Power series coefficients of the secular function about a real point.
fn series(problem: &Problem, centre: &Zero) -> [f64; TERMS + 2] {
    let l = centre.value.re;
    let mut sum = [0.0; TERMS + 2];
    for (omega, tip) in &problem.modes {
        let p = l * (l + problem.mass_damping) + omega * centre.beam.re;
        let slope = 2.0 * l + problem.mass_damping + problem.stiffness_damping * omega;
        let (mut below2, mut below) = (0.0, tip * tip / p);
        for entry in &mut sum {
            *entry += below;
            (below2, below) = (below, -(slope * below + below2) / p);
        }
    }
    let contact = problem.contact_stiffness * centre.contact.re;
    let rate = problem.contact_stiffness * problem.contact_damping;
    let mut below = 0.0;
    for entry in &mut sum {
        let own = *entry;
        *entry = contact * own + rate * below;
        below = own;
    }
    if let Some(constant) = sum.first_mut() {
        *constant += 1.0;
    }
    sum
}
