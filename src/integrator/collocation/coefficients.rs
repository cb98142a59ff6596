//! The coefficients of a step, which depend on its length only, and a cache of them.

use bytemuck::{Zeroable, write_zeroes, zeroed_box};

use crate::beam::mode::{Modal, Mode};
use crate::excitation::generator::Turns;
use crate::excitation::random::Piece;
use crate::excitation::waveform::Accelerations;
use crate::integrator::collocation::elimination::solve;
use crate::integrator::collocation::modal_response::ModeOverStep;
use crate::integrator::collocation::polynomial::{Collocation, Home, Shared};
use crate::integrator::collocation::shapes::Shapes;
use crate::integrator::collocation::superposition::{Pair, Response, Sum};
use crate::integrator::constants::SLOTS;
use crate::math::free_motion::FreeMotion;
use crate::math::nodal::{Nodal, add, scaled};
use crate::math::simd::{Arithmetic, Simd, compiled_for};
use crate::model::Model;

/// Free motion of the tip at the nodes due to one mode; includes the factor of the mode's tip displacement.
#[derive(Clone, Copy, Debug)]
pub struct NodeRows<const S: usize> {
    /// Tip displacement per initial q, and per initial v.
    pub tip_from_q: Nodal<S>,
    /// See [`NodeRows::tip_from_q`].
    pub tip_from_v: Nodal<S>,
    /// Tip velocity per initial q, and per initial v.
    pub rate_from_q: Nodal<S>,
    /// See [`NodeRows::rate_from_q`].
    pub rate_from_v: Nodal<S>,
}

/// State of the modes at the end of the step; arrays over the modes, for vector arithmetic.
#[derive(Clone, Copy, Debug, Zeroable)]
pub struct EndRows<const S: usize> {
    /// q and v at the end per initial q and v, and per load at each node.
    pub q_from_q: Modal,
    /// See [`EndRows::q_from_q`].
    pub q_from_v: Modal,
    /// See [`EndRows::q_from_q`].
    pub v_from_q: Modal,
    /// See [`EndRows::q_from_q`].
    pub v_from_v: Modal,
    /// See [`EndRows::q_from_q`].
    pub q_from_load: [Modal; S],
    /// See [`EndRows::q_from_q`].
    pub v_from_load: [Modal; S],
    /// Modal load per tip force, and tip displacement per q.
    pub tip: Modal,
    /// Modal load per base acceleration, with opposite sign.
    pub participation: Modal,
}

impl<const S: usize> NodeRows<S> {
    const ZERO: Self = Self {
        tip_from_q: [0.0; S],
        tip_from_v: [0.0; S],
        rate_from_q: [0.0; S],
        rate_from_v: [0.0; S],
    };

    /// Sets them to a multiple of the free motion of a mode over a step of `h` seconds.
    #[inline(always)]
    fn set<A: Arithmetic>(&mut self, factor: f64, mode: &Mode, response: &Response<S>, h: f64) {
        let Pair { q, v } = &response.impulse;
        self.tip_from_v = scaled(q, factor * h);
        self.rate_from_v = scaled(v, factor);
        self.tip_from_q = scaled(v, factor);
        add::<S, A>(&mut self.tip_from_q, factor * mode.damping * h, q);
        self.rate_from_q = scaled(q, -factor * mode.omega_squared * h);
    }
}

impl<const S: usize> EndRows<S> {
    /// The free motion of each mode.
    pub fn free(&self) -> impl Iterator<Item = FreeMotion> {
        let rows = self.q_from_q.iter().zip(&self.q_from_v).zip(&self.v_from_q);
        rows.zip(&self.v_from_v)
            .map(|(((q_from_q, q_from_v), v_from_q), v_from_v)| FreeMotion {
                q_from_q: *q_from_q,
                q_from_v: *q_from_v,
                v_from_q: *v_from_q,
                v_from_v: *v_from_v,
            })
    }

    #[expect(clippy::indexing_slicing, reason = "no model has more modes than there is room for")]
    fn set(&mut self, i: usize, mode: &Mode, free: &FreeMotion, q_from_load: &Nodal<S>, v_from_load: &Nodal<S>) {
        self.q_from_q[i] = free.q_from_q;
        self.q_from_v[i] = free.q_from_v;
        self.v_from_q[i] = free.v_from_q;
        self.v_from_v[i] = free.v_from_v;
        for (row, load) in self.q_from_load.iter_mut().zip(q_from_load) {
            row[i] = *load;
        }
        for (row, load) in self.v_from_load.iter_mut().zip(v_from_load) {
            row[i] = *load;
        }
        self.tip[i] = mode.tip;
        self.participation[i] = mode.participation;
    }
}

