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
use crate::integrator::collocation::superposition::{self, Pair, Sum};
use crate::math::free_motion::FreeMotion;
use crate::math::nodal::{Nodal, add, end, scaled};
use crate::math::simd::{Arithmetic, Simd, compiled_for};
use crate::model::Model;

/// Step lengths whose coefficients are kept, a power of two: those of 32 octaves with and without half of their own, as
/// free steps have them, from nanoseconds after a blow to seconds. Cost.
pub const SLOTS: usize = 64;

/// Free motion of a port at the nodes due to one mode; includes the displacement of the port per coordinate of the mode.
#[derive(Clone, Copy, Debug)]
pub struct NodeRows<const S: usize> {
    /// Displacement per initial q, and per initial v.
    pub from_q: Nodal<S>,
    /// See [`NodeRows::from_q`].
    pub from_v: Nodal<S>,
    /// Velocity per initial q, and per initial v.
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
}

impl<const S: usize> NodeRows<S> {
    const ZERO: Self = Self {
        from_q: [0.0; S],
        from_v: [0.0; S],
        rate_from_q: [0.0; S],
        rate_from_v: [0.0; S],
    };

    /// Sets them to a multiple of the free motion of a mode over a step of `h` seconds.
    #[inline(always)]
    fn set<A: Arithmetic>(&mut self, factor: f64, mode: &Mode, response: &superposition::Response<S>, h: f64) {
        let Pair { q, v } = &response.impulse;
        self.from_v = scaled(q, factor * h);
        self.rate_from_v = scaled(v, factor);
        self.from_q = scaled(v, factor);
        add::<S, A>(&mut self.from_q, factor * mode.damping * h, q);
        self.rate_from_q = scaled(q, -factor * mode.omega_squared * h);
    }
}

impl<const S: usize> EndRows<S> {
    /// The free motion of a mode.
    pub fn free(&self, i: usize) -> Option<FreeMotion> {
        Some(FreeMotion {
            q_from_q: *self.q_from_q.get(i)?,
            q_from_v: *self.q_from_v.get(i)?,
            v_from_q: *self.v_from_q.get(i)?,
            v_from_v: *self.v_from_v.get(i)?,
        })
    }

    #[expect(clippy::indexing_slicing, reason = "no model has more modes than there is room for")]
    fn set(&mut self, i: usize, free: &FreeMotion, q_from_load: &Nodal<S>, v_from_load: &Nodal<S>) {
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
    }
}

/// Displacement and velocity at the nodes per unit load at each node.
#[derive(Clone, Copy, Debug, Zeroable)]
pub struct Columns<const S: usize> {
    /// Displacement.
    pub displacement: [Nodal<S>; S],
    /// Velocity.
    pub velocity: [Nodal<S>; S],
}

/// Displacement and velocity at the nodes per unit defect at the start: under the shape of the error estimate.
#[derive(Clone, Copy, Debug, Zeroable)]
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
    pub load: Response<S>,
}

/// The coefficients of a port.
#[derive(Clone, Debug)]
pub struct PortCoefficients<const S: usize> {
    /// Free motion, mode by mode, of the modes that it has a part in.
    pub modes: Vec<NodeRows<S>>,
    /// Motion per base acceleration that loads the modes with `participation`, and per defect of it.
    pub acceleration: Response<S>,
    /// Motion per force at each port up to this one, and per defect of it.
    pub forces: Vec<Response<S>>,
}

impl<const S: usize> ErrorColumn<S> {
    /// Adds a multiple of another.
    #[inline(always)]
    pub(super) fn add<A: Arithmetic>(&mut self, factor: f64, other: &Self) {
        add::<S, A>(&mut self.displacement, factor, &other.displacement);
        add::<S, A>(&mut self.velocity, factor, &other.velocity);
    }
}

impl<const S: usize> Columns<S> {
    /// Displacement and velocity at the end under nodal values of the load.
    #[inline(always)]
    pub(crate) fn at_end(&self, load: &Nodal<S>) -> (f64, f64) {
        let last = |columns: &[Nodal<S>; S]| {
            let entries = columns.iter().zip(load);
            entries.map(|(column, load)| end(column) * load).sum()
        };
        (last(&self.displacement), last(&self.velocity))
    }
}

/// Motion of a port per nodal values of a load, and per defect of the load at the start.
#[derive(Clone, Copy, Debug, Zeroable)]
pub struct Response<const S: usize> {
    /// Per nodal values.
    pub columns: Columns<S>,
    /// Per defect.
    pub defect: ErrorColumn<S>,
}

