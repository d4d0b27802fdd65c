//! `Shape "curve"`, and tyndall's own `Shape "hair"`: the strands of a file.

use tyndall::shape::{Basis, Style};

use super::param::ParamType;
use super::params::{Params, quote};
use crate::desc::{CurveDesc, Radii, ShapeKind, StrandsDesc};
use crate::error::SceneError;
use crate::source::Spanned;

/// The words of what is around a curve.
pub(crate) const STYLES: [(&str, Style); 3] =
    [("flat", Style::Flat), ("ribbon", Style::Ribbon), ("cylinder", Style::Round)];

/// The words of how points make a curve, with its degree. The last two are tyndall's own.
pub(crate) const BASES: [(&str, u32, Basis); 6] = [
    ("bezier", 3, Basis::CubicBezier),
    ("bspline", 3, Basis::CubicBSpline),
    ("bezier", 2, Basis::QuadraticBezier),
    ("bspline", 2, Basis::QuadraticBSpline),
    ("catmull-rom", 3, Basis::CatmullRom),
    ("linear", 1, Basis::Linear),
];

/// One of several words.
fn word(p: &mut Params, name: &'static str, default: &str, words: &[&'static str]) -> Option<Spanned<&'static str>> {
    let found = p.string_opt(name).unwrap_or(Spanned::new(default.to_owned(), p.span));
    if let Some(word) = words.iter().find(|word| **word == found.value) {
        return Some(Spanned::new(*word, found.span));
    }
    let message = format!("there is no {name} {}", quote(&found.value));
    p.error(SceneError::at(found.span, message).suggest(&found.value, words.iter().copied()));
    None
}

fn style(p: &mut Params, default: &str) -> Option<Style> {
    let found = word(p, "type", default, &STYLES.map(|(word, _)| word))?;
    STYLES.into_iter().find(|(word, _)| *word == found.value).map(|(_, style)| style)
}

/// A basis by its word and its degree, which is 3 unless the word or the file says otherwise.
fn basis(p: &mut Params, default: &str) -> Option<Basis> {
    let found = word(p, "basis", default, &["bezier", "bspline", "catmull-rom", "linear"]);
    let degree = p.count_opt("degree", 1);
    let found = found?;
    let mut known = BASES.into_iter().filter(|(word, ..)| *word == found.value);
    match degree {
        None => known.next().map(|(_, _, basis)| basis),
        Some(degree) => known.find(|(_, of, _)| *of == degree.value).map(|(_, _, basis)| basis).or_else(|| {
            let message = format!("a curve of the basis {} cannot have degree {}", quote(found.value), degree.value);
            p.error(SceneError::at(degree.span, message).help("leave it out: it is 3, or 2 for a simpler curve"));
            None
        }),
    }
}

pub(super) fn curve(p: &mut Params) -> Option<ShapeKind> {
    p.ignore("splitdepth", "curves are split where that makes them faster");
    let (style, basis) = (style(p, "flat"), basis(p, "bezier"));
    let width = p.not_negative("width", 1.0).value;
    let widths = [p.not_negative("width0", width), p.not_negative("width1", width)];
    let points = p.tuples::<3>("P", &[ParamType::Point3]);
    if style.is_some_and(|style| style != Style::Ribbon) {
        p.ignore("N", "only a ribbon has normals");
    }
    let normals = p.tuples::<3>("N", &[ParamType::Normal3]);
    let (style, basis) = (style?, basis?);
    if widths.iter().all(|width| width.value == 0.0) {
        p.error(SceneError::at(widths[0].span, "a curve of width 0 is not there").help("give a width above 0"));
        return None;
    }
    let Some(segments) = basis.segments(points.value.len()) else {
        let (count, first, step) = (points.value.len(), basis.points(), basis.step());
        let message = format!("{count} points make no whole number of segments of this curve");
        p.error(SceneError::at(points.span, message).help(format!(
            "give {first}, {}, {} … points",
            first + step,
            first + 2 * step
        )));
        return None;
    };
    let expected = if style == Style::Ribbon { segments + 1 } else { 0 };
    if normals.value.len() != expected {
        let found = normals.value.len();
        let message = format!("a ribbon of {segments} segments needs {expected} normals \"N\", not {found}");
        p.error(SceneError::at(normals.span, message));
        return None;
    }
    let widths = widths.map(|width| width.value);
    Some(ShapeKind::Curve(CurveDesc { basis, style, points: points.value, normals: normals.value, widths }))
}

pub(super) fn hair(p: &mut Params) -> Option<ShapeKind> {
    let (style, basis) = (style(p, "cylinder"), basis(p, "catmull-rom"));
    let Some(file) = p.string_opt("filename") else {
        p.error(SceneError::at(p.span, "hair needs \"string filename\""));
        return None;
    };
    let (style, basis) = (style?, basis?);
    if style == Style::Ribbon {
        p.error(SceneError::at(file.span, "the strands of a file have no normals, so they are no ribbons"));
        return None;
    }
    let path = file.map(|name| p.resolve(&name));
    Some(ShapeKind::Strands(StrandsDesc { path, basis, style, radii: Radii::Own }))
}
