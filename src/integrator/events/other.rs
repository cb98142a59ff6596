//! The other contact of two: in flight it may close as well as the one whose view the state is.
//!
//! It is looked for by the same search, in the mirror image of the step ([`State::mirror`](crate::state::State::mirror)).
//! Where it closes, the state goes over to its view.

use crate::integrator::collocation::step::Trial;
use crate::integrator::constants::DISTANT;
use crate::integrator::course::turning_points;
use crate::integrator::events::Cut;
use crate::integrator::integration::Integration;
use crate::integrator::workspace::{Room, Workspace};
use crate::math::nodal::Nodal;
use crate::math::prediction::value_and_slope;

impl Integration<'_> {
    /// Goes over to the view of the other contact.
    pub(crate) fn mirror(&mut self) {
        if let Some(other) = self.other.replace(self.model) {
            self.model = other;
            self.state.mirror(self.drive.second_rate);
            self.drive = self.drive.mirrored();
        }
    }

    /// Locates the first closing of either contact in the trial of free flight of `length` seconds; `None` if both stay
    /// open.
    pub(crate) fn closing_of_either<const S: usize>(&mut self, trial: &Trial<S>, length: f64) -> Option<Cut>
    where
        Workspace: Room<S>,
    {
        let other = self.closing_of_other(trial, length);
        let own = self.closing(trial, length);
        match other {
            Some(at) if own.as_ref().is_none_or(|own| at < own.end.at) => {
                let end = self.inside(trial, length, at);
                Some(Cut {
                    mirrors: true,
                    ..self.cut(end, true)
                })
            }
            _ => own,
        }
    }

    /// When the other contact closes in the trial, s after its start.
    fn closing_of_other<const S: usize>(&mut self, trial: &Trial<S>, length: f64) -> Option<f64>
    where
        Workspace: Room<S>,
    {
        let gap = -self.other?.preload.indentation;
        let second = self.second_support(length);
        let start = self.state.second_support - self.state.indentation;
        let (mut lowest, mut highest) = (start, start);
        let mut fastest = (self.drive.second_rate - self.state.indentation_rate).abs();
        for ((second, d), rate) in second.iter().zip(&trial.indentations).zip(&trial.rates) {
            (lowest, highest) = (lowest.min(second - d), highest.max(second - d));
            fastest = fastest.max((self.drive.second_rate - rate).abs());
        }
        if highest + DISTANT * (highest - lowest + fastest * length) < gap {
            return None;
        }
        let image = trial.mirrored(&second, self.drive.second_rate);
        let (state, drive) = (*self.state, self.drive);
        let (model, other) = (self.model, self.other);
        self.mirror();
        self.mirror_loads::<S>();
        let found = self.closing(&image, length);
        self.mirror_loads::<S>();
        (self.model, self.other, self.drive) = (model, other, drive);
        *self.state = state;
        // It is a gap away: time advances.
        found.map(|cut| cut.end.at.max(self.resolution()))
    }

    /// Those of an axial force on the modes in the trial.
    fn mirror_loads<const S: usize>(&mut self)
    where
        Workspace: Room<S>,
    {
        if self.model.axial().is_some() {
            let (_, end, _) = Room::<S>::parts(self.workspace);
            end.loads.iter_mut().flatten().for_each(|load| *load = -*load);
        }
    }

    /// Places of the second fixed contact relative to the first at the nodes of a step of `length` seconds, m.
    fn second_support<const S: usize>(&mut self, length: f64) -> Nodal<S>
    where
        Workspace: Room<S>,
    {
        let (start, way) = (self.state.second_support, self.drive.second_rate * length);
        self.collocation::<S>().nodes.map(|node| start + way * node)
    }

    /// Records in the extremes how near the second contact comes in the step of `length` seconds about to be taken.
    pub(crate) fn note_approach<const S: usize>(&mut self, trial: &Trial<S>, length: f64)
    where
        Workspace: Room<S>,
    {
        if self.extremes.is_none() || self.other.is_none() {
            return;
        }
        let gap = self.model.scene.second.gap;
        let (mirrored, second_rate) = (self.state.mirrored, self.drive.second_rate);
        let seen = |second: f64, d: f64, rate: f64| {
            if mirrored {
                (d, rate)
            } else {
                (second - d, second_rate - rate)
            }
        };
        let second = self.second_support(length);
        let state = &self.state;
        let (start, mut before) = seen(state.second_support, state.indentation, state.indentation_rate);
        let (mut nearest, mut turns, mut indentations) = (start, false, second);
        for ((place, d), rate) in indentations.iter_mut().zip(&trial.indentations).zip(&trial.rates) {
            let (indentation, now) = seen(*place, *d, *rate);
            *place = indentation;
            nearest = nearest.max(indentation);
            turns |= before > 0.0 && now <= 0.0;
            before = now;
        }
        let simd = self.model.simd;
        let inside = turns.then(|| self.collocation::<S>().through(simd, start, &indentations));
        if let Some(extremes) = &mut self.extremes {
            extremes.approach(nearest - gap);
            if let Some(polynomial) = inside {
                for y in turning_points(&polynomial).iter() {
                    extremes.approach(value_and_slope(&polynomial, y).0 - gap);
                }
            }
        }
    }
}
