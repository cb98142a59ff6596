//! Coefficients of steps of several lengths for one set of modes.

use std::ops::Range;

use bytemuck::{Zeroable, write_zeroes};

use crate::beam::mode::Mode;
use crate::excitation::generator::{Generator, Turns};
use crate::integrator::collocation::coefficients::{
    EndGroup, ModeColumns, NodeRows, Response, StepCoefficients, responses_before,
};
use crate::integrator::collocation::modal_response::ModeOverStep;
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::shapes::Variable;
use crate::integrator::collocation::slip::following;
use crate::integrator::collocation::superposition::{Pair, Sum};
use crate::link::Port;
use crate::math::free_motion::FreeMotion;
use crate::math::nodal::{Nodal, add, scaled};
use crate::math::simd::{Arithmetic, LANES, Simd, compiled_for};
use crate::model::Model;

/// Lengths of free steps whose coefficients are kept, a power of two: of 32 octaves, from nanoseconds after a blow to seconds. Cost.
const FREE: usize = 64;

/// The same of fractions of communication steps. Cost.
const PARTS: usize = 32;

/// The same of leaps, which are free steps by the root of time. Cost.
const LEAPS: usize = 32;

/// All of them.
const SLOTS: usize = FREE + PARTS + LEAPS;

/// The slot of a length. Those of free steps, 1 and 1.5 times powers of two, have neighbouring ones, and so have dyadic fractions of
/// another length, which start anywhere (Fibonacci hashing).
fn slot(length: f64, variable: Variable) -> usize {
    let bits = length.to_bits();
    let (octave, mantissa) = (bits >> 51, bits << 13);
    let free = usize::try_from(octave).unwrap_or_default();
    if variable == Variable::Root {
        return FREE + PARTS + free % LEAPS;
    }
    if mantissa == 0 {
        return free % FREE;
    }
    let start = mantissa.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (64 - PARTS.ilog2());
    FREE + usize::try_from((octave >> 1) + start).unwrap_or_default() % PARTS
}

/// All that the coefficients of a length depend on, but for the generator.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Basis {
    modes: Vec<Mode>,
    ports: Vec<Port>,
    /// Whether an axial force loads each mode.
    axial: bool,
    /// Damping time of the contact, s, where it rubs.
    rubbing: Option<f64>,
    portable: bool,
}

impl Basis {
    pub(super) fn of(model: &Model) -> Self {
        Self {
            modes: model.modes.clone(),
            ports: model.ports.clone(),
            axial: model.axial.is_some(),
            rubbing: model.friction().map(|_| model.law.damping),
            portable: matches!(model.simd, Simd::Portable),
        }
    }
}

/// Coefficients of steps of several lengths, in places that are made as they are needed: room for all of them is reserved, but
/// not touched before.
#[derive(Debug, Default)]
pub(crate) struct Store<const S: usize> {
    basis: Basis,
    places: Vec<Place<S>>,
    rows: Vec<NodeRows<S>>,
    responses: Vec<Response<S>>,
    columns: Vec<ModeColumns<S>>,
    following: Vec<Nodal<S>>,
    ends: Vec<EndGroup<S>>,
    sizes: Sizes,
    /// The place of each slot that a recurring length may have by its hash; 0: none yet.
    of_slot: Vec<u8>,
}

/// What every place has one of. Each reserved room costs a page of memory, however little of it is used.
#[derive(Clone, Debug)]
struct Place<const S: usize> {
    /// Length of the step, s; 0: none yet.
    length: f64,
    collocation: &'static Collocation<S>,
    turns: Turns<S>,
}

/// How many there are of each in a place.
#[derive(Clone, Debug, Default)]
struct Sizes {
    rows: usize,
    responses: usize,
    columns: usize,
    following: usize,
    ends: usize,
    /// Where the rows of each port begin and end.
    of_port: Vec<Range<usize>>,
}

/// The part of a place of this size.
#[inline(always)]
#[expect(clippy::indexing_slicing, reason = "places that are there")]
fn part<T>(all: &[T], place: usize, size: usize) -> &[T] {
    &all[place * size..(place + 1) * size]
}

/// The same to be written.
#[expect(clippy::indexing_slicing, reason = "places that are there")]
fn part_mut<T>(all: &mut [T], place: usize, size: usize) -> &mut [T] {
    &mut all[place * size..(place + 1) * size]
}

impl Sizes {
    fn of<const S: usize>(model: &Model) -> Self {
        let mut rows = 0;
        let of_port = model.ports.iter().map(|port| {
            let first = rows;
            rows += port.modes.len();
            first..rows
        });
        let of_port = of_port.collect();
        Self {
            rows,
            responses: responses_before(model.ports.len()),
            columns: if model.axial.is_some() { model.modes.len() } else { 0 },
            following: if model.friction().is_some() { S } else { 0 },
            ends: model.modes.len().div_ceil(LANES),
            of_port,
        }
    }

