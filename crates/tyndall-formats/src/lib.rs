//! Scene languages, meshes, images and film files.
//!
//! ```text
//! scene.pbrt | scene.xml ─▶ load ─▶ SceneDesc   the user's words, spans and units kept
//! ```
//!
//! The readers of the two languages, [`pbrt`] and [`mitsuba`], give the same [`desc::SceneDesc`]. What they do not know is
//! an error that names file, line, column, the word and what to do ([`error`]).

pub mod build;
pub mod desc;
pub mod error;
pub mod film;
pub mod gzip;
pub mod image;
pub mod inspect;
pub mod measured;
pub mod mesh;
pub mod missing;
pub mod mitsuba;
pub mod pbrt;
pub mod source;
pub mod write;

use std::path::Path;

use desc::SceneDesc;
use error::{Diagnostics, SceneError, Unsupported};
use source::SourceMap;

/// Reads a scene, in the language that the file's ending names (before `.gz`, if it is compressed). `overrides` are parameters of the scene (`-D name=value`).
///
/// # Errors
/// Everything that is wrong with the scene; and what is not supported yet, unless that is only to be warned of
/// ([`SceneDesc::warnings`]).
pub fn load(
    path: &Path,
    overrides: &[(String, String)],
    unsupported: Unsupported,
) -> Result<(SceneDesc, SourceMap), Diagnostics> {
    let name = path.file_stem().filter(|_| gzip::is_gzip(path)).map_or(path, Path::new);
    match name.extension().and_then(|e| e.to_str()) {
        Some("pbrt") => pbrt::load(path, overrides, unsupported),
        Some("xml") => mitsuba::load(path, overrides, unsupported),
        _ => {
            let error = SceneError::new(format!("{} is in no scene language that is known here", path.display()))
                .help("scenes end in .pbrt (pbrt-v4) or .xml (Mitsuba 3)");
            Err(Diagnostics::new(vec![error], SourceMap::default()))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use desc::MaterialKind;
    use error::Severity;

    /// A scene in a file of its own, read with warnings only.
    fn read(name: &str, text: &str, unsupported: Unsupported) -> Result<SceneDesc, Diagnostics> {
        let directory = std::env::temp_dir().join(format!("tyndall-lenient-{}", std::process::id()));
        std::fs::create_dir_all(&directory).unwrap();
        let path = directory.join(name);
        std::fs::write(&path, text).unwrap();
        load(&path, &[], unsupported).map(|(desc, _)| desc)
    }

    /// What is not supported yet is refused, or left out: of three shapes one is left, under the default material.
    fn check(name: &str, text: &str, left_out: usize) {
        let refused = read(name, text, Unsupported::Refuse).unwrap_err();
        assert_eq!(refused.errors.len(), left_out, "{refused}");
        assert!(refused.errors.iter().all(|e| e.severity == Severity::NotYet));
        assert!(refused.to_string().starts_with("error: "), "{refused}");

        let desc = read(name, text, Unsupported::Warn).unwrap();
        assert_eq!(desc.warnings.len(), left_out);
        assert!(desc.warnings.iter().all(|e| e.severity == Severity::Warning));
        assert_eq!(desc.shapes.len(), 1);
        let material = desc.material(desc.shapes[0].material.value).unwrap();
        assert!(matches!(material.kind, MaterialKind::Diffuse { .. }));
    }

    #[test]
    fn a_pbrt_scene_without_what_is_not_known_yet_is_left() {
        let text = r#"
            WorldBegin
            MakeNamedMedium "cloud" "string type" "nanovdb" "string filename" "cloud.nvdb"
            Texture "t" "spectrum" "ptex" "string filename" "t.ptx"
            MediumInterface "cloud" ""
            Shape "sphere"
            Material "diffuse" "texture reflectance" "t"
        "#;
        check("scene.pbrt", text, 2);
        let desc = read("scene.pbrt", text, Unsupported::Warn).unwrap();
        assert_eq!(desc.media[0].scale.value, 0.0, "a medium that is not known yet is clear");
    }

    /// However often a word occurs that is left out: more often than faults are kept.
    #[test]
    fn a_scene_with_thousands_of_clouds_is_left_without_them() {
        let cloud = |i| format!("MakeNamedMedium \"{i}\" \"string type\" \"nanovdb\" \"string filename\" \"a.nvdb\"\n");
        let clouds: String = (0..5000).map(cloud).collect();
        let text = format!("WorldBegin\n{clouds}Shape \"sphere\"\n");
        let desc = read("clouds.pbrt", &text, Unsupported::Warn).unwrap();
        assert_eq!(desc.shapes.len(), 1);
    }

    #[test]
    fn a_mitsuba_scene_without_what_is_not_known_yet_is_left() {
        let text = r#"<scene version="3.0.0"><sensor type="perspective"/>
            <integrator type="stokes"/>
            <shape type="sphere"><bsdf type="pplastic"/></shape>
            <shape type="sdfgrid"/>
            <emitter type="sunsky"/>
        </scene>"#;
        check("scene.xml", text, 4);
    }

    /// Without a camera that is known there is no image: warnings alone do not make a scene.
    #[test]
    fn a_scene_whose_camera_is_not_known_yet_is_refused_anyway() {
        let text = r#"<scene version="3.0.0"><sensor type="perspective"><film type="specfilm"/></sensor></scene>"#;
        let refused = read("blind.xml", text, Unsupported::Warn).unwrap_err().to_string();
        assert!(refused.contains("error: without what is not known yet, no image is left to be made"), "{refused}");
        assert!(refused.contains("warning: the film \"specfilm\" is not known yet"), "{refused}");
    }

    /// A slip of the pen is no word that will be known one day.
    #[test]
    fn a_misspelt_word_is_an_error_even_if_the_reader_is_lenient() {
        let misspelt = read("slip.pbrt", "WorldBegin\nShape \"spere\"", Unsupported::Warn).unwrap_err();
        assert!(misspelt.to_string().contains("did you mean \"sphere\"?"), "{misspelt}");
    }
}
