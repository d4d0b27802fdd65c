//! Estimators by name.

use tyndall::{
    integrator::{Analog, Counted, Deep, Integrator, VolPath},
    lecture::Lecture,
};

use crate::args::IntegratorName;

/// The estimator of a name. `max_depth`, a limit on the scatterings of a path that are `counted`, is for `volpath` alone.
pub(crate) fn integrator(name: IntegratorName, max_depth: Option<u32>, counted: Counted) -> Box<dyn Integrator> {
    let lecture = |version: Lecture| -> Box<dyn Integrator> { Box::new(version) };
    let volpath =
        |deep: Deep| -> Box<dyn Integrator> { Box::new(VolPath { max_depth, counted, deep, ..VolPath::default() }) };
    match name {
        IntegratorName::Volpath => volpath(Deep::Together),
        IntegratorName::VolpathAlone => volpath(Deep::Alone),
        IntegratorName::VolpathTraced => volpath(Deep::Traced),
        IntegratorName::Analog => Box::new(Analog),
        IntegratorName::LectureSurface0 => lecture(Lecture::SurfaceV0),
        IntegratorName::LectureSurface05 => lecture(Lecture::SurfaceV0_5),
        IntegratorName::LectureSurface075 => lecture(Lecture::SurfaceV0_75),
        IntegratorName::LectureSurface10 => lecture(Lecture::SurfaceV1),
        IntegratorName::LectureVolume0 => lecture(Lecture::VolumeV0),
        IntegratorName::LectureVolume05 => lecture(Lecture::VolumeV0_5),
        IntegratorName::LectureVolume075 => lecture(Lecture::VolumeV0_75),
        IntegratorName::LectureVolume10 => lecture(Lecture::VolumeV1),
    }
}
