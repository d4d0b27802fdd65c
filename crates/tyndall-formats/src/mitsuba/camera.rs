//! `<sensor>`: `perspective`, `thinlens`, `orthographic`, `radiancemeter`, `irradiancemeter`, `distant`, `batch`; with
//! `<film>`, `<rfilter>` and `<sampler>`.
//!
//! Mitsuba's camera looks along its own +z with +x to the left of the image; a [`CameraDesc`] has +x to the right. So the
//! x axis is turned round: `to_world · diag(−1, 1, 1)`.

use glam::{DMat3, DMat4, DVec3};
use tyndall::lpe::named;

use super::object::{Object, Report};
use super::scene::Builder;
use super::tree::Element;
use super::words;
use crate::desc::{
    CameraDesc, CameraKind, CropDesc, DistantTarget, FilmDesc, FilterDesc, FovAxis, FrameDesc, Ignored, PartsDesc,
    SamplerDesc, ThinLensDesc,
};
use crate::error::SceneError;
use crate::source::{Span, Spanned};

/// What a sensor's response would be.
const NO_RESPONSE: &str =
    "a response weighs wavelengths, in Mitsuba's spectral variants only: here the film sees as the eye does";

/// The largest film \[pixels a side\].
const LARGEST_SIDE: u32 = 1 << 16;

/// The camera, its film and its sampler. `shape` is the shape that it stands on, if it does.
pub(super) fn sensor<'t>(
    builder: &mut Builder<'t>,
    element: &'t Element,
    shape: Option<usize>,
) -> Option<(CameraDesc, FilmDesc, SamplerDesc)> {
    let plugin = words::plugin(element, &mut builder.report)?;
    let mut object = builder.object(element);
    let film = match object.only("film", &mut builder.report) {
        Some(film) => film_desc(builder, film.element)?,
        None => default_film(element.span),
    };
    let sampler = match object.only("sampler", &mut builder.report) {
        Some(sampler) => sampler_desc(builder, sampler.element),
        None => None,
    };
    let sampler = sampler.unwrap_or_else(|| default_sampler(element.span));
    let camera = camera(builder, object, plugin, shape)?;
    match &camera.kind {
        CameraKind::RadianceMeter | CameraKind::Distant { .. } if (film.width, film.height) != (1, 1) => {
            let error = SceneError::at(film.span, format!("the film of a \"{plugin}\" has one pixel"));
            builder.report.errors.push(error.help("set \"width\" and \"height\" to 1"));
        }
        CameraKind::Batch(cameras) if !(film.width as usize).is_multiple_of(cameras.len()) => {
            let message = format!("{} sensors do not divide {} columns", cameras.len(), film.width);
            builder.report.errors.push(SceneError::at(film.span, message).help("set another \"width\""));
        }
        _ => {}
    }
    Some((camera, film, sampler))
}

/// A camera, its film and sampler left to the sensor that it belongs to.
/// The near clip of a sensor that has none written \[scene units\].
pub(crate) const NEAR_CLIP: f64 = 1e-2;
/// Stands for no near clip \[scene units\].
pub(crate) const NO_NEAR_CLIP: f64 = 1e-6;

