//! Coefficients of steps of several lengths for one set of modes.

use std::ops::Range;

use bytemuck::allocation::zeroed_vec;
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

/// One for each, and one for the last length that does not recur.
const PLACES: usize = SLOTS + 1;

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

/// The same number of things for each length, in places that are made as they are needed: room for all of them is reserved, as steps do
/// not allocate, but not touched before.
#[derive(Debug)]
struct Blocks<T> {
    all: Vec<T>,
    /// How many a place has.
    size: usize,
}

impl<T> Blocks<T> {
    fn reserved(size: usize) -> Self {
        Self { all: Vec::with_capacity(PLACES * size), size }
    }

    /// Makes another place.
    fn add(&mut self, make: impl FnMut() -> T) {
        self.all.resize_with(self.all.len() + self.size, make);
    }

    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "a place that is there")]
    fn of(&self, place: usize) -> &[T] {
        &self.all[place * self.size..(place + 1) * self.size]
    }

    #[expect(clippy::indexing_slicing, reason = "a place that is there")]
    fn of_mut(&mut self, place: usize) -> &mut [T] {
        &mut self.all[place * self.size..(place + 1) * self.size]
    }
}

impl<T> Default for Blocks<T> {
    fn default() -> Self {
        Self { all: Vec::new(), size: 0 }
    }
}

impl<T: Clone> Clone for Blocks<T> {
    /// With the same room.
    fn clone(&self) -> Self {
        let mut same = Self::reserved(self.size);
        same.all.extend_from_slice(&self.all);
        same
    }
}

/// What every place has one of. Each reserved room costs a page of memory, however little of it is used.
#[derive(Clone, Debug)]
struct Place<const S: usize> {
    /// Length of the step, s; 0: none yet.
    length: f64,
    collocation: &'static Collocation<S>,
    turns: Turns<S>,
}

/// Coefficients of steps of several lengths.
#[derive(Clone, Debug, Default)]
pub(crate) struct Store<const S: usize> {
    /// All that they depend on, but for the generator.
    modes: Vec<Mode>,
    ports: Vec<Port>,
    /// Damping time of the contact, s, where it rubs.
    rubbing: Option<f64>,
    portable: bool,
    places: Blocks<Place<S>>,
    rows: Blocks<NodeRows<S>>,
    responses: Blocks<Response<S>>,
    /// Where an axial force loads each mode.
    columns: Blocks<ModeColumns<S>>,
    /// Where the contact rubs.
    following: Blocks<Nodal<S>>,
    ends: Blocks<EndGroup<S>>,
    /// Where the rows of each port begin and end.
    of_port: Vec<Range<usize>>,
    /// The place of each slot that a recurring length may have by its hash; 0: none yet.
    of_slot: Vec<u8>,
    /// The place that was last asked for.
    last: usize,
    /// While coefficients are computed: for each response, and for one mode.
    sums: Vec<Sum<S>>,
}

/// How many rows, responses, columns, following velocities and groups of modes at the end a place has.
fn sizes<const S: usize>(model: &Model) -> [usize; 5] {
    let rows = model.ports.iter().map(|port| port.modes.len()).sum();
    let columns = if model.axial.is_some() { model.modes.len() } else { 0 };
    let following = if model.friction().is_some() { S } else { 0 };
    [rows, responses_before(model.ports.len()), columns, following, model.modes.len().div_ceil(LANES)]
}

/// Damping time of the contact, s, where it rubs.
fn rubbing(model: &Model) -> Option<f64> {
    model.friction().map(|_| model.law.damping)
}

impl<const S: usize> Store<S> {
    /// With room for all lengths of a model.
    pub(super) fn new(model: &Model) -> Self {
        let [rows, responses, columns, following, ends] = sizes::<S>(model);
        let mut before = 0;
        let of_port = model.ports.iter().map(|port| {
            let first = before;
            before += port.modes.len();
            first..before
        });
        Self {
            modes: model.modes.clone(),
            ports: model.ports.clone(),
            rubbing: rubbing(model),
            portable: matches!(model.simd, Simd::Portable),
            places: Blocks::reserved(1),
            rows: Blocks::reserved(rows),
            responses: Blocks::reserved(responses),
            columns: Blocks::reserved(columns),
            following: Blocks::reserved(following),
            ends: Blocks::reserved(ends),
            of_port: of_port.collect(),
            of_slot: vec![0; SLOTS],
            last: 0,
            sums: zeroed_vec(responses + 1),
        }
    }

