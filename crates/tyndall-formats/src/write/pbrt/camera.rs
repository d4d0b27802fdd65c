//! The camera: where the world is as seen from it.

use glam::{DMat4, DVec3};

use super::Pen;
use super::entity::Entity;
use crate::desc::{
    ApertureDesc, CameraDesc, CameraKind, FovAxis, FrameDesc, RealisticDesc, Spanned, SphereMapping, ThinLensDesc,
};
use crate::pbrt::state::look_at;
use crate::write::number::{doubles, shortest};
use crate::write::place::{Look, inverse_of, widened, width};

/// pbrt's mirror, for scenes that are right-handed.
fn mirror() -> DMat4 {
    DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0))
}

impl Pen<'_, '_> {
    pub(super) fn camera(&mut self) {
        let camera = &self.draft.desc.camera;
        if let Some(medium) = camera.medium {
            self.interface(None, Some(medium.value));
        }
        let width = self.view(camera);
        let mut entity = match &camera.kind {
            CameraKind::Perspective { fov, frame, lens } => self.perspective(camera, *fov, frame, *lens),
            CameraKind::Orthographic { frame } => self.orthographic(camera, frame, width),
            CameraKind::Spherical { mapping } => {
                let mut entity = Entity::new("Camera", &["spherical"]);
                if *mapping == SphereMapping::Equirectangular {
                    entity.string("mapping", "equirectangular");
                }
                entity
            }
            CameraKind::Realistic(realistic) => self.realistic(realistic),
            CameraKind::IrradianceMeter { .. } => return self.lacks(camera.span, "the sensor \"irradiancemeter\""),
            CameraKind::Distant { .. } => return self.lacks(camera.span, "the sensor \"distant\""),
            CameraKind::RadianceMeter => return self.lacks(camera.span, "the sensor \"radiancemeter\""),
            CameraKind::Batch(_) => return self.lacks(camera.span, "several sensors in one image"),
        };
        entity.float_unless("near", camera.near, 0.0);
        self.entity(entity);
    }

    /// The transformation from the world to the camera, but for how much wider it sees, which is given back.
    fn view(&mut self, camera: &CameraDesc) -> f64 {
        let to_world = camera.to_world;
        if to_world == DMat4::IDENTITY {
            return 1.0;
        }
        let mirrored = to_world.determinant() < 0.0;
        let after = if mirrored { mirror() } else { DMat4::IDENTITY };
        // Only parallel rays can see more in another way.
        let width = if matches!(camera.kind, CameraKind::Orthographic { .. }) { width(to_world) } else { 1.0 };
        let look = Look::at(to_world, |l| Some(look_at(l.eye, l.target, l.up)? * after * widened(width)));
        let Some(look) = look else {
            self.matrix(inverse_of(to_world));
            return 1.0;
        };
        if mirrored {
            self.sheet.line("Scale -1 1 1");
        }
        let [eye, target, up] = [look.eye, look.target, look.up].map(|v| doubles(&v.to_array()));
        self.sheet.line(&format!("LookAt {eye}  {target}  {up}"));
        width
    }

    fn perspective(
        &mut self,
        camera: &CameraDesc,
        fov: Spanned<f64>,
        frame: &FrameDesc,
        lens: Option<ThinLensDesc>,
    ) -> Entity {
        let mut entity = Entity::new("Camera", &["perspective"]);
        let fov = if frame.axis == FovAxis::Smaller || frame.screen_window.is_some() {
            fov.value
        } else {
            self.smaller_fov(camera)
        };
        entity.float_unless("fov", fov, 90.0);
        if frame.offset != [0.0; 2] {
            self.lacks(camera.span, "a principal point beside the middle of the picture");
        }
        window(&mut entity, frame);
        if let Some(lens) = lens {
            entity.float("lensradius", lens.radius);
            entity.float_unless("focaldistance", lens.focus, 1e6);
        }
        entity
    }

