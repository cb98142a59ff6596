//! Every number that was chosen for the integrator: meaning, unit (1: a ratio), source, and the test that pins it.
//!
//! *Pinned*: with the number changed as told, that test fails. *Cost*: results do not depend on it, only the work, which the
//! bench `cost` and `cargo xtask instructions` show. The number of modes is chosen in [`mode_count`](crate::beam::mode_count).

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

/// The same after a rejection, 1. Chosen. Cost.
pub const AFTER_REJECTION: f64 = 0.8;

/// Least factor on the length after a rejection, 1. Chosen. Cost.
pub const LEAST_SHRINK: f64 = 0.1;

/// Largest factor on the length after a rejection, and the least after a step taken, 1. Chosen. Cost.
pub const MOST_SHRINK: f64 = 0.5;

/// Largest factor on the length of a step that cannot end at an event inside, 1: to the next length of free steps. Cost.
pub const NEXT_LENGTH: f64 = 0.75;

/// Largest growth that a step taken reports, 1. Chosen. Cost.
pub const MOST_GROWTH: f64 = 64.0;

/// Largest growth from one step to the next, 1. Chosen. Cost.
pub const STEP_GROWTH: f64 = 4.0;

/// Growth from step to step that shows that short steps still find their length, 1. Chosen by the work in the scenes.
/// Cost.
pub const GROWING: f64 = 1.5;

/// Length of a long step over that of a short one from which it costs less, 1. Chosen by the work in the scenes.
/// Pinned: × 500, `a_digit_costs_less_than_half_as_much_again`.
pub const WORTH: f64 = 2.0;

/// Length of a long step after a closing over the time since then, 1: nearer to it the force is not smooth enough for
/// polynomials of high degree. Cost.
pub const SMOOTH: f64 = 2.0;

/// Length that a long step reaches at most, in short ones, 1. Observed. Cost.
pub const LONGER: f64 = 16.0;

/// Factor on the length of short steps after a long one in a communication step that begins with another input, 1: whether
/// they suffice shows when they are tried again. Cost.
pub const AGAIN: f64 = 1.1;

/// Length of a communication step, in steps of the integrator, from which one of them ends with it, 1. Chosen by the
/// work in the scenes. Cost.
pub const MANY_STEPS: f64 = 4.0;

/// Spacing of floating-point numbers of time, in first steps, beyond which a motion cannot be followed, 1. A tenth of a
/// fiftieth of the lowest period. Pinned: × 2, `a_time_too_coarse_for_the_motion_is_refused`.
pub const COARSEST: f64 = 0.1;

/// Steps rejected in succession before the discrete gradient takes one, which no polynomial follows: with more, steps are
/// tried down to the rounding of time. Chosen. Cost.
pub const REFUSALS: u32 = 40;

// Error estimate.

/// Error of the contact force inside a step, per force that its polynomial misses at the start, 1: the shape that it lacks
/// is largest there. Pinned: 0.3, `tests/promise.rs`.
pub const INSIDE: f64 = 1.0;

/// Largest ratio of a term of the force polynomial to the one before it from which the next terms are extrapolated, 1: a
/// term that passes through zero shows no slow decay. Chosen: terms of steps at the tolerance decay by five to ten.
/// Pinned: 0, `tests/promise.rs`.
pub const SLOWEST_DECAY: f64 = 1.0 / 3.0;

/// Mean over a step of what the nodal polynomial misses of the square root of time from its start, over what it misses
/// at the start, 1. From the quadrature of the root. Pinned: ÷ 1000, `tests/chatter.rs` (interruptions of
/// microseconds).
pub const KINKED: f64 = 0.015;

/// Mean over a step of 4 nodes of what the nodal polynomial misses of a sine, times its amplitude, over the square of what
/// it misses at the start, 1, where the phase passes 1 rad: error of the Radau quadrature, `S 2^(2 S - 1) (S - 1)!^4 /
/// (2 S - 1)!^3 (h / 2)^(2 S) / h` per derivative of order `2 S - 1`, and the product of the nodes over `S!` (P. J. Davis,
/// P. Rabinowitz, Methods of Numerical Integration, 1984, section 2.7). Pinned: 0, `tests/promise.rs`.
pub const QUADRATURE_SHORT: f64 = 1.4e-2;

/// [`QUADRATURE_SHORT`] with 8 nodes.
pub const QUADRATURE_LONG: f64 = 8e-5;