    /// What it takes of memory for a model at most, bytes.
    pub(super) fn size(model: &Model) -> usize {
        let [rows, responses, columns, following, ends] = sizes::<S>(model);
        let place = size_of::<Place<S>>()
            + rows * size_of::<NodeRows<S>>()
            + responses * size_of::<Response<S>>()
            + columns * size_of::<ModeColumns<S>>()
            + following * size_of::<Nodal<S>>()
            + ends * size_of::<EndGroup<S>>();
        PLACES * place + (responses + 1) * size_of::<Sum<S>>()
    }

    /// Whether its coefficients are those of a model.
    pub(super) fn is_of(&self, model: &Model) -> bool {
        self.modes == model.modes
            && self.ports == model.ports
            && (self.columns.size > 0) == model.axial.is_some()
            && self.rubbing == rubbing(model)
            && self.portable == matches!(model.simd, Simd::Portable)
    }

    /// Makes it one for steps with this generator.
    pub(super) fn turn(&mut self, generator: &Generator) {
        for place in &mut self.places.all {
            place.turns = Turns::NONE;
            place.turns.fill(generator, place.length, &place.collocation.nodes);
        }
    }

    /// The coefficients for a length, `recurring`: one that is kept.
    pub(super) fn prepare(
        &mut self,
        length: f64,
        recurring: bool,
        model: &Model,
        collocation: &'static Collocation<S>,
    ) -> StepCoefficients<'_, S> {
        let place = self.place(length, recurring, collocation);
        if !self.has(place, length, collocation) {
            self.fill(place, length, model, collocation);
        }
        self.last = place;
        self.view(place)
    }

    /// The place for them.
    fn place(&mut self, length: f64, recurring: bool, collocation: &'static Collocation<S>) -> usize {
        if self.places.all.is_empty() {
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

    /// Makes a place, for no length yet; returns its index. Out of line, for the sake of the stack.
    #[inline(never)]
    fn add(&mut self, collocation: &'static Collocation<S>) -> usize {
        self.rows.add(NodeRows::zeroed);
        self.responses.add(Response::zeroed);
        self.columns.add(ModeColumns::zeroed);
        self.following.add(|| [0.0; S]);
        self.ends.add(EndGroup::zeroed);
        self.places.add(|| Place { length: 0.0, collocation, turns: Turns::NONE });
        self.places.all.len() - 1
    }

    /// Whether a place has the coefficients for a length.
    fn has(&self, place: usize, length: f64, collocation: &Collocation<S>) -> bool {
        self.places.all.get(place).is_some_and(|own| {
            own.length.to_bits() == length.to_bits() && own.collocation.variable == collocation.variable
        })
    }

    /// What is in a place.
    #[inline(always)]
    #[expect(clippy::indexing_slicing, reason = "a place that is there")]
    fn view(&self, place: usize) -> StepCoefficients<'_, S> {
        let Place { length, turns, .. } = &self.places.all[place];
        StepCoefficients {
            length: *length,
            columns: self.columns.of(place),
            following: self.following.of(place),
            end: self.ends.of(place),
            turns,
            responses: self.responses.of(place),
            rows: self.rows.of(place),
            of_port: &self.of_port,
        }
    }

    /// Computes the coefficients for a length in place.
    #[inline(never)]
    #[expect(clippy::indexing_slicing, reason = "a place that is there")]
    fn fill(&mut self, place: usize, length: f64, model: &Model, collocation: &'static Collocation<S>) {
        let (shapes, simd) = (&collocation.shapes, model.simd);
        let own = &mut self.places.all[place];
        (own.length, own.collocation) = (length, collocation);
        own.turns.fill(&model.generator, length, &collocation.nodes);
        let mut modes = Modes {
            rows: self.rows.of_mut(place),
            of_port: &self.of_port,
            columns: self.columns.of_mut(place),
            end: self.ends.of_mut(place),
        };
        let sums = &mut self.sums;
        sums.iter_mut().for_each(write_zeroes);
        compiled_for!(simd, A => modes.set::<A>(length, model, collocation, sums));
        for (response, sum) in self.responses.of_mut(place).iter_mut().zip(sums) {
            response.set(sum, simd, shapes, length);
        }
        if let Some(damping) = self.rubbing {
            let following = compiled_for!(simd, A => following::<S, A>(damping, length, shapes));
            self.following.of_mut(place).copy_from_slice(&following);
        }
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