    /// The field of view of the shorter side.
    fn smaller_fov(&self, camera: &CameraDesc) -> f64 {
        let film = &self.draft.desc.film;
        let seen = |camera: &CameraDesc| {
            let window = camera.window(film.width, film.height);
            window.map(|w| [w.left, w.right, w.bottom, w.top].map(|v| v as f32))
        };
        let with = |fov: f64| {
            let kind = match &camera.kind {
                CameraKind::Perspective { fov: given, frame, lens } => CameraKind::Perspective {
                    fov: given.map(|_| fov),
                    frame: FrameDesc { axis: FovAxis::Smaller, ..*frame },
                    lens: *lens,
                },
                other => other.clone(),
            };
            CameraDesc { kind, ..camera.clone() }
        };
        let half = camera.window(film.width, film.height).map_or(1.0, |w| w.right.min(w.top));
        let fov = 2.0 * half.atan().to_degrees();
        let same = |fov: f64| fov < 180.0 && seen(&with(fov)) == seen(camera);
        // Rounded once more, the tangent may end beside the one that is meant.
        let near = [0i64, 1, -1, 2, -2, 3, -3].map(|ulps| f64::from_bits(fov.to_bits().wrapping_add_signed(ulps)));
        shortest(near.into_iter().find(|fov| same(*fov)).unwrap_or(fov), same)
    }

    /// Half of pbrt's shorter side is 1, and of the others another one may be.
    fn orthographic(&mut self, camera: &CameraDesc, frame: &FrameDesc, width: f64) -> Entity {
        let mut entity = Entity::new("Camera", &["orthographic"]);
        let film = &self.draft.desc.film;
        let smaller = FrameDesc { axis: FovAxis::Smaller, ..*frame };
        let as_smaller = CameraDesc { kind: CameraKind::Orthographic { frame: smaller }, ..camera.clone() };
        let [wanted, found] = [camera, &as_smaller].map(|camera| camera.window(film.width, film.height));
        match wanted.filter(|_| wanted != found || width != 1.0) {
            Some(w) => entity.list("float", "screenwindow", &[w.left, w.right, w.bottom, w.top].map(|v| v * width)),
            None => window(&mut entity, frame),
        }
        entity
    }

    fn realistic(&mut self, realistic: &RealisticDesc) -> Entity {
        let mut entity = Entity::new("Camera", &["realistic"]);
        let lens = self.draft.relative(&realistic.lens.value, realistic.lens.span);
        entity.string("lensfile", &lens);
        entity.float_unless("aperturediameter", realistic.aperture_diameter, 1.0);
        entity.float_unless("focusdistance", realistic.focus_distance.value, 10.0);
        match &realistic.aperture {
            ApertureDesc::Circular => {}
            ApertureDesc::Gaussian => entity.string("aperture", "gaussian"),
            ApertureDesc::Square => entity.string("aperture", "square"),
            ApertureDesc::Pentagon => entity.string("aperture", "pentagon"),
            ApertureDesc::Star => entity.string("aperture", "star"),
            ApertureDesc::Image(file) => {
                let name = self.draft.relative(&file.value, file.span);
                entity.string("aperture", &name);
            }
        }
        entity
    }
}

/// What of the view is in the picture, where it is not the film's own part.
fn window(entity: &mut Entity, frame: &FrameDesc) {
    if let Some(aspect) = frame.aspect {
        entity.float("frameaspectratio", aspect.value);
    }
    if let Some(window) = frame.screen_window {
        entity.list("float", "screenwindow", &window.value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_in_words_is_the_same_view() {
        let eye = DVec3::new(1.0, -5.0, 2.2);
        let target = DVec3::new(0.0, 0.0, 0.8);
        let to_world = look_at(eye, target, DVec3::Z).unwrap() * mirror();
        let look = Look::at(to_world, |l| Some(look_at(l.eye, l.target, l.up)? * mirror())).unwrap();
        assert_eq!(look, Look { eye, target, up: DVec3::Z });
    }
}