/// Tip displacement and velocity at the nodes per unit load at each node.
#[derive(Clone, Copy, Debug)]
pub struct TipColumns<const S: usize> {
    /// Displacement.
    pub displacement: [Nodal<S>; S],
    /// Velocity.
    pub velocity: [Nodal<S>; S],
}

/// Tip displacement and velocity at the nodes per unit defect at the start: under the shape of the error estimate.
#[derive(Clone, Copy, Debug)]
pub struct ErrorColumn<const S: usize> {
    /// Displacement.
    pub displacement: Nodal<S>,
    /// Velocity.
    pub velocity: Nodal<S>,
}

/// Motion of one mode at the nodes.
#[derive(Clone, Copy, Debug)]
pub struct ModeColumns<const S: usize> {
    /// Displacement per initial q, and per initial v.
    pub q_from_q: Nodal<S>,
    /// See [`ModeColumns::q_from_q`].
    pub q_from_v: Nodal<S>,
    /// Displacement and velocity per load on the mode.
    pub load: TipColumns<S>,
    /// Displacement and velocity per defect of the load on the mode.
    pub error: ErrorColumn<S>,
}

/// The coefficients for friction: of the displacement of the contact point along the spring.
#[derive(Clone, Debug)]
pub struct TangentialCoefficients<const S: usize> {
    /// Free motion, mode by mode.
    pub modes: Vec<NodeRows<S>>,
    /// Motion along the spring per tip force, and with opposite sign indentation per friction force.
    pub cross: TipColumns<S>,
    /// Motion along the spring per friction force.
    pub own: TipColumns<S>,
    /// Motion along the spring per base acceleration, with opposite sign.
    pub acceleration: TipColumns<S>,
    /// As `cross`, per defect of the force.
    pub cross_error: ErrorColumn<S>,
    /// As `own`, per defect of the force.
    pub own_error: ErrorColumn<S>,
    /// As `acceleration`, per defect of the base acceleration.
    pub acceleration_error: ErrorColumn<S>,
    /// Velocity of a deflection z that follows another with the contact's damping time, `beta_c z' + z = z_1`, per
    /// difference of the two from the start, 1/s.
    pub following: [Nodal<S>; S],
}

/// The coefficients of a step of one length.
#[derive(Clone, Debug)]
pub struct StepCoefficients<const S: usize> {
    /// The length, s.
    pub length: f64,
    /// Free motion of the tip, mode by mode.
    pub modes: Vec<NodeRows<S>>,
    /// Motion of each mode, for an axial force that follows the deflection; else empty.
    pub columns: Vec<ModeColumns<S>>,
    /// For friction; else none.
    pub tangential: Option<Box<TangentialCoefficients<S>>>,
    /// The modes at the end.
    pub end: Box<EndRows<S>>,
    /// Tip motion per tip force.
    pub force: TipColumns<S>,
    /// Tip motion per base acceleration that loads the modes with `participation`.
    pub acceleration: TipColumns<S>,
    /// Phase advance of the generator.
    pub turns: Turns<S>,
    /// Tip motion per defect of the contact force.
    pub force_error: ErrorColumn<S>,
    /// Tip motion per defect of the base acceleration.
    pub acceleration_error: ErrorColumn<S>,
}

impl<const S: usize> TipColumns<S> {
    const ZERO: Self = Self {
        displacement: [[0.0; S]; S],
        velocity: [[0.0; S]; S],
    };
}

impl<const S: usize> ErrorColumn<S> {
    const ZERO: Self = Self {
        displacement: [0.0; S],
        velocity: [0.0; S],
    };
}

impl<const S: usize> StepCoefficients<S> {
    /// Allocates for the model; no length yet.
    fn empty(model: &Model) -> Self {
        Self {
            length: 0.0,
            modes: vec![NodeRows::ZERO; model.modes.len()],
            tangential: model.friction().map(|_| {
                Box::new(TangentialCoefficients {
                    modes: vec![NodeRows::ZERO; model.modes.len()],
                    cross: TipColumns::ZERO,
                    own: TipColumns::ZERO,
                    acceleration: TipColumns::ZERO,
                    cross_error: ErrorColumn::ZERO,
                    own_error: ErrorColumn::ZERO,
                    acceleration_error: ErrorColumn::ZERO,
                    following: [[0.0; S]; S],
                })
            }),
            columns: vec![
                ModeColumns {
                    q_from_q: [0.0; S],
                    q_from_v: [0.0; S],
                    load: TipColumns::ZERO,
                    error: ErrorColumn::ZERO,
                };
                if model.axial().is_some() { model.modes.len() } else { 0 }
            ],
            end: zeroed_box(),
            force: TipColumns::ZERO,
            acceleration: TipColumns::ZERO,
            turns: Turns::room(&model.generator),
            force_error: ErrorColumn::ZERO,
            acceleration_error: ErrorColumn::ZERO,
        }
    }

