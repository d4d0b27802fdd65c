//! A pack as a pbrt scene: one grain, placed once for each; a floor beneath, a lamp from the left and above, a dim sky.
//! Or the grains alone, for a scene that includes them wherever it wants them.
//! The centre of a container that is a mesh stays where its file has it.

use std::fmt::Write;

use glam::DVec3;
use tyndall_grains::{
    form::Form,
    pack::{Grain, Pack},
};

use super::material::Material;

/// The scene. Everything is placed in units of the container's size, so that every pack fills its picture.
pub(super) fn text(pack: &Pack, material: Material) -> String {
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
        grains = grains(pack, material, "grain"),
    )
}

/// The grains alone. The object has this name, and its medium another made of it.
pub(super) fn grains(pack: &Pack, material: Material, name: &str) -> String {
    let DVec3 { x, y, z } = pack.container.centre();
    let mut text = format!("{}AttributeBegin\nTranslate {x} {y} {z}\n", object(&pack.form, material, name));
    for grain in &pack.grains {
        place(&mut text, grain, name);
    }
    text + "AttributeEnd\n"
}

/// A grain of radius 1. It is the same wherever it is defined: what it stands in then counts for its instances only.
fn object(form: &Form, material: Material, name: &str) -> String {
    let mut text = String::new();
    if let Some(absorption) = material.absorption() {
        let spectrum: Vec<String> = absorption.iter().map(|(nm, sigma_a)| format!("{nm} {sigma_a:.4e}")).collect();
        let spectrum = spectrum.join(" ");
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
        (_, Some((points, triangles))) => {
            let points: Vec<String> = points.iter().map(|p| format!("{:.7e} {:.7e} {:.7e}", p.x, p.y, p.z)).collect();
            let indices: Vec<String> = triangles.iter().map(|[a, b, c]| format!("{a} {b} {c}")).collect();
            let (points, indices) = (points.join(" "), indices.join(" "));
            let _ = writeln!(text, "Shape \"trianglemesh\" \"point3 P\" [{points}] \"integer indices\" [{indices}]");
        }
        (Form::Ellipsoid(axes), _) => {
            let _ = writeln!(text, "Scale {} {} {}\nShape \"sphere\"", axes.x, axes.y, axes.z);
        }
        _ => text += "Shape \"sphere\"\n",
    }
    text + "ObjectEnd\n"
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
