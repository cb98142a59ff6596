//! Exact response of a mode `q'' + c q' + omega^2 q = r(t)` over a step to its initial state and to a load that is a
//! polynomial in time, at any step length and any damping.
//!
//! In units of the step length, the response to a load shape is a combination of functions of the shape alone. For a
//! mode slow compared with the step: repeated integrals of the shape (the power series of the impulse response,
//! integrated by parts). For a fast mode: derivatives of the shape (the quasi-static particular solution) and a free
//! motion that cancels its initial value. A strongly overdamped mode with one fast and one slow root uses one of each.

use crate::beam::mode::Mode;
use crate::integrator::collocation::fading_load::convolved;
use crate::integrator::collocation::shapes::{MAX_SHAPES, Row, Shapes, Variable};
use crate::integrator::collocation::superposition::{Combination, Fading, Fast, Pair, Response};
use crate::math::elementary::exp;
use crate::math::free_motion::{FADED, FreeMotion, Roots};
use crate::math::nodal::{Nodal, add, scaled};
use crate::math::series::{NEGLIGIBLE, TERMS};
use crate::math::simd::Arithmetic;

/// Root times step length up to which the power series keeps its digits, 1: its terms grow to about `7^6 / 7!`. Pinned:
/// × 4.5, the library's unit tests do not end.
pub const SLOW: f64 = 6.7;

/// Root times step length from which the derivatives of a shape fall fast enough against its powers, 1. Pinned: ÷ 10,
/// `responses_agree_with_quadrature_in_every_regime`.
pub const FAST: f64 = 5.0;

/// Root times step length up to which the power series of the free motion keeps its digits, 1: `2^2 / 2!`. Pinned: ×
/// 10, `responses_agree_with_quadrature_in_every_regime`.
pub const FREE: f64 = 2.0;

/// Which characteristic roots of a mode are slow compared with the step.
#[derive(Clone, Copy, Debug)]
pub(super) enum Regime {
    /// Both roots are slow.
    Slow,
    /// Both roots are fast.
    Fast,
    /// One of each; the roots times the step length.
    Split(f64, f64),
}

impl Regime {
    /// By the magnitudes of the roots times the step length.
    #[inline(always)]
    pub(super) fn of(slow: f64, fast: f64) -> Self {
        if fast <= SLOW {
            Self::Slow
        } else if slow >= FAST {
            Self::Fast
        } else {
            Self::Split(-slow, -fast)
        }
    }
}

/// A mode over a step: `q'' + c q' + omega^2 q = r(t)`.
#[derive(Clone, Copy, Debug)]
pub struct ModeOverStep {
    omega_squared: f64,
    damping: f64,
    /// Step length, s.
    h: f64,
    /// Magnitude of the faster root times h.
    fast: f64,
    regime: Regime,
}

impl ModeOverStep {
    /// For `omega_squared` >= 0 (1/s2), `damping` c >= 0 (1/s), and the step length `h` > 0 (s).
    pub fn new(omega_squared: f64, damping: f64, h: f64) -> Self {
        let Roots { slow: [slow], fast: [fast], .. } = Roots::of([omega_squared], [damping]);
        Self { omega_squared, damping, h, fast: fast * h, regime: Regime::of(slow * h, fast * h) }
    }

    /// The longest step by the root of time over which the response of a mode is known, s.
    pub fn longest_by_root(mode: &Mode) -> f64 {
        let fast = Self::new(mode.omega_squared, mode.damping, 1.0).fast;
        let is_overdamped = 0.25 * mode.damping * mode.damping > mode.omega_squared;
        if is_overdamped { FAST * fast / mode.omega_squared } else { SLOW / fast }
    }

