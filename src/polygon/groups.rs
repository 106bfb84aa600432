//! Boxes that hang together.

use super::measure::Bounds;
use crate::sets::Sets;
use crate::sort::StableSort;

/// Groups of boxes that hang together, two of them where they are within `margin` mm of each other. Groups are
/// ordered by their first box, and so are the boxes in them.
pub fn groups_of(boxes: &[Bounds], margin: f64) -> Vec<Vec<usize>> {
    let mut sets = Sets::new(boxes.len());
    let mut from_left: Vec<usize> = (0..boxes.len()).collect();
    from_left.stable_sort_by(|&a, &b| boxes[a].min.x.total_cmp(&boxes[b].min.x));
    for (k, &a) in from_left.iter().enumerate() {
        let end = boxes[a].max.x + margin;
        for &b in from_left[k + 1..].iter().take_while(|&&b| boxes[b].min.x <= end) {
            if boxes[a].is_near(boxes[b], margin) {
                sets.join(a, b);
            }
        }
    }
    let mut members = vec![Vec::new(); boxes.len()];
    (0..boxes.len()).for_each(|i| members[sets.root(i)].push(i));
    members.retain(|group| !group.is_empty());
    members
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    #[test]
    fn boxes_hang_together_through_others() {
        let at = |x: f64, y: f64| Bounds { min: dvec2(x, y), max: dvec2(x + 1.0, y + 1.0) };
        let boxes = [at(4.0, 0.0), at(0.0, 0.0), at(2.5, 5.0), at(1.5, 0.5), at(2.5, 1.0), at(0.0, 3.0)];
        assert_eq!(groups_of(&boxes, 0.0), [vec![0], vec![1], vec![2], vec![3, 4], vec![5]]);
        assert_eq!(groups_of(&boxes, 0.6), [vec![0, 1, 3, 4], vec![2], vec![5]]);
        assert!(groups_of(&[], 1.0).is_empty());
    }
}
