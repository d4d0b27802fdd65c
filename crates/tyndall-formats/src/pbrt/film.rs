//! `Film` and `PixelFilter`.

use tyndall::lpe::named;

use super::Reader;
use super::layers::{gbuffer, spectral};
use super::params::Params;
use super::parser::Statement;
use crate::desc::{CropDesc, FilmDesc, FilterDesc, PartsDesc};
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
            parts: PartsDesc::default(),
            exposure: 1.0,
        }
    }
}

const FILMS: [&str; 3] = ["rgb", "gbuffer", "spectral"];

/// The largest side of an image \[pixels\].
const MAX_SIDE: u32 = 1 << 16;

impl Reader {
    pub(super) fn film(&mut self, mut s: Statement<'_>) {
        let name = s.names[0].clone();
        if !FILMS.contains(&&*name.value) {
            return self.unknown_kind("film", &name, &FILMS, &[]);
        }
        if name.value == "gbuffer" {
            let reason = "dzdx and dzdy are from pixel to pixel, in pbrt over max(1/8, 1/√spp) of that; for variances the \
                          layer `stderr` has the standard errors";
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
        p.ignore("maxcomponentvalue", "no sample is clamped: clamped, the image is too dark");
        sensor(&mut p);
        let layers = match &*name.value {
            "gbuffer" => gbuffer(&mut p),
            "spectral" => spectral(&mut p),
            _ => Vec::new(),
        };
        let parts = parts(&mut p);
        self.finish_params(p);
        if self.settings.film.is_some() {
            self.ignore(s.whole, "it replaces the film before");
        }
        let filter = FilmDesc::pbrt_default(s.whole).filter;
        self.settings.film =
            Some(FilmDesc { span: s.whole, width, height, crop, filename, diagonal, filter, layers, parts, exposure });
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

/// pbrt's cameras whose response has been measured.
const SENSORS: [&str; 18] = [
    "cie1931",
    "canon_eos_100d",
    "canon_eos_1dx_mkii",
    "canon_eos_200d",
    "canon_eos_200d_mkii",
    "canon_eos_5d",
    "canon_eos_5d_mkii",
    "canon_eos_5d_mkiii",
    "canon_eos_5d_mkiv",
    "canon_eos_5ds",
    "canon_eos_m",
    "hasselblad_l1d_20c",
    "nikon_d810",
    "nikon_d850",
    "sony_ilce_6400",
    "sony_ilce_7m3",
    "sony_ilce_7rm3",
    "sony_ilce_9",
];

/// The observer of CIE 1931; the curves of cameras are others' and not part of tyndall.
fn sensor(p: &mut Params) {
    let Some(sensor) = p.string_opt("sensor") else { return };
    let name = &*sensor.value;
    if !SENSORS.contains(&name) {
        let error = SceneError::at(sensor.span, format!("there is no sensor \"{name}\""));
        p.error(error.suggest(name, SENSORS));
    } else if name != SENSORS[0] {
        p.error(
            SceneError::not_yet(sensor.span, format!("the response of the camera \"{name}\" is not part of tyndall"))
                .help(
                    "its measured curves may not be passed on; \"cie1931\", the default, sees colours as the eye does",
                ),
        );
    }
}

/// tyndall's own: parts of the light, by name or expression.
fn parts(p: &mut Params) -> PartsDesc {
    let words = p.any_strings("layers");
    let Some(first) = words.first() else { return PartsDesc::default() };
    let span = Some(first.span);
    match named::items(words.iter().map(|word| &*word.value)) {
        Ok(layers) => PartsDesc { span, layers },
        Err(error) => {
            p.error(SceneError::at(first.span, error.to_string()));
            PartsDesc::default()
        }
    }
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
