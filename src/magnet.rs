//! The magnet that draws the armature to its core, and the stops between which it moves.
//!
//! `F = F_h i^2 / (1 + g / g_0)^2` at the gap `g` to the core, with the hold force `F_h` at no gap and the current `i` of the coil
//! relative to that of the hold force: the field of a magnetic circuit whose iron takes as many ampere turns as an air gap of
//! `g_0`. A stop that gives way leaves the force at that of no gap.

use crate::math::roots;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Magnet {
    /// Force at no gap and a relative current of 1, N.
    pub hold: f64,
    /// Gap at which a quarter of it is left, m.
    pub constant: f64,
}

impl Magnet {
    /// Force (N) at a gap (m) and a relative current, and its derivative by the gap (N/m).
    #[inline(always)]
    pub fn force(&self, gap: f64, current: f64) -> (f64, f64) {
        let held = self.hold * current * current;
        if gap <= 0.0 {
            return (held, 0.0);
        }
        let ratio = self.constant / (self.constant + gap);
        let force = held * ratio * ratio;
        (force, -2.0 * force / (self.constant + gap))
    }

    /// Gap (m), far below that of a quarter, that changes the force by this (N).
    pub fn gap_of(&self, change: f64, current: f64) -> f64 {
        0.5 * self.constant * change / (self.hold * current * current)
    }

    /// Work that opening a gap (m) from none takes at a relative current, J.
    pub fn energy(&self, gap: f64, current: f64) -> f64 {
        let open = gap.max(0.0);
        self.hold * current * current * (self.constant / (self.constant + open) * open + gap.min(0.0))
    }
}

/// Share of critical damping with which a mass leaves a linear spring, which only presses, with this share of its velocity.
///
/// T. Schwager, T. Poeschel, Granular Matter 9 (2007) 465: the touch ends where the force vanishes, not the overlap.
pub fn damping_ratio(restitution: f64) -> f64 {
    if restitution >= 1.0 {
        return 0.0;
    }
    let excess = |logarithm: f64| left(logarithm.exp()) - restitution;
    roots::bracketed(excess, -30.0, 10.0).map_or(0.0, f64::exp)
}

/// Share of the velocity left at a share of critical damping.
fn left(ratio: f64) -> f64 {
    // Of the motion from touch to where spring and damper balance.
    let root = (1.0 - ratio * ratio).abs().sqrt();
    if ratio < 1.0 {
        let angle = f64::atan2(2.0 * ratio * root, 2.0 * ratio * ratio - 1.0);
        (-ratio / root * angle).exp()
    } else if root > 0.0 {
        (-ratio / root * ((ratio + root) / (ratio - root)).ln()).exp()
    } else {
        (-2.0_f64).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::free_motion::FreeMotion;

    /// Velocity with which a unit mass leaves a unit spring, where the force vanishes.
    fn thrown(ratio: f64) -> f64 {
        let motions = (1..).map(|k| FreeMotion::new(1.0, 2.0 * ratio, 1e-4 * f64::from(k)));
        let mut motions = motions.map(|at| (at.q_from_v, at.v_from_v));
        let left = motions.find(|(d, v)| *v < 0.0 && d + 2.0 * ratio * v <= 0.0);
        -left.unwrap().1
    }

    #[test]
    fn a_mass_leaves_a_stop_with_its_restitution() {
        for restitution in [0.05, 0.1, 0.2, 0.4, 0.7, 0.95] {
            let left = thrown(damping_ratio(restitution));
            // To a step of time.
            assert!((left - restitution).abs() < 2e-4, "{restitution}: {left}");
        }
        assert_eq!(damping_ratio(1.0), 0.0);
    }

    #[test]
    fn the_force_is_the_derivative_of_the_energy() {
        let magnet = Magnet { hold: 4.0, constant: 1e-4 };
        for gap in [-1e-6, 1e-6, 1e-4, 1e-3] {
            let step = 1e-4 * gap;
            let [below, above] = [gap - step, gap + step].map(|gap| magnet.energy(gap, 0.7));
            let force = (above - below) / (2.0 * step);
            assert!((magnet.force(gap, 0.7).0 - force).abs() < 1e-6 * force);
        }
        assert_eq!(magnet.force(1e-4, 1.0).0, 1.0);
        assert_eq!(magnet.force(-1e-6, 0.5), (1.0, 0.0));
    }
}
