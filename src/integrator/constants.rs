//! Every number of the integrator that was chosen: its meaning and unit, where it comes from, and the test that pins it: that
//! fails when the number is changed by the factor named. *Cost*: results do not depend on it, only the work; the bench `cost`
//! and `cargo xtask instructions` show it. The number of modes is chosen in [`Model`](crate::model::Model).

// Step size.

/// Share of the tolerance that one step may add to the error, 1. Errors against tolerances over the scenes of
/// `tests/calibration.rs`: an impact makes errors of the motion before it a hundred times larger, and without damping
/// errors add up.
pub const SHARE: f64 = 0.004;

/// Growth from step to step that shows that short steps still find their length, 1. Work in the chatter scene.
pub const GROWING: f64 = 1.5;

/// Length of a long step over that of a short one from which it costs less, 1. Ratio of the times of both, measured.
pub const WORTH: f64 = 2.0;

/// Length that a long step reaches at most, in short ones, 1. Observed over all tolerances.
pub const LONGER: f64 = 16.0;

/// Tolerance below which rounding of the polynomials of long steps shows, 1. Error of the paper scene at 1e-11.
pub const LONG_FLOOR: f64 = 3e-11;

/// Length of a communication step, in steps of the integrator, from which one of them ends with it, 1. Work in scenes
/// with random communication steps.
pub const MANY_STEPS: f64 = 4.0;

/// Spacing of floating-point numbers of time, in first steps, beyond which a motion cannot be followed, 1. A tenth of a
/// fiftieth of the lowest period.
pub const COARSEST: f64 = 0.1;

/// Steps rejected in succession before the discrete gradient takes one. Forty halvings reach the shortest step.
pub const REFUSALS: u32 = 40;

// Error estimate.

/// Error of the contact force inside a step, per force that its polynomial misses at the start, 1. The largest value of
/// the vanishing shape behind the first node.
pub const INSIDE: f64 = 0.3;

/// Mean over a step of what the nodal polynomial misses of the square root of time from its start, over what it misses
/// at the start, 1. Quadrature of the root.
pub const KINKED: f64 = 0.015;

/// Distance from a kink beyond which it is not felt, steps. The factor of the kink is below rounding there.
pub const FAR: f64 = 20.0;

/// Rounding of a contact force or of loads, relative to them, 1. Some hundred roundings.
pub const FORCE_ROUNDING: f64 = 1e-13;

/// Roundings in a sum over the modes, 1. Four partial sums.
pub const SUM_ROUNDINGS: f64 = 4.0;

// Newton's method.

/// Largest difference that it leaves between a nodal force and that of the law, in errors allowed in a step, 1. Small
/// beside the error estimate.
pub const NEWTON: f64 = 0.2;

/// Iterations before a step is judged too long. It converges in one to four, or not at all.
pub const ITERATIONS: u64 = 12;

/// Rounding of the motion at the nodes, relative to what it would be without contact force, 1. Four partial sums.
pub const MOTION_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Pivot below which rows are exchanged, 1. Rounding grows by its inverse in an elimination.
pub const SMALL_PIVOT: f64 = 0.1;

/// Nodes of the flatter of the two predictions of the force. Iterations over the scenes.
pub const FLAT: usize = 4;

// Work.

/// Steps of known lengths that a communication step may take. Seconds of computing.
pub const STEPS: u64 = 10_000_000;

/// Further ones per second of it, 1/s. A tenth of a microsecond a step.
pub const RATE: f64 = 1e7;

/// Work of a step of a new length, in steps of known lengths. Instructions of both.
pub const NEW_LENGTH: u64 = 10;

/// Step lengths whose coefficients are kept, a power of two. Memory against recomputation.
pub const SLOTS: usize = 32;

// Events.

/// Points at which a nodal polynomial is examined where it comes near zero. Half a period of degree eight has four.
pub const LOOKS: u32 = 32;

/// Share of its greatest value above which a nodal polynomial stays positive between its nodes if it is at them, 1.
/// Lebesgue constant of the nodes.
pub const NEAR: f64 = 0.25;

/// Halvings before an interval counts as an instant. The spacing of floating-point numbers in a step.
pub const DEPTH: u32 = 40;

/// Part of the change of the engagement between two samples that fast modes may make unseen, 1.
pub const UNSEEN: f64 = 1e-2;

/// Part of the flight examined that a contact stays open at least, 1. The integration must advance where a contact
/// closes as it opens.
pub const SHORTEST_FLIGHT: f64 = 1e-3;

/// Places in a step at which the force is looked for clearly on its old side of a threshold.
pub const PLACES: u32 = 8;

/// Pieces of a step in each of which its force polynomial has one extreme at most. Its degree.
pub const PIECES: u32 = 8;

/// Openings and closings of a communication step that are kept for the log.
pub const EVENTS_KEPT: usize = 1024;

// Response of a mode.

/// Root times step length up to which the power series keeps its digits, 1: its terms grow to about `7^6 / 7!`.
pub const SLOW: f64 = 6.7;

/// Root times step length from which the derivatives of a shape fall fast enough against its powers, 1.
pub const FAST: f64 = 5.0;

/// Root times step length up to which the power series of the free motion keeps its digits, 1: `2^2 / 2!`.
pub const FREE: f64 = 2.0;

/// Terms of a power series below this are left out, 1. A thousandth of rounding.
pub const NEGLIGIBLE: f64 = 1e-19;

/// Most terms of a power series: `7^n / n!` is below rounding from there on.
pub const TERMS: usize = 48;

/// Points of the quadrature for repeated integrals. Exact for all that are large.
pub const POINTS: usize = 20;

// Axial force, rest, energy.

/// Rounds of the fixed-point iteration for the axial force before a step is judged too long.
pub const ROUNDS: u32 = 8;

/// Change of the contact force, in tolerances, that a contact at rest may still have before it, 1.
pub const UNREST: f64 = 1e-2;

/// Rounding of a contact force at rest, relative to it, 1.
pub const REST_ROUNDING: f64 = 1e-14;

/// Change of the stiffness of the modes by an axial force that counts as small, 1.
pub const WEAK: f64 = 0.1;

/// Share of the tolerance that the force may be wrong by to return energy, 1.
pub const RETURNED: f64 = 0.05;
