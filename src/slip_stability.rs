//! Whether slip is stable.
//!
//! While the contact slips, the friction force is `sigma mu F` (`sigma`: its sign), so that small motions about slip under a
//! constant contact force are those of
//!
//! ```text
//! q_i'' + c_i q_i' + omega_i^2 q_i + u_i k sum T_j (q_j + beta_c q_j') = 0,  u_i = T_i + sigma mu h T_i'
//! ```
//!
//! with the tangent stiffness `k` of the contact. It couples the modes by a matrix that is not symmetric: two of them can feed
//! each other from the slip (flutter, heard as squeal), or one alone moves away (divergence). The tangential spring follows
//! and does not act back.
//!
//! Most slip is stable, which Nyquist's criterion shows for a hundredth of what the eigenvalues cost: the contact closes a loop
//! with the gain `k` around the response of its approach to its force,
//!
//! ```text
//! L(s) = (1 + beta_c s) sum T_j u_j / (s^2 + c_j s + omega_j^2)
//! ```
//!
//! which is stable by itself. It stays so up to the gain `k` where `L` on the imaginary axis does not reach the real numbers
//! from `-1 / k` down.

use std::f64::consts::TAU;

use nalgebra::linalg::Schur;
use nalgebra::{Complex, DMatrix, DVector};

use crate::beam::mode::Mode;
use crate::contact::friction::{Friction, Phase};
use crate::contact::power::Power;
use crate::error::Remark;
use crate::scene::Scene;
use crate::shared::{Found, Home, Shared};

/// Contact forces looked at, in the usual force, 1, each this many times the one before: a blow has many times the preload.
const FORCES: [f64; 5] = [0.0625, 0.25, 1.0, 4.0, 16.0];
const APART: f64 = 4.0;

/// Growth that is mere rounding, in the norm of the matrix, 1.
const ROUNDING: f64 = 1e-12;

/// Iterations for the eigenvalues, per eigenvalue; two or three are usual. nalgebra's own default has no limit, and matrices
/// are known with which it never ends (its issues 611 and 764).
const ITERATIONS: usize = 30;

/// Halvings of the logarithm of frequency between two bends of the response of the loop. Cost: where more are needed the
/// eigenvalues tell.
const HALVINGS: u32 = 10;

/// Slip in a direction in which it is unstable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Unstable {
    /// The direction.
    pub(crate) slip: Phase,
    /// The usual contact force, N.
    usual: f64,
    /// Growth rate at each of the forces, 1/s, 0 where it is stable, and its frequency, Hz, 0: it moves away without vibrating.
    growing: [(f64, f64); FORCES.len()],
}

impl Unstable {
    /// Growth rate at a contact force (N), 1/s: linear in the logarithm of the force between those looked at.
    pub(crate) fn growth(&self, force: f64) -> f64 {
        let [least, .., most] = FORCES;
        let force = (force / self.usual).clamp(least, most);
        let near = |share: f64| (1.0 - (force / share).ln().abs() / APART.ln()).max(0.0);
        let rates = FORCES.iter().zip(&self.growing);
        rates.map(|(share, (rate, _))| near(*share) * rate).sum()
    }

    /// What a user should know of it: where it is unstable nearest to the usual force.
    pub(crate) fn remark(&self, scene: &Scene) -> Option<Remark> {
        let rates = FORCES.iter().zip(self.growing).filter(|(_, (rate, _))| *rate > 0.0);
        let (share, (growth, frequency)) = rates.min_by(|(a, _), (b, _)| a.ln().abs().total_cmp(&b.ln().abs()))?;
        Some(Remark::UnstableSlip {
            away: self.slip == Phase::SlipForth,
            force: share * self.usual,
            growth,
            frequency,
            coefficient: scene.friction.coefficient,
            height: scene.tip.contact_height,
        })
    }
}

/// What was found, by modes, friction, law and usual force (N).
pub(crate) type Known = Found<(Vec<Mode>, Friction, Power, f64), Vec<Unstable>>;

/// Where that is.
pub(crate) static KNOWN: Home<Known> = Home::new();

/// Unstable slip, in each direction in which it is, about the usual contact force (N).
pub(crate) fn unstable(modes: &[Mode], friction: &Friction, law: &Power, usual: f64) -> Vec<Unstable> {
    let of = (modes.to_vec(), *friction, *law, usual);
    Shared::of(&KNOWN).of(of, |(modes, friction, law, usual)| {
        let usual = *usual;
        let along = |slip: Phase| {
            let loads = loads(modes, friction, slip)?;
            let [.., most] = FORCES;
            let closed = Loop {
                modes,
                loads: &loads,
                contact_damping: law.damping,
                stiffest: law.tangent_stiffness(law.indentation(most * usual)),
            };
            if closed.is_stable() {
                return None;
            }
            let growing = FORCES.map(|share| {
                let value = fastest(modes, &loads, law, share * usual);
                value.map_or((0.0, 0.0), |value| (value.re, value.im.abs() / TAU))
            });
            let unstable = growing.iter().any(|(rate, _)| *rate > 0.0);
            unstable.then_some(Unstable { slip, usual, growing })
        };
        let ways = [Phase::SlipBack, Phase::SlipForth];
        ways.into_iter().filter_map(along).collect()
    })
}

