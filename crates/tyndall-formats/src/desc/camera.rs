//! The camera and its film.

use glam::DMat4;
use tyndall::{
    film::{LayerKind, Recorded},
    lpe::PathLayer,
    spectrum::ColorMode,
};

use super::{FileRef, MediumId, ShapeDesc, Span, Spanned};

/// A camera.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraDesc {
    /// The words that made it.
    pub span: Span,
    /// Camera space to world: the camera sits at the origin, looks along +z, +x is right in the image, +y is up.
    pub to_world: DMat4,
    /// How it sees.
    pub kind: CameraKind,
    /// Surfaces at a depth below this are not seen \[scene units\]; 0 for a camera that sees all.
    pub near: f64,
    /// The medium that the camera is in, if the file says.
    pub medium: Option<Spanned<MediumId>>,
}

/// How a camera sees.
#[derive(Clone, Debug, PartialEq)]
pub enum CameraKind {
    /// Through a pinhole or a thin lens.
    Perspective {
        /// Field of view \[degrees\], in (0, 180).
        fov: Spanned<f64>,
        /// What of it is in the picture.
        frame: FrameDesc,
        /// The lens; a pinhole without one.
        lens: Option<ThinLensDesc>,
    },
    /// By parallel rays: half the picture's reference side is 1 scene unit.
    Orthographic {
        /// What is in the picture.
        frame: FrameDesc,
    },
    /// All around.
    Spherical {
        /// How directions lie on the picture.
        mapping: SphereMapping,
    },
    /// A film behind a lens that a file describes.
    Realistic(RealisticDesc),
    /// The light that falls on a shape.
    IrradianceMeter {
        /// Index into [`super::SceneDesc::shapes`].
        shape: usize,
    },
    /// The light of one ray along +z.
    RadianceMeter,
    /// The light of parallel rays along +z from outside of the scene, to a target.
    Distant {
        /// Where they go.
        target: DistantTarget,
    },
    /// Several cameras side by side, left to right, each as wide as the others.
    Batch(Vec<CameraDesc>),
}

/// Where parallel rays go.
#[derive(Clone, Debug, PartialEq)]
pub enum DistantTarget {
    /// To the disk that the sphere around the box of the scene shows them.
    Scene,
    /// To a point in the world.
    Point([f64; 3]),
    /// To all points of a shape alike; it need not be part of the scene.
    Shape(Box<ShapeDesc>),
}

/// A thin lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinLensDesc {
    /// Radius \[scene units\], greater than 0.
    pub radius: f64,
    /// Distance of the plane in focus \[scene units\], greater than 0.
    pub focus: f64,
}

/// How directions lie on a picture of all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SphereMapping {
    /// On an equal-area octahedral square.
    EqualArea,
    /// By latitude and longitude.
    Equirectangular,
}

/// A film behind a lens of many elements.
#[derive(Clone, Debug, PartialEq)]
pub struct RealisticDesc {
    /// The lens: four numbers an element \[mm\].
    pub lens: FileRef,
    /// Diameter of the stop \[mm\].
    pub aperture_diameter: f64,
    /// Distance from the film that is in focus \[scene units\].
    pub focus_distance: Spanned<f64>,
    /// Shape of the stop.
    pub aperture: ApertureDesc,
    /// How long a millimetre of the lens is \[scene units\].
    pub millimetre: f64,
}

/// The opening of a lens's stop.
#[derive(Clone, Debug, PartialEq)]
pub enum ApertureDesc {
    /// A disk.
    Circular,
    /// A disk that lets less through towards its edge.
    Gaussian,
    /// A square.
    Square,
    /// A regular pentagon.
    Pentagon,
    /// A star of five points.
    Star,
    /// A picture over the square around the disk.
    Image(FileRef),
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

/// What part of the view is in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameDesc {
    /// The side of the image whose half is 1.
    pub axis: FovAxis,
    /// Width over height of the picture, if it is not that of the film.
    pub aspect: Option<Spanned<f64>>,
    /// pbrt's screen window `[x_min, x_max, y_min, y_max]`; it replaces the aspect.
    pub screen_window: Option<Spanned<[f64; 4]>>,
    /// How far the picture lies to the right of that and below, in its own width and height (Mitsuba's principal point).
    pub offset: [f64; 2],
}

