//! The dependencies of initial unknowns that the description declares, against what changes when a known is changed.

use std::collections::{BTreeMap, BTreeSet};

use std::path::Path;
use std::thread;

use relay_contact::MODEL_DESCRIPTION;
use relay_contact::error::SceneError;
use relay_contact::inputs::Inputs;
use relay_contact::scene::{Scene, choices};
use relay_contact::simulation::Simulation;
use relay_contact::variables::{Group, RealOutput, VARIABLES, Variable};
use roxmltree::Document;

/// Values by name, choices and Booleans by number.
type Values = Vec<(&'static str, f64)>;

/// In all scenes.
const ALWAYS: &str = "effects.heating=1 contact.current=0.1 effects.axialForce=1";

/// Changes that many scenes have.
const SHARED: [(&str, &str); 11] = [
    ("PLAIN", ""),
    ("ALL_COUNT", "chatter.minimumDuration=0"),
    ("PULLED", "environment.gravity=-9.81"),
    ("OPEN", "contact.overtravel=-1e-4"),
    ("RUBBING", "effects.friction=2"),
    ("SECOND", "effects.secondContact=1"),
    ("BESIDE", "effects.parallelContact=1"),
    ("ON_SPRING", "fixed.file=1"),
    ("PRESSED", "effects.pusher=2"),
    ("MOVED", "effects.pusher=3"),
    // Between its stops.
    ("FLOATING", "armature.corePosition=1e-3 armature.gapConstant=1e-3 armature.returnForce=0"),
];

/// From what is critical so far, m: thousands of roundings, which depend on everything.
const BARELY: f64 = 1e-15;

/// Scenes in which every known that matters at all matters somewhere: the start values with these changes. A threshold that
/// is critical is the resistance at rest; with an overtravel that is critical the contact is about to close, with a parallel contact or a
/// pusher that is, it has just touched.
const SCENES: &str = "\
PLAIN
effects.axialForce=2
effects.axialForce=3
effects.axialForce=3 solver.modes=5
effects.axialForce=4
solver.tolerance=1e-9 beam.stiffnessDamping=3e-6
effects.contactLaw=2 solver.tolerance=1e-3
effects.contactLaw=3 effects.contactDamping=0
effects.contactLaw=4
effects.contactLaw=4 effects.friction=2 friction.initial=0.5
PULLED ALL_COUNT effects.contactLaw=4 chatter.resistanceThreshold=critical
effects.contactLaw=4 effects.secondContact=1 second.stiffness=1e7
environment.gravity=9.81 effects.axialForce=3
PULLED contact.overtravel=critical
PULLED effects.axialForce=4 beam.axialForce=2 contact.overtravel=critical
PULLED ALL_COUNT effects.axialForce=4 chatter.resistanceThreshold=critical
PULLED ALL_COUNT effects.resistance=2 chatter.resistanceThreshold=critical
contact.overtravel=-2e-5 support.displacement=1e-4
ALL_COUNT contact.overtravel=-2e-5
resistance.film=0.1 contact.current=100
resistance.film=100 contact.current=-1
effects.resistance=3 effects.chatter=0
effects.heating=0 effects.extremes=0
effects.excitation=2 effects.energy=1
effects.excitation=5 beam.massDamping=100
SECOND second.curvatureRadius=5 effects.axialForce=3
SECOND second.curvatureRadius=5 second.damping=1e-6 beam.stiffnessDamping=3e-6
SECOND effects.extremes=0 effects.chatter=0
RUBBING ALL_COUNT effects.axialForce=4 chatter.resistanceThreshold=critical
RUBBING PULLED effects.axialForce=4
ON_SPRING RUBBING PULLED ALL_COUNT effects.axialForce=4 beam.axialForce=1 chatter.resistanceThreshold=critical
PRESSED OPEN pusher.displacement=3e-4 RUBBING PULLED ALL_COUNT effects.axialForce=4 beam.axialForce=1 \
    chatter.resistanceThreshold=critical
PRESSED PULLED RUBBING effects.axialForce=4 beam.axialForce=1 pusher.displacement=critical
PRESSED PULLED effects.axialForce=4 beam.axialForce=-1 pusher.displacement=critical
MOVED OPEN PULLED RUBBING ALL_COUNT effects.axialForce=4 beam.axialForce=1 chatter.resistanceThreshold=critical
MOVED OPEN FLOATING RUBBING ALL_COUNT chatter.resistanceThreshold=critical
MOVED OPEN armature.holdForce=2 FLOATING ON_SPRING
MOVED OPEN PULLED coil.relativeCurrent=0 armature.mass=0.5 armature.restPosition=-1e-5 armature.corePosition=1e-3
BESIDE parallel.offset=1e-5 beam.file=2
BESIDE PULLED ALL_COUNT effects.contactLaw=4 effects.axialForce=4 beam.axialForce=1 chatter.resistanceThreshold=critical
BESIDE PRESSED OPEN PULLED pusher.displacement=3e-4 ON_SPRING
BESIDE MOVED OPEN PULLED ON_SPRING effects.contactLaw=4
BESIDE PULLED parallel.offset=-1e-5 contact.overtravel=critical effects.contactLaw=4
BESIDE MOVED FLOATING PULLED effects.axialForce=4 beam.axialForce=1 contact.overtravel=critical
# Half of the force has a resistance just above.
BESIDE ALL_COUNT chatter.resistanceThreshold=0.085
BESIDE ALL_COUNT effects.contactLaw=4 chatter.resistanceThreshold=0.085
# The parallel contact holds the first open; a softer one would not.
BESIDE parallel.offset=-2e-7
BESIDE parallel.offset=critical
BESIDE effects.contactLaw=4 parallel.offset=critical
BESIDE PRESSED PULLED pusher.displacement=critical
BESIDE PRESSED PULLED effects.contactLaw=4 pusher.displacement=critical
BESIDE MOVED PULLED coil.relativeCurrent=0.2 OPEN
BESIDE ON_SPRING parallel.offset=-1e-3 contact.overtravel=1e-5 effects.contactLaw=4
";

/// The scenes, each with its changes.
fn scenes() -> Vec<Values> {
    let lines = SCENES.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| values(ALWAYS).chain(values(line)).collect()).collect()
}

