//! Numbers as attributes hold them: finite, apart by commas or white space.

use glam::DVec3;

use super::tree::Element;
use crate::error::SceneError;
use crate::source::Span;

/// One number.
pub(super) fn number(text: &str, span: Span) -> Result<f64, SceneError> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(SceneError::at(span, format!("\"{text}\" is not a number"))),
    }
}

/// So many numbers.
pub(super) fn numbers<const N: usize>(text: &str, span: Span) -> Result<[f64; N], SceneError> {
    let values = list(text, span)?;
    let count = values.len();
    values.try_into().map_err(|_| SceneError::at(span, format!("{N} numbers are needed here, not {count}")))
}

/// One number, which stands for three, or three.
pub(super) fn one_or_three(text: &str, span: Span) -> Result<[f64; 3], SceneError> {
    match list(text, span)?[..] {
        [v] => Ok([v; 3]),
        [x, y, z] => Ok([x, y, z]),
        ref other => Err(SceneError::at(span, format!("1 or 3 numbers are needed here, not {}", other.len()))),
    }
}

/// A vector from `value` (one number for all axes, or three) or from `x`, `y` and `z`, each `missing` if not there.
pub(super) fn vector(element: &Element, missing: f64) -> Result<DVec3, SceneError> {
    let axis = |name| element.attribute(name).map_or(Ok(missing), |a| number(&a.value, a.span));
    match element.attribute("value") {
        Some(value) if ["x", "y", "z"].iter().any(|name| element.attribute(name).is_some()) => {
            Err(SceneError::at(value.span, "\"value\" cannot stand beside \"x\", \"y\" and \"z\""))
        }
        Some(value) => one_or_three(&value.value, value.span).map(DVec3::from_array),
        None => Ok(DVec3::new(axis("x")?, axis("y")?, axis("z")?)),
    }
}

pub(super) fn list(text: &str, span: Span) -> Result<Vec<f64>, SceneError> {
    let words = text.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty());
    words.map(|word| number(word, span)).collect()
}