/// The load `u_i` on each mode per contact force, 1/sqrt(kg); `None` if none is against the displacement of its tip. Then slip is
/// stable: scaled by `sqrt(u_i / T_i)`, all matrices are symmetric and none is negative.
fn loads(modes: &[Mode], friction: &Friction, slip: Phase) -> Option<DVector<f64>> {
    let share = slip.sign()? * friction.coefficient;
    let along = share * friction.height;
    let loads = DVector::from_iterator(modes.len(), modes.iter().map(|mode| mode.tip + along * mode.rotation));
    let against = modes.iter().zip(&loads).any(|(mode, load)| mode.tip * load < 0.0);
    against.then_some(loads)
}

/// The loop that the contact closes.
struct Loop<'a> {
    modes: &'a [Mode],
    loads: &'a DVector<f64>,
    /// Damping time of the contact, s.
    contact_damping: f64,
    /// Greatest of its stiffnesses, N/m.
    stiffest: f64,
}

/// The response at an angular frequency (1/s), m/N.
type Response = (f64, Complex<f64>);

impl Loop<'_> {
    /// Whether it is stable at all stiffnesses up to the greatest. `false` also where that does not show, as without damping,
    /// where the response is real.
    fn is_stable(&self) -> bool {
        let mut frequencies = self.frequencies();
        frequencies.retain(|frequency| frequency.is_finite() && *frequency > 0.0);
        frequencies.sort_unstable_by(f64::total_cmp);
        frequencies.dedup();
        let samples: Vec<Response> = frequencies.iter().map(|frequency| self.at(*frequency)).collect();
        let (Some(first), Some(last)) = (samples.first(), samples.last()) else {
            return false;
        };
        // Below the first the response is that at rest, above the last it falls.
        let at_rest = first.1.re * self.stiffest > -0.99;
        let falls = last.1.norm() * self.stiffest < 1.0;
        let mut pairs = samples.iter().zip(samples.iter().skip(1));
        at_rest && falls && pairs.all(|(from, to)| self.keeps_away(*from, *to, HALVINGS))
    }

    /// Where the response bends: at and beside the roots of each mode; and ends far below and above them all.
    fn frequencies(&self) -> Vec<f64> {
        let roots = self.modes.iter().flat_map(|mode| {
            let (omega, half) = (mode.omega_squared.sqrt(), 0.5 * mode.damping);
            if half < omega {
                [omega - half, omega, omega + half]
            } else {
                let fast = half + (half * half - mode.omega_squared).sqrt();
                [mode.omega_squared / fast, omega, fast]
            }
        });
        let roots: Vec<f64> = roots.collect();
        let (least, most) = roots.iter().fold((f64::INFINITY, 0.0_f64), |(least, most), root| {
            (if *root > 0.0 { least.min(*root) } else { least }, most.max(*root))
        });
        // There it is at most sum |T_j u_j| (1 + beta_c omega) / (3/4 omega^2).
        let pairs = self.modes.iter().zip(self.loads);
        let gain = self.stiffest * pairs.map(|(mode, load)| (mode.tip * load).abs()).sum::<f64>() / 0.75;
        let far = (2.0 * most)
            .max(2.0 * gain * self.contact_damping)
            .max((2.0 * gain).sqrt());
        roots.into_iter().chain([1e-3 * least, far]).collect()
    }

    fn at(&self, frequency: f64) -> Response {
        let square = frequency * frequency;
        let modes = self.modes.iter().zip(self.loads).map(|(mode, load)| {
            let below = Complex::new(mode.omega_squared - square, mode.damping * frequency);
            below.conj() * (mode.tip * load / below.norm_sqr())
        });
        let damped = Complex::new(1.0, self.contact_damping * frequency);
        (frequency, damped * modes.sum::<Complex<f64>>())
    }

    /// Whether the response keeps away from the numbers that it must not reach between two frequencies; `false` also where that
    /// does not show after so many halvings. A piece that lies far from them, for its length, or on one side without much change
    /// has no room for a crossing, as all bends lie at its ends.
    fn keeps_away(&self, from: Response, to: Response, halvings: u32) -> bool {
        let middle = self.at((from.0 * to.0).sqrt());
        let is_clear = |(_, a): Response, (_, b): Response| {
            let (least, most) = (a.im.abs().min(b.im.abs()), a.im.abs().max(b.im.abs()));
            let beside = (a.im > 0.0) == (b.im > 0.0) && most < 2.0 * least;
            beside || (a - b).norm() < self.distance(a).min(self.distance(b))
        };
        if is_clear(from, middle) && is_clear(middle, to) {
            return true;
        }
        halvings > 0 && self.keeps_away(from, middle, halvings - 1) && self.keeps_away(middle, to, halvings - 1)
    }

    /// Distance of a response from those numbers, m/N.
    fn distance(&self, response: Complex<f64>) -> f64 {
        let beyond = (response.re + 1.0 / self.stiffest).max(0.0);
        beyond.hypot(response.im)
    }
}

