//! Packs of grains: a [`container`], a [`form`], [`radii`], random sequential addition ([`pack`]) or settling ([`settle`]), the
//! part of space that is grain ([`bulk`]), and the free path of light between the grains, by rays and by formula
//! ([`free_path`]); what a grain does to light ([`scattering`]), and the medium that stands for all of them ([`proxy`]). Lengths have whatever unit the caller has.

pub mod bulk;
pub mod container;
pub mod form;
pub mod free_path;
pub mod pack;
pub mod proxy;
pub mod radii;
pub mod scattering;
pub mod settle;
pub mod solid;

mod grid;
mod walls;

use std::ops::RangeInclusive;

use tyndall::sampling::Rng;

/// What cannot be packed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GrainError {
    /// A text that is no container or no distribution.
    #[error("`{text}` is not {wanted}")]
    Syntax {
        /// What was written.
        text: String,
        /// What may be written.
        wanted: &'static str,
    },
    /// A length outside of [`LENGTHS`], or no number.
    #[error("`{text}`: {what} must be between {:e} and {:e}", LENGTHS.start(), LENGTHS.end())]
    Length {
        /// What was written.
        text: String,
        /// Which length.
        what: &'static str,
    },
    /// The largest grain is larger than the container.
    #[error("a grain of radius {radius} does not fit into the container: the largest that does has {room}")]
    TooLarge {
        /// Largest radius asked for.
        radius: f64,
        /// Largest that fits.
        room: f64,
    },
    /// The largest grain is so small beside the container that lines through it would take forever.
    #[error("grains of radius {radius} are too small for the container: at least {least} is wanted")]
    TooSmall {
        /// Largest radius asked for.
        radius: f64,
        /// Least that is allowed.
        least: f64,
    },
    /// Not one has found a place.
    #[error(
        "no grain finds a place in the container: it is too narrow for the shape of the grains, or packing was interrupted"
    )]
    NoRoom,
    /// A mesh that bounds no body.
    #[error("the mesh {0}")]
    Mesh(String),
    /// Rigid bodies of such different sizes cannot be followed together.
    #[error("grains that settle may differ tenfold in radius, not from {smallest} to {largest}")]
    Varied {
        /// Smallest radius asked for.
        smallest: f64,
        /// Largest.
        largest: f64,
    },
    /// More than [`settle::MOST`].
    #[error("{0} grains: at most 300 thousand can settle; random sequential addition packs 10 million")]
    Settling(u64),
    /// A coefficient of friction.
    #[error("friction of {0}: between 0 and 10 is possible")]
    Friction(f64),
    /// Grains that have settled and do not fill a mesh: where they end, no medium could.
    #[error(
        "the grains do not fill the mesh to its top: a medium can stand for them in a box, a cylinder, a sphere or a full mesh"
    )]
    NotFull,
    /// More grains than [`pack::MOST`], or none.
    #[error("{0} grains: between 1 and 10 million can be packed")]
    Count(u64),
}

/// The next number of a stream, in (0, 1), with 32 random bits: as fine as the places of ten million grains want.
fn uniform(rng: &mut Rng) -> f64 {
    (f64::from(rng.next_u32()) + 0.5) / 4_294_967_296.0
}

/// Lengths whose third powers and their sums are numbers.
pub const LENGTHS: RangeInclusive<f64> = 1e-30..=1e30;

/// The numbers of a text `NAME:a:b`, all of them lengths.
fn lengths(text: &str, numbers: &str, what: &'static str, wanted: &'static str) -> Result<Vec<f64>, GrainError> {
    let syntax = || GrainError::Syntax { text: text.to_owned(), wanted };
    let lengths: Vec<f64> = numbers.split(':').map(|n| n.parse().map_err(|_| syntax())).collect::<Result<_, _>>()?;
    if lengths.iter().all(|length| LENGTHS.contains(length)) {
        Ok(lengths)
    } else {
        Err(GrainError::Length { text: text.to_owned(), what })
    }
}
