//! Light among fibres: of the rays to lamps only those are sent that bring much, and no light is lost by it.

mod common;

use common::{World, assert_agree, measure};
use tyndall::{
    integrator::{Analog, VolPath},
    material::{HairColour, HairTextures, Material},
    math::{Transform, Vec3},
    scene::Scene,
    shape::{Basis, Curves, Knot, Style},
};

/// How many strands stand in a row, and how many rows there are.
const ROW: usize = 6;

/// A tuft of strands of this roughness before a sky, below a lamp. The camera looks at one of them.
fn tuft(roughness: f32) -> Scene {
    let mut world = World::seen(Vec3::new(0.02, 0.1, 4.0), Vec3::new(0.02, 0.1, 0.0));
    let mut strands = Curves::new(Style::Round);
    for (row, column) in (0..ROW).flat_map(|row| (0..ROW).map(move |column| (row, column))) {
        let turn = (row * ROW + column) as f32;
        let foot = Vec3::new(0.2 * (column as f32 - 2.0), 0.0, -0.2 * row as f32);
        let knot = |k: u16| Knot {
            p: foot + Vec3::new(0.03 * (turn + f32::from(k)).sin(), 0.5 * f32::from(k) - 1.5, 0.03 * turn.cos()),
            radius: 0.06,
        };
        strands.push(Basis::CatmullRom, &(0..7).map(knot).collect::<Vec<_>>());
    }
    world.builder.add_curves(strands, &Transform::IDENTITY).unwrap();
    let hair = HairTextures {
        colour: HairColour::SigmaA(0.1.into()),
        eta: 1.55.into(),
        beta_m: roughness.into(),
        beta_n: roughness.into(),
        alpha: 2.0.into(),
    };
    world.object(Material::Hair(Box::new(hair)), None);
    world.shining_disk(3.0, 2.0, common::diffuse(0.0), 5.0);
    world.sky(0.2);
    world.scene()
}

/// Paths that run into lamps by chance find as much.
#[test]
fn light_samples_among_fibres_find_what_paths_find() {
    for roughness in [0.3, 0.7] {
        let scene = tuft(roughness);
        let sampled = measure(&scene, &VolPath::default(), 200_000);
        let naive = measure(&scene, &Analog, 600_000);
        assert_agree(&format!("roughness {roughness}"), [sampled, naive], 0.01);
    }
}