fn camera<'t>(
    builder: &mut Builder<'t>,
    mut object: Object<'t>,
    plugin: &str,
    shape: Option<usize>,
) -> Option<CameraDesc> {
    let span = object.element.span;
    let medium = object.only("medium", &mut builder.report);
    let medium = medium.and_then(|m| Some(Spanned::new(builder.medium_id(m.element)?, m.at.span)));
    let parts = if plugin == "batch" { object.nested("sensor") } else { Vec::new() };
    let cameras: Vec<_> = parts.iter().filter_map(|part| builder.part_of_batch(part.element)).collect();
    let target = if plugin == "distant" { builder.target(&mut object)? } else { DistantTarget::Scene };
    let report = &mut builder.report;
    let mut to_world = DMat4::IDENTITY;
    let kind = match plugin {
        "perspective" | "thinlens" => {
            let (fov, axis) = field_of_view(&mut object, report);
            let lens = (plugin == "thinlens").then(|| thin_lens(&mut object, report)).flatten();
            let offset = match plugin {
                "perspective" => ["principal_point_offset_x", "principal_point_offset_y"]
                    .map(|name| object.float(name, |_| true, "a number", report).map_or(0.0, |offset| offset.value)),
                _ => [0.0; 2],
            };
            to_world = object.transform(report);
            check_rigid(to_world, object.element, report);
            CameraKind::Perspective { fov, frame: FrameDesc { offset, ..FrameDesc::of_film(axis) }, lens }
        }
        "orthographic" => {
            to_world = object.transform(report);
            CameraKind::Orthographic { frame: FrameDesc::of_film(FovAxis::X) }
        }
        "radiancemeter" => {
            to_world = meter_transform(&mut object, report);
            CameraKind::RadianceMeter
        }
        "distant" => {
            to_world = facing(&mut object, report);
            CameraKind::Distant { target }
        }
        "irradiancemeter" => {
            let Some(shape) = shape else {
                let error = SceneError::at(span, "an \"irradiancemeter\" measures at a shape");
                report.errors.push(error.help("write it inside of a <shape>"));
                return None;
            };
            CameraKind::IrradianceMeter { shape }
        }
        _ if cameras.is_empty() => {
            report.errors.push(SceneError::at(span, "the batch has no <sensor> that can be used"));
            return None;
        }
        _ => CameraKind::Batch(cameras),
    };
    let near = match kind {
        CameraKind::Perspective { .. } | CameraKind::Orthographic { .. } => near_clip(&mut object, report),
        _ => {
            object.ignore(&["near_clip"], "nothing is too near to be seen", report);
            0.0
        }
    };
    object.ignore(&["far_clip"], "nothing is too far to be seen", report);
    if plugin != "thinlens" {
        object.ignore(&["focus_distance"], "without a lens everything is in focus", report);
    }
    object.ignore(&["shutter_open", "shutter_close"], "nothing moves", report);
    object.ignore(&["srf"], NO_RESPONSE, report);
    object.finish(report);
    let to_world = to_world * DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    Some(CameraDesc { span, to_world, kind, near, medium })
}

impl<'t> Builder<'t> {
    /// Where the rays of a distant sensor go.
    fn target(&mut self, object: &mut Object<'t>) -> Option<DistantTarget> {
        if let Some(child) = object.object_of("target", "shape") {
            let plugin = words::plugin(child.element, &mut self.report)?;
            let shape = self.shape(plugin, child.element)?;
            return Some(DistantTarget::Shape(Box::new(shape)));
        }
        let point = object.point("target", &mut self.report);
        Some(point.map_or(DistantTarget::Scene, |point| DistantTarget::Point(point.value.to_array())))
    }

    /// A sensor of a batch, whose film and sampler are the batch's.
    fn part_of_batch(&mut self, element: &'t Element) -> Option<CameraDesc> {
        let plugin = words::plugin(element, &mut self.report)?;
        if plugin == "batch" {
            let error = SceneError::at(element.span, "a batch inside of a batch");
            self.report.errors.push(error.help("list its sensors here"));
            return None;
        }
        let mut object = self.object(element);
        for tag in ["film", "sampler"] {
            for child in object.nested(tag) {
                let reason = "a batch has one film and one sampler";
                self.report.ignored.push(Ignored { span: child.at.span, reason });
            }
        }
        camera(self, object, plugin, None)
    }
}

/// Mitsuba's near clip must be positive: one of [`NO_NEAR_CLIP`] or less is none.
fn near_clip(object: &mut Object, report: &mut Report) -> f64 {
    let near =
        object.float("near_clip", |near| near > 0.0, "greater than 0", report).map_or(NEAR_CLIP, |near| near.value);
    if near <= NO_NEAR_CLIP { 0.0 } else { near }
}

/// A lens of radius `aperture_radius`, focused at `focus_distance`: Mitsuba's far clip, if nothing is said.
fn thin_lens(object: &mut Object, report: &mut Report) -> Option<ThinLensDesc> {
    let radius = object.float("aperture_radius", |r| r >= 0.0, "at least 0", report);
    let far = object.float("far_clip", |f| f > 0.0, "greater than 0", report).map_or(1e4, |f| f.value);
    let focus = object.float("focus_distance", |f| f > 0.0, "greater than 0", report).map_or(far, |f| f.value);
    let Some(radius) = radius else {
        report.errors.push(SceneError::at(object.element.span, "the \"thinlens\" lacks an \"aperture_radius\""));
        return None;
    };
    (radius.value > 0.0).then_some(ThinLensDesc { radius: radius.value, focus })
}

