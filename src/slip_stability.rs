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
