//! Every word of both scene languages: what the readers make of it, as a page of the book.
//!
//! `words/*.txt` list the words that the languages have. Each is read here, alone, in a scene that has little else; what
//! comes of it is its status. The page is made of these, so it says what the readers do. After a change:
//!
//! ```text
//! TYNDALL_WRITE=1 cargo test -p tyndall-formats --test words
//! ```

use std::fmt::Write;
use std::path::Path;

use tyndall_formats::desc::SceneDesc;
use tyndall_formats::error::{Diagnostics, Severity};
use tyndall_formats::{mitsuba, pbrt};

/// What becomes of a word.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Status {
    Supported,
    /// It is read and changes nothing, or not what the language says.
    Differs(Vec<String>),
    NotYet,
}

/// Stands behind the words that are tyndall's own.
const OURS: &str = "†";

/// A line of a list: something that has parameters.
struct Kind<'a> {
    is_ours: bool,
    directive: &'a str,
    name: &'a str,
    params: Vec<Param<'a>>,
}

/// A parameter with an example.
#[derive(Clone, Copy)]
struct Param<'a> {
    needed: bool,
    is_ours: bool,
    /// `float`, `rgb`, …; empty for what is written out.
    tag: &'a str,
    name: &'a str,
    example: &'a str,
    /// What must stand before it, as `float alpha_v=0.5 & float alpha_u`.
    after: Option<&'a str>,
}

/// A scene language, as far as a word of it can be tried.
struct Language {
    name: &'static str,
    list: &'static str,
    /// The text of a parameter.
    param: fn(&Param) -> String,
    /// A scene with this kind of thing and these parameters.
    scene: fn(&Kind, &str) -> String,
    read: fn(&str) -> Result<SceneDesc, Diagnostics>,
}

const PBRT: Language = Language {
    name: "pbrt-v4",
    list: include_str!("words/pbrt.txt"),
    param: pbrt_param,
    scene: pbrt_scene,
    read: |text| pbrt::parse(Path::new("words.pbrt"), text).map(|(desc, _)| desc),
};

const MITSUBA: Language = Language {
    name: "Mitsuba 3",
    list: include_str!("words/mitsuba.txt"),
    param: mitsuba_param,
    scene: mitsuba_scene,
    read: |text| mitsuba::parse(Path::new("words.xml"), text, &[]).map(|(desc, _)| desc),
};

fn pbrt_param(p: &Param) -> String {
    let example = match (p.example, p.tag) {
        ("", "rgb") => "0.5 0.5 0.5",
        ("", "bool") => "true",
        ("", _) => "1",
        (example, _) => example,
    };
    if p.tag.is_empty() { example.to_owned() } else { format!("\"{} {}\" [ {example} ]", p.tag, p.name) }
}

fn pbrt_scene(kind: &Kind, params: &str) -> String {
    let Kind { directive, name, .. } = kind;
    let world = "WorldBegin\nTexture \"floats\" \"float\" \"constant\"\n\
                 MakeNamedMaterial \"one\" \"string type\" \"diffuse\"\nMakeNamedMaterial \"two\" \"string type\" \"diffuse\"\n";
    match *directive {
        "Option" => format!("Option \"{name}\" {params}\nWorldBegin\n"),
        "Camera" | "Film" | "PixelFilter" | "Sampler" | "Integrator" | "Accelerator" => {
            format!("{directive} \"{name}\" {params}\nWorldBegin\n")
        }
        "Texture" => format!("{world}Texture \"t\" \"float\" \"{name}\" {params}\n"),
        "SpectrumTexture" => format!("{world}Texture \"t\" \"spectrum\" \"{name}\" {params}\n"),
        "MakeNamedMedium" => format!("{world}MakeNamedMedium \"m\" \"string type\" \"{name}\" {params}\n"),
        _ => format!("{world}{directive} \"{name}\" {params}\n"),
    }
}

fn mitsuba_param(p: &Param) -> String {
    let (tag, name) = (p.tag, p.name);
    let value = match (p.example, tag) {
        ("", "boolean") => "true",
        ("", "transform") => return format!("<transform name=\"{name}\"><translate x=\"1\"/></transform>"),
        ("", "integer") => "1",
        ("", _) => "0.5",
        (example, _) => example,
    };
    match tag {
        "" => p.example.to_owned(),
        _ => format!("<{tag} name=\"{name}\" value=\"{value}\"/>"),
    }
}