    /// The response over a step with these nodes and shapes.
    #[inline(always)]
    pub fn response<const S: usize, A: Arithmetic>(&self, nodes: &Nodal<S>, shapes: &Shapes<S>) -> Response<S> {
        let combination = self.combination::<S, A>(shapes);
        let decay = self.decay::<S, A>(nodes);
        let impulse = self.impulse::<S, A>(nodes, shapes, &combination, &decay);
        let start = |factors: &[f64; MAX_SHAPES]| {
            let mut start = Row { nodal: [0.0; S], error: 0.0 };
            for (factor, row) in factors.iter().zip(shapes.start_derivatives) {
                add::<S, A>(&mut start.nodal, *factor, &row.nodal);
                start.error = A::mul_add(*factor, row.error, start.error);
            }
            start
        };
        let Pair { q, v } = &combination.derivatives;
        let fading = match self.regime {
            _ if shapes.variable == Variable::Root => [None; 2],
            Regime::Slow => [None; 2],
            Regime::Split(_, fast) => {
                let fade = Pair { q: decay, v: scaled(&decay, fast) };
                [Some(Fading { start: start(q), fade }), None]
            }
            Regime::Fast => {
                let mut from_q = impulse.v;
                add::<S, A>(&mut from_q, self.damping * self.h, &impulse.q);
                let fade = Pair { q: from_q, v: scaled(&impulse.q, -self.omega_squared * self.h * self.h) };
                [Some(Fading { start: start(q), fade }), Some(Fading { start: start(v), fade: impulse })]
            }
        };
        let fast = match self.regime {
            Regime::Split(slow, fast) if shapes.variable == Variable::Root => {
                let share = 1.0 / (slow - fast);
                Some(Fast {
                    convolved: convolved::<S, A>(-fast, nodes, shapes),
                    factors: Pair { q: share, v: share * fast },
                })
            }
            _ => None,
        };
        Response { combination, fading, fast, impulse }
    }

    #[inline(always)]
    fn combination<const S: usize, A: Arithmetic>(&self, shapes: &Shapes<S>) -> Combination {
        let mut factors = Combination::ZERO;
        self.set_integrals::<S, A>(shapes, &mut factors);
        if shapes.variable == Variable::Time {
            self.set_derivatives::<S>(&mut factors.derivatives);
        }
        factors
    }

    /// Sets the factors of the integrals, for slow roots: the derivatives of the impulse response at the start, its power series.
    #[inline(always)]
    fn set_integrals<const S: usize, A: Arithmetic>(&self, shapes: &Shapes<S>, factors: &mut Combination) {
        // At the last node the powers are 1 / n!.
        let sizes = shapes.powers.iter().filter_map(|power| power.last());
        let Combination { integrals: Pair { q, v }, terms, .. } = factors;
        let mut entries = q.iter_mut().zip(v);
        match self.regime {
            Regime::Slow => {
                let (c, w) = (-self.damping * self.h, -self.omega_squared * self.h * self.h);
                // The factor of the velocity is the next one of the displacement.
                let (mut below, mut value) = (0.0_f64, 1.0_f64);
                for (size, (q, v)) in sizes.take(TERMS - 1).zip(entries.by_ref()) {
                    *terms += 1;
                    *q = below;
                    if below.abs().max(value.abs()) * size < NEGLIGIBLE {
                        return;
                    }
                    *v = value;
                    (below, value) = (value, A::mul_add(c, value, w * below));
                }
                if let Some((q, _)) = entries.next() {
                    *terms += 1;
                    *q = below;
                }
            }
            Regime::Fast => (),
            Regime::Split(slow, fast) => {
                let share = 1.0 / (slow - fast);
                let mut power = share;
                for (size, (q, v)) in sizes.zip(entries) {
                    *terms += 1;
                    *q = power;
                    power *= slow;
                    *v = power;
                    if power.abs() * size < NEGLIGIBLE * share {
                        break;
                    }
                }
            }
        }
    }

    /// Sets the factors of the derivatives, for fast roots.
    #[inline(always)]
    fn set_derivatives<const S: usize>(&self, factors: &mut Pair<[f64; MAX_SHAPES]>) {
        let factors = factors.q.iter_mut().zip(&mut factors.v).take(S + 1);
        match self.regime {
            Regime::Slow => (),
            Regime::Fast => {
                let (c, w) = (self.damping * self.h, self.omega_squared * self.h * self.h);
                let (mut below, mut value) = (0.0, 1.0 / w);
                for (q, v) in factors {
                    (*q, *v) = (value, below);
                    (below, value) = (value, -(c * value + below) / w);
                }
            }
            Regime::Split(slow, fast) => {
                let inverse = 1.0 / fast;
                let mut power = 1.0 / (slow - fast);
                for (q, v) in factors {
                    *v = power;
                    power *= inverse;
                    *q = power;
                }
            }
        }
    }

