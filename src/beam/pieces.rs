//! A spring of segments, cut into pieces at the masses and the contact, and where it tapers strongly.

use crate::beam::section::Section;
use crate::math::legendre;
use crate::scene::Scene;
use crate::scene::spring::{PointMass, Segments};

/// Largest ratio of thickness or width between the ends of a piece: 16 nodes then represent `1 / (E I)` to rounding,
/// whose poles lie 4.3 half-lengths from the middle.
const TAPER: f64 = 1.6;

/// Nodes of a piece beyond those that its share of the waves needs.
const SPARE_NODES: usize = 18;

/// Distance below which two places on a spring are the same, as a share of its length.
const SAME: f64 = 1e-9;

/// A stretch without mass or contact inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    pub length: f64,
    /// At start and end.
    width: [f64; 2],
    thickness: [f64; 2],
    youngs_modulus: f64,
    density: f64,
    /// Mass (kg) and rotary inertia (kg m2) at its end.
    pub mass: f64,
    pub inertia: f64,
}

impl Piece {
    /// Bending stiffness (N m2) and mass per length (kg/m) at a share of the length.
    pub fn section(&self, share: f64) -> (f64, f64) {
        let between = |[start, end]: [f64; 2]| start + (end - start) * share;
        let (width, thickness) = (between(self.width), between(self.thickness));
        (self.youngs_modulus * width * thickness.powi(3) / 12.0, self.density * width * thickness)
    }

    /// Both parts, cut at a share of the length; what sits at the end stays there.
    fn cut(self, share: f64) -> [Self; 2] {
        let middle = |[start, end]: [f64; 2]| start + (end - start) * share;
        let (width, thickness) = (middle(self.width), middle(self.thickness));
        let first = Self {
            length: self.length * share,
            width: [self.width[0], width],
            thickness: [self.thickness[0], thickness],
            mass: 0.0,
            inertia: 0.0,
            ..self
        };
        let last = Self {
            length: self.length * (1.0 - share),
            width: [width, self.width[1]],
            thickness: [thickness, self.thickness[1]],
            ..self
        };
        [first, last]
    }

    /// In pieces that taper little.
    fn graded(self, into: &mut Vec<Self>) {
        let ratio = |[start, end]: [f64; 2]| (end / start).max(start / end);
        let (width, thickness) = (self.width, self.thickness);
        let most = if ratio(thickness) > ratio(width) { thickness } else { width };
        let [start, end] = most;
        if ratio(most) <= TAPER {
            into.push(self);
            return;
        }
        for part in self.cut(((start * end).sqrt() - start) / (end - start)) {
            part.graded(into);
        }
    }

    /// Wave number of a unit frequency, integrated over the length: what counts of the length to a wave.
    fn phase(&self) -> f64 {
        let nodes = legendre::gauss(4).map(|(x, weight)| {
            let (stiffness, mass) = self.section(f64::midpoint(x, 1.0));
            weight * (mass / stiffness).sqrt().sqrt()
        });
        0.5 * self.length * nodes.sum::<f64>()
    }
}

/// A spring of segments, cut into pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct Pieces {
    /// From the clamp on.
    pub parts: Vec<Piece>,
    /// Number of pieces up to the contact.
    pub before_contact: usize,
    /// Number of pieces up to the pusher, where there is one.
    pub before_pusher: Option<usize>,
    /// Rotation of the clamp per moment, rad/(N m).
    pub clamp_flexibility: f64,
}

