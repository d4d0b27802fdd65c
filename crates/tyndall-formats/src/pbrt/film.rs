//! `Film` and `PixelFilter`.

use tyndall::{
    feature::{Facing, Feature, Space},
    film::{Average, LayerKind},
};

use super::Reader;
use super::params::Params;
use super::parser::Statement;
use crate::desc::{CropDesc, FilmDesc, FilterDesc};
use crate::error::SceneError;
use crate::source::Span;

impl FilmDesc {
    /// The film of a file that has none.
    pub(super) fn pbrt_default(span: Span) -> Self {
        let filter = FilterDesc::Gaussian { radius: [1.5, 1.5], sigma: 0.5 };
        Self {
            span,
            width: 1280,
            height: 720,
            crop: None,
            filename: None,
            diagonal: 35.0,
            filter,
            layers: Vec::new(),
            exposure: 1.0,
        }
    }
}

/// The largest side of an image \[pixels\].
const MAX_SIDE: u32 = 1 << 16;

impl Reader {
    pub(super) fn film(&mut self, mut s: Statement<'_>) {
        let name = s.names[0].clone();
        if !["rgb", "gbuffer"].contains(&&*name.value) {
            return self.unknown_kind("film", &name, &["rgb", "gbuffer"], &["spectral"]);
        }
        if name.value == "gbuffer" {
            let reason = "dzdx, dzdy and variances are not written: the layer `stderr` has the standard errors";
            self.ignore(name.span, reason);
        }
        let mut p = self.params("film", &mut s, &[]);
        let [width, height] = ["xresolution", "yresolution"].map(|side| {
            let pixels = p.count(side, if side == "xresolution" { 1280 } else { 720 }, 1);
            if pixels.value > MAX_SIDE {
                let message = format!("an image of {} pixels a side is too large", pixels.value);
                p.error(SceneError::at(pixels.span, message).help(format!("at most {MAX_SIDE}")));
            }
            pixels.value.min(MAX_SIDE)
        });
        let crop = crop(&mut p, width, height);
        let filename = p.string_opt("filename");
        let exposure = p.positive("iso", 100.0).value / 100.0;
        let diagonal = p.positive("diagonal", 35.0).value;
        p.ignore("savefp16", "images are written in single precision");
        p.later_unless("whitebalance", 0.0);
        p.later("maxcomponentvalue");
        if let Some(sensor) = p.string_opt("sensor")
            && sensor.value != "cie1931"
        {
            p.error(
                SceneError::not_yet(sensor.span, "measured sensors are not supported yet")
                    .help("use \"cie1931\", the default"),
            );
        }
        let layers = if name.value == "gbuffer" { gbuffer(&mut p) } else { Vec::new() };
        self.finish_params(p);
        if self.settings.film.is_some() {
            self.ignore(s.whole, "it replaces the film before");
        }
        let filter = FilmDesc::pbrt_default(s.whole).filter;
        self.settings.film =
            Some(FilmDesc { span: s.whole, width, height, crop, filename, diagonal, filter, layers, exposure });
    }

    pub(super) fn filter(&mut self, mut s: Statement<'_>) {
        let name = s.names[0].clone();
        let mut p = self.params("filter", &mut s, &[]);
        let mut radius = |default| [p.positive("xradius", default).value, p.positive("yradius", default).value];
        let filter = match &*name.value {
            "box" => FilterDesc::Box { radius: radius(0.5) },
            "triangle" => FilterDesc::Triangle { radius: radius(2.0) },
            "gaussian" => FilterDesc::Gaussian { radius: radius(1.5), sigma: p.positive("sigma", 0.5).value },
            "mitchell" => {
                let third = 1.0 / 3.0;
                FilterDesc::Mitchell { radius: radius(2.0), b: p.float("B", third).value, c: p.float("C", third).value }
            }
            "sinc" => FilterDesc::Sinc { radius: radius(4.0), tau: p.positive("tau", 3.0).value },
            _ => {
                let known = ["box", "triangle", "gaussian", "mitchell", "sinc"];
                return self.unknown_kind("filter", &name, &known, &[]);
            }
        };
        self.finish_params(p);
        self.settings.filter = Some(filter);
    }
}

/// The layers of pbrt's `gbuffer`, by their names there.
fn gbuffer(p: &mut Params) -> Vec<LayerKind> {
    let space = match p.string_opt("coordinatesystem") {
        Some(word) if word.value == "world" => Space::World,
        Some(word) if word.value != "camera" => {
            let error = SceneError::at(word.span, format!("there is no coordinate system \"{}\"", word.value));
            p.error(error.suggest(&word.value, ["camera", "world"]));
            Space::Camera
        }
        _ => Space::Camera,
    };
    gbuffer_layers(space)
}

/// The layers of a `gbuffer` in a space.
pub(crate) fn gbuffer_layers(space: Space) -> Vec<LayerKind> {
    let layer = |feature, average, channels: &[&str]| LayerKind {
        feature,
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
    ]
}

/// The part of the film that is rendered: `cropwindow` in parts of the image, or `pixelbounds`; the first wins.
fn crop(p: &mut Params, width: u32, height: u32) -> Option<CropDesc> {
    let bounds = p.integers("pixelbounds", 4);
    let window = p.floats("cropwindow", 4);
    let (crop, span) = match (window, bounds) {
        (Some(w), _) => {
            // pbrt takes the pixels from ceil(start) to ceil(end), whichever of the two is smaller.
            let pixel = |a: f64, side: u32| (a.clamp(0.0, 1.0) * f64::from(side)).ceil() as u32;
            let ordered = |a: f64, b: f64, side| (pixel(a.min(b), side), pixel(a.max(b), side));
            let ((x0, x1), (y0, y1)) =
                (ordered(w.value[0], w.value[1], width), ordered(w.value[2], w.value[3], height));
            (CropDesc { x0, y0, x1, y1 }, w.span)
        }
        (None, Some(b)) => {
            let pixel = |a: f64, side: u32| a.clamp(0.0, f64::from(side)) as u32;
            let v = &b.value;
            let crop = CropDesc {
                x0: pixel(v[0], width),
                x1: pixel(v[1], width),
                y0: pixel(v[2], height),
                y1: pixel(v[3], height),
            };
            (crop, b.span)
        }
        (None, None) => return None,
    };
    if crop.x0 >= crop.x1 || crop.y0 >= crop.y1 {
        p.error(SceneError::at(span, "this part of the image is empty").help("it is [ x_min x_max y_min y_max ]"));
        return None;
    }
    Some(crop)
}