/// `to_world`, or a place and a direction.
fn meter_transform(object: &mut Object, report: &mut Report) -> DMat4 {
    let placed = object.has("to_world");
    let to_world = object.transform(report);
    let (origin, direction) = (object.point("origin", report), object.point("direction", report));
    match (origin, direction) {
        _ if placed => to_world,
        (Some(origin), Some(direction)) => {
            let Some(z) = direction.value.try_normalize() else {
                report.errors.push(SceneError::at(direction.span, "a \"direction\" has a length"));
                return to_world;
            };
            let (x, y) = z.any_orthonormal_pair();
            DMat4::from_cols(x.extend(0.0), y.extend(0.0), z.extend(0.0), origin.value.extend(1.0))
        }
        (None, None) => to_world,
        (Some(one), None) | (None, Some(one)) => {
            report
                .errors
                .push(SceneError::at(one.span, "\"origin\" and \"direction\" are given together or not at all"));
            to_world
        }
    }
}

/// `to_world`, or a direction of the rays.
fn facing(object: &mut Object, report: &mut Report) -> DMat4 {
    let to_world = object.transform(report);
    let Some(direction) = object.point("direction", report) else { return to_world };
    if object.has("to_world") {
        report.errors.push(SceneError::at(direction.span, "\"direction\" cannot stand beside \"to_world\""));
    }
    let Some(z) = direction.value.try_normalize() else {
        report.errors.push(SceneError::at(direction.span, "a \"direction\" has a length"));
        return to_world;
    };
    let (x, y) = z.any_orthonormal_pair();
    DMat4::from_mat3(DMat3::from_cols(x, y, z))
}

/// `fov` along `fov_axis`, or the focal length of a 35 mm camera, whose picture is 36 × 24 mm.
pub(super) fn field_of_view(object: &mut Object, report: &mut Report) -> (Spanned<f64>, FovAxis) {
    let axes = [
        ("x", FovAxis::X),
        ("y", FovAxis::Y),
        ("diagonal", FovAxis::Diagonal),
        ("smaller", FovAxis::Smaller),
        ("larger", FovAxis::Larger),
    ];
    let fov = object.float("fov", |fov| fov > 0.0 && fov < 180.0, "greater than 0 and less than 180", report);
    let axis = object.choice("fov_axis", &axes, report);
    let focal_length = object.string("focal_length", report);
    if let (Some(fov), Some(length)) = (fov, focal_length) {
        let error = SceneError::at(length.span, "\"fov\" and \"focal_length\" say the same thing twice");
        report.errors.push(error.related(fov.span, "the field of view is given here"));
    }
    if let Some(fov) = fov {
        return (fov, axis);
    }
    let length = focal_length.unwrap_or(Spanned::new("50mm", object.element.span));
    let millimetres = length.value.trim().trim_end_matches("mm").trim().parse::<f64>();
    let millimetres = millimetres.ok().filter(|mm| mm.is_finite() && *mm > 0.0).unwrap_or_else(|| {
        let error = SceneError::at(length.span, format!("\"{}\" is no focal length", length.value));
        report.errors.push(error.help("write \"50mm\", for example"));
        50.0
    });
    let fov = 2.0 * (36.0f64.hypot(24.0) / (2.0 * millimetres)).atan();
    (Spanned::new(fov.to_degrees(), length.span), FovAxis::Diagonal)
}

/// Mitsuba takes no camera that is scaled.
fn check_rigid(to_world: DMat4, element: &Element, report: &mut Report) {
    let linear = DMat3::from_mat4(to_world);
    if !(linear.transpose() * linear).abs_diff_eq(DMat3::IDENTITY, 1e-3) {
        report.errors.push(SceneError::at(element.span, "the \"to_world\" of a sensor cannot scale or shear"));
    }
}

fn default_film(span: Span) -> FilmDesc {
    let filter = gaussian(0.5);
    FilmDesc {
        span,
        width: 768,
        height: 576,
        crop: None,
        filename: None,
        diagonal: 35.0,
        filter,
        layers: Vec::new(),
        parts: PartsDesc::default(),
        exposure: 1.0,
    }
}