/// Factor on the estimated error just after a closing, 1, where steps grow with the time since. Pinned: ÷ 10,
/// `former_excesses_are_within_the_tolerance`.
pub const AFTER_BLOW: f64 = 10.0;

/// Time since a closing up to which that holds, steps. Observed. Pinned: 0, `former_excesses_are_within_the_tolerance`.
pub const NEAR_BLOW: f64 = 3.0;

/// Factor on the error that the contact's damper takes back, where a step is accepted or rejected, 1: the velocity at its
/// start is wrong by what the step before has left for the damper, and no shorter step has less of that. Pinned: ÷ 2, hard
/// case "Spring without damping".
pub const INHERITED: f64 = 0.25;

/// The same in a communication step that begins with another input, and for the length of the next step too, 1.
/// Observed: errors delivered are a quarter of what that allows, 0.2 of the tolerance, at most. Pinned: ÷ 20,
/// `inputs_and_lengths_that_are_new_in_each_step_keep_the_tolerance`.
pub const DRIVEN: f64 = 0.02;

/// Factor on the error inside such a step, 1: what is read goes through the start of the step too, and beyond the first node
/// the shape that it lacks is 0.4 of what it is at the start. Observed: of 3,300 closed relays with held inputs none is above
/// its tolerance, one of 1,448 with 0.4. Pinned: 0, the same test.
pub const INSIDE_DRIVEN: f64 = 0.5;

/// Distance from a kink beyond which it is not felt, steps. The factor of the kink is below 2e-6 there. Cost.
pub const FAR: f64 = 20.0;

/// Rounding of a contact force, of loads or of the indentation between nodes, relative to them, 1. About a thousand
/// roundings. Pinned: × 1e8, `tests/calibration.rs`.
pub const FORCE_ROUNDING: f64 = 1e-13;

/// Error that stands for mere rounding, relative to the one allowed, 1: long steps may then grow as fast as they ever do, and
/// short ones are not thought to do as well. Cost.
pub const ROUNDED: f64 = 1e-7;

/// Roundings in a sum over the modes, 1. Chosen. Pinned: × 1e12, `tests/calibration.rs`.
pub const SUM_ROUNDINGS: f64 = 4.0;

// Newton's method.

/// Largest difference that it leaves between a nodal force and that of the law, in errors allowed in a step, 1. Small
/// compared with the error estimate. Pinned: × 1000, `tests/calibration.rs`.
pub const NEWTON: f64 = 0.2;

/// Iterations before a step is judged too long. Most solutions need one or two. Cost.
pub const ITERATIONS: u64 = 12;

/// Largest ratio of a residual to the one before it with which the Jacobian of a contact that sticks still serves, 1. Cost.
pub const STALE: f64 = 0.03;

/// Rounding of the motion at the nodes, relative to what it would be without contact force, 1. Four roundings.
/// Pinned: × 1e8, `tests/promise.rs`; 0 only adds rejected steps.
pub const MOTION_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Pivot below which rows are exchanged, 1. An elimination multiplies rounding by its inverse. Pinned: 0,
/// `a_small_pivot_costs_no_digits`.
pub const SMALL_PIVOT: f64 = 0.1;

/// Length of a step, in those of the one before, beyond which its forces are first guessed by a parabola. Cost.
pub const FAR_AHEAD: f64 = 1.5;

// Work.

/// Work that a communication step may take, however long it is, in modes at nodes: each takes some forty instructions, all
/// together one to three seconds on processors of 2026. Pinned: ÷ 1e5 and × 100, `tests/fmi_api`.
pub const WORK: u64 = 500_000_000;

/// Work of a step of a new length, in that of one of a known length. Instructions of both. Cost.
pub const NEW_LENGTH: u64 = 10;

/// Step lengths whose coefficients are kept, a power of two: those of 32 octaves with and without half of their own, as
/// free steps have them, from nanoseconds after a blow to seconds. Cost.
pub const SLOTS: usize = 64;

/// Step lengths for which the coefficients of exact linear steps are kept. Chosen. Cost.
pub const LENGTHS: usize = 8;

// Events.

/// Points at which a nodal polynomial is examined where it comes near zero. Chosen. Pinned: ÷ 16, `tests/chatter.rs`.
pub const LOOKS: u32 = 32;

/// Share of its greatest value above which a nodal polynomial stays positive between its nodes if it is at them, 1.
/// Chosen. Pinned: below zero, `tests/chatter.rs`, `tests/benchmarks/opening_threshold.rs`.
pub const NEAR: f64 = 0.25;

