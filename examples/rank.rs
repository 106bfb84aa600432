#[path = "../tests/orientation_shapes/mod.rs"]
mod shapes;
use foothold::orientation::*;
use std::time::Instant;
fn main() {
    let go = |name: &str, mesh: &foothold::mesh::Mesh, o: &OrientationOptions| {
        let t = Instant::now();
        let r = orient(mesh, o, &mut |_, _| true);
        let e = t.elapsed();
        println!("{name}: {} triangles {e:?}", mesh.triangles.len());
        match r { Ok(r) => { for d in &r.directions { println!("  {:2} sup {:10.2} base {:8.2} str {:4} specks {:4} bed {:8.2} h {:6.1} scar {:8.1} par {}", d.id, d.support_mm3, d.base_mm3, d.structures, d.specks, d.bed_contact_mm2, d.height_mm, d.scarred_mm2, d.pareto); } println!("  o1 {:?} exact {:?} chosen {}", r.o1, r.exact, r.chosen); }, Err(e) => println!("  {e}") }
    };
    let six = OrientationOptions { hull_directions: 0, ..Default::default() };
    go("part1", &shapes::part_model_1(), &OrientationOptions { layer_height: 0.01, ..six.clone() });
    go("ball smooth 100k", &shapes::bumpy_ball(25.0, 0.0, 160), &six);
    go("ball bumpy 100k", &shapes::bumpy_ball(25.0, 0.3, 160), &six);
    go("frustum44", &shapes::frustum(10.0, 10.0 + 20.0 * 0.965689, 20.0), &six);
}
