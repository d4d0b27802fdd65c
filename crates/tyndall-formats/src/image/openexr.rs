//! OpenEXR. Read is the first layer with channels R, G and B, of any number type and compression; alpha is not used. Written are
//! floats, ZIP-compressed.

use std::io::Cursor;

use exr::prelude::*;

use super::{Image, check_size};

pub(super) fn parse(bytes: &[u8]) -> std::result::Result<Image, String> {
    let headers = MetaData::read_from_buffered(bytes, false).map_err(|error| error.to_string())?.headers;
    for header in &headers {
        check_size(header.layer_size.x() as u64, header.layer_size.y() as u64)?;
    }
    let layer = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size, _| (size.width(), vec![[0.0; 3]; size.area()]),
            |(width, pixels), at, (r, g, b, _): (f32, f32, f32, f32)| pixels[at.y() * *width + at.x()] = [r, g, b],
        )
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(|error| error.to_string())?
        .layer_data;
    let (width, height) = check_size(layer.size.width() as u64, layer.size.height() as u64)?;
    Ok(Image { width, height, pixels: layer.channel_data.pixels.1 })
}

/// The bytes of a file.
pub(crate) fn write(image: &Image) -> std::result::Result<Vec<u8>, String> {
    let width = image.width as usize;
    let pixel = |at: Vec2<usize>| image.pixels[at.y() * width + at.x()].into();
    let layer = Layer::new(
        (width, image.height as usize),
        LayerAttributes::default(),
        Encoding { compression: Compression::ZIP16, ..Encoding::SMALL_LOSSLESS },
        SpecificChannels::rgb(|at| -> (f32, f32, f32) { pixel(at) }),
    );
    let mut bytes = Cursor::new(Vec::new());
    let file = exr::image::Image::from_layer(layer);
    file.write().non_parallel().to_buffered(&mut bytes).map_err(|error| error.to_string())?;
    Ok(bytes.into_inner())
}
