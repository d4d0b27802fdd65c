//! `<transform>`: each step is applied after the ones before it, that is, multiplied from the left.

use glam::{DMat3, DMat4, DVec3, DVec4};

use super::number::{number, numbers, vector};
use super::tree::Element;
use crate::error::{ErrorList, SceneError};

/// The matrix of a `<transform>`; a step that is wrong is left out.
pub(super) fn transform(element: &Element, errors: &mut ErrorList) -> DMat4 {
    let mut matrix = DMat4::IDENTITY;
    for step in &element.children {
        if let Some(step) = errors.ok(step_matrix(step)) {
            matrix = step * matrix;
        }
    }
    if !matrix.is_finite() || !matrix.inverse().is_finite() {
        errors.push(SceneError::at(element.span, "this transform is beyond the range of numbers"));
        return DMat4::IDENTITY;
    }
    matrix
}

fn step_matrix(step: &Element) -> Result<DMat4, SceneError> {
    let matrix = match step.tag {
        "translate" => DMat4::from_translation(vector(step, 0.0)?),
        "scale" => DMat4::from_scale(vector(step, 1.0)?),
        "rotate" => rotation(step)?,
        "lookat" => written_look_at(step)?,
        "matrix" => written(step)?,
        other => {
            return Err(SceneError::at(step.span, format!("<{other}> is no step of a transform"))
                .suggest(other, ["translate", "rotate", "scale", "lookat", "matrix"]));
        }
    };
    if matrix.determinant() == 0.0 || !matrix.inverse().is_finite() {
        return Err(SceneError::at(step.span, format!("this <{}> cannot be undone: it flattens space", step.tag)));
    }
    Ok(matrix)
}

/// `cos θ I + sin θ [a]× + (1 − cos θ) a aᵀ`, with the axis `a` as it is written: Mitsuba does not normalise it, so a longer
/// axis makes a matrix that is no rotation, and scenes are written by what it makes.
fn rotation(step: &Element) -> Result<DMat4, SceneError> {
    let (sin, cos) = number(step.text("angle"), step.span_of("angle"))?.to_radians().sin_cos();
    let a = vector(step, 0.0)?;
    let column = |unit: DVec3| cos * unit + sin * a.cross(unit) + (1.0 - cos) * a.dot(unit) * a;
    Ok(DMat4::from_mat3(DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))))
}

/// +z to the target, +y near `up`, and so +x to the left of one who looks along +z. `None` if they do not span a space.
pub(crate) fn look_at(origin: DVec3, target: DVec3, up: DVec3) -> Option<DMat4> {
    let dir = (target - origin).try_normalize()?;
    let left = up.cross(dir).try_normalize()?;
    let columns = [left, dir.cross(left), dir].map(|axis| axis.extend(0.0));
    Some(DMat4::from_cols(columns[0], columns[1], columns[2], origin.extend(1.0)))
}

fn written_look_at(step: &Element) -> Result<DMat4, SceneError> {
    let point = |name| {
        let [x, y, z] = numbers(step.text(name), step.span_of(name))?;
        Ok::<_, SceneError>(DVec3::new(x, y, z))
    };
    let (origin, target) = (point("origin")?, point("target")?);
    let dir = (target - origin)
        .try_normalize()
        .ok_or_else(|| SceneError::at(step.span, "origin and target of the lookat are the same point"))?;
    let up = if step.attribute("up").is_some() { point("up")? } else { DVec3::ZERO };
    let up = if up == DVec3::ZERO { dir.any_orthonormal_vector() } else { up };
    look_at(origin, target, up)
        .ok_or_else(|| SceneError::at(step.span_of("up"), "up is parallel to the line from origin to target"))
}

/// 16 numbers by rows, or the 9 of the linear part.
fn written(step: &Element) -> Result<DMat4, SceneError> {
    let (text, span) = (step.text("value"), step.span_of("value"));
    if let Ok(m) = numbers::<9>(text, span) {
        let m = DMat3::from_cols_array(&m).transpose();
        return Ok(DMat4::from_mat3(m));
    }
    let m = DMat4::from_cols_array(
        &numbers::<16>(text, span).map_err(|error| error.help("a matrix has 16 numbers, or 9"))?,
    )
    .transpose();
    if m.row(3) != DVec4::W {
        return Err(SceneError::at(span, "the last row of the matrix is not 0 0 0 1"));
    }
    Ok(m)
}
