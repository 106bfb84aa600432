//! Support regions from the top down, their volume and the structures they form.
//!
//! Source: [Karim] equations (9) to (12). A_k is the part's section in layer k, S_k the support
//! region, both seen from above; layers are counted from the bed.

use super::tile::{Part, Tile};
use crate::polygon::tiles::{Piece, Tiles};
use crate::polygon::{DVec2, Polygon, PolygonSet};
use crate::region::overhang;
use crate::sets::Sets;

/// What the descent needs to know about the print.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VolumeRules {
    /// Height t of every layer, mm.
    pub layer_height: f64,
    /// Self-support angle alpha, degrees from the vertical.
    pub self_support_angle_deg: f64,
    /// Layers m of the base below part and supports.
    pub base_layers: u32,
    /// By how much the sections were simplified, mm: two of them may seem farther apart by twice
    /// this, and a wall at the very angle must not need support for it.
    pub section_tolerance: f64,
    /// Structures whose largest layer is under the square of this (a line's width, mm) are specks.
    pub speck_width: f64,
}

/// What supports cost.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SupportVolumes {
    /// Sum of area(S_k) t, mm3.
    pub support_mm3: f64,
    /// m t area(S_1 u A_1), mm3.
    pub base_mm3: f64,
    /// Connected supports larger than a speck, plus one for the base.
    pub structures: u32,
    /// Connected supports of which no layer is as large as a line is wide.
    pub specks: u32,
    /// area(A_1), mm2: what of the part itself stands on the bed.
    pub bed_contact_mm2: f64,
}

/// A walk over the layers from the top down.
///
/// Equal neighbouring layers come as one step and cost next to nothing, however many there are.
#[derive(Debug)]
pub struct Descent {
    rules: VolumeRules,
    step: f64,
    /// A_k of the layer entered last.
    area: PolygonSet,
    grid: Tiles,
    /// S_k of the layer entered last.
    tiles: Vec<Tile>,
    structures: Structures,
    support_mm3: f64,
}

impl Descent {
    /// Above the topmost layer.
    pub fn new(rules: VolumeRules) -> Self {
        Descent::in_tiles(rules, Tiles::whole())
    }

    /// Above the topmost layer, support regions kept in tiles. Only those that the part's border crosses are
    /// computed anew from layer to layer, which makes regions of many vertices many times faster.
    pub fn in_tiles(rules: VolumeRules, grid: Tiles) -> Self {
        let step = overhang::permissible_step(rules.layer_height, rules.self_support_angle_deg);
        Descent {
            rules,
            step: step + 2.0 * rules.section_tolerance,
            area: PolygonSet::EMPTY,
            tiles: (0..grid.count()).map(|tile| Tile::new(grid.bounds(tile))).collect(),
            grid,
            structures: Structures::default(),
            support_mm3: 0.0,
        }
    }

    /// Goes down by `layers` layers of one section and finds their support region,
    /// S_k = (S_(k+1) u ESF_k) - A_k.
    ///
    /// *Erratum*: [Karim] eq. (9) writes RA for ESF and looks one layer up only; this is what its
    /// figures do.
    pub fn enter(&mut self, area: PolygonSet, layers: u32) {
        if area != self.area {
            let esf = overhang::externally_supported(&self.area, &area, self.step);
            if !esf.is_empty() || self.tiles.iter().any(|tile| !tile.parts().is_empty()) {
                self.replace_region(&area, &esf);
            }
            self.area = area;
        }
        self.support_mm3 += self.region_mm2() * self.rules.layer_height * f64::from(layers);
    }

    /// area(S_k) of the layer entered last.
    fn region_mm2(&self) -> f64 {
        self.tiles.iter().map(Tile::area_mm2).sum()
    }

    fn replace_region(&mut self, area: &PolygonSet, esf: &PolygonSet) {
        let pieces = self.grid.cut(area).into_iter().zip(self.grid.cut(esf));
        let mut changed = false;
        for (tile, (area, esf)) in self.tiles.iter_mut().zip(pieces) {
            changed |= tile.descend(area, &esf, self.rules.layer_height, &mut self.structures.sets);
        }
        if changed {
            self.join_neighbours();
        }
    }

