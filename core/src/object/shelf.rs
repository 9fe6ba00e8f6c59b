//! What builds leave for the next: what the last one used, and for a while what it did not, so that
//! going back to how a scene was a moment ago makes nothing anew.

use std::hash::Hash;

use indexmap::IndexMap;

/// So many builds may go by without a thing before it goes too.
const PATIENCE: u32 = 2;

/// Something that is kept, by its content.
pub trait Kept: Clone {
    /// Whether both are one and the same.
    fn is(&self, other: &Self) -> bool;

    /// Bytes that are free once it goes, as far as they can be counted.
    fn bytes(&self) -> usize;
}

/// Things by content, in the order in which they were put there.
pub type ByContent<K, V> = IndexMap<K, V, foldhash::fast::RandomState>;

/// Things by content, those of the last build and of a few before it.
#[derive(Debug)]
pub struct Shelf<K, V> {
    /// What the build in hand, or the last one, has used.
    now: ByContent<K, V>,
    /// What builds before used and later ones did not, the latest first.
    past: Vec<Past<K, V>>,
}

#[derive(Clone, Debug)]
struct Past<K, V> {
    key: K,
    thing: V,
    /// Builds that have gone by without it.
    age: u32,
}

impl<K, V> Default for Shelf<K, V> {
    fn default() -> Self {
        Self { now: ByContent::default(), past: vec![] }
    }
}

impl<K: Eq + Hash + Copy, V: Kept> Shelf<K, V> {
    /// What this build has used.
    pub fn now(&self) -> &ByContent<K, V> {
        &self.now
    }

    /// This build uses it.
    pub fn put(&mut self, key: K, thing: V) {
        self.now.insert(key, thing);
    }

    /// This build uses the first `n` things that an earlier one has used.
    pub fn take(&mut self, before: &Self, n: usize) {
        let first = before.now.iter().take(n);
        self.now.extend(first.map(|(key, thing)| (*key, thing.clone())));
    }

    /// Everything there is of this key, the latest first.
    pub fn all(&self, key: K) -> impl Iterator<Item = &V> {
        let past = self.past.iter().filter(move |past| past.key == key);
        self.now.get(&key).into_iter().chain(past.map(|past| &past.thing))
    }

    /// Takes over what an earlier build left and this one has not used: no longer than two builds,
    /// and no more than so many bytes, which what is latest has first. Returns how many bytes are kept.
    pub fn inherit(&mut self, before: &Self, most: usize) -> usize {
        let last =
            before.now.iter().map(|(key, thing)| Past { key: *key, thing: thing.clone(), age: 1 });
        let older = before.past.iter().cloned().map(|past| Past { age: past.age + 1, ..past });
        let is_used =
            |past: &Past<K, V>| self.now.get(&past.key).is_some_and(|it| it.is(&past.thing));
        let mut bytes = 0usize;
        let fits = |past: &Past<K, V>| {
            let with = bytes.saturating_add(past.thing.bytes());
            bytes = if with <= most { with } else { bytes };
            with <= most
        };
        let left = last.chain(older).filter(|past| past.age <= PATIENCE && !is_used(past));
        self.past = left.filter(fits).collect();
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A name and its bytes.
    type Thing = (&'static str, usize);

    impl Kept for Thing {
        fn is(&self, other: &Self) -> bool {
            self == other
        }

        fn bytes(&self) -> usize {
            self.1
        }
    }

    /// One build after another; what each leaves of the key 0.
    fn builds(used: &[Option<Thing>], most: usize) -> Vec<Thing> {
        let mut shelf = Shelf::default();
        for thing in used {
            let mut next = Shelf::default();
            if let Some(thing) = thing {
                next.put(0, *thing);
            }
            next.inherit(&shelf, most);
            shelf = next;
        }
        shelf.all(0).copied().collect()
    }

    #[test]
    fn what_three_builds_used_is_there_once_and_the_latest_comes_first() {
        let [a, b, c, d] = ["a", "b", "c", "d"].map(|name| (name, 1));
        assert_eq!(builds(&[Some(a), Some(b), Some(c), Some(d)], 100), [d, c, b]);
        assert_eq!(builds(&[Some(a), Some(b), Some(a)], 100), [a, b]);
        assert_eq!(builds(&[Some(a), None, None], 100), [a]);
        assert_eq!(builds(&[Some(a), None, None, None], 100), []);
    }

    #[test]
    fn what_is_not_used_stays_within_its_bytes_and_the_oldest_goes_first() {
        let [a, b, c] = [("a", 40), ("b", 50), ("c", 1000)];
        assert_eq!(builds(&[Some(a), Some(b), Some(c)], 90), [c, b, a]);
        assert_eq!(builds(&[Some(a), Some(b), Some(c)], 89), [c, b]);
        assert_eq!(builds(&[Some(c), Some(a)], 999), [a]);
    }
}
