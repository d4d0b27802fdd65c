//! Parameter lists: typed values that are asked for by name.
//!
//! Whoever makes something of a list asks for each parameter that it knows, and [`Params::finish`] makes an error of every
//! parameter that nobody asked for, with the nearest name that was.

use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::color_space::ColorSpace;
use super::lexer::shorten;
use super::param::{Param, ParamType};
use super::textures::{Texels, Textures};
use crate::desc::{Ignored, SpectrumDesc, Varying};
use crate::error::{ErrorList, SceneError};
use crate::source::{Span, Spanned};

/// The most parameters of one list: none in the language has as many.
pub(super) const MAX_PARAMS: usize = 200;

/// A parameter list while something is made of it.
#[derive(Debug)]
pub(super) struct Params {
    /// Whose they are, as messages say it: `shape "sphere"`.
    owner: String,
    /// The words that name the owner.
    pub(super) span: Span,
    dir: Rc<Path>,
    space: ColorSpace,
    list: Vec<Param>,
    asked: Vec<&'static str>,
    errors: Vec<SceneError>,
    ignored: Vec<Ignored>,
}

impl Params {
    /// `defaults` are those of `Attribute` directives; the list comes before them.
    pub(super) fn new(owner: String, span: Span, list: Vec<Param>, defaults: &[Param], dir: &Rc<Path>) -> Self {
        let mut errors = Vec::new();
        if list.len() > MAX_PARAMS {
            errors.push(SceneError::at(span, format!("{owner} has more than {MAX_PARAMS} parameters")));
        }
        let mut kept: Vec<Param> = Vec::with_capacity(list.len());
        for param in list.into_iter().take(MAX_PARAMS) {
            match kept.iter().find(|k| k.name == param.name) {
                Some(first) => {
                    let message = format!("the parameter \"{}\" is given twice", shorten(&param.name));
                    errors.push(SceneError::at(param.declared, message).related(first.declared, "first here"));
                }
                None => kept.push(param),
            }
        }
        // Of several defaults the last one counts.
        for param in defaults.iter().rev() {
            if kept.iter().all(|k| k.name != param.name) {
                kept.push(param.clone());
            }
        }
        let (dir, space) = (Rc::clone(dir), ColorSpace::default());
        Self { owner, span, dir, space, list: kept, asked: Vec::new(), errors, ignored: Vec::new() }
    }

    /// The same, with colours of this space.
    pub(super) fn in_space(self, space: ColorSpace) -> Self {
        Self { space, ..self }
    }

    /// A file, relative to the directory of the scene.
    pub(super) fn resolve(&self, name: &str) -> PathBuf {
        self.dir.join(name)
    }

    /// Reports a fault of these parameters.
    pub(super) fn error(&mut self, error: SceneError) {
        self.errors.push(error);
    }

    /// Reports what was wrong, and every parameter that nobody asked for.
    pub(super) fn finish(self, errors: &mut ErrorList, ignored: &mut Vec<Ignored>) {
        ignored.extend(self.ignored);
        self.errors.into_iter().for_each(|e| errors.push(e));
        for param in self.list.iter().filter(|p| !p.inherited) {
            let message = format!("{} has no parameter \"{}\"", self.owner, shorten(&param.name));
            errors.push(SceneError::at(param.declared, message).suggest(&param.name, self.asked.iter().copied()));
        }
    }

    /// Whether a parameter is given.
    pub(super) fn has(&self, name: &str) -> bool {
        self.list.iter().any(|p| p.name == name)
    }

    /// Drops a parameter that depends on another one which is wrong.
    pub(super) fn skip(&mut self, name: &'static str) {
        self.list.retain(|p| p.name != name);
    }

