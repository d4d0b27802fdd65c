//! What pbrt's films `gbuffer` and `spectral` record beside colour.

use tyndall::{
    feature::{Facing, Feature, Space},
    film::{Average, Bands, LayerKind, Recorded},
};

use super::params::Params;
use crate::error::SceneError;

/// The most bands of a film.
const MOST_BANDS: u32 = 1024;

/// The layers of pbrt's `gbuffer`, by their names there.
pub(super) fn gbuffer(p: &mut Params) -> Vec<LayerKind> {
    let space = match p.string_opt("coordinatesystem") {
        Some(word) if word.value == "world" => Space::World,
        Some(word) if word.value != "camera" => {
            let error = SceneError::at(word.span, format!("there is no coordinate system \"{}\"", word.value));
            p.error(error.suggest(&word.value, ["camera", "world"]));
            Space::Camera
        }
        _ => Space::Camera,
    };
    in_space(space)
}

/// The layers of a `gbuffer` in a space.
pub(crate) fn in_space(space: Space) -> Vec<LayerKind> {
    let layer = |feature, average, channels: &[&str]| LayerKind {
        recorded: Recorded::Surface(feature),
        average,
        channels: channels.iter().map(ToString::to_string).collect(),
    };
    let (geometric, shading) =
        (Feature::GeometricNormal(space, Facing::Viewer), Feature::ShadingNormal(space, Facing::Viewer));
    vec![
        layer(Feature::Albedo, Average::Samples, &["Albedo.R", "Albedo.G", "Albedo.B"]),
        layer(Feature::Position(space), Average::Hits, &["P.X", "P.Y", "P.Z"]),
        layer(geometric, Average::Directions, &["N.X", "N.Y", "N.Z"]),
        layer(shading, Average::Directions, &["Ns.X", "Ns.Y", "Ns.Z"]),
        layer(Feature::Uv, Average::Hits, &["u", "v"]),
        layer(Feature::DzDxy(space), Average::Sizes, &["dzdx", "dzdy"]),
    ]
}

/// The layers of pbrt's `spectral`: bands side by side, called by the wavelength in their middle, as Fichet et al. 2021 ("An
/// OpenEXR layout for spectral images") have it: `S0.374,688nm`. Four share a layer.
pub(super) fn spectral(p: &mut Params) -> Vec<LayerKind> {
    let bands = p.count("nbuckets", 16, 1);
    let [least, greatest] = [("lambdamin", 360.0), ("lambdamax", 830.0)].map(|(name, default)| {
        p.float_in(name, default, "between 360 and 830 nm, the wavelengths of light", |l| (360.0..=830.0).contains(&l))
    });
    if least.value >= greatest.value {
        p.error(
            SceneError::at(greatest.span, "these wavelengths make no band").help("\"lambdamin\" is the lesser one"),
        );
        return Vec::new();
    }
    if bands.value > MOST_BANDS {
        p.error(SceneError::at(bands.span, format!("a film has at most {MOST_BANDS} buckets")));
        return Vec::new();
    }
    let width = (greatest.value - least.value) / f64::from(bands.value);
    let name = |band: u32| {
        let middle = least.value + width * (f64::from(band) + 0.5);
        format!("S0.{}nm", format!("{middle:.3}").replace('.', ","))
    };
    let layer = |first: u32| {
        let last = (first + 4).min(bands.value);
        let from = (least.value + width * f64::from(first)) as f32;
        LayerKind {
            recorded: Recorded::Light(Bands { first: from, width: width as f32, count: (last - first) as u8 }),
            average: Average::Samples,
            channels: (first..last).map(name).collect(),
        }
    };
    (0..bands.value).step_by(4).map(layer).collect()
}
