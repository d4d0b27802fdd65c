//! `Camera`.
//!
//! pbrt's transformation before `Camera` maps the world to the camera, which looks along +z with +x to the right of the image
//! and +y up: the camera convention of [`crate::desc`], so its inverse is taken as it is. pbrt takes worlds for left-handed;
//! a `Scale -1 1 1` that a right-handed scene puts first mirrors the matrix, and the image stays what pbrt shows.

use glam::DMat4;

use super::Reader;
use super::params::Params;
use super::parser::Statement;
use crate::desc::{
    ApertureDesc, CameraDesc, CameraKind, FovAxis, FrameDesc, RealisticDesc, SphereMapping, ThinLensDesc,
};
use crate::error::SceneError;
use crate::source::{Span, Spanned};

/// The cameras of pbrt.
const CAMERAS: [&str; 4] = ["orthographic", "perspective", "realistic", "spherical"];

impl CameraDesc {
    /// The camera of a file that has none.
    pub(super) fn pbrt_default(span: Span) -> Self {
        let frame = FrameDesc::of_film(FovAxis::Smaller);
        let kind = CameraKind::Perspective { fov: Spanned::new(90.0, span), frame, lens: None };
        Self { span, to_world: DMat4::IDENTITY, kind, near: 0.0, medium: None }
    }
}

impl Reader {
    pub(super) fn camera(&mut self, mut s: Statement<'_>) {
        let to_world = self.state.now.inverse;
        self.state.name("camera", to_world);
        let name = s.names[0].clone();
        if !CAMERAS.contains(&&*name.value) {
            return self.unknown_kind("camera", &name, &CAMERAS, &[]);
        }
        let mut p = self.params("camera", &mut s, &[]);
        let kind = match &*name.value {
            "perspective" => perspective(&mut p),
            "orthographic" => {
                // pbrt's lens in front of parallel rays gathers them all on the axis: it is no orthographic view.
                p.later_unless("lensradius", 0.0);
                p.ignore("focaldistance", "parallel rays are in focus everywhere");
                CameraKind::Orthographic { frame: frame(&mut p) }
            }
            "spherical" => spherical(&mut p),
            _ => realistic(&mut p),
        };
        let shutter = p.float("shutterclose", 1.0).value - p.float("shutteropen", 0.0).value;
        if shutter <= 0.0 {
            p.error(
                SceneError::at(p.span, "the shutter never opens")
                    .help("\"shutterclose\" must be after \"shutteropen\""),
            );
        }
        let near = match kind {
            CameraKind::Perspective { .. } | CameraKind::Orthographic { .. } => p.not_negative("near", 0.0).value,
            _ => 0.0,
        };
        self.finish_params(p);
        let medium = self.state.now.interface.and_then(|i| i.outside.map(|medium| Spanned::new(medium, i.span)));
        if self.settings.camera.is_some() {
            self.ignore(s.whole, "it replaces the camera before");
        }
        self.settings.shutter = Some(shutter);
        self.settings.camera = Some(CameraDesc { span: s.whole, to_world, kind, near, medium });
    }
}

fn frame(p: &mut Params) -> FrameDesc {
    let aspect = p.float_opt("frameaspectratio").filter(|a| a.value > 0.0);
    let screen_window = p.floats("screenwindow", 4).map(|w| w.map(|v| [v[0], v[1], v[2], v[3]]));
    if let Some(window) = &screen_window
        && (window.value[0] >= window.value[1] || window.value[2] >= window.value[3])
    {
        p.error(SceneError::at(window.span, "this screen window is empty").help("it is [ x_min x_max y_min y_max ]"));
    }
    FrameDesc { aspect, screen_window, ..FrameDesc::of_film(FovAxis::Smaller) }
}

fn perspective(p: &mut Params) -> CameraKind {
    let fov = p.float_in("fov", 90.0, "between 0 and 180 degrees", |v| v > 0.0 && v < 180.0);
    let radius = p.not_negative("lensradius", 0.0).value;
    let focus = p.positive("focaldistance", 1e6).value;
    let lens = (radius > 0.0).then_some(ThinLensDesc { radius, focus });
    CameraKind::Perspective { fov, frame: frame(p), lens }
}

fn spherical(p: &mut Params) -> CameraKind {
    for name in ["frameaspectratio", "screenwindow", "lensradius", "focaldistance"] {
        p.ignore(name, "a spherical camera sees all around a point");
    }
    let mapping = match p.string_opt("mapping") {
        Some(word) if word.value == "equirectangular" => SphereMapping::Equirectangular,
        Some(word) if word.value != "equalarea" => {
            let error = SceneError::at(word.span, format!("there is no mapping \"{}\"", word.value));
            p.error(error.suggest(&word.value, ["equalarea", "equirectangular"]));
            SphereMapping::EqualArea
        }
        _ => SphereMapping::EqualArea,
    };
    CameraKind::Spherical { mapping }
}

fn realistic(p: &mut Params) -> CameraKind {
    let lens = p.string_opt("lensfile").unwrap_or_else(|| {
        p.error(SceneError::at(p.span, "the camera \"realistic\" lacks a \"lensfile\""));
        Spanned::new(String::new(), p.span)
    });
    let lens = lens.map(|name| p.resolve(&name));
    let aperture = match p.string_opt("aperture") {
        None => ApertureDesc::Circular,
        Some(word) => match &*word.value {
            "" | "circular" => ApertureDesc::Circular,
            "gaussian" => ApertureDesc::Gaussian,
            "square" => ApertureDesc::Square,
            "pentagon" => ApertureDesc::Pentagon,
            "star" => ApertureDesc::Star,
            _ => ApertureDesc::Image(word.map(|name| p.resolve(&name))),
        },
    };
    CameraKind::Realistic(RealisticDesc {
        lens,
        aperture_diameter: p.positive("aperturediameter", 1.0).value,
        focus_distance: p.positive("focusdistance", 10.0),
        aperture,
        millimetre: 1e-3,
    })
}
