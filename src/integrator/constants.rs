//! The knobs of the integrator: every number that was chosen for the control of steps and events, with its meaning, unit (1: a
//! ratio), source, and the test that pins it. Numbers that follow from a formula, and sizes of memory, stand where they are used.
//!
//! *Pinned*: with the number changed as told, that test fails. *Cost*: results do not depend on it, only the work, which the
//! bench `accuracy` and `cargo xtask instructions` show. The number of modes is chosen in [`mode_count`](crate::beam::mode_count).

// Step size.

/// Share of the tolerance that one step may add to the error, 1. Errors against tolerances over the scenes of
/// `tests/calibration.rs`: an impact makes errors of the motion before it a hundred times larger, and without damping
/// errors add up. Pinned: × 100, `tests/calibration.rs`.
pub const SHARE: f64 = 0.004;

/// Tolerance of steps where a looser one is asked, 1: with that, first guesses are poor and more steps are rejected, so that
/// the work grows. Cost.
pub const LOOSEST: f64 = 1e-2;

/// Factor on the length that the error estimate allows, 1. Chosen, as usual in step size control. Cost.
pub const SAFETY: f64 = 0.9;

/// Least factor on the length after a rejection, and on that of the first step after a jump of an acceleration, which sets faster modes
/// vibrating, 1. Chosen. Cost.
pub const LEAST_SHRINK: f64 = 0.1;

/// Largest factor on the length after a rejection, and the least after a step taken, 1. Chosen. Cost.
pub const MOST_SHRINK: f64 = 0.5;

/// Largest growth from one step to the next, and its square after slip has begun or ended, 1. With 4 iterations are lost where Newton's
/// method fails. Cost.
pub const STEP_GROWTH: f64 = 2.0;

/// Growth from step to step that shows that short steps still find their length, 1. Chosen by the work in the scenes.
/// Cost.
pub const GROWING: f64 = 1.5;

/// Length of a long step over that of a short one from which it costs less, 1. Chosen by the work in the scenes.
/// Pinned: × 500, `a_digit_costs_less_than_half_as_much_again`.
pub const WORTH: f64 = 2.0;

/// What polynomials through the nodes of a long step miss at its start of the root of the time since a closing, in powers of the size
/// of the Bernstein ellipse through the closing, 1. From their interpolation of the root: 0.14 to 0.22. Pinned: × 2,
/// `long_steps_after_a_closing_miss_as_much_of_a_root_as_they_may`.
pub const MISSED_ROOT: f64 = 0.2;

/// Length that a long step reaches at most, in short ones, 1. Observed. A leap after a closing has to reach farther to spare steps.
/// Pinned: × 1e6, `a_blow_takes_few_steps`.
pub const LONGER: f64 = 16.0;

/// Steps of the integrator for which a look at all modes has to serve: at what is unresolved one in so many; whether nothing moves up
/// to a communication point, or an exact step goes there, where it is as far. A look at each step costs 1 %. Cost.
pub const MANY_STEPS: u32 = 4;

/// Spacing of floating-point numbers of time, in first steps, beyond which a motion cannot be followed, 1. A tenth of a
/// fiftieth of the lowest period. Pinned: × 2, `a_time_too_coarse_for_the_motion_is_refused`.
pub const COARSEST: f64 = 0.1;

// Error estimate.

/// Largest ratio of a term of the force polynomial to the one before it from which the next terms are extrapolated, 1: a
/// term that passes through zero shows no slow decay. Chosen: terms of steps at the tolerance decay by five to ten.
/// Pinned: 0, `tests/promise.rs`.
pub const SLOWEST_DECAY: f64 = 1.0 / 3.0;

/// Mean over a step of what the nodal polynomial misses of the square root of time from its start, over what it misses
/// at the start, 1. From the quadrature of the root; of a power of the time left to its end 0.5 to 4 times as much. Pinned: ÷ 1000,
/// `tests/chatter.rs` (interruptions of microseconds).
pub const KINKED: f64 = 0.015;

/// Factor on the error that the contact's damper takes back, where a step is accepted or rejected, 1: the velocity at its
/// start is wrong by what the step before has left for the damper, and no shorter step has less of that. Pinned: ÷ 2, hard
/// case "Spring without damping".
pub const INHERITED: f64 = 0.25;

/// The same in a communication step that begins with another input, and for the length of the next step too, 1.
/// Observed: with a fifth of it errors of springs that ring on add up to more than the tolerance. Pinned: ÷ 5,
/// `relays_that_once_exceeded_the_tolerance_keep_it`.
pub const DRIVEN: f64 = 0.1;

/// Next terms of the force polynomial, in the error allowed in what is read, below which the law is not looked at where the force turns,
/// 1: there it has differed by up to four of them. Pinned: infinite, `relays_that_once_exceeded_the_tolerance_keep_it`.
pub const LOOKED: f64 = 0.1;

