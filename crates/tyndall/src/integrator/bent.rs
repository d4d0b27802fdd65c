//! Light samples through a polished wall: the way from a collision in a medium to a light, bent once.
//!
//! At a collision at `x` a light and a point `y` of it are drawn as everywhere. [`Wall::bend`] looks for the point `s` of the wall
//! at which light from `y` bends towards `x`. With `dω/dA` of the way ([`Bend::spread`]) the sample has the density
//! `p_A(y) / (dω/dA)` per solid angle at `x`, and brings
//!
//! ```text
//! phase(x, d) T(x, s) (1 − F) η² T(s, y) L(y → s) / density
//! ```
//!
//! **Why it is unbiased.** Which `s` belongs to `(x, y)` is a function of the two and nothing else: [`Scene::bend`]. A path that was
//! scattered at `x`, bent by the wall and has run into the light at `y` asks the same function. If the answer is its own way, a light
//! sample could have made it, and both are weighed by the balance heuristic; if not, no light sample could, and it counts in
//! full. So what the search does not find costs variance and nothing else. Lights without extent, which no path runs into, are left
//! alone for that reason.

use super::volpath::Sink;
use crate::{
    bend::{Bend, Goal, Wall},
    bsdf::fresnel,
    light::{LightId, Reference, Target},
    math::{Ray, Vec2, Vec3},
    medium::Inside,
    path::{
        Attempt, History, Path, PathWeights, Sight, Source, Turn, Vertex, shadow,
        sight::{PassedWall, Start},
        turn::Kind,
        vertex::Scattered,
    },
    scene::Scene,
    shape::{Hit, ObjectId},
    spectrum::Lanes,
    tally::Tally,
};

/// Walls that are tried for one way: of a solid, the face behind which the first way ends may not be where it begins.
const TRIES: u32 = 4;
/// How deep the far end of a way may lie behind its wall \[mean free paths\].
const DEEPEST: f32 = 12.0;
/// How near two directions must be to be the same way \[rad\].
const SAME: f32 = 1e-3;

/// A way through a wall of the scene.
#[derive(Debug, Clone, Copy)]
struct Way {
    /// The object and the part of it.
    part: (ObjectId, u32),
    bend: Bend,
    /// The index before the wall over that behind it \[1\].
    eta: f32,
    /// Whether the geometric normal points back.
    faces: bool,
}

impl Scene {
    /// The way from a place in a medium to a goal, bent once at the first surface in its direction, and where that is: the one
    /// that is found from the straight line, or in a ball.
    fn bend(&self, from: &Start, goal: &Goal, tally: &mut Tally) -> Option<(Way, Ray, Hit)> {
        let mut way = match self.only_wall(from.medium) {
            Some(ball) => Some(self.way_through((ball, 0), from, goal)?),
            None => None,
        };
        for _ in 0..TRIES {
            let ray = Ray::new(from.p, way.map_or_else(|| goal.straight(from.p), |way| way.bend.dir));
            tally.shadow_rays += 1;
            let hit = self.geometry.intersect(&ray, from.reach)?;
            let part = (hit.object, hit.prim);
            match way {
                Some(way) if way.part == part => return Some((way, ray, hit)),
                _ => way = Some(self.way_through(part, from, goal)?),
            }
        }
        None
    }

    /// The way through one wall, as if nothing else were there.
    fn way_through(&self, part: (ObjectId, u32), from: &Start, goal: &Goal) -> Option<Way> {
        let index = self.wall(part.0)?;
        let (wall, faces) = Wall::of(self.geometry.shape(part.0), part.1, from.p)?;
        let eta = if faces { 1.0 / index } else { index };
        Some(Way { part, bend: wall.bend(from.p, eta, goal, from.reach)?, eta, faces })
    }

    /// The density with which a light sample finds the goal of a path that has passed a wall, if it would have gone the same way
    /// [1/sr].
    #[inline(never)]
    fn light_density_bent(&self, id: LightId, goal: &Goal, passed: &PassedWall, tally: &mut Tally) -> f32 {
        let (light, from) = (self.lights.get(id), Reference { p: passed.start.p, normal: None });
        if !light.is_worth_bending() {
            return 0.0;
        }
        match self.bend(&passed.start, goal, tally) {
            Some((Way { bend, .. }, ..)) if bend.dir.distance_squared(passed.dir) < SAME * SAME => {
                self.lights.bending_probability(&from, id) * light.pdf_across(&from, goal, bend.onward) / bend.spread
            }
            _ => 0.0,
        }
    }
}

