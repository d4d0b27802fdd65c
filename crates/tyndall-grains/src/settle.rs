//! Settling: grains fall, roll and come to rest, by the rigid bodies of the crate `rapier3d`.
//!
//! A container is filled in rounds: grains are put at random into the room that is left (random sequential addition, loosely),
//! and fall, until no more find a place. They are inelastic, with Coulomb's `friction` between them and at the walls, in a medium
//! that lets none fall faster than some twenty radii per second. At rest is a round whose mean square speed is too little to
//! lift a grain by a hundred thousandth of its radius.
//!
//! Rigid bodies sink into each other a little under load. So each is [`SKIN`] larger than its grain, and at the end all float
//! without weight until contacts have pushed them apart. What still overlaps a grain or a wall then is taken out and counted:
//! the sizes are those asked for, and a pack has no overlaps.
//!
//! Equal balls fill 0.55 (much friction) to 0.64 (none) of space: random loose and random close packing (Song, Wang and Makse 2008).
//! Ellipsoids move as polyhedra around them, 1.5 % larger at most; meshes as their convex hulls.

use glam::{DQuat, DVec3};
use rapier3d::prelude::{
    ColliderBuilder, PhysicsWorld, Pose, RigidBodyBuilder, RigidBodyHandle, Rotation, SharedShape, SpringCoefficients,
    TriMeshFlags,
};
use tyndall::sampling::Rng;

use crate::{
    GrainError,
    form::single,
    pack::{Grain, Pack, Recipe},
    walls::walls,
};

/// The most grains that settle: some two kilobytes each, and minutes.
pub const MOST: u64 = 300_000;

/// How much larger than its grain a body is \[1\].
pub const SKIN: f64 = 0.001;

/// The most that the largest radius may be of the smallest.
const VARIED: f64 = 10.0;
/// The most that half a container may be of a grain: single precision ends at 10⁻⁴ radii.
const WIDEST: f64 = 1000.0;
/// Failures in a row that end a round of adding.
const PATIENCE: u32 = 2000;
/// Of what is there, the least that a round must add for another to follow \[1\].
const WORTHWHILE: f64 = 0.005;
/// Gravity [radii/s²], and the rate at which speed is lost [1/s].
const GRAVITY: f64 = 10.0;
const DRAG: f64 = 0.5;
/// Root mean square speed of what is at rest [radii/s].
const REST: f64 = 0.014;
/// Root mean square speed of new grains at which more may fall, and speed of what counts as settled when somebody interrupts
/// [radii/s].
const SLOW: f64 = 0.3;
/// What part of the time grains fall; in the rest they come to rest.
const FALLING: f64 = 0.7;
/// Steps a second, and between two looks.
const RATE: f64 = 60.0;
const LOOK: u32 = 10;
/// The most looks while grains float apart.
const FLOATING: u32 = 60;

/// How far it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Grains in the container.
    pub grains: u64,
    /// What part of the time has passed, by estimate \[1\].
    pub done: f64,
}

/// What has come to rest.
#[derive(Debug)]
pub struct Settled {
    /// What is in the container.
    pub pack: Pack,
    /// Grains that were taken out because they overlapped others or a wall, or had not come to rest when somebody interrupted.
    pub removed: usize,
    /// Root mean square speed at the end, of a speed that lifts a grain by its radius \[1\].
    pub unrest: f64,
}

/// Fills a container with grains that have come to rest. `go_on` hears how far it is, and says whether to continue.
///
/// # Errors
/// As [`Pack::fill`]; more than [`MOST`], sizes that differ too much, friction that cannot be.
pub fn settle(recipe: &Recipe, friction: f64, mut go_on: impl FnMut(Progress) -> bool) -> Result<Settled, GrainError> {
    let mut pack = Pack::empty(recipe)?;
    let unit = unit(recipe, friction)?;
    let mut bodies = Bodies::new(&pack, unit, friction);
    let interrupted = bodies.fall(&mut pack, recipe, &mut go_on);
    if pack.grains.is_empty() {
        return Err(GrainError::NoRoom);
    }
    let unrest = bodies.unrest() / (2.0 * GRAVITY).sqrt();
    let all = pack.grains.len();
    if interrupted {
        bodies.remove_fast();
    }
    bodies.float_apart(&mut pack);
    Ok(Settled { removed: all - pack.grains.len(), pack, unrest })
}

/// The middle of the radii \[length\], of a recipe that rigid bodies can follow.
fn unit(recipe: &Recipe, friction: f64) -> Result<f64, GrainError> {
    let (smallest, largest) = (recipe.radii.smallest(), recipe.radii.largest());
    if recipe.count > MOST {
        return Err(GrainError::Settling(recipe.count));
    }
    if largest > VARIED * smallest {
        return Err(GrainError::Varied { smallest, largest });
    }
    if !(0.0..=10.0).contains(&friction) {
        return Err(GrainError::Friction(friction));
    }
    let unit = (smallest * largest).sqrt();
    let half = recipe.container.half().max_element();
    if half > WIDEST * unit {
        return Err(GrainError::TooSmall { radius: unit, least: half / WIDEST });
    }
    Ok(unit)
}

/// Grains as rigid bodies; lengths in a unit of their size.
struct Bodies {
    world: PhysicsWorld,
    handles: Vec<(RigidBodyHandle, f64)>,
    unit: f64,
    friction: f32,
    /// Of a grain of radius 1; of balls there is none.
    polyhedron: Option<rapier3d::parry::shape::ConvexPolyhedron>,
}

