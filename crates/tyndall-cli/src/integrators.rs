//! Estimators by name.

use anyhow::bail;
use tyndall::integrator::{Analog, Integrator, VolPath};

use crate::args::IntegratorName;

/// The estimator of a name, with a limit on the scatterings of a path where the user wants one.
pub(crate) fn integrator(name: IntegratorName, max_depth: Option<u32>) -> anyhow::Result<Box<dyn Integrator>> {
    Ok(match name {
        IntegratorName::Volpath => Box::new(VolPath { max_depth, ..VolPath::default() }),
        IntegratorName::Analog => Box::new(Analog),
        _ => bail!("the estimators of the lecture are not built yet"),
    })
}
