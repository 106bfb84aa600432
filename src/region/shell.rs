//! Top and bottom skin from the layers above and below.

use super::{Region, Role};
use crate::polygon::{Join, PolygonSet};

crate::options! {
    /// Solid layers that close the part at its tops and bottoms.
    pub struct SkinOptions {
        /// Solid layers under every top surface.
        top_layers: u32 = 5, "Top layers", "", 0.0..=1000.0;
        /// Solid layers over every bottom surface.
        bottom_layers: u32 = 4, "Bottom layers", "", 0.0..=1000.0;
        /// Whether the lines of skins are laid one beside the other in one direction only: the surface
        /// shines evenly, for a little more travel.
        monotonic: bool = true, "Monotonic skins";
        /// How far skins and solid infill reach into the innermost wall, as a share of the line width,
        /// so that they hold together.
        overlap: f64 = 0.2, "Skin overlap", "", 0.0..=0.5;
        /// Plastic in a bridge's lines, as a share of the usual: a little less keeps them taut.
        bridge_flow: f64 = 0.95, "Bridge flow", "", 0.1..=2.0;
    }
}

/// What of a layer's area lies bare, hair lines along its outline left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Exposure {
    /// Not covered by the next layer.
    pub top: PolygonSet,
    /// Not carried by the layer below.
    pub bottom: PolygonSet,
}

/// Compares a layer's area with its neighbours'; `None` is open air or the bed.
///
/// Strips along the outline up to `hair` mm wide are passed over, wider ones come out `hair` wider. On a steep slope every layer has such a strip
/// along its whole outline, and the walls cover it on this layer and on those below; see
/// [`hair_of_walls`].
pub fn exposure(
    below: Option<&PolygonSet>,
    area: &PolygonSet,
    above: Option<&PolygonSet>,
    hair: f64,
) -> Exposure {
    let differs = |n: Option<&PolygonSet>| n.is_some_and(|n| n != area);
    let core = match differs(below) || differs(above) {
        true => area.offset(-hair, Join::WALL),
        false => PolygonSet::EMPTY,
    };
    let bare = |neighbour: Option<&PolygonSet>| match neighbour {
        None => area.clone(),
        Some(same) if same == area => PolygonSet::EMPTY,
        Some(other) => core.difference(other).offset(hair, Join::WALL),
    };
    Exposure { top: bare(above), bottom: bare(below) }
}

/// Width of the strips that may be passed over under walls `thickness` mm thick and skins of up to
/// `layers` layers: as many strips side by side still lie within the walls.
pub fn hair_of_walls(thickness: f64, layers: u32) -> f64 {
    thickness / f64::from(layers.max(1))
}

/// The exposures that decide about one layer's fill.
pub struct Shells<'a> {
    /// Bare tops of this layer (first) and of the `top_layers - 1` above it; empty for no top skin.
    pub tops: &'a [&'a PolygonSet],
    /// Bare bottoms of this layer (first) and of the `bottom_layers - 1` below it.
    pub bottoms: &'a [&'a PolygonSet],
}

/// How the inside is divided.
#[derive(Debug, Clone, Copy)]
pub struct Division {
    /// Width of a bead, mm.
    pub bead_width: f64,
    /// Sparse islands smaller than this are made solid, mm2; infinite: nothing is sparse.
    pub solid_below: f64,
}

/// Divides the area inside the walls into skins, solid infill behind them and sparse infill.
///
/// Solid places narrower than half a bead are left to the sparse infill; all others reach one bead's
/// width into it, so that their lines have something to hold on.
pub fn divide(inner: &PolygonSet, shells: &Shells, division: Division) -> Vec<Region> {
    let Division { bead_width, solid_below } = division;
    let near_surface = || shells.tops.iter().chain(shells.bottoms).copied();
    let (solid, sparse) = match solid_below.is_infinite() {
        true => (inner.clone(), PolygonSet::EMPTY),
        false => {
            let solid = anchored(&inner.intersection_with_any(near_surface()), inner, bead_width);
            let sparse = inner.difference(&solid);
            without_small_islands(inner, solid, sparse, solid_below)
        }
    };
    let bare = |exposed: Option<&&PolygonSet>, within: &PolygonSet| match exposed {
        Some(e) => within.intersection(e).opened(bead_width / 2.0, Join::WALL),
        None => PolygonSet::EMPTY,
    };
    let top_skin = bare(shells.tops.first(), &solid);
    let below_top = solid.difference(&top_skin);
    let bottom_skin = bare(shells.bottoms.first(), &below_top);
    let regions = [
        Region { role: Role::Infill, area: sparse },
        Region { role: Role::SolidInfill, area: below_top.difference(&bottom_skin) },
        Region { role: Role::BottomSkin, area: bottom_skin },
        Region { role: Role::TopSkin, area: top_skin },
    ];
    regions.into_iter().filter(|r| !r.area.is_empty()).collect()
}

