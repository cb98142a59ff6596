//! Saved states with manipulated contents and a correct checksum.

use std::collections::BTreeMap;

use campaign::api::LIBRARY;
use campaign::choices::{Choices, bytes};
use campaign::hostile::{Outcome, SPECIMENS, changed, meet, repaired, specimen};

#[test]
fn a_repaired_specimen_is_the_specimen() {
    let specimen = specimen(&LIBRARY, &[]);
    assert_eq!(repaired(specimen.clone()), specimen, "the format of saved states has changed");
    assert_eq!(meet(&LIBRARY, &specimen, 10), Ok(Outcome::WentOn));
}

#[test]
fn hostile_contents_are_refused_or_gone_on_from() {
    let specimens = SPECIMENS.map(|parameters| specimen(&LIBRARY, parameters));
    // Fewer and shorter under valgrind, which is thirty times slower.
    let short = std::env::var_os("CAMPAIGN_CALLS").is_some();
    let mut outcomes = BTreeMap::new();
    for (seed, specimen) in (0..if short { 100 } else { 400 }).zip(specimens.iter().cycle()) {
        let drawn = bytes(seed, 32);
        let hostile = changed(specimen, &mut Choices::new(&drawn));
        let steps = if short { 0 } else { 2 };
        let outcome = meet(&LIBRARY, &hostile, steps).unwrap_or_else(|reason| panic!("seed {seed}: {reason}"));
        *outcomes.entry(outcome).or_insert(0) += 1;
    }
    println!("{outcomes:?}");
    for outcome in [Outcome::NotRead, Outcome::NotSet, Outcome::WentOn] {
        assert!(outcomes.contains_key(&outcome), "no {outcome:?} among {outcomes:?}");
    }
}
