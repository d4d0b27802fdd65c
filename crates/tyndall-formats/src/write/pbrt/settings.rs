//! Units, integrator, sampler, film and filter.

use tyndall::feature::Space;

use super::Pen;
use super::entity::{Entity, quoted};
use crate::desc::{CameraKind, FilmDesc, FilterDesc, LengthUnit};
use crate::pbrt::layers::in_space;
use crate::write::number::shortest;

impl Pen<'_, '_> {
    pub(super) fn settings(&mut self) {
        let desc = self.draft.desc;
        let unit = LengthUnit::ALL.into_iter().find(|(_, unit)| *unit == desc.options.unit.value).map_or("mm", |u| u.0);
        // Behind a lens, a unit that is not said is a metre.
        let matters = matches!(&desc.camera.kind, CameraKind::Realistic(r) if r.millimetre == 1.0);
        if unit != "mm" || matters {
            self.sheet.line(&format!("Option \"string unit\" {}", quoted(unit)));
        }
        if let Some(seed) = desc.options.seed {
            self.sheet.line(&format!("Option \"integer seed\" {}", seed.value));
        }
        self.integrator();
        self.sampler();
        self.filter(&desc.film.filter);
        self.film(&desc.film);
        self.sheet.gap();
        self.camera();
    }

    fn integrator(&mut self) {
        let integrator = &self.draft.desc.integrator;
        let word = match integrator.name.value.as_str() {
            word @ ("path" | "volpath" | "simplepath" | "simplevolpath" | "randomwalk" | "lightpath" | "bdpt"
            | "mlt" | "sppm") => word,
            "ptracer" => "lightpath",
            "volpathmis" | "prbvolpath" => "volpath",
            _ => "path",
        };
        let mut entity = Entity::new("Integrator", &[word]);
        match integrator.max_depth {
            Some(depth) => entity.integer("maxdepth", depth.value.into()),
            None => self
                .sheet
                .line("# as long as light goes on; pbrt-v4 itself stops at \"integer maxdepth\" 5 unless told"),
        }
        if let Some(grains) = integrator.explicit_grains {
            entity.integer("explicitgrains", grains.value.into());
        }
        self.entity(entity);
        if let Some(depth) = integrator.rr_depth {
            self.draft.differs(depth.span, "pbrt has no word for when Russian roulette begins: the noise may differ");
        }
        if integrator.hide_emitters {
            self.lacks(integrator.name.span, "emission that is hidden from the camera");
        }
        if !integrator.layers.is_empty() {
            self.lacks(integrator.name.span, "these layers of the film");
        }
    }

    fn sampler(&mut self) {
        let sampler = &self.draft.desc.sampler;
        let word = match sampler.kind.value.as_str() {
            word @ ("halton" | "independent" | "paddedsobol" | "pmj02bn" | "sobol" | "stratified" | "zsobol") => word,
            "multijitter" | "orthogonal" => "pmj02bn",
            _ => "zsobol",
        };
        let mut entity = Entity::new("Sampler", &[word]);
        let spp = sampler.spp.value;
        if word == "stratified" {
            // As square as can be.
            let x = (1..=spp.isqrt()).rev().find(|x| spp.is_multiple_of(*x)).unwrap_or(1);
            entity.integer("xsamples", (spp / x).into());
            entity.integer("ysamples", x.into());
        } else {
            entity.integer("pixelsamples", spp.into());
        }
        if let Some(seed) = sampler.seed {
            match i32::try_from(seed.value) {
                Ok(seed) => entity.integer("seed", seed.into()),
                Err(_) => self.lacks(seed.span, "a seed of more than 31 bits"),
            }
        }
        self.entity(entity);
    }

    fn filter(&mut self, filter: &FilterDesc) {
        let radii = |word: &str, radius: [f64; 2], default: f64| {
            let mut entity = Entity::new("PixelFilter", &[word]);
            entity.float_unless("xradius", radius[0], default);
            entity.float_unless("yradius", radius[1], default);
            entity
        };
        let entity = match *filter {
            FilterDesc::Gaussian { radius: [1.5, 1.5], sigma: 0.5 } => return,
            FilterDesc::Box { radius } => radii("box", radius, 0.5),
            FilterDesc::Triangle { radius } => radii("triangle", radius, 2.0),
            FilterDesc::Gaussian { radius, sigma } => {
                let mut entity = radii("gaussian", radius, 1.5);
                entity.float_unless("sigma", sigma, 0.5);
                entity
            }
            FilterDesc::Mitchell { radius, b, c } => {
                let mut entity = radii("mitchell", radius, 2.0);
                entity.float_unless("B", b, 1.0 / 3.0);
                entity.float_unless("C", c, 1.0 / 3.0);
                entity
            }
            FilterDesc::Sinc { radius, tau } => {
                let mut entity = radii("sinc", radius, 4.0);
                entity.float_unless("tau", tau, 3.0);
                entity
            }
        };
        self.entity(entity);
    }

    fn film(&mut self, film: &FilmDesc) {
        let space = [Space::Camera, Space::World].into_iter().find(|space| film.layers == in_space(*space));
        if space.is_none() && !film.layers.is_empty() {
            self.lacks(film.span, "these layers of the film");
        }
        let mut entity = Entity::new("Film", &[if space.is_some() { "gbuffer" } else { "rgb" }]);
        if space == Some(Space::World) {
            entity.string("coordinatesystem", "world");
        }
        entity.integer("xresolution", film.width.into());
        entity.integer("yresolution", film.height.into());
        if let Some(c) = film.crop {
            entity.param("integer", "pixelbounds", &format!("[ {} {} {} {} ]", c.x0, c.x1, c.y0, c.y1));
        }
        if let Some(name) = &film.filename {
            entity.string("filename", &name.value);
        }
        let exposure = shortest(film.exposure * 100.0, |iso| iso / 100.0 == film.exposure);
        entity.float_unless("iso", exposure, 100.0);
        entity.float_unless("diagonal", film.diagonal, 35.0);
        if !film.parts.layers.is_empty() {
            let words: Vec<_> = film.parts.layers.iter().map(|layer| quoted(&layer.word())).collect();
            entity.param("string", "layers", &format!("[ {} ]", words.join(" ")));
        }
        self.entity(entity);
    }
}
