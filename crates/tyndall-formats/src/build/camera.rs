//! The camera and its film.

use std::path::Path;

use glam::{DMat4, DVec3};
use tyndall::{
    camera::{
        Batch, Camera, CameraModel, Distant, Element, IrradianceMeter, LensSystem, Orthographic, Perspective,
        RadianceMeter, Realistic, Spherical, SphericalMapping, Stop, Surface, Target, ThinLens, View,
    },
    film::{Filter, Kernel, Lobed},
    math::{Vec2, Vec3},
    shape::Geometry,
};

use super::{Builder, medium_id, shapes::Shapes};
use crate::{
    desc::{
        ApertureDesc, CameraDesc, CameraKind, DistantTarget, FilmDesc, FilterDesc, RealisticDesc, ShapeDesc,
        SphereMapping,
    },
    error::SceneError,
    image,
    source::Span,
};

/// Elements of a lens: more than any zoom has.
const MOST_ELEMENTS: usize = 200;
/// The largest lens file [bytes].
const LARGEST_LENS_FILE: u64 = 1 << 20;
/// Values a side of a stop that is drawn here.
const STOP_SIDE: usize = 256;

impl<'a> Builder<'a> {
    pub(super) fn camera(&mut self, shapes: &Shapes) -> Option<Camera> {
        let (camera, film) = (&self.desc.camera, &self.desc.film);
        let view = self.view(camera, film, shapes)?;
        // A meter's pixels are parts of its surface, which ends where they end.
        let is_meter = matches!(
            view.model,
            CameraModel::IrradianceMeter(_) | CameraModel::RadianceMeter(_) | CameraModel::Distant(_)
        );
        let filter = if is_meter { Filter::default() } else { self.filter(&film.filter, film.span)? };
        Some(Camera {
            view,
            width: film.width,
            height: film.height,
            filter,
            exposure: film.exposure as f32,
            medium: camera.medium.map(|m| medium_id(m.value)),
            layers: film.layers.iter().chain(&self.desc.integrator.layers).cloned().collect(),
        })
    }

    fn view(&mut self, camera: &'a CameraDesc, film: &FilmDesc, shapes: &Shapes) -> Option<View> {
        let window =
            camera.window(film.width, film.height).map(|w| [w.left, w.right, w.bottom, w.top].map(|v| v as f32));
        let mut to_world = camera.to_world;
        let model = match &camera.kind {
            CameraKind::Perspective { lens, .. } => CameraModel::Perspective(Perspective {
                window: window?,
                lens: lens.map(|lens| ThinLens { radius: lens.radius as f32, focus: lens.focus as f32 }),
            }),
            CameraKind::Orthographic { .. } => {
                // In double precision: a picture is the same whether its window or its space is wider.
                let w = camera.window(film.width, film.height)?;
                let half = if w.left == -w.right { w.right } else { 1.0 };
                to_world *= DMat4::from_scale(DVec3::new(half, half, 1.0));
                let window = [w.left, w.right, w.bottom, w.top].map(|v| (v / half) as f32);
                CameraModel::Orthographic(Orthographic { window })
            }
            CameraKind::Spherical { mapping } => CameraModel::Spherical(Spherical {
                mapping: match mapping {
                    SphereMapping::EqualArea => SphericalMapping::EqualArea,
                    SphereMapping::Equirectangular => SphericalMapping::Equirectangular,
                },
            }),
            CameraKind::Realistic(desc) => CameraModel::Realistic(Box::new(self.realistic(desc, film)?)),
            CameraKind::RadianceMeter => CameraModel::RadianceMeter(RadianceMeter),
            CameraKind::IrradianceMeter { shape } => {
                to_world = DMat4::IDENTITY;
                let pieces = shapes.meters.get(shape).cloned()?;
                match Surface::new(pieces) {
                    Some(surface) => CameraModel::IrradianceMeter(IrradianceMeter { surface }),
                    None => return self.fail(SceneError::at(camera.span, "this shape has no area to measure at")),
                }
            }
            CameraKind::Distant { target } => {
                let disk = shapes.geometry.bounds();
                let (centre, radius) = if disk.is_empty() {
                    (tyndall::math::Vec3::ZERO, 0.0)
                } else {
                    (disk.centre(), 0.5 * disk.extent().length())
                };
                let target = match target {
                    DistantTarget::Scene => Target::Disk,
                    DistantTarget::Point(p) => Target::Point(glam::DVec3::from_array(*p).as_vec3()),
                    DistantTarget::Shape(shape) => Target::Surface(self.surface_of(shape)?),
                };
                CameraModel::Distant(Distant { centre, radius, target })
            }
            CameraKind::Batch(cameras) => {
                to_world = DMat4::IDENTITY;
                CameraModel::Batch(self.batch(camera, cameras, film, shapes)?)
            }
        };
        let to_world = self.transform(to_world, camera.span)?;
        let view = View { to_world, model, near: 0.0 };
        let near = camera.near as f32;
        // Where nothing is nearer, rays begin at the eye, as they do in renderers without a near clip.
        Some(if near > 0.0 && may_be_nearer(&view, &shapes.geometry, near) { View { near, ..view } } else { view })
    }

