//! Many walks in one medium at once, a lane each. A lane that has ended is filled again at once: walks differ in length,
//! and lanes that wait for the longest do nothing most of the time.

use fearless_simd::{Level, Simd, dispatch};

use super::{Announced, End, Walker, step};
use crate::{
    math::Vec3,
    medium::MediumId,
    phase::Phase,
    sampling::Rng,
    shape::{Ball, Block, Room},
};

/// Lanes: what the widest instruction set does at once.
pub(crate) const WIDTH: usize = 16;

/// Advances walks with one model of phase functions.
macro_rules! advance {
    ($walks:expr, $level:expr, $model:expr, $least:expr, $hear:expr) => {
        match ($walks.lit, $walks.block) {
            (true, None) => advance!($walks, $level, true, Lanes::ball, $model, $least, $hear),
            (false, None) => advance!($walks, $level, false, Lanes::ball, $model, $least, $hear),
            (true, Some(block)) => advance!($walks, $level, true, in_block(block), $model, $least, $hear),
            (false, Some(block)) => advance!($walks, $level, false, in_block(block), $model, $least, $hear),
        }
    };
    ($walks:expr, $level:expr, $lit:expr, $room:expr, $model:expr, $least:expr, $hear:expr) => {
        dispatch!($level, simd => $walks.run::<_, $lit>(simd, $room, |u| $model.sample(u), $least, $hear))
    };
}

