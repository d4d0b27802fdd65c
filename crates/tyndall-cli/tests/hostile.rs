//! Instruments and verifier on input that cannot be: a message, status 2, nothing written or overwritten.

mod common;

use std::{fs, process::Output};

use common::Desk;

impl Desk {
    fn tyndall(&self, arguments: &[&str]) -> Output {
        self.program().args(arguments).output().unwrap()
    }

    /// Fails unless the program refuses, and says `words`.
    #[track_caller]
    fn refuses(&self, arguments: &[&str], words: &str) {
        let output = self.tyndall(arguments);
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {told}");
        assert!(told.contains(words), "{arguments:?}: no `{words}` in\n{told}");
        assert!(!told.contains("panicked"), "{told}");
        assert_eq!(output.stdout, b"", "{arguments:?}");
    }
}

#[test]
fn a_medium_that_cannot_be_is_refused() {
    let desk = Desk::new("medium");
    for (layer, words) in [
        ("sigma_a=-1 sigma_s=1 d=1", "absorption coefficient"),
        ("sigma_a=1 sigma_s=-1e-9 d=1", "scattering coefficient"),
        ("sigma_a=nan sigma_s=1 d=1", "absorption coefficient"),
        ("sigma_a=1 sigma_s=inf d=1", "scattering coefficient"),
        ("sigma_a=1 sigma_s=1 g=1 d=1", "mean cosine"),
        ("sigma_a=1 sigma_s=1 g=-1 d=1", "mean cosine"),
        ("sigma_a=1 sigma_s=1 g=nan d=1", "mean cosine"),
        ("sigma_a=1 sigma_s=1 n=0 d=1", "refractive index"),
        ("sigma_a=1 sigma_s=1 d=0", "thickness"),
        ("sigma_a=1 sigma_s=1 d=-1", "thickness"),
        ("albedo=1.5 tau=1", "absorption coefficient"),
        ("", "layer"),
        ("sigma_a", "layer"),
    ] {
        desk.refuses(&["lab", "slab", "--layer", layer], words);
    }
    desk.refuses(&["lab", "slab"], "FILE.mci");
    desk.refuses(&["lab", "slab", "--layer", "albedo=0.9 tau=1", "--angle", "90"], "less than 90 degrees");
    desk.refuses(&["lab", "slab", "--layer", "albedo=0.9 tau=1", "--photons", "0"], "--photons");
    desk.refuses(&["lab", "slab", "--layer", "albedo=0.9 tau=1", "--error", "nan"], "--error");
    desk.refuses(&["lab", "slab", "--layer", "albedo=0.9 tau=1", "--angles", "100000000"], "bins");
    desk.refuses(&["lab", "point", "--albedo", "2"], "absorption coefficient");
    desk.refuses(&["lab", "point", "--albedo", "1"], "absorption coefficient");
    desk.refuses(&["lab", "sphere", "--albedo", "0.5", "--radius=-1"], "radius");
    desk.refuses(&["lab", "sphere", "--albedo", "0.5", "--radius", "nan"], "radius");
    desk.refuses(&["lab", "walk", "--g", "1"], "mean cosine");
    desk.refuses(&["lab", "walk", "--g", "0", "--flights", "0"], "flights");
}

const RUN: &str = "1.0\n1\na.mco A\n1000\n0.01 0.1\n4 5 6\n1\n1.0\n1.37 1 100 0.9 0.1\n1.0\n";

#[test]
fn an_input_file_that_cannot_be_is_refused_where_it_is_wrong() {
    let desk = Desk::new("mci");
    let write = |name: &str, bytes: &[u8]| fs::write(desk.0.join(name), bytes).unwrap();
    write("empty.mci", b"");
    write("cut.mci", &RUN.as_bytes()[..RUN.len() - 4]);
    write("binary.mci", &[0, 255, 128, 7]);
    write("zeros.mci", &[0; 4096]);
    write("layerless.mci", RUN.replace("6\n1\n", "6\n0\n").as_bytes());
    write("negative.mci", RUN.replace(" 100 ", " -100 ").as_bytes());
    write("nan.mci", RUN.replace(" 0.9 ", " nan ").as_bytes());
    let long = fs::File::create(desk.0.join("long.mci")).unwrap();
    long.set_len(5 << 30).unwrap(); // of a disk it takes nothing
    for (file, words) in [
        ("empty.mci", "line 1"),
        ("cut.mci", "the file ends before"),
        ("binary.mci", "not text"),
        ("zeros.mci", "is no number"),
        ("layerless.mci", "line 7: the number of layers"),
        ("negative.mci", "scattering coefficient"),
        ("nan.mci", "mean cosine"),
        ("long.mci", "too long"),
        ("missing.mci", "cannot read missing.mci"),
        (".", "cannot read ."),
    ] {
        desk.refuses(&["lab", "slab", file, "--json", "out.json"], words);
    }
    if cfg!(unix) {
        desk.refuses(&["lab", "slab", "/dev/zero"], "too long");
    }
    assert!(!desk.0.join("out.json").exists());
}

/// Told before the experiment, which would take days.
#[test]
fn files_that_cannot_be_written_are_known_at_once() {
    let desk = Desk::new("files");
    fs::create_dir(desk.0.join("directory")).unwrap();
    let forever = ["lab", "slab", "--layer", "albedo=0.9 tau=1", "--photons", "1000000000000"];
    for (option, file, words) in [
        ("--json", "nowhere/a.json", "cannot write nowhere/a.json"),
        ("--csv", "directory", "cannot write directory"),
        ("--plot", "nowhere/a.svg", "cannot write nowhere/a.svg"),
        ("--plot", "a.gif", ".svg or .png"),
    ] {
        desk.refuses(&[&forever[..], &[option, file]].concat(), words);
    }
    desk.refuses(&["verify", "--full", "--json", "nowhere/a.json"], "cannot write nowhere/a.json");
    desk.refuses(&["verify", "--filter", "no such table"], "no table is called");
    desk.refuses(&["verify", "--alpha", "2"], "--alpha");
    let left: Vec<_> = fs::read_dir(&desk.0).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["directory"]);
}

/// A report replaces a report, and nothing else.
#[test]
fn a_report_overwrites_no_file_that_is_not_its_own() {
    let desk = Desk::new("report");
    fs::create_dir(desk.0.join("book")).unwrap();
    fs::write(desk.0.join("book/verify.md"), "# My own page").unwrap();
    let report = ["verify", "--filter", "image-single", "--report"];
    desk.refuses(&[&report[..], &["book"]].concat(), "verify.md is there already");
    assert_eq!(fs::read_to_string(desk.0.join("book/verify.md")).unwrap(), "# My own page");
    desk.refuses(&[&report[..], &["book/verify.md"]].concat(), "cannot make the directory");
    for _ in 0..2 {
        let output = desk.tyndall(&[&report[..], &["new"]].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    let page = fs::read_to_string(desk.0.join("new/verify.md")).unwrap();
    assert!(page.contains("4 figures of 1 tables are reproduced"), "{page}");
    for plot in ["verify.svg", "verify-image-single.svg"] {
        assert!(page.contains(&format!("({plot})")) && desk.0.join("new").join(plot).exists(), "{plot}");
    }
}