fn mitsuba_scene(kind: &Kind, params: &str) -> String {
    let Kind { directive, name, .. } = kind;
    let tag = directive.trim_start_matches("area");
    let this = format!("<{tag} type=\"{name}\">{params}</{tag}>");
    let bitmap = |this: &str| format!("<bsdf type=\"diffuse\"><texture name=\"reflectance\" {this}</bsdf>");
    let inside = match *directive {
        "film" | "sampler" => format!("<sensor type=\"perspective\">{this}</sensor>"),
        "rfilter" => format!("<sensor type=\"perspective\"><film type=\"hdrfilm\">{this}</film></sensor>"),
        "sensor" if *name == "irradiancemeter" => format!("<shape type=\"sphere\">{this}</shape>"),
        "areaemitter" => format!("<shape type=\"sphere\">{this}</shape>"),
        "phase" => format!("<medium type=\"homogeneous\">{this}</medium>"),
        // What is passed straight counts differently for a limit on depth.
        "integrator" => format!("{this}<shape type=\"sphere\"><bsdf type=\"null\"/></shape>"),
        "volume" => {
            let albedo = this.replacen("<volume", "<volume name=\"albedo\"", 1);
            format!("<medium type=\"homogeneous\">{albedo}</medium>")
        }
        "texture" => bitmap(this.trim_start_matches("<texture")),
        _ => this,
    };
    let has_sensor = matches!(*directive, "sensor" | "film" | "sampler" | "rfilter");
    let sensor = if has_sensor { "" } else { "<sensor type=\"perspective\"/>" };
    format!("<scene version=\"3.0.0\">{sensor}{inside}</scene>")
}

impl Language {
    fn kinds(&self) -> Vec<Kind<'static>> {
        let lines = self.list.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
        lines.map(|line| Kind::read(line).unwrap_or_else(|| panic!("what is this line? {line}"))).collect()
    }

    /// What becomes of a kind with its needed parameters and `extra`. An example that is refused goes to `wrong`.
    fn status(&self, kind: &Kind, extra: Option<&Param>, wrong: &mut Vec<String>) -> Status {
        let needed = kind.params.iter().filter(|p| p.needed).copied();
        let before = extra.and_then(|p| p.after).map(|text| Param::read(text).expect("a parameter before another"));
        let text: Vec<String> = needed.chain(before).chain(extra.copied()).map(|p| (self.param)(&p)).collect();
        let scene = (self.scene)(kind, &text.join(" "));
        match (self.read)(&scene) {
            Ok(desc) => {
                let warned = desc.warnings.iter().map(|warning| warning.message.clone());
                let reasons: Vec<String> = warned.chain(desc.ignored.iter().map(|word| word.reason.into())).collect();
                if reasons.is_empty() { Status::Supported } else { Status::Differs(reasons) }
            }
            Err(faults) if faults.errors.iter().all(|e| e.severity == Severity::NotYet) => Status::NotYet,
            Err(faults) => {
                wrong.push(format!(
                    "{} has this word, and its example should be right:\n{scene}\n{faults}\n",
                    self.name
                ));
                Status::NotYet
            }
        }
    }

    /// The rows of one kind.
    fn row(&self, kind: &Kind, wrong: &mut Vec<String>) -> String {
        let name = kind.name;
        let status = self.status(kind, None, wrong);
        if status == Status::NotYet {
            return format!("| `{name}` | *not yet* | |\n");
        }
        let own: &[String] = if let Status::Differs(reasons) = &status { reasons } else { &[] };
        let (mut read, mut other) = (Vec::new(), Vec::new());
        for param in kind.params.iter().filter(|p| !p.title().is_empty()) {
            let title = param.title();
            let mark = if param.is_ours { OURS } else { "" };
            let alone = if param.needed { Status::Supported } else { self.status(kind, Some(param), wrong) };
            match alone {
                Status::Differs(mut reasons) if reasons.iter().any(|reason| !own.contains(reason)) => {
                    reasons.retain(|reason| !own.contains(reason));
                    other.push(format!("`{title}`: {}", reasons.join("; ")));
                }
                Status::Supported | Status::Differs(_) => read.push(format!("`{title}`{mark}")),
                Status::NotYet => other.push(format!("`{title}`: *not yet*")),
            }
        }
        read.dedup();
        let mark = if kind.is_ours { OURS } else { "" };
        let own: String = own.iter().flat_map(|reason| [reason, ". "]).collect();
        format!("| `{name}`{mark} | {} | {own}{} |\n", read.join(" "), other.join("; "))
    }

    fn section(&self, page: &mut String, wrong: &mut Vec<String>) {
        let _ = writeln!(page, "\n## {}", self.name);
        let mut directive = "";
        for kind in self.kinds() {
            if kind.directive != directive {
                directive = kind.directive;
                let title = match directive {
                    "areaemitter" => "emitter, in a shape",
                    "SpectrumTexture" => "Texture, of spectra only",
                    _ => directive,
                };
                let _ = writeln!(page, "\n### {title}\n\n| word | parameters | otherwise |\n|---|---|---|");
            }
            page.push_str(&self.row(&kind, wrong));
        }
    }
}