    /// Takes a parameter out of the list if it has one of the types.
    fn take(&mut self, name: &'static str, types: &[ParamType]) -> Option<Param> {
        self.asked.push(name);
        let at = self.list.iter().position(|p| p.name == name)?;
        let param = self.list.remove(at);
        if types.contains(&param.kind) {
            return Some(param);
        }
        if param.kind == ParamType::Texture {
            let message = format!("{} of {} cannot be a texture", quote(name), self.owner);
            self.errors.push(SceneError::at(param.declared, message).help("give it as a constant"));
        } else {
            let words: Vec<_> = types.iter().map(|t| format!("\"{} {name}\"", t.word())).collect();
            let message = format!("{} of {} cannot be of type {}", quote(name), self.owner, param.kind.word());
            self.errors.push(SceneError::at(param.declared, message).help(format!("write {}", words.join(" or "))));
        }
        None
    }

    /// Takes a parameter that must have exactly one value.
    fn take_one(&mut self, name: &'static str, types: &[ParamType]) -> Option<Param> {
        let param = self.take(name, types)?;
        let values = &param.values;
        let count = values.numbers.len() / param.kind.numbers_each() + values.strings.len() + values.bools.len();
        if count == 1 {
            return Some(param);
        }
        let message = format!("{} of {} takes one value and has {count}", quote(name), self.owner);
        self.errors.push(SceneError::at(param.declared, message));
        None
    }

    /// Notes a parameter that is known and changes nothing here.
    pub(super) fn ignore(&mut self, name: &'static str, reason: &'static str) {
        self.asked.push(name);
        if let Some(at) = self.list.iter().position(|p| p.name == name) {
            let param = self.list.remove(at);
            self.ignored.push(Ignored { span: param.span, reason });
        }
    }

    /// Reports a parameter that pbrt knows and this reader does not yet. It is no suggestion for others.
    pub(super) fn later(&mut self, name: &'static str) {
        if let Some(at) = self.list.iter().position(|p| p.name == name) {
            let param = self.list.remove(at);
            if !param.inherited {
                let message = format!("{} of {} is not supported yet", quote(name), self.owner);
                self.errors.push(SceneError::not_yet(param.declared, message).help("leave it out"));
            }
        }
    }

    /// As [`Params::later`], unless it is a number with the value that changes nothing.
    pub(super) fn later_unless(&mut self, name: &'static str, neutral: f64) {
        let is_neutral = |p: &Param| p.name == name && p.kind == ParamType::Float && p.values.numbers == [neutral];
        match self.list.iter().position(is_neutral) {
            Some(at) => drop(self.list.remove(at)),
            None => self.later(name),
        }
    }

    pub(super) fn float_opt(&mut self, name: &'static str) -> Option<Spanned<f64>> {
        let param = self.take_one(name, &[ParamType::Float])?;
        Some(Spanned::new(param.values.numbers[0], param.span))
    }

    pub(super) fn float(&mut self, name: &'static str, default: f64) -> Spanned<f64> {
        self.float_opt(name).unwrap_or(Spanned::new(default, self.span))
    }

    /// A number that must satisfy `valid`, which `range` says in words ("positive").
    pub(super) fn float_in(
        &mut self,
        name: &'static str,
        default: f64,
        range: &str,
        valid: impl Fn(f64) -> bool,
    ) -> Spanned<f64> {
        let found = self.float(name, default);
        if valid(found.value) {
            return found;
        }
        let message = format!("{} of {} must be {range}, not {}", quote(name), self.owner, found.value);
        self.errors.push(SceneError::at(found.span, message));
        found.map(|_| default)
    }

    pub(super) fn positive(&mut self, name: &'static str, default: f64) -> Spanned<f64> {
        self.float_in(name, default, "positive", |v| v > 0.0)
    }

    pub(super) fn not_negative(&mut self, name: &'static str, default: f64) -> Spanned<f64> {
        self.float_in(name, default, "at least 0", |v| v >= 0.0)
    }

    pub(super) fn floats(&mut self, name: &'static str, count: usize) -> Option<Spanned<Vec<f64>>> {
        let param = self.take(name, &[ParamType::Float])?;
        self.counted(name, &param, count)
    }

    /// As many numbers as there are.
    pub(super) fn any_floats(&mut self, name: &'static str) -> Option<Spanned<Vec<f64>>> {
        let param = self.take(name, &[ParamType::Float])?;
        Some(Spanned::new(param.values.numbers.clone(), param.span))
    }

