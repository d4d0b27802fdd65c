//! `<shape>`: `sphere`, `rectangle`, `cube`, `disk`, `cylinder`, `obj`, `ply`, `serialized`, `bsplinecurve`,
//! `linearcurve`, and `shapegroup` with `instance`.

use glam::{DMat3, DMat4, DVec3};
use tyndall::shape::{Basis, DiskMapping, SpherePart, Style, Turn};

use super::object::Object;
use super::scene::Builder;
use super::tree::Element;
use super::words;
use crate::desc::{
    GroupDesc, GroupId, InstanceDesc, MaterialDesc, MaterialId, MaterialKind, MediumInterface, Radii, ShapeDesc,
    ShapeKind, StrandsDesc, Varying, granular,
};
use crate::error::SceneError;
use crate::source::Spanned;

impl<'t> Builder<'t> {
    /// A shape of the scene: one that is seen, a group, or an instance of one.
    pub(super) fn shape_or_instance(&mut self, element: &'t Element) {
        match words::plugin(element, &mut self.report) {
            Some("shapegroup") => {
                self.group(element);
            }
            Some("instance") => {
                if let Some(instance) = self.instance(element) {
                    self.instances.push(instance);
                }
            }
            Some(plugin) => {
                if let Some(shape) = self.shape(plugin, element) {
                    self.shapes.push(shape);
                }
            }
            None => {}
        }
    }

    pub(super) fn shape(&mut self, plugin: &str, element: &'t Element) -> Option<ShapeDesc> {
        let mut object = self.object(element);
        let emitter = object.only("emitter", &mut self.report);
        let emission = emitter.and_then(|emitter| self.area_light(emitter.element));
        if let Some(sensor) = object.only("sensor", &mut self.report) {
            self.meters.push((sensor.element, self.shapes.len()));
        }
        let bsdf = object.only("bsdf", &mut self.report);
        let material = bsdf.and_then(|bsdf| Some(Spanned::new(self.material(bsdf.element, false)?, bsdf.at.span)));
        let material =
            material.unwrap_or_else(|| Spanned::new(self.default_material(element, emitter.is_some()), element.span));
        let interface = self.interface(&mut object);
        let mut to_world = object.transform(&mut self.report);
        let kind = self.shape_kind(plugin, &mut object, &mut to_world)?;
        let report = &mut self.report;
        let reverse_orientation = object.flag("flip_normals", false, report);
        // tyndall's own.
        let priority = object.integer("priority", i32::MIN.into(), report);
        let priority = priority.map(|p| p.map(|p| i32::try_from(p).unwrap_or(i32::MAX)));
        let granular = object.string("granular", report).map(granular);
        let granular = granular.and_then(|found| found.map_err(|error| report.errors.push(error)).ok());
        object.ignore(&["silhouette_sampling_weight"], "silhouettes are not sampled", report);
        object.finish(report);
        Some(ShapeDesc {
            span: element.span,
            name: element.id(),
            kind,
            to_world,
            reverse_orientation,
            material,
            opacity: None,
            emission,
            interface,
            priority,
            granular,
        })
    }