    /// Computes the coefficients for a length in place.
    fn fill(&mut self, length: f64, model: &Model, collocation: &Collocation<S>, sums: &mut Sums<S>) {
        let (h, shapes, simd) = (length, &collocation.shapes, model.simd);
        self.length = length;
        self.turns.fill(&model.generator, length, &collocation.nodes);
        write_zeroes(sums);
        compiled_for!(simd, A => self.add_modes::<A>(model, collocation, sums));
        set_columns(&sums.force, simd, shapes, h, &mut self.force, &mut self.force_error);
        let (columns, error) = (&mut self.acceleration, &mut self.acceleration_error);
        set_columns(&sums.acceleration, simd, shapes, h, columns, error);
        if let Some(along) = self.tangential.as_deref_mut() {
            set_columns(&sums.cross, simd, shapes, h, &mut along.cross, &mut along.cross_error);
            set_columns(&sums.own, simd, shapes, h, &mut along.own, &mut along.own_error);
            let (columns, error) = (&mut along.acceleration, &mut along.acceleration_error);
            set_columns(&sums.along, simd, shapes, h, columns, error);
            along.following = compiled_for!(simd, A => following::<S, A>(model.law.damping(), h, shapes));
        }
    }

    /// Sets what there is of each mode, and adds up the modes.
    #[inline(always)]
    fn add_modes<A: Arithmetic>(&mut self, model: &Model, collocation: &Collocation<S>, sums: &mut Sums<S>) {
        let (h, shapes) = (self.length, &collocation.shapes);
        let mut along = self.tangential.as_deref_mut().zip(model.friction());
        for (i, (mode, step)) in model.modes.iter().zip(&mut self.modes).enumerate() {
            let tip = mode.tip;
            let mode_over_step = ModeOverStep::new(mode.omega_squared, mode.damping, h);
            let response = mode_over_step.response::<S, A>(&collocation.nodes, shapes);
            sums.force.add::<A>(tip * tip, &response);
            sums.acceleration.add::<A>(tip * mode.participation, &response);

            step.set::<A>(tip, mode, &response, h);
            if let Some((tangential, friction)) = &mut along
                && let (Some(rows), Some(lever)) = (tangential.modes.get_mut(i), friction.levers.get(i))
            {
                sums.cross.add::<A>(lever * tip, &response);
                sums.own.add::<A>(lever * lever, &response);
                sums.along.add::<A>(lever * mode.participation, &response);
                rows.set::<A>(*lever, mode, &response, h);
            }

            let end = FreeMotion::new(mode.omega_squared, mode.damping, h);
            let loads = response.at_end::<A>(shapes);
            self.end
                .set(i, mode, &end, &scaled(&loads.q, h * h), &scaled(&loads.v, h));
            if let Some(columns) = self.columns.get_mut(i) {
                let Pair { q, v } = &response.impulse;
                columns.q_from_v = scaled(q, h);
                columns.q_from_q = *v;
                add::<S, A>(&mut columns.q_from_q, mode.damping * h, q);
                write_zeroes(&mut sums.alone);
                sums.alone.add::<A>(1.0, &response);
                set_columns(
                    &sums.alone,
                    model.simd,
                    shapes,
                    h,
                    &mut columns.load,
                    &mut columns.error,
                );
            }
        }
    }
}

/// Sums over the modes while the coefficients of a length are computed; too large for the stack.
#[derive(Clone, Debug, Zeroable)]
struct Sums<const S: usize> {
    force: Sum<S>,
    acceleration: Sum<S>,
    /// For friction, as in [`TangentialCoefficients`].
    cross: Sum<S>,
    own: Sum<S>,
    /// Of the base acceleration.
    along: Sum<S>,
    /// Of one mode.
    alone: Sum<S>,
}

/// See [`TangentialCoefficients::following`]; `damping`: the damping time, s.
#[inline(always)]
fn following<const S: usize, A: Arithmetic>(damping: f64, h: f64, shapes: &Shapes<S>) -> [Nodal<S>; S] {
    let mut matrix = shapes.integrals.first().map_or([[0.0; S]; S], |table| table.nodal);
    let mut right = [[0.0; S]; S];
    let scale = 1.0 / (damping + h);
    for (j, (column, right)) in matrix.iter_mut().zip(&mut right).enumerate() {
        *column = scaled(column, h * scale);
        column
            .iter_mut()
            .skip(j)
            .take(1)
            .for_each(|entry| *entry += damping * scale);
        right.iter_mut().skip(j).take(1).for_each(|entry| *entry = scale);
    }
    solve::<S, S, A>(matrix, right).unwrap_or([[0.0; S]; S])
}