/// The coefficients of a step of one length.
#[derive(Clone, Debug)]
pub struct StepCoefficients<const S: usize> {
    /// The length, s.
    pub length: f64,
    /// Port by port.
    pub ports: Vec<PortCoefficients<S>>,
    /// Motion of each mode, for an axial force that follows the deflection; else empty.
    pub columns: Vec<ModeColumns<S>>,
    /// With friction: velocity of a deflection z that follows another with the contact's damping time, `beta_c z' + z = z_1`,
    /// per difference of the two from the start, 1/s; else empty.
    pub following: Vec<Nodal<S>>,
    /// The modes at the end.
    pub end: Box<EndRows<S>>,
    /// Phase advance of the generator.
    pub turns: Turns<S>,
}

impl<const S: usize> StepCoefficients<S> {
    /// Allocates for the model; no length yet.
    fn empty(model: &Model) -> Self {
        let ports = model.ports.iter().enumerate();
        let following = if model.friction().is_some() { S } else { 0 };
        let axial = if model.axial().is_some() { model.modes.len() } else { 0 };
        Self {
            length: 0.0,
            ports: ports
                .map(|(p, port)| PortCoefficients {
                    modes: vec![NodeRows::ZERO; port.modes.len()],
                    acceleration: Response::zeroed(),
                    forces: vec![Response::zeroed(); p + 1],
                })
                .collect(),
            columns: vec![
                ModeColumns {
                    q_from_q: [0.0; S],
                    q_from_v: [0.0; S],
                    load: Response::zeroed(),
                };
                axial
            ],
            following: vec![[0.0; S]; following],
            end: zeroed_box(),
            turns: Turns::room(&model.generator),
        }
    }

    /// The response of one port to forces at another, or at itself.
    #[inline(always)]
    #[expect(
        clippy::indexing_slicing,
        reason = "there are coefficients for every port of the model"
    )]
    pub fn response(&self, a: usize, b: usize) -> &Response<S> {
        &self.ports[a.max(b)].forces[a.min(b)]
    }

    /// Computes the coefficients for a length in place.
    fn fill(&mut self, length: f64, model: &Model, collocation: &Collocation<S>, sums: &mut [Sum<S>]) {
        let (h, shapes, simd) = (length, &collocation.shapes, model.simd);
        self.length = length;
        self.turns.fill(&model.generator, length, &collocation.nodes);
        sums.iter_mut().for_each(write_zeroes);
        compiled_for!(simd, A => self.add_modes::<A>(model, collocation, sums));
        let mut sums = sums.iter();
        for port in &mut self.ports {
            for (response, sum) in [&mut port.acceleration]
                .into_iter()
                .chain(&mut port.forces)
                .zip(&mut sums)
            {
                response.set(sum, simd, shapes, h);
            }
        }
        if !self.following.is_empty() {
            let following = compiled_for!(simd, A => following::<S, A>(model.law().damping(), h, shapes));
            self.following.copy_from_slice(&following);
        }
    }

    /// Sets what there is of each mode, and adds up the modes: `sums` has for each port that of the base acceleration, then
    /// those of the ports up to it, and at the end room for one mode.
    #[inline(always)]
    fn add_modes<A: Arithmetic>(&mut self, model: &Model, collocation: &Collocation<S>, sums: &mut [Sum<S>]) {
        let (h, shapes) = (self.length, &collocation.shapes);
        for (i, mode) in model.modes.iter().enumerate() {
            let mode_over_step = ModeOverStep::new(mode.omega_squared, mode.damping, h);
            let response = mode_over_step.response::<S, A>(&collocation.nodes, shapes);
            let displacement = |p: usize| {
                let port = model.ports.get(p);
                port.and_then(|port| port.shape.get(i)).copied().unwrap_or_default()
            };
            let mut of_port = sums.iter_mut();
            for (p, (port, step)) in model.ports.iter().zip(&mut self.ports).enumerate() {
                let b = displacement(p);
                for (q, sum) in of_port.by_ref().take(p + 2).enumerate() {
                    let weight = b * if q == 0 {
                        mode.participation
                    } else {
                        displacement(q - 1)
                    };
                    if weight != 0.0 {
                        sum.add::<A>(weight, &response);
                    }
                }
                let own = i.checked_sub(port.modes.start).and_then(|own| step.modes.get_mut(own));
                if let Some(rows) = own {
                    rows.set::<A>(b, mode, &response, h);
                }
            }
            let end = FreeMotion::new(mode.omega_squared, mode.damping, h);
            let loads = response.at_end::<A>(shapes);
            self.end.set(i, &end, &scaled(&loads.q, h * h), &scaled(&loads.v, h));
            if let (Some(columns), Some(alone)) = (self.columns.get_mut(i), of_port.next()) {
                let Pair { q, v } = &response.impulse;
                columns.q_from_v = scaled(q, h);
                columns.q_from_q = *v;
                add::<S, A>(&mut columns.q_from_q, mode.damping * h, q);
                write_zeroes(alone);
                alone.add::<A>(1.0, &response);
                columns.load.set(alone, model.simd, shapes, h);
            }
        }
    }
}