    fn shape_kind(&mut self, plugin: &str, object: &mut Object<'t>, to_world: &mut DMat4) -> Option<ShapeKind> {
        let report = &mut self.report;
        Some(match plugin {
            "sphere" => {
                if let Some(center) = object.point("center", report) {
                    *to_world *= DMat4::from_translation(center.value);
                }
                // Its v runs from the pole at +z to that at −z, ours the other way.
                *to_world *= DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0));
                let radius = object.float("radius", |radius| radius > 0.0, "greater than 0", report);
                ShapeKind::Sphere { radius: radius.map_or(1.0, |radius| radius.value), part: SpherePart::WHOLE }
            }
            "disk" => {
                let mapping = DiskMapping::OutwardAzimuth;
                ShapeKind::Disk { height: 0.0, radius: 1.0, inner_radius: 0.0, turn: Turn::FULL, mapping }
            }
            "cylinder" => {
                let [p0, p1] = [("p0", DVec3::ZERO), ("p1", DVec3::Z)]
                    .map(|(name, default)| object.point(name, report).map_or(default, |p| p.value));
                let radius = object.float("radius", |radius| radius > 0.0, "greater than 0", report);
                let length = (p1 - p0).length();
                // Divided, not multiplied by the inverse: of an axis along z nothing is rounded.
                let along = (p1 - p0) / length;
                if !along.is_finite() {
                    let error = SceneError::at(object.element.span, "the two ends of this cylinder are one point");
                    report.errors.push(error.help("give \"p0\" and \"p1\" that differ"));
                    return None;
                }
                *to_world *= DMat4::from_translation(p0) * DMat4::from_mat3(around(along));
                let radius = radius.map_or(1.0, |radius| radius.value);
                ShapeKind::Cylinder { radius, heights: [0.0, length], turn: Turn::FULL }
            }
            "rectangle" | "cube" => {
                object.ignore(&["face_normals"], "its faces are flat", report);
                if plugin == "cube" { ShapeKind::Cube } else { ShapeKind::Rectangle }
            }
            "bsplinecurve" | "linearcurve" => {
                let Some(name) = object.string("filename", report) else {
                    let message = format!("the shape \"{plugin}\" lacks a \"filename\"");
                    report.errors.push(SceneError::at(object.element.span, message));
                    return None;
                };
                let basis = if plugin == "linearcurve" { Basis::Linear } else { Basis::CubicBSpline };
                let (path, radii) = (self.file(name), Radii::World);
                ShapeKind::Strands(StrandsDesc { path, basis, style: Style::Round, radii })
            }
            _ => {
                let face_normals = object.flag("face_normals", false, report);
                let flip_tex_coords = plugin != "serialized" && object.flag("flip_tex_coords", plugin == "obj", report);
                let index = if plugin == "serialized" { object.count("shape_index", 0, 0, report).value } else { 0 };
                let Some(name) = object.string("filename", report) else {
                    let message = format!("the shape \"{plugin}\" lacks a \"filename\"");
                    report.errors.push(SceneError::at(object.element.span, message));
                    return None;
                };
                let path = self.file(name);
                let smooth_normals = !face_normals;
                match plugin {
                    "obj" => ShapeKind::Obj { path, face_normals, smooth_normals, flip_tex_coords },
                    "serialized" => ShapeKind::Serialized { path, index, face_normals },
                    _ => ShapeKind::Ply { path, face_normals, smooth_normals, flip_tex_coords, displacement: None },
                }
            }
        })
    }

    /// Mitsuba's: grey, or black for a surface that shines. Each is made once, at the first shape that needs it.
    fn default_material(&mut self, element: &'t Element, shines: bool) -> MaterialId {
        if let Some(id) = self.default_materials[usize::from(shines)] {
            return id;
        }
        let reflectance = Varying::constant(if shines { 0.0 } else { 0.5 });
        let kind = MaterialKind::Diffuse { reflectance: Spanned::new(reflectance, element.span) };
        let id = self.add_material(MaterialDesc { span: element.span, name: None, kind, two_sided: false });
        self.default_materials[usize::from(shines)] = Some(id);
        id
    }

    /// The media named `interior` and `exterior`.
    fn interface(&mut self, object: &mut Object<'t>) -> Option<MediumInterface> {
        let media = object.nested("medium");
        let mut interface = MediumInterface { span: media.first()?.at.span, inside: None, outside: None };
        for medium in media {
            let at = medium.at.span_of("name");
            let side = match medium.name() {
                Some("interior") => &mut interface.inside,
                Some("exterior") => &mut interface.outside,
                other => {
                    let error = SceneError::at(at, "the medium of a shape is named \"interior\" or \"exterior\"");
                    self.report.errors.push(match other {
                        Some(other) => error.suggest(other, ["interior", "exterior"]),
                        None => error.help("add name=\"interior\""),
                    });
                    continue;
                }
            };
            if side.is_some() {
                self.report.errors.push(SceneError::at(at, "the shape has two media on one side"));
            }
            *side = self.medium_id(medium.element);
        }
        Some(interface)
    }

    /// The shapes of a group, built once.
    fn group(&mut self, element: &'t Element) -> GroupId {
        if let Some(&id) = self.built_groups.get(&element.span) {
            return id;
        }
        let mut object = self.object(element);
        let mut shapes = Vec::new();
        for child in object.nested("shape") {
            let Some(plugin) = words::plugin(child.element, &mut self.report) else { continue };
            if matches!(plugin, "shapegroup" | "instance") {
                let message = format!("a \"{plugin}\" inside a \"shapegroup\" is not known");
                self.report.errors.push(SceneError::at(child.at.span, message));
                continue;
            }
            let meters = self.meters.len();
            let shape = self.shape(plugin, child.element);
            for (sensor, _) in self.meters.split_off(meters) {
                let message = "a shape that measures cannot be part of a \"shapegroup\"";
                self.report.errors.push(SceneError::at(sensor.span, message));
            }
            if let Some(emission) = shape.as_ref().and_then(|shape| shape.emission.as_ref()) {
                let error = SceneError::at(emission.span, "a shape that shines cannot be part of a \"shapegroup\"");
                self.report.errors.push(error.help("place it in the scene itself"));
            }
            shapes.extend(shape);
        }
        object.finish(&mut self.report);
        let name = element.text("id").to_owned();
        self.groups.push(GroupDesc { span: element.span, name, shapes });
        let id = GroupId(self.groups.len() as u32 - 1);
        self.built_groups.insert(element.span, id);
        id
    }

    fn instance(&mut self, element: &'t Element) -> Option<InstanceDesc> {
        let mut object = self.object(element);
        let child = object.only("shape", &mut self.report);
        let to_world = object.transform(&mut self.report);
        object.finish(&mut self.report);
        let Some(child) = child else {
            let error = SceneError::at(element.span, "the instance names no group");
            self.report.errors.push(error.help("add <ref id=\"…\"/> with the id of a <shape type=\"shapegroup\">"));
            return None;
        };
        if child.element.text("type") != "shapegroup" {
            let message = format!("the shape \"{}\" is no \"shapegroup\"", child.element.text("type"));
            self.report.errors.push(SceneError::at(child.at.span, message));
            return None;
        }
        let group = Spanned::new(self.group(child.element), child.at.span);
        Some(InstanceDesc { span: element.span, group, to_world })
    }
}

/// To axes whose third is the unit vector `n`, those that Mitsuba takes (Duff et al. 2017): azimuth 0 is along the first.
fn around(n: DVec3) -> DMat3 {
    let sign = 1f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    DMat3::from_cols(
        DVec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
        DVec3::new(b, sign + n.y * n.y * a, -n.y),
        n,
    )
}