    /// Parts that go on across tiles' borders are one component: they belong to one structure, and count as
    /// large as all of them together.
    fn join_neighbours(&mut self) {
        let pieces: Vec<Vec<&Piece>> =
            self.tiles.iter().map(|tile| tile.parts().iter().map(|part| &part.piece).collect()).collect();
        let first = self.grid.components(&pieces);
        let parts: Vec<&Part> = self.tiles.iter().flat_map(Tile::parts).collect();
        let mut areas = vec![0.0; parts.len()];
        for (part, &first) in parts.iter().zip(&first) {
            areas[first] += part.area_mm2;
        }
        for (part, &first) in parts.iter().zip(&first) {
            self.structures.sets.join(parts[first].node, part.node);
            self.structures.reach(part.node, areas[first]);
        }
    }

    /// Whether `p` lies in S_k of the layer entered last.
    pub fn supports(&self, p: DVec2) -> bool {
        self.tiles[self.grid.of(p)].contains(p)
    }

    /// The components of S_k of the layer entered last, cut by tiles' borders, each with a mark; marks of one
    /// structure come to the same number in [`Descent::structure_of`] once all layers were entered.
    pub fn components(&self) -> impl Iterator<Item = (Polygon, usize)> {
        let parts = self.tiles.iter().flat_map(Tile::parts);
        parts.flat_map(|part| part.polygons().into_iter().map(|polygon| (polygon, part.node)))
    }

    /// A number for the structure that a component belongs to.
    pub fn structure_of(&mut self, mark: usize) -> usize {
        self.structures.sets.root(mark)
    }

    /// The figures, once the layer on the bed has been entered.
    pub fn finish(self) -> SupportVolumes {
        let rules = self.rules;
        // Nothing of S_1 lies in A_1.
        let base_mm2 = self.region_mm2() + self.area.area();
        let (large, specks) = self.structures.count(rules.speck_width * rules.speck_width);
        SupportVolumes {
            support_mm3: self.support_mm3,
            base_mm3: f64::from(rules.base_layers) * rules.layer_height * base_mm2,
            structures: large + 1,
            specks,
            // An empty area sums to -0.0.
            bed_contact_mm2: self.area.area() + 0.0,
        }
    }
}

/// The components of all layers; a set is one support structure.
#[derive(Debug, Default)]
struct Structures {
    sets: Sets,
    /// The largest component that each node was part of, mm2.
    largest_mm2: Vec<f64>,
}

impl Structures {
    /// `node` is part of a component of `area_mm2`.
    fn reach(&mut self, node: usize, area_mm2: f64) {
        if self.largest_mm2.len() <= node {
            self.largest_mm2.resize(node + 1, 0.0);
        }
        self.largest_mm2[node] = self.largest_mm2[node].max(area_mm2);
    }

