//! Stretches of a line: sorted, disjoint intervals.

use crate::sort::StableSort;

/// From and to, mm; from < to.
pub(super) type Span = [f64; 2];

/// Ends that are this near to each other, mm, are one: what rounding leaves between neighbours.
const SAME_MM: f64 = 1e-9;

/// Sorts and joins what overlaps or touches.
pub(super) fn tidy(spans: &mut Vec<Span>) {
    if spans.windows(2).all(|pair| pair[0][1] < pair[1][0] - SAME_MM) {
        return;
    }
    spans.stable_sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut kept = 0;
    for i in 1..spans.len() {
        if spans[i][0] <= spans[kept][1] + SAME_MM {
            spans[kept][1] = spans[kept][1].max(spans[i][1]);
        } else {
            kept += 1;
            spans[kept] = spans[i];
        }
    }
    spans.truncate(kept + 1);
}

/// What lies in both.
pub(super) fn intersect(a: &[Span], b: &[Span]) -> Vec<Span> {
    let (mut i, mut j) = (0, 0);
    let mut both = Vec::new();
    while i < a.len() && j < b.len() {
        let (from, to) = (a[i][0].max(b[j][0]), a[i][1].min(b[j][1]));
        if from < to {
            both.push([from, to]);
        }
        if a[i][1] < b[j][1] { i += 1 } else { j += 1 }
    }
    both
}

/// What lies in `a` and not in `b`.
pub(super) fn subtract(a: &[Span], b: &[Span]) -> Vec<Span> {
    let mut left = Vec::with_capacity(a.len());
    let mut first = 0;
    for &[mut from, to] in a {
        while first < b.len() && b[first][1] <= from {
            first += 1;
        }
        for cut in b[first..].iter().take_while(|cut| cut[0] < to) {
            if from < cut[0] {
                left.push([from, cut[0]]);
            }
            from = from.max(cut[1]);
        }
        if from < to {
            left.push([from, to]);
        }
    }
    left
}

/// What lies in either.
pub(super) fn unite(a: &[Span], b: &[Span]) -> Vec<Span> {
    let mut all = [a, b].concat();
    tidy(&mut all);
    all
}

/// Each interval shortened by `by` at both ends.
pub(super) fn shrink(spans: &[Span], by: f64) -> Vec<Span> {
    spans.iter().map(|s| [s[0] + by, s[1] - by]).filter(|s| s[0] < s[1]).collect()
}

/// Sum of the lengths, mm.
pub(super) fn length(spans: &[Span]) -> f64 {
    spans.iter().map(|s| s[1] - s[0]).sum()
}

/// Whether two intervals overlap when each is longer by `slack` at both ends.
pub(super) fn meet(a: Span, b: Span, slack: f64) -> bool {
    a[0] < b[1] + slack && b[0] < a[1] + slack
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_joined_cut_and_taken_away() {
        let mut spans = vec![[5.0, 6.0], [0.0, 1.0], [1.0, 2.0], [5.5, 7.0]];
        tidy(&mut spans);
        assert_eq!(spans, [[0.0, 2.0], [5.0, 7.0]]);
        assert_eq!(intersect(&spans, &[[1.0, 5.5], [6.0, 9.0]]), [[1.0, 2.0], [5.0, 5.5], [6.0, 7.0]]);
        assert_eq!(subtract(&spans, &[[0.5, 1.0], [1.5, 5.5]]), [[0.0, 0.5], [1.0, 1.5], [5.5, 7.0]]);
        assert_eq!(unite(&spans, &[[2.0, 3.0]]), [[0.0, 3.0], [5.0, 7.0]]);
        assert_eq!(shrink(&spans, 0.9), [[0.9, 1.1], [5.9, 6.1]]);
        assert_eq!(length(&spans), 4.0);
    }
}
