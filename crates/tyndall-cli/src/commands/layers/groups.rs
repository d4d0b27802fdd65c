//! The layers of light of an image, in groups that each add up to it.
//!
//! A layer is of light if it has channels `NAME.R`, `NAME.G`, `NAME.B` and is no surface's colour. Layers that have names of
//! their own ([`named`]) tell by them which group they belong to; all others are put side by side. A layer goes into the
//! first group of its kind that has room for it: light that was in a group before is not there twice. What a group lacks of
//! the image is a layer of its own, the rest.

use tyndall::{
    lpe::named::{self, By, Count},
    spectrum::srgb,
};
use tyndall_formats::film::Image;

/// What the layers of a group tell apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// How often light was scattered at all.
    Ways,
    /// How often it was scattered in media.
    Media,
    /// The same, order by order.
    Orders,
    /// How often it was scattered at all, time by time.
    Depths,
    /// What it was that scattered first.
    Seen,
    /// What the user's expressions select.
    Own,
}

/// A layer of light.
#[derive(Debug, Clone)]
pub(crate) struct Layer {
    pub(crate) name: String,
    /// How its light was scattered, if its name tells.
    pub(crate) meaning: String,
    /// Row by row.
    pub(crate) values: Vec<[f32; 3]>,
    /// Its share of the light of the image, by luminance.
    pub(crate) share: f64,
}

/// Layers that add up to the image.
#[derive(Debug, Clone)]
pub(crate) struct Group {
    pub(crate) kind: Kind,
    pub(crate) layers: Vec<Layer>,
    /// How far their sum is from the image, at most [units in the last place]; `None` if there is a rest.
    pub(crate) apart: Option<u32>,
}

/// Light that may be in a group twice before one says so: single pixels of spectral images are a little negative.
const TWICE: f64 = 0.01;
/// What rounding may leave of the light.
const NOTHING: f64 = 1e-6;
/// Colours of surfaces in the films of pbrt and Mitsuba, and what is known of their errors: no light.
const NO_LIGHT: [&str; 4] = ["stderr", "albedo", "variance", "relativevariance"];

impl Kind {
    fn of(name: &str) -> Self {
        let base = base(name);
        match base {
            "emission" | "direct" | "indirect" => Self::Ways,
            "unscattered" | "single" | "multiple" => Self::Media,
            "surface" | "volume" => Self::Seen,
            _ => match Count::named(base) {
                Some(Count { by: By::Media, .. }) => Self::Orders,
                Some(Count { by: By::All, .. }) => Self::Depths,
                None => Self::Own,
            },
        }
    }

    /// For people.
    pub(crate) fn title(self) -> &'static str {
        match self {
            Self::Ways => "direct and indirect",
            Self::Media => "single and multiple scattering in media",
            Self::Orders => "orders of scattering in media",
            Self::Depths => "orders of scattering by anything",
            Self::Seen => "what is seen first",
            Self::Own => "layers of the scene's own",
        }
    }

    /// For names of files.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Ways => "ways",
            Self::Media => "media",
            Self::Orders => "orders",
            Self::Depths => "depths",
            Self::Seen => "seen",
            Self::Own => "own",
        }
    }
}

/// All groups of an image; none if it has no layers of light.
pub(crate) fn groups(image: &Image) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for layer in layers(image) {
        let kind = Kind::of(&layer.name);
        let room = |group: &&mut Group| group.kind == kind && has_room(image, group, &layer);
        match groups.iter_mut().find(room) {
            Some(group) => group.layers.push(layer),
            None => groups.push(Group { kind, layers: vec![layer], apart: None }),
        }
    }
    for group in &mut groups {
        group.layers.sort_by_key(|layer| rank(&layer.name));
        complete(group, image);
    }
    groups.sort_by_key(|group| group.kind as u8);
    groups
}