/// The eigenvalue (1/s) with which a motion grows fastest at a contact force (N), if one grows.
fn fastest(modes: &[Mode], loads: &DVector<f64>, law: &Power, force: f64) -> Option<Complex<f64>> {
    let count = modes.len();
    let stiffness = law.tangent_stiffness(law.indentation(force));
    let per_mode = |value: fn(&Mode) -> f64| DVector::from_iterator(count, modes.iter().map(value));
    let (omega, tip) = (per_mode(|mode| mode.omega_squared.sqrt()), per_mode(|mode| mode.tip));
    // Of omega_i q_i and q_i', whose squares are energies.
    let mut matrix = DMatrix::zeros(2 * count, 2 * count);
    let square = (count, count);
    matrix.view_mut((0, count), square).set_diagonal(&omega);
    matrix.view_mut((count, 0), square).set_diagonal(&-&omega);
    matrix
        .view_mut(square, square)
        .set_diagonal(&-per_mode(|mode| mode.damping));
    let mut held = matrix.view_mut((count, 0), square);
    held.ger(-stiffness, loads, &tip.component_div(&omega), 1.0);
    let mut damped = matrix.view_mut(square, square);
    damped.ger(-stiffness * law.damping, loads, &tip, 1.0);
    let least = ROUNDING * matrix.norm();
    if !least.is_finite() {
        return None;
    }
    let schur = Schur::try_new(matrix, f64::EPSILON, ITERATIONS * 2 * count)?;
    let values = schur.complex_eigenvalues();
    let growing = values.iter().filter(|value| value.re > least);
    growing.copied().max_by(|a, b| a.re.total_cmp(&b.re))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::power::HERTZ;

    /// Numbers from 0 to 1 that look random.
    fn numbers() -> impl FnMut() -> f64 {
        let mut state = 1_u64;
        move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        }
    }

    #[test]
    fn slip_that_nyquist_calls_stable_has_no_eigenvalue_that_grows() {
        let mut random = numbers();
        let (mut stable, mut calm) = (0, 0);
        for case in 0..3000_usize {
            let count = 1 + case % 12;
            let damped = 10_f64.powf(-6.0 + 5.0 * random());
            let (mut omega, by_mass) = (10_f64.powf(3.0 + random()), 10.0 * random());
            let modes: Vec<Mode> = (0..count)
                .map(|_| {
                    omega *= 1.01 + 2.0 * random() * random();
                    Mode {
                        omega_squared: omega * omega,
                        damping: by_mass + damped * omega * omega * 1e-3,
                        tip: 20.0 * (random() - 0.5),
                        ..Mode::default()
                    }
                })
                .collect();
            let against = random();
            let loads = modes
                .iter()
                .map(|mode| mode.tip * (random() - 0.6 * against) + 4.0 * against * (random() - 0.5));
            let loads = DVector::from_vec(loads.collect::<Vec<f64>>());
            let damping = if case % 3 == 0 {
                0.0
            } else {
                10_f64.powf(-8.0 + 4.0 * random())
            };
            let law = Power {
                coefficient: 10_f64.powf(8.0 + 3.0 * random()),
                exponent: HERTZ,
                damping,
                traces: 0.0,
                least: 0.0,
            };
            let grows = FORCES
                .iter()
                .any(|force| fastest(&modes, &loads, &law, force * 0.2).is_some());
            let closed = Loop {
                modes: &modes,
                loads: &loads,
                contact_damping: damping,
                stiffest: law.tangent_stiffness(law.indentation(16.0 * 0.2)),
            };
            let is_stable = closed.is_stable();
            assert!(!(is_stable && grows), "{case}: {modes:?} {loads} {law:?}");
            stable += u32::from(is_stable);
            calm += u32::from(!grows);
        }
        // Most of what is stable shows.
        println!("{stable} of {calm} stable ones");
        assert!(stable > calm / 3 && calm < 2500, "{stable} of {calm}");
    }
}
