//! The transient integrator: **the method**, and the files that carry it out.
//!
//! The model is a set of modes and a set of links: scalar laws of linear functionals of the modes ([`link`](crate::link)). Each mode is
//! propagated exactly, whatever its stiffness and damping. What is left to solve is a few scalar equations in time: the force of
//! each link is its law at the motion of its port, and that motion follows from the forces. A step represents the forces by
//! polynomials through collocation nodes and solves for the nodal values. Stiff modes cost nothing: they are evaluated, never
//! integrated.
//!
//! The numbers that were chosen stand in [`constants`], each with its unit, its source, and the test that pins it.
//!
//! # Equations
//!
//! All quantities are deviations from the static preload: the indentation is tens of nanometres beside an overtravel of tenths of a
//! millimetre, and forming the difference at each step would lose four digits. With the modes of the cantilever without contact
//! ([`Mode`](crate::beam::mode::Mode), modal mass 1 kg), base acceleration `a`, and for each link its sense `s`, port `b_i`, law
//! `F(d, d')` and the displacement `u` of its other body:
//!
//! ```text
//! q_i'' + c_i q_i' + omega_i^2 q_i = sum over the links of s b_i (F - F_0) - g_i a          i = 1 ... n
//! d - d_0 = u - s sum b_i q_i
//! F = F(d, d') while the link is closed, 0 while it is open
//! ```
//!
//! (Machines 2025, 13(1), 52, eqs. 1, 2, 7, 8, 14, 22; the contact's damping is that of Kuwabara and Kono.)
//!
//! The modes are Ritz vectors in a space of polynomials that contains the deflection under a static tip load
//! ([`galerkin`](crate::beam::galerkin)). The static compliance of the tip is therefore exact with any number of them, and the contact
//! force converges exponentially; eigenvectors of the continuum cut off at `n` would converge like `1 / n^3`. Their number follows
//! from the tolerance and from what an impact excites ([`mode_count`](crate::beam::mode_count)), and does not change.
//!
//! # One step
//!
//! Over a step of length `h`, `x = (t - t_0) / h`, forces and base acceleration are polynomials `sum F_j l_j(x)` through `S` nodes
//! ([`collocation::polynomial`]). The response of a mode to a polynomial is known in closed form. Summed over the modes, the approach
//! `d_k` and its velocity at the nodes are linear in the nodal forces,
//!
//! ```text
//! d_ak = d_ak(free) - sum_bj D_abkj F_bj        D_ab = s_a s_b sum_i b_ia b_ib (response of mode i at x_k to l_j)
//! ```
//!
//! where *free* is the motion under the initial modal state, the base acceleration, moving bodies, and forces that are known
//! ([`collocation::step`]). There is one matrix `D` for each pair of ports, however many modes there are. It depends on `h` alone;
//! matrices are kept by step length ([`collocation::coefficients`]), also for the next simulation of the same modes, and step
//! lengths are chosen so that they recur ([`grid`]).
//!
//! *Response of one mode* ([`collocation::modal_response`]). Integrated by parts, the response to `l_j` is either a series of the
//! repeated integrals of `l_j` (power series of the impulse response), or a finite sum of its derivatives (the motion that follows
//! the load) and a free motion that cancels its start. The first keeps its digits where the roots of the mode times `h` are below
//! [`SLOW`](collocation::modal_response::SLOW), the second where they are above [`FAST`](collocation::modal_response::FAST); an overdamped mode with one root of each kind splits into
//! both. The sums over the modes are formed on these coefficients, before they meet the tables of the shapes
//! ([`collocation::superposition`], [`collocation::shapes`]).
//!
//! *Nodes.* They are those of Radau IIA: the last one is the end of the step. The force there obeys the law exactly, so an overdamped
//! contact, which is nearly the algebraic constraint `d' = 0`, does not excite the step that follows (Hairer, Wanner, Solving
//! Ordinary Differential Equations II, 1996, sections IV.5 and VI.1). The quadrature has order `2 S - 1`, which is what slow modes see
//! at the end; at the inner nodes the error is of order `h^(S + 1)`. There are four nodes in short communication steps and just
//! after a closing, where the force is not smooth, and eight in flight and where they reach [`constants::WORTH`] times as far
//! ([`step_length`]).
//!
//! *Leaps* ([`leap`]). Just after a closing the dissipative part of the force is like the root of the time since, `c k d^(1/2) d'`, which no
//! polynomial of time follows: steps would have to start at a thousandth of a nanosecond. The first step after a closing therefore
//! uses polynomials of the root of time ([`collocation::shapes::Variable`]), eight nodes of Radau IIA in that variable, and reaches
//! as far as its error allows, tens of nanoseconds. Only the integrals of the shapes differ: those of `t^(m/2)` are known, and for a
//! root of a mode that is fast against the step so are the convolutions ([`collocation::fading_load`]). Modes that swing fast against
//! the step limit its length ([`collocation::modal_response::ModeOverStep::longest_by_root`]). A leap ends at no event: where
//! anything may happen inside, where the exponent of a contact law is no multiple of 1/2, with friction or
//! an axial force that follows the deflection, there is none, and short steps do it.
//!
//! *Newton's method* ([`collocation::newton`]). The unknowns are the nodal forces of the links that are closed. The residual is
//! `F_k - F(d_k, d'_k)` on the closed branch of the law, continued smoothly beyond opening. With stiffness `k` and damping `c` of the
//! laws the Jacobian is `1 + diag(k) D + diag(c) D'`. It is compiled for one link, the common case, and for several. The first guess
//! continues the force of the last step, which makes most solutions one or two iterations. Iteration ends below
//! [`constants::NEWTON`] of the error allowed in a step, or below what rounding of the motion makes of the laws
//! ([`constants::MOTION_ROUNDING`]); after [`constants::ITERATIONS`] the step is rejected. In free flight the forces are known.
//!
//! # Error estimate
//!
//! The shape of lowest degree that the nodal polynomials lack is the one of degree `S` that vanishes at the nodes and is 1 at the
//! start. How much of it a force lacks shows at the start: `m`, the force there less the polynomial extrapolated to it; likewise
//! `m_a` for the base acceleration. The response of the modes to that shape is part of the coefficients, so what `m` and `m_a` do to
//! approach and velocity at the end is known to first order, with the reaction of the laws. Three parts are added
//! ([`collocation::error`]):
//!
//! - stiffness and damping of each law times these errors: the part of modes that are fast against the step;
//! - the part of slow modes, which hardly feel the shape, as it is orthogonal to polynomials of low degree: three times `m^2` over the
//!   largest force (fitted to the impact of a free mass on a Hertz contact), and for the base acceleration the error of the
//!   quadrature, `S / 2 (S - 1)!^2 / (2 S - 1)!` times `m_a^2` over the largest acceleration;
//! - after a closing or a jump, where the force moves like the root of time, and before a contact parts, where its law has a branch
//!   point: a share [`constants::KINKED`] of `m`, which falls with the distance from there as the convergence of a polynomial near a
//!   branch point does (Trefethen, Approximation Theory and Approximation Practice, 2013, chapters 8 and 19).
//!
//! The last two are reduced by `g / (1 + g)`, `g` the force of the law at the end of the step per force throughout it, the greatest of
//! all contacts; that of one that is open or hardly touches is at the force scale, as it will meet what these errors make. Where
//! inputs have just changed, forces bend, and an `m` that passes through zero shows nothing of it: there `m` is at least what the
//! polynomials through fewer nodes let expect, and the next term of theirs in the step before a contact parts. In flight the estimate is
//! what `m_a` and the quadrature do to the approach, times the stiffness the contact would have at the force scale.
//!
//! A step that ends inside, at an event, has a larger error, as the shape is not orthogonal to anything there. A blow makes it a
//! hundred times larger, so at an opening it has to be below [`constants::AT_EVENT`] of the error allowed in a step. An estimate below
//! what rounding makes of the motion ([`constants::MOTION_ROUNDING`]) counts as small ([`constants::ROUNDED`]): no shorter step reduces
//! it.
//!
//! What is read inside a step, its extremes too, may be wrong where the polynomials are right at their nodes ([`accuracy`]): by the next
//! terms, extrapolated from polynomials through fewer nodes, and where a force turns, and halfway between nodes, by what it differs from
//! its law, at the motion that also has the velocities at the nodes. That is compared with the rounding of the free motion ([`constants::FREE_ROUNDING`]);
//! below it, the next step has the next length of the grid.
//!
//! # Step size control
//!
//! A step may add [`constants::SHARE`] of `solver.tolerance` times the force scale ([`tolerance`]). Its length is multiplied by
//! `(allowed / estimate)^(1 / (S + 1))` and [`constants::SAFETY`], within bounds. Acceptance discounts the velocity error inherited
//! from the previous step ([`constants::INHERITED`]): the contact's damper takes it back, and a shorter step would not have less of it.
//! Step ends lie on a grid: binary fractions of the communication step where it is integrated to its end, and lengths of 1 and 1.5
//! times powers of two where the integrator runs ahead, and off that grid after an event; the generator's corners (start, end,
//! crossover) end a step. After a closing the force is smooth in the logarithm of the time since: the next step may be longer in the
//! ratio in which that time grows, up to where its polynomials follow a root of that time to the tolerance ([`leap`]). A step is never
//! longer than a quarter of the generator's shortest period, nor than `solver.maximumStep`.
//!
//! Work is counted and bounded per communication step ([`workspace::WORK`]): beyond it the step ends with an error that
//! names the time.
//!
//! # Events
//!
//! A step ends where a contact opens or closes ([`events`]). Inside a trial the motion of the modes is exact under the polynomials of
//! forces and base acceleration ([`collocation::part`]): up to an instant these are nodal polynomials again, so no coefficients of a
//! step of that length are needed and no Newton iteration. The instant is found by Chandrupatla's bracketing method
//! ([`roots`](crate::math::roots)) on the polynomials through approach and velocity, then by the secant method on the exact motion.
//!
//! - *Opening* ([`events::opening`]): the force reaches zero, at a node or in a dip of the polynomial between nodes. With contact
//!   damping that is before the surfaces part.
//! - *Closing* ([`events::closing`]): on cubics through approach and velocity at the nodes, with bounds of all that they miss. A
//!   grazing touch is not missed, as it is by a search for changes of sign.
//! - *Slip* ([`events::slip`]): the trial force of stick passes Coulomb's limit, or the slip velocity its zero. What fades in the
//!   tangential spring in a part of the step is no polynomial ([`collocation::slip`]), and part of the slip velocity.
//! - *Gap* ([`events::gap`]): an armature that has left its core, which damps, is indented no longer, and the force of the magnet bends.
//! - *Interruption* ([`events::interruption`]): the step goes on where the force passes that of the threshold resistance. Between the
//!   places where it turns the force polynomial is monotone, so that no dip is missed.
//!
//! After a closing there is a leap, where it can be taken. Else the first step is so short that missing the dissipative part of the
//! force moves the force by less than the error allowed. After a change between stick and slip the slope
//! of the friction force jumps, and the spring answers as steeply as its highest modes do: the first step is about as long as the
//! last one after such a change. What an event makes of the state: [`transition`].
//!
//! # Communication steps
//!
//! While inputs stay as they are, or go on along their lines but for rounding ([`Drive::next`](crate::excitation::drive::Drive::next)),
//! the integrator takes steps of its own, also beyond the communication point. Outputs are read from dense output, the polynomials of
//! its last step ([`communication_step`], [`motion`], [`recorder`]). A long step that will be read inside must keep the tolerance there
//! too ([`accuracy`]): that of the forces in the step where they are larger than the force scale, as nothing follows from what is
//! read. A short step that cannot ends at the communication point, cut as at an event. A changed
//! input takes the motion back to the communication point: it is integrated again from the start of the step, under the former
//! inputs. With inputs that bend at its start, a communication step is integrated to its end. Inputs act linearly in time within a
//! communication step; a jump of their rate changes the dissipative force at once and restarts the step length.
//!
//! *Inputs that change each time.* Each change bends the force, which with contact damping follows within a fraction of a
//! microsecond. A wrong velocity that is left by it is taken back by the contact's damper as soon, so that it counts only
//! [`constants::DRIVEN`] times; a wrong way and what slow modes feel count in full, and all of it once the contact has opened, as a
//! blow would multiply it. The next communication step begins with the step length that this one began with. Where its length is
//! new too, no coefficients are formed for it: the last step is cut at the communication point.
//!
//! # Rest, fallback, energy
//!
//! *Rest* ([`rest`]): under constant inputs, the energy above the equilibrium bounds the force that is still to come. Where that bound
//! is below [`constants::UNREST`] of the tolerance nothing is integrated until something changes.
//!
//! *Discrete gradient* ([`discrete_gradient`]): where Newton's method still fails at the shortest step, or after
//! [`constants::HALVINGS`] rejections, each force is taken constant over the step. That always has a solution, and makes no energy at
//! any step length. Order two.
//!
//! *Energy* ([`energy`]): where nothing dissipates, what a step makes of energy is its error, and is returned by small impulses within
//! a share of the tolerance. `energy.balance` is the work of the forces by which the polynomials miss the laws.
//!
//! # Axial force, friction, exact steps
//!
//! An axial force that follows the deflection is no scalar law: it loads each mode by all of them
//! ([`Feedback`](crate::beam::axial::Feedback)). These loads are weak over a step, nodal polynomials too, and found by fixed-point
//! iteration around Newton's method ([`collocation::axial_force`]).
//!
//! Friction ([`friction`](crate::contact::friction)) is a link at the port along the spring. While the contact sticks, its law depends on
//! the indentation too. While it slips, the friction force is a share of the contact force and no unknown, and the deflection of the
//! tangential spring is collocated at the same nodes ([`collocation::slip`]).
//!
//! Where beam and contact are linear, the generator is a sine or none, and nothing inside a step is asked for, steps are exact at any
//! length ([`exact_step`]), in the eigenvectors of beam and contact together ([`closed_loop`](crate::closed_loop)). The state holds
//! these oscillators from step to step. A bound on the swing shows whether the contact may open; then the collocation takes over.
//!
//! # The promise of `solver.tolerance`
//!
//! The error of `contact.force` at communication points and of the extremes within steps is below `solver.tolerance` times the larger
//! of the force scale, `max(F_0, 3 E I max(|s|, 0.1 mm) / L^3)`, and the largest force so far: a blow of newtons is not known to a
//! part of a preload of centinewtons. Shown for random relays with 0.1 to 34 % damping by `tests/promise.rs`, for the specimen by
//! `tests/calibration.rs` and the package `benches`. Limits: springs for which [`MAX_MODES`](crate::beam::mode::MAX_MODES) are too few
//! once the contact opens, and motions in which a change of the excitation by the tolerance moves the force by more.
//!
//! `solver.forceError` says what the error may be by now ([`force_error`](crate::force_error)): by the largest error that a step has
//! added, by a deviation of the motion that is carried along once a contact has opened or closed ([`deviation`]), and by what the modes
//! left out do ([`resolution`](crate::beam::resolution)). How often it is above the error is in docs/accuracy.md.
//!
//! # Files
//!
//! A communication step goes down through these: [`communication_step`], [`steps`] (one after the other), [`step_end`] (where one
//! ends: at an event), [`stepper`] (one on trial: computed, judged, committed), [`collocation`]. [`step_length`]: what the next step is
//! to be. [`workspace`]: room made once, so that no step allocates. [`State`](crate::state::State) and [`motion`] are all that moves:
//! plain numbers, a saved state is a copy. The kernel of a step is compiled twice, for any processor and for AVX2 with fused multiply-add
//! ([`simd`](crate::math::simd)).

pub mod accuracy;
pub mod collocation;
pub mod commit;
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
pub mod grid;
pub mod leap;
pub mod motion;
pub mod recorder;
pub mod rest;
pub mod rounding;
pub mod step_end;
pub mod step_length;
pub mod stepper;
pub mod steps;
pub mod tolerance;
pub mod transition;
pub mod with_contact;
pub mod workspace;