/// Halvings before an interval counts as an instant. A part of 1e-12 of the interval. Pinned: ÷ 40, hard case
/// "Grazing spring".
pub const DEPTH: usize = 40;

/// Halvings of the cubic between two samples before the motion in their middle is computed. Cost.
pub const HALVINGS: u32 = 3;

/// Part of the change of the engagement between two samples that fast modes may make unseen, 1. Pinned: infinite,
/// `relays_with_friction_keep_their_tolerance_or_say_that_they_may_not`.
pub const UNSEEN: f64 = 1e-2;

/// Part of the flight examined that a contact stays open at least, 1. The integration must advance where a contact
/// closes as it opens. Pinned: 0, hard case "Grazing mass".
pub const SHORTEST_FLIGHT: f64 = 1e-3;

/// Error allowed in the motion at an opening, in errors allowed in a step, 1: the blow that follows makes it a hundred
/// times larger. Pinned: × 100, `tests/calibration.rs`.
pub const AT_EVENT: f64 = 0.01;

/// Force that counts as zero where the contact opens or begins or ceases to slip, in errors allowed in a step, 1. Chosen. Cost.
pub const LOCATED: f64 = 0.05;

/// Instants at which the exact motion inside a step is looked at to find an event, before it is bracketed. Newton's and the
/// secant method need three. Cost.
pub const GUESSES: u32 = 8;

/// Distance beyond which the other contact is not looked for in a step of flight, in ways of the tip at its nodes and at the
/// fastest velocity there, 1. What swings unseen between so many nodes is no larger. Pinned: negative, `tests/second`.
pub const DISTANT: f64 = 8.0;

/// Changes between stick and slip that take no time, before the contact goes on as it is for one step. Only rounding makes
/// them. Pinned: 0, `amplitude_of_a_coulomb_damped_oscillator`.
pub const MOST_CHANGES: u32 = 16;

/// Pieces of a step in each of which at most two extremes of its force polynomial are looked for. The degree of long steps.
/// Pinned: ÷ 8, `tests/promise.rs`.
pub const PIECES: u32 = 8;

/// Openings and closings of a communication step that are kept for the log. Pinned: ÷ 512,
/// `every_event_is_reported_once`.
pub const EVENTS_KEPT: usize = 1024;

// Response of a mode.

/// Root times step length up to which the power series keeps its digits, 1: its terms grow to about `7^6 / 7!`. Pinned:
/// × 4.5, the library's unit tests do not end.
pub const SLOW: f64 = 6.7;

/// Root times step length from which the derivatives of a shape fall fast enough against its powers, 1. Pinned: ÷ 10,
/// `responses_agree_with_quadrature_in_every_regime`.
pub const FAST: f64 = 5.0;

/// Root times step length up to which the power series of the free motion keeps its digits, 1: `2^2 / 2!`. Pinned: ×
/// 10, `responses_agree_with_quadrature_in_every_regime`.
pub const FREE: f64 = 2.0;

/// Terms of a power series below this are left out, 1. A thousandth of rounding. Pinned: × 1e10,
/// `responses_agree_with_quadrature_in_every_regime`.
pub const NEGLIGIBLE: f64 = 1e-19;

/// Most terms of a power series: `7^n / n!` is below rounding from there on. Pinned: ÷ 4,
/// `responses_agree_with_quadrature_in_every_regime`.
pub const TERMS: usize = 48;

/// Points of the quadrature for repeated integrals. Exact for all that are large. Pinned: ÷ 5,
/// `responses_agree_with_quadrature_in_every_regime`.
pub const POINTS: usize = 20;

// Axial force, rest, energy.

/// Rounds of the fixed-point iteration for the axial force before a step is judged too long. Pinned: ÷ 8,
/// `tests/axial`.
pub const ROUNDS: u32 = 8;

/// Change of the contact force, in tolerances, that a contact at rest may still have before it, 1. Pinned: × 1e5,
/// `rest_is_found_and_kept`.
pub const UNREST: f64 = 1e-2;

/// Rounding of a contact force at rest, relative to it, 1. Pinned: × 1e11, `rest_is_found_and_kept`.
pub const REST_ROUNDING: f64 = 1e-14;

/// Change of the stiffness of the modes by an axial force that counts as small, 1: from 1 on that might vanish, and the
/// energy bound of rest with it. Smaller ones cost steps; no test fails with a larger one.
pub const WEAK: f64 = 0.1;

/// Share of the tolerance that the force may be wrong by to return energy, 1. Pinned: 0, `a_mass_between_two_stops`.
pub const RETURNED: f64 = 0.05;