    /// The surface of a shape that is not part of the scene.
    fn surface_of(&mut self, shape: &'a ShapeDesc) -> Option<Surface> {
        let pieces = self.surface_pieces(shape)?;
        Surface::new(pieces).or_else(|| self.fail(SceneError::at(shape.span, "this shape has no area to be seen")))
    }

    fn batch(
        &mut self,
        batch: &CameraDesc,
        cameras: &'a [CameraDesc],
        film: &FilmDesc,
        shapes: &Shapes,
    ) -> Option<Batch> {
        let width = film.width / cameras.len().max(1) as u32;
        let part = FilmDesc { width: width.max(1), ..film.clone() };
        let mut views = Vec::new();
        for camera in cameras {
            if let Some(medium) = camera.medium.filter(|m| batch.medium.is_none_or(|b| b.value != m.value)) {
                return self.fail(
                    SceneError::at(medium.span, "the sensors of a batch are in the medium of the batch")
                        .help("name the medium in the batch itself"),
                );
            }
            views.push(self.view(camera, &part, shapes)?);
        }
        Some(Batch { views })
    }

    fn filter(&mut self, filter: &FilterDesc, span: Span) -> Option<Filter> {
        let radii = |r: [f64; 2]| r.map(|v| v as f32);
        let mut lobed = |kernel, radius| match Lobed::new(kernel, radii(radius)) {
            Some(lobed) => Some(Filter::Lobed(lobed)),
            None => self.fail(
                SceneError::at(span, "this filter has no positive integral: its lobes cancel")
                    .help("use smaller B and C, or a wider tau"),
            ),
        };
        match *filter {
            FilterDesc::Box { radius } => Some(Filter::Box { radius: radii(radius) }),
            FilterDesc::Triangle { radius } => Some(Filter::Triangle { radius: radii(radius) }),
            FilterDesc::Gaussian { radius, sigma } => {
                Some(Filter::Gaussian { radius: radii(radius), sigma: sigma as f32 })
            }
            FilterDesc::Mitchell { radius, b, c } => lobed(Kernel::Mitchell { b, c }, radius),
            FilterDesc::Sinc { radius, tau } => lobed(Kernel::Sinc { tau }, radius),
        }
    }

    fn realistic(&mut self, desc: &RealisticDesc, film: &FilmDesc) -> Option<Realistic> {
        let at = desc.lens.span;
        let mut elements = match read_lens(&desc.lens.value) {
            Ok(elements) => elements,
            Err(problem) => {
                let message = format!("{}: {problem}", desc.lens.value.display());
                return self.fail(SceneError::at(at, message));
            }
        };
        for element in &mut elements {
            if element.curvature == 0.0 {
                element.aperture = element.aperture.min(desc.aperture_diameter / 2.0);
            }
            for length in [&mut element.curvature, &mut element.thickness, &mut element.aperture] {
                *length *= desc.millimetre;
            }
        }
        let lens = LensSystem { elements, stop: self.stop(&desc.aperture)? };
        let Some(lens) = lens.focused(desc.focus_distance.value) else {
            return self.fail(
                SceneError::at(desc.focus_distance.span, "the lens cannot be focused at this distance")
                    .help("set a greater \"focusdistance\", in scene units from the film"),
            );
        };
        let aspect = f64::from(film.width) / f64::from(film.height);
        match Realistic::new(lens, film.diagonal * desc.millimetre, aspect) {
            Some(camera) => Some(camera),
            None => self.fail(SceneError::at(at, "no light gets through this lens to the film")),
        }
    }

