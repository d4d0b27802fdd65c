//! A pack as a pbrt scene: one ball, placed once for each grain; a floor beneath, a lamp from the left and above, a dim sky.

use std::fmt::Write;

use tyndall_grains::pack::Pack;

/// The scene. Everything is placed in units of the container's size, so that every pack fills its picture.
pub(super) fn text(pack: &Pack, eta: f64) -> String {
    let half = pack.container.half();
    let size = half.length();
    let mut text = format!(
        "# {} grains, written by `tyndall pack`. Lengths are millimetres.\n\
         Option \"string unit\" \"mm\"\n\
         Scale -1 1 1 # the picture as seen from the front, not in a mirror\n\
         LookAt 0 {eye} {above}  0 0 0  0 0 1\n\
         Camera \"perspective\" \"float fov\" 32\n\
         Film \"rgb\" \"integer xresolution\" 320 \"integer yresolution\" 280 \"string filename\" \"pack.exr\"\n\
         Sampler \"zsobol\" \"integer pixelsamples\" 64\n\
         Integrator \"volpath\"\n\
         WorldBegin\n\
         LightSource \"infinite\" \"rgb L\" [0.25 0.28 0.32]\n\
         AttributeBegin\n\
         AreaLightSource \"diffuse\" \"rgb L\" [22 20 18]\n\
         Translate {lamp} {lamp} {high}\n\
         Rotate 136.7 -1 1 0\n\
         Shape \"disk\" \"float radius\" {disk}\n\
         AttributeEnd\n\
         AttributeBegin\n\
         Material \"diffuse\" \"rgb reflectance\" [0.35 0.33 0.31]\n\
         Translate 0 0 {floor}\n\
         Shape \"disk\" \"float radius\" {wide}\n\
         AttributeEnd\n\
         ObjectBegin \"grain\"\n\
         Material \"dielectric\" \"float eta\" {eta}\n\
         Shape \"sphere\"\n\
         ObjectEnd\n",
        pack.grains.len(),
        eye = -3.6 * size,
        above = 1.9 * size,
        lamp = -2.0 * size,
        high = 3.0 * size,
        disk = 0.8 * size,
        floor = -half.z,
        wide = 40.0 * size,
    );
    for grain in &pack.grains {
        let (c, r) = (grain.centre, grain.radius);
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "AttributeBegin Translate {:.6e} {:.6e} {:.6e} Scale {r:.6e} {r:.6e} {r:.6e} ObjectInstance \"grain\" AttributeEnd",
            c.x, c.y, c.z
        );
    }
    text
}