impl Path {
    /// Next event estimation through a wall: one light, one way, one shadow ray from the wall.
    #[inline(never)]
    pub(super) fn sample_light_bent(
        &self,
        scene: &Scene,
        vertex: &Vertex,
        (attempt, [u_choice, u, v, _]): (&Attempt, [f32; 4]),
        (weights, history): (&PathWeights, &History),
        sink: &mut impl Sink,
        tally: &mut Tally,
    ) {
        let (reference, Some(start)) = (vertex.reference(), self.start(vertex.reference().p)) else { return };
        let Some((id, probability)) = scene.lights.choose_bending(&reference, u_choice) else { return };
        let light = scene.lights.get(id);
        if !light.is_worth_bending() {
            return;
        }
        let Some(sample) = light.sample(&reference, Vec2::new(u, v), &self.wavelengths) else { return };
        let (goal, source) = match sample.target {
            Target::Surface { p, ng, .. } => (Goal::Point { p, ng }, Source::Light(id)),
            Target::Infinity => (Goal::Infinity(sample.dir), Source::Sky(id)),
            Target::Point(_) => return,
        };
        let Some((way, ray, hit)) = scene.bend(&start, &goal, tally) else { return };
        let Bend { dir, onward, cos_theta, spread } = way.bend;
        let Some(Attempt { odds, supposed, .. }) = attempt.towards(start.p, dir) else { return };
        if !light.shines_towards(&goal, -onward) {
            return;
        }
        let (f, scatter_pdf) = vertex.eval(dir);
        let beyond = scene.objects[hit.object.0 as usize].interface.map_or(self.inside, |interface| {
            Inside::of(scene, interface.towards(if way.faces { -1.0 } else { 1.0 }), &self.wavelengths)
        });
        if f.is_zero() || !scene.light_can_reach(beyond.id()) {
            return;
        }
        let passes = 1.0 - fresnel::dielectric(cos_theta, 1.0 / way.eta).reflectance;
        let origin = scene.geometry.interaction(&ray, &hit).spawn(onward).origin;
        let wavelengths = (&self.wavelengths, self.hero);
        let outside =
            shadow::transmittance(scene, origin, onward, &sample.target, (beyond, &self.within), wavelengths, tally);
        if let Some(outside) = outside {
            let pdf = probability * light.pdf_across(&reference, &goal, onward) / spread;
            let inside = self.inside.coefficients().map_or(Lanes::ONE, |c| c.transmittance(hit.t));
            let found = inside * scene.reached(&beyond, outside) * (scatter_pdf * passes);
            let weight = weights.light_sample([supposed * pdf, pdf], found, inside * outside);
            let mut history = *history;
            sink.turned(&mut history, vertex.turn(false, false), 1);
            let last = Turn::Surface { object: hit.object, crossed: true, kind: Kind::Specular };
            let bends = passes * way.eta * way.eta;
            sink.add(weight * (supposed / odds * bends) * f * sample.li, &history, Some(last), source);
        }
    }

    /// How light is sampled from a vertex that is no Dirac lobe.
    #[inline]
    pub(super) fn sight(scene: &Scene, vertex: &Vertex) -> Sight {
        match vertex {
            Vertex::Surface { .. } => Sight::Straight,
            Vertex::Medium { medium, .. } => scene.lit(Some(*medium)).into(),
        }
    }

    /// The wall that the path passes by a Dirac lobe, if light samples from its last vertex may bend there. To be called before it
    /// does.
    #[inline]
    pub(super) fn passes(&self, scene: &Scene, vertex: &Vertex, scattered: &Scattered) -> Option<PassedWall> {
        let (Sight::Behind, Vertex::Surface { hit, .. }) = (self.sight, vertex) else { return None };
        if !scattered.crossed || scene.wall(hit.object).is_none() {
            return None;
        }
        Some(PassedWall { start: self.start(self.last_vertex.p)?, dir: self.ray.dir })
    }

    /// What a light sample from `p`, in the medium that the path is in, starts with.
    #[inline]
    fn start(&self, p: Vec3) -> Option<Start> {
        let Inside::Medium { id, coefficients } = &self.inside else { return None };
        Some(Start { p, medium: *id, reach: DEEPEST / coefficients.sigma_t.min_lane() })
    }

    /// The density with which a light sample would have found the goal that the path has run into, by solid angle where it last
    /// scattered [1/sr]: `straight` from there without a wall between.
    #[inline]
    pub(super) fn light_density(
        &self,
        scene: &Scene,
        id: LightId,
        goal: &Goal,
        straight: impl FnOnce(&Reference) -> f32,
        tally: &mut Tally,
    ) -> f32 {
        match &self.sight {
            Sight::Straight => scene.lights.probability(&self.last_vertex, id) * straight(&self.last_vertex),
            Sight::Behind => 0.0,
            Sight::Past(passed) => scene.light_density_bent(id, goal, passed, tally),
        }
    }
}