    fn stop(&mut self, aperture: &ApertureDesc) -> Option<Stop> {
        Some(match aperture {
            ApertureDesc::Circular => Stop::Circular,
            ApertureDesc::Gaussian => drawn(|x, y| (-x * x - y * y).exp() - (-1.0f64).exp()),
            ApertureDesc::Square => drawn(|x, y| if x.abs() < 0.5 && y.abs() < 0.5 { 1.0 } else { 0.0 }),
            ApertureDesc::Pentagon => drawn(|x, y| within(&polygon(5, |_| 0.8), x, y)),
            ApertureDesc::Star => {
                let inner = 72f64.to_radians().cos() / 36f64.to_radians().cos();
                // pbrt's first point lies on +x; turned by a quarter it is the pentagon's.
                let star = polygon(10, |i| if i % 2 == 1 { 1.0 } else { inner });
                drawn(|x, y| within(&star, -y, x))
            }
            ApertureDesc::Image(file) => {
                let picture = match image::read_image(&file.value) {
                    Ok(picture) if picture.width == picture.height => picture,
                    Ok(_) => return self.fail(SceneError::at(file.span, "the picture of an aperture is square")),
                    Err(error) => return self.fail(SceneError::at(file.span, error.to_string())),
                };
                let rows = picture.pixels.chunks(picture.width as usize).rev();
                let values: Vec<f64> = rows.flatten().map(|p| p.iter().map(|v| f64::from(*v) / 3.0).sum()).collect();
                bright_as_a_disk(picture.width as usize, values)
            }
        })
    }
}

/// A stop of the transmittance `f(x, y)` over [−1, 1]², y up in its own picture. pbrt turns that picture over.
fn drawn(f: impl Fn(f64, f64) -> f64) -> Stop {
    let at = |i: usize| (i as f64 + 0.5) / STOP_SIDE as f64 * 2.0 - 1.0;
    let values = (0..STOP_SIDE * STOP_SIDE).map(|i| f(at(i % STOP_SIDE), -at(i / STOP_SIDE)).max(0.0)).collect();
    bright_as_a_disk(STOP_SIDE, values)
}

/// Scaled so that its mean over the square is that of the disk in it.
fn bright_as_a_disk(n: usize, values: Vec<f64>) -> Stop {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let scale = std::f64::consts::FRAC_PI_4 / mean;
    Stop::Image { n, values: values.into_iter().map(|v| (v * scale) as f32).collect() }
}

/// Corners at equal angles, the first on +y.
fn polygon(corners: usize, radius: impl Fn(usize) -> f64) -> Vec<[f64; 2]> {
    let corner = |i: usize| {
        let (sin, cos) = (std::f64::consts::TAU * i as f64 / corners as f64).sin_cos();
        [-sin * radius(i), cos * radius(i)]
    };
    (0..corners).map(corner).collect()
}