    pub(super) fn integers(&mut self, name: &'static str, count: usize) -> Option<Spanned<Vec<f64>>> {
        let param = self.take(name, &[ParamType::Integer])?;
        self.counted(name, &param, count)
    }

    fn counted(&mut self, name: &str, param: &Param, count: usize) -> Option<Spanned<Vec<f64>>> {
        let found = param.values.numbers.len();
        if found == count {
            return Some(Spanned::new(param.values.numbers.clone(), param.span));
        }
        let message = format!("{} of {} takes {count} numbers and has {found}", quote(name), self.owner);
        self.errors.push(SceneError::at(param.declared, message));
        None
    }

    pub(super) fn integer_opt(&mut self, name: &'static str) -> Option<Spanned<i32>> {
        let param = self.take_one(name, &[ParamType::Integer])?;
        Some(Spanned::new(param.values.numbers[0] as i32, param.span))
    }

    /// An integer of at least `least`.
    pub(super) fn count(&mut self, name: &'static str, default: u32, least: u32) -> Spanned<u32> {
        self.count_opt(name, least).unwrap_or(Spanned::new(default, self.span))
    }

    /// An integer of at least `least`, if given.
    pub(super) fn count_opt(&mut self, name: &'static str, least: u32) -> Option<Spanned<u32>> {
        let found = self.integer_opt(name)?;
        match u32::try_from(found.value) {
            Ok(value) if value >= least => Some(found.map(|_| value)),
            _ => {
                let message = format!("{} of {} must be at least {least}", quote(name), self.owner);
                self.errors.push(SceneError::at(found.span, message));
                None
            }
        }
    }

    pub(super) fn boolean(&mut self, name: &'static str, default: bool) -> Spanned<bool> {
        match self.take_one(name, &[ParamType::Bool]) {
            Some(param) => Spanned::new(param.values.bools[0], param.span),
            None => Spanned::new(default, self.span),
        }
    }

    pub(super) fn string_opt(&mut self, name: &'static str) -> Option<Spanned<String>> {
        let param = self.take_one(name, &[ParamType::String])?;
        param.values.strings.first().cloned()
    }

    /// What layers of light call a thing: tyndall's own.
    pub(super) fn name(&mut self) -> Option<String> {
        self.string_opt("name").map(|name| name.value).filter(|name| !name.is_empty())
    }

    /// So many strings; `None` if there are others or none.
    pub(super) fn strings(&mut self, name: &'static str, count: usize) -> Option<Vec<Spanned<String>>> {
        let param = self.take(name, &[ParamType::String])?;
        (param.values.strings.len() == count).then(|| param.values.strings.clone())
    }

    /// As many strings as there are.
    pub(super) fn any_strings(&mut self, name: &'static str) -> Vec<Spanned<String>> {
        self.take(name, &[ParamType::String]).map_or(Vec::new(), |param| param.values.strings.clone())
    }

    pub(super) fn point(&mut self, name: &'static str, default: [f64; 3]) -> Spanned<[f64; 3]> {
        match self.take_one(name, &[ParamType::Point3]) {
            Some(param) => {
                let n = &param.values.numbers;
                Spanned::new([n[0], n[1], n[2]], param.span)
            }
            None => Spanned::new(default, self.span),
        }
    }

    pub(super) fn vector(&mut self, name: &'static str, default: [f64; 3]) -> Spanned<[f64; 3]> {
        match self.take_one(name, &[ParamType::Vector3]) {
            Some(param) => {
                let n = &param.values.numbers;
                Spanned::new([n[0], n[1], n[2]], param.span)
            }
            None => Spanned::new(default, self.span),
        }
    }

