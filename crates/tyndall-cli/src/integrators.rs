//! Estimators by name.

use tyndall::{
    integrator::{Analog, Deep, Integrator, VolPath},
    lecture::Lecture,
};
use tyndall_formats::desc::IntegratorDesc;

use crate::args::IntegratorName;

/// What a scene says of paths; among grains they are followed to their end.
pub(crate) fn explicit(said: &IntegratorDesc) -> VolPath {
    VolPath { max_depth: said.max_depth.map(|depth| depth.value), counted: said.counted, ..VolPath::default() }
}

/// The estimator of a name; the settings are for the path tracer alone.
pub(crate) fn integrator(name: IntegratorName, settings: VolPath) -> Box<dyn Integrator> {
    let lecture = |version: Lecture| -> Box<dyn Integrator> { Box::new(version) };
    match name {
        IntegratorName::Volpath => Box::new(VolPath { deep: Deep::Together, ..settings }),
        IntegratorName::VolpathAlone => Box::new(VolPath { deep: Deep::Alone, ..settings }),
        IntegratorName::VolpathTraced => Box::new(VolPath { deep: Deep::Traced, ..settings }),
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
