//! Placements as few words as say them exactly.
//!
//! A renderer keeps a placement as a matrix and its inverse in single precision, both made in double precision. Words that
//! make the same two are the same placement.

use glam::{DMat4, DVec3};
use tyndall::math::Transform;

/// Whether two matrices are the same placement.
pub(super) fn same(a: DMat4, b: DMat4) -> bool {
    Transform::new(a).is_some_and(|a| Transform::new(b) == Some(a))
}

/// A placement in words; where it stands for more than one step, a scale comes before a translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    /// Where things are anyway.
    Identity,
    /// A scale along the axes, then a translation.
    Steps {
        /// Factors, if they are not all 1.
        scale: Option<DVec3>,
        /// The way, if it is not zero.
        translation: Option<DVec3>,
    },
    /// Neither.
    Matrix(DMat4),
}

impl Place {
    /// The words for a matrix.
    pub(super) fn of(m: DMat4) -> Self {
        let (scale, translation) = (DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z), m.w_axis.truncate());
        let steps = DMat4::from_translation(translation) * DMat4::from_scale(scale);
        if m != steps {
            return Self::Matrix(m);
        }
        let scale = (scale != DVec3::ONE).then_some(scale);
        let translation = (translation != DVec3::ZERO).then_some(translation);
        match (scale, translation) {
            (None, None) => Self::Identity,
            (scale, translation) => Self::Steps { scale, translation },
        }
    }
}

/// Eye, target and direction upwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Look {
    pub(super) eye: DVec3,
    pub(super) target: DVec3,
    pub(super) up: DVec3,
}

impl Look {
    /// What places something at the origin of `to_world` with its +z and +y, to the last bit: `made` is what a reader makes of
    /// it. It is there for every view that a person wrote by it.
    pub(super) fn at(to_world: DMat4, made: impl Fn(Self) -> Option<DMat4>) -> Option<Self> {
        let eye = to_world.w_axis.truncate();
        let (z, y) = (to_world.z_axis.truncate(), to_world.y_axis.truncate());
        let targets: Vec<_> = targets(eye, z).collect();
        // An axis as the direction upwards is the one that a person would have written, that nearest to it first.
        let mut axes = [DVec3::Y, DVec3::Z, DVec3::X, -DVec3::Y, -DVec3::Z, -DVec3::X];
        axes.sort_by(|a, b| y.dot(*b).total_cmp(&y.dot(*a)));
        let ups = axes.into_iter().chain([y]);
        let mut looks = ups.flat_map(|up| targets.iter().map(move |target| Self { eye, target: *target, up }));
        looks.find(|look| made(*look) == Some(to_world))
    }
}

/// A point that lies in this direction, in single precision and with few digits. It depends on nothing but the direction in
/// single precision: whoever reads it and writes it again writes the same.
pub(super) fn target(from: DVec3, axis: DVec3) -> Option<DVec3> {
    let axis = axis.try_normalize()?.as_vec3();
    let is_right = |to: DVec3| (to - from).try_normalize().is_some_and(|read| read.as_vec3() == axis);
    targets(from, axis.as_dvec3()).find(|to| is_right(*to))
}

/// Points along a direction: those in a plane between the axes, rounded, are often what a person wrote.
fn targets(from: DVec3, dir: DVec3) -> impl Iterator<Item = DVec3> {
    let planes = (0..3).map(|i| -from[i] / dir[i]);
    let steps = (0..3).map(|i| 1.0 / dir[i].abs());
    let distances = planes.chain(steps).chain([1.0, 10.0, 0.1, from.length(), 100.0]);
    let distances: Vec<_> = distances.filter(|d| (1e-12..1e12).contains(d)).collect();
    let exact = distances.clone().into_iter().map(move |d| from + d * dir);
    let with = move |digits: f64, d: f64| rounded(from + d * dir, digits, d.max(from.length()));
    let few = [6.0, 9.0, 13.0]
        .into_iter()
        .flat_map(move |digits| distances.clone().into_iter().map(move |d| with(digits, d)));
    few.chain(exact)
}

/// To some digits of a length.
fn rounded(v: DVec3, digits: f64, size: f64) -> DVec3 {
    let unit = 10f64.powf((digits - size.log10()).clamp(-300.0, 300.0).floor());
    let rounded = (v * unit).round() / unit;
    if rounded.is_finite() { rounded } else { v }
}

/// How much larger the xy plane is in a space, if it is, and the same in all directions.
pub(super) fn width(m: DMat4) -> f64 {
    let length = m.x_axis.truncate().length();
    let short = rounded(DVec3::splat(length), 13.0, length).x;
    if short > 0.0 && short.is_finite() { short } else { 1.0 }
}

/// That as a matrix.
pub(super) fn widened(width: f64) -> DMat4 {
    DMat4::from_scale(DVec3::new(width, width, 1.0))
}

/// A matrix whose inverse is this placement, where there is one to the last bit.
pub(super) fn inverse_of(m: DMat4) -> DMat4 {
    let inverse = m.inverse();
    let size = inverse.to_cols_array().iter().fold(0.0f64, |size, v| size.max(v.abs()));
    // What would be zero but for rounding.
    let clean = DMat4::from_cols_array(&inverse.to_cols_array().map(|v| if v.abs() < 1e-15 * size { 0.0 } else { v }));
    [inverse, clean].into_iter().find(|candidate| same(candidate.inverse(), m)).unwrap_or(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a spot at (-230, 150, 150) that shines at (-13, 3, 19) and of others like it.
    #[test]
    fn a_target_that_is_read_and_written_again_stays_where_it_is() {
        let coordinate = |i: u32| (f64::from(i) * 12.9898).sin() * 43758.5453 % 300.0;
        let place = |i: u32| DVec3::new(coordinate(3 * i), coordinate(3 * i + 1), coordinate(3 * i + 2)).round();
        let known = (DVec3::new(-230.0, 150.0, 150.0), DVec3::new(-13.0, 3.0, 19.0));
        for (from, to) in (0..200).map(|i| (place(2 * i), place(2 * i + 1))).chain([known]) {
            let once = target(from, to - from).unwrap();
            assert_eq!((once - from).normalize().as_vec3(), (to - from).normalize().as_vec3());
            assert_eq!(target(from, once - from), Some(once), "{from} {to}");
        }
        let table = DVec3::new(4.0, 0.0, -7.0);
        assert_eq!(target(known.0, table - known.0), Some(table));
    }

    #[test]
    fn scales_and_translations_are_words_and_all_else_is_numbers() {
        let translation = DVec3::new(1.0, 0.1, -3.0);
        let m = DMat4::from_translation(translation) * DMat4::from_scale(DVec3::new(2.0, 2.0, 0.3));
        let steps = Place::Steps { scale: Some(DVec3::new(2.0, 2.0, 0.3)), translation: Some(translation) };
        assert_eq!(Place::of(m), steps);
        assert_eq!(Place::of(DMat4::IDENTITY), Place::Identity);
        let turned = DMat4::from_rotation_x(0.3);
        assert_eq!(Place::of(turned), Place::Matrix(turned));
    }
}
