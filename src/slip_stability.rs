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
use crate::contact::law::Law;
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

/// Pieces of the axis of frequencies that are tried; where more are needed the eigenvalues tell. Cost.
const MOST_PIECES: u32 = 3000;

/// Slip in a direction in which it is unstable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Unstable {
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
pub(crate) type Known = Found<(Vec<Mode>, Friction, Law, f64), Vec<Unstable>>;

pub(crate) static KNOWN: Home<Known> = Home::new(None);

/// Unstable slip, in each direction in which it is, about the usual contact force (N).
pub(crate) fn unstable(modes: &[Mode], friction: &Friction, law: &Law, usual: f64) -> Vec<Unstable> {
    let of = (modes.to_vec(), *friction, *law, usual);
    Shared::of(&KNOWN).of(of, |(modes, friction, law, usual)| {
        let usual = *usual;
        let along = |slip: Phase| {
            let loads = loads(modes, friction, slip)?;
            if Loop::of(modes, &loads, law, usual).is_stable() {
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

/// The least and the greatest value of something.
type Range = [f64; 2];

fn product([a, b]: Range, [c, d]: Range) -> Range {
    let all = [a * c, a * d, b * c, b * d];
    [all.into_iter().fold(f64::INFINITY, f64::min), all.into_iter().fold(f64::NEG_INFINITY, f64::max)]
}

fn add(sum: &mut Range, range: Range) {
    for (sum, value) in sum.iter_mut().zip(range) {
        *sum += value;
    }
}

impl<'a> Loop<'a> {
    /// Up to the greatest of the forces looked at about the usual one (N).
    fn of(modes: &'a [Mode], loads: &'a DVector<f64>, law: &Law, usual: f64) -> Self {
        let [.., most] = FORCES;
        Self { modes, loads, contact_damping: law.damping, stiffest: law.tangent_stiffness(most * usual) }
    }

    /// Whether it is stable at all stiffnesses up to the greatest. `false` also where that does not show, as with a mode without
    /// damping, at whose frequency the response is infinite.
    fn is_stable(&self) -> bool {
        if !self.modes.iter().all(|mode| mode.damping > 0.0) {
            return false;
        }
        let far = self.far();
        let (mut from, mut to) = (0.0, far);
        for _ in 0..MOST_PIECES {
            if self.keeps_away([from, to]) {
                if to == far {
                    return true;
                }
                // The next piece may be longer, by the logarithm.
                let next = if from > 0.0 { to * (to / from).powi(2) } else { 1e3 * to };
                (from, to) = (to, next.min(far));
            } else {
                to = if from > 0.0 { (from * to).sqrt() } else { 1e-3 * to };
                if to <= from {
                    return false;
                }
            }
        }
        false
    }

    /// An angular frequency from which on the response is too small, 1/s: it is at most
    /// `sum |T_j u_j| (1 + beta_c omega) / (3/4 omega^2)` above twice the highest of the modes.
    fn far(&self) -> f64 {
        let most = self.modes.iter().map(|mode| mode.omega_squared).fold(0.0, f64::max);
        let pairs = self.modes.iter().zip(self.loads);
        let gain = self.stiffest * pairs.map(|(mode, load)| (mode.tip * load).abs()).sum::<f64>() / 0.75;
        (2.0 * most.sqrt()).max(2.0 * gain * self.contact_damping).max((2.0 * gain).sqrt())
    }

    /// Whether the response keeps away from the numbers that it must not reach at these frequencies (1/s); `false` also where its bounds
    /// do not show it.
    fn keeps_away(&self, frequencies: Range) -> bool {
        let ([real, _], [least, greatest]) = self.within(frequencies);
        real * self.stiffest > -1.0 || least > 0.0 || greatest < 0.0
    }

    /// Real and imaginary part of the response at these frequencies (1/s), m/N: bounds of them, by those of each mode.
    fn within(&self, [from, to]: Range) -> (Range, Range) {
        let (mut real, mut imaginary) = ([0.0; 2], [0.0; 2]);
        let beta = self.contact_damping;
        let squares = [from * from, to * to];
        for (mode, load) in self.modes.iter().zip(self.loads) {
            let (stiffness, damping) = (mode.omega_squared, mode.damping);
            // Over |omega_j^2 - omega^2 + i c_j omega|^2, a parabola in omega^2.
            let magnitude = |square: f64| (stiffness - square).powi(2) + damping * damping * square;
            let ends = squares.map(magnitude);
            let lowest = magnitude((stiffness - 0.5 * damping * damping).clamp(squares[0], squares[1]));
            let inverse = [1.0 / ends[0].max(ends[1]), 1.0 / lowest];
            let scale = mode.tip * load;
            let part = squares.map(|square| stiffness + (beta * damping - 1.0) * square);
            let part = product([part[0].min(part[1]), part[0].max(part[1])], inverse);
            add(&mut real, product(part, [scale; 2]));
            let rate = [squares[1], squares[0]].map(|square| beta * (stiffness - square) - damping);
            let part = product(product(rate, [from, to]), inverse);
            add(&mut imaginary, product(part, [scale; 2]));
        }
        (real, imaginary)
    }
}

/// The eigenvalue (1/s) with which a motion grows fastest at a contact force (N), if one grows.
fn fastest(modes: &[Mode], loads: &DVector<f64>, law: &Law, force: f64) -> Option<Complex<f64>> {
    let count = modes.len();
    let stiffness = law.tangent_stiffness(force);
    let per_mode = |value: fn(&Mode) -> f64| DVector::from_iterator(count, modes.iter().map(value));
    let (omega, tip) = (per_mode(|mode| mode.omega_squared.sqrt()), per_mode(|mode| mode.tip));
    // Of omega_i q_i and q_i', whose squares are energies.
    let mut matrix = DMatrix::zeros(2 * count, 2 * count);
    let square = (count, count);
    matrix.view_mut((0, count), square).set_diagonal(&omega);
    matrix.view_mut((count, 0), square).set_diagonal(&-&omega);
    matrix.view_mut(square, square).set_diagonal(&-per_mode(|mode| mode.damping));
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
    use crate::contact::law::HERTZ;
    use crate::excitation::random::SplitMix64;

    #[test]
    fn slip_that_nyquist_calls_stable_has_no_eigenvalue_that_grows() {
        let mut generator = SplitMix64(1);
        let mut random = || generator.next_part();
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
                        damping: if random() < 0.02 { 0.0 } else { by_mass + damped * omega * omega * 1e-3 },
                        tip: 20.0 * (random() - 0.5),
                        ..Mode::default()
                    }
                })
                .collect();
            let against = random();
            let loads =
                modes.iter().map(|mode| mode.tip * (random() - 0.6 * against) + 4.0 * against * (random() - 0.5));
            let loads = DVector::from_vec(loads.collect::<Vec<f64>>());
            let damping = if case % 3 == 0 { 0.0 } else { 10_f64.powf(-8.0 + 4.0 * random()) };
            let law = Law::power(10_f64.powf(8.0 + 3.0 * random()), HERTZ, damping);
            let grows = |force: &f64| fastest(&modes, &loads, &law, force * 0.2).is_some();
            let grows = FORCES.iter().any(grows);
            let is_stable = Loop::of(&modes, &loads, &law, 0.2).is_stable();
            assert!(!(is_stable && grows), "{case}: {modes:?} {loads} {law:?}");
            stable += u32::from(is_stable);
            calm += u32::from(!grows);
        }
        // Most of what is stable shows.
        assert!(stable > calm / 2 && calm < 2500, "{stable} of {calm}");
    }
}
