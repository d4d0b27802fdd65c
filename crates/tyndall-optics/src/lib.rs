//! tyndall-optics
pub mod measured {
//! stopgap
pub struct Measured { pub sigma_a: [f32;3], pub sigma_s_reduced: [f32;3] }
pub fn named(_: &str) -> Option<&'static Measured> { None }
pub fn names() -> Vec<&'static str> { vec![] }
}
