//! What a path goes through, one event at a time: where it is turned, and where its light comes from.

use crate::{light::LightId, medium::MediumId, shape::ObjectId};

/// How sharply a surface scatters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// By a Dirac lobe: a mirror, clear glass, the polish over paint.
    Specular,
    /// By any other law than Lambert's, with what lies beneath it.
    Glossy,
    /// By Lambert's law.
    Diffuse,
}

/// A scattering.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Turn {
    /// At a surface.
    Surface {
        /// Which.
        object: ObjectId,
        /// Whether the path goes on on the other side.
        crossed: bool,
        /// By which lobe.
        kind: Kind,
    },
    /// In a medium.
    Medium(MediumId),
}

/// Where light comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// From a light.
    Light(LightId),
    /// From a medium that glows. Of those that share a place, it bears the name of one, as likely as that scatters there.
    Medium(MediumId),
    /// From infinity.
    Sky(LightId),
    /// From nowhere: a weight that is no number, for the film to count.
    Fault,
}
