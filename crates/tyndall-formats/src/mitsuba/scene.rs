//! From the tree to the scene: finds the parts, follows references, builds each part once.

use std::collections::{HashMap, HashSet};

use tyndall::integrator::Counted;

use super::object::{Files, Ids, Object, Report};
use super::texture::Answer;
use super::tree::{Element, Tree};
use super::{camera, integrator, words};
use crate::desc::{
    FileRef, GroupDesc, GroupId, InstanceDesc, IntegratorDesc, LengthUnit, LightDesc, MaterialDesc, MaterialId,
    MediumDesc, MediumId, Options, SceneDesc, ShapeDesc, TextureDesc, TextureId,
};
use crate::error::{ErrorList, SceneError};
use crate::source::{SourceMap, Span, Spanned};

/// The deepest nesting of materials in materials.
const MAX_DEPTH: usize = 32;

/// The scene as far as it is built.
pub(super) struct Builder<'t> {
    ids: Ids<'t>,
    files: Files<'t>,
    pub(super) report: Report,
    /// Parts that are built, or were found wrong, by the element that says them.
    built_materials: HashMap<(Span, bool), Option<MaterialId>>,
    /// The materials that are being built, each inside of the one before.
    open_materials: Vec<(Span, bool)>,
    built_media: HashMap<Span, Option<MediumId>>,
    pub(super) built_textures: HashMap<(Span, Answer), Option<TextureId>>,
    pub(super) texture_depth: u32,
    pub(super) built_groups: HashMap<Span, GroupId>,
    /// The materials of shapes that name none: that of a surface, and that of one that shines.
    pub(super) default_materials: [Option<MaterialId>; 2],
    pub(super) textures: Vec<TextureDesc>,
    pub(super) materials: Vec<MaterialDesc>,
    pub(super) media: Vec<MediumDesc>,
    pub(super) shapes: Vec<ShapeDesc>,
    pub(super) groups: Vec<GroupDesc>,
    pub(super) instances: Vec<InstanceDesc>,
    pub(super) lights: Vec<LightDesc>,
    /// Sensors on shapes, with the index of the shape.
    pub(super) meters: Vec<(&'t Element, usize)>,
}

/// The scene of a tree, and all that is wrong with it. `None` only if something is wrong.
pub(super) fn build(tree: &Tree, sources: &SourceMap, errors: ErrorList) -> (Option<SceneDesc>, ErrorList) {
    let mut report = Report { errors, ..Report::default() };
    let ids = ids(tree, &mut report.errors);
    let mut builder = Builder {
        ids,
        files: Files { sources, directories: &tree.directories },
        report,
        built_materials: HashMap::new(),
        open_materials: Vec::new(),
        built_media: HashMap::new(),
        built_textures: HashMap::new(),
        texture_depth: 0,
        built_groups: HashMap::new(),
        default_materials: [None; 2],
        textures: Vec::new(),
        materials: Vec::new(),
        media: Vec::new(),
        shapes: Vec::new(),
        groups: Vec::new(),
        instances: Vec::new(),
        lights: Vec::new(),
        meters: Vec::new(),
    };
    let referred = referred(tree, &builder.ids);
    let scene = builder.scene(&tree.root, &referred);
    (scene, builder.report.errors)
}

/// Every object that has an `id`, and every alias.
fn ids<'t>(tree: &'t Tree, errors: &mut ErrorList) -> Ids<'t> {
    let mut ids = Ids::new();
    let mut rest = vec![&tree.root];
    while let Some(element) = rest.pop() {
        rest.extend(element.children.iter().rev());
        let Some(id) = element.attribute("id").filter(|_| element.tag != "ref") else { continue };
        if let Some(first) = ids.insert(&id.value, element) {
            let error = SceneError::at(id.span, format!("the id \"{}\" is taken", id.value));
            errors.push(error.related(first.span_of("id"), "first here"));
        }
    }
    for (alias, id) in &tree.aliases {
        match ids.get(id.value.as_str()) {
            Some(&element) => drop(ids.entry(alias).or_insert(element)),
            None => errors.push(SceneError::at(id.span, format!("nothing has the id \"{}\"", id.value))),
        }
    }
    ids
}

/// The objects that some `<ref>` names.
fn referred(tree: &Tree, ids: &Ids) -> HashSet<Span> {
    let mut spans = HashSet::new();
    let mut rest = vec![&tree.root];
    while let Some(element) = rest.pop() {
        rest.extend(&element.children);
        if element.tag == "ref" {
            spans.extend(ids.get(element.text("id")).map(|element| element.span));
        }
    }
    spans
}