/// What walks tell on the way.
#[derive(Debug, Clone, Copy)]
pub(crate) enum News<'a> {
    /// Light is to be sampled.
    Light(&'a Announced),
    /// The walk is over.
    Ended(&'a Walker, End),
}

/// Walks under way in one medium, all in the same block or each in a ball of its own, with the numbers of their paths.
#[derive(Debug)]
pub(crate) struct Walks {
    level: Level,
    medium: MediumId,
    lit: bool,
    block: Option<Block>,
    waiting: Vec<(u32, Walker)>,
}

impl Walks {
    pub(crate) fn new(medium: MediumId, lit: bool, block: Option<Block>) -> Self {
        Self { level: Level::new(), medium, lit, block, waiting: Vec::new() }
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

    /// Walks until fewer than `least` walks are under way, and tells `hear` what becomes of each.
    pub(crate) fn advance(&mut self, phase: &Phase, least: usize, hear: &mut dyn FnMut(u32, News)) {
        let level = self.level;
        match phase {
            Phase::Isotropic(model) => advance!(self, level, model, least, hear),
            Phase::HenyeyGreenstein(model) => advance!(self, level, model, least, hear),
            Phase::Rayleigh(model) => advance!(self, level, model, least, hear),
            Phase::Tabulated(model) => advance!(self, level, model, least, hear),
            Phase::Blend(model) => advance!(self, level, model, least, hear),
        }
    }

    #[inline(always)]
    fn run<S: Simd, const LIT: bool>(
        &mut self,
        simd: S,
        room: impl Fn(&Lanes, usize) -> Room + Copy,
        cosine: impl Fn(f32) -> f32 + Copy,
        least: usize,
        hear: &mut dyn FnMut(u32, News),
    ) {
        let mut lanes = Lanes::default();
        let mut under_way = (0..WIDTH).filter(|&lane| self.fill(&mut lanes, lane)).count();
        while under_way > 0 && under_way + self.waiting.len() >= least {
            let codes = simd.vectorize(
                #[inline(always)]
                || {
                    loop {
                        let codes = lanes.collide::<LIT>(room, cosine);
                        if codes.iter().fold(0, |any, code| any | code) != step::GOES_ON {
                            return codes;
                        }
                    }
                },
            );
            for (lane, code) in codes.into_iter().enumerate() {
                let path = lanes.path[lane];
                if code == step::GOES_ON || path == NOBODY {
                    continue;
                }
                let walker = lanes.get(lane, self.medium, LIT, room);
                if step::is_lit(code) {
                    hear(path, News::Light(&walker.announced()));
                }
                if let Some(end) = step::end(code) {
                    hear(path, News::Ended(&walker, end));
                    under_way -= usize::from(!self.fill(&mut lanes, lane));
                }
            }
        }
        for (lane, path) in lanes.path.into_iter().enumerate().filter(|(_, path)| *path != NOBODY) {
            self.waiting.push((path, lanes.get(lane, self.medium, LIT, room)));
        }
    }

    /// Gives a lane to the next walk; false if there is none.
    #[inline(always)]
    fn fill(&mut self, lanes: &mut Lanes, lane: usize) -> bool {
        let Some((path, walker)) = self.waiting.pop() else {
            lanes.rest(lane, self.block.map_or(Vec3::ZERO, |block| block.centre));
            return false;
        };
        lanes.path[lane] = path;
        lanes.set(lane, &walker);
        true
    }
}

/// The number of no path.
const NOBODY: u32 = u32::MAX;

/// The numbers of [`WIDTH`] walkers, one array each.
#[derive(Debug, Clone, Default)]
#[repr(align(64))]
struct Lanes {
    path: [u32; WIDTH],
    p: [[f32; WIDTH]; 3],
    dir: [[f32; WIDTH]; 3],
    came: [[f32; WIDTH]; 3],
    centre: [[f32; WIDTH]; 3],
    radius: [f32; WIDTH],
    mean_free_path: [f32; WIDTH],
    sigma_min: [f32; WIDTH],
    share: [f32; WIDTH],
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
    fn collide<const LIT: bool>(
        &mut self,
        room: impl Fn(&Self, usize) -> Room + Copy,
        cosine: impl Fn(f32) -> f32 + Copy,
    ) -> [u32; WIDTH] {
        let mut codes = [0; WIDTH];
        for (lane, code) in codes.iter_mut().enumerate() {
            let mut walker = self.get(lane, MediumId(0), LIT, room);
            *code = step::collide::<LIT>(&mut walker, cosine);
            self.set(lane, &walker);
        }
        codes
    }

    /// A lane without a walk: it stays at a point that is inside and has nothing to say, so that it never stops the others.
    #[inline(always)]
    fn rest(&mut self, i: usize, inside: Vec3) {
        (self.p[0][i], self.p[1][i], self.p[2][i]) = (inside.x, inside.y, inside.z);
        self.path[i] = NOBODY;
        (self.radius[i], self.mean_free_path[i], self.share[i]) = (f32::INFINITY, 0.0, 0.0);
        (self.collisions[i], self.limit[i]) = (0, u32::MAX);
    }

    #[inline(always)]
    fn ball(&self, i: usize) -> Room {
        let centre = Vec3::new(self.centre[0][i], self.centre[1][i], self.centre[2][i]);
        Room::Ball(Ball { centre, radius: self.radius[i] })
    }

    #[inline(always)]
    fn get(&self, i: usize, medium: MediumId, lit: bool, room: impl Fn(&Self, usize) -> Room) -> Walker {
        let vector = |v: &[[f32; WIDTH]; 3]| Vec3::new(v[0][i], v[1][i], v[2][i]);
        Walker {
            medium,
            p: vector(&self.p),
            dir: vector(&self.dir),
            came: vector(&self.came),
            rng: Rng { key: [self.key[0][i], self.key[1][i]], counter: self.counter[i] },
            room: room(self, i),
            mean_free_path: self.mean_free_path[i],
            sigma_min: self.sigma_min[i],
            share: self.share[i],
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
        put(&mut self.came, walker.came);
        if let Room::Ball(ball) = walker.room {
            put(&mut self.centre, ball.centre);
            self.radius[i] = ball.radius;
        }
        self.mean_free_path[i] = walker.mean_free_path;
        self.sigma_min[i] = walker.sigma_min;
        self.share[i] = walker.share;
        self.length[i] = walker.length;
        self.flight[i] = walker.flight;
        self.cos_theta[i] = walker.cos_theta;
        (self.key[0][i], self.key[1][i]) = (walker.rng.key[0], walker.rng.key[1]);
        self.counter[i] = walker.rng.counter;
        self.collisions[i] = walker.collisions;
        self.limit[i] = walker.limit;
    }
}

/// The room of all walks that are in one block.
fn in_block(block: Block) -> impl Fn(&Lanes, usize) -> Room + Copy {
    #[inline(always)]
    move |_, _| Room::Block(block)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::phase::{Isotropic, Rayleigh};

    /// The instruction sets of this machine.
    fn levels() -> [Level; 4] {
        let best = Level::new();
        let (sse4_2, avx2) = (best.as_sse4_2().map(Simd::level), best.as_avx2().map(Simd::level));
        [best, Level::baseline(), sse4_2.unwrap_or(best), avx2.unwrap_or(best)]
    }

    /// A rhombohedron around where walks begin.
    fn block() -> Block {
        let axes = [Vec3::new(0.8, 0.6, 0.0), Vec3::new(0.8, -0.6, 0.0), Vec3::Z];
        Block { centre: Vec3::new(1.1, 1.9, 3.2), axes, half: [2.0, 3.0, 4.0] }
    }

    fn walker(number: u32, medium: MediumId, lit: bool, block: Option<Block>) -> Walker {
        let ball = Ball { centre: Vec3::new(1.0, 2.0, 3.0), radius: 2.0 + number as f32 * 0.1 };
        let dir = Vec3::new(0.6, 0.0, -0.8);
        Walker {
            medium,
            p: Vec3::new(1.0, 2.0, 3.0),
            dir: if number.is_multiple_of(2) { dir } else { Vec3::Z },
            came: dir,
            rng: Rng::for_sample((number, 0), 0, 1),
            room: block.map_or(Room::Ball(ball), Room::Block),
            mean_free_path: 0.3,
            share: 0.5 + 0.5 * (number % 2) as f32,
            sigma_min: 2.0,
            lit,
            collisions: 0,
            limit: 1 + number % 50,
            length: 0.0,
            flight: 0.0,
            cos_theta: 1.0,
        }
    }

    /// If they had, they would stop the others at each of their collisions.
    #[test]
    fn lanes_at_rest_have_nothing_to_say() {
        for block in [None, Some(block())] {
            let mut lanes = Lanes::default();
            // Half of them have walked before: to the end of their room and of their collisions.
            for lane in 0..WIDTH / 2 {
                let walker = walker(lane as u32, MediumId(0), true, block);
                lanes.set(lane, &Walker { collisions: 50, limit: 50, ..walker });
            }
            (0..WIDTH).for_each(|lane| lanes.rest(lane, block.map_or(Vec3::ZERO, |block| block.centre)));
            let room = |lanes: &Lanes, i: usize| block.map_or_else(|| lanes.ball(i), Room::Block);
            for _ in 0..10_000 {
                assert_eq!(lanes.collide::<true>(room, |u| 1.0 - 2.0 * u), [step::GOES_ON; WIDTH]);
            }
        }
    }

    /// Every instruction set of this machine gives the bits that one walk after the other gives, for every model.
    #[test]
    fn every_instruction_set_walks_alike() {
        let forward = Phase::henyey_greenstein(0.9).unwrap();
        let phases = [
            Phase::Isotropic(Isotropic),
            forward.clone(),
            Phase::Rayleigh(Rayleigh),
            Phase::tabulated(&[0.5, 0.1, 3.0]).unwrap(),
            Phase::blend(&forward, &Phase::Rayleigh(Rayleigh), 0.5).unwrap(),
        ];
        let medium = MediumId(0);
        let kinds = [true, false].into_iter().flat_map(|lit| [None, Some(block())].map(|block| (lit, block)));
        let kinds: Vec<_> = kinds.flat_map(|(lit, block)| levels().map(|level| (lit, block, level))).collect();
        for phase in &phases {
            for &(lit, block, level) in &kinds {
                let mut walks = Walks { level, medium, lit, block, waiting: Vec::new() };
                (0..100).for_each(|number| walks.push(number, walker(number, medium, lit, block)));
                let (mut ends, mut heard) = (0, vec![Vec::new(); 100]);
                walks.advance(phase, 1, &mut |number, news| match news {
                    News::Light(announced) => heard[number as usize].push(*announced),
                    News::Ended(together, end) => {
                        let (mut alone, mut announced) = (walker(number, medium, lit, block), Vec::new());
                        assert_eq!(alone.alone(phase, |a| announced.push(*a)), end, "{phase:?} {number}");
                        assert_eq!(alone, *together, "{phase:?} {number}");
                        assert_eq!(announced, heard[number as usize], "{phase:?} {number}");
                        ends += 1;
                    }
                });
                assert_eq!((ends, walks.len()), (100, 0));
                assert_eq!(heard.concat().is_empty(), !lit);
            }
        }
    }
}