/// The values in a text, a critical one as no number.
fn values(text: &'static str) -> impl Iterator<Item = (&'static str, f64)> {
    let changes = text.split_whitespace().flat_map(|word| {
        let shared = SHARED.iter().find(|(name, _)| *name == word);
        shared.map_or(word, |(_, changes)| changes).split_whitespace()
    });
    changes.map(|change| {
        let (name, value) = change.split_once('=').unwrap();
        let critical = value == "critical";
        (name, if critical { f64::NAN } else { value.parse().unwrap() })
    })
}

/// What is known at initialisation.
#[derive(Clone)]
struct Known {
    scene: Scene,
    inputs: Inputs,
}

impl Known {
    fn set(&mut self, variable: &Variable, value: f64) -> Result<(), SceneError> {
        match variable.group {
            Group::RealInput(input) => self.inputs.set_real(input, value),
            Group::StringParameter(parameter) => {
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // whole numbers
                let file = ["", "tapered-cube.toml", "forked.toml"][value as usize];
                self.scene.set_string(parameter, file, Path::new("scenes/springs"))
            }
            _ => self.scene.set_number(variable, value),
        }
    }

    /// These values, critical ones for those set so far.
    fn with(values: &Values) -> Self {
        let (scene, inputs) = (Scene::default(), Inputs::default());
        let mut known = Self { scene, inputs };
        for &(name, value) in values {
            let variable = Variable::by_name(name).unwrap();
            let value = match name {
                "chatter.resistanceThreshold" if value.is_nan() => known.at_rest(RealOutput::ContactResistance),
                "contact.overtravel" if value.is_nan() => {
                    // The same distance further than where the contact is open.
                    known.scene.contact.overtravel = -1e-3;
                    -BARELY - 1e-3 - known.at_rest(RealOutput::ContactIndentation)
                }
                "parallel.offset" if value.is_nan() => {
                    known.scene.parallel.offset = 1e-3;
                    known.at_rest(RealOutput::ContactIndentation) - BARELY
                }
                "pusher.displacement" if value.is_nan() => {
                    // Where it touches without force.
                    known.inputs.pusher_displacement = -1e-3;
                    let simulation = Simulation::new(&known.scene, &known.inputs, 0.0).unwrap();
                    BARELY - 1e-3 - simulation.model().preload.pusher_overlap
                }
                _ => value,
            };
            known.set(variable, value).unwrap();
        }
        known
    }