impl<'t> Builder<'t> {
    pub(super) fn object(&mut self, element: &'t Element) -> Object<'t> {
        Object::new(element, &self.ids, self.files, &mut self.report)
    }

    /// The file that a `filename` names.
    pub(super) fn file(&self, name: Spanned<&str>) -> FileRef {
        self.files.resolve(name)
    }

    fn scene(&mut self, root: &'t Element, referred: &HashSet<Span>) -> Option<SceneDesc> {
        let mut scene = self.object(root);
        for bsdf in scene.nested("bsdf") {
            self.material(bsdf.element, false);
        }
        for medium in scene.nested("medium") {
            self.medium_id(medium.element);
        }
        let textures = scene.nested("texture");
        for volume in scene.nested("volume") {
            words::plugin(volume.element, &mut self.report);
        }
        for shape in scene.nested("shape") {
            self.shape_or_instance(shape.element);
        }
        for emitter in scene.nested("emitter") {
            let is_of_a_shape = emitter.element.text("type") == "area" && referred.contains(&emitter.element.span);
            if is_of_a_shape {
                continue;
            }
            if let Some(light) = self.light(emitter.element) {
                self.lights.push(light);
            }
        }
        let integrator = match scene.only("integrator", &mut self.report) {
            Some(integrator) => integrator::integrator(self, integrator.element),
            None => None,
        };
        let integrator = integrator.unwrap_or_else(|| default_integrator(root.span));
        integrator::warn_of_open_surfaces(&integrator, &self.materials, &mut self.report);
        for texture in textures {
            self.unless_built(texture.element);
        }
        let sensor = self.sensor(&mut scene);
        let seen = sensor.and_then(|(element, shape)| camera::sensor(self, element, shape));
        scene.leave_to_references(referred);
        scene.finish(&mut self.report);

        let (camera, film, sampler) = seen?;
        Some(SceneDesc {
            options: Options { unit: Spanned::new(LengthUnit::Millimetre, root.span), seed: None },
            camera,
            film,
            sampler,
            integrator,
            textures: std::mem::take(&mut self.textures),
            materials: std::mem::take(&mut self.materials),
            media: std::mem::take(&mut self.media),
            shapes: std::mem::take(&mut self.shapes),
            groups: std::mem::take(&mut self.groups),
            instances: std::mem::take(&mut self.instances),
            lights: std::mem::take(&mut self.lights),
            ignored: std::mem::take(&mut self.report.ignored),
            warnings: Vec::new(),
        })
    }

    /// The first sensor, and the shape that it stands on. Mitsuba too takes the first.
    fn sensor(&mut self, scene: &mut Object<'t>) -> Option<(&'t Element, Option<usize>)> {
        let mut sensors: Vec<_> = scene.nested("sensor").iter().map(|s| (s.at.span, s.element, None)).collect();
        sensors.extend(self.meters.iter().map(|(element, shape)| (element.span, *element, Some(*shape))));
        if sensors.is_empty() {
            let error = SceneError::at(scene.element.span, "the scene has no <sensor>");
            self.report.errors.push(error.help("add a <sensor type=\"perspective\">"));
        }
        let reason = "the first sensor of the scene makes the image";
        self.report
            .ignored
            .extend(sensors.iter().skip(1).map(|(span, ..)| crate::desc::Ignored { span: *span, reason }));
        sensors.first().map(|(_, element, shape)| (*element, *shape))
    }

    /// The material of a `<bsdf>`, built once.
    /// A `twosided` around it makes another of it.
    pub(super) fn material(&mut self, element: &'t Element, two_sided: bool) -> Option<MaterialId> {
        let key = (element.span, two_sided);
        if let Some(&built) = self.built_materials.get(&key) {
            return built;
        }
        let error = if self.open_materials.contains(&key) {
            SceneError::at(element.span, "this material contains itself")
        } else if self.open_materials.len() >= MAX_DEPTH {
            SceneError::at(element.span, format!("materials are nested more than {MAX_DEPTH} deep"))
        } else {
            self.open_materials.push(key);
            let id = self.bsdf(element, two_sided).map(|material| self.add_material(material));
            self.open_materials.pop();
            self.built_materials.insert(key, id);
            return id;
        };
        self.report.errors.push(error);
        None
    }

    pub(super) fn add_material(&mut self, material: MaterialDesc) -> MaterialId {
        self.materials.push(material);
        MaterialId(self.materials.len() as u32 - 1)
    }

    /// The id of a `<medium>`, built once.
    pub(super) fn medium_id(&mut self, element: &'t Element) -> Option<MediumId> {
        if let Some(&built) = self.built_media.get(&element.span) {
            return built;
        }
        let id = self.medium(element).map(|medium| {
            self.media.push(medium);
            MediumId(self.media.len() as u32 - 1)
        });
        self.built_media.insert(element.span, id);
        id
    }
}

/// Mitsuba's `path`, which it takes if a scene names none.
pub(super) fn default_integrator(span: Span) -> IntegratorDesc {
    let name = Spanned::new("path".into(), span);
    IntegratorDesc {
        name,
        max_depth: None,
        counted: Counted::default(),
        explicit_grains: None,
        rr_depth: None,
        hide_emitters: false,
        layers: Vec::new(),
    }
}