    /// A list of tuples of `N` numbers in single precision, empty if not given.
    pub(super) fn tuples<const N: usize>(&mut self, name: &'static str, kinds: &[ParamType]) -> Spanned<Vec<[f32; N]>> {
        let Some(param) = self.take(name, kinds) else { return Spanned::new(Vec::new(), self.span) };
        let (tuples, rest) = param.values.numbers.as_chunks::<N>();
        debug_assert!(rest.is_empty(), "Param::new checked the count");
        let tuples: Vec<_> = tuples.iter().map(|t| t.map(|v| v as f32)).collect();
        if tuples.as_flattened().iter().any(|v| !v.is_finite()) {
            let message = format!("{} of {} is too large for single precision", quote(name), self.owner);
            self.errors.push(SceneError::at(param.declared, message));
        }
        Spanned::new(tuples, param.span)
    }

    /// Corners of faces, `N` each, that must be below `count`. `None` if not given or wrong: that has been reported.
    pub(super) fn indices<const N: usize>(&mut self, name: &'static str, count: usize) -> Option<Vec<[u32; N]>> {
        let param = self.take(name, &[ParamType::Integer])?;
        let numbers = &param.values.numbers;
        let (faces, rest) = numbers.as_chunks::<N>();
        let wrong = if rest.is_empty() {
            numbers.iter().find(|&&i| i < 0.0 || i >= count as f64).map(|i| {
                format!(
                    "{} of {} names corner {i}, but it has {count} corners, counted from 0",
                    quote(name),
                    self.owner
                )
            })
        } else {
            Some(format!("{} of {} has {} numbers, but a face takes {N}", quote(name), self.owner, numbers.len()))
        };
        if let Some(message) = wrong {
            self.errors.push(SceneError::at(param.declared, message));
            return None;
        }
        Some(faces.iter().map(|face| face.map(|i| i as u32)).collect())
    }

    pub(super) fn spectrum_opt(&mut self, name: &'static str) -> Option<Spanned<SpectrumDesc>> {
        self.spectrum_of(name, &[ParamType::Rgb, ParamType::Spectrum, ParamType::Blackbody], ColorSpace::filter)
    }

    /// A spectrum of light; by default the white of the colour space.
    pub(super) fn light(&mut self, name: &'static str) -> Spanned<SpectrumDesc> {
        let white = SpectrumDesc::Rgb(self.space.light([1.0; 3]));
        self.light_opt(name).unwrap_or(Spanned::new(white, self.span))
    }

    /// A spectrum of light, if given.
    pub(super) fn light_opt(&mut self, name: &'static str) -> Option<Spanned<SpectrumDesc>> {
        self.spectrum_of(name, &[ParamType::Rgb, ParamType::Spectrum, ParamType::Blackbody], ColorSpace::light)
    }

    /// A spectrum that may also be given as one number.
    pub(super) fn spectrum_or_float(&mut self, name: &'static str, default: SpectrumDesc) -> Spanned<SpectrumDesc> {
        self.spectrum_of(name, &[ParamType::Float, ParamType::Spectrum], ColorSpace::filter)
            .unwrap_or(Spanned::new(default, self.span))
    }

    /// A spectrum, or the texture of the name.
    pub(super) fn varying_opt(&mut self, name: &'static str, textures: &Textures) -> Option<Spanned<Varying>> {
        let named = self.texture_opt(name, textures, Texels::Colours);
        named.or_else(|| self.spectrum_opt(name).map(|s| s.map(Varying::Everywhere)))
    }

    /// As [`Params::varying_opt`], or else a constant.
    pub(super) fn varying(&mut self, name: &'static str, default: f64, textures: &Textures) -> Spanned<Varying> {
        let default = Spanned::new(Varying::constant(default), self.span);
        self.varying_opt(name, textures).unwrap_or(default)
    }

    /// A number of at least 0, or the texture of the name.
    pub(super) fn amount(&mut self, name: &'static str, textures: &Textures) -> Option<Spanned<Varying>> {
        self.number(name, textures, |v| v >= 0.0)
    }

    /// A number, or the texture of the name.
    pub(super) fn number(
        &mut self,
        name: &'static str,
        textures: &Textures,
        valid: impl Fn(f64) -> bool,
    ) -> Option<Spanned<Varying>> {
        if let Some(found) = self.texture_opt(name, textures, Texels::Numbers) {
            return Some(found);
        }
        let found = self.float_opt(name)?;
        if !valid(found.value) {
            let message = format!("{} of {} must be at least 0, not {}", quote(name), self.owner, found.value);
            self.errors.push(SceneError::at(found.span, message));
            return None;
        }
        Some(found.map(Varying::constant))
    }