/// Rounding of a contact force, of loads or of the indentation between nodes, relative to them, 1. About a thousand
/// roundings. Pinned: × 1e8, `tests/calibration.rs`.
pub const FORCE_ROUNDING: f64 = 1e-13;

/// Error that stands for mere rounding, relative to the one allowed, 1: long steps may then grow as fast as they ever do, and
/// short ones are not thought to do as well. Cost.
pub const ROUNDED: f64 = 1e-7;

/// Rounding of a motion, relative to the sums over the modes and the ways of the inputs that it is made of, 1. Four roundings.
/// Pinned: × 1e8, `tests/promise.rs`; in Newton's method 0 only adds rejected steps.
pub const MOTION_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The same of the free motion over a step, 1: its coefficients cancel where a root fades within the step, so that the first forces
/// differ from the one at the start by this in steps of any length. Twice the bound of `responses_agree_with_quadrature_in_every_regime`.
/// Pinned: ÷ 20, `steps_at_the_tightest_tolerance_do_not_stay_short`.
pub const FREE_ROUNDING: f64 = 2e-14;

// Newton's method.

/// Largest difference that it leaves between a nodal force and that of the law, in errors allowed in a step, 1. Small
/// compared with the error estimate. Pinned: × 1000, `tests/promise.rs`.
pub const NEWTON: f64 = 0.2;

/// Iterations before a step is judged too long. Most solutions need one or two. Cost.
pub const ITERATIONS: u64 = 12;

/// Largest ratio of a residual to the one before it with which the Jacobian of several unknowns still serves, 1. Where it may leave more
/// of the residual, that is what limits the next steps. Cost.
pub const STALE: f64 = 0.03;

/// Pivot below which rows are exchanged, 1. An elimination multiplies rounding by its inverse. Pinned: 0,
/// `a_small_pivot_costs_no_digits`.
pub const SMALL_PIVOT: f64 = 0.1;

/// Length of a step, in those of the one before, beyond which its forces are first guessed by a parabola. Cost.
pub const FAR_AHEAD: f64 = 1.5;

// Events.

/// Share of its greatest value above which a nodal polynomial stays positive between its nodes if it is at them, 1.
/// Chosen. Pinned: below zero, `tests/chatter.rs`, `tests/benchmarks/opening_threshold.rs`.
pub const NEAR: f64 = 0.25;

/// Halvings before an interval counts as an instant. A part of 1e-12 of the interval. Pinned: ÷ 40, hard case
/// "Grazing spring".
pub const HALVINGS: u32 = 40;

/// Part of the change of the engagement between two samples that fast modes may make unseen, 1. Pinned: infinite,
/// `relays_with_friction_keep_their_tolerance_or_say_that_they_may_not`.
pub const UNSEEN: f64 = 1e-2;

/// Part of the flight examined that a contact stays open at least, 1. The integration must advance where a contact
/// closes as it opens. Pinned: 0, hard case "Grazing mass".
pub const SHORTEST_FLIGHT: f64 = 1e-3;

/// Error allowed in the motion at an opening, and force that counts as zero there, or where a contact begins or ceases to slip, in
/// errors allowed in a step, 1: the blow that follows makes it a hundred times larger. Pinned: × 100,
/// `what_is_read_inside_the_integrators_steps_is_within_the_tolerance`.
pub const AT_EVENT: f64 = 0.01;

/// Length from which on a step is counted by the force that the deviation makes in it, per radian of the lowest mode, 1: a nanosecond of
/// the specimen. A communication point is hardly ever nearer to the instant of a closing, at which a wrong instant is a wrong force.
/// Chosen.
pub const SEEN: f64 = 2e-6;

/// Distance beyond which the other contact is not looked for in a step of flight, in ways of the tip at its nodes and at the
/// fastest velocity there, 1. What swings unseen between so many nodes is no larger. Pinned: negative, `tests/second`.
pub const DISTANT: f64 = 8.0;

/// Changes between stick and slip that take no time, before the contact goes on as it is for one step of the shortest length. Only
/// rounding makes them. Cost.
pub const MOST_CHANGES: u32 = 16;

/// Pieces of a step, or of a part of it, in each of which at most two extremes of its force polynomial are looked for. The degree of long steps.
/// Pinned: ÷ 8, `tests/promise.rs`.
pub const PIECES: usize = 8;

// Axial force, rest, energy.

/// Change of the contact force, in tolerances, that a contact at rest may still have before it, 1. Pinned: × 1e5,
/// `motion_comes_to_rest_in_the_equilibrium_of_all_parts`.
pub const UNREST: f64 = 1e-2;

/// Change of the stiffness of the modes by an axial force that counts as small, 1: from 1 on that might vanish, and the
/// energy bound of rest with it. Smaller ones cost steps; no test fails with a larger one.
pub const WEAK: f64 = 0.1;

/// Share of the tolerance that the force may be wrong by to return energy, 1. Pinned: 0, `a_mass_between_two_stops`.
pub const RETURNED: f64 = 0.05;
