//! Layers of light: the names that expressions may use, and the automaton of the expressions.

use tyndall::{
    lpe::Names,
    scene::{Emission, Scene},
};

use super::Builder;
use crate::error::SceneError;

impl Builder<'_> {
    /// Adds the layers of light that the film asks for; `objects` are the names of each object of the scene.
    pub(super) fn take_apart(&mut self, scene: &mut Scene, objects: Vec<Vec<String>>) -> Option<()> {
        let parts = &self.desc.film.parts;
        if parts.layers.is_empty() {
            return Some(());
        }
        let media = self.desc.media.iter().map(|medium| medium.name.iter().cloned().collect());
        let names = Names { lights: names_of_lights(scene, &objects), objects, media: media.collect() };
        let error = |message: String| match parts.span {
            Some(span) => SceneError::at(span, message),
            None => SceneError::new(message),
        };
        if let Err(e) = scene.take_apart(&parts.layers, &names) {
            return self.fail(error(e.to_string()));
        }
        let mut channels: Vec<_> = scene.camera.layers.iter().flat_map(|layer| &layer.channels).collect();
        channels.sort_unstable();
        if let Some([twice, _]) = channels.windows(2).find(|pair| pair[0] == pair[1]) {
            let help = "call the layer of light otherwise, as in NAME=EXPRESSION";
            return self.fail(error(format!("two layers have a channel `{twice}`")).help(help));
        }
        Some(())
    }
}

/// A light that is a shape bears the names of the shape. (Lights of a shape follow one another.)
fn names_of_lights(scene: &Scene, objects: &[Vec<String>]) -> Vec<Vec<String>> {
    let mut lights = vec![Vec::new(); scene.lights.lights.len()];
    for (object, names) in scene.objects.iter().zip(objects) {
        let of_it = match object.emission {
            Emission::None => continue,
            Emission::Whole(id) => id.0..id.0 + 1,
            Emission::EachPrimitive(first) => first.0..u32::MAX,
        };
        // What comes after the last primitive belongs to the next shape, which writes its own names there.
        for light in lights.iter_mut().take(of_it.end as usize).skip(of_it.start as usize) {
            names.clone_into(light);
        }
    }
    // Nor have lights that are no shapes these names.
    for (names, light) in lights.iter_mut().zip(&scene.lights.lights) {
        if !matches!(light, tyndall::light::Light::Area(_) | tyndall::light::Light::Beam(_)) {
            names.clear();
        }
    }
    lights
}
