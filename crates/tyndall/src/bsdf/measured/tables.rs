//! The tables of a measured material, checked and brought to the colours of a render.

use std::f32::consts::TAU;

use super::grid::{Block, Grid, GridError};
use crate::spectrum::{ColorMode, cie, srgb};

/// What a file of a measured material has.
#[derive(Debug, Clone)]
pub struct Parts {
    /// Polar angles [rad] of the directions from which it was seen.
    pub theta: Vec<f32>,
    /// Their azimuths [rad]; at most two of an isotropic material.
    pub phi: Vec<f32>,
    /// The density of normals, by the unit square.
    pub normals: Block,
    /// The projected area of facets.
    pub area: Block,
    /// The density of visible normals, by azimuth and polar angle.
    pub visible: Block,
    /// The luminance in the adapted places, by azimuth and polar angle.
    pub luminance: Block,
    /// The values in the adapted places, by azimuth, polar angle, and channel.
    pub spectra: Block,
    /// The channels.
    pub channels: Channels,
    /// Whether the values lack the factor of the facets.
    pub jacobian: bool,
}

/// What the values of a measured material are.
#[derive(Debug, Clone, PartialEq)]
pub enum Channels {
    /// Linear sRGB.
    Rgb,
    /// Shares of the light at these wavelengths [nm].
    Wavelengths(Vec<f32>),
}

/// Why there is no material in the parts of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum TablesError {
    /// What is the matter with one of its blocks.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// It was measured over a part of the azimuths that is no whole, half or quarter.
    #[error("its azimuths cover neither all directions, nor a half, nor a quarter of them")]
    Azimuths,
    /// It has no spectra.
    #[error("it has colours and no spectra, so that it cannot be drawn in spectral mode")]
    NoSpectra,
}

/// A measured material, ready to be looked up.
#[derive(Debug, Clone)]
pub struct Tables {
    pub(super) normals: Grid,
    pub(super) area: Grid,
    pub(super) visible: Grid,
    pub(super) luminance: Grid,
    pub(super) spectra: Grid,
    pub(super) isotropic: bool,
    pub(super) jacobian: bool,
    /// In how many parts of the azimuths the material is the same: 1, 2 or 4.
    pub(super) symmetry: u8,
}

impl Tables {
    /// The material in the colours of a render.
    ///
    /// # Errors
    /// [`TablesError`].
    pub fn new(parts: Parts, color: ColorMode) -> Result<Self, TablesError> {
        let Parts { theta, phi, normals, area, visible, luminance, spectra, channels, jacobian } = parts;
        let isotropic = phi.len() <= 2;
        let symmetry = if isotropic { 1 } else { symmetry(&phi).ok_or(TablesError::Azimuths)? };
        let (spectra, channels) = in_color(spectra, channels, color)?;
        let view = || vec![phi.clone(), theta.clone()];
        Ok(Self {
            normals: Grid::function(normals, Vec::new())?,
            area: Grid::function(area, Vec::new())?,
            visible: Grid::density(visible, view())?,
            luminance: Grid::density(luminance, view())?,
            spectra: Grid::function(spectra, vec![phi.clone(), theta.clone(), channels])?,
            isotropic,
            jacobian,
            symmetry,
        })
    }
}

/// Into how many parts that are the same the azimuths divide.
fn symmetry(phi: &[f32]) -> Option<u8> {
    let covered = phi.last()? - phi.first()?;
    [1u8, 2, 4].into_iter().find(|n| (covered * f32::from(*n) / TAU - 1.0).abs() < 0.1)
}

/// The values in the colours of a render, and the parameter that says which is which.
fn in_color(spectra: Block, channels: Channels, color: ColorMode) -> Result<(Block, Vec<f32>), TablesError> {
    let to_rgb = match (channels, color) {
        (Channels::Wavelengths(lambda), ColorMode::Spectral) => return Ok((spectra, lambda)),
        (Channels::Rgb, ColorMode::Spectral) => return Err(TablesError::NoSpectra),
        (Channels::Wavelengths(lambda), _) => rgb_of_wavelengths(&lambda)?,
        (Channels::Rgb, _) => vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    };
    let mix: Vec<Vec<f32>> = match color {
        ColorMode::Mono => vec![to_rgb.iter().map(|rgb| srgb::luminance(*rgb)).collect()],
        _ => (0..3).map(|c| to_rgb.iter().map(|rgb| rgb[c]).collect()).collect(),
    };
    let outputs = (0..mix.len()).map(|c| c as f32).collect();
    Ok((mixed(&spectra, &mix)?, outputs))
}

/// The linear sRGB, under D65, of a spectrum that is 1 at one of the wavelengths and linear to 0 at the next ones.
fn rgb_of_wavelengths(lambda: &[f32]) -> Result<Vec<[f32; 3]>, GridError> {
    if lambda.windows(2).any(|w| w[0].partial_cmp(&w[1]) != Some(std::cmp::Ordering::Less)) {
        return Err(GridError::Parameters);
    }
    let hat = |i: usize, l: f32| {
        let side = if l < lambda[i] { i.checked_sub(1) } else { Some(i + 1) };
        match side.and_then(|j| lambda.get(j)) {
            Some(end) => (1.0 - (l - lambda[i]) / (end - lambda[i])).max(0.0),
            None => f32::from(l == lambda[i]),
        }
    };
    let rgb = |i: usize| srgb::from_xyz(cie::xyz_under_d65(lambda, |l| f64::from(hat(i, l))).map(|v| v as f32));
    Ok((0..lambda.len()).map(rgb).collect())
}

/// Each place of the third dimension of a block becomes a weighted sum over the old ones.
fn mixed(block: &Block, mix: &[Vec<f32>]) -> Result<Block, GridError> {
    let [phi, theta, channels, height, width] = block.shape[..] else { return Err(GridError::Shape) };
    let size = height.saturating_mul(width).max(1);
    let each = channels.checked_mul(size).filter(|each| *each > 0).ok_or(GridError::Shape)?;
    if mix.iter().any(|weights| weights.len() != channels) || !block.values.len().is_multiple_of(each) {
        return Err(GridError::Shape);
    }
    let mut values = Vec::with_capacity(block.values.len() / channels * mix.len());
    for view in block.values.chunks_exact(each) {
        for weights in mix {
            let at = |i: usize| view[i..].iter().step_by(size).zip(weights).map(|(v, w)| v * w).sum::<f32>();
            values.extend((0..size).map(at));
        }
    }
    Ok(Block { shape: vec![phi, theta, mix.len(), height, width], values })
}
