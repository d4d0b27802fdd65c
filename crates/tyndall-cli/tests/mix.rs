//! Mixtures from the command line to a scene.

mod common;

use std::{fs, process::Output};

use common::Desk;
use serde_json::Value;

fn tyndall(desk: &Desk, arguments: &[&str]) -> Output {
    desk.program().args(arguments).output().unwrap()
}

fn done(desk: &Desk, arguments: &[&str]) -> String {
    let output = tyndall(desk, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The row of `milk_frisvad_miepython.csv` at 550 nm, per metre there: 1.5 % fat, 3.4 % protein, 20 MPa, steps of 5 nm. Its
/// phase function, at every degree, sends all light on: `2π ∫ p sin θ dθ = 1`, by Simpson's rule.
#[test]
fn milk_from_the_command_line_is_that_of_the_table() {
    let desk = Desk::new("mix-json");
    let json = done(&desk, &["mix", "milk", "--fat", "1.5", "--protein", "3.4", "--json", "-"]);
    let told: Value = serde_json::from_str(&json).unwrap();
    let row = told["by_wavelength"].as_array().unwrap().iter().find(|row| row["nanometres"] == 550.0).unwrap();
    let expected = expected();
    assert!((1e3 * row["sigma_s"].as_f64().unwrap() / expected[0] - 1.0).abs() < 2e-5, "{row}");
    assert!((row["g"].as_f64().unwrap() - expected[1]).abs() < 2e-5, "{row}");
    let phase: Vec<f64> = row["phase"].as_array().unwrap().iter().map(|p| p.as_f64().unwrap()).collect();
    let sum: f64 = phase
        .iter()
        .enumerate()
        .map(|(degree, p)| {
            let weight = f64::from(if degree % 180 == 0 { 1 } else { 2 + 2 * (degree % 2) as i32 });
            weight / 3.0 * p * (degree as f64).to_radians().sin()
        })
        .sum();
    let light = 2.0 * std::f64::consts::PI * 1f64.to_radians() * sum;
    assert!((light - 1.0).abs() < 1e-3, "{light}");
}

/// σ_s and g of the table's row.
fn expected() -> [f64; 2] {
    let table = include_str!("../../tyndall-optics/data/milk_frisvad_miepython.csv");
    let row = table.lines().find(|line| line.starts_with("regular,1.5,3.4,20,0.005,550,")).unwrap();
    let values: Vec<f64> = row.split(',').skip(7).map(|v| v.parse().unwrap()).collect();
    [values[0], values[2]]
}

/// Both languages take what is written for them, and a picture is drawn.
#[test]
fn a_mixed_medium_can_be_put_into_a_scene() {
    let desk = Desk::new("mix-medium");
    let text = done(&desk, &["mix", "milk", "--fat", "0.1", "--medium", "milk.pbrt", "--plot", "milk.svg"]);
    assert!(text.contains("550") && text.contains("Frisvad"), "{text}");
    assert!(fs::read_to_string(desk.0.join("milk.svg")).unwrap().contains("wavelength"));
    fs::write(
        desk.0.join("scene.pbrt"),
        "Option \"string unit\" \"mm\"\nWorldBegin\nInclude \"milk.pbrt\"\nMediumInterface \"milk\" \"\"\n\
         Material \"interface\" Shape \"sphere\" \"float radius\" 20\n",
    )
    .unwrap();
    assert!(done(&desk, &["info", "scene.pbrt"]).contains("milk"));
    done(&desk, &["mix", "fog", "--medium", "fog.xml"]);
    fs::write(
        desk.0.join("scene.xml"),
        "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><include filename=\"fog.xml\"/>\
         <shape type=\"sphere\"><bsdf type=\"null\"/><ref name=\"interior\" id=\"fog\"/></shape></scene>",
    )
    .unwrap();
    assert!(done(&desk, &["info", "scene.xml"]).contains("fog"));
}

#[test]
fn what_cannot_be_mixed_is_told_with_status_2() {
    let desk = Desk::new("mix-wrong");
    for (arguments, told) in [
        (&["mix", "milk", "--fat", "40"][..], "between 0 and 10"),
        (&["mix", "milk", "--fat", "NaN"], "between 0 and 10"),
        (&["mix", "beer"], "beer"),
        (&["mix", "milk", "--medium", "milk.txt"], ".pbrt or .xml"),
        (&["mix", "milk", "--plot", "milk.txt"], ".svg or .png"),
    ] {
        let output = tyndall(&desk, arguments);
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(2) && error.contains(told), "{arguments:?}: {error}");
    }
}

/// The whole list has a colour each: whole milk is nearly white, espresso nearly black.
#[test]
fn all_materials_are_listed_with_their_colours() {
    let desk = Desk::new("materials");
    let list = done(&desk, &["materials"]);
    let light = |name: &str| {
        let line = list.lines().find(|line| line.contains(&format!("  {name} "))).unwrap_or_else(|| panic!("{name}"));
        let digits = line.trim_start().trim_start_matches('#');
        u32::from_str_radix(&digits[2..4], 16).unwrap()
    };
    assert!(light("Wholemilk") > 220 && light("milk") > 220 && light("Espresso") < 120 && light("ink") < 60, "{list}");
    assert!(tyndall_optics::spectra::metals().all(|metal| list.contains(&format!("  {metal} "))));
    done(&desk, &["materials", "--page", "page"]);
    assert!(fs::read_to_string(desk.0.join("page/index.html")).unwrap().contains("Merlot"));
}
