//! Sensors, with film, filter and sampler; and the integrator.

use super::Pen;
use super::element::Element;
use super::emitter::point;
use super::placed;
use crate::desc::{
    CameraDesc, CameraKind, DistantTarget, FilmDesc, FilterDesc, FovAxis, FrameDesc, Spanned, ThinLensDesc,
};
use crate::mitsuba::{NEAR_CLIP, NO_NEAR_CLIP, layer_word};
use crate::write::number::double;
use glam::{DMat4, DVec3};
use tyndall::lpe::PathLayer;

impl Pen<'_, '_> {
    pub(super) fn integrator(&mut self) -> Element {
        let integrator = &self.draft.desc.integrator;
        let word = match integrator.name.value.as_str() {
            word @ ("path" | "volpath" | "volpathmis" | "ptracer" | "prb" | "prb_basic" | "prb_projective"
            | "prbvolpath") => word,
            // Of the light that is scattered once.
            "direct" | "direct_projective" | "depth" | "simplepath" | "randomwalk" => "path",
            "lightpath" => "ptracer",
            _ => "volpath",
        };
        let mut element = Element::plugin("integrator", word);
        if let Some(depth) = integrator.max_depth {
            // Mitsuba counts the segments of a path.
            element.integer("max_depth", i64::from(depth.value) + 1);
        }
        if let Some(grains) = integrator.explicit_grains {
            element.integer("explicit_grains", grains.value.into());
        }
        if let Some(depth) = integrator.rr_depth {
            element.integer("rr_depth", depth.value.into());
        }
        if integrator.hide_emitters {
            element.boolean("hide_emitters", true);
        }
        let layers = &integrator.layers;
        if layers.is_empty() {
            return element;
        }
        let words: Vec<_> = layers.iter().filter_map(layer_word).collect();
        if words.len() != layers.len() {
            self.lacks(integrator.name.span, "one of the layers of the film");
        }
        let aovs = Element::parameter("string", "aovs", &words.join(", "));
        Element::plugin("integrator", "aov").around(aovs).around(element)
    }

    /// The sensor; or the one that belongs to a shape, with the index of that.
    pub(super) fn sensor(&mut self) -> (Option<Element>, Option<(usize, Element)>) {
        let camera = &self.draft.desc.camera;
        let Some(mut sensor) = self.view(camera) else { return (None, None) };
        sensor.push(self.film());
        sensor.push(self.sampler());
        match &camera.kind {
            CameraKind::IrradianceMeter { shape } => (None, Some((*shape, sensor))),
            _ => (Some(sensor), None),
        }
    }

    fn view(&mut self, camera: &CameraDesc) -> Option<Element> {
        // Its +x points to the left.
        let to_world = camera.to_world * DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        let mut element = match &camera.kind {
            CameraKind::Perspective { fov, frame, lens } => {
                let mut element = self.perspective(camera, *fov, frame, *lens);
                element.extend(placed(to_world));
                element
            }
            CameraKind::Orthographic { frame } => {
                let mut element = Element::plugin("sensor", "orthographic");
                element.extend(placed(to_world * self.orthographic_scale(camera, frame)));
                element
            }
            CameraKind::RadianceMeter => {
                let mut element = Element::plugin("sensor", "radiancemeter");
                element.extend(placed(to_world));
                element
            }
            CameraKind::Distant { target } => {
                let mut element = Element::plugin("sensor", "distant");
                element.extend(placed(to_world));
                match target {
                    DistantTarget::Scene => {}
                    DistantTarget::Point(p) => element.push(point("target", DVec3::from_array(*p))),
                    DistantTarget::Shape(shape) => element.extend(self.target(shape)),
                }
                element
            }
            CameraKind::IrradianceMeter { .. } => Element::plugin("sensor", "irradiancemeter"),
            CameraKind::Batch(cameras) => {
                let mut element = Element::plugin("sensor", "batch");
                for camera in cameras {
                    element.extend(self.view(camera));
                }
                element
            }
            CameraKind::Spherical { .. } => {
                self.lacks(camera.span, "a camera that sees all around");
                return None;
            }
            CameraKind::Realistic(_) => {
                self.lacks(camera.span, "a camera behind a lens of many elements");
                return None;
            }
        };
        if matches!(camera.kind, CameraKind::Perspective { .. } | CameraKind::Orthographic { .. }) {
            let near = if camera.near == 0.0 { NO_NEAR_CLIP } else { camera.near };
            element.float_unless("near_clip", near, NEAR_CLIP);
        }
        if let Some(medium) = camera.medium {
            element.push(self.medium_ref(medium.value));
        }
        Some(element)
    }