impl Bodies {
    fn new(pack: &Pack, unit: f64, friction: f64) -> Self {
        let mut world = PhysicsWorld::new();
        world.gravity.z = -GRAVITY as f32;
        world.gravity.y = 0.0;
        world.integration_parameters.dt = 1.0 / RATE as f32;
        let friction = friction as f32;
        let (points, triangles) = walls(&pack.container, pack.largest);
        let points = points.into_iter().map(|point| single(point / unit)).collect();
        if let Ok(shape) = SharedShape::trimesh_with_flags(points, triangles, TriMeshFlags::FIX_INTERNAL_EDGES) {
            world.insert_collider(ColliderBuilder::new(shape).friction(friction), None);
        }
        Self { world, handles: Vec::new(), unit, friction, polyhedron: pack.form.polyhedron() }
    }

    /// Adds the grains from one on.
    fn insert(&mut self, pack: &Pack, from: usize) {
        for grain in &pack.grains[from..] {
            let radius = (grain.radius / self.unit * (1.0 + SKIN)) as f32;
            let grown =
                self.polyhedron.as_ref().and_then(|body| body.clone().scaled(single(DVec3::splat(radius.into()))));
            let shape = grown.map_or_else(|| SharedShape::ball(radius), SharedShape::new);
            let turn = Rotation::from_array(grain.turn.to_array().map(|x| x as f32));
            let body = RigidBodyBuilder::dynamic()
                .pose(Pose::from_parts(single(grain.centre / self.unit), turn))
                .linear_damping(DRAG as f32)
                .angular_damping(DRAG as f32);
            let (handle, _) = self.world.insert(body, ColliderBuilder::new(shape).friction(self.friction));
            self.handles.push((handle, grain.radius));
        }
    }

    /// Adds grains in rounds and lets them fall, until no more find a place; whether somebody has interrupted that.
    fn fall(&mut self, pack: &mut Pack, recipe: &Recipe, go_on: &mut impl FnMut(Progress) -> bool) -> bool {
        let unit = self.unit;
        let mut rng = Rng::for_sample((0, 0), 0, recipe.seed);
        // Time to fall through the container, and to come to rest.
        let seconds = 2.0 * recipe.container.half().z / unit * DRAG / GRAVITY + 3.0;
        let expected = (seconds * RATE) as u32;
        let room = 0.62 * recipe.container.volume() / (4.19 * unit.powi(3));
        let all = room.min(recipe.count as f64);
        let (mut interrupted, mut last) = (false, false);
        while !interrupted && !last {
            let before = pack.grains.len();
            pack.add(recipe, &mut rng, PATIENCE, &mut |_| true);
            let added = pack.grains.len() - before;
            last = added as f64 <= WORTHWHILE * before as f64;
            if last {
                pack.grains.truncate(before);
            }
            self.insert(pack, before);
            // Few of them move in a late round.
            let enough = if last { REST } else { SLOW * (added as f64 / pack.grains.len() as f64).sqrt() };
            for step in 1..=4 * expected {
                self.world.step();
                if step % LOOK == 0 {
                    let passed = f64::from(step.min(expected)) / f64::from(expected);
                    let fallen = (before as f64 + if last { 0.0 } else { passed * added as f64 }) / all;
                    let done = if last { FALLING + (1.0 - FALLING) * passed } else { FALLING * fallen.min(1.0) };
                    interrupted = !go_on(Progress { grains: pack.grains.len() as u64, done });
                    if interrupted || self.unrest() < enough {
                        break;
                    }
                }
            }
            self.read(pack);
        }
        interrupted
    }

    /// Root mean square speed [radii/s].
    fn unrest(&self) -> f64 {
        let squares: f64 = self.world.bodies.iter().map(|(_, body)| f64::from(body.linvel().length_squared())).sum();
        (squares / self.handles.len().max(1) as f64).sqrt()
    }

    /// Takes out what is still on its way.
    fn remove_fast(&mut self) {
        let world = &mut self.world;
        self.handles.retain(|&(handle, _)| {
            let slow = f64::from(world.bodies[handle].linvel().length()) < SLOW;
            if !slow {
                world.remove_body(handle);
            }
            slow
        });
    }

    /// Ends gravity, and lets speeds die.
    fn float(&mut self) {
        self.world.gravity.z = 0.0;
        for (_, body) in self.world.bodies.iter_mut() {
            body.set_linear_damping(RATE as f32);
            body.set_angular_damping(RATE as f32);
        }
        for (_, collider) in self.world.colliders.iter_mut() {
            collider.set_friction(0.0);
        }
        // Contacts push firmly now that they carry nothing.
        let parameters = &mut self.world.integration_parameters;
        parameters.contact_softness = SpringCoefficients::new(60.0, 2.0);
        parameters.static_contact_softness = parameters.contact_softness;
    }

    /// Lets them float until contacts have pushed them apart, and takes out what overlaps then nevertheless.
    fn float_apart(&mut self, pack: &mut Pack) {
        self.float();
        for _ in 0..FLOATING {
            // What hardly moves falls asleep, overlapping or not.
            self.world.wake_up_all(true);
            (0..LOOK).for_each(|_| self.world.step());
            self.read(pack);
            pack.sift();
            if pack.grains.len() == self.handles.len() {
                break;
            }
        }
    }

    /// Where the grains are now.
    fn read(&self, pack: &mut Pack) {
        pack.replace(self.handles.iter().map(|&(handle, radius)| {
            let pose = self.world.bodies[handle].position();
            let wide = |x: f32| f64::from(x);
            let centre = self.unit * DVec3::from_array(pose.translation.to_array().map(wide));
            Grain { centre, radius, turn: DQuat::from_array(pose.rotation.to_array().map(wide)).normalize() }
        }));
    }
}
