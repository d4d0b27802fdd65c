//! Layers of light: the names that expressions may use, and the automaton of the expressions.

use tyndall::{lpe::Names, scene::Scene};

use super::Builder;
use crate::error::SceneError;

impl Builder<'_> {
    /// Adds the layers of light that the film asks for; `names` are those of its shapes and of the lights that they are.
    pub(super) fn take_apart(&mut self, scene: &mut Scene, mut names: Names) -> Option<()> {
        let parts = &self.desc.film.parts;
        if parts.layers.is_empty() {
            return Some(());
        }
        let alone = |name: &Option<String>| name.iter().cloned().collect();
        names.media = self.desc.media.iter().map(|medium| alone(&medium.name)).collect();
        // Lights that are no shapes come after those that are.
        names.lights.extend(self.desc.lights.iter().map(|light| alone(&light.name)));
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