fn film_desc<'t>(builder: &mut Builder<'t>, element: &'t Element) -> Option<FilmDesc> {
    words::plugin(element, &mut builder.report)?;
    let mut object = builder.object(element);
    let filter = match object.only("rfilter", &mut builder.report) {
        Some(filter) => filter_desc(builder, filter.element),
        None => None,
    };
    let filter = filter.unwrap_or_else(|| gaussian(0.5));
    let report = &mut builder.report;
    let default = default_film(element.span);
    let width = object.count("width", 1, default.width, report);
    let height = object.count("height", 1, default.height, report);
    for side in [width, height] {
        if side.value > LARGEST_SIDE {
            let message = format!("a film of {} pixels a side is too large: at most {LARGEST_SIDE}", side.value);
            report.errors.push(SceneError::at(side.span, message));
        }
    }
    let crop = crop(&mut object, width.value, height.value, report);
    let format = ["pixel_format", "component_format", "file_format", "compensate", "banner"];
    object.ignore(&format, "the format of the image is chosen on the command line", report);
    object.ignore(&["sample_border"], "the filter is sampled, so no border is needed", report);
    let parts = parts(&mut object, report);
    object.finish(report);
    Some(FilmDesc { width: width.value, height: height.value, crop, filter, parts, ..default })
}

/// tyndall's own: parts of the light, by name or expression, between commas.
fn parts(object: &mut Object, report: &mut Report) -> PartsDesc {
    let Some(words) = object.string("layers", report) else { return PartsDesc::default() };
    match named::list(words.value) {
        Ok(layers) => PartsDesc { span: Some(words.span), layers },
        Err(error) => {
            report.errors.push(SceneError::at(words.span, error.to_string()));
            PartsDesc::default()
        }
    }
}

fn crop(object: &mut Object, width: u32, height: u32, report: &mut Report) -> Option<CropDesc> {
    let given = ["crop_offset_x", "crop_offset_y", "crop_width", "crop_height"].iter().any(|name| object.has(name));
    let x = object.count("crop_offset_x", 0, 0, report);
    let y = object.count("crop_offset_y", 0, 0, report);
    let w = object.count("crop_width", 1, width, report);
    let h = object.count("crop_height", 1, height, report);
    for (offset, size, whole) in [(x, w, width), (y, h, height)] {
        if u64::from(offset.value) + u64::from(size.value) > u64::from(whole) {
            let message = format!(
                "the crop reaches pixel {}, but there are {whole}",
                u64::from(offset.value) + u64::from(size.value)
            );
            report.errors.push(SceneError::at(size.span, message));
            return None;
        }
    }
    given.then(|| CropDesc { x0: x.value, y0: y.value, x1: x.value + w.value, y1: y.value + h.value })
}

/// Mitsuba cuts its Gaussian off at four standard deviations.
fn gaussian(sigma: f64) -> FilterDesc {
    FilterDesc::Gaussian { radius: [4.0 * sigma; 2], sigma }
}

fn filter_desc<'t>(builder: &mut Builder<'t>, element: &'t Element) -> Option<FilterDesc> {
    let kind = words::plugin(element, &mut builder.report)?;
    let mut object = builder.object(element);
    let report = &mut builder.report;
    let mut positive =
        |name, default| object.float(name, |v| v > 0.0, "greater than 0", report).map_or(default, |v| v.value);
    let filter = match kind {
        "box" => FilterDesc::Box { radius: [0.5; 2] },
        "tent" => FilterDesc::Triangle { radius: [positive("radius", 1.0); 2] },
        "gaussian" => gaussian(positive("stddev", 0.5)),
        "mitchell" => {
            let mut weight = |name| object.float(name, |_| true, "", report).map_or(1.0 / 3.0, |v| v.value);
            FilterDesc::Mitchell { radius: [2.0; 2], b: weight("B"), c: weight("C") }
        }
        // The cubic of Mitchell and Netravali with B = 0 and C = 1/2.
        "catmullrom" => FilterDesc::Mitchell { radius: [2.0; 2], b: 0.0, c: 0.5 },
        _ => {
            let lobes = f64::from(object.count("lobes", 1, 3, report).value);
            FilterDesc::Sinc { radius: [lobes; 2], tau: lobes }
        }
    };
    object.finish(report);
    Some(filter)
}

fn default_sampler(span: Span) -> SamplerDesc {
    SamplerDesc { kind: Spanned::new("independent".into(), span), spp: Spanned::new(4, span), seed: None }
}

fn sampler_desc<'t>(builder: &mut Builder<'t>, element: &'t Element) -> Option<SamplerDesc> {
    let kind = words::plugin(element, &mut builder.report)?;
    let mut object = builder.object(element);
    let report = &mut builder.report;
    let spp = object.count("sample_count", 1, 4, report);
    let seed = object.integer("seed", 0, report).map(|seed| seed.map(i64::cast_unsigned));
    object.ignore(&["jitter", "strength"], "there is one sampler, of low discrepancy", report);
    object.finish(report);
    Some(SamplerDesc { kind: Spanned::new(kind.into(), element.span_of("type")), spp, seed })
}