impl<'a> Kind<'a> {
    /// `Shape sphere; float radius; float zmin=-0.5`.
    fn read(line: &'a str) -> Option<Self> {
        let mut parts = line.split("; ");
        let line = parts.next()?;
        let (directive, name) = line.trim_start_matches('+').split_once(' ')?;
        Some(Self {
            is_ours: line.starts_with('+'),
            directive,
            name,
            params: parts.map(Param::read).collect::<Option<_>>()?,
        })
    }
}

impl<'a> Param<'a> {
    fn read(text: &'a str) -> Option<Self> {
        if let Some((before, text)) = text.split_once(" & ") {
            return Some(Self { after: Some(before), ..Self::read(text)? });
        }
        let (needed, is_ours) = (text.starts_with('!'), text.starts_with('+'));
        let text = text.trim_start_matches(['!', '+']);
        if text.starts_with('<') || text.starts_with('=') {
            let example = text.trim_start_matches('=');
            return Some(Self { needed, is_ours, tag: "", name: "", example, after: None });
        }
        let (tag, rest) = text.split_once(' ')?;
        let (name, example) = rest.split_once('=').unwrap_or((rest, ""));
        Some(Self { needed, is_ours, tag, name, example, after: None })
    }

    /// How the page calls it: by its name, or as the element that it is.
    fn title(&self) -> String {
        if !self.name.is_empty() || !self.example.starts_with('<') {
            return self.name.to_owned();
        }
        let name = self.example.split_once("name=\"").map(|(_, rest)| rest.split('"').next().unwrap_or(""));
        let tag = self.example[1..].split([' ', '>']).next().unwrap_or("");
        match name.filter(|_| self.example.find("name=") < self.example.find('>')) {
            Some(name) => format!("<{tag} {name}>"),
            None => format!("<{tag}>"),
        }
    }
}

fn page() -> String {
    let mut page = String::from(
        "# Words\n\n\
         Every word of both scene languages, and what tyndall makes of it. This page is made by a test that reads each word:\n\
         `crates/tyndall-formats/tests/words.rs`. A parameter in the second column means what its language says; the third\n\
         column has those that mean something else here, and those that are errors until they are supported, or with\n\
         `--lenient` warnings. Words with a † are tyndall's own: the other renderer does not know them.\n\n\
         One thing is not in any word: a mesh of Mitsuba's with normals at its vertices shines there to the side that these face\n\
         (and its light samples and its hits then disagree a little), here to the side that the triangles face.\n",
    );
    let mut wrong = Vec::new();
    PBRT.section(&mut page, &mut wrong);
    MITSUBA.section(&mut page, &mut wrong);
    assert!(wrong.is_empty(), "{}\n{} words are refused", wrong.join("\n"), wrong.len());
    page
}

#[test]
fn the_table_of_words_says_what_the_readers_do() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/src/words.md");
    let page = page();
    if std::env::var_os("TYNDALL_WRITE").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap_or_default();
    let differs = page.lines().zip(written.lines()).find(|(now, then)| now != then);
    assert!(
        page == written,
        "docs/src/words.md is out of date, first at {differs:?}: \
         run `TYNDALL_WRITE=1 cargo test -p tyndall-formats --test words`"
    );
}
