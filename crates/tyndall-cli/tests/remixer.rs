//! The page that mixes layers anew, in a browser without a window: what is on its canvas is what the program would draw.
//!
//! The browser is `chromium-headless-shell` or `chromium` (Debian: `apt-get install chromium-headless-shell`). Where there
//! is none the test says loudly that it has tested nothing.

#![allow(clippy::print_stderr)] // a test that tests nothing says so

mod common;

use std::{fs, io::BufReader, path::Path, process::Command};

use common::Desk;
use tyndall_formats::film::{Image, Tone, exr};

/// A glowing ball of fog and an opaque one on a floor under a lamp: light of every kind.
const SCENE: &str = r#"
Film "rgb" "integer xresolution" 40 "integer yresolution" 30 "string layers" [
  "emission" "direct" "indirect" "unscattered" "single" "multiple" "fog=C.*V'fog'.*[LOB]" ]
Sampler "independent" "integer pixelsamples" 8
LookAt 0 1 -5  0 0.2 0  0 1 0
Camera "perspective" "float fov" 50
WorldBegin
LightSource "infinite" "rgb L" [ 0.1 0.2 0.4 ]
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [ 1 1.5 2 ] "rgb Le" [ 0.02 0.01 0 ] "rgb sigma_a" [ 0.1 0.1 0.1 ]
AttributeBegin
  MediumInterface "fog" ""
  Material "interface"
  Shape "sphere" "float radius" 1
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 19 18 17 ]
  Translate 1.6 1.6 0
  Shape "sphere" "float radius" 0.3
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.6 0.5 0.4 ]
Shape "bilinearmesh" "point3 P" [ -4 -1 -4  4 -1 -4  -4 -1 4  4 -1 4 ]
"#;

/// Moves sliders as a hand does, and writes the bytes of the canvas (red, green, blue in hexadecimal) into the page.
const HAND: &str = r"
<script>
(async () => {
  const until = async found => { while (!found()) await new Promise(done => setTimeout(done, 10)); };
  const drawn = () => new Promise(done => setTimeout(done, 20));
  const by = text => [...document.querySelectorAll('#layers li')].find(row => row.querySelector('label').textContent === text);
  const slide = (slider, to) => { slider.value = to; slider.dispatchEvent(new Event('input', { bubbles: true })); };
  const note = async () => {
    await drawn();
    const canvas = document.getElementById('picture');
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    const pre = document.createElement('pre');
    pre.textContent = 'canvas:' + [...data].filter((_, i) => i % 4 < 3).map(v => v.toString(16).padStart(2, '0')).join('') + ':';
    document.body.append(pre);
  };
  await until(() => by('direct'));
  await note();
  slide(document.getElementById('exposure'), 1.5);
  slide(by('direct').querySelector('input'), 0.25);
  by('emission').querySelector('.mute').click();
  await note();
  document.getElementById('group1').click();
  by('multiple').querySelector('.solo').click();
  await note();
  document.getElementById('reset').click();
  await note();
  document.getElementById('group2').click();
  slide(by('fog').querySelector('input'), 2);
  await note();
})();
</script>";

fn browser() -> Option<&'static str> {
    let names = ["chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"];
    names.into_iter().find(|name| Command::new(name).arg("--version").output().is_ok_and(|out| out.status.success()))
}

/// What is on the canvas each time that the hand writes it down.
fn canvases(browser: &str, page: &Path) -> Vec<Vec<u8>> {
    let home = page.with_extension("profile");
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=20000", "--dump-dom"])
        .arg(format!("--user-data-dir={}", home.display()))
        .arg(format!("file://{}", page.display()))
        .output()
        .unwrap();
    let dom = String::from_utf8(output.stdout).unwrap();
    let texts = dom.split("<pre>canvas:").skip(1).map(|rest| rest.split(':').next().unwrap_or_default());
    let byte = |pair: &[u8]| u8::from_str_radix(std::str::from_utf8(pair).unwrap(), 16).unwrap();
    texts.map(|text| text.as_bytes().chunks(2).map(byte).collect()).collect()
}

/// Linear values of a layer.
fn layer(image: &Image, name: &str) -> Vec<[f32; 3]> {
    let channel = |c| &image.layers.iter().find(|channel| channel.name == format!("{name}.{c}")).unwrap().values;
    let [r, g, b] = ["R", "G", "B"].map(channel);
    r.iter().zip(g).zip(b).map(|((r, g), b)| [*r, *g, *b]).collect()
}

/// The bytes that the program makes of a weighted sum of layers.
fn mixed(image: &Image, exposure: f32, parts: &[(f32, &[[f32; 3]])]) -> Vec<u8> {
    let tone = Tone { exposure, ..Tone::default() };
    let pixel = |i: usize| [0, 1, 2].map(|c| parts.iter().map(|(weight, values)| weight * values[i][c]).sum());
    (0..image.mean.len()).flat_map(|i| tone.apply(pixel(i))).collect()
}

fn assert_alike(found: &[u8], expected: &[u8], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let apart = found.iter().zip(expected).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
    assert!(apart <= 1, "{what}: {apart} levels apart");
    assert!(expected.iter().any(|v| *v > 60) && expected.iter().any(|v| *v < 200), "{what}: nothing to see");
}

/// 16-bit floats are off by 2⁻¹¹ of a value at most, less than a fifth of a level of sRGB.
#[test]
fn a_page_mixes_light_as_the_program_does() {
    let Some(browser) = browser() else {
        eprintln!(
            "\n!!! SKIPPED: there is no Chromium on this machine: NOTHING was tested of the page that mixes layers !!!\n"
        );
        return;
    };
    let desk = Desk::new("mix");
    fs::write(desk.0.join("fog.pbrt"), SCENE).unwrap();
    let run = |arguments: &str| {
        let output = desk.program().args(arguments.split_whitespace()).output().unwrap();
        assert!(output.status.success(), "{arguments}: {}", String::from_utf8_lossy(&output.stderr));
    };
    run("render fog.pbrt -o fog --quiet");
    run("layers fog.exr --page fog.html");
    let page = fs::read_to_string(desk.0.join("fog.html")).unwrap();
    assert!(!page.contains("http") && !page.contains("src="), "the page asks for other files");
    let probed = desk.0.join("probed.html");
    fs::write(&probed, page.replace("</body>", &format!("{HAND}</body>"))).unwrap();

    let image = exr::read(&desk.0.join("fog.exr")).unwrap();
    let png = png::Decoder::new(BufReader::new(fs::File::open(desk.0.join("fog.png")).unwrap()));
    let mut reader = png.read_info().unwrap();
    let mut rendered = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut rendered).unwrap();

    let found = canvases(browser, &probed);
    assert_eq!(found.len(), 5, "the page did not run to its end");
    assert_alike(&found[0], &rendered, "as rendered");
    let [direct, indirect, multiple] = ["direct", "indirect", "multiple"].map(|name| layer(&image, name));
    let weighed = mixed(&image, 1.5, &[(0.25, &direct), (1.0, &indirect)]);
    assert_alike(&found[1], &weighed, "a quarter of the direct light, no emission, 1.5 stops");
    assert_alike(&found[2], &mixed(&image, 1.5, &[(1.0, &multiple)]), "multiple scattering alone");
    assert_alike(&found[3], &rendered, "as rendered, again");
    let doubled = mixed(&image, 0.0, &[(1.0, &image.mean), (1.0, &layer(&image, "fog"))]);
    assert_alike(&found[4], &doubled, "twice the light of the fog");
}
