//! Whether grains and what stands for them are what [`tyndall::granular`] takes them for.

use tyndall::{granular::Granular, scene::Scene, shape::ObjectId};

use super::Builder;
use crate::{
    desc::{GroupDesc, ShapeDesc},
    error::SceneError,
    source::Span,
};

impl Builder<'_> {
    /// `granular` are all shapes that are grains or proxies, each with its objects.
    pub(super) fn check_granular(&mut self, scene: &Scene, granular: &[(&ShapeDesc, Vec<ObjectId>)]) -> Option<()> {
        for group in &self.desc.groups {
            self.check_group(group)?;
        }
        for (shape, objects) in granular {
            if let Some((message, help)) = fault(scene, shape, objects) {
                return self.fail(SceneError::at(place(shape), message).help(help));
            }
        }
        let first = |what| granular.iter().find(|(shape, _)| shape.granular.is_some_and(|g| g.value == what));
        let (grain, proxy) = (first(Granular::Grain), first(Granular::Proxy));
        match (proxy, grain, &self.desc.integrator.explicit_grains) {
            (Some((proxy, _)), None, _) => self.fail(
                SceneError::at(place(proxy), "this stands for grains, and there are none")
                    .help("mark the shapes that it stands for as \"grain\""),
            ),
            (None, _, Some(grains)) => self.fail(
                SceneError::at(grains.span, "there is nothing for a path to go on in after its explicit grains")
                    .help("mark the medium that stands for them as \"proxy\"; `tyndall pack --proxy` writes one"),
            ),
            _ => Some(()),
        }
    }

    /// Instances are placed as a whole: with the grains, or with their proxy.
    fn check_group(&mut self, group: &GroupDesc) -> Option<()> {
        let grains = group.shapes.iter().filter(|shape| shape.granular.is_some());
        let Some(grain) = grains.clone().next() else { return Some(()) };
        if let Some(proxy) = grains.clone().find(|shape| shape.granular.is_some_and(|g| g.value == Granular::Proxy)) {
            return self.fail(
                SceneError::at(place(proxy), "a proxy is no part of an object that is instanced")
                    .help("place it in the world itself"),
            );
        }
        let Some(other) = group.shapes.iter().find(|shape| shape.granular.is_none()) else { return Some(()) };
        self.fail(
            SceneError::at(other.span, "this is no grain, and a shape of the same object is one")
                .help("make grains of all shapes of an object, or of none")
                .related(place(grain), "the grain"),
        )
    }
}

/// Where it says what it is among grains.
fn place(shape: &ShapeDesc) -> Span {
    shape.granular.map_or(shape.span, |granular| granular.span)
}

