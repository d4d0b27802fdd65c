//! A pack as a pbrt scene: one grain, placed once for each; a floor beneath, a lamp from the left and above, a dim sky.
//! Or the grains alone, for a scene that includes them wherever it wants them.
//! The centre of a container that is a mesh stays where its file has it. With a proxy, its body and medium come before the grains.

use std::fmt::Write;

use glam::DVec3;
use tyndall_grains::{
    form::Form,
    pack::{Grain, Pack},
    proxy::{Body, Proxy},
};

use super::material::Material;

/// The scene around the grains. Everything is placed in units of the container's size, so that every pack fills its picture.
pub(super) fn around(pack: &Pack, grains: &str) -> String {
    let (half, centre) = (pack.container.half(), pack.container.centre());
    let size = half.length();
    format!(
        "# {} grains, written by `tyndall pack`. Lengths are millimetres.\n\
         Option \"string unit\" \"mm\"\n\
         Scale -1 1 1 # the picture as seen from the front, not in a mirror\n\
         LookAt {x} {eye} {above}  {x} {y} {z}  0 0 1\n\
         Camera \"perspective\" \"float fov\" 32\n\
         Film \"rgb\" \"integer xresolution\" 320 \"integer yresolution\" 280 \"string filename\" \"pack.exr\"\n\
         Sampler \"zsobol\" \"integer pixelsamples\" 64\n\
         Integrator \"volpath\"\n\
         WorldBegin\n\
         LightSource \"infinite\" \"rgb L\" [0.25 0.28 0.32]\n\
         AttributeBegin\n\
         Translate {x} {y} {z}\n\
         AreaLightSource \"diffuse\" \"rgb L\" [22 20 18]\n\
         Translate {lamp} {lamp} {high}\n\
         Rotate 136.7 -1 1 0\n\
         Shape \"disk\" \"float radius\" {disk}\n\
         AttributeEnd\n\
         AttributeBegin\n\
         Material \"diffuse\" \"rgb reflectance\" [0.35 0.33 0.31]\n\
         Translate {x} {y} {floor}\n\
         Shape \"disk\" \"float radius\" {wide}\n\
         AttributeEnd\n\
         {grains}",
        pack.grains.len(),
        x = centre.x,
        y = centre.y,
        z = centre.z,
        eye = centre.y - 3.6 * size,
        above = centre.z + 1.9 * size,
        lamp = -2.0 * size,
        high = 3.0 * size,
        disk = 0.8 * size,
        floor = centre.z - half.z,
        wide = 40.0 * size,
    )
}

/// The grains alone. The object has this name, and media others made of it.
pub(super) fn grains(pack: &Pack, material: Material, proxy: Option<&Proxy>, name: &str) -> String {
    let DVec3 { x, y, z } = pack.container.centre();
    let mut text = object(&pack.form, material, proxy.is_some(), name);
    let _ = writeln!(text, "AttributeBegin\nTranslate {x} {y} {z}");
    if let Some(proxy) = proxy {
        text += &stand_in(proxy, material, name);
    }
    for grain in &pack.grains {
        place(&mut text, grain, name);
    }
    text + "AttributeEnd\n"
}

/// The medium that stands for the grains.
fn stand_in(proxy: &Proxy, material: Material, name: &str) -> String {
    let coefficient = |name: &str, values: &[f64]| match material.absorption() {
        Some(absorption) => format!(
            "\"spectrum {name}\" [{}]",
            spectrum(absorption.iter().map(|(nm, _)| *nm).zip(values.iter().copied()))
        ),
        None => format!("\"rgb {name}\" [{v:.6e} {v:.6e} {v:.6e}]", v = values[0]),
    };
    let phase: Vec<String> = proxy.phase.iter().map(|value| format!("{value:.5e}")).collect();
    let mut text = format!(
        "MakeNamedMedium \"among {name}\" \"string type\" \"homogeneous\" {} {}\n\"float phase\" [{}]\n\
         AttributeBegin\nMaterial \"interface\"\nMediumInterface \"among {name}\" \"\"\n",
        coefficient("sigma_a", &proxy.sigma_a),
        coefficient("sigma_s", &proxy.sigma_s),
        phase.join(" ")
    );
    match &proxy.body {
        Body::Ball(radius) => {
            let _ = write!(text, "Shape \"sphere\" \"float radius\" {radius}");
        }
        Body::Mesh(points, triangles) => text += &mesh(points, triangles),
    }
    text + " \"string granular\" \"proxy\"\nAttributeEnd\n"
}

fn spectrum(values: impl Iterator<Item = (f64, f64)>) -> String {
    values.map(|(nm, sigma)| format!("{nm} {sigma:.6e}")).collect::<Vec<_>>().join(" ")
}

fn mesh(points: &[DVec3], triangles: &[[u32; 3]]) -> String {
    let points: Vec<String> = points.iter().map(|p| format!("{:.7e} {:.7e} {:.7e}", p.x, p.y, p.z)).collect();
    let indices: Vec<String> = triangles.iter().map(|[a, b, c]| format!("{a} {b} {c}")).collect();
    format!("Shape \"trianglemesh\" \"point3 P\" [{}] \"integer indices\" [{}]", points.join(" "), indices.join(" "))
}

/// A grain of radius 1; one that a proxy stands for is marked. It is the same wherever it is defined: what it stands in then counts
/// for its instances only.
fn object(form: &Form, material: Material, marked: bool, name: &str) -> String {
    let mut text = String::new();
    if let Some(absorption) = material.absorption() {
        let spectrum = spectrum(absorption.into_iter());
        text = format!(
            "MakeNamedMedium \"inside {name}\" \"string type\" \"homogeneous\" \"spectrum sigma_a\" [{spectrum}] \"rgb sigma_s\" [0 0 0]\n"
        );
    }
    let _ =
        writeln!(text, "ObjectBegin \"{name}\"\nIdentity\nMaterial \"dielectric\" \"float eta\" {}", material.eta());
    if material.absorption().is_some() {
        let _ = writeln!(text, "MediumInterface \"inside {name}\" \"\"");
    }
    match (form, form.triangles()) {
        (_, Some((points, triangles))) => text += &mesh(&points, triangles),
        (Form::Ellipsoid(axes), _) => {
            let _ = write!(text, "Scale {} {} {}\nShape \"sphere\"", axes.x, axes.y, axes.z);
        }
        _ => text += "Shape \"sphere\"",
    }
    text + if marked { " \"string granular\" \"grain\"\nObjectEnd\n" } else { "\nObjectEnd\n" }
}

fn place(text: &mut String, grain: &Grain, name: &str) {
    let (c, r) = (grain.centre, grain.radius);
    let (axis, angle) = grain.turn.to_axis_angle();
    // Writing to a string cannot fail.
    let _ = write!(text, "AttributeBegin Translate {:.6e} {:.6e} {:.6e} ", c.x, c.y, c.z);
    if angle != 0.0 {
        let _ = write!(text, "Rotate {:.6} {:.7} {:.7} {:.7} ", angle.to_degrees(), axis.x, axis.y, axis.z);
    }
    let _ = writeln!(text, "Scale {r:.6e} {r:.6e} {r:.6e} ObjectInstance \"{name}\" AttributeEnd");
}