    /// Refuses the texture of a parameter that pbrt would take, and says why.
    pub(super) fn texture_later(&mut self, name: &'static str, reason: &str) {
        if !self.list.iter().any(|p| p.name == name && p.kind == ParamType::Texture) {
            return;
        }
        if let Some(param) = self.take(name, &[ParamType::Texture]) {
            let message = format!("a texture for {} of {} is not supported: {reason}", quote(name), self.owner);
            let help = format!(
                "give {} as a constant, or paint the surface: \"diffusetransmission\" takes textures",
                quote(name)
            );
            self.errors.push(SceneError::not_yet(param.declared, message).help(help));
        }
    }

    /// The texture that a parameter names. One that does not exist is reported; then the parameter counts as not given.
    fn texture_opt(&mut self, name: &'static str, textures: &Textures, texels: Texels) -> Option<Spanned<Varying>> {
        if !self.list.iter().any(|p| p.name == name && p.kind == ParamType::Texture) {
            return None;
        }
        let named = self.take_one(name, &[ParamType::Texture])?.values.strings.first().cloned()?;
        match textures.find(&named, texels) {
            Ok(id) => Some(named.map(|_| Varying::Texture(id))),
            Err(error) => {
                self.errors.push(error);
                None
            }
        }
    }

    fn spectrum_of(
        &mut self,
        name: &'static str,
        kinds: &[ParamType],
        to_srgb: fn(ColorSpace, [f64; 3]) -> [f64; 3],
    ) -> Option<Spanned<SpectrumDesc>> {
        let param = self.take(name, kinds)?;
        let values = &param.values;
        let spectrum = match (param.kind, &values.numbers[..], values.strings.first()) {
            (ParamType::Rgb, &[r, g, b], _) => Ok(SpectrumDesc::Rgb(to_srgb(self.space, [r, g, b]))),
            (ParamType::Float, &[value], _) => Ok(SpectrumDesc::Constant(value)),
            (ParamType::Blackbody, &[kelvin], _) if kelvin > 0.0 => Ok(SpectrumDesc::Blackbody { kelvin }),
            (ParamType::Blackbody, &[_], _) => Err("takes a positive temperature in kelvin"),
            (ParamType::Spectrum, numbers, _) if !numbers.is_empty() => samples(numbers),
            (ParamType::Spectrum, _, Some(name)) => Ok(self.named_spectrum(&name.value)),
            _ => Err("takes one value"),
        };
        match spectrum {
            Ok(spectrum) => Some(Spanned::new(spectrum, param.span)),
            Err(what) => {
                let message = format!("{} of {} {what}", quote(name), self.owner);
                self.errors.push(SceneError::at(param.declared, message));
                None
            }
        }
    }

    /// A name such as `metal-Cu-eta`, or a file, whose name has an ending or a directory.
    fn named_spectrum(&self, name: &str) -> SpectrumDesc {
        if name.contains(['.', '/']) {
            SpectrumDesc::File(self.resolve(name))
        } else {
            SpectrumDesc::Named(name.into())
        }
    }
}

fn samples(numbers: &[f64]) -> Result<SpectrumDesc, &'static str> {
    let (pairs, rest) = numbers.as_chunks::<2>();
    let lambda: Vec<f64> = pairs.iter().map(|p| p[0]).collect();
    let values = pairs.iter().map(|p| p[1]).collect();
    if !rest.is_empty() {
        return Err("takes pairs of wavelength and value");
    }
    if lambda[0] <= 0.0 || lambda.windows(2).any(|w| w[0] >= w[1]) {
        return Err("takes wavelengths in nm that are positive and increase");
    }
    Ok(SpectrumDesc::Samples { lambda, values })
}

/// A name in quotes, as messages show it.
pub(super) fn quote(name: &str) -> String {
    format!("\"{}\"", shorten(name))
}