    fn perspective(
        &mut self,
        camera: &CameraDesc,
        fov: Spanned<f64>,
        frame: &FrameDesc,
        lens: Option<ThinLensDesc>,
    ) -> Element {
        let mut element = Element::plugin("sensor", if lens.is_some() { "thinlens" } else { "perspective" });
        element.extend(field_of_view(fov.value, frame.axis));
        if lens.is_none() {
            element.float_unless("principal_point_offset_x", frame.offset[0], 0.0);
            element.float_unless("principal_point_offset_y", frame.offset[1], 0.0);
        }
        self.whole_window(camera, frame);
        if let Some(lens) = lens {
            element.float("aperture_radius", lens.radius);
            element.float("focus_distance", lens.focus);
        }
        element
    }

    /// Mitsuba's picture is that of the film.
    fn whole_window(&mut self, camera: &CameraDesc, frame: &FrameDesc) {
        let film = &self.draft.desc.film;
        let whole = FrameDesc { offset: frame.offset, ..FrameDesc::of_film(frame.axis) };
        let kind = match &camera.kind {
            CameraKind::Perspective { fov, lens, .. } => {
                CameraKind::Perspective { fov: *fov, frame: whole, lens: *lens }
            }
            _ => CameraKind::Orthographic { frame: whole },
        };
        let whole = CameraDesc { kind, ..camera.clone() };
        if whole.window(film.width, film.height) != camera.window(film.width, film.height) {
            let span = frame.screen_window.map(|w| w.span).or(frame.aspect.map(|a| a.span)).unwrap_or(camera.span);
            self.lacks(span, "a picture that is not the whole view");
        }
    }

    /// Half of Mitsuba's width is 1: what makes it the width that is meant.
    fn orthographic_scale(&mut self, camera: &CameraDesc, frame: &FrameDesc) -> DMat4 {
        let film = &self.draft.desc.film;
        let Some(w) = camera.window(film.width, film.height) else { return DMat4::IDENTITY };
        let aspect = f64::from(film.width) / f64::from(film.height);
        let centred = w.left == -w.right && w.bottom == -w.top && (w.right / w.top / aspect - 1.0).abs() < 1e-6;
        if !centred {
            let span = frame.screen_window.map(|w| w.span).or(frame.aspect.map(|a| a.span)).unwrap_or(camera.span);
            self.lacks(span, "a picture that is not the whole view");
        }
        DMat4::from_scale(DVec3::new(w.right, w.right, 1.0))
    }

    fn film(&mut self) -> Element {
        let film = &self.draft.desc.film;
        let mut element = Element::plugin("film", "hdrfilm");
        element.integer("width", film.width.into());
        element.integer("height", film.height.into());
        if let Some(c) = film.crop {
            let crop = [
                ("crop_offset_x", c.x0),
                ("crop_offset_y", c.y0),
                ("crop_width", c.x1 - c.x0),
                ("crop_height", c.y1 - c.y0),
            ];
            for (name, v) in crop {
                element.integer(name, v.into());
            }
        }
        element.extend(self.filter(film));
        if film.exposure != 1.0 {
            let what = format!("an exposure of {} (scale the lights by it)", film.exposure);
            self.lacks(film.span, &what);
        }
        if !film.layers.is_empty() {
            self.lacks(film.span, "a \"gbuffer\"");
        }
        if !film.parts.layers.is_empty() {
            let words: Vec<_> = film.parts.layers.iter().map(PathLayer::word).collect();
            element.push(Element::parameter("string", "layers", &words.join(",")));
        }
        element
    }

