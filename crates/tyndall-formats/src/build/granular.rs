//! Whether grains and what stands for them are what [`tyndall::granular`] takes them for.

use tyndall::{granular::Granular, scene::Scene, shape::ObjectId};

use super::Builder;
use crate::{
    desc::{GroupDesc, ShapeDesc},
    error::SceneError,
    source::Span,
};

impl Builder<'_> {
    /// `granular` are all shapes that are grains or proxies, each with its objects.
    pub(super) fn check_granular(&mut self, scene: &Scene, granular: &[(&ShapeDesc, Vec<ObjectId>)]) -> Option<()> {
        for group in &self.desc.groups {
            self.check_group(group)?;
        }
        for (shape, objects) in granular {
            if let Some((message, help)) = fault(scene, shape, objects) {
                return self.fail(SceneError::at(place(shape), message).help(help));
            }
        }
        let first = |what| granular.iter().find(|(shape, _)| shape.granular.is_some_and(|g| g.value == what));
        let (grain, proxy) = (first(Granular::Grain), first(Granular::Proxy));
        match (proxy, grain, &self.desc.integrator.explicit_grains) {
            (Some((proxy, _)), None, _) => self.fail(
                SceneError::at(place(proxy), "this stands for grains, and there are none")
                    .help("mark the shapes that it stands for as \"grain\""),
            ),
            (None, _, Some(grains)) => self.fail(
                SceneError::at(grains.span, "there is nothing for a path to go on in after its explicit grains")
                    .help("mark the medium that stands for them as \"proxy\"; `tyndall pack --proxy` writes one"),
            ),
            _ => Some(()),
        }
    }

    /// Instances are placed as a whole: with the grains, or with their proxy.
    fn check_group(&mut self, group: &GroupDesc) -> Option<()> {
        let grains = group.shapes.iter().filter(|shape| shape.granular.is_some());
        let Some(grain) = grains.clone().next() else { return Some(()) };
        if let Some(proxy) = grains.clone().find(|shape| shape.granular.is_some_and(|g| g.value == Granular::Proxy)) {
            return self.fail(
                SceneError::at(place(proxy), "a proxy is no part of an object that is instanced")
                    .help("place it in the world itself"),
            );
        }
        let Some(other) = group.shapes.iter().find(|shape| shape.granular.is_none()) else { return Some(()) };
        self.fail(
            SceneError::at(other.span, "this is no grain, and a shape of the same object is one")
                .help("make grains of all shapes of an object, or of none")
                .related(place(grain), "the grain"),
        )
    }
}

/// Where it says what it is among grains.
fn place(shape: &ShapeDesc) -> Span {
    shape.granular.map_or(shape.span, |granular| granular.span)
}

/// What is wrong with a grain or a proxy, and what to do.
fn fault(scene: &Scene, shape: &ShapeDesc, objects: &[ObjectId]) -> Option<(&'static str, &'static str)> {
    let faces_inward = || matches!(objects, [object] if scene.geometry.faces_inward(*object));
    if shape.emission.is_some() {
        return Some(("grains and their proxies do not shine", "leave out the light"));
    }
    if shape.priority.is_some() {
        return Some(("grains and their proxies have no priority", "leave it out"));
    }
    if !scene.geometry.is_closed(objects) || faces_inward() {
        return Some((
            "grains and their proxies are closed, with normals to their outside",
            "close it, or turn it round",
        ));
    }
    let mut objects = objects.iter().map(|id| &scene.objects[id.0 as usize]);
    match shape.granular?.value {
        Granular::Grain if objects.any(|object| scene.lets_light_pass(object)) => Some((
            "light passes this grain unchanged, and cannot be told from light that has met none",
            "give it a material",
        )),
        Granular::Proxy if !objects.all(|object| scene.lets_light_pass(object)) || shape.opacity.is_some() => {
            Some(("a proxy is a boundary without a material", "use the material \"interface\" (\"null\")"))
        }
        Granular::Proxy if shape.interface.is_none_or(|interface| interface.inside.is_none()) => {
            Some(("there is no medium in this proxy", "name the medium inside"))
        }
        Granular::Grain | Granular::Proxy => None,
    }
}
