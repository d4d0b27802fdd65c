//! Pictures of textures that are not where the scene says.
//!
//! Without its pictures a scene can still be looked at: grey stands for them, with a warning for each, where the user is
//! lenient or only asks what is in the scene. Otherwise a picture that some surface needs is an error when it is read; one
//! that nothing needs is only told of.

use crate::desc::{SceneDesc, Spanned, SpectrumDesc, TextureId, TextureKind, Varying};
use crate::error::SceneError;

/// Which missing pictures are replaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Missing {
    /// Those that nothing needs.
    Unused,
    /// All.
    All,
}

/// What stands for a picture \[1\].
const GREY: f64 = 0.5;

/// Puts grey for missing pictures, and adds a warning for each to those of the scene.
pub fn replace(desc: &mut SceneDesc, which: Missing) {
    let used: std::collections::HashSet<TextureId> = match which {
        Missing::Unused => desc.textures_in_use().collect(),
        Missing::All => std::collections::HashSet::new(),
    };
    for (id, texture) in (0..).map(TextureId).zip(&mut desc.textures) {
        let TextureKind::Image(picture) = &texture.kind else { continue };
        if used.contains(&id) || picture.path.value.exists() {
            continue;
        }
        let (path, span) = (picture.path.value.display(), picture.path.span);
        let name = texture.name.as_deref().map_or(String::new(), |name| format!(" of the texture \"{name}\""));
        let told = SceneError::warning(span, format!("the picture{name} is missing: {path}"));
        desc.warnings.push(told.help("grey stands for it"));
        let grey = Spanned::new(Varying::Everywhere(SpectrumDesc::Constant(GREY)), span);
        texture.kind = TextureKind::Plain(grey);
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use tyndall::spectrum::ColorMode;

    use super::*;

    const WORLD: &str = r#"WorldBegin
Texture "bark" "spectrum" "imagemap" "string filename" "no-such-bark.png"
Texture "moss" "spectrum" "imagemap" "string filename" "no-such-moss.png"
Material "diffuse" "texture reflectance" "bark" Shape "sphere""#;

    /// Told of are both, one, or none; and what some surface needs is an error when the scene is built.
    #[test]
    fn grey_stands_for_a_picture_that_is_missing() {
        let told = |which: Option<Missing>| {
            let (mut desc, sources) = crate::pbrt::parse(Path::new("scene.pbrt"), WORLD).unwrap();
            if let Some(which) = which {
                replace(&mut desc, which);
            }
            let told: Vec<_> = desc.warnings.iter().map(|warning| warning.message.clone()).collect();
            (told.join("\n"), crate::build::build(&desc, sources, ColorMode::Rgb).map_err(|error| error.to_string()))
        };
        let (all, built) = told(Some(Missing::All));
        assert!(all.contains("the picture of the texture \"bark\" is missing") && all.contains("moss"), "{all}");
        let material = &built.unwrap().0.materials[0];
        let tyndall::material::Material::Diffuse { reflectance, .. } = material else { panic!("{material:?}") };
        assert_eq!(format!("{reflectance:?}"), format!("{:?}", tyndall::texture::Texture::from(0.5)));

        let (unused, built) = told(Some(Missing::Unused));
        assert!(unused.contains("moss") && !unused.contains("bark"), "{unused}");
        let refused = built.unwrap_err();
        assert!(refused.contains("no-such-bark.png") && refused.contains("scene.pbrt:2:"), "{refused}");
        assert_eq!(told(None).0, "");
    }
}
