//! Independent runs, side by side.

use std::num::NonZero;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::{available_parallelism, scope};

use anyhow::{Result, anyhow};

/// What `work` makes of each item, in the order of the items, on as many threads as there are cores; each takes the next
/// item that is left. The first error, if there is one.
pub fn map<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> Result<R> + Sync) -> Result<Vec<R>> {
    let next = AtomicUsize::new(0);
    let take = || {
        let mut done = Vec::new();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(index) else {
                return done;
            };
            done.push((index, work(item)));
        }
    };
    let threads = available_parallelism().map_or(1, NonZero::get);
    let mut results = scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(take)).collect();
        let mut results = Vec::new();
        for worker in workers {
            results.extend(worker.join().map_err(|_| anyhow!("a run panicked"))?);
        }
        Ok::<_, anyhow::Error>(results)
    })?;
    results.sort_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_stand_in_the_order_of_the_items() -> Result<()> {
        let items: Vec<u32> = (0..100).collect();
        let squares = map(&items, |item| Ok(item * item))?;
        assert!(
            squares
                .iter()
                .zip(0..)
                .all(|(square, item): (&u32, u32)| *square == item * item)
        );
        Ok(())
    }

    #[test]
    fn an_error_is_told() {
        let result = map(&[1, 2, 3], |item| if *item == 2 { Err(anyhow!("two")) } else { Ok(()) });
        assert_eq!(result.err().map(|error| error.to_string()), Some("two".to_owned()));
    }
}