/// Sets columns to a sum at the nodes, scaled from units of the step length `h` (s) to seconds.
#[inline(never)]
fn set_columns<const S: usize>(
    sum: &Sum<S>,
    simd: Simd,
    shapes: &Shapes<S>,
    h: f64,
    columns: &mut TipColumns<S>,
    error: &mut ErrorColumn<S>,
) {
    compiled_for!(simd, A => {
        let Pair { q, v } = sum.at_nodes::<A>(shapes);
        let nodal = columns.displacement.iter_mut().zip(&mut columns.velocity);
        for ((displacement, velocity), (q, v)) in nodal.zip(q.nodal.iter().zip(&v.nodal)) {
            (*displacement, *velocity) = (scaled(q, h * h), scaled(v, h));
        }
        (error.displacement, error.velocity) = (scaled(&q.error, h * h), scaled(&v.error, h));
    });
}

/// The slot of a length: dyadic fractions of one, and one and a half times them, occupy neighbouring slots; those of another
/// start elsewhere (Fibonacci hashing).
fn slot(length: f64) -> usize {
    let bits = length.to_bits();
    let (octave, mantissa) = (bits >> 51, bits << 13);
    let elsewhere = mantissa.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (64 - SLOTS.ilog2());
    usize::try_from(octave + elsewhere).unwrap_or_default() % SLOTS
}

/// Cache of coefficients by step length. Its content never affects results, only the time they take.
#[derive(Clone, Debug)]
pub struct Cache<const S: usize> {
    collocation: Shared<S>,
    /// For recurring lengths, each in the slot of its hash.
    slots: Vec<StepCoefficients<S>>,
    /// For the last other length.
    other: Box<StepCoefficients<S>>,
    /// While coefficients are computed.
    sums: Box<Sums<S>>,
    /// Piece of a random acceleration.
    piece: Piece,
}

/// What a step of a length from an instant on is computed with.
#[derive(Clone, Copy, Debug)]
pub struct Prepared<'a, const S: usize> {
    /// The coefficients of its length.
    pub step: &'a StepCoefficients<S>,
    /// The polynomials.
    pub collocation: &'a Collocation<S>,
    /// Accelerations of the generator.
    pub generated: Accelerations<S>,
}

impl<const S: usize> Cache<S> {
    /// Allocates for the model.
    pub fn new(model: &Model, home: &'static Home<S>) -> Self {
        Self {
            collocation: Shared::of(home),
            slots: (0..SLOTS).map(|_| StepCoefficients::empty(model)).collect(),
            other: Box::new(StepCoefficients::empty(model)),
            sums: zeroed_box(),
            piece: Piece::default(),
        }
    }

    /// What it takes of memory for the model, bytes.
    pub fn size(model: &Model) -> usize {
        let axial = model.axial().map_or(0, |_| size_of::<ModeColumns<S>>());
        let along = model.friction().map_or(0, |_| size_of::<NodeRows<S>>());
        let per_mode = size_of::<NodeRows<S>>() + axial + along;
        let tangential = model.friction().map_or(0, |_| size_of::<TangentialCoefficients<S>>());
        let fixed = size_of::<StepCoefficients<S>>() + size_of::<EndRows<S>>() + tangential;
        size_of::<Sums<S>>() + (SLOTS + 1) * (fixed + model.modes.len() * per_mode)
    }

    /// The polynomials.
    pub fn collocation(&self) -> &Collocation<S> {
        &self.collocation
    }

    /// The coefficients for a length, with the base acceleration of a step from `time` (s) on.
    pub fn prepare(&mut self, time: f64, length: f64, recurring: bool, model: &Model) -> Prepared<'_, S> {
        let (step, collocation, piece) = self.entry(length, recurring, model);
        let mut generated = model.generator.over_step(model.simd, time, &step.turns, piece);
        if model.mirrored {
            generated = generated.mirrored();
        }
        Prepared {
            step,
            collocation,
            generated,
        }
    }

    /// The coefficients for a length, if they are known.
    pub fn known(&self, length: f64, recurring: bool) -> Option<&StepCoefficients<S>> {
        let entry = self
            .slots
            .get(slot(length))
            .filter(|_| recurring)
            .unwrap_or(&self.other);
        (entry.length.to_bits() == length.to_bits()).then_some(entry)
    }

    /// The coefficients for a length, `recurring`: kept in a slot; and the piece of a random acceleration.
    fn entry(
        &mut self,
        length: f64,
        recurring: bool,
        model: &Model,
    ) -> (&StepCoefficients<S>, &Collocation<S>, &mut Piece) {
        let Self {
            collocation,
            slots,
            other,
            sums,
            piece,
        } = self;
        let entry = slots.get_mut(slot(length)).filter(|_| recurring).unwrap_or(other);
        if entry.length.to_bits() != length.to_bits() {
            entry.fill(length, model, collocation, sums);
        }
        (entry, collocation, piece)
    }
}
