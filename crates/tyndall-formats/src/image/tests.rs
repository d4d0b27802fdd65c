//! Images that are right, and images that are not.

use proptest::prelude::*;

use super::*;

/// Two columns, three rows, every value exact in all formats of floats.
fn picture() -> Image {
    let pixels = (0..6).map(|i| [i as f32, 0.5, 0.25 * i as f32]).collect();
    Image { width: 2, height: 3, pixels }
}

fn exr() -> Vec<u8> {
    use exr::prelude::*;
    let picture = picture();
    let channels = SpecificChannels::rgb(|at: Vec2<usize>| {
        let [r, g, b] = picture.pixels[at.y() * 2 + at.x()];
        (r, g, b)
    });
    let mut bytes = std::io::Cursor::new(Vec::new());
    exr::prelude::Image::from_channels((2, 3), channels).write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

fn pfm(scale: &str) -> Vec<u8> {
    let mut bytes = format!("PF\n2 3\n{scale}\n").into_bytes();
    for row in picture().pixels.chunks(2).rev() {
        for value in row.iter().flatten() {
            bytes.extend(if scale.starts_with('-') { value.to_le_bytes() } else { value.to_be_bytes() });
        }
    }
    bytes
}

fn coded(format: ImageFormat) -> Vec<u8> {
    let picture = picture();
    let mut bytes = Cursor::new(Vec::new());
    let image = ::image::Rgb32FImage::from_vec(2, 3, picture.pixels.into_iter().flatten().collect()).unwrap();
    match format {
        ImageFormat::Hdr => DynamicImage::from(image).write_to(&mut bytes, format).unwrap(),
        _ => DynamicImage::from(image).to_rgb8().write_to(&mut bytes, format).unwrap(),
    }
    bytes.into_inner()
}

/// One chunk of each kind, by the specification: a colour, two more of it, a small difference, one by its green, an
/// earlier colour by its hash (3·10 + 5·20 + 7·30 + 11·255) mod 64 = 9, a colour with alpha, and a difference that wraps.
fn qoi() -> Vec<u8> {
    let header = [b"qoif".as_slice(), &[0, 0, 0, 4, 0, 0, 0, 2, 3, 0]].concat();
    let chunks = [0xfe, 10, 20, 30, 0xc1, 0x76, 0xa5, 0x5a, 0x09, 0xff, 1, 2, 3, 128, 0x4a];
    [header.as_slice(), &chunks, &[0, 0, 0, 0, 0, 0, 0, 1]].concat()
}

#[test]
fn every_chunk_of_qoi_is_understood() {
    let codes =
        [[10, 20, 30], [10, 20, 30], [10, 20, 30], [11, 19, 30], [13, 24, 37], [10, 20, 30], [1, 2, 3], [255, 2, 3]];
    let image = parse_encoded(&qoi(), "qoi", Encoding::Linear).unwrap();
    assert_eq!((image.width, image.height), (4, 2));
    for (found, code) in image.pixels.iter().zip(codes) {
        assert_eq!(found.map(|v| (v * 255.0).round() as i32), code);
    }
    assert!(parse_image(&qoi()[..20], "qoi").is_err());
}

#[test]
fn a_picture_of_codes_is_the_same_in_every_format_of_codes() {
    let png = parse_image(&coded(ImageFormat::Png), "png").unwrap();
    for (format, ending) in [(ImageFormat::Tga, "tga"), (ImageFormat::Bmp, "bmp"), (ImageFormat::Tiff, "tif")] {
        assert_eq!(parse_image(&coded(format), ending).unwrap(), png, "{ending}");
    }
}

#[test]
fn a_picture_of_floats_is_the_same_in_every_format_of_floats() {
    assert_eq!(parse_image(&exr(), "exr").unwrap(), picture());
    assert_eq!(parse_image(&pfm("-1.0"), "pfm").unwrap(), picture());
    assert_eq!(parse_image(&pfm("1.0"), "PFM").unwrap(), picture());
    // Radiance shares one exponent between the channels: 8 bits of mantissa for the largest.
    let hdr = parse_image(&coded(ImageFormat::Hdr), "hdr").unwrap();
    for (read, written) in hdr.pixels.iter().zip(picture().pixels) {
        let step = written.iter().fold(0.0f32, |a, &b| a.max(b)) / 128.0;
        assert!((0..3).all(|c| (read[c] - written[c]).abs() <= step), "{read:?} for {written:?}");
    }
}

/// sRGB code 128 is 0.2158605 of full light (IEC 61966-2-1): ((128/255 + 0.055)/1.055)^2.4.
#[test]
fn eight_bits_are_decoded_by_the_srgb_curve() {
    let red = parse_image(&coded(ImageFormat::Png), "png").unwrap().pixels;
    assert_eq!(red[0][0], 0.0);
    assert!((red[1][0] - 1.0).abs() < 1e-6);
    assert!((red[0][1] - 0.215_860_5).abs() < 1e-6, "{}", red[0][1]);
}

#[test]
fn a_faulty_image_is_told_what_is_wrong() {
    let nan = [b"PF 1 1 -1\n".as_slice(), &[0, 0, 0, 0, 0, 0, 192, 127, 0, 0, 0, 0]].concat();
    let cases: [(&[u8], &str, &str); 6] = [
        (b"", "gif", "`.gif` is no image format that is read: exr, hdr, pfm, png, jpg, tiff, tga, bmp, qoi"),
        (b"P6\n1 1\n255\n", "pfm", "does not begin with `PF` or `Pf`"),
        (b"PF\n0 1\n-1\n", "pfm", "is 0 × 1 pixels"),
        (
            b"PF\n32768 32768\n-1\n",
            "pfm",
            "is 32768 × 32768 pixels; at most 32768 a side and 134217728 in all are read",
        ),
        (b"PF\n2 2\n-1\n1234", "pfm", "ends too early: 48 bytes of pixels expected, 4 found"),
        (&nan, "pfm", "pixel (0, 0) is [0.0, NaN, 0.0], which is no amount of light"),
    ];
    for (bytes, extension, problem) in cases {
        assert_eq!(parse_image(bytes, extension).unwrap_err(), problem);
    }
    let error = read_image(Path::new("no/such.exr")).unwrap_err();
    assert_eq!(error.to_string(), "no/such.exr: No such file or directory (os error 2)");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn no_damage_to_an_image_makes_a_reader_panic(
        which in 0usize..9,
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        keep in any::<prop::sample::Index>(),
        cut in any::<bool>(),
    ) {
        let (mut bytes, extension) = match which {
            0 => (exr(), "exr"),
            1 => (pfm("-1.0"), "pfm"),
            2 => (coded(ImageFormat::Hdr), "hdr"),
            3 => (coded(ImageFormat::Png), "png"),
            4 => (coded(ImageFormat::Jpeg), "jpg"),
            5 => (coded(ImageFormat::Tiff), "tiff"),
            6 => (coded(ImageFormat::Tga), "tga"),
            7 => (coded(ImageFormat::Bmp), "bmp"),
            _ => (qoi(), "qoi"),
        };
        for (at, byte) in damage {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        if cut {
            bytes.truncate(keep.index(bytes.len()));
        }
        if let Ok(image) = parse_image(&bytes, extension) {
            prop_assert_eq!(image.pixels.len(), (image.width * image.height) as usize);
        }
    }
}
