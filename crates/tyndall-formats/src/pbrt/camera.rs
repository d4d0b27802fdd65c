//! `Camera`.
//!
//! pbrt's transformation before `Camera` maps the world to the camera, which looks along +z with +x to the right of the image
//! and +y up: the camera convention of [`crate::desc`], so its inverse is taken as it is. pbrt takes worlds for left-handed;
//! a `Scale -1 1 1` that a right-handed scene puts first mirrors the matrix, and the image stays what pbrt shows.

use glam::DMat4;

use super::Reader;
use super::parser::Statement;
use crate::desc::{CameraDesc, FovAxis};
use crate::error::SceneError;
use crate::source::{Span, Spanned};

impl CameraDesc {
    /// The camera of a file that has none.
    pub(super) fn pbrt_default(span: Span) -> Self {
        Self {
            span,
            to_world: DMat4::IDENTITY,
            fov: Spanned::new(90.0, span),
            fov_axis: FovAxis::Smaller,
            aspect: None,
            screen_window: None,
            medium: None,
        }
    }
}

impl Reader {
    pub(super) fn camera(&mut self, mut s: Statement<'_>) {
        let to_world = self.state.now.ctm.inverse();
        self.state.name("camera", to_world);
        let name = s.names[0].clone();
        if name.value != "perspective" {
            let later = ["orthographic", "realistic", "spherical"];
            return self.unknown_kind("camera", &name, &["perspective"], &later);
        }
        let mut p = self.params("camera", &mut s, &[]);
        let fov = p.float_in("fov", 90.0, "between 0 and 180 degrees", |v| v > 0.0 && v < 180.0);
        let aspect = p.float_opt("frameaspectratio").filter(|a| a.value > 0.0);
        let screen_window = p.floats("screenwindow", 4).map(|w| w.map(|v| [v[0], v[1], v[2], v[3]]));
        if let Some(window) = &screen_window
            && (window.value[0] >= window.value[1] || window.value[2] >= window.value[3])
        {
            p.error(
                SceneError::at(window.span, "this screen window is empty").help("it is [ x_min x_max y_min y_max ]"),
            );
        }
        let shutter = p.float("shutterclose", 1.0).value - p.float("shutteropen", 0.0).value;
        if shutter <= 0.0 {
            p.error(
                SceneError::at(p.span, "the shutter never opens")
                    .help("\"shutterclose\" must be after \"shutteropen\""),
            );
        }
        p.later_unless("lensradius", 0.0);
        p.ignore("focaldistance", "the camera is a pinhole: everything is in focus");
        self.finish_params(p);
        let medium = self.state.now.interface.and_then(|i| i.outside.map(|medium| Spanned::new(medium, i.span)));
        if self.settings.camera.is_some() {
            self.ignore(s.whole, "it replaces the camera before");
        }
        self.settings.shutter = Some(shutter);
        self.settings.camera = Some(CameraDesc {
            span: s.whole,
            to_world,
            fov,
            fov_axis: FovAxis::Smaller,
            aspect,
            screen_window,
            medium,
        });
    }
}
