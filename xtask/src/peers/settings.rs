//! The peers' scenes and, for each, the setting for Mitsuba 3: the best that was measured on
//! 128² pixels (`shared/peers/README.md`); for `f_grains` and `a3` a guess.
//!
//! Roulette is off in scattering media of high albedo: Mitsuba's default caps survival at 0.95 after depth 5, which
//! makes the variance infinite there and loses light in practice. Light sampling inside the medium is off where a
//! dielectric boundary blocks every shadow ray. Where few vertices matter its stratified sampler `multijitter` is the better
//! one, as ours is; and tyndall has `--adaptive` where that gains: each renderer has its best.

/// A backend of Mitsuba.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Variant {
    /// Plain C++, one path at a time
    Scalar,
    /// Compiled at run time by LLVM, 8 or 16 paths side by side
    Llvm,
}

impl Variant {
    /// Mitsuba's name for it.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Scalar => "scalar_rgb",
            Self::Llvm => "llvm_ad_rgb",
        }
    }
}

/// One scene of `scenes/peers/mitsuba` and how both render it.
#[derive(Debug, Clone)]
pub(crate) struct Duel {
    /// Name of the file without `.xml`
    pub(crate) scene: &'static str,
    /// Mitsuba's backend
    pub(crate) variant: Variant,
    /// Values of the scene's `$parameters` for Mitsuba, `name=value` separated by blanks
    pub(crate) parameters: String,
    /// Samples a pixel in one run of Mitsuba: about 3 CPU seconds
    pub(crate) mitsuba_spp: u32,
    /// Samples a pixel in one run of tyndall: about as long; more, where its start would take most of that
    pub(crate) tyndall_spp: u32,
    /// Arguments of `tyndall render`
    pub(crate) arguments: &'static [&'static str],
}

/// Spectral MIS without roulette.
const DEEP: &str = "integrator=volpathmis rr_depth=1000000";
/// The same, without light sampling in the medium.
const DEEP_IN_GLASS: &str = "integrator=volpathmis rr_depth=1000000 nee=false";

/// More samples where errors are large.
const ADAPTIVE: &[&str] = &["--adaptive"];

/// All scenes, the quick ones first.
pub(crate) fn duels() -> Vec<Duel> {
    use Variant::{Llvm, Scalar};
    let even = |scene, variant, parameters: &str, mitsuba_spp, tyndall_spp| Duel {
        scene,
        variant,
        parameters: parameters.to_owned(),
        mitsuba_spp,
        tyndall_spp,
        arguments: &[],
    };
    let adaptive = |scene, variant, parameters, mitsuba_spp, tyndall_spp| Duel {
        arguments: ADAPTIVE,
        ..even(scene, variant, parameters, mitsuba_spp, tyndall_spp)
    };
    vec![
        adaptive("g_cornell", Llvm, "integrator=path sampler=multijitter", 256, 64),
        adaptive("d_fog_box", Llvm, "integrator=volpath sampler=multijitter", 64, 32),
        adaptive("d2_fog_lamp", Llvm, "integrator=volpath sampler=multijitter", 64, 32),
        even("e_hair", Llvm, "integrator=path sampler=multijitter", 64, 32),
        even("f_grains", Scalar, "integrator=path", 32, 24),
        even("f2_grains_direct", Scalar, "integrator=path", 40, 24),
        adaptive("b_marble_cube_matched", Scalar, DEEP, 12, 32),
        adaptive("b4_marble_mesh", Scalar, DEEP, 8, 96),
        adaptive("b5_marble_smooth_mesh", Scalar, DEEP, 8, 96),
        even("b2_furnace_matched", Scalar, DEEP_IN_GLASS, 24, 32),
        adaptive("b3_grey_matched", Scalar, "integrator=volpath rr_depth=1000000", 12, 32),
        even("a_marble_cube", Scalar, DEEP_IN_GLASS, 8, 6),
        even("a2_marble_cube_spot", Scalar, DEEP_IN_GLASS, 2, 2),
        even("a3_marble_cube_rough_spot", Scalar, DEEP_IN_GLASS, 8, 6),
        even("a4_marble_cube_frosted_spot", Scalar, DEEP_IN_GLASS, 24, 20),
        adaptive("c_milk_sphere", Scalar, DEEP_IN_GLASS, 2, 24),
        adaptive("c2_milk_mesh", Scalar, DEEP_IN_GLASS, 2, 48),
        adaptive("c3_milk_smooth_mesh", Scalar, DEEP_IN_GLASS, 2, 48),
    ]
}
