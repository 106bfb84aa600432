//! The points that [Zhao] names: where supports begin and where they come to rest.

use crate::polygon::{Contour, DVec2, PolygonSet, dvec2};

/// Whether another contour lies above an S-point; IO-points have the type of their S-point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PointType {
    /// No other contour lies above.
    A,
    /// Another contour lies above.
    B,
}

/// Where the vertical through an S-point comes to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Foot {
    /// IO-point: on another contour, or back on the same one.
    Io(DVec2),
    /// G-point: on the bed.
    G(DVec2),
}

/// An S-point: where a contour's normal turns between downward and upward; the end of a stretch
/// that needs support. On a vertical wall it is the lower end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SPoint {
    /// Place in the plane, (u, z) in mm.
    pub at: DVec2,
    /// Type A or B.
    pub kind: PointType,
    /// Index of its contour in the section.
    pub contour: usize,
    /// Where its vertical meets the next contour below, or the bed.
    pub foot: Foot,
}

/// All S-points of a section with their feet, contour by contour. Inner corners, where the ceiling
/// of a notch meets its floor, have no air below them and are left out.
pub fn s_points(section: &PolygonSet) -> Vec<SPoint> {
    let contours = section.contours();
    let describe = |contour: usize| {
        let ends = stretch_ends(&contours[contour]).into_iter();
        ends.map(move |at| SPoint {
            at,
            kind: if is_below_another(contours, contour, at) { PointType::B } else { PointType::A },
            contour,
            foot: foot(contours, at),
        })
    };
    (0..contours.len()).flat_map(describe).collect()
}

/// Ends of the stretches whose normal points down, in the contour's order.
fn stretch_ends(contour: &Contour) -> Vec<DVec2> {
    let across: Vec<(DVec2, DVec2)> = contour.edges().filter(|(a, b)| a.x != b.x).collect();
    let n = across.len();
    let pairs = (0..n).map(|i| (across[i], across[(i + 1) % n]));
    let turn = |((a, b), (c, d)): ((DVec2, DVec2), (DVec2, DVec2))| {
        let (comes_down, goes_down) = (b.x > a.x, d.x > c.x);
        // Between the two edges lies nothing, or a vertical wall from b to c.
        let by = if b == c { (b - a).perp_dot(d - c) } else { (b - a).perp_dot(c - b) };
        (comes_down != goes_down && by > 0.0).then_some(if comes_down { b } else { c })
    };
    pairs.filter_map(turn).collect()
}

fn is_below_another(contours: &[Contour], own: usize, at: DVec2) -> bool {
    let others = contours.iter().enumerate().filter(|(i, _)| *i != own);
    others.flat_map(|(_, c)| heights_over(c, at.x)).any(|z| z > at.y)
}

fn foot(contours: &[Contour], at: DVec2) -> Foot {
    let below = contours.iter().flat_map(|c| heights_over(c, at.x)).filter(|&z| z < at.y);
    match below.max_by(f64::total_cmp) {
        Some(z) if z > 0.0 => Foot::Io(dvec2(at.x, z)),
        _ => Foot::G(dvec2(at.x, 0.0)),
    }
}

/// Where the vertical at u meets the contour's edges, their ends included.
fn heights_over(contour: &Contour, u: f64) -> impl Iterator<Item = f64> + '_ {
    let meets = move |(a, b): (DVec2, DVec2)| {
        let within = a.x != b.x && a.x.min(b.x) <= u && u <= a.x.max(b.x);
        within.then(|| if u == b.x { b.y } else { a.y + (u - a.x) * ((b.y - a.y) / (b.x - a.x)) })
    };
    contour.edges().filter_map(meets)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ledge_in_a_block_falls_back_onto_the_same_contour() {
        // A C with its opening to the right: the ceiling of the notch ends over its floor.
        let c = [(0, 0), (30, 0), (30, 10), (10, 10), (10, 20), (30, 20), (30, 30), (0, 30)];
        let contour = Contour::new(c.iter().map(|&(u, z)| dvec2(f64::from(u), f64::from(z))).collect());
        let found = s_points(&PolygonSet::from_contours(vec![contour]));
        let roof = found.iter().find(|s| s.at == dvec2(30.0, 20.0)).expect("the ceiling ends there");
        assert_eq!((roof.kind, roof.foot), (PointType::A, Foot::Io(dvec2(30.0, 10.0))));
        // Its other two ends stand on the bed; the inner corner at (10, 20) is none.
        assert_eq!(found.len(), 3);
    }
}
