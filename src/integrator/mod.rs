//! The transient integrator: **the method**, and the files that carry it out.
//!
//! The spring is linear and only its tip is loaded. So each mode is propagated exactly, whatever its stiffness and
//! damping, and what is left to solve is one scalar equation in time: the contact force is the contact law at the
//! motion of the tip, and the motion of the tip follows from the contact force. A step represents the force by a
//! polynomial through collocation nodes and solves for the nodal forces. Stiff modes cost nothing, as they are
//! evaluated and never integrated.
//!
//! Numbers that were chosen stand in [`constants`], each with its unit, its source and the test that pins it; this page
//! names them and does not repeat them.
//!
//! # Equations
//!
//! All quantities are deviations from the static preload (`F_0`, `d_0`): the indentation is tens of nanometres beside
//! an overtravel of tenths of a millimetre, and forming the difference at each step would lose four digits. With the
//! modes of the cantilever without contact ([`Mode`](crate::beam::mode::Mode): `omega_i`, `c_i = alpha + beta
//! omega_i^2`, tip displacement `T_i`, participation `g_i`, modal mass 1 kg), base acceleration `a`, displacement `u`
//! of the fixed contact and contact law `F(d, d')`:
//!
//! ```text
//! q_i'' + c_i q_i' + omega_i^2 q_i = T_i (F - F_0) - g_i a          i = 1 ... n
//! d - d_0 = u - sum T_i q_i
//! F = F(d, d') while the contact is closed, 0 while it is open
//! ```
//!
//! (Machines 2025, 13(1), 52, eqs. 1, 2, 7, 8, 14, 22; the contact's damping is that of Kuwabara and Kono.) With the
//! axial force that follows the deflection every mode has a further load, see *Axial force*; with friction the spring has one
//! more at its contact, see *Friction*.
//!
//! The modes are Ritz vectors in a space of polynomials that contains the deflection under a static tip load
//! ([`galerkin`](crate::beam::galerkin)). The static compliance of the tip is therefore exact with any number of them,
//! and the contact force converges exponentially; eigenvectors of the continuum cut off at `n` would converge like `1 /
//! n^3`.
//!
//! # One step
//!
//! Over a step of length `h`, `x = (t - t_0) / h`, force and base acceleration are polynomials `sum F_j l_j(x)`, `sum
//! a_j l_j(x)` through `S` nodes `x_j` (`l_j`: Lagrange polynomials; [`collocation::polynomial`]). The response of a
//! mode to a polynomial is known in closed form. Summed over the modes, indentation and velocity at the nodes are
//! linear in the nodal forces,
//!
//! ```text
//! d_k  = d_k(free)  - sum_j D_kj F_j        D  = sum_i T_i^2 (response of mode i at x_k to l_j)
//! d'_k = d'_k(free) - sum_j D'_kj F_j
//! ```
//!
//! where *free* is the motion under the initial modal state, the base acceleration and the fixed contact, without a
//! change of the contact force ([`collocation::step`]). `D` and `D'` are `S` by `S`, however many modes there are, and
//! depend on `h` alone. They are kept by step length ([`collocation::coefficients`]), and step lengths are chosen so
//! that they recur ([`grid`]).
//!
//! *Response of one mode* ([`collocation::modal_response`]). Integrated by parts, the response to `l_j` is either a
//! series of the repeated integrals of `l_j` (power series of the impulse response), or a finite sum of the derivatives
//! of `l_j` (the motion that follows the load) and a free motion that cancels its start. The first keeps its digits
//! where the roots of the mode times `h` are below [`constants::SLOW`], the second where they are above
//! [`constants::FAST`]; an overdamped mode with one root of each kind splits into both. The sums over the modes are
//! formed on these coefficients, before they meet the tables of the shapes ([`collocation::superposition`],
//! [`collocation::shapes`]). At the end of the step each mode has its own row.
//!
//! *Nodes.* They are those of Radau IIA: the last one is the end of the step. The force there obeys the law exactly, so
//! an overdamped contact, which is nearly the algebraic constraint `d' = 0`, does not excite the step that follows;
//! with Gauss nodes the force at the end is an extrapolation, and errors in it do not decay (Hairer, Wanner, Solving
//! Ordinary Differential Equations II, 1996, section IV.5 and VI.1). The quadrature has order `2 S - 1`, which is what
//! slow modes see at the end of the step; at the inner nodes the error is of order `h^(S + 1)`.
//!
//! *Four or eight of them* ([`SHORT`](crate::math::nodal::SHORT), [`LONG`](crate::math::nodal::LONG)). Both have a step
//! length of their own in the state. Eight are used in flight, where the force is known, and where they reach at least
//! [`constants::WORTH`] times as far as four within what is left to integrate; four in short communication steps and just
//! after a closing, where the force is not smooth: a long step is at most [`constants::SMOOTH`] times as long as the time
//! since. Polynomials are expanded about the middle of their step: about an end, rounding would show at the tightest tolerance.
//!
//! # Newton's method
//!
//! The unknowns are the `S` nodal forces ([`collocation::newton`]). The residual is `F_k - F(d_k, d'_k)` on the closed
//! branch of the law, continued smoothly beyond the point at which the force vanishes. With stiffness `k_k` and damping
//! `c_k` of the law at the nodes the Jacobian is
//!
//! ```text
//! 1 + diag(k_k) D + diag(c_k) D'
//! ```
//!
//! and is solved by Gauss-Jordan elimination together with the right-hand sides of the error estimate. The first guess
//! continues the force of the last step: by its polynomial, or over a much longer step ([`constants::FAR_AHEAD`]) by the
//! parabola at its end, as polynomials of high degree lead astray. That makes most solutions one or two iterations.
//! Iteration ends when all residuals are below [`constants::NEWTON`] of the error allowed in a step, or below what the
//! rounding of the motion makes of the law ([`constants::MOTION_ROUNDING`]); after [`constants::ITERATIONS`] the step is
//! rejected. In free flight the nodal forces are known and there is no iteration.
//!
//! # Error estimate
//!
//! The shape of lowest degree that the nodal polynomials lack is the one of degree `S` that vanishes at the nodes and
//! is 1 at the start of the step. How much of it the force lacks shows at the start: `m`, the force there less the
//! nodal polynomial extrapolated to it; likewise `m_a` for the base acceleration. The response of the modes to that
//! shape is part of the coefficients, so what `m` and `m_a` do to indentation and velocity at the end is known to first
//! order, with the reaction of the contact (the two further right-hand sides of Newton's method). Three parts are added
//! ([`collocation::error`]):
//!
//! - stiffness and damping of the law (the greatest at start and nodes, which may all lie beyond an opening) times these
//!   errors of indentation and velocity: the part of modes that are fast against the step;
//! - the part of slow modes, which hardly feel the shape, as it is orthogonal to polynomials of low degree: three times
//!   `m^2` over the largest force (fitted to the impact of a free mass on a Hertz contact), and for the base acceleration
//!   the error of the quadrature, [`constants::QUADRATURE_SHORT`] `m_a^2` over the largest acceleration;
//! - after a closing or a jump, where the force moves like the root of time: a share [`constants::KINKED`] of `m`,
//!   which falls with the distance from the kink as the convergence of a polynomial near a branch point does
//!   (Trefethen, Approximation Theory and Approximation Practice, 2013, chapters 8 and 19).
//!
//! Just after a closing, within [`constants::NEAR_BLOW`] steps of it, the sum counts [`constants::AFTER_BLOW`] times.
//!
//! The last two are reduced by `g / (1 + g)`, `g` the force of the law at the end of the step per force on the tip throughout it.
//!
//! In flight the estimate is what `m_a` does to the indentation at any node, times the stiffness the contact would have
//! at the force scale, and what the error of the quadrature of the acceleration makes of it in `1 / omega_1`.
//!
//! A step that ends inside, at an event, has a larger error, as the shape is not orthogonal to anything there: what `m`
//! and `m_a` do to the nodal forces, and the greatest impulse of the shape times `m` and `m_a`; in flight what `m_a`
//! does to the velocity, in `1 / omega_1`. A blow makes it a hundred times larger, so at an opening it has to be below
//! [`constants::AT_EVENT`] of the error allowed in a step.
//!
//! An estimate below what rounding makes of the sums over the modes counts as small ([`constants::ROUNDED`]): no shorter
//! step reduces it.
//!
//! # Step size control
//!
//! A step may add [`constants::SHARE`] of `solver.tolerance` times the force scale ([`attempt`], [`step_control`]). Its
//! length is multiplied by `(allowed / estimate)^(1 / (S + 1))` and [`constants::SAFETY`], with bounds on growth and
//! shrinkage beside it. It is accepted by its estimate with [`constants::INHERITED`] of what the contact's damper takes back:
//! the velocity at its start is wrong by what the step before has left of that, and a shorter step would be rejected as well.
//! Step ends lie on a grid: binary fractions of the communication step, or lengths of 1 and 1.5
//! times powers of two where the integrator runs ahead ([`grid`]), so that coefficients recur; the generator's corners
//! (start, end, crossover) end a step, and the step size starts anew there. After a closing the force is smooth in the
//! logarithm of the time since: the next step may be longer in the ratio in which that time grows, beside what the
//! estimate says. A step is never longer than a quarter of the generator's shortest period, nor than
//! `solver.maximumStep`. Without damping, a step that makes more energy than a force wrong by the tolerance would is
//! rejected too.
//!
//! Work is counted and bounded per communication step, however long that is ([`constants::WORK`]; [`workspace`]):
//! beyond it the step ends with an error that names the time.
//!
//! # Number of modes
//!
//! What too few modes miss is felt most in an impact, which excites all of them, and in what rings on until the next. Its
//! error falls exponentially with their number; how fast depends on damping and rivet of the spring and on the stiffness of
//! the contact, which together limit the wave number that an impact excites
//! ([`mode_count`](crate::beam::mode_count)). Their number follows from that and from the tolerance, up to
//! [`MAX_MODES`](crate::beam::mode::MAX_MODES), and does not change during a simulation.
//!
//! # Events
//!
//! A step ends where the contact opens or closes ([`events`]): the step accepted is cut there. Inside it the motion of the
//! modes is exact under the polynomials of force and base acceleration ([`collocation::part`], with the modes
//! [`side by side`](collocation::side_by_side)): up to an instant these are nodal polynomials again, so no coefficients of a
//! step of that length are needed and no Newton iteration. The instant is found by Chandrupatla's bracketing method
//! ([`roots`](crate::math::roots)) on the polynomials through indentations and velocities at the nodes, then by the secant
//! method on the exact motion, until the force there is below [`constants::LOCATED`] of the error allowed in a step. Where
//! the error inside is too large the step is repeated, shorter but of a length whose coefficients are known.
//!
//! - *Opening* ([`events::opening`]): the law's force reaches zero, at a node or in a dip of the nodal polynomial
//!   between nodes. With contact damping that is before the surfaces part. Not within rounding of time after a closing, where
//!   rounding alone would open it.
//! - *Closing* ([`events::closing`]): in flight, indentation and velocity at the nodes define cubics, whose error is
//!   estimated from neighbouring nodes. Intervals in which the highest point of the cubic, plus that error, plus the
//!   amplitudes of modes that vibrate faster than the interval, stays open are clear; others are halved, first on the
//!   cubic, then by the exact motion in the middle. A grazing
//!   touch is therefore not missed, as it is by a search for changes of sign. In the step that begins with an opening,
//!   an engagement that rounding alone leaves there is no contact.
//! - *Interruption* ([`events::interruption`]): the step goes on where the force passes that of the threshold resistance;
//!   the instant is kept with its polynomials. Between the places where it turns the force polynomial is monotone, so that
//!   no dip is missed. Just after a closing, where it is not accurate, the law at the exact motion under it takes its place.
//!
//! *Two contacts.* The second contact of a changeover relay is the mirror image of the first
//! ([`second_contact`](crate::second_contact)), and at most one of them is closed. So the state is always in the view of
//! one contact, and all of this page is said of that one. In flight the other is looked for by the same search in the mirror
//! image of the step, if it is near ([`events::other`]); the state goes over to its view as it closes.
//!
//! After a closing the dissipative part of the force starts like the root of time (`k_j ~ d^(1/2)`, `d ~ t`), which no
//! polynomial follows. The first step is so short that missing this part moves the force by less than the error
//! allowed; the following steps grow by the error estimate, with the part for the kink described above.
//!
//! # Communication steps
//!
//! While inputs do not change, the integrator takes steps of its own, also beyond the communication point, and outputs
//! are read from the polynomials of its last step ([`communication_step`], [`motion`]): dense output of the force
//! (through the start and all nodes), the indentation and its velocity. A long step that will be read inside must keep
//! the tolerance there too: [`constants::INSIDE`] times `m` is the error inside, and in flight the error of the
//! indentation follows from the velocities at the nodes, which the slopes of its polynomial miss. A short step that
//! cannot ends at the communication point, cut as at an event. A changed input takes the motion back to the
//! communication point: it is integrated again from the start of the step, under the former inputs. A communication
//! step much longer than the
//! integrator's steps ends one of them exactly. Inputs act linearly in time within a communication step; a jump of
//! their rate changes the dissipative force at once and restarts the step length.
//!
//! Where the contact has opened or closed once, the integrator always runs ahead while inputs do not change.
//!
//! *Inputs that change each time.* Each change bends the force, which with contact damping follows within a fraction of a
//! microsecond. A wrong velocity of the tip that is left by it is taken back by the contact's damper as soon, so that it counts
//! only [`constants::DRIVEN`] times ([`Estimate`](collocation::error::Estimate)); a wrong way and what slow modes feel count in full,
//! and all of it once the contact has opened, as a blow would multiply it. What is read inside such a step may miss
//! more at its start ([`constants::INSIDE_DRIVEN`]). The next communication step begins with the step
//! length that this one began with. Where its length is new too, no coefficients are formed for it: steps have the lengths of
//! free ones, and the last one is cut at the communication point, as at an event ([`grid`]), unless the law there differs from
//! the force polynomial by more than the tolerance.
//!
//! Extremes of the force in a communication step come from the same polynomials ([`extremes`]): the places where the force
//! turns are found once for each step ([`course`]) and kept with them.
//!
//! # Rest
//!
//! Under constant inputs, the energy above the equilibrium bounds the force that is still to come: potential energy is
//! convex, so a residual load `r` on a mode holds at most `r^2 / (2 omega^2)`, and a force that differs by `e` needs at
//! least `e^2 / (2 k)`. Where that bound is below [`constants::UNREST`] of the tolerance nothing is integrated until
//! something changes ([`rest`]).
//!
//! # Discrete gradient
//!
//! Where Newton's method or the error estimate fails repeatedly, and at the shortest step, the force is taken constant
//! over the step: the discrete gradient of the contact's elastic energy between both ends, `(V(d_1) - V(d_0)) / (d_1 -
//! d_0)`, and a dissipative part that opposes the motion ([`discrete_gradient`]; O. Gonzalez, J. Nonlinear Sci. 6
//! (1996) 449). With exact modes the energy is then conserved without damping and never made with damping, at any step
//! length, opening and closing within the step included. The force at the end of the step is a monotone scalar equation
//! between brackets and always has its solution. Order two.
//!
//! # Energy
//!
//! Where nothing dissipates, what a step makes of energy is its error, and is returned by small impulses on the tip
//! within a share of the tolerance ([`energy::conservation`]), so that nothing adds up over millions of impacts.
//! `energy.balance` ([`energy::balance`]) is the work of the force by which the polynomial misses the law; it costs two
//! further evaluations of each step, where it is asked for.
//!
//! # Axial force
//!
//! Where the axial force follows the deflection, modes have loads that depend on all of them
//! ([`Feedback`](crate::beam::axial::Feedback)). They are weak over a step, so they are nodal polynomials too, found by
//! fixed-point iteration around Newton's method ([`collocation::axial_force`]); what they miss at the start enters the
//! error estimate as the base acceleration does.
//!
//! # Friction
//!
//! With friction ([`friction`](crate::friction): the law) the friction force `T` is a second load on the modes, a polynomial
//! through the same nodes, and the displacement `v` of the contact point along the spring a second sum over them. The tables
//! of the response gain `X = sum T_i (h T_i')` and `Y = sum (h T_i')^2`, formed as `D` is, and Newton's method the nodal
//! values of `T` ([`collocation::friction`]), with the law of stick or of slip throughout a step. While the contact slips, `T`
//! is a share of `F` and each contact force moves the tip with its friction force: there are `S` unknowns, as without friction,
//! with other coefficients. While it sticks there are `2 S`; the friction forces are eliminated first, and a Jacobian serves as
//! long as each iteration reduces the residuals to [`constants::STALE`] of what they were. What both polynomials miss at the
//! start enters the error estimate with its effect on both forces.
//!
//! A step ends where the contact begins or ceases to slip ([`friction`]): where the trial force of stick passes the limit,
//! or the slip velocity its zero: on the polynomials through the nodes, then on the exact motion under them, as at any event,
//! because what is missing there stays in the tangential spring as a wrong friction force. No blow follows, so the error
//! inside need only be that allowed in a step. The slope of the friction force jumps there, and the spring, which has no
//! rotary inertia at its end unless `tip.rotaryInertia` gives it, answers as steeply as its highest modes do. So the first
//! step is about as long as the last one after such a change, and the next ones grow with the time since, as after a closing.
//! Rounding could change stick and slip to and fro at one instant: what is below
//! [`constants::LOCATED`] of the error allowed is no change.
//!
//! As the contact opens the limit vanishes, so it slips before; as it closes, the direction of the first motion decides.
//! A contact that sticks may be at rest, with the friction force among the loads. Exact steps, the return of energy, an axial
//! force that follows the deflection and the second contact know no friction: such scenes are refused. A step with constant
//! contact force holds the friction force too.
//!
//! # Exact steps
//!
//! Where beam and contact are linear, the generator is a sine or none, and neither extremes nor near interruptions are
//! asked for, steps are exact at any length ([`exact_step`]), in the eigenvectors of beam and contact together
//! ([`closed_loop`](crate::closed_loop)): the eigenvalues are the zeros of a secular equation, in pairs, each a damped
//! oscillator with a closed form. The state holds these oscillators from step to step; the modes of the cantilever are
//! formed where they are needed. A bound on the swing shows whether the contact may open within the step; then the
//! collocation takes over.
//!
//! A long communication step is one exact step. In short ones with constant inputs the integrator runs ahead in exact
//! steps, and outputs are read from polynomials through the tip at the nodes of eight. They add no error to the motion;
//! the step is as long as [`constants::INSIDE`] times what the force polynomial misses at the start is below
//! [`constants::SHARE`] of the tolerance. Where no step beyond the communication point is so accurate (just after an
//! input has changed), an exact step ends there.
//!
//! # The promise of `solver.tolerance`
//!
//! The error of `contact.force` at communication points and of the extremes within steps is below `solver.tolerance`
//! times the larger of the force scale, `max(F_0, 3 E I max(|s|, 0.1 mm) / L^3)`, and the largest force so far: a blow of
//! newtons is not known to a part of a preload of centinewtons. Shown for closed and opening contacts of random relays
//! with 0.1 to 34 % damping by `tests/promise.rs`, for the specimen by `tests/calibration.rs` and the package `benches`
//! (`docs/accuracy.md`). Limits: springs for which [`MAX_MODES`](crate::beam::mode::MAX_MODES) are too few once the contact
//! opens, and motions in which a change of the excitation by the tolerance moves the force by more, as errors do too.
//!
//! `solver.forceError` says what the error may be by now ([`force_error`](crate::force_error)): the largest error that a
//! step has added, times the growth of a small deviation of the motion that is carried along once the contact has opened or
//! closed ([`deviation`]), times a factor that makes it an upper bound for 95 % of random relays. With inputs that jump at
//! each of thousands of communication steps the errors of as many steps add up, and it is too small for a third of them.
//!
//! # Files
//!
//! A communication step goes down through these: [`communication_step`], [`step_control`] (steps one after the other),
//! [`attempt`] (a step on trial, taken or rejected), [`collocation`] (one step). [`integration`]: what they share;
//! [`workspace`]: room made once, so that no step allocates. [`State`](crate::state::State) and [`motion`] are all that
//! moves: plain numbers, a saved state is a copy. The step is compiled twice, for any processor and for AVX2 with fused
//! multiply-add ([`simd`](crate::math::simd)).

pub mod attempt;
pub mod collocation;
pub mod communication_step;
pub mod constants;
pub mod course;
pub mod dense_output;
pub mod deviation;
pub mod discrete_gradient;
pub mod energy;
pub mod events;
pub mod exact_step;
pub mod extremes;
pub mod friction;
pub mod friction_output;
pub mod grid;
pub mod integration;
pub mod motion;
pub mod rest;
pub mod step_control;
pub mod step_length;
pub mod with_contact;
pub mod workspace;
