//! The coefficients of the steps taken so far, kept by the length of the step.

use std::mem;
use std::sync::OnceLock;

use bytemuck::Zeroable;

use crate::excitation::random::Piece;
use crate::excitation::waveform::Accelerations;
use crate::integrator::collocation::coefficients::StepCoefficients;
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::shapes::Variable;
use crate::integrator::collocation::store::{Basis, Store};
use crate::integrator::collocation::superposition::Sum;
use crate::math::nodal::{LONG, SHORT};
use crate::model::Model;
use crate::shared::{Home, Shared, Shelf};

/// What all simulations share of steps with `S` nodes.
#[derive(Debug, Default)]
pub struct Common<const S: usize> {
    collocation: Collocation<S>,
    /// By the root of time.
    by_root: OnceLock<Collocation<S>>,
    /// Coefficients that simulations have left.
    left: Shelf<Store<S>>,
}

/// That of short steps.
pub static OF_SHORT: Home<Common<SHORT>> = Home::new();

/// That of long steps.
pub static OF_LONG: Home<Common<LONG>> = Home::new();

/// Cache of coefficients by step length. Its content never affects results, only the time they take.
#[derive(Clone, Debug)]
pub struct Cache<const S: usize> {
    common: Shared<Common<S>>,
    variable: Variable,
    /// For recurring lengths, and first for the last other one.
    places: Store<S>,
    /// While coefficients are computed: for each response, and for one mode.
    sums: Vec<Sum<S>>,
    /// Piece of a random acceleration.
    piece: Piece,
}

/// What a step of a length from an instant on is computed with.
#[derive(Clone, Copy, Debug)]
pub struct Prepared<'a, const S: usize> {
    /// The coefficients of its length.
    pub step: StepCoefficients<'a, S>,
    /// The polynomials.
    pub collocation: &'a Collocation<S>,
    /// Accelerations of the generator.
    pub generated: Accelerations<S>,
}

impl<const S: usize> Common<S> {
    /// The polynomials by this variable.
    fn polynomials(&self, variable: Variable) -> &Collocation<S> {
        match variable {
            Variable::Time => &self.collocation,
            Variable::Root => self.by_root.get_or_init(|| Collocation::new(variable)),
        }
    }
}

impl<const S: usize> Cache<S> {
    /// With what another simulation of the same modes has left, or allocated for the model.
    pub fn new(model: &Model, home: &'static Home<Common<S>>, variable: Variable) -> Self {
        let (common, basis) = (Shared::of(home), Basis::of(model, variable));
        // Now: not in a step.
        let collocation = common.polynomials(variable);
        let places = match common.left.take(|places| places.is_of(&basis)) {
            Some(mut places) => {
                places.turn(&model.generator, &collocation.nodes);
                places
            }
            None => Store::for_model(basis, model),
        };
        Self {
            sums: vec![Sum::zeroed(); Store::<S>::sums(model)],
            common,
            variable,
            places,
            piece: Piece::default(),
        }
    }

    /// Those by a variable.
    pub fn polynomials(&self, variable: Variable) -> &Collocation<S> {
        self.common.polynomials(variable)
    }

    /// What it takes of memory for the model at most, bytes.
    pub fn size(model: &Model) -> usize {
        Store::<S>::sums(model) * size_of::<Sum<S>>() + Store::<S>::size(model)
    }

    /// The polynomials.
    pub fn collocation(&self) -> &Collocation<S> {
        self.polynomials(self.variable)
    }

    /// The coefficients for a length, with the base acceleration of a step from `time` (s) on.
    pub fn prepare(&mut self, time: f64, length: f64, recurring: bool, model: &Model) -> Prepared<'_, S> {
        let collocation = self.common.polynomials(self.variable);
        let place = self.places.place(length, recurring);
        if self.places.length(place).to_bits() != length.to_bits() {
            self.places.fill(place, length, model, collocation, &mut self.sums);
        }
        let step = self.places.view(place);
        Prepared {
            step,
            collocation,
            generated: model.generator.over_step(model.simd, time, step.turns, &mut self.piece),
        }
    }

    /// The coefficients for a length, if they are known.
    pub fn known(&self, length: f64, recurring: bool) -> Option<StepCoefficients<'_, S>> {
        self.places.known(length, recurring)
    }
}

impl<const S: usize> Drop for Cache<S> {
    fn drop(&mut self) {
        let places = mem::take(&mut self.places);
        self.common.left.leave(places, &self.common);
    }
}
