//! Ritz space of a spring of segments: the shapes under a few loads, and under the inertia of the shapes before.
//!
//! The loads are the contact force, base acceleration, angular acceleration about the clamp, and force and moment at the end. A spring has
//! four independent motions of a given frequency; each is a power series in the square of the frequency
//! whose terms arise from these shapes by `K^-1 M`. So the space holds what moves the spring at any place for frequencies
//! up to a bound that grows with its size. Without axial force it is the space of polynomials of [`galerkin`] on a uniform spring, and it
//! holds the static shape under a contact force in any case. (E. L. Wilson, M.-W. Yuan, J. M. Dickens, Earthquake Engineering and
//! Structural Dynamics 10 (1982) 813; in blocks: B. Nour-Omid, R. W. Clough, ibid. 13 (1985) 271.)
//!
//! `K` is the stiffness under the axial force. That of bending alone would leave out of all shapes what the force does to a taper or a
//! step, and so of the last ones too, which tell what is missing ([`resolution`](crate::beam::resolution)).
//!
//! Of a force of the pusher the space holds the static shape, with its bend. What would follow from it by `K^-1 M` is smooth but for its
//! seventh derivative, bends like the others, and would take from them a fifth of the modes.
//!
//! [`galerkin`]: crate::beam::galerkin

use std::collections::VecDeque;
use std::iter;

use nalgebra::{DMatrix, DVector};

use crate::beam::galerkin::{Places, Space};
use crate::beam::mesh::{Bend, Mesh, Moments, dot};
use crate::beam::pieces::Pieces;
use crate::beam::section::Section;
use crate::beam::statics;

/// The uniform spring of the same mass that deflects and turns as much at its end under a force there.
pub fn equivalent(spring: &Pieces) -> Section {
    let mesh = Mesh::new(spring, 1);
    let (deflection, slope) = mesh.bent(mesh.pushed(spring.before_contact)).at_end(spring.before_contact);
    let length = 1.5 * deflection / slope;
    Section {
        length,
        bending_stiffness: length.powi(3) / (3.0 * deflection),
        mass_per_length: spring.mass() / length,
        tip_mass: 0.0,
        tip_inertia: 0.0,
    }
}

/// A space of `count` functions for statics, in units of the equivalent section.
pub fn static_space(spring: &Pieces, section: &Section, count: usize) -> Space {
    let mesh = Mesh::new(spring, count);
    space(&mesh, &static_shapes(&mesh, count), section)
}

/// A space of `count` functions for motion under an axial compression (N), where `rubs` also under a moment at the contact,
/// in units of the equivalent section. `None` if it buckles.
pub fn dynamic_space(spring: &Pieces, section: &Section, count: usize, axial_force: f64, rubs: bool) -> Option<Space> {
    let mesh = Mesh::new(spring, count.max(statics::size(section, axial_force)));
    let (contact, end) = (spring.before_contact, spring.parts.len());
    let pushed = pushed_under(&mesh, section, axial_force)?;
    let compression = if axial_force == 0.0 { None } else { Some(mesh.compression(axial_force)?) };
    let under = |moments: Moments| match &compression {
        Some(compression) => compression.added(moments),
        None => moments,
    };
    let [moved, turned] = mesh.shaken();
    let mut starts = vec![moved, mesh.turned(end), turned];
    if spring.goes_on() {
        starts.push(mesh.pushed(end));
        if rubs {
            starts.push(mesh.turned(contact));
        }
    }
    // Where the contact is, it is the shape of that.
    let elsewhere = spring.before_pusher.filter(|pusher| *pusher != contact && count > 1);
    let pusher = elsewhere.map(|pusher| mesh.pushed(pusher));
    let starts = iter::once(pushed).chain(starts.into_iter().map(under)).collect();
    let shapes = krylov(&mesh, pusher.map(under), starts, |shape| under(mesh.swung(shape)), count);
    Some(space(&mesh, &shapes, section))
}

fn static_shapes(mesh: &Mesh, count: usize) -> Vec<Bend> {
    let [moved, _] = mesh.shaken();
    let pusher = mesh.spring.before_pusher.map(|pusher| mesh.pushed(pusher));
    let starts = [mesh.pushed(mesh.spring.before_contact), moved].into_iter().chain(pusher);
    krylov(mesh, None, starts.collect(), |shape| mesh.compressed(shape), count)
}

/// The moments of unit contact force and an axial compression (N).
fn pushed_under(mesh: &Mesh, section: &Section, axial_force: f64) -> Option<Moments> {
    if axial_force == 0.0 {
        return Some(mesh.pushed(mesh.spring.before_contact));
    }
    let shapes = static_shapes(mesh, statics::size(section, axial_force));
    let space = space(mesh, &shapes, section);
    let deflections = space.deflections(section, axial_force)?;
    Some(mesh.sum(deflections.iter().copied().zip(&shapes)))
}

/// Up to `count` orthonormal shapes: one from which nothing follows, if any, the starts, then in turn what follows from each.
fn krylov(
    mesh: &Mesh,
    barren: Option<Moments>,
    starts: Vec<Moments>,
    next: impl Fn(&Bend) -> Moments,
    count: usize,
) -> Vec<Bend> {
    let mut waiting = VecDeque::from(starts);
    let mut found = Vec::with_capacity(count);
    found.extend(barren.and_then(|moments| mesh.orthonormal(moments, &[])));
    while found.len() < count
        && let Some(moments) = waiting.pop_front()
    {
        if let Some(shape) = mesh.orthonormal(moments, &found) {
            waiting.push_back(next(&shape));
            found.push(shape);
        }
    }
    found
}

/// The space of orthonormal shapes.
fn space(mesh: &Mesh, shapes: &[Bend], section: &Section) -> Space {
    let (contact, pusher) = (mesh.spring.before_contact, mesh.spring.before_pusher);
    let (masses, lengths, ends) = mesh.inertia();
    let products = |columns: Vec<Vec<f64>>| {
        let columns: Vec<_> = columns.into_iter().map(DVector::from_vec).collect();
        let matrix = DMatrix::from_columns(&columns);
        matrix.tr_mul(&matrix)
    };
    let moved = |shape: &Bend| {
        let inside = masses.iter().zip(&shape.deflection).map(|(mass, y)| mass.sqrt() * y);
        let carried = ends.iter().zip(&shape.ends);
        let carried = carried.flat_map(|((mass, inertia), (y, turn))| [mass.sqrt() * y, inertia.sqrt() * turn]);
        inside.chain(carried).collect()
    };
    let turned = |shape: &Bend| {
        let nodes = lengths.iter().zip(&shape.slope);
        nodes.map(|(length, slope)| length.sqrt() * slope).collect()
    };
    let loaded = |shape: &Bend| -> f64 {
        let carried = ends.iter().zip(&shape.ends).map(|((mass, _), (y, _))| mass * y);
        dot(&masses, &shape.deflection) + carried.sum::<f64>()
    };
    let vector = |value: &dyn Fn(&Bend) -> f64| DVector::from_iterator(shapes.len(), shapes.iter().map(value));
    Space::with(
        section,
        products(shapes.iter().map(moved).collect()),
        products(shapes.iter().map(turned).collect()),
        vector(&loaded),
        Places {
            tip: vector(&|shape| shape.at_end(contact).0),
            slope: vector(&|shape| shape.at_end(contact).1),
            pusher: vector(&|shape| pusher.map_or(0.0, |pusher| shape.at_end(pusher).0)),
            // Side by side at one tip; tongues of their own come as modes of their own.
            parallel: vector(&|shape| shape.at_end(contact).0),
        },
    )
}