    /// Free motion: displacement (per step length) and velocity at the nodes per initial velocity.
    #[inline(always)]
    fn impulse<const S: usize, A: Arithmetic>(
        &self,
        nodes: &Nodal<S>,
        shapes: &Shapes<S>,
        factors: &Combination,
        decay: &Nodal<S>,
    ) -> Pair<Nodal<S>> {
        let (mut q, mut v) = ([0.0; S], [0.0; S]);
        match self.regime {
            Regime::Slow if self.fast <= FREE => {
                let series = factors.integrals.v.iter().take(factors.terms);
                for ((gamma, below), power) in series.zip(&shapes.powers).zip(shapes.powers.iter().skip(1)) {
                    add::<S, A>(&mut q, *gamma, power);
                    add::<S, A>(&mut v, *gamma, below);
                }
            }
            Regime::Split(slow, fast) => {
                let share = 1.0 / (slow - fast);
                let series = factors.integrals.q.iter().take(factors.terms);
                if slow > -0.5 {
                    for (term, power) in series.zip(&shapes.powers) {
                        add::<S, A>(&mut q, *term, power);
                    }
                } else {
                    q = scaled(&exp::<S, A>(&scaled(nodes, slow)), share);
                }
                for ((q, v), decay) in q.iter_mut().zip(&mut v).zip(decay) {
                    *v = A::mul_add(slow, *q, -share * fast * decay);
                    *q = A::mul_add(-share, *decay, *q);
                }
            }
            _ => {
                let roots = Roots::of([self.omega_squared; S], [self.damping; S]);
                let free = FreeMotion::side_by_side::<S, A>(&roots, &scaled(nodes, self.h));
                (q, v) = (free.q_from_v.map(|q| q / self.h), free.v_from_v);
            }
        }
        Pair { q, v }
    }

