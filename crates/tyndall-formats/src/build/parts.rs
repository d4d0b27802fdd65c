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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use tyndall::{light::LightId, path::turn::Source, scene::Scene, spectrum::ColorMode};

    use crate::{build::build, mitsuba, pbrt};

    /// Which of the layers `lamp`, `globe`, `key` and `fill` the light of each source, seen from the camera, belongs to.
    fn called(scene: &Scene) -> Vec<Vec<&'static str>> {
        let paths = scene.paths.as_ref().unwrap();
        let of = |light| {
            let layers = paths.selects(0, Source::Light(LightId(light)));
            (0..)
                .zip(["lamp", "globe", "key", "fill"])
                .filter(move |(bit, _)| layers & (1 << bit) != 0)
                .map(|(_, name)| name)
        };
        (0..scene.lights.lights.len() as u32).map(|light| of(light).collect()).collect()
    }

    /// A light bears its own name and those of the shape that it is; each triangle of a mesh is a light of its own. Lights that
    /// are no shapes come last; one has no name, and two may have one.
    #[test]
    fn lights_have_names_in_both_languages() {
        let layers = "lamp=C.*L'lamp' globe=C.*L'globe' key=C.*L'key' fill=C.*L'fill'";
        let words = layers.replace(' ', "\" \"");
        let text = format!(
            r#"Film "rgb" "string layers" [ "{words}" ]
               WorldBegin
               LightSource "point" "string name" "key"
               LightSource "distant"
               LightSource "infinite" "string name" "fill"
               AttributeBegin
                 AreaLightSource "diffuse" "string name" "lamp"
                 Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [0 0 0 1 0 0 1 1 0 0 2 0]
                 Shape "sphere" "string name" "globe"
               AttributeEnd
               LightSource "spot" "string name" "key"
               AreaLightSource "diffuse"
               Shape "sphere""#
        );
        let (desc, sources) = pbrt::parse(Path::new("scene.pbrt"), &text).unwrap();
        let (scene, _) = build(&desc, sources, ColorMode::Rgb).unwrap();
        let [lamp, globe, key, fill] = ["lamp", "globe", "key", "fill"];
        let expected = [vec![lamp], vec![lamp], vec![lamp, globe], vec![], vec![key], vec![], vec![fill], vec![key]];
        assert_eq!(called(&scene), expected);

        let layers = layers.replace(' ', ",");
        let text = format!(
            r#"<scene version="3.0.0">
               <sensor type="perspective"><film type="hdrfilm"><string name="layers" value="{layers}"/></film></sensor>
               <emitter type="point" id="key"/>
               <emitter type="constant"/>
               <shape type="sphere" id="globe"><emitter type="area" id="lamp"/></shape>
               <emitter type="directional" id="fill"/>
               </scene>"#
        );
        let (desc, sources) = mitsuba::parse(Path::new("scene.xml"), &text, &[]).unwrap();
        let (scene, _) = build(&desc, sources, ColorMode::Rgb).unwrap();
        assert_eq!(called(&scene), [vec![lamp, globe], vec![key], vec![], vec![fill]]);
    }
}