    fn filter(&mut self, film: &FilmDesc) -> Option<Element> {
        let with = |kind, name: &str, value: f64, default: f64| {
            let mut element = Element::plugin("rfilter", kind);
            element.float_unless(name, value, default);
            element
        };
        let element = match film.filter {
            FilterDesc::Gaussian { radius: [2.0, 2.0], sigma: 0.5 } => return None,
            FilterDesc::Box { radius: [0.5, 0.5] } => Element::plugin("rfilter", "box"),
            FilterDesc::Triangle { radius: [x, y] } if x == y => with("tent", "radius", x, 1.0),
            FilterDesc::Gaussian { radius, sigma } if radius == [4.0 * sigma; 2] => {
                with("gaussian", "stddev", sigma, 0.5)
            }
            FilterDesc::Mitchell { radius: [2.0, 2.0], b: 0.0, c: 0.5 } => Element::plugin("rfilter", "catmullrom"),
            FilterDesc::Mitchell { radius: [2.0, 2.0], b, c } => {
                let third = 1.0 / 3.0;
                let mut element = with("mitchell", "B", b, third);
                element.float_unless("C", c, third);
                element
            }
            FilterDesc::Sinc { radius: [x, y], tau } if x == y && x == tau && x.fract() == 0.0 && x < 1e6 => {
                let lobes = Element::parameter("integer", "lobes", &double(x));
                Element::plugin("rfilter", "lanczos").around(lobes)
            }
            // What pbrt takes where a scene says nothing is no word of it.
            FilterDesc::Gaussian { radius: [1.5, 1.5], sigma: 0.5 } => {
                let message =
                    "Mitsuba cuts its Gaussian filter off at 2 pixels, pbrt at 1.5: pixels are a little softer";
                self.draft.differs(film.span, message);
                return None;
            }
            FilterDesc::Box { .. } => return self.no_filter(film, "a box filter that is not one pixel wide"),
            FilterDesc::Triangle { .. } | FilterDesc::Mitchell { .. } | FilterDesc::Sinc { .. } => {
                return self.no_filter(film, "a filter of these radii");
            }
            FilterDesc::Gaussian { .. } => {
                return self.no_filter(film, "a Gaussian filter that does not end at four standard deviations");
            }
        };
        Some(element)
    }

    fn no_filter(&mut self, film: &FilmDesc, what: &str) -> Option<Element> {
        self.lacks(film.span, what);
        None
    }

    fn sampler(&mut self) -> Element {
        let desc = self.draft.desc;
        let word = match desc.sampler.kind.value.as_str() {
            word @ ("independent" | "stratified" | "multijitter" | "orthogonal" | "ldsampler") => word,
            "pmj02bn" => "multijitter",
            _ => "ldsampler",
        };
        let mut element = Element::plugin("sampler", word);
        element.integer("sample_count", desc.sampler.spp.value.into());
        if let Some(seed) = desc.sampler.seed.or(desc.options.seed) {
            match u32::try_from(seed.value) {
                Ok(seed) => element.integer("seed", seed.into()),
                Err(_) => self.lacks(seed.span, "a seed of more than 32 bits"),
            }
        }
        element
    }
}

/// A field of view, and the side that it spans if it is not the width.
pub(super) fn field_of_view(fov: f64, axis: FovAxis) -> impl Iterator<Item = Element> {
    let axis = match axis {
        FovAxis::X => None,
        FovAxis::Y => Some("y"),
        FovAxis::Smaller => Some("smaller"),
        FovAxis::Larger => Some("larger"),
        FovAxis::Diagonal => Some("diagonal"),
    };
    let fov = Element::parameter("float", "fov", &double(fov));
    std::iter::once(fov).chain(axis.map(|axis| Element::parameter("string", "fov_axis", axis)))
}