    /// What a place takes of memory, bytes.
    fn bytes<const S: usize>(&self) -> usize {
        size_of::<Place<S>>()
            + self.rows * size_of::<NodeRows<S>>()
            + self.responses * size_of::<Response<S>>()
            + self.columns * size_of::<ModeColumns<S>>()
            + self.following * size_of::<Nodal<S>>()
            + self.ends * size_of::<EndGroup<S>>()
    }
}

impl<const S: usize> Store<S> {
    /// With room for all lengths of a model, of which this is the basis.
    pub(super) fn for_model(basis: Basis, model: &Model) -> Self {
        Self::reserved(basis, Sizes::of::<S>(model))
    }

    /// How many sums [`Store::fill`] takes for a model: for each response, and for one mode.
    pub(super) fn sums(model: &Model) -> usize {
        responses_before(model.ports.len()) + 1
    }

    /// What it takes of memory for a model at most, bytes.
    pub(super) fn size(model: &Model) -> usize {
        (SLOTS + 1) * Sizes::of::<S>(model).bytes::<S>()
    }

    /// Whether its coefficients are those of a basis.
    pub(super) fn is_of(&self, basis: &Basis) -> bool {
        self.basis == *basis
    }

    /// The coefficients for a length, if they are known.
    pub(super) fn known(
        &self,
        length: f64,
        recurring: bool,
        collocation: &Collocation<S>,
    ) -> Option<StepCoefficients<'_, S>> {
        let slot = self.of_slot.get(slot(length, collocation.variable)).filter(|_| recurring);
        let place = slot.map_or(0, |place| usize::from(*place));
        self.has(place, length, collocation).then(|| self.view(place))
    }

    /// The place for the coefficients of a length, `recurring`: one that is kept.
    pub(super) fn place(&mut self, length: f64, recurring: bool, collocation: &'static Collocation<S>) -> usize {
        if self.places.is_empty() {
            // That of a length that does not recur.
            self.add(collocation);
        }
        let slot = slot(length, collocation.variable);
        let Some(place) = self.of_slot.get(slot).filter(|_| recurring) else { return 0 };
        if *place > 0 {
            return usize::from(*place);
        }
        // There is one for each slot.
        let place = self.add(collocation);
        if let (Some(entry), Ok(place)) = (self.of_slot.get_mut(slot), u8::try_from(place)) {
            *entry = place;
        }
        place
    }

    /// Reserves room for a place for each slot, and one more.
    fn reserved(basis: Basis, sizes: Sizes) -> Self {
        let places = SLOTS + 1;
        Self {
            basis,
            places: Vec::with_capacity(places),
            rows: Vec::with_capacity(places * sizes.rows),
            responses: Vec::with_capacity(places * sizes.responses),
            columns: Vec::with_capacity(places * sizes.columns),
            following: Vec::with_capacity(places * sizes.following),
            ends: Vec::with_capacity(places * sizes.ends),
            sizes,
            of_slot: vec![0; SLOTS],
        }
    }

    /// Makes it one for steps with this generator.
    pub(super) fn turn(&mut self, generator: &Generator) {
        for place in &mut self.places {
            place.turns = Turns::NONE;
            place.turns.fill(generator, place.length, &place.collocation.nodes);
        }
    }

    /// Makes a place, for no length yet; returns its index. Out of line, for the sake of the stack.
    #[inline(never)]
    fn add(&mut self, collocation: &'static Collocation<S>) -> usize {
        let place = self.places.len();
        let (sizes, places) = (&self.sizes, place + 1);
        self.rows.resize_with(places * sizes.rows, NodeRows::zeroed);
        self.responses.resize_with(places * sizes.responses, Response::zeroed);
        self.columns.resize_with(places * sizes.columns, ModeColumns::zeroed);
        self.following.resize(places * sizes.following, [0.0; S]);
        self.ends.resize_with(places * sizes.ends, EndGroup::zeroed);
        self.places.push(Place { length: 0.0, collocation, turns: Turns::NONE });
        place
    }

    /// Whether a place has the coefficients for a length.
    pub(super) fn has(&self, place: usize, length: f64, collocation: &Collocation<S>) -> bool {
        self.places.get(place).is_some_and(|own| {
            own.length.to_bits() == length.to_bits() && own.collocation.variable == collocation.variable
        })
    }

    /// What is in a place.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "a place that is there")]
    pub(super) fn view(&self, place: usize) -> StepCoefficients<'_, S> {
        let sizes = &self.sizes;
        let Place { length, turns, .. } = &self.places[place];
        StepCoefficients {
            length: *length,
            columns: part(&self.columns, place, sizes.columns),
            following: part(&self.following, place, sizes.following),
            end: part(&self.ends, place, sizes.ends),
            turns,
            responses: part(&self.responses, place, sizes.responses),
            rows: part(&self.rows, place, sizes.rows),
            of_port: &sizes.of_port,
        }
    }

    /// Computes the coefficients for a length in place.
    #[inline(never)]
    #[expect(clippy::indexing_slicing, reason = "a place that is there")]
    pub(super) fn fill(
        &mut self,
        place: usize,
        length: f64,
        model: &Model,
        collocation: &'static Collocation<S>,
        sums: &mut [Sum<S>],
    ) {
        let (h, shapes, simd) = (length, &collocation.shapes, model.simd);
        let sizes = &self.sizes;
        let own = &mut self.places[place];
        (own.length, own.collocation) = (length, collocation);
        own.turns.fill(&model.generator, length, &collocation.nodes);
        let mut modes = Modes {
            rows: part_mut(&mut self.rows, place, sizes.rows),
            of_port: &sizes.of_port,
            columns: part_mut(&mut self.columns, place, sizes.columns),
            end: part_mut(&mut self.ends, place, sizes.ends),
        };
        sums.iter_mut().for_each(write_zeroes);
        compiled_for!(simd, A => modes.set::<A>(h, model, collocation, sums));
        let responses = part_mut(&mut self.responses, place, sizes.responses);
        for (response, sum) in responses.iter_mut().zip(&*sums) {
            response.set(sum, simd, shapes, h);
        }
        if sizes.following > 0 {
            let following = compiled_for!(simd, A => following::<S, A>(model.law.damping, h, shapes));
            part_mut(&mut self.following, place, sizes.following).copy_from_slice(&following);
        }
    }
}