impl Pieces {
    /// The segments with the rivet of the scene at the contact.
    pub fn new(spring: &Segments, scene: &Scene) -> Self {
        let same = SAME * spring.length();
        let contact = spring.contact_position.unwrap_or(spring.length());
        let rivet = PointMass { position: contact, mass: scene.tip.mass, rotary_inertia: scene.tip.rotary_inertia };
        // Nothing, but a place to be cut at.
        let pusher = scene.pushed_at().map(|position| PointMass { position, ..PointMass::default() });
        let mut carried: Vec<_> = spring.masses.iter().copied().chain([rivet]).chain(pusher).collect();
        carried.sort_by(|a, b| a.position.total_cmp(&b.position));
        let mut pieces = Vec::new();
        let mut start = 0.0;
        for segment in &spring.segments {
            let end = start + segment.length;
            let mut rest = Piece {
                length: segment.length,
                width: segment.width,
                thickness: segment.thickness,
                youngs_modulus: segment.youngs_modulus.unwrap_or(scene.beam.youngs_modulus),
                density: segment.density.unwrap_or(scene.beam.density),
                mass: 0.0,
                inertia: 0.0,
            };
            for at in carried.iter().filter(|at| at.position < end - same) {
                let share = 1.0 - (end - at.position) / rest.length;
                if share * rest.length > same {
                    let [first, last] = rest.cut(share);
                    first.graded(&mut pieces);
                    rest = last;
                }
            }
            rest.graded(&mut pieces);
            start = end;
        }
        let (mut end, mut ends) = (0.0, Vec::new());
        for piece in &mut pieces {
            let start = end;
            end += piece.length;
            ends.push(end);
            for at in carried.iter().filter(|at| at.position > start + same && at.position <= end + same) {
                piece.mass += at.mass;
                piece.inertia += at.rotary_inertia;
            }
        }
        let before = |position: f64| ends.iter().filter(|end| **end <= position + same).count();
        Self {
            parts: pieces,
            before_contact: before(contact),
            before_pusher: scene.pushed_at().map(before),
            clamp_flexibility: spring.clamp_stiffness.map_or(0.0, f64::recip),
        }
    }

    /// Whether the spring goes on beyond its contact.
    pub fn goes_on(&self) -> bool {
        self.before_contact < self.parts.len()
    }

    /// Whether it is a uniform spring with its contact at the end, and no mass but there.
    pub fn are_uniform(&self) -> bool {
        let Some((last, others)) = self.parts.split_last() else { return true };
        let section = last.section(1.0);
        let same = |piece: &Piece| piece.section(0.0) == section && piece.section(1.0) == section;
        let bare = |piece: &Piece| same(piece) && piece.mass == 0.0 && piece.inertia == 0.0;
        !self.goes_on() && same(last) && others.iter().all(bare)
    }

    /// Mass of the spring and all it carries, kg.
    pub fn mass(&self) -> f64 {
        let mass = |piece: &Piece| {
            let nodes = legendre::gauss(2).map(|(x, weight)| weight * piece.section(f64::midpoint(x, 1.0)).1);
            0.5 * piece.length * nodes.sum::<f64>() + piece.mass
        };
        self.parts.iter().map(mass).sum()
    }

    /// A uniform spring of the section before the contact, with the mass there, of the length that is as long for waves.
    pub fn at_contact(&self) -> Section {
        let last = self.before_contact.checked_sub(1).and_then(|last| self.parts.get(last));
        let (bending_stiffness, mass_per_length) = last.map_or((0.0, 0.0), |piece| piece.section(1.0));
        let phase: f64 = self.parts.iter().map(Piece::phase).sum();
        Section {
            length: phase * (bending_stiffness / mass_per_length).sqrt().sqrt(),
            bending_stiffness,
            mass_per_length,
            tip_mass: last.map_or(0.0, |piece| piece.mass),
            tip_inertia: 0.0,
        }
    }

    /// Number of nodes of a piece that represents `count` functions: those of a space of polynomials in the phase of a
    /// wave oscillate uniformly in its arc cosine.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small positive count")]
    pub fn nodes(&self, count: usize) -> usize {
        let count = count as f64;
        let whole: f64 = self.parts.iter().map(Piece::phase).sum();
        let mut at = 0.0;
        let widest = self.parts.iter().map(|piece| {
            let before = at;
            at += piece.phase();
            let angle = |phase: f64| (1.0 - 2.0 * phase / whole).clamp(-1.0, 1.0).acos();
            angle(at) - angle(before)
        });
        let widest = widest.fold(0.0, f64::max);
        (0.51 * count * widest).min(count).ceil() as usize + SPARE_NODES
    }
}