/// 1 inside of a polygon, 0 outside: by the edges that a ray along +x crosses.
fn within(polygon: &[[f64; 2]], x: f64, y: f64) -> f64 {
    let edges = polygon.iter().zip(polygon.iter().cycle().skip(1));
    let crosses = |(a, b): &(&[f64; 2], &[f64; 2])| {
        (a[1] <= y) != (b[1] <= y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
    };
    (edges.filter(crosses).count() % 2) as f64
}

/// Four numbers an element: radius of curvature, thickness, index, diameter [mm]; `#` starts a comment.
fn read_lens(path: &Path) -> Result<Vec<Element>, String> {
    let size = std::fs::metadata(path).map_err(|e| e.to_string())?.len();
    if size > LARGEST_LENS_FILE {
        return Err(format!("{size} bytes are too many for a lens"));
    }
    parse_lens(&std::fs::read_to_string(path).map_err(|e| e.to_string())?)
}

fn parse_lens(text: &str) -> Result<Vec<Element>, String> {
    let mut numbers = Vec::new();
    for (row, line) in text.lines().enumerate() {
        for word in line.split('#').next().unwrap_or_default().split_whitespace() {
            let number = word.parse::<f64>().ok().filter(|v| v.is_finite());
            numbers.push(number.ok_or_else(|| format!("line {}: \"{word}\" is no number", row + 1))?);
        }
    }
    if numbers.is_empty() || numbers.len() % 4 != 0 || numbers.len() > 4 * MOST_ELEMENTS {
        return Err(format!(
            "a lens has four numbers for each of up to {MOST_ELEMENTS} elements, not {}",
            numbers.len()
        ));
    }
    let element = |n: &[f64]| Element { curvature: n[0], thickness: n[1], eta: n[2], aperture: n[3] / 2.0 };
    let elements: Vec<_> = numbers.chunks(4).map(element).collect();
    match elements.iter().position(|e| e.thickness < 0.0 || e.eta < 0.0 || e.aperture <= 0.0) {
        Some(i) => Err(format!("element {}: thickness and index are at least 0, a diameter is positive", i + 1)),
        None => Ok(elements),
    }
}

/// Whether a surface may be at a depth between the eye and `near`: around the eye, or for parallel rays in the whole scene.
fn may_be_nearer(view: &View, geometry: &Geometry, near: f32) -> bool {
    let at = |x: f32, y: f32| view.ray(Vec2::new(x, y), Vec2::splat(0.5)).ray;
    let eye = at(0.5, 0.5).origin;
    let depth = view.to_world.vector(Vec3::Z);
    if matches!(view.model, CameraModel::Orthographic(_)) {
        let depths = geometry.bounds().corners().map(|corner| (corner - eye).dot(depth) / depth.length_squared());
        return depths.into_iter().fold(f32::INFINITY, f32::min) < near;
    }
    // The farthest corner of the near plane, and the lens.
    let cosines = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(x, y)| at(x, y).dir.dot(depth));
    let lens = [0.0, 0.5, 1.0].map(|u| view.ray(Vec2::splat(0.5), Vec2::new(u, 0.0)).ray.origin.distance(eye));
    let reach = near * depth.length_squared() / cosines.into_iter().fold(f32::INFINITY, f32::min)
        + 2.0 * lens.into_iter().fold(0.0, f32::max);
    geometry.clearance(eye, reach) < reach
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lens_file_is_four_numbers_an_element() {
        let lens = parse_lens("# radius thickness eta diameter\n30 4 1.6 24\n0 3 0 12 # stop\n").unwrap();
        assert_eq!(lens[0], Element { curvature: 30.0, thickness: 4.0, eta: 1.6, aperture: 12.0 });
        assert_eq!((lens.len(), lens[1].curvature, lens[1].aperture), (2, 0.0, 6.0));
        for bad in ["", "1 2 3", "1 2 3 x", "1 -2 1 4", "1 2 1 0", "1 2 nan 4"] {
            assert!(parse_lens(bad).is_err(), "{bad}");
        }
    }

    /// Areas in the square [−1, 1]²: the pentagon of radius r has 5/2·sin 72°·r², the star of outer radius 1 five times
    /// sin 36° times its inner radius.
    #[test]
    fn stops_have_their_areas_and_the_brightness_of_a_disk() {
        let share = |stop: &Stop| match stop {
            Stop::Image { values, .. } => values.iter().filter(|v| **v > 0.0).count() as f64 / values.len() as f64,
            Stop::Circular => panic!(),
        };
        let inner = 72f64.to_radians().cos() / 36f64.to_radians().cos();
        let pentagon = drawn(|x, y| within(&polygon(5, |_| 0.8), x, y));
        let star = drawn(|x, y| within(&polygon(10, |i| if i % 2 == 1 { 1.0 } else { inner }), x, y));
        assert!((share(&pentagon) - 2.5 * 72f64.to_radians().sin() * 0.64 / 4.0).abs() < 2e-3);
        assert!((share(&star) - 5.0 * 36f64.to_radians().sin() * inner / 4.0).abs() < 2e-3);
        let Stop::Image { values, .. } = &star else { panic!() };
        let mean = values.iter().map(|v| f64::from(*v)).sum::<f64>() / values.len() as f64;
        assert!((mean - std::f64::consts::FRAC_PI_4).abs() < 1e-6);
    }
}
