//! The resolved, immutable world that a render reads: arrays and typed ids, made once.

mod lit;
mod rooms;

use std::sync::Arc;

pub use lit::Lit;

use crate::{
    camera::Camera,
    film::{Average, LayerKind, Recorded},
    granular::Granular,
    light::{AreaLight, Light, LightId, LightTable},
    lpe::{Automaton, Names, PathLayer, automaton::BuildError},
    material::Material,
    math::{Bounds, Ray, Vec3, rounding::gamma},
    medium::{Body, Homogeneous, MediumId, MediumInterface, Member, Within, enclosure},
    shape::{Distances, Geometry, Hit, Hollows, Interaction, ObjectId, Room, Shape, TouchingBalls},
    spectrum::ColorMode,
    surface::may_be_open,
};

/// Index of a material of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct MaterialId(pub u32);

/// What a shape is made of: everything about a surface that is not its geometry.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    /// What the user called it.
    pub name: String,
    /// How it scatters light.
    pub material: MaterialId,
    /// The media on its two sides; `None` when it stands in a medium without bounding one.
    pub interface: Option<MediumInterface>,
    /// Its lights.
    pub emission: Emission,
    /// The body that it bounds, if it has a priority.
    pub body: Option<Member>,
    /// What it is among grains, if it has to do with them.
    pub granular: Option<Granular>,
}

impl Object {
    /// Whether a medium is on one of its sides.
    fn bounds(&self, medium: MediumId) -> bool {
        self.interface.is_some_and(|i| i.inside == Some(medium) || i.outside == Some(medium))
    }
}

/// The lights that the primitives of an object are.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Emission {
    /// It does not shine.
    None,
    /// All its primitives are one light.
    Whole(LightId),
    /// Each primitive is a light of its own: the light of primitive 0, the others follow.
    EachPrimitive(LightId),
}

/// A scene, ready to be rendered.
#[derive(Debug)]
pub struct Scene {
    /// What the lanes of a path mean.
    pub color: ColorMode,
    /// The view.
    pub camera: Camera,
    /// All surfaces.
    pub geometry: Geometry,
    /// By [`crate::shape::ObjectId`].
    pub objects: Arc<[Object]>,
    /// By [`MaterialId`].
    pub materials: Arc<[Material]>,
    /// By [`MediumId`].
    pub media: Arc<[Homogeneous]>,
    /// All lights.
    pub lights: Arc<LightTable>,
    /// How its light is taken apart, if layers ask for that: [`Self::take_apart`].
    pub paths: Option<Automaton>,
    /// The same world with a proxy in the place of its grains, if there is one: [`Self::with_proxy`].
    proxied: Option<Box<Self>>,
    /// What follows from the above and is asked for often.
    facts: Facts,
}

/// What is known about a scene before the first ray.
#[derive(Debug, Default)]
struct Facts {
    /// Whether any surface lets light pass unchanged, so that shadow rays have to walk.
    has_null_surfaces: bool,
    /// By object: whether it lets all light pass, if that is all there is to know of what light can pass.
    open: Option<Vec<bool>>,
    /// By medium: how light samples from inside it reach lights.
    lit: Vec<Lit>,
    /// By object: the index of a smooth wall that light samples may bend at \[1\].
    walls: Vec<Option<f32>>,
    /// By medium: the ball that holds it and that alone bounds it, if that is such a wall.
    only_wall: Vec<Option<ObjectId>>,
    /// By medium: a box that it does not reach out of.
    extent: Vec<Bounds>,
    /// By medium: all that it fills, if that is simple.
    room: Vec<Option<Room>>,
    /// Spheres that light can enter and in which nothing else is.
    hollows: Hollows,
    /// By medium: the greatest clearance in it [length].
    deepest: Vec<f32>,
    /// By medium: the greatest radius of balls that touch its surface [length].
    widest: Vec<f32>,
    /// By medium: whether a small lamp is in it.
    holds_lamp: Vec<bool>,
    /// Where lights are that are no surfaces; one box for all if they are many.
    bare_lights: Vec<Bounds>,
    /// Whether a search for the nearest surface is quick.
    has_few_surfaces: bool,
    /// Distances deep inside media, where a search for them is slow.
    distances: Option<Distances>,
    /// Balls that touch the triangles around media from inside.
    touching: TouchingBalls,
    /// Bodies with a priority, which may overlap.
    bodies: Vec<Body>,
    /// What the camera is in.
    around_camera: Within,
}