    fn at_rest(&self, output: RealOutput) -> f64 {
        Simulation::new(&self.scene, &self.inputs, 0.0).unwrap().real(output)
    }

    /// Other values of a known to try; some may not fit.
    fn others(&self, variable: &Variable) -> Vec<f64> {
        let near = |value: f64| {
            let Variable { min, max, .. } = *variable;
            let step = if value == 0.0 { 1e-3 * max.min(1.0) } else { 1e-3 * value };
            // Some ends of a range do not fit.
            let inside = 1e-3 * (max - min);
            vec![value + step, value - step, min, max, min + inside, max - inside]
        };
        match variable.group {
            Group::RealInput(input) => near(self.inputs.real(input)),
            Group::RealParameter(parameter) => near(self.scene.real(parameter)),
            Group::IntegerParameter(parameter) => {
                let value = f64::from(self.scene.integer(parameter));
                vec![value + 1.0, value + 10.0]
            }
            Group::EnumerationParameter(parameter) => {
                choices(parameter).iter().map(|(_, number)| f64::from(*number)).collect()
            }
            Group::BooleanParameter(parameter) => vec![f64::from(u8::from(!self.scene.boolean(parameter)))],
            Group::StringParameter(_) => vec![1.0],
            Group::RealOutput(_) | Group::IntegerOutput(_) | Group::BooleanOutput(_) => vec![],
        }
    }

    /// The bits of the initial unknowns by name, if these values fit.
    fn unknowns(&self) -> Option<BTreeMap<&'static str, u64>> {
        let simulation = Simulation::new(&self.scene, &self.inputs, 0.0).ok()?;
        let unknown = |variable: &'static Variable| Some((variable.name, simulation.output(variable)?.to_bits()));
        Some(VARIABLES.iter().filter_map(unknown).collect())
    }
}

/// Unknowns with a known each.
type Pairs = BTreeSet<(&'static str, &'static str)>;

fn declared() -> Pairs {
    let document = Document::parse(MODEL_DESCRIPTION).unwrap();
    let unknowns = document.descendants().find(|node| node.has_tag_name("InitialUnknowns")).unwrap();
    let name = |index: &str| VARIABLES[index.parse::<usize>().unwrap() - 1].name;
    let pairs = unknowns.children().filter(roxmltree::Node::is_element).flat_map(|unknown| {
        let knowns = unknown.attribute("dependencies").unwrap().split_whitespace();
        knowns.map(move |known| (name(unknown.attribute("index").unwrap()), name(known)))
    });
    pairs.collect()
}

/// Unknowns that change with a known, in these scenes.
fn moved_in(scenes: impl Iterator<Item = Values>) -> Pairs {
    let mut found = Pairs::new();
    for values in scenes {
        let base = Known::with(&values);
        let before = base.unknowns().unwrap_or_else(|| panic!("{values:?} do not fit"));
        for known in &VARIABLES {
            for other in base.others(known) {
                let mut changed = base.clone();
                let Some(after) = changed.set(known, other).ok().and_then(|()| changed.unknowns()) else { continue };
                let moved = before.iter().filter(|(name, bits)| after[*name] != **bits);
                found.extend(moved.map(|(unknown, _)| (*unknown, known.name)));
            }
        }
    }
    found
}

#[test]
fn initial_unknowns_depend_on_what_the_description_says() {
    // As long as there is one, what springs of segments take their time for is made once.
    let _kept = Simulation::new(&Scene::default(), &Inputs::default(), 0.0);
    let found: Pairs = thread::scope(|scope| {
        let threads = [0, 1].map(|first| scope.spawn(move || moved_in(scenes().into_iter().skip(first).step_by(2))));
        threads.into_iter().flat_map(|thread| thread.join().unwrap()).collect()
    });
    let declared = declared();
    let undeclared: Vec<_> = found.difference(&declared).collect();
    assert!(undeclared.is_empty(), "not declared: {undeclared:#?}");
    let idle: Vec<_> = declared.difference(&found).collect();
    assert!(idle.is_empty(), "declared, but nothing changes: {idle:#?}");
}
