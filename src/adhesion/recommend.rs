//! Which kind suits a first layer, and why, for the panel "How shall it stick?".

use super::ground::Ground;
use super::{AdhesionKind, FirstLayer};
use crate::polygon::Contour;
use crate::polygon::simplify::simplify_ring;

/// How much a material shrinks while it cools, and so lifts corners.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Warping {
    /// Such as PLA and TPU.
    #[default]
    Little,
    /// Such as PETG.
    Some,
    /// Such as ABS, ASA, nylon and PC.
    Much,
}

impl Warping {
    /// By the material's name as profiles write it, such as "PETG" or "ABS+"; unknown ones warp little.
    pub fn of_material(name: &str) -> Warping {
        let letters: String = name.trim().chars().take_while(char::is_ascii_alphabetic).collect();
        match letters.to_ascii_uppercase().as_str() {
            "ABS" | "ASA" | "PA" | "NYLON" | "PC" | "PP" | "HIPS" | "POM" => Warping::Much,
            "PET" | "PETG" | "CPE" | "PCTG" => Warping::Some,
            _ => Warping::Little,
        }
    }
}

/// Something about a first layer that makes it lift.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// Corners of less than 100 degrees on a part longer than 30 mm.
    SharpCorners,
    /// Longer than 80 mm: shrinkage adds up.
    Long,
    /// On average thinner than 6 mm: little to hold on to.
    Thin,
    /// Less than 1 cm2 on the bed.
    Small,
    /// The material shrinks.
    Material,
}

/// A kind with the reasons for it; none when a skirt is enough.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Recommendation {
    /// What to lay.
    pub kind: AdhesionKind,
    /// What speaks for more hold than a skirt's.
    pub reasons: Vec<Reason>,
}

/// Corners are looked for on an outline simplified to this, mm.
const CORNER_TOLERANCE_MM: f64 = 0.2;

/// Cosine of 100 degrees: sharper corners lift.
const SHARP_COS: f64 = -0.174;

/// A rule of thumb: one reason asks for teeth, three (a material that warps much counts twice) for a brim,
/// and a raft is for a small or thin foot of such a material.
pub fn recommend(first: &FirstLayer, warping: Warping) -> Recommendation {
    let ground = Ground::of(first);
    let reasons = reasons(&ground, warping);
    let weight = reasons.len() + usize::from(warping == Warping::Much);
    let weak_foot = reasons.contains(&Reason::Thin) || reasons.contains(&Reason::Small);
    let kind = match weight {
        0 => AdhesionKind::Skirt,
        1 | 2 => AdhesionKind::Teeth,
        _ if weak_foot && warping == Warping::Much => AdhesionKind::Raft,
        _ => AdhesionKind::Brim,
    };
    Recommendation { kind, reasons }
}

fn reasons(ground: &Ground, warping: Warping) -> Vec<Reason> {
    let area = ground.area.area();
    let length: f64 = ground.area.length();
    let longest = ground.area.contours().iter().filter_map(Contour::bounds).map(|b| b.size().length());
    let longest = longest.fold(0.0, f64::max);
    let sharp = ground.area.contours().iter().any(has_sharp_corner);
    let found = [
        (Reason::SharpCorners, sharp && longest > 30.0),
        (Reason::Long, longest > 80.0),
        // A strip of width w has the area of w times half its outline.
        (Reason::Thin, 2.0 * area < 6.0 * length),
        (Reason::Small, area < 100.0),
        (Reason::Material, warping != Warping::Little),
    ];
    found.into_iter().filter_map(|(reason, holds)| (holds && area > 0.0).then_some(reason)).collect()
}

fn has_sharp_corner(contour: &Contour) -> bool {
    let points = simplify_ring(contour, CORNER_TOLERANCE_MM).points;
    let n = points.len();
    (0..n).any(|i| {
        let u = (points[(i + n - 1) % n] - points[i]).normalize_or_zero();
        let v = (points[(i + 1) % n] - points[i]).normalize_or_zero();
        v.perp_dot(u) > 0.0 && u.dot(v) > SHARP_COS
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::measure::Bounds;
    use crate::polygon::trig::sin_cos;
    use crate::polygon::{DVec2, PolygonSet, dvec2};

    fn of(outline: &PolygonSet, warping: Warping) -> Recommendation {
        let supports = PolygonSet::default();
        let bed = Bounds { min: DVec2::ZERO, max: dvec2(220.0, 220.0) };
        let first = FirstLayer {
            outline,
            supports: &supports,
            bed,
            closed: &supports,
            line_width: 0.5,
            height: 0.2,
            next_height: 0.2,
        };
        recommend(&first, warping)
    }

    fn disc(radius: f64) -> PolygonSet {
        let at = |i: u32| {
            let (sin, cos) = sin_cos(f64::from(i) * std::f64::consts::TAU / 90.0);
            dvec2(100.0, 100.0) + dvec2(cos, sin) * radius
        };
        PolygonSet::from_contours(vec![Contour::new((0..90).map(at).collect())])
    }

    #[test]
    fn materials_are_known_by_their_first_word() {
        let of = |names: &[&str]| names.iter().map(|n| Warping::of_material(n)).collect::<Vec<_>>();
        assert_eq!(of(&["ABS", "asa", "PA12-CF", "PC blend", "ABS+"]), [Warping::Much; 5]);
        assert_eq!(of(&["PETG", "PET-CF"]), [Warping::Some; 2]);
        assert_eq!(of(&["PLA", "PLA+", "TPU 95A", "", "PACF?"]), [Warping::Little; 5]);
    }

    #[test]
    fn a_broad_round_foot_needs_a_skirt_and_a_long_sharp_one_more() {
        let round = of(&disc(20.0), Warping::Little);
        assert_eq!((round.kind, round.reasons.len()), (AdhesionKind::Skirt, 0));
        let plate = PolygonSet::rectangle(dvec2(10.0, 10.0), dvec2(60.0, 50.0));
        assert_eq!(of(&plate, Warping::Little).kind, AdhesionKind::Teeth);
        assert_eq!(of(&plate, Warping::Little).reasons, [Reason::SharpCorners]);
        let ruler = PolygonSet::rectangle(dvec2(10.0, 10.0), dvec2(160.0, 14.0));
        assert_eq!(of(&ruler, Warping::Little).reasons, [Reason::SharpCorners, Reason::Long, Reason::Thin]);
        assert_eq!(of(&ruler, Warping::Little).kind, AdhesionKind::Brim);
        assert_eq!(of(&ruler, Warping::Much).kind, AdhesionKind::Raft);
        let pin = of(&disc(2.0), Warping::Little);
        assert_eq!((pin.kind, pin.reasons), (AdhesionKind::Teeth, vec![Reason::Thin, Reason::Small]));
    }
}
