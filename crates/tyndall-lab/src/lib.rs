//! Virtual instruments: what an optical bench would measure, from the renderer's own media, phase functions, boundaries
//! and random walks.
//!
//! | instrument | what it measures |
//! |---|---|
//! | [`slab`] | plane layers: reflectance, transmittance, absorption; by angle, radius, depth, order, path length |
//! | [`beam`] | a narrow beam on a half-space, slab, ball, box or mesh: R(r), and the picture of what comes back |
//! | [`ball`] | a scattering sphere: what it absorbs, what escapes |
//! | [`furnace`] | any scene in uniform light: energy kept, lost or made, and where |
//! | [`gonio`] | a surface, a phase function, layers or a grain: what leaves, by direction |
//! | [`point`] | an isotropic point source in an infinite medium: fluence against distance |
//! | [`walk`] | moments of a random walk |
//! | [`separate`] | direct and global light, by patterns that a projector throws |
//!
//! [`photon`] launches photons and lets an instrument watch them; [`run`] repeats that until the figures are good enough,
//! each with its standard error; [`verify`] holds the figures against published numbers.
//!
//! Lengths are in any unit, coefficients per that unit. Powers are fractions of the light that is sent in.

pub mod ball;
pub mod beam;
pub mod diffusion;
pub mod furnace;
pub mod gonio;
pub mod mci;
pub mod photon;
pub mod point;
pub mod run;
pub mod separate;
pub mod slab;
pub mod verify;
pub mod walk;
pub mod world;