/// What is wrong with a grain or a proxy, and what to do.
fn fault(scene: &Scene, shape: &ShapeDesc, objects: &[ObjectId]) -> Option<(&'static str, &'static str)> {
    let faces_inward = || matches!(objects, [object] if scene.geometry.faces_inward(*object));
    if shape.emission.is_some() {
        return Some(("grains and their proxies do not shine", "leave out the light"));
    }
    if shape.priority.is_some() {
        return Some(("grains and their proxies have no priority", "leave it out"));
    }
    if !scene.geometry.is_closed(objects) || faces_inward() {
        return Some((
            "grains and their proxies are closed, with normals to their outside",
            "close it, or turn it round",
        ));
    }
    let mut objects = objects.iter().map(|id| &scene.objects[id.0 as usize]);
    match shape.granular?.value {
        Granular::Grain if objects.any(|object| scene.lets_light_pass(object)) => Some((
            "light passes this grain unchanged, and cannot be told from light that has met none",
            "give it a material",
        )),
        Granular::Proxy if !objects.all(|object| scene.lets_light_pass(object)) || shape.opacity.is_some() => {
            Some(("a proxy is a boundary without a material", "use the material \"interface\" (\"null\")"))
        }
        Granular::Proxy if shape.interface.is_none_or(|interface| interface.inside.is_none()) => {
            Some(("there is no medium in this proxy", "name the medium inside"))
        }
        Granular::Grain | Granular::Proxy => None,
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use tyndall::{granular::Granular, scene::Scene, spectrum::ColorMode};

    use crate::error::Diagnostics;

    fn pbrt(text: &str) -> Result<Scene, Diagnostics> {
        let (desc, sources) = crate::pbrt::parse(Path::new("scene.pbrt"), text)?;
        Ok(crate::build::build(&desc, sources, ColorMode::Rgb)?.0)
    }

    /// A ball of glass, three times, and what stands for it.
    const HEAP: &str = r#"
        ObjectBegin "grain" Material "dielectric" Shape "sphere" "string granular" "grain" ObjectEnd
        ObjectInstance "grain" Translate 3 0 0 ObjectInstance "grain"
        MakeNamedMedium "dust" "string type" "homogeneous"
        Material "interface" MediumInterface "dust" "" Shape "sphere" "float radius" 9 "string granular" "proxy""#;

    #[test]
    fn both_languages_have_grains_and_their_proxy() {
        let scene = pbrt(&format!("Integrator \"volpath\" \"integer explicitgrains\" 2\nWorldBegin\n{HEAP}")).unwrap();
        let roles = |scene: &Scene| scene.objects.iter().filter_map(|o| o.granular).collect::<Vec<_>>();
        assert_eq!(roles(&scene), [Granular::Proxy, Granular::Grain]);
        let bounds = |scene: &Scene| scene.geometry.bounds().extent().x.round();
        // Two balls, 3 apart; a ball of radius 9.
        assert_eq!((bounds(&scene), bounds(scene.proxied().unwrap())), (5.0, 18.0));
        let text = r#"<scene version="3.0.0"><sensor type="perspective"/>
            <integrator type="volpath"><integer name="explicit_grains" value="2"/></integrator>
            <shape type="sphere"><string name="granular" value="grain"/><bsdf type="dielectric"/></shape>
            <shape type="cube"><string name="granular" value="proxy"/><bsdf type="null"/>
              <medium name="interior" type="homogeneous"/></shape></scene>"#;
        let (desc, sources) = crate::mitsuba::parse(Path::new("scene.xml"), text, &[]).unwrap();
        assert_eq!(desc.integrator.explicit_grains.map(|grains| grains.value), Some(2));
        let scene = crate::build::build(&desc, sources, ColorMode::Rgb).unwrap().0;
        assert_eq!(roles(&scene), [Granular::Grain, Granular::Proxy]);
        assert!(scene.proxied().is_some());
    }

    /// Each fault is told, at its line and column: in the third line, if not said otherwise.
    #[test]
    fn what_is_no_grain_or_no_proxy_is_told() {
        let grain = "Material \"dielectric\" Shape \"sphere\" \"string granular\" \"grain\"";
        let medium = "MakeNamedMedium \"dust\" \"string type\" \"homogeneous\"";
        let proxy = "Material \"interface\" MediumInterface \"dust\" \"\"";
        let ball = "Shape \"sphere\" \"string granular\"";
        let lamp = "AreaLightSource \"diffuse\"";
        let cases = [
            (format!("{ball} \"grian\""), ":33", "did you mean \"grain\""),
            (format!("{proxy} {ball} \"proxy\""), ":80", "there are none"),
            (format!("{grain} {lamp} {ball} \"grain\""), ":118", "do not shine"),
            (format!("{grain} {ball} \"grain\" \"integer priority\" 1"), ":95", "no priority"),
            (format!("Material \"interface\" {ball} \"grain\""), ":54", "light passes this grain unchanged"),
            (
                format!("Material \"diffuse\" {ball} \"grain\" \"float alpha\" 0.5"),
                ":52",
                "light passes this grain unchanged",
            ),
            (format!("Shape \"disk\" \"string granular\" \"grain\""), ":31", "are closed"),
            (format!("ReverseOrientation {ball} \"grain\""), ":52", "are closed"),
            (format!("{grain} {proxy} Material \"diffuse\" {ball} \"proxy\""), ":162", "without a material"),
            (format!("{grain} Material \"interface\" {ball} \"proxy\""), ":116", "no medium in this proxy"),
            (format!("ObjectBegin \"o\" {grain} {proxy} {ball} \"proxy\" ObjectEnd"), ":158", "no part of an object"),
            (format!("ObjectBegin \"o\" {grain} Shape \"sphere\" ObjectEnd"), ":78", "this is no grain"),
        ];
        for (world, column, message) in cases {
            let told = pbrt(&format!("WorldBegin\n{medium}\n{world}")).unwrap_err().to_string();
            assert!(told.contains(&format!("scene.pbrt:3{column}")) && told.contains(message), "{world}\n{told}");
        }
        let integrator = "Integrator \"volpath\" \"integer explicitgrains\"";
        for (count, message) in [("2", "nothing for a path to go on in"), ("-1", "at least 0"), ("1.5", "integer")] {
            let told = pbrt(&format!("{integrator} {count}\nWorldBegin\n{grain}")).unwrap_err().to_string();
            assert!(told.contains("scene.pbrt:1:") && told.contains(message), "{count}\n{told}");
        }
    }
}
