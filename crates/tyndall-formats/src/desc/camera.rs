//! The camera and its film.

use glam::DMat4;

use super::{MediumId, Span, Spanned};

/// A perspective camera.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraDesc {
    /// The words that made it.
    pub span: Span,
    /// Camera space to world: the camera sits at the origin, looks along +z, +x is right in the image, +y is up.
    pub to_world: DMat4,
    /// Field of view \[degrees\], in (0, 180).
    pub fov: Spanned<f64>,
    /// The side of the image that the field of view spans.
    pub fov_axis: FovAxis,
    /// Width over height of the picture, if it is not that of the film.
    pub aspect: Option<Spanned<f64>>,
    /// pbrt's screen window `[x_min, x_max, y_min, y_max]`, in which 1 is half the field of view; it replaces the aspect.
    pub screen_window: Option<Spanned<[f64; 4]>>,
    /// The medium that the camera is in, if the file says.
    pub medium: Option<Spanned<MediumId>>,
}

/// The side of an image that a field of view spans.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FovAxis {
    /// The width.
    X,
    /// The height.
    Y,
    /// The shorter of the two (pbrt).
    Smaller,
    /// The longer of the two.
    Larger,
    /// Corner to corner.
    Diagonal,
}

/// The part of the plane z = 1 in camera space that the whole film sees (a crop is a part of it).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageWindow {
    /// x at the left edge.
    pub left: f64,
    /// x at the right edge.
    pub right: f64,
    /// y at the lower edge.
    pub bottom: f64,
    /// y at the upper edge.
    pub top: f64,
}

impl CameraDesc {
    /// What a film of `width` × `height` pixels sees of the plane z = 1.
    pub fn window(&self, width: u32, height: u32) -> ImageWindow {
        let half = (self.fov.value.to_radians() / 2.0).tan();
        if let Some(Spanned { value: [left, right, bottom, top], .. }) = self.screen_window {
            return ImageWindow { left: left * half, right: right * half, bottom: bottom * half, top: top * half };
        }
        let aspect = self.aspect.map_or(width as f64 / height as f64, |a| a.value);
        let wide = aspect > 1.0;
        // Half the width and half the height, from the one that is known.
        let (x, y) = match (self.fov_axis, wide) {
            (FovAxis::X, _) | (FovAxis::Smaller, false) | (FovAxis::Larger, true) => (half, half / aspect),
            (FovAxis::Y, _) | (FovAxis::Smaller, true) | (FovAxis::Larger, false) => (half * aspect, half),
            (FovAxis::Diagonal, _) => {
                let y = half / aspect.hypot(1.0);
                (y * aspect, y)
            }
        };
        ImageWindow { left: -x, right: x, bottom: -y, top: y }
    }
}

/// The film.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmDesc {
    /// The words that made it.
    pub span: Span,
    /// Width of the whole image \[pixels\], at least 1.
    pub width: u32,
    /// Height of the whole image \[pixels\], at least 1.
    pub height: u32,
    /// The part to render, if not all.
    pub crop: Option<CropDesc>,
    /// Where to write the image, if the file says.
    pub filename: Option<Spanned<String>>,
    /// Reconstruction filter.
    pub filter: FilterDesc,
    /// Factor on every value (pbrt: `iso` / 100 × time that the shutter is open), 1 by default.
    pub exposure: f64,
}

/// A rectangle of pixels, from the upper left: `x0 ≤ x < x1`, `y0 ≤ y < y1`, not empty and within the film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CropDesc {
    /// First column.
    pub x0: u32,
    /// First row.
    pub y0: u32,
    /// One past the last column.
    pub x1: u32,
    /// One past the last row.
    pub y1: u32,
}

/// A reconstruction filter. Radii are half widths \[pixels\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilterDesc {
    /// Flat.
    Box {
        /// Radii in x and y.
        radius: [f64; 2],
    },
    /// A tent.
    Triangle {
        /// Radii in x and y.
        radius: [f64; 2],
    },
    /// A Gaussian, less its value at the radius so that it ends at 0.
    Gaussian {
        /// Radii in x and y.
        radius: [f64; 2],
        /// Standard deviation \[pixels\].
        sigma: f64,
    },
    /// Mitchell and Netravali's cubic.
    Mitchell {
        /// Radii in x and y.
        radius: [f64; 2],
        /// Their B.
        b: f64,
        /// Their C.
        c: f64,
    },
    /// A sinc, windowed by a wider one (Lanczos).
    Sinc {
        /// Radii in x and y.
        radius: [f64; 2],
        /// Cycles of the sinc before the window ends.
        tau: f64,
    },
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::FileId;

    fn camera(fov_axis: FovAxis) -> CameraDesc {
        let span = Span::new(FileId(0), 0, 0);
        CameraDesc {
            span,
            to_world: DMat4::IDENTITY,
            fov: Spanned::new(90.0, span),
            fov_axis,
            aspect: None,
            screen_window: None,
            medium: None,
        }
    }

    /// tan 45° = 1, so a field of view of 90° reaches to ±1 along its own axis.
    #[test]
    fn the_field_of_view_spans_its_axis() {
        let corner = |axis, width, height| {
            let w = camera(axis).window(width, height);
            assert_eq!((w.left, w.bottom), (-w.right, -w.top));
            (w.right, w.top)
        };
        let near = |(x, y): (f64, f64), (u, v): (f64, f64)| (x - u).abs() < 1e-12 && (y - v).abs() < 1e-12;
        assert!(near(corner(FovAxis::X, 200, 100), (1.0, 0.5)));
        assert!(near(corner(FovAxis::Y, 200, 100), (2.0, 1.0)));
        assert!(near(corner(FovAxis::Smaller, 200, 100), (2.0, 1.0)));
        assert!(near(corner(FovAxis::Smaller, 100, 200), (1.0, 2.0)));
        assert!(near(corner(FovAxis::Larger, 200, 100), (1.0, 0.5)));
        assert!(near(corner(FovAxis::Larger, 100, 200), (0.5, 1.0)));
        // A 3:4:5 triangle: the half diagonal is 1.
        assert!(near(corner(FovAxis::Diagonal, 400, 300), (0.8, 0.6)));
    }
}
