//! Grains, and the medium that may stand for them: explicit geometry for the first grains of a path, a proxy for the rest.
//!
//! Light in a heap of clear grains passes hundreds of them. What the first few do is seen: their glints, their shapes, the
//! gaps between them. What all later ones do together is hardly told from what a medium does, and costs less in one. So a
//! scene may hold both, *grains* and their *proxy*, a closed boundary without a material around a medium, in two geometries
//! over the same tables of objects, media and lights: one without the proxy, where a path begins, and one without the grains
//! ([`Scene::proxied`]). A path that leaves its `N`-th grain ([`VolPath::explicit_grains`]) goes on in the other one from
//! where it is, in the medium if the proxy is around it, and stays there.
//!
//! - A path *leaves a grain* where it goes away from a surface of one and is in none: when it has passed through, and also
//!   when it is reflected at once. A grain in a grain (a coat, a core) is part of it.
//! - *The proxy is around a point* if the first surface of a proxy along a ray from there is met from within.
//! - A light sample at the last grain is looked for where a scattered ray would go on, so that both weigh each other rightly.
//!   Grains and proxies therefore do not shine, and light passes neither unchanged: no shadow ray goes through a grain.
//!
//! This is not exact: the medium knows nothing of what the next grain hides, nor of single bright ways through it. `None`
//! explicit grains is the exact answer, and `tyndall render` tells how far the two are apart.
//!
//! Sources: Moon, Walter and Marschner 2007, "Rendering Discrete Random Media Using Precomputed Scattering Solutions"; Meng
//! et al. 2015, "Multi-Scale Modeling and Rendering of Granular Materials"; Müller et al. 2016, "Efficient Rendering of
//! Heterogeneous Polydisperse Granular Media". They go from grains to a medium by where a path is or by what it costs; here
//! it is the number of grains, which keeps what a path is independent of the view.
//!
//! [`VolPath::explicit_grains`]: crate::integrator::VolPath::explicit_grains

use crate::{
    math::{Ray, Vec3},
    medium::{Inside, MediumInterface, Within},
    path::{Path, Vertex},
    scene::Scene,
    shape::Interaction,
    spectrum::Wavelengths,
};

/// What an object is among grains.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Granular {
    /// A grain, or a part of one. Closed, with its normal outwards.
    Grain,
    /// The boundary of a medium that stands for grains. Closed, with its normal outwards.
    Proxy,
}

/// How far a path has come among grains.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Among grains.
    Explicit {
        /// So many are left before the proxy; `None` for all there are.
        left: Option<u32>,
        /// Surfaces of grains that it is within.
        depth: u32,
    },
    /// Where the proxy stands for them.
    Proxied,
}

/// Surfaces after which a ray has looked for a proxy long enough.
const MOST_SURFACES: usize = 1000;

impl Default for Stage {
    fn default() -> Self {
        Self::Explicit { left: None, depth: 0 }
    }
}

impl Stage {
    /// After a surface of a grain was left along `dir`, to the other side or not.
    fn after(self, surface: &Interaction, dir: Vec3, crossed: bool) -> Self {
        let Self::Explicit { left: Some(left), depth } = self else { return self };
        let outward = dir.dot(surface.ng) > 0.0;
        let depth = match (crossed, outward) {
            (false, _) => depth,
            (true, false) => depth + 1,
            // A path that began in a grain leaves what it never entered.
            (true, true) => depth.saturating_sub(1),
        };
        match left - u32::from(outward && depth == 0) {
            0 => Self::Proxied,
            left => Self::Explicit { left: Some(left), depth },
        }
    }
}

impl Path {
    /// The world that the path is in.
    #[inline]
    pub(crate) fn world<'s>(&self, scene: &'s Scene) -> &'s Scene {
        match self.stage {
            Stage::Explicit { .. } => scene,
            Stage::Proxied => scene.proxied().unwrap_or(scene),
        }
    }

    /// At the camera: so many explicit grains, then their proxy.
    pub(crate) fn limit_grains(&mut self, scene: &Scene, grains: u32) {
        let Some(proxied) = scene.proxied() else { return };
        match grains {
            0 => self.go_on_in(proxied),
            grains => self.stage = Stage::Explicit { left: Some(grains), depth: 0 },
        }
    }

    /// The path has scattered on a surface, and is on its way from there.
    #[inline]
    pub(crate) fn leave_grain(&mut self, scene: &Scene, hit: &Interaction, crossed: bool) {
        let Some(proxied) = scene.proxied() else { return };
        match self.stage_after(scene, hit, self.ray.dir, crossed) {
            Stage::Proxied => self.go_on_in(proxied),
            explicit @ Stage::Explicit { .. } => self.stage = explicit,
        }
    }

    /// The world of the proxy, if a ray from `vertex` towards `dir` goes on there and the path is not there yet.
    #[inline]
    pub(crate) fn proxied_towards<'s>(&self, scene: &'s Scene, vertex: &Vertex, dir: Vec3) -> Option<&'s Scene> {
        let (Some(proxied), Vertex::Surface { hit, .. }) = (scene.proxied(), vertex) else { return None };
        let after = self.stage_after(scene, hit, dir, vertex.crosses(self.ray.dir, dir));
        (after == Stage::Proxied).then_some(proxied)
    }

    fn stage_after(&self, scene: &Scene, hit: &Interaction, dir: Vec3, crossed: bool) -> Stage {
        match scene.object(hit).granular {
            Some(Granular::Grain) => self.stage.after(hit, dir, crossed),
            Some(Granular::Proxy) | None => self.stage,
        }
    }

    fn go_on_in(&mut self, proxied: &Scene) {
        self.stage = Stage::Proxied;
        self.forget_surroundings();
        self.inside = proxied.enter_proxy(&self.ray, self.inside, &mut self.within, &self.wavelengths);
    }
}

impl Scene {
    /// What a path is in at the origin of a ray, outside of all grains, when the proxy has taken their place.
    pub(crate) fn enter_proxy(
        &self,
        ray: &Ray,
        outside: Inside,
        within: &mut Within,
        wavelengths: &Wavelengths,
    ) -> Inside {
        let Some(boundary) = self.proxy_around(*ray) else { return outside };
        within.cross_written(&boundary, -1.0);
        within.inside(self, wavelengths)
    }

    /// The boundary of the proxy that is around the origin of a ray.
    fn proxy_around(&self, mut ray: Ray) -> Option<MediumInterface> {
        for _ in 0..MOST_SURFACES {
            let hit = self.geometry.intersect(&ray, f32::INFINITY)?;
            let hit = self.geometry.interaction(&ray, &hit);
            let object = self.object(&hit);
            if object.granular == Some(Granular::Proxy) {
                return object.interface.filter(|_| ray.dir.dot(hit.ng) > 0.0);
            }
            ray = hit.spawn(ray.dir);
        }
        None
    }
}