    /// Decay of the fast root up to the nodes.
    #[inline(always)]
    fn decay<const S: usize, A: Arithmetic>(&self, nodes: &Nodal<S>) -> Nodal<S> {
        let Regime::Split(_, fast) = self.regime else {
            return [0.0; S];
        };
        let exponents = scaled(nodes, fast);
        let mut decay = exp::<S, A>(&exponents);
        for (decay, exponent) in decay.iter_mut().zip(&exponents) {
            *decay = if *exponent > FADED { *decay } else { 0.0 };
        }
        decay
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrator::collocation::polynomial::{Collocation, LONG_BY_ROOT, LONG_BY_TIME, SHORT_BY_TIME};
    use crate::integrator::collocation::shapes::Table;
    use crate::integrator::collocation::superposition::Sum;
    use crate::math::legendre;
    use crate::math::simd::Separate;

    /// The response at `x` to a load shape by quadrature of the impulse response over many panels, in units of the
    /// step.
    fn by_quadrature(w: f64, c: f64, h: f64, x: f64, load: impl Fn(f64) -> f64) -> (f64, f64) {
        let scale = w.sqrt().max(c);
        // By the root of time, by which all loads are smooth.
        let end = x.sqrt();
        let panels = (1..20_000).find(|panels| f64::from(*panels) >= 2.0 * scale * h * x).unwrap();
        let width = end / f64::from(panels);
        let (mut q, mut v) = (0.0, 0.0);
        for panel in 0..panels {
            for (point, weight) in legendre::gauss(16) {
                let root = width * (f64::from(panel) + f64::midpoint(1.0, point));
                let s = root * root;
                let free = FreeMotion::new(w, c, h * (x - s));
                let weight = weight * width * root;
                q += weight * free.q_from_v / h * load(s);
                v += weight * free.v_from_v * load(s);
            }
        }
        (q, v)
    }

    #[expect(clippy::indexing_slicing, reason = "every index runs over the fixed size of the arrays")]
    fn agree<const S: usize>(collocation: &Collocation<S>) {
        let variable = collocation.variable;
        let nodes = collocation.nodes;
        let shape = |j: usize, s: f64| {
            let s = if variable == Variable::Root { s.sqrt() } else { s };
            let mut unit = [0.0; S];
            let Some(entry) = unit.get_mut(j) else {
                return collocation.places.iter().map(|node| 1.0 - s / node).product();
            };
            *entry = 1.0;
            collocation.interpolate(&unit, s)
        };
        for omega_h in [1e-3, 0.3, 2.0, 3.9, 5.1, 6.6, 6.8, 9.0, 25.0] {
            for ratio in [0.0, 0.01, 0.9, 1.0, 1.000_001, 1.2, 3.0, 30.0] {
                let (omega, h) = (1e4, omega_h / 1e4);
                let (w, c) = (omega * omega, 2.0 * ratio * omega);
                let mode = Mode { omega_squared: w, damping: c, ..Mode::default() };
                if variable == Variable::Root && h > ModeOverStep::longest_by_root(&mode) {
                    continue;
                }
                let response = ModeOverStep::new(w, c, h).response::<S, Separate>(&nodes, &collocation.shapes);
                let mut sum: Sum<S> = bytemuck::Zeroable::zeroed();
                sum.add::<Separate>(1.0, &response);
                let columns = sum.at_nodes::<Separate>(&collocation.shapes);
                let end = response.at_end::<Separate>(&collocation.shapes);
                let exact = nodes.map(|x| {
                    let response = |j| by_quadrature(w, c, h, x, |s| shape(j, s));
                    (0..=S).map(response).collect::<Vec<_>>()
                });
                let size =
                    |part: fn(&(f64, f64)) -> f64| exact.iter().flatten().map(part).map(f64::abs).fold(0.0, f64::max);
                let sizes = (size(|pair| pair.0), size(|pair| pair.1));
                for (i, exact) in exact.iter().enumerate() {
                    for (j, exact) in exact.iter().enumerate() {
                        // Cancellation relative to the largest response of the step: four of sixteen digits at the
                        // limit of the fast regime, 6.7 per step, where the highest derivatives for eight nodes are 1e8
                        // and more; ten times that for the shape of the error estimate. By the root of time the shapes are
                        // summed from its powers, with factors of 1e5 (2e-16 times that).
                        let tolerance = match (S, j < S) {
                            (8, true) if variable == Variable::Root => 1e-11,
                            (8, false) if variable == Variable::Root => 1e-10,
                            (8, true) => 2e-12,
                            (8, false) => 1e-11,
                            _ => 1e-12,
                        };
                        let agree = |q: f64, v: f64| {
                            let errors = ((q - exact.0) / sizes.0, (v - exact.1) / sizes.1);
                            assert!(
                                errors.0.abs() < tolerance && errors.1.abs() < tolerance,
                                "S {S}, omega h {omega_h}, ratio {ratio}, node {i}, shape {j}: {errors:?}"
                            );
                        };
                        let of = |table: &Table<S>| table.nodal.get(j).unwrap_or(&table.error)[i];
                        agree(of(&columns.q), of(&columns.v));
                        if i + 1 == S && j < S {
                            agree(end.q[j], end.v[j]);
                        }
                    }
                    let free = FreeMotion::new(w, c, nodes[i] * h);
                    let errors = (response.impulse.q[i] - free.q_from_v / h, response.impulse.v[i] - free.v_from_v);
                    assert!(errors.0.abs().max(errors.1.abs()) < 1e-14, "{omega_h} {ratio} {errors:?}");
                }
            }
        }
    }

    #[test]
    fn responses_agree_with_quadrature_in_every_regime() {
        agree(&SHORT_BY_TIME);
        agree(&LONG_BY_TIME);
        agree(&LONG_BY_ROOT);
    }
}
