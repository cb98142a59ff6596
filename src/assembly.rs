//! The ports and links of a model: what its scene puts together.

use crate::armature::Armature;
use crate::beam::mode::{Mode, lowest_frequency};
use crate::chatter::Criterion;
use crate::contact::friction::{self, Friction};
use crate::contact::law::Law;
use crate::electrical::ElectricalContact;
use crate::link::{Link, LinkLaw, Port};
use crate::preload::Preload;
use crate::scene::Scene;

#[derive(Clone, Debug, Default)]
pub struct Assembly {
    pub ports: Vec<Port>,
    /// The laws of these forces, the contact first.
    pub links: Vec<Link>,
    pub roles: Roles,
}

#[derive(Clone, Copy, Debug)]
pub struct Laws {
    pub contact: Law,
    pub parallel: Option<Law>,
    pub second: Option<Law>,
}

/// The index of each link that a model may have beside the contact.
#[derive(Clone, Copy, Debug, Default)]
pub struct Roles {
    pub parallel: Option<usize>,
    pub second: Option<usize>,
    pub friction: Option<usize>,
    /// Core that stops the armature.
    pub core: Option<usize>,
    pub pusher: Option<usize>,
    /// Displacement of the fixed contact on its spring.
    pub fixed: Option<usize>,
}

impl Assembly {
    /// That of a scene with these modes and this preload, and these laws of the contacts.
    pub fn new((scene, modes, preload): (&Scene, &[Mode], &Preload), laws: Laws, armature: Option<&Armature>) -> Self {
        let mut all = Self::default();
        all.contacts((scene, modes, preload), laws);
        if scene.pushed_at().is_some() {
            let port = all.port(Port::new(modes, |mode| mode.pusher));
            let law = Law::linear(scene.pusher.stiffness, scene.pusher.damping);
            // On the side away from the fixed contact: where the spring rises, it comes closer.
            all.roles.pusher = Some(all.link(Link {
                sense: -1.0,
                driven: [0.0, 0.0, 1.0],
                force: preload.pusher_force,
                approach: preload.pusher_overlap,
                ..Link::passive("pusher", LinkLaw::Contact(law), port)
            }));
        }
        if let Some(armature) = armature {
            all.armature(armature, modes, preload);
        }
        if scene.fixed_spring.is_some() {
            let port = all.port(Port::new(modes, |mode| mode.fixed));
            all.roles.fixed =
                Some(all.link(Link { sense: -1.0, ..Link::passive("fixed contact", LinkLaw::Gauge, port) }));
        }
        if let (Some(friction), Some(share)) = (Friction::new(scene, modes), friction::tangential_share(scene)) {
            let port = all.port(Port::new(modes, |mode| friction.height * mode.rotation));
            all.roles.friction = Some(all.link(Link {
                force: share * preload.force,
                ..Link::passive("friction", LinkLaw::Friction(friction), port)
            }));
        }
        all
    }

    fn contacts(&mut self, (scene, modes, preload): (&Scene, &[Mode], &Preload), laws: Laws) {
        let port = self.port(Port::new(modes, |mode| mode.tip));
        let contact = |law: Law| {
            let electrical = ElectricalContact::new(scene, &law);
            let criterion = electrical.as_ref();
            Link {
                electrical,
                criterion: criterion.and_then(|electrical| Criterion::new(scene, electrical)),
                force: preload.force,
                approach: preload.indentation,
                driven: [1.0, 0.0, 0.0],
                circuit: Some(0),
                ..Link::passive("contact", LinkLaw::Contact(law), port)
            }
        };
        self.link(contact(laws.contact));
        if let Some(law) = laws.parallel {
            let port = self.port(Port::new(modes, |mode| mode.parallel));
            self.roles.parallel = Some(self.link(Link {
                name: "parallel contact",
                port,
                force: preload.parallel_force,
                approach: preload.parallel_indentation,
                ..contact(law)
            }));
        }
        if let Some(law) = laws.second {
            // Its fixed contact is rigid.
            let port = match scene.fixed_spring {
                Some(_) => self.port(Port::new(modes, |mode| mode.tip + mode.fixed)),
                None => port,
            };
            // At the distance of the gap; the second input moves it relative to the first.
            self.roles.second = Some(self.link(Link {
                name: "second contact",
                port,
                sense: -1.0,
                driven: [-1.0, 1.0, 0.0],
                force: 0.0,
                approach: -scene.second.gap,
                circuit: Some(1),
                ..contact(law)
            }));
        }
    }

    fn armature(&mut self, armature: &Armature, modes: &[Mode], preload: &Preload) {
        let port = self.port(Port::new(modes, |mode| mode.armature));
        let at = preload.armature;
        let stop = LinkLaw::Contact(armature.stop());
        self.roles.core = Some(self.link(Link {
            sense: -1.0,
            force: at.core_force,
            approach: at.place - armature.given.core_position,
            ..Link::passive("core", stop, port)
        }));
        self.link(Link {
            force: at.rest_force,
            approach: armature.given.rest_position - at.place,
            ..Link::passive("rest stop", stop, port)
        });
        self.link(Link {
            force: at.magnet_force,
            approach: armature.given.core_position - at.place,
            ..Link::passive("magnet", LinkLaw::Magnet(armature.magnet), port)
        });
    }

    /// Lowest angular frequency about the preload, rad/s: of the modes with every closed link as a spring.
    pub fn frequency(&self, modes: &[Mode], coil: f64) -> Option<f64> {
        let springs = self.links.iter().filter_map(|link| {
            let stiffness = match &link.law {
                LinkLaw::Contact(law) if link.force > 0.0 => law.tangent_stiffness(link.force),
                LinkLaw::Magnet(magnet) => magnet.force(link.approach, coil).1,
                _ => return None,
            };
            Some((stiffness, self.ports.get(link.port)?.shape))
        });
        lowest_frequency(modes, springs)
    }

    /// Adds a port, and returns its index.
    fn port(&mut self, port: Port) -> usize {
        self.ports.push(port);
        self.ports.len() - 1
    }

    /// Adds a link, and returns its index.
    fn link(&mut self, link: Link) -> usize {
        self.links.push(link);
        self.links.len() - 1
    }
}
