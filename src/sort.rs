//! Stable sorting that costs little code.
//!
//! The standard library compiles its stable sort anew for every kind of element and every
//! comparison, about 6 KiB of wasm each time; with some fifty of them that was a sixth of the
//! engine. Here one compiled sort orders indices, and only the comparison is called indirectly.
//! Plain numbers that are sorted in many places by the same function stay with the standard sort.

use std::cmp::Ordering;

/// Stable sorting of slices.
pub(crate) trait StableSort<T> {
    /// Sorts by a comparison that is a total order; equal elements keep their order.
    fn stable_sort_by(&mut self, compare: impl FnMut(&T, &T) -> Ordering);

    /// Sorts by a key; elements with equal keys keep their order.
    fn stable_sort_by_key<K: Ord>(&mut self, key: impl FnMut(&T) -> K);
}

impl<T> StableSort<T> for [T] {
    fn stable_sort_by(&mut self, mut compare: impl FnMut(&T, &T) -> Ordering) {
        if self.len() > 1 {
            let order =
                sorted_order(self.len() as u32, &mut |a, b| compare(&self[a as usize], &self[b as usize]));
            arrange(self, order);
        }
    }

    fn stable_sort_by_key<K: Ord>(&mut self, mut key: impl FnMut(&T) -> K) {
        self.stable_sort_by(|a, b| key(a).cmp(&key(b)));
    }
}

/// The indices below `len` in the order that the comparison gives them.
#[inline(never)]
fn sorted_order(len: u32, compare: &mut dyn FnMut(u32, u32) -> Ordering) -> Vec<u32> {
    let mut order: Vec<u32> = (0..len).collect();
    order.sort_by(|&a, &b| compare(a, b));
    order
}

/// Puts at each place the element that stood at `order[place]`.
fn arrange<T>(items: &mut [T], mut order: Vec<u32>) {
    for start in 0..items.len() {
        let mut place = start;
        loop {
            let source = std::mem::replace(&mut order[place], place as u32) as usize;
            if source == start || source == place {
                break;
            }
            items.swap(place, source);
            place = source;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn equal_elements_keep_their_order(keys in prop::collection::vec(0u8..9, 0..200)) {
            let mut sorted: Vec<(u8, usize)> = keys.iter().copied().zip(0..).collect();
            let mut twin = sorted.clone();
            twin.sort_by_key(|it| std::cmp::Reverse(it.0));
            sorted.stable_sort_by(|a, b| b.0.cmp(&a.0));
            prop_assert_eq!(&sorted, &twin);
            twin.sort_by_key(|it| it.0 % 4);
            sorted.stable_sort_by_key(|it| it.0 % 4);
            prop_assert_eq!(sorted, twin);
        }
    }
}