impl Scene {
    /// Puts a scene together.
    #[allow(clippy::too_many_arguments)] // one for each array of the world
    pub fn new(
        color: ColorMode,
        camera: Camera,
        geometry: Geometry,
        objects: impl Into<Arc<[Object]>>,
        materials: impl Into<Arc<[Material]>>,
        media: impl Into<Arc<[Homogeneous]>>,
        lights: LightTable,
    ) -> Self {
        let (mut objects, materials) = (objects.into(), materials.into());
        let bodies = Body::gather(Arc::make_mut(&mut objects), &materials, &geometry);
        let scene = Self {
            color,
            camera,
            geometry,
            objects,
            materials,
            media: media.into(),
            lights: Arc::new(lights),
            paths: None,
            proxied: None,
            facts: Facts::default(),
        };
        scene.known(bodies, Granular::Proxy)
    }

    /// Adds the world in which a proxy stands for the grains: the same tables, and the geometry
    /// [without grains](crate::shape::GeometryBuilder::build_granular).
    #[must_use]
    pub fn with_proxy(mut self, geometry: Geometry) -> Self {
        let twin = Self {
            color: self.color,
            camera: self.camera.clone(),
            geometry,
            objects: Arc::clone(&self.objects),
            materials: Arc::clone(&self.materials),
            media: Arc::clone(&self.media),
            lights: Arc::clone(&self.lights),
            paths: None,
            proxied: None,
            facts: Facts::default(),
        };
        self.proxied = Some(Box::new(twin.known(self.facts.bodies.clone(), Granular::Grain)));
        self
    }

    /// With the facts, where the objects that are `absent` are not in its geometry.
    fn known(mut self, bodies: Vec<Body>, absent: Granular) -> Self {
        let all = Arc::clone(&self.objects);
        let present = |(_, object): &(ObjectId, &Object)| object.granular != Some(absent);
        let objects: Vec<_> = (0..).map(ObjectId).zip(all.iter()).filter(present).collect();
        let Self { camera, geometry, materials, lights, .. } = &self;
        let walls = lit::walls(&self, &bodies);
        let is_open = |(_, o): &(ObjectId, &Object)| may_be_open(&materials[o.material.0 as usize], materials);
        let media = || (0..).map(MediumId).take(self.media.len());
        let extent: Vec<_> = media().map(|medium| rooms::extent(medium, camera, geometry, &objects, &bodies)).collect();
        self.facts = Facts {
            // A surface of a body may not be there.
            has_null_surfaces: objects.iter().any(is_open) || !bodies.is_empty(),
            open: self.open_surfaces(&objects).filter(|_| bodies.is_empty()),
            lit: media()
                .zip(&extent)
                .map(|(m, extent)| {
                    if lit::opens_straight(m, &bodies) || lit::can_be_lit(m, extent, &objects, materials, lights) {
                        Lit::Straight
                    } else if objects.iter().any(|(id, o)| o.bounds(m) && walls[id.0 as usize].is_some()) {
                        Lit::Bent
                    } else {
                        Lit::Never
                    }
                })
                .collect(),
            only_wall: media().map(|m| lit::only_wall(m, &objects, &walls, geometry)).collect(),
            walls,
            deepest: extent.iter().map(|extent| rooms::deepest(extent, geometry)).collect(),
            extent,
            bare_lights: rooms::bare_lights(lights),
            has_few_surfaces: rooms::has_few_surfaces(geometry),
            bodies,
            ..Facts::default()
        };
        let holds_lamp = |medium| {
            (0..).map(LightId).take(self.lights.lights.len()).any(|lamp| self.small_lamp(medium, lamp).is_some())
        };
        self.facts.holds_lamp = (0..).map(MediumId).take(self.media.len()).map(holds_lamp).collect();
        self.facts.room = rooms::of_media(&self, &objects);
        self.facts.hollows = rooms::hollows(&self);
        self.facts.distances = rooms::distances(&self);
        self.facts.widest = rooms::widest(&self);
        self.facts.touching = rooms::touching(&self);
        self.facts.around_camera = enclosure::around_camera(&self);
        self
    }

    /// By object whether it lets all light pass; `None` where some light is let pass otherwise: by holes, by surfaces that shine
    /// too, or by those that a ray can meet twice.
    fn open_surfaces(&self, objects: &[(ObjectId, &Object)]) -> Option<Vec<bool>> {
        let mut open = vec![false; self.objects.len()];
        for &(id, object) in objects {
            let material = &self.materials[object.material.0 as usize];
            let is_mesh = matches!(self.geometry.shape(id), Shape::Mesh(_));
            if matches!(material, Material::Null) && object.emission == Emission::None && is_mesh {
                open[id.0 as usize] = true;
            } else if may_be_open(material, &self.materials) {
                return None;
            }
        }
        Some(open)
    }

