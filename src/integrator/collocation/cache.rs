//! The coefficients of the steps taken so far, kept by the length of the step.

use std::mem;

use crate::excitation::random::Piece;
use crate::excitation::waveform::Accelerations;
use crate::integrator::collocation::coefficients::StepCoefficients;
use crate::integrator::collocation::polynomial::Collocation;
use crate::integrator::collocation::store::Store;
use crate::math::nodal::{LONG, SHORT};
use crate::model::Model;
use crate::shared::{Home, Shared, Shelf};

/// Coefficients of steps with `S` nodes that simulations have left.
pub type Left<const S: usize> = Shelf<Store<S>>;

/// Those of short steps.
pub static OF_SHORT: Home<Left<SHORT>> = Home::new(None);

/// Those of long steps.
pub static OF_LONG: Home<Left<LONG>> = Home::new(None);

/// Cache of coefficients by step length. Its content never affects results, only the time they take.
#[derive(Clone, Debug)]
pub struct Cache<const S: usize> {
    left: Shared<Left<S>>,
    /// The polynomials.
    pub(crate) collocation: &'static Collocation<S>,
    places: Store<S>,
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

impl<const S: usize> Cache<S> {
    /// With what another simulation of the same modes has left, or allocated for the model.
    pub fn new(model: &Model, home: &'static Home<Left<S>>, collocation: &'static Collocation<S>) -> Self {
        let left = Shared::of(home);
        let places = match left.take(|places| places.is_of(model)) {
            Some(mut places) => {
                places.turn(&model.generator);
                places
            }
            None => Store::new(model),
        };
        Self { left, collocation, places, piece: Piece::default() }
    }

    /// What it takes of memory for the model at most, bytes.
    pub fn size(model: &Model) -> usize {
        Store::<S>::size(model)
    }

    /// The coefficients for a length, with the base acceleration of a step from `time` (s) on.
    pub fn prepare(&mut self, time: f64, length: f64, recurring: bool, model: &Model) -> Prepared<'_, S> {
        let collocation = self.collocation;
        let step = self.places.prepare(length, recurring, model, collocation);
        Prepared {
            step,
            collocation,
            generated: model.generator.over_step(model.simd, time, step.turns, &mut self.piece),
        }
    }
}

impl<const S: usize> Drop for Cache<S> {
    fn drop(&mut self) {
        let places = mem::take(&mut self.places);
        self.left.leave(places, &self.left);
    }
}
