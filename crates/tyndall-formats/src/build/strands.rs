//! Hair: strands and what they are made of.

use tyndall::{
    material::{HairColour, HairTextures, Pigments},
    math::{Transform, Vec3},
    shape::{Basis, Curves, Knot, Style},
};

use super::{Builder, spectra::Measure};
use crate::{
    desc::{CurveDesc, HairColourDesc, HairDesc, MaterialKind, Radii, ShapeDesc, StrandsDesc},
    error::SceneError,
    mesh::{Strand, read_strands},
};

impl Builder<'_> {
    pub(super) fn hair(&mut self, desc: &HairDesc) -> Option<HairTextures> {
        if let Some(eta) = desc.eta.value.number()
            && eta <= 1.0
        {
            let error = SceneError::at(desc.eta.span, format!("the index of a fibre must be above 1, not {eta}"));
            return self.fail(error.help("that of hair is 1.55"));
        }
        let colour = match &desc.colour {
            HairColourDesc::SigmaA(sigma_a) => HairColour::SigmaA(self.texture(sigma_a, Measure::Coefficient)?),
            HairColourDesc::Reflectance(colour) => HairColour::Reflectance(self.texture(colour, Measure::Share)?),
            HairColourDesc::Pigments { eumelanin, pheomelanin } => {
                let [eumelanin, pheomelanin] =
                    [eumelanin, pheomelanin].map(|amount| self.texture(amount, Measure::Coefficient));
                HairColour::Pigments(Box::new(Pigments::new(eumelanin?, pheomelanin?)))
            }
        };
        Some(HairTextures {
            colour,
            eta: self.texture(&desc.eta, Measure::Index)?,
            beta_m: self.texture(&desc.beta_m, Measure::Share)?,
            beta_n: self.texture(&desc.beta_n, Measure::Share)?,
            alpha: self.texture(&desc.alpha, Measure::Number)?,
        })
    }

    /// Strands have no area to shine with, no inside, and no relief.
    pub(super) fn check_strands(&mut self, shape: &ShapeDesc) -> Option<()> {
        let related = |error: SceneError| error.related(shape.span, "these strands");
        if let Some(light) = &shape.emission {
            return self.fail(related(SceneError::not_yet(light.span, "strands cannot shine yet")));
        }
        if let Some(interface) = &shape.interface {
            let error = SceneError::at(interface.span, "strands have no inside that a medium could be in");
            return self.fail(related(error.help("what light does within them is for the material \"hair\"")));
        }
        let material = self.desc.material(shape.material.value).map(|material| &material.kind);
        match material {
            Some(MaterialKind::Embossed { .. }) => {
                let error = SceneError::not_yet(shape.material.span, "strands cannot have a relief yet");
                self.fail(related(error.help("leave the bump or normal map out")))
            }
            Some(MaterialKind::Dielectric { .. }) if style(shape) == Some(Style::Round) => {
                let error = SceneError::at(shape.material.span, "light that is in a strand does not meet it again");
                self.fail(related(error.help("fibres that light goes through are of the material \"hair\"")))
            }
            _ => Some(()),
        }
    }
}

/// The strands of a file, and where they are to be placed if their shape is to be placed there.
pub(crate) fn strands(desc: &StrandsDesc, to_world: &Transform) -> Result<(Curves, Transform), SceneError> {
    let read = read_strands(&desc.path.value);
    let mut strands = read.map_err(|error| SceneError::at(desc.path.span, error.to_string()))?;
    let placed = match desc.radii {
        Radii::Own => *to_world,
        Radii::World => {
            let map = to_world.matrix.as_dmat4();
            for knot in strands.iter_mut().flatten() {
                knot.p = map.transform_point3(knot.p.as_dvec3()).as_vec3();
            }
            Transform::IDENTITY
        }
    };
    let mut curves = Curves::new(desc.style);
    for (number, strand) in strands.iter().enumerate() {
        let knots = with_ends(desc.basis, strand);
        if desc.basis.segments(knots.len()).is_none() {
            let (path, count) = (desc.path.value.display(), strand.len());
            let problem = format!("{path}: strand {number} has {count} points, which make no whole number of segments");
            let error = SceneError::at(desc.path.span, problem);
            return Err(error.help(format!("the first segment of this curve takes {}", desc.basis.points())));
        }
        curves.push(desc.basis, &knots);
    }
    Ok((curves, placed))
}

/// A curve that does not reach the ends of its points has them once more, mirrored.
fn with_ends(basis: Basis, strand: &Strand) -> Strand {
    match (basis, &strand[..]) {
        (Basis::CatmullRom, [first, second, ..]) => {
            let (last, before) = (strand[strand.len() - 1], strand[strand.len() - 2]);
            [&[beyond(*first, *second)], &strand[..], &[beyond(last, before)]].concat()
        }
        _ => strand.clone(),
    }
}

fn beyond(end: Knot, next: Knot) -> Knot {
    Knot { p: end.p * 2.0 - next.p, radius: end.radius }
}

/// A strand that is written down.
pub(crate) fn strand(desc: &CurveDesc) -> Curves {
    let vectors = |list: &[[f32; 3]]| list.iter().copied().map(Vec3::from_array).collect::<Vec<_>>();
    let mut curves = Curves::new(desc.style);
    curves.push_tapered(desc.basis, &vectors(&desc.points), desc.widths.map(|width| 0.5 * width as f32));
    curves.orient(&vectors(&desc.normals));
    curves
}

fn style(shape: &ShapeDesc) -> Option<Style> {
    match &shape.kind {
        crate::desc::ShapeKind::Curve(curve) => Some(curve.style),
        crate::desc::ShapeKind::Strands(strands) => Some(strands.style),
        _ => None,
    }
}
