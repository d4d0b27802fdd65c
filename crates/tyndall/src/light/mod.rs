//! Where light comes from: emitting surfaces, points, spots, distant suns and environments.

pub mod area;
pub mod beam;
pub mod bounds;
pub mod choose;
pub mod distant;
pub mod environment;
pub mod goniometric;
mod hierarchy;
mod patch;
pub mod pattern;
pub mod point;
pub mod portal;
pub mod projector;
pub mod revolved;
pub mod sky;
pub mod slide;
pub mod spot;

pub(crate) use area::Point;
pub use area::{AreaLight, EmitterShape};
pub use beam::Beam;
pub use choose::LightTable;
pub use distant::Distant;
pub use environment::{ConstantEnvironment, EnvironmentMap, Projection};
pub use goniometric::Goniometric;
pub use pattern::{Coordinates, Pattern};
pub use point::PointLight;
pub use portal::{Portal, PortalError};
pub use projector::{Even, Projector};
pub use revolved::Revolved;
pub use sky::{SkyError, SkyImage};
pub use slide::Slide;
pub use spot::{Falloff, SpotLight};

use crate::{
    bend::Goal,
    math::{Bounds, Vec2, Vec3},
    spectrum::{Lanes, Wavelengths},
};

/// Index of a light of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct LightId(pub u32);

/// From where a light is looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// The point [length].
    pub p: Vec3,
    /// The shading normal, at a surface that does not let light through; `None` when light may come from all sides.
    pub normal: Option<Vec3>,
}

/// The end of a shadow ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// A point in space.
    Point(Vec3),
    /// A point on a surface that must not shadow itself.
    Surface {
        /// The point [length].
        p: Vec3,
        /// Bound on its rounding error, per axis [length].
        error: Vec3,
        /// The surface's unit normal.
        ng: Vec3,
    },
    /// Infinitely far away.
    Infinity,
}

/// Light that arrives at a reference if nothing stands in the way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightSample {
    /// Unit direction from the reference to the light.
    pub dir: Vec3,
    /// Radiance [W·m⁻²·sr⁻¹]; for a Dirac light, the irradiance it makes on a plane facing it [W·m⁻²].
    pub li: Lanes,
    /// Density over solid angle [1/sr]; 1 for a Dirac light.
    pub pdf: f32,
    /// Whether the light is a Dirac in direction, so that no other technique can find it.
    pub dirac: bool,
    /// Where the light is.
    pub target: Target,
}

/// A light of the scene.
#[derive(Debug, Clone)]
pub enum Light {
    /// An emitting surface.
    Area(AreaLight),
    /// A point that shines alike in all directions.
    Point(PointLight),
    /// A point that shines into a cone.
    Spot(SpotLight),
    /// Parallel light.
    Distant(Distant),
    /// A uniform sky.
    Constant(ConstantEnvironment),
    /// A sky with an image.
    Map(Box<EnvironmentMap>),
    /// A sky behind an opening.
    Portal(Box<Portal>),
    /// A point that was measured in all directions.
    Goniometric(Box<Goniometric>),
    /// A point that shines through a picture.
    Projector(Box<Projector>),
    /// A flat surface that shines straight ahead.
    Beam(Beam),
}

impl Light {
    /// A direction towards the light; `None` when this light cannot reach the reference.
    #[inline]
    pub fn sample(&self, from: &Reference, u: Vec2, wavelengths: &Wavelengths) -> Option<LightSample> {
        match self {
            Self::Area(l) => l.sample(from, u, wavelengths),
            Self::Point(l) => l.sample(from, wavelengths),
            Self::Spot(l) => l.sample(from, wavelengths),
            Self::Distant(l) => Some(l.sample(wavelengths)),
            Self::Constant(l) => Some(l.sample(from, u, wavelengths)),
            Self::Map(l) => l.sample(u, wavelengths),
            Self::Portal(l) => l.sample(from.p, u, wavelengths),
            Self::Goniometric(l) => l.sample(from, wavelengths),
            Self::Projector(l) => l.sample(from, wavelengths),
            Self::Beam(l) => l.sample(from, wavelengths),
        }
    }

    /// Density [1/sr] with which [`Self::sample`] finds the point `p` of an emitting surface with unit normal `ng`.
    #[inline]
    pub fn pdf_at(&self, from: &Reference, p: Vec3, ng: Vec3) -> f32 {
        match self {
            Self::Area(l) => l.pdf(from, p, ng),
            _ => 0.0,
        }
    }

    /// Density [1/sr] with which [`Self::sample`] finds a direction of the environment.
    #[inline]
    pub fn pdf_towards(&self, from: &Reference, dir: Vec3) -> f32 {
        match self {
            Self::Constant(l) => l.pdf(from, dir),
            Self::Map(l) => l.pdf(dir),
            Self::Portal(l) => l.pdf(from.p, dir),
            _ => 0.0,
        }
    }