/// See [`StepCoefficients::following`]; `damping`: the damping time, s.
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

impl<const S: usize> Response<S> {
    /// All nodal values, one after the other.
    #[inline(always)]
    fn values_mut(&mut self) -> impl Iterator<Item = &mut Nodal<S>> {
        let Self { columns, defect } = self;
        let columns = columns.displacement.iter_mut().chain(&mut columns.velocity);
        columns.chain([&mut defect.displacement, &mut defect.velocity])
    }

    /// Multiplies it.
    #[inline(always)]
    pub(super) fn scale(&mut self, factor: f64) {
        for values in self.values_mut() {
            *values = scaled(values, factor);
        }
    }

    /// Adds a multiple of another.
    #[inline(always)]
    pub(super) fn add<A: Arithmetic>(&mut self, factor: f64, other: &Self) {
        let mut other = *other;
        for (sum, values) in self.values_mut().zip(other.values_mut()) {
            add::<S, A>(sum, factor, values);
        }
    }

    /// Sets it to a sum at the nodes, scaled from units of the step length `h` (s) to seconds.
    #[inline(never)]
    fn set(&mut self, sum: &Sum<S>, simd: Simd, shapes: &Shapes<S>, h: f64) {
        let Self { columns, defect } = self;
        compiled_for!(simd, A => {
            let Pair { q, v } = sum.at_nodes::<A>(shapes);
            let nodal = columns.displacement.iter_mut().zip(&mut columns.velocity);
            for ((displacement, velocity), (q, v)) in nodal.zip(q.nodal.iter().zip(&v.nodal)) {
                (*displacement, *velocity) = (scaled(q, h * h), scaled(v, h));
            }
            (defect.displacement, defect.velocity) = (scaled(&q.error, h * h), scaled(&v.error, h));
        });
    }
}

/// The slot of a length: dyadic fractions of one, and one and a half times them, occupy neighbouring slots; those of another
/// start elsewhere (Fibonacci hashing).
fn slot(length: f64) -> usize {
    let bits = length.to_bits();
    let (octave, mantissa) = (bits >> 51, bits << 13);
    let elsewhere = mantissa.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (64 - SLOTS.ilog2());
    usize::try_from(octave + elsewhere).unwrap_or_default() % SLOTS
}

/// Sums over the modes that a step needs: of each port under the base acceleration and under forces at the ports up to it, and
/// room for one mode.
fn sums(model: &Model) -> usize {
    (1..=model.ports.len()).map(|p| p + 1).sum::<usize>() + 1
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
    sums: Vec<Sum<S>>,
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
            sums: vec![Sum::zeroed(); sums(model)],
            piece: Piece::default(),
        }
    }

    /// What it takes of memory for the model, bytes.
    pub fn size(model: &Model) -> usize {
        let axial = model
            .axial()
            .map_or(0, |_| model.modes.len() * size_of::<ModeColumns<S>>());
        let following = model.friction().map_or(0, |_| S * size_of::<Nodal<S>>());
        let rows: usize = model
            .ports
            .iter()
            .map(|port| port.modes.len() * size_of::<NodeRows<S>>())
            .sum();
        let fixed = size_of::<StepCoefficients<S>>() + size_of::<EndRows<S>>() + axial + following + rows;
        let sums = sums(model);
        sums * size_of::<Sum<S>>() + (SLOTS + 1) * (fixed + sums * size_of::<Response<S>>())
    }

    /// The polynomials.
    pub fn collocation(&self) -> &Collocation<S> {
        &self.collocation
    }

    /// The coefficients for a length, with the base acceleration of a step from `time` (s) on.
    pub fn prepare(&mut self, time: f64, length: f64, recurring: bool, model: &Model) -> Prepared<'_, S> {
        let (step, collocation, piece) = self.entry(length, recurring, model);
        Prepared {
            step,
            collocation,
            generated: model.generator.over_step(model.simd, time, &step.turns, piece),
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