/// The part of a plane that the whole film sees (a crop is a part of it).
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
    /// What a film of `width` × `height` pixels sees: of the plane z = 1 through a pinhole or thin lens, of the plane z = 0
    /// by parallel rays. `None` for a camera whose picture is no part of a plane.
    pub fn window(&self, width: u32, height: u32) -> Option<ImageWindow> {
        match &self.kind {
            CameraKind::Perspective { fov, frame, .. } => {
                Some(frame.window((fov.value.to_radians() / 2.0).tan(), width, height))
            }
            CameraKind::Orthographic { frame } => Some(frame.window(1.0, width, height)),
            _ => None,
        }
    }

    /// The shapes that it measures at, as indices into [`super::SceneDesc::shapes`].
    pub fn metered_shapes(&self) -> Vec<usize> {
        match &self.kind {
            CameraKind::IrradianceMeter { shape } => vec![*shape],
            CameraKind::Batch(cameras) => cameras.iter().flat_map(Self::metered_shapes).collect(),
            _ => Vec::new(),
        }
    }

    /// The files that it names.
    pub fn files(&self) -> Vec<&FileRef> {
        match &self.kind {
            CameraKind::Realistic(RealisticDesc { lens, aperture: ApertureDesc::Image(image), .. }) => {
                vec![lens, image]
            }
            CameraKind::Realistic(realistic) => vec![&realistic.lens],
            _ => Vec::new(),
        }
    }
}

impl FrameDesc {
    /// The whole film, by one of its sides.
    pub fn of_film(axis: FovAxis) -> Self {
        Self { axis, aspect: None, screen_window: None, offset: [0.0; 2] }
    }

    /// What a picture of `width` × `height` sees of a plane in which half of its reference side is `half`.
    pub(crate) fn window(&self, half: f64, width: u32, height: u32) -> ImageWindow {
        let ImageWindow { left, right, bottom, top } = self.centred(half, width, height);
        let [right_by, down_by] = self.offset;
        let (x, y) = ((right - left) * right_by, (bottom - top) * down_by);
        ImageWindow { left: left + x, right: right + x, bottom: bottom + y, top: top + y }
    }

    fn centred(&self, half: f64, width: u32, height: u32) -> ImageWindow {
        if let Some(Spanned { value: [left, right, bottom, top], .. }) = self.screen_window {
            return ImageWindow { left: left * half, right: right * half, bottom: bottom * half, top: top * half };
        }
        let aspect = self.aspect.map_or(width as f64 / height as f64, |a| a.value);
        let wide = aspect > 1.0;
        // Half the width and half the height, from the one that is known.
        let (x, y) = match (self.axis, wide) {
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
    /// Its diagonal \[mm\], which matters behind a lens.
    pub diagonal: f64,
    /// Reconstruction filter.
    pub filter: FilterDesc,
    /// What is recorded beside light.
    pub layers: Vec<LayerKind>,
    /// Parts of the light that are recorded too.
    pub parts: PartsDesc,
    /// Factor on every value (pbrt: `iso` / 100 × time that the shutter is open), 1 by default.
    pub exposure: f64,
}

/// Parts of the light, by what its paths go through.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PartsDesc {
    /// The words that ask for them, if the scene does.
    pub span: Option<Span>,
    /// They.
    pub layers: Vec<PathLayer>,
}

impl FilmDesc {
    /// How colour must be carried for what the film records: by wavelengths, if it records bands of them.
    pub fn color(&self) -> ColorMode {
        let is_light = |layer: &LayerKind| matches!(layer.recorded, Recorded::Light(_));
        if self.layers.iter().any(is_light) { ColorMode::Spectral } else { ColorMode::Rgb }
    }
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

    fn camera(axis: FovAxis) -> CameraDesc {
        let span = Span::new(FileId(0), 0, 0);
        let kind =
            CameraKind::Perspective { fov: Spanned::new(90.0, span), frame: FrameDesc::of_film(axis), lens: None };
        CameraDesc { span, to_world: DMat4::IDENTITY, kind, near: 0.0, medium: None }
    }

    /// tan 45° = 1, so a field of view of 90° reaches to ±1 along its own axis.
    #[test]
    fn the_field_of_view_spans_its_axis() {
        let corner = |axis, width, height| {
            let w = camera(axis).window(width, height).unwrap();
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
