//! Values of arguments: each a word that becomes a quantity, or a sentence that says what was expected.

use std::time::Duration;

use tyndall::{
    film::Crop,
    lpe::{PathLayer, named},
};

/// `30s`, `2m`, `1.5h`, `500ms`; a bare number is seconds.
pub(crate) fn duration(word: &str) -> Result<Duration, String> {
    let split = word.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(word.len());
    let (number, unit) = word.split_at(split);
    let seconds = match unit {
        "ms" => 1e-3,
        "" | "s" => 1.0,
        "m" | "min" => 60.0,
        "h" => 3600.0,
        _ => return Err(format!("`{unit}` is no unit of time: write ms, s, m or h, as in 30s")),
    };
    let time = number.trim().parse::<f64>().ok().filter(|n| *n > 0.0);
    time.and_then(|n| Duration::try_from_secs_f64(n * seconds).ok())
        .ok_or_else(|| "expected a time above zero, such as 30s, 2m or 1h".into())
}

/// `X0,Y0,X1,Y1`.
pub(crate) fn crop(word: &str) -> Result<Crop, String> {
    let numbers: Vec<u32> = word.split(',').map_while(|n| n.trim().parse().ok()).collect();
    match numbers[..] {
        [x0, y0, x1, y1] if word.matches(',').count() == 3 => {
            if x0 < x1 && y0 < y1 {
                Ok(Crop { min: (x0, y0), max: (x1, y1) })
            } else {
                Err("the crop is empty: X1 must be above X0, and Y1 above Y0".into())
            }
        }
        _ => Err("expected four pixel coordinates X0,Y0,X1,Y1, such as 0,0,64,48".into()),
    }
}

/// `WxH`.
pub(crate) fn resolution(word: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse::<u32>().ok().filter(|n| (1..=65536).contains(n));
    word.split_once('x')
        .and_then(|(w, h)| Some([side(w)?, side(h)?]))
        .ok_or_else(|| "expected width x height in pixels, from 1x1 to 65536x65536, such as 640x360".into())
}

/// `NAME=VALUE`.
pub(crate) fn definition(word: &str) -> Result<(String, String), String> {
    match word.split_once('=') {
        Some((name, value)) if !name.is_empty() => Ok((name.to_owned(), value.to_owned())),
        _ => Err("expected NAME=VALUE, such as spp=64".into()),
    }
}

/// Layers of light.
#[derive(Debug, Clone)]
pub(crate) struct LayerList(pub(crate) Vec<PathLayer>);

/// `direct,orders:8,NAME=EXPRESSION`; nothing is none.
pub(crate) fn layers(word: &str) -> Result<LayerList, String> {
    named::list(word).map(LayerList).map_err(|e| e.to_string())
}

/// A finite number.
pub(crate) fn finite(word: &str) -> Result<f32, String> {
    word.parse().ok().filter(|v: &f32| v.is_finite()).ok_or_else(|| "expected a number".into())
}

/// `40mm`, `4cm`, `0.04m`; a bare number is in mm. At least 0 \[mm\].
pub(crate) fn length(word: &str) -> Result<f64, String> {
    let split = word.find(|c: char| c.is_ascii_alphabetic() && c != 'e' && c != 'E').unwrap_or(word.len());
    let (number, unit) = word.split_at(split);
    let millimetres = match unit {
        "um" => 1e-3,
        "" | "mm" => 1.0,
        "cm" => 10.0,
        "m" => 1000.0,
        _ => return Err(format!("`{unit}` is no unit of length: write um, mm, cm or m, as in 40mm")),
    };
    let length = number.trim().parse::<f64>().ok().map(|n| n * millimetres);
    length.filter(|l| *l >= 0.0 && l.is_finite()).ok_or_else(|| "expected a length, such as 40mm or 4cm".into())
}

/// A length above zero \[mm\].
pub(crate) fn size(word: &str) -> Result<f64, String> {
    length(word).and_then(|l| if l > 0.0 { Ok(l) } else { Err("expected a length above zero".into()) })
}