/// Solid and sparse area after sparse islands smaller than `solid_below` mm2 went to the solid one.
fn without_small_islands(
    inner: &PolygonSet,
    solid: PolygonSet,
    sparse: PolygonSet,
    solid_below: f64,
) -> (PolygonSet, PolygonSet) {
    let islands = sparse.islands();
    if islands.iter().all(|i| i.area() >= solid_below) {
        return (solid, sparse);
    }
    let large = islands.into_iter().filter(|i| i.area() >= solid_below);
    let sparse = PolygonSet::canonical(large.flat_map(|i| i.into_set().into_contours()).collect());
    (inner.difference(&sparse), sparse)
}

/// The solid area without hair lines, grown by one bead's width within `inner`.
fn anchored(solid: &PolygonSet, inner: &PolygonSet, bead_width: f64) -> PolygonSet {
    let core = solid.offset(-bead_width / 4.0, Join::WALL);
    core.offset(bead_width * 1.25, Join::WALL).intersection(inner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    const WITH_SPARSE: Division = Division { bead_width: 0.4, solid_below: 0.0 };
    const SOLID: Division = Division { bead_width: 0.4, solid_below: f64::INFINITY };

    #[test]
    fn sparse_islands_that_are_too_small_become_solid() {
        let two = square(10.0).union(&PolygonSet::rectangle(dvec2(20.0, 0.0), dvec2(23.0, 3.0)));
        let regions =
            divide(&two, &Shells { tops: &[], bottoms: &[] }, Division { solid_below: 10.0, ..WITH_SPARSE });
        let roles: Vec<(Role, f64)> = regions.iter().map(|r| (r.role, r.area.area().round())).collect();
        assert_eq!(roles, [(Role::Infill, 100.0), (Role::SolidInfill, 9.0)]);
    }

    fn square(side: f64) -> PolygonSet {
        PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(side, side))
    }

    #[test]
    fn a_step_is_top_skin_and_the_layer_below_it_is_solid() {
        let (large, small) = (square(20.0), square(10.0));
        let step = exposure(Some(&large), &large, Some(&small), 0.1);
        assert!((step.top.area() - 300.0).abs() < 3.0);
        assert!(step.bottom.is_empty());

        let at_step = divide(&large, &Shells { tops: &[&step.top], bottoms: &[] }, WITH_SPARSE);
        let roles: Vec<(Role, f64)> = at_step.iter().map(|r| (r.role, r.area.area().round())).collect();
        // The bare top comes out 0.1 mm wider, and its solid area reaches 0.4 mm farther.
        let sparse = 9.5f64 * 9.5;
        assert_eq!(roles, [(Role::Infill, 90.0), (Role::SolidInfill, 8.0), (Role::TopSkin, 302.0)]);
        assert!((at_step[0].area.area() - sparse).abs() < 0.01);

        let none = PolygonSet::EMPTY;
        let below = divide(&large, &Shells { tops: &[&none, &step.top], bottoms: &[] }, WITH_SPARSE);
        let roles: Vec<(Role, f64)> = below.iter().map(|r| (r.role, r.area.area().round())).collect();
        assert_eq!(roles, [(Role::Infill, 90.0), (Role::SolidInfill, 310.0)]);
    }

    #[test]
    fn the_strip_of_a_steep_slope_is_no_skin_and_that_of_a_flat_one_is() {
        let rim = |width: f64| exposure(None, &square(20.0), Some(&square(20.0 - width)), 0.1).top;
        assert!(rim(0.09).is_empty());
        assert!((rim(1.0).area() - (400.0 - 19.0 * 19.0)).abs() < 5.0);
    }

    #[test]
    fn the_regions_are_the_inner_area_without_overlap() {
        let (inner, top, bottom) = (square(20.0), square(12.0), square(5.0));
        let regions = divide(&inner, &Shells { tops: &[&top], bottoms: &[&bottom] }, SOLID);
        let total: f64 = regions.iter().map(|r| r.area.area()).sum();
        assert!((total - 400.0).abs() < 1e-6);
        assert!((PolygonSet::union_all(regions.iter().map(|r| &r.area)).area() - 400.0).abs() < 1e-6);
    }
}
