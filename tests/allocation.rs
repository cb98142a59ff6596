//! A time step, and setting and reading around it, allocates nothing.

use relay_contact::fmi2::fmi2OK;
use relay_contact::variables::ExcitationKind;
use testing::allocator::Counting;
use testing::instance::Instance;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// With every choice of `effects.excitation`.
#[test]
fn a_communication_step_allocates_nothing() {
    for &(_, excitation) in ExcitationKind::CHOICES {
        check(excitation);
    }
}

fn check(excitation: i32) {
    let contact = Instance::new();
    assert_eq!(contact.set_integer("effects.excitation", excitation), fmi2OK);
    assert_eq!(contact.set_boolean("effects.energy", true), fmi2OK);
    contact.initialize();
    let before = Counting::calls();
    assert!(before > 0, "nothing is counted");
    for n in 0..1000 {
        let time = f64::from(n) * 1e-5;
        // A square wave of 204 g: the contact opens and bounces.
        let acceleration = if n % 100 < 50 { 2000.0 } else { -2000.0 };
        let inputs = ["base.acceleration", "contact.current"];
        assert_eq!(contact.set_reals(inputs, [acceleration, 0.1]), fmi2OK);
        assert_eq!(contact.step(time, 1e-5), fmi2OK);
        assert!(contact.real("contact.force").is_finite() && contact.real("contact.resistance").is_finite());
    }
    assert_eq!(Counting::calls(), before, "allocated in a step");
    let opening = contact.real("contact.lastOpening");
    assert!(opening > 0.0, "the contact never opened: events are not covered");
}

/// Exact steps ahead, at communication points, and back to one where the input changes.
#[test]
fn an_exact_step_allocates_nothing() {
    let contact = Instance::new();
    assert_eq!(contact.set_integer("effects.excitation", 2), fmi2OK);
    assert_eq!(contact.set_integer("effects.contactLaw", 3), fmi2OK);
    for watched in ["effects.extremes", "effects.chatter"] {
        assert_eq!(contact.set_boolean(watched, false), fmi2OK);
    }
    contact.initialize();
    let before = Counting::calls();
    for n in 0..1000 {
        let acceleration = if n % 100 < 50 { 20.0 } else { -20.0 };
        assert_eq!(contact.set_real("base.acceleration", acceleration), fmi2OK);
        assert_eq!(contact.step(f64::from(n) * 1e-6, 1e-6), fmi2OK);
        assert!(contact.real("contact.force").is_finite());
    }
    assert_eq!(Counting::calls(), before, "allocated in a step");
    assert!(contact.integer("solver.steps") < 500, "no step went ahead");
}