/// An angle to a normal, from 0 up to 90 [degrees].
pub(crate) fn incidence(word: &str) -> Result<f64, String> {
    let angle = word.parse().ok().filter(|angle| (0.0..90.0).contains(angle));
    angle.ok_or_else(|| "expected an angle from 0 to less than 90 degrees".into())
}

/// One number for all channels, or three.
pub(crate) fn channels(word: &str) -> Result<[f64; 3], String> {
    let numbers: Option<Vec<f64>> =
        word.split(',').map(|n| n.trim().parse().ok().filter(|v: &f64| v.is_finite())).collect();
    match numbers.as_deref() {
        Some([grey]) => Ok([*grey; 3]),
        Some([r, g, b]) => Ok([*r, *g, *b]),
        _ => Err("expected a number, or three for red, green and blue, such as 0.7,1.2,1.9".into()),
    }
}

/// `X,Y,Z`, finite.
pub(crate) fn vector(word: &str) -> Result<[f32; 3], String> {
    let numbers: Option<Vec<f32>> =
        word.split(',').map(|n| n.trim().parse().ok().filter(|v: &f32| v.is_finite())).collect();
    let three = numbers.and_then(|numbers| numbers.try_into().ok());
    three.ok_or_else(|| "expected three numbers, such as 0.1,0,0".into())
}

/// A number of powers of ten.
pub(crate) fn decades(word: &str) -> Result<f64, String> {
    word.parse().ok().filter(|n| (0.1..=20.0).contains(n)).ok_or_else(|| "expected a number from 0.1 to 20".into())
}

/// A number between 0 and 1, both excluded.
pub(crate) fn probability(word: &str) -> Result<f64, String> {
    word.parse().ok().filter(|p| *p > 0.0 && *p < 1.0).ok_or_else(|| "expected a number between 0 and 1".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_units() {
        assert_eq!(duration("30s"), Ok(Duration::from_secs(30)));
        assert_eq!(duration("30"), Ok(Duration::from_secs(30)));
        assert_eq!(duration("1.5m"), Ok(Duration::from_secs(90)));
        assert_eq!(duration("2h"), Ok(Duration::from_hours(2)));
        assert_eq!(duration("250ms"), Ok(Duration::from_millis(250)));
        for bad in ["", "s", "0s", "-1s", "1e400", "inf", "nan", "3 days", "1e300h"] {
            assert!(duration(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn lengths_have_units_and_channels_are_one_or_three() {
        assert_eq!([length("40mm"), length("4cm"), length("0.04 m"), length("4e1")], [(); 4].map(|()| Ok(40.0)));
        for bad in ["", "mm", "-1mm", "nan", "inf", "4 miles", "1e400"] {
            assert!(length(bad).is_err(), "{bad}");
        }
        assert_eq!(channels("2"), Ok([2.0; 3]));
        assert_eq!(channels("1, 2,3e0"), Ok([1.0, 2.0, 3.0]));
        for bad in ["", "1,2", "1,2,3,4", "x", "nan", "inf,1,1"] {
            assert!(channels(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn crops_and_sizes_are_numbers_of_pixels() {
        assert_eq!(crop("1,2,3,4"), Ok(Crop { min: (1, 2), max: (3, 4) }));
        for bad in ["", "1,2,3", "1,2,3,4,5", "1,2,3,x", "3,2,3,4", "-1,0,1,1"] {
            assert!(crop(bad).is_err(), "{bad}");
        }
        assert_eq!(resolution("640x360"), Ok([640, 360]));
        for bad in ["", "640", "0x1", "1x99999999", "axb"] {
            assert!(resolution(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn definitions_keep_what_follows_the_first_equals_sign() {
        assert_eq!(definition("a=b=c"), Ok(("a".into(), "b=c".into())));
        assert!(definition("a").is_err() && definition("=b").is_err());
    }
}