    /// Radiance that comes from infinity out of direction `dir` to the point `from`, the last vertex of a path
    /// [W·m⁻²·sr⁻¹].
    #[inline]
    pub fn le_from_infinity(&self, from: Vec3, dir: Vec3, wavelengths: &Wavelengths) -> Lanes {
        match self {
            Self::Constant(l) => l.radiance.eval(wavelengths),
            Self::Map(l) => l.le(dir, wavelengths),
            Self::Portal(l) => l.le(from, dir, wavelengths),
            _ => Lanes::ZERO,
        }
    }

    /// Whether the light surrounds the scene, so that escaping rays find it.
    pub fn is_environment(&self) -> bool {
        matches!(self, Self::Constant(_) | Self::Map(_) | Self::Portal(_))
    }

    /// Whether only light sampling finds it, since no path runs into it: a Dirac light, or one on a surface that is not
    /// there.
    pub fn is_hidden(&self) -> bool {
        match self {
            Self::Area(l) => l.opacity == 0.0,
            Self::Point(_)
            | Self::Spot(_)
            | Self::Distant(_)
            | Self::Goniometric(_)
            | Self::Projector(_)
            | Self::Beam(_) => true,
            Self::Constant(_) | Self::Map(_) | Self::Portal(_) => false,
        }
    }

    /// Whether light samples of it through walls that bend light are worth while: not of a sky that is the same everywhere,
    /// which paths find as well, nor through a portal, nor of what only light sampling finds.
    pub fn is_worth_bending(&self) -> bool {
        match self {
            Self::Area(_) => !self.is_hidden(),
            Self::Map(_) => true,
            _ => false,
        }
    }

    /// Whether light leaves a goal that is sampled of it towards `dir`.
    pub fn shines_towards(&self, goal: &Goal, dir: Vec3) -> bool {
        match (self, goal) {
            (Self::Area(light), Goal::Point { ng, .. }) => light.two_sided || ng.dot(dir) > 0.0,
            _ => true,
        }
    }

    /// Density with which [`Self::sample`] finds a goal: over the area across a ray along `onward` that arrives there
    /// [1/length²], or over the solid angle of its directions if it is infinitely far away [1/sr].
    pub fn pdf_across(&self, from: &Reference, goal: &Goal, onward: Vec3) -> f32 {
        match (self, *goal) {
            (Self::Area(light), Goal::Point { p, ng }) if light.shows(from.p, p, ng) => {
                let straight = p - from.p;
                let d2 = straight.length_squared();
                let turned = (straight.dot(ng) / onward.dot(ng)).abs() / d2.sqrt();
                light.pdf(from, p, ng) * turned / d2
            }
            (_, Goal::Infinity(dir)) => self.pdf_towards(from, dir),
            _ => 0.0,
        }
    }

    /// A guess at the irradiance that the light makes at `p` [W·m⁻²]: zero only where the light certainly is.
    #[inline]
    pub fn importance(&self, p: Vec3) -> f32 {
        match self {
            Self::Area(l) => l.importance(p),
            Self::Point(l) => l.luminance / l.position.distance_squared(p).max(f32::MIN_POSITIVE),
            Self::Spot(l) => l.importance(p),
            Self::Distant(l) => l.luminance,
            Self::Constant(l) => l.luminance * std::f32::consts::PI,
            Self::Map(l) => l.mean_luminance * std::f32::consts::PI,
            Self::Portal(l) => l.importance(p),
            Self::Goniometric(l) => l.importance(p),
            Self::Projector(l) => l.importance(p),
            Self::Beam(l) => l.importance(p),
        }
    }

    /// The same without a place, for lights that are infinitely far away.
    pub(crate) fn importance_at_large(&self) -> f32 {
        match self {
            Self::Portal(l) => l.importance_at_large(),
            other => other.importance(Vec3::ZERO),
        }
    }

    /// Where the light is, for lights that are somewhere.
    pub fn bounds(&self) -> Option<Bounds> {
        match self {
            Self::Area(l) => Some(l.shape.bounds()),
            Self::Point(l) => Some(Bounds::of([l.position])),
            Self::Spot(l) => Some(Bounds::of([l.position])),
            Self::Goniometric(l) => Some(Bounds::of([l.position()])),
            Self::Projector(l) => Some(Bounds::of([l.position])),
            Self::Beam(l) => Some(l.shape.bounds()),
            Self::Distant(_) | Self::Constant(_) | Self::Map(_) | Self::Portal(_) => None,
        }
    }
}