    /// The same if there is such a surface.
    #[inline]
    pub(crate) fn open_to_paths(&self) -> Option<&[bool]> {
        self.open().filter(|_| self.facts.has_null_surfaces)
    }

    /// By object whether it lets all light pass, where that is all there is to know of what light can pass.
    #[inline]
    pub(crate) fn open(&self) -> Option<&[bool]> {
        self.facts.open.as_deref()
    }

    /// The same world with a proxy in the place of its grains.
    #[inline]
    pub fn proxied(&self) -> Option<&Self> {
        self.proxied.as_deref()
    }

    /// Adds layers of light to what the camera's film records.
    ///
    /// # Errors
    /// What is wrong with their expressions, in this scene with these names.
    pub fn take_apart(&mut self, layers: &[PathLayer], names: &Names) -> Result<(), BuildError> {
        self.paths = Some(Automaton::new(layers, names)?);
        self.camera.layers.extend((0..).zip(layers).map(|(number, layer)| LayerKind {
            recorded: Recorded::Paths(number),
            channels: ["R", "G", "B"].map(|c| format!("{}.{c}", layer.name)).to_vec(),
            average: Average::Samples,
        }));
        Ok(())
    }

    /// The object that was hit.
    #[inline]
    pub fn object(&self, hit: &Interaction) -> &Object {
        &self.objects[hit.object.0 as usize]
    }

    /// The material that was hit.
    #[inline]
    pub fn material(&self, hit: &Interaction) -> &Material {
        &self.materials[self.object(hit).material.0 as usize]
    }

    /// Whether light may pass unchanged through some of an object's surface.
    pub fn lets_light_pass(&self, object: &Object) -> bool {
        may_be_open(&self.materials[object.material.0 as usize], &self.materials)
    }

    /// A medium by its index.
    #[inline]
    pub fn medium(&self, id: MediumId) -> &Homogeneous {
        &self.media[id.0 as usize]
    }

    /// The light that was hit, if the surface shines.
    #[inline]
    pub fn light_at(&self, hit: &Interaction) -> Option<(LightId, &AreaLight)> {
        let id = match self.object(hit).emission {
            Emission::None => return None,
            Emission::Whole(id) => id,
            Emission::EachPrimitive(first) => LightId(first.0 + hit.prim),
        };
        match self.lights.get(id) {
            Light::Area(light) => Some((id, light)),
            _ => None,
        }
    }

    /// Whether there are bodies that may overlap.
    #[inline]
    pub fn has_bodies(&self) -> bool {
        !self.facts.bodies.is_empty()
    }

    /// The bodies, by [`crate::medium::BodyId`].
    #[inline]
    pub fn bodies(&self) -> &[Body] {
        &self.facts.bodies
    }

    /// What the camera is in: found by what encloses it where the scene does not say.
    #[inline]
    pub fn around_camera(&self) -> &Within {
        &self.facts.around_camera
    }

    /// The first surface within a free flight of length `flight` [length].
    ///
    /// The end of a flight is rounded, and must not be rounded across a surface: a collision on the wrong side would
    /// leave a body without meeting its boundary. A surface as near to the end as rounding can be is therefore reached.
    #[inline]
    pub fn first_surface(&self, ray: &Ray, flight: f32) -> Option<Hit> {
        self.geometry.intersect(ray, flight + self.rounding(ray, flight))
    }

    /// How far rounding may carry the end of a flight [length].
    #[inline]
    pub fn rounding(&self, ray: &Ray, flight: f32) -> f32 {
        gamma(8) * (ray.origin.abs().max_element() + flight)
    }

    /// Whether `p` can be in a medium at all, which has ends. (At grazing incidence a rounded collision may still lie
    /// outside: such a path has leaked, and is told by this once it is far enough.)
    #[inline]
    pub fn may_contain(&self, medium: MediumId, p: Vec3) -> bool {
        self.facts.extent[medium.0 as usize].contains(p)
    }

    /// Whether shadow rays must walk through surfaces that let light pass.
    #[inline]
    pub fn has_null_surfaces(&self) -> bool {
        self.facts.has_null_surfaces
    }
}

fn overlap(a: &Bounds, b: &Bounds) -> bool {
    a.min.cmple(b.max).all() && b.min.cmple(a.max).all()
}
