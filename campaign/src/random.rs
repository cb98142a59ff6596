//! Sequences of random calls, and their reduction to the shortest that fails.

use std::time::{Duration, Instant};

use crate::api::Api;
use crate::call::{Call, Fault};
use crate::choices::{Choices, bytes};
use crate::draw;
use crate::judge::Judge;

/// Bytes a sequence is drawn from: some hundreds of calls.
const LENGTH: usize = 2000;

/// Makes at least `wanted` random calls, starting with the sequence of number `seed`; how many they were.
/// Panics at the first wrong answer, with the seed and the shortest sequence found that shows it.
pub fn campaign(api: &Api, mut seed: u64, wanted: u64) -> u64 {
    let mut calls = 0;
    while calls < wanted {
        calls += sequence(api, &bytes(seed, LENGTH)).unwrap_or_else(|failure| panic!("seed {seed}\n{failure}"));
        seed += 1;
    }
    calls
}

/// Makes the calls drawn from the bytes; how many they were.
/// An error is the first wrong answer, with the shortest sequence found that shows it.
pub fn sequence(api: &Api, bytes: &[u8]) -> Result<u64, String> {
    let mut judge = Judge::new(api);
    let mut choices = Choices::new(bytes);
    let mut made = Vec::new();
    while !choices.is_empty() {
        let (call, fault) = draw::call(&mut choices, &judge.life.now);
        made.push((call.clone(), fault));
        if let Err(reason) = judge.call_with(&call, fault) {
            drop(judge);
            let (calls, reason) = shortened(api, made, reason);
            let calls: Vec<_> = calls.iter().map(|(call, fault)| format!("  {call:?} ({fault:?})")).collect();
            return Err(format!("{reason}\nafter the calls\n{}", calls.join("\n")));
        }
    }
    Ok(judge.calls)
}

/// Makes the calls on a new instance.
fn run(api: &Api, calls: &[(Call, Fault)]) -> Result<(), String> {
    let mut judge = Judge::new(api);
    calls.iter().try_for_each(|(call, fault)| judge.call_with(call, *fault))
}

/// Time limit of the search for a shorter sequence.
const PATIENCE: Duration = Duration::from_secs(10);

/// Removes calls that are not needed for the failure: halves first, single calls last.
fn shortened(api: &Api, mut calls: Vec<(Call, Fault)>, mut reason: String) -> (Vec<(Call, Fault)>, String) {
    let start = Instant::now();
    let mut piece = calls.len().div_ceil(2);
    while piece > 0 && start.elapsed() < PATIENCE {
        let mut at = 0;
        while at < calls.len() && start.elapsed() < PATIENCE {
            let end = (at + piece).min(calls.len());
            let rest = [&calls[..at], &calls[end..]].concat();
            match run(api, &rest) {
                Err(other) => (calls, reason) = (rest, other),
                Ok(()) => at = end,
            }
        }
        piece /= 2;
    }
    (calls, reason)
}
