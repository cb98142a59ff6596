//! An instance and its saved states leave nothing allocated behind. Alone in its process, for an allocator that counts.

use campaign::api::Api;
use campaign::call::Call;
use campaign::judge::Judge;
use relay_contact::fmi2::fmi2OK;
use testing::allocator::Counting;
use testing::instance::Instance;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Two life cycles: with states saved, read from bytes, saved again and freed or not, an error and a reset.
fn live(api: &Api) {
    let [enter, exit] = Call::INITIALISE;
    let life = [
        enter.clone(),
        exit.clone(),
        Call::step(1e-5),
        Call::GetState(0),
        Call::GetState(1),
        Call::Serialize(0),
        Call::Deserialize(2),
        Call::GetState(2),
        Call::FreeState(1),
        Call::step(-1.0),
        Call::SetState(0),
        Call::step(1e-5),
        Call::Reset,
        Call::Renew,
        enter,
        exit,
        Call::GetState(0),
    ];
    Judge::new(api).run(&life).unwrap();
}

/// Also of what instances share.
fn the_last_instance_leaves_nothing() {
    let before = Counting::held();
    for _ in 0..3 {
        let instances = [Instance::new(), Instance::new()];
        for fmu in &instances {
            assert_eq!(fmu.set_integer("effects.excitation", 2), fmi2OK);
            fmu.initialize();
            assert_eq!(fmu.step(0.0, 1e-3), fmi2OK);
        }
        assert!(Counting::held() > before, "nothing is counted");
        drop(instances);
        assert_eq!(Counting::held(), before, "allocations, after as many before");
    }
}

#[test]
fn an_instance_leaves_nothing_behind_whether_its_saved_states_were_freed_or_not() {
    the_last_instance_leaves_nothing();
    let api = Api::linked();
    // The first time allocates what stays, such as the description.
    live(&api);
    let before = Counting::held();
    assert!(before > 0, "nothing is counted");
    for _ in 0..100 {
        live(&api);
        assert_eq!(Counting::held(), before, "allocations, after as many before");
    }
}
