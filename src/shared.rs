//! What simulations of a process share: made by the first that needs it, freed with the last, as hosts load and unload the
//! library thousands of times in a process. It never affects results, only the time they take.

use std::collections::VecDeque;
use std::ops::Deref;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Where something is found that somebody uses, with the number of shares.
pub type Home<T> = Mutex<Option<(Arc<T>, usize)>>;

/// A share in it: it stays as long as there is one.
#[derive(Debug)]
pub struct Shared<T: 'static> {
    value: Arc<T>,
    home: &'static Home<T>,
}

impl<T: Default> Shared<T> {
    /// A share in what others use, or in a new one.
    pub fn of(home: &'static Home<T>) -> Self {
        let mut there = open(home);
        let (value, shares) = there.get_or_insert_default();
        *shares += 1;
        Self { value: value.clone(), home }
    }
}

impl<T: Default> Clone for Shared<T> {
    fn clone(&self) -> Self {
        Self::of(self.home)
    }
}

impl<T> Deref for Shared<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.value
    }
}

impl<T> Drop for Shared<T> {
    fn drop(&mut self) {
        let mut home = open(self.home);
        match &mut *home {
            Some((_, shares)) if *shares > 1 => *shares -= 1,
            _ => *home = None,
        }
    }
}

/// Things that simulations leave for others.
#[derive(Debug, Default)]
pub struct Shelf<T>(Mutex<Vec<T>>);

impl<T> Shelf<T> {
    /// Takes the last one that is such.
    pub fn take(&self, is_such: impl FnMut(&T) -> bool) -> Option<T> {
        let mut things = open(&self.0);
        let found = things.iter().rposition(is_such)?;
        Some(things.remove(found))
    }

    /// Leaves one, in the place of the oldest where there are as many as there are shares in `common`, to which the shelf belongs.
    pub fn leave<C>(&self, thing: T, common: &Shared<C>) {
        let mut things = open(&self.0);
        let shares = open(common.home).as_ref().map_or(0, |(_, shares)| *shares);
        let oldest = (things.len() >= shares).then(|| things.remove(0));
        things.push(thing);
        drop(things);
        drop(oldest);
    }
}

/// Values found so far, each with what it was found for.
#[derive(Debug)]
pub struct Found<K, V>(Mutex<VecDeque<(K, V)>>);

/// How many are kept. Cost.
const KEPT: usize = 32;

impl<K, V> Default for Found<K, V> {
    fn default() -> Self {
        Self(Mutex::new(VecDeque::new()))
    }
}

impl<K: PartialEq, V: Clone> Found<K, V> {
    /// The value for a key, if need be found now: by a function that knows nothing but the key, so that no other value can be kept.
    pub fn of(&self, key: K, find: fn(&K) -> V) -> V {
        let known = |(of, value): &(K, V)| (*of == key).then(|| value.clone());
        let known = open(&self.0).iter().find_map(known);
        known.unwrap_or_else(|| {
            // Others may go on meanwhile.
            let value = find(&key);
            let mut all = open(&self.0);
            all.truncate(KEPT - 1);
            all.push_front((key, value.clone()));
            value
        })
    }
}

/// What a lock holds is whole whenever it is free.
pub(crate) fn open<T>(lock: &Mutex<T>) -> MutexGuard<'_, T> {
    lock.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    #[test]
    fn a_shelf_has_no_more_than_there_are_shares() {
        static HOME: Home<Shelf<u32>> = Home::new(None);
        let shares = [Shared::of(&HOME), Shared::of(&HOME)];
        for number in 1..=5 {
            shares[0].leave(number, &shares[0]);
        }
        assert_eq!([(); 3].map(|()| shares[1].take(|_| true)), [Some(5), Some(4), None]);
    }

    #[test]
    fn what_is_found_is_found_once() {
        static CALLS: AtomicUsize = AtomicUsize::new(0);
        let twice = |key: &usize| {
            CALLS.fetch_add(1, Ordering::Relaxed);
            2 * key
        };
        let found = Found::default();
        for key in (0..KEPT).chain(0..KEPT) {
            assert_eq!(found.of(key, twice), 2 * key);
        }
        assert_eq!(CALLS.load(Ordering::Relaxed), KEPT);
        // The oldest makes room.
        found.of(KEPT, |key| 2 * key);
        found.of(0, twice);
        assert_eq!(CALLS.load(Ordering::Relaxed), KEPT + 1);
    }
}
