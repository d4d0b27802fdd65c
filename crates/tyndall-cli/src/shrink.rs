//! Smaller pictures, by means over squares of pixels.

/// Size [pixels] and values of a picture whose pixels are means over `edge` × `edge` pixels of another; what does not fill a
/// square, at the right and below, is left out.
pub(crate) fn shrink(values: &[[f32; 3]], [columns, rows]: [u32; 2], edge: u32) -> ([u32; 2], Vec<[f32; 3]>) {
    let size = [columns / edge, rows / edge];
    let square = |x: u32, y: u32| {
        let mut sum = [0.0; 3];
        for (dx, dy) in (0..edge).flat_map(|dy| (0..edge).map(move |dx| (dx, dy))) {
            let value = values[((y * edge + dy) * columns + x * edge + dx) as usize];
            for (sum, v) in sum.iter_mut().zip(value) {
                *sum += f64::from(v);
            }
        }
        sum.map(|v| (v / f64::from(edge * edge)) as f32)
    };
    (size, (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y))).map(|(x, y)| square(x, y)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_picture_has_the_means_of_squares() {
        let values: Vec<_> = (0..15).map(|i| [i as f32, 1.0, 0.0]).collect();
        let expected = vec![[3.0, 1.0, 0.0], [5.0, 1.0, 0.0]];
        assert_eq!(shrink(&values, [5, 3], 2), ([2, 1], expected));
        assert_eq!(shrink(&values, [5, 3], 1), ([5, 3], values));
    }
}
