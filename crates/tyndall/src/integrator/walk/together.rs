//! Many walks in one medium at once, a lane each. A lane that has ended is filled again at once: walks differ in length,
//! and lanes that wait for the longest do nothing most of the time.

use fearless_simd::{Level, Simd, dispatch};

use super::{Ball, End, Walker, step};
use crate::{math::Vec3, medium::MediumId, phase::Phase, sampling::Rng};

/// Lanes: what the widest instruction set does at once.
pub(crate) const WIDTH: usize = 16;

/// Runs the walks of a school for one model of phase functions.
macro_rules! swim {
    ($school:expr, $level:expr, $model:expr, $least:expr, $ended:expr) => {
        if $school.lit {
            dispatch!($level, simd => $school.run::<_, true>(simd, |u| $model.sample(u), $least, &mut $ended))
        } else {
            dispatch!($level, simd => $school.run::<_, false>(simd, |u| $model.sample(u), $least, &mut $ended))
        }
    };
}

/// Walks under way in one medium, each with the number of its path.
#[derive(Debug)]
pub(crate) struct School {
    level: Level,
    medium: MediumId,
    lit: bool,
    waiting: Vec<(u32, Walker)>,
}

impl School {
    pub(crate) fn new(medium: MediumId, lit: bool) -> Self {
        Self { level: Level::new(), medium, lit, waiting: Vec::new() }
    }

    pub(crate) fn medium(&self) -> MediumId {
        self.medium
    }

    pub(crate) fn len(&self) -> usize {
        self.waiting.len()
    }

    pub(crate) fn push(&mut self, path: u32, walker: Walker) {
        self.waiting.push((path, walker));
    }

    /// Walks until fewer than `least` walks are under way, and tells `ended` of each that ends.
    pub(crate) fn swim(&mut self, phase: &Phase, least: usize, mut ended: impl FnMut(u32, &Walker, End)) {
        let level = self.level;
        match phase {
            Phase::Isotropic(model) => swim!(self, level, model, least, ended),
            Phase::HenyeyGreenstein(model) => swim!(self, level, model, least, ended),
            Phase::Rayleigh(model) => swim!(self, level, model, least, ended),
            Phase::Tabulated(model) => swim!(self, level, model, least, ended),
            Phase::Blend(model) => swim!(self, level, model, least, ended),
        }
    }

    #[inline(always)]
    fn run<S: Simd, const LIT: bool>(
        &mut self,
        simd: S,
        cosine: impl Fn(f32) -> f32 + Copy,
        least: usize,
        ended: &mut impl FnMut(u32, &Walker, End),
    ) {
        let mut lanes = Lanes::default();
        let mut paths = [NOBODY; WIDTH];
        let mut swimming = 0;
        for lane in 0..WIDTH {
            swimming += usize::from(self.fill(&mut lanes, &mut paths, lane));
        }
        while swimming > 0 && swimming + self.waiting.len() >= least {
            let codes = simd.vectorize(
                #[inline(always)]
                || lanes.collide::<LIT>(cosine),
            );
            if codes.iter().fold(0, |any, code| any | code) == step::GOES_ON {
                continue;
            }
            for lane in 0..WIDTH {
                if codes[lane] == step::GOES_ON || paths[lane] == NOBODY {
                    continue;
                }
                if let Some(end) = step::end(codes[lane]) {
                    ended(paths[lane], &lanes.get(lane, self.medium, LIT), end);
                }
                swimming -= usize::from(!self.fill(&mut lanes, &mut paths, lane));
            }
        }
        for lane in 0..WIDTH {
            if paths[lane] != NOBODY {
                self.waiting.push((paths[lane], lanes.get(lane, self.medium, LIT)));
            }
        }
    }

    /// Gives a lane to the next walk; false if there is none.
    #[inline(always)]
    fn fill(&mut self, lanes: &mut Lanes, paths: &mut [u32; WIDTH], lane: usize) -> bool {
        match self.waiting.pop() {
            Some((path, walker)) => {
                paths[lane] = path;
                lanes.set(lane, &walker);
                true
            }
            None => {
                paths[lane] = NOBODY;
                false
            }
        }
    }
}

/// The number of no path.
const NOBODY: u32 = u32::MAX;

/// The numbers of [`WIDTH`] walkers, one array each.
#[derive(Debug, Clone, Default)]
#[repr(align(64))]
struct Lanes {
    p: [[f32; WIDTH]; 3],
    dir: [[f32; WIDTH]; 3],
    centre: [[f32; WIDTH]; 3],
    radius: [f32; WIDTH],
    mean_free_path: [f32; WIDTH],
    sigma_min: [f32; WIDTH],
    length: [f32; WIDTH],
    flight: [f32; WIDTH],
    cos_theta: [f32; WIDTH],
    key: [[u32; WIDTH]; 2],
    counter: [u32; WIDTH],
    collisions: [u32; WIDTH],
    limit: [u32; WIDTH],
}

impl Lanes {
    #[inline(always)]
    fn collide<const LIT: bool>(&mut self, cosine: impl Fn(f32) -> f32 + Copy) -> [u32; WIDTH] {
        let mut codes = [0; WIDTH];
        for lane in 0..WIDTH {
            let mut walker = self.get(lane, MediumId(0), LIT);
            codes[lane] = step::collide::<LIT>(&mut walker, cosine);
            self.set(lane, &walker);
        }
        codes
    }

    #[inline(always)]
    fn get(&self, i: usize, medium: MediumId, lit: bool) -> Walker {
        let vector = |v: &[[f32; WIDTH]; 3]| Vec3::new(v[0][i], v[1][i], v[2][i]);
        Walker {
            medium,
            p: vector(&self.p),
            dir: vector(&self.dir),
            rng: Rng { key: [self.key[0][i], self.key[1][i]], counter: self.counter[i] },
            ball: Ball { centre: vector(&self.centre), radius: self.radius[i] },
            mean_free_path: self.mean_free_path[i],
            sigma_min: self.sigma_min[i],
            lit,
            collisions: self.collisions[i],
            limit: self.limit[i],
            length: self.length[i],
            flight: self.flight[i],
            cos_theta: self.cos_theta[i],
        }
    }

    #[inline(always)]
    fn set(&mut self, i: usize, walker: &Walker) {
        let put = |to: &mut [[f32; WIDTH]; 3], v: Vec3| (to[0][i], to[1][i], to[2][i]) = (v.x, v.y, v.z);
        put(&mut self.p, walker.p);
        put(&mut self.dir, walker.dir);
        put(&mut self.centre, walker.ball.centre);
        self.radius[i] = walker.ball.radius;
        self.mean_free_path[i] = walker.mean_free_path;
        self.sigma_min[i] = walker.sigma_min;
        self.length[i] = walker.length;
        self.flight[i] = walker.flight;
        self.cos_theta[i] = walker.cos_theta;
        (self.key[0][i], self.key[1][i]) = (walker.rng.key[0], walker.rng.key[1]);
        self.counter[i] = walker.rng.counter;
        self.collisions[i] = walker.collisions;
        self.limit[i] = walker.limit;
    }
}
