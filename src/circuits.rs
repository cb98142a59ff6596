//! Interruptions of the circuits that the contacts close: that of the contact with its parallel one, and that of the second
//! contact. A circuit is interrupted while all of its contacts are.

use serde::{Deserialize, Serialize};

use crate::chatter::Interruptions;
use crate::integrator::course::Places;
use crate::link::{Link, MAX_LINKS};

pub const CIRCUITS: usize = 2;

/// What is counted of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Circuits {
    interrupted: [bool; MAX_LINKS],
    interruptions: [Interruptions; CIRCUITS],
}

impl Circuits {
    /// Interruptions of a circuit so far.
    pub fn of(&self, circuit: usize) -> Interruptions {
        self.interruptions.get(circuit).copied().unwrap_or_default()
    }

    pub fn is_interrupted(&self, link: usize) -> bool {
        self.interrupted.get(link).is_some_and(|interrupted| *interrupted)
    }

    /// Whether the values are consistent at an instant (s) (check of a deserialised state).
    pub fn is_sound(&self, time: f64) -> bool {
        self.interruptions.iter().all(|circuit| circuit.is_sound(time))
    }

    /// Begins and ends interruptions at an instant (s) as these forces do.
    pub fn note(&mut self, links: &[Link], forces: impl Iterator<Item = f64>, time: f64) {
        for (index, (link, force)) in links.iter().zip(forces).enumerate() {
            let Some(criterion) = &link.criterion else { continue };
            if (force < criterion.force) != self.is_interrupted(index) {
                self.turn(links, index, time);
            }
        }
    }

    /// Begins and ends the interruptions in a step of this length (s) to an instant (s), at their places in it up to `now`.
    pub(crate) fn pass(
        &mut self,
        links: &[Link],
        passages: &[&Places; MAX_LINKS],
        (end, length): (f64, f64),
        now: f64,
    ) {
        let mut passed = [0; MAX_LINKS];
        loop {
            // Those of the contacts of a circuit in the order of time.
            let ahead = passages.iter().zip(&passed).take(links.len()).enumerate();
            let ahead = ahead.filter_map(|(index, (places, passed))| Some((index, places.until(now).nth(*passed)?)));
            let Some((index, place)) = ahead.min_by(|a, b| a.1.total_cmp(&b.1)) else { return };
            if let Some(passed) = passed.get_mut(index) {
                *passed += 1;
            }
            self.turn(links, index, end + place * length);
        }
    }

    /// Begins or ends the interruption of a contact at an instant (s), and with it that of its circuit.
    fn turn(&mut self, links: &[Link], index: usize, time: f64) {
        let Some((link, at)) = links.get(index).zip(self.interrupted.get_mut(index)) else { return };
        *at = !*at;
        let mut counted = links.iter().zip(&self.interrupted);
        let all = counted.all(|(other, at)| *at || other.criterion.is_none() || other.circuit != link.circuit);
        if let (Some(circuit), Some(criterion)) = (link.circuit, &link.criterion)
            && let Some(circuit) = self.interruptions.get_mut(circuit)
            && circuit.in_progress != all
        {
            circuit.turn(criterion, time);
        }
    }
}