/// The layers of light, but the one that is the whole image.
fn layers(image: &Image) -> impl Iterator<Item = Layer> {
    let channel = |name: &str| image.layers.iter().find(|channel| channel.name == name).map(|channel| &channel.values);
    let whole = luminance(&image.mean);
    image.layers.iter().filter_map(move |red| {
        let name = red.name.strip_suffix(".R")?;
        let first = name.split('.').next().unwrap_or_default().to_lowercase();
        if NO_LIGHT.contains(&&*first) || name == "all" {
            return None;
        }
        let (green, blue) = (channel(&format!("{name}.G"))?, channel(&format!("{name}.B"))?);
        let values: Vec<_> = red.values.iter().zip(green).zip(blue).map(|((r, g), b)| [*r, *g, *b]).collect();
        let meaning = meaning(name);
        Some(Layer { name: name.to_owned(), meaning, share: luminance(&values) / whole, values })
    })
}

/// Whether nothing would be in the group twice.
fn has_room(image: &Image, group: &Group, layer: &Layer) -> bool {
    let with = group.layers.iter().chain([layer]);
    let rest = rest(image, with);
    let too_much: f64 = rest.iter().flatten().filter(|v| **v < 0.0).map(|v| f64::from(-v)).sum();
    too_much <= TWICE * size(&image.mean)
}

/// Adds what is missing, or tells how far the sum is from the image.
fn complete(group: &mut Group, image: &Image) {
    let values = rest(image, group.layers.iter());
    if size(&values) > NOTHING * size(&image.mean) {
        let share = luminance(&values) / luminance(&image.mean);
        group.layers.push(Layer { name: "rest".into(), meaning: "all other light".into(), values, share });
        return;
    }
    let apart = |pixel: usize| {
        let mean = image.mean[pixel];
        (0..3).map(move |c| (c, mean[c])).filter(|(_, mean)| mean.is_finite()).map(move |(c, mean)| (pixel, c, mean))
    };
    let ulps = (0..image.mean.len()).flat_map(apart).map(|(pixel, c, mean)| {
        let sum: f64 = group.layers.iter().map(|layer| f64::from(layer.values[pixel][c])).sum();
        ordinal(sum as f32).abs_diff(ordinal(mean))
    });
    group.apart = Some(ulps.max().unwrap_or(0));
}

/// The image less layers.
fn rest<'a>(image: &Image, layers: impl Iterator<Item = &'a Layer>) -> Vec<[f32; 3]> {
    let mut rest: Vec<[f64; 3]> = image.mean.iter().map(|pixel| pixel.map(f64::from)).collect();
    for layer in layers {
        for (rest, value) in rest.iter_mut().flatten().zip(layer.values.iter().flatten()) {
            *rest -= f64::from(*value);
        }
    }
    rest.into_iter().map(|pixel| pixel.map(|v| v as f32)).collect()
}

/// All light, whatever its sign.
fn size(values: &[[f32; 3]]) -> f64 {
    values.iter().flatten().filter(|v| v.is_finite()).map(|v| f64::from(v.abs())).sum()
}

/// Sum over all pixels.
fn luminance(values: &[[f32; 3]]) -> f64 {
    values.iter().map(|pixel| f64::from(srgb::luminance(*pixel))).filter(|v| v.is_finite()).sum()
}

/// Floats in order: neighbours differ by one.
fn ordinal(v: f32) -> i32 {
    let bits = v.to_bits() as i32;
    if bits < 0 { i32::MIN - bits } else { bits }
}

/// Less scattered light comes first: order0, order1, …; a film's channels come in any order.
fn rank(name: &str) -> (u32, String) {
    const FIRST: [&str; 6] = ["emission", "direct", "indirect", "unscattered", "single", "multiple"];
    let place = match Count::named(base(name)) {
        Some(Count { n, more, .. }) => 2 * n + u32::from(more),
        None => FIRST.iter().position(|first| name.starts_with(first)).unwrap_or(FIRST.len()) as u32,
    };
    (place, name.to_owned())
}

/// A name without what was first to scatter.
fn base(name: &str) -> &str {
    name.strip_suffix("_surface").or(name.strip_suffix("_volume")).unwrap_or(name)
}

