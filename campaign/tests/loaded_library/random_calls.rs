//! Random calls.

use std::time::Instant;

use campaign::api::LIBRARY;
use campaign::random::campaign;

/// Number of calls, unless the environment variable CAMPAIGN_CALLS is set.
const CALLS: u64 = 100_000;

#[test]
fn random_calls_get_no_wrong_answer() {
    let wanted = std::env::var("CAMPAIGN_CALLS").map_or(CALLS, |calls| calls.parse().unwrap());
    let start = Instant::now();
    let calls = campaign(&LIBRARY, 0, wanted);
    let seconds = start.elapsed().as_secs_f64();
    println!("{calls} random calls without a wrong answer, in {seconds:.1} s");
}