    /// How many sets reach `speck_mm2` in some layer, and how many do not.
    fn count(mut self, speck_mm2: f64) -> (u32, u32) {
        let mut largest = vec![0.0f64; self.largest_mm2.len()];
        for (node, area_mm2) in self.largest_mm2.iter().enumerate() {
            let root = self.sets.root(node);
            largest[root] = largest[root].max(*area_mm2);
        }
        let roots = (0..largest.len()).filter(|&node| self.sets.root(node) == node);
        let (specks, large): (Vec<usize>, Vec<usize>) = roots.partition(|&root| largest[root] < speck_mm2);
        (large.len() as u32, specks.len() as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::dvec2;
    use crate::polygon::measure::Bounds;
    use crate::polygon::stars::star;
    use proptest::prelude::*;

    const RULES: VolumeRules = VolumeRules {
        layer_height: 0.5,
        self_support_angle_deg: 45.0,
        base_layers: 5,
        section_tolerance: 0.0,
        speck_width: 0.45,
    };

    fn rectangle(x0: f64, y0: f64, x1: f64, y1: f64) -> PolygonSet {
        PolygonSet::rectangle(dvec2(x0, y0), dvec2(x1, y1))
    }

    fn descend_in(rules: VolumeRules, grid: Tiles, layers: &[(PolygonSet, u32)]) -> SupportVolumes {
        let mut descent = Descent::in_tiles(rules, grid);
        layers.iter().for_each(|(area, count)| descent.enter(area.clone(), *count));
        descent.finish()
    }

    /// Layers from the top down, as (section, number of layers). Tiles make no difference.
    fn descend(layers: &[(PolygonSet, u32)]) -> SupportVolumes {
        let found = descend_in(RULES, Tiles::whole(), layers);
        for count in 2..9 {
            let bounds = Bounds { min: DVec2::ZERO, max: dvec2(30.0, 10.0) };
            let cut = descend_in(RULES, Tiles::over(bounds, count), layers);
            let counts = |v: SupportVolumes| (v.structures, v.specks, v.bed_contact_mm2);
            assert_eq!(counts(cut), counts(found), "{count} tiles");
            assert!((cut.support_mm3 - found.support_mm3).abs() < 1e-9, "{count} tiles");
            assert!((cut.base_mm3 - found.base_mm3).abs() < 1e-9, "{count} tiles");
        }
        found
    }

    /// Four sections from the top down.
    fn stars() -> impl Strategy<Value = Vec<(PolygonSet, u32)>> {
        prop::collection::vec(star(dvec2(15.0, 5.0), 3.0).prop_map(|area| (area, 3)), 4)
    }

    proptest! {
        #[test]
        fn any_shapes_cost_the_same_in_tiles(layers in stars(), count in 2usize..9) {
            // Jags end at the tiles' borders; layers this thin have none to speak of.
            let rules = VolumeRules { layer_height: 0.02, ..RULES };
            let found = descend_in(rules, Tiles::whole(), &layers);
            let bounds = Bounds { min: DVec2::ZERO, max: dvec2(30.0, 10.0) };
            let cut = descend_in(rules, Tiles::over(bounds, count), &layers);
            let wrong = (cut.support_mm3 - found.support_mm3).abs();
            prop_assert!(wrong <= 0.001 * found.support_mm3 + 1e-4, "{cut:?} {found:?}");
            prop_assert!((cut.base_mm3 - found.base_mm3).abs() <= 0.001 * found.base_mm3);
        }
    }

    #[test]
    fn a_t_is_held_down_to_the_bed() {
        // Erratum of eq. (9): looking one layer up only, support would end one layer below the top.
        let found = descend(&[(rectangle(0.0, 0.0, 30.0, 10.0), 4), (rectangle(10.0, 0.0, 20.0, 10.0), 60)]);
        assert!((found.support_mm3 - 20.0 * 10.0 * 30.0).abs() < 1e-9);
        assert!((found.base_mm3 - 5.0 * 0.5 * 300.0).abs() < 1e-9);
        assert_eq!((found.structures, found.specks), (3, 0));
        assert_eq!(found.bed_contact_mm2, 100.0);
    }

    #[test]
    fn support_stands_on_the_part_below_it() {
        let foot = rectangle(0.0, 0.0, 30.0, 10.0);
        let found = descend(&[
            (rectangle(0.0, 0.0, 30.0, 10.0), 4),
            (rectangle(10.0, 0.0, 20.0, 10.0), 8),
            (foot, 2),
        ]);
        assert!((found.support_mm3 - 20.0 * 10.0 * 4.0).abs() < 1e-9);
        assert_eq!(found.structures, 3);
    }

    #[test]
    fn two_supports_that_meet_further_down_are_one_structure() {
        let wall = rectangle(14.0, 0.0, 16.0, 10.0);
        let top = rectangle(0.0, 0.0, 30.0, 10.0);
        // The wall hangs in the air, so that the supports beside it and under it are one.
        let foot = rectangle(0.0, 0.0, 1.0, 10.0);
        let found = descend(&[(top, 4), (wall.union(&foot), 8), (foot, 8)]);
        assert_eq!(found.structures, 2);
    }

    #[test]
    fn one_support_split_by_the_part_stays_one() {
        let top = rectangle(0.0, 0.0, 30.0, 10.0);
        let foot = rectangle(0.0, 0.0, 1.0, 10.0);
        let ridge = foot.union(&rectangle(14.0, 0.0, 16.0, 10.0));
        let found = descend(&[(top, 4), (foot, 8), (ridge, 8)]);
        assert_eq!(found.structures, 2);
    }

    #[test]
    fn tiny_structures_are_counted_apart() {
        let tip = rectangle(20.0, 5.0, 20.3, 5.3);
        let body = rectangle(0.0, 0.0, 10.0, 10.0);
        let found = descend(&[(body.union(&tip), 2), (body, 10)]);
        assert_eq!((found.structures, found.specks), (1, 1));
        assert!((found.support_mm3 - 0.09 * 5.0).abs() < 1e-9);
    }

    #[test]
    fn nothing_in_nothing_out() {
        let found = Descent::new(RULES).finish();
        assert_eq!((found.support_mm3, found.base_mm3, found.structures), (0.0, 0.0, 1));
    }
}
