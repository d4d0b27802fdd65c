//! Many paths at once: those that are deep inside a medium walk together, the others step one after the other.
//!
//! A path is a value that owns its random numbers, so the order in which paths are followed cannot be seen in what each
//! of them finds. Who follows them, and what is made of it, is a [`Crew`]: an estimator of radiance, an instrument.

use super::walk::{
    Announced, End, Walker,
    together::{News, WIDTH, Walks},
};
use crate::{
    medium::MediumId,
    phase::Phase,
    scene::{Lit, Scene},
    tally::Tally,
};

/// Paths under way at once: enough that walks rarely wait for others, and few enough for the cache.
const PATHS: usize = 128;

/// Follows paths.
pub trait Crew {
    /// A path, with what else there is to know of it.
    type Member;

    /// Follows a path until it walks deep inside a medium; `None` at its end.
    fn advance(&mut self, member: &mut Self::Member, tally: &mut Tally) -> Option<Walker>;

    /// Light is to be sampled on its walk.
    fn light(&mut self, _: &Self::Member, _: &Announced, _: &Phase, _: &mut Tally) {}

    /// Its walk is over.
    fn end_walk(&mut self, member: &mut Self::Member, walker: &Walker, end: End, phase: &Phase, tally: &mut Tally);
}

/// Paths under way.
struct Pool<M> {
    members: Vec<M>,
    /// Numbers of paths that are at their end.
    free: Vec<u32>,
    /// Walks under way, by medium: those in balls and those in its block.
    walks: Vec<Walks>,
}

/// Follows all of `members` to their end.
pub fn follow<C: Crew>(scene: &Scene, crew: &mut C, members: impl IntoIterator<Item = C::Member>, tally: &mut Tally) {
    let walks = (0..scene.media.len()).map(|i| MediumId(i as u32));
    let worlds = || std::iter::once(scene).chain(scene.proxied());
    let lit = |id| worlds().any(|world| world.lit(Some(id)) != Lit::Never);
    let block = |id| worlds().find_map(|world| world.room(id)?.block());
    let walks = walks.flat_map(|id| [None, block(id)].map(|block| Walks::new(id, lit(id), block))).collect();
    let mut pool = Pool { members: Vec::with_capacity(PATHS), free: Vec::new(), walks };
    let mut waiting = members.into_iter();
    let mut ended = Vec::with_capacity(PATHS);
    loop {
        while pool.has_room() {
            let Some(member) = waiting.next() else { break };
            let slot = pool.place(member);
            pool.advance(slot, crew, tally);
        }
        let Some(walks) = pool.walks.iter_mut().max_by_key(|walks| walks.len()) else { break };
        if walks.len() == 0 {
            break;
        }
        let least = if walks.len() < WIDTH { 1 } else { WIDTH };
        let (members, phase) = (&mut pool.members, &scene.medium(walks.medium()).phase);
        walks.advance(phase, least, &mut |slot, news| {
            let member = &mut members[slot as usize];
            match news {
                News::Light(announced) => crew.light(member, announced, phase, tally),
                News::Ended(walker, end) => {
                    crew.end_walk(member, walker, end, phase, tally);
                    ended.push(slot);
                }
            }
        });
        for slot in ended.drain(..) {
            pool.advance(slot, crew, tally);
        }
    }
}

impl<M> Pool<M> {
    fn has_room(&self) -> bool {
        !self.free.is_empty() || self.members.len() < PATHS
    }

    /// Takes a path in, and gives it a number.
    fn place(&mut self, member: M) -> u32 {
        if let Some(free) = self.free.pop() {
            self.members[free as usize] = member;
            return free;
        }
        self.members.push(member);
        self.members.len() as u32 - 1
    }

    /// Follows a path until it walks deep inside a medium or ends.
    fn advance<C: Crew<Member = M>>(&mut self, slot: u32, crew: &mut C, tally: &mut Tally) {
        match crew.advance(&mut self.members[slot as usize], tally) {
            Some(walker) => {
                let in_block = walker.room.block().is_some();
                self.walks[2 * walker.medium.0 as usize + usize::from(in_block)].push(slot, walker);
            }
            None => self.free.push(slot),
        }
    }
}