/// How light of a layer with a name was scattered.
fn meaning(name: &str) -> String {
    if let Some((_, _, meaning)) = named::table().find(|(known, ..)| *known == name) {
        return format!("scattered {meaning}").replace("scattered in any way; ", "");
    }
    match Count::named(name) {
        Some(Count { by: By::Media, n: 0, more: false }) => "scattered by no medium".into(),
        Some(Count { by: By::All, n: 0, more: false }) => "not scattered".into(),
        Some(Count { by, n, more }) => {
            let by = if by == By::Media { " by media" } else { "" };
            let times = if n == 1 { "once".into() } else { format!("{n} times") };
            format!("scattered{by} {}{times}", if more { "more than " } else { "" })
        }
        None => match (name.strip_suffix("_surface"), name.strip_suffix("_volume")) {
            (Some(base), _) if !meaning(base).is_empty() => format!("{}, first by a surface", meaning(base)),
            (_, Some(base)) if !meaning(base).is_empty() => format!("{}, first by a medium", meaning(base)),
            _ => String::new(),
        },
    }
}

#[cfg(test)]
mod tests {
    use tyndall_formats::film::{Channel, Metadata};

    use super::*;

    /// Two pixels of grey, whose layers are these.
    fn image(mean: [f32; 2], layers: &[(&str, [f32; 2])]) -> Image {
        let film = tyndall::film::Film::new(2, 1, tyndall::film::Crop::full(2, 1));
        let channels = layers.iter().flat_map(|(name, values)| {
            ["R", "G", "B"].map(|c| Channel { name: format!("{name}.{c}"), values: values.to_vec() })
        });
        let mean = mean.map(|v| [v; 3]).to_vec();
        Image { mean, layers: channels.collect(), ..Image::of(&film, Metadata::default()) }
    }

    fn names(group: &Group) -> Vec<&str> {
        group.layers.iter().map(|layer| &*layer.name).collect()
    }

    #[test]
    fn layers_that_tell_one_thing_apart_are_a_group_and_what_is_missing_is_the_rest() {
        let all = image(
            [1.0, 4.0],
            &[
                ("Albedo", [0.5, 0.5]),
                ("beyond1", [0.75, 0.0]),
                ("direct", [0.25, 3.0]),
                ("indirect", [0.75, 1.0]),
                ("deeper0", [0.5, 4.0]),
                ("depth0", [0.5, 0.0]),
                ("order0", [0.0, 3.0]),
                ("order1", [0.25, 1.0]),
                ("single", [0.25, 1.0]),
                ("stderr.single", [0.1, 0.1]),
            ],
        );
        let found = groups(&all);
        let expected: [&[&str]; 4] =
            [&["direct", "indirect"], &["single", "rest"], &["order0", "order1", "beyond1"], &["depth0", "deeper0"]];
        assert_eq!(found.iter().map(names).collect::<Vec<_>>(), expected);
        assert_eq!(found.iter().map(|group| group.apart).collect::<Vec<_>>(), [Some(0), None, Some(0), Some(0)]);
        assert_eq!(found[1].layers[1].values, [[0.75; 3], [3.0; 3]]);
        assert!((found[0].layers[0].share - 0.65).abs() < 1e-6);
    }

    /// One unit in the last place of 4 is 2⁻²¹.
    #[test]
    fn a_sum_that_is_off_by_a_unit_in_the_last_place_says_so() {
        let found = groups(&image([4.0, 1.0], &[("emission", [1.0, 1.0]), ("direct", [3.0 + 2f32.powi(-21), 0.0])]));
        assert_eq!(found[0].apart, Some(1));
    }

    #[test]
    fn layers_with_the_same_light_are_in_different_groups() {
        let found = groups(&image([1.0, 1.0], &[("lamp", [1.0, 0.25]), ("milk", [0.5, 0.0]), ("sky", [0.0, 0.75])]));
        assert_eq!(found.iter().map(names).collect::<Vec<_>>(), [vec!["lamp", "sky"], vec!["milk", "rest"]]);
        assert!(groups(&image([1.0, 1.0], &[("albedo", [1.0, 1.0])])).is_empty());
    }

    #[test]
    fn a_name_tells_how_its_light_was_scattered() {
        assert_eq!(meaning("single"), "scattered by media once");
        assert_eq!(meaning("surface"), "what is seen there is a surface");
        assert_eq!(meaning("beyond3_volume"), "scattered by media more than 3 times, first by a medium");
        assert_eq!(meaning("deeper4"), "scattered more than 4 times");
        assert_eq!(meaning("depth1_surface"), "scattered once, first by a surface");
        assert_eq!(meaning("caustic"), "");
    }
}