impl<const S: usize> Clone for Store<S> {
    /// With the same room, as steps do not allocate.
    fn clone(&self) -> Self {
        let mut same = Self::reserved(self.basis.clone(), self.sizes.clone());
        same.places.extend_from_slice(&self.places);
        same.rows.extend_from_slice(&self.rows);
        same.responses.extend_from_slice(&self.responses);
        same.columns.extend_from_slice(&self.columns);
        same.following.extend_from_slice(&self.following);
        same.ends.extend_from_slice(&self.ends);
        same.of_slot.clone_from(&self.of_slot);
        same
    }
}

/// What there is of each mode in a place.
struct Modes<'a, const S: usize> {
    rows: &'a mut [NodeRows<S>],
    of_port: &'a [Range<usize>],
    columns: &'a mut [ModeColumns<S>],
    end: &'a mut [EndGroup<S>],
}

impl<const S: usize> Modes<'_, S> {
    /// Sets it for the length `h` (s), and adds up the modes: `sums` has for each port that of the base acceleration, then those
    /// of the ports up to it, and at the end room for one mode.
    #[inline(always)]
    fn set<A: Arithmetic>(&mut self, h: f64, model: &Model, collocation: &Collocation<S>, sums: &mut [Sum<S>]) {
        let shapes = &collocation.shapes;
        for (i, mode) in model.modes.iter().enumerate() {
            let mode_over_step = ModeOverStep::new(mode.omega_squared, mode.damping, h);
            let response = mode_over_step.response::<S, A>(&collocation.nodes, shapes);
            let mut of_port = sums.iter_mut();
            for (p, (port, range)) in model.ports.iter().zip(self.of_port).enumerate() {
                let b = model.displacement(p, i);
                for (q, sum) in of_port.by_ref().take(p + 2).enumerate() {
                    let weight = b * if q == 0 { mode.participation } else { model.displacement(q - 1, i) };
                    if weight != 0.0 {
                        sum.add::<A>(weight, &response);
                    }
                }
                if port.modes.contains(&i)
                    && let Some(rows) = self.rows.get_mut(range.start + i - port.modes.start)
                {
                    rows.set::<A>(b, mode, &response, h);
                }
            }
            if let Some(group) = self.end.get_mut(i / LANES) {
                let free = FreeMotion::new(mode.omega_squared, mode.damping, h);
                let Pair { q, v } = response.at_end::<A>(shapes);
                let (q, v) = (scaled(&q, h * h), scaled(&v, h));
                group.set(i % LANES, &free, &Pair { q, v });
            }
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    /// Lengths that share a slot are computed anew in turn, which changes no result and is seen nowhere else.
    #[test]
    fn lengths_that_alternate_have_slots_of_their_own() {
        let octaves = |count: i32| (-40..count - 40).map(|octave| f64::from(octave).exp2());
        let free = octaves(32).flat_map(|length| [length, 1.5 * length].map(|length| slot(length, Variable::Time)));
        let free: BTreeSet<usize> = free.collect();
        assert_eq!(free.len(), FREE);
        for k in 0..1000 {
            let size = 1.0 + (0.3 + f64::from(k)) / 1000.7;
            let parts: BTreeSet<usize> = octaves(32).map(|octave| slot(size * octave, Variable::Time)).collect();
            assert!(parts.len() == PARTS && parts.is_disjoint(&free), "{size}");
        }
    }
}
