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
    }
}

/// What of a layer's area lies bare.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Exposure {
    /// Not covered by the next layer.
    pub top: PolygonSet,
    /// Not carried by the layer below.
    pub bottom: PolygonSet,
}

/// Compares a layer's area with its neighbours'; `None` is open air or the bed.
pub fn exposure(below: Option<&PolygonSet>, area: &PolygonSet, above: Option<&PolygonSet>) -> Exposure {
    let bare = |neighbour: Option<&PolygonSet>| match neighbour {
        Some(n) => area.difference(n),
        None => area.clone(),
    };
    Exposure { top: bare(above), bottom: bare(below) }
}

/// The exposures that decide about one layer's fill.
pub struct Shells<'a> {
    /// Bare tops of this layer (first) and of the `top_layers - 1` above it; empty for no top skin.
    pub tops: &'a [&'a PolygonSet],
    /// Bare bottoms of this layer (first) and of the `bottom_layers - 1` below it.
    pub bottoms: &'a [&'a PolygonSet],
}

/// Divides the area inside the walls into skins, solid infill behind them and sparse infill.
///
/// Solid places narrower than `bead_width` mm are left to the sparse infill. With `all_solid`
/// nothing is sparse.
pub fn divide(inner: &PolygonSet, shells: &Shells, bead_width: f64, all_solid: bool) -> Vec<Region> {
    let near_surface = || shells.tops.iter().chain(shells.bottoms).copied();
    let solid = match all_solid {
        true => inner.clone(),
        false => inner.intersection_with_any(near_surface()).opened(bead_width / 2.0, Join::WALL),
    };
    let bare = |exposed: Option<&&PolygonSet>, within: &PolygonSet| match exposed {
        Some(e) => within.intersection(e).opened(bead_width / 2.0, Join::WALL),
        None => PolygonSet::EMPTY,
    };
    let top_skin = bare(shells.tops.first(), &solid);
    let below_top = solid.difference(&top_skin);
    let bottom_skin = bare(shells.bottoms.first(), &below_top);
    let regions = [
        Region { role: Role::Infill, area: inner.difference(&solid) },
        Region { role: Role::SolidInfill, area: below_top.difference(&bottom_skin) },
        Region { role: Role::BottomSkin, area: bottom_skin },
        Region { role: Role::TopSkin, area: top_skin },
    ];
    regions.into_iter().filter(|r| !r.area.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;

    fn square(side: f64) -> PolygonSet {
        PolygonSet::rectangle(dvec2(0.0, 0.0), dvec2(side, side))
    }

    #[test]
    fn a_step_is_top_skin_and_the_layer_below_it_is_solid() {
        let (large, small) = (square(20.0), square(10.0));
        let step = exposure(Some(&large), &large, Some(&small));
        assert!((step.top.area() - 300.0).abs() < 1e-6);
        assert!(step.bottom.is_empty());

        let at_step = divide(&large, &Shells { tops: &[&step.top], bottoms: &[] }, 0.4, false);
        let roles: Vec<(Role, f64)> = at_step.iter().map(|r| (r.role, r.area.area().round())).collect();
        assert_eq!(roles, [(Role::Infill, 100.0), (Role::TopSkin, 300.0)]);

        let none = PolygonSet::EMPTY;
        let below = divide(&large, &Shells { tops: &[&none, &step.top], bottoms: &[] }, 0.4, false);
        let roles: Vec<(Role, f64)> = below.iter().map(|r| (r.role, r.area.area().round())).collect();
        assert_eq!(roles, [(Role::Infill, 100.0), (Role::SolidInfill, 300.0)]);
    }

    #[test]
    fn the_regions_are_the_inner_area_without_overlap() {
        let (inner, top, bottom) = (square(20.0), square(12.0), square(5.0));
        let regions = divide(&inner, &Shells { tops: &[&top], bottoms: &[&bottom] }, 0.4, true);
        let total: f64 = regions.iter().map(|r| r.area.area()).sum();
        assert!((total - 400.0).abs() < 1e-6);
        assert!((PolygonSet::union_all(regions.iter().map(|r| &r.area)).area() - 400.0).abs() < 1e-6);
    }
}
