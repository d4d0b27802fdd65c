//! Where the light of a slab ends up, as totals in one array.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::Range;

use tyndall::bsdf::fresnel;

use super::{Edges, Incidence, Measured, Setup};
use crate::photon::{Collision, Detector, Photon};
use crate::run::{Estimate, Sums};

/// Where in the array each kind of quantity lies.
#[derive(Debug)]
pub(super) struct Layout {
    absorbed: Range<usize>,
    /// By exit angle, radius, order and length, reflected and transmitted.
    angle: [Range<usize>; 2],
    radius: [Range<usize>; 2],
    order: [Range<usize>; 2],
    length: [Range<usize>; 2],
    depth: Range<usize>,
    quantities: usize,
}

/// The first quantities: what leaves upwards and downwards, of each all, the unscattered and the scattered.
const EXITS: usize = 6;

impl Layout {
    pub(super) fn new(setup: &Setup) -> Self {
        let mut quantities = EXITS;
        let mut take = |count: usize| {
            quantities += count;
            quantities - count..quantities
        };
        let bins = &setup.bins;
        let absorbed = take(setup.layers.len());
        let [angle, radius, order, length] = [bins.angles, bins.radii.count(), bins.orders, bins.lengths.count()]
            .map(|count| [take(count), take(count)]);
        let depth = take(bins.depths.count());
        Self { absorbed, angle, radius, order, length, depth, quantities }
    }

    /// The figures, in their units.
    pub(super) fn read(&self, setup: &Setup, sums: &Sums) -> Measured {
        let bins = &setup.bins;
        let per = |range: &Range<usize>, size: &dyn Fn(usize) -> f64| -> Vec<Estimate> {
            range.clone().enumerate().map(|(i, quantity)| sums.estimate(quantity).scaled(1.0 / size(i))).collect()
        };
        let step = FRAC_PI_2 / bins.angles.max(1) as f64;
        let solid_angle = |i: usize| TAU * ((i as f64 * step).cos() - ((i + 1) as f64 * step).cos());
        let ring = |i: usize| {
            let [inner, outer] = bins.radii.bin(i);
            PI * (outer * outer - inner * inner)
        };
        let width = |edges: &Edges, i: usize| {
            let [start, end] = edges.bin(i);
            end - start
        };
        let whole = |_: usize| 1.0;
        Measured {
            photons: sums.photons(),
            collisions: sums.tally.collisions,
            specular: sums.estimate(1),
            first_surface: first_surface(setup),
            diffuse: sums.estimate(2),
            reflectance: sums.estimate(0),
            unscattered: sums.estimate(4),
            diffuse_transmittance: sums.estimate(5),
            transmittance: sums.estimate(3),
            absorbed: per(&self.absorbed, &whole),
            reflectance_by_angle: per(&self.angle[0], &solid_angle),
            transmittance_by_angle: per(&self.angle[1], &solid_angle),
            reflectance_by_radius: per(&self.radius[0], &ring),
            transmittance_by_radius: per(&self.radius[1], &ring),
            fluence: per(&self.depth, &|i| width(&bins.depths, i)),
            reflectance_by_order: per(&self.order[0], &whole),
            transmittance_by_order: per(&self.order[1], &whole),
            reflectance_by_length: per(&self.length[0], &|i| width(&bins.lengths, i)),
            transmittance_by_length: per(&self.length[1], &|i| width(&bins.lengths, i)),
        }
    }
}

/// The reflectance of the first surface alone \[1\].
fn first_surface(setup: &Setup) -> f64 {
    let eta = setup.layers[0].substance.n / setup.n_above;
    let at = |cosine: f64| f64::from(fresnel::dielectric(cosine as f32, eta as f32).reflectance);
    match setup.incidence {
        Incidence::Beam(_) if eta == 1.0 => 0.0,
        Incidence::Beam(1.0) => ((eta - 1.0) / (eta + 1.0)).powi(2),
        Incidence::Beam(cosine) => at(cosine),
        Incidence::Diffuse => mean_over_powers(1.0, at),
        Incidence::Power(k) => mean_over_powers(k, at),
    }
}

/// The mean of a function of the cosine μ of the incidence, where the power per cosine is `(k + 1) μᵏ`: over the midpoints
/// of equal parts of it.
fn mean_over_powers(k: f64, at: impl Fn(f64) -> f64) -> f64 {
    const PARTS: u32 = 4096;
    let part = |i: u32| at(((f64::from(i) + 0.5) / f64::from(PARTS)).powf(1.0 / (k + 1.0)));
    (0..PARTS).map(part).sum::<f64>() / f64::from(PARTS)
}

/// The totals of a batch.
#[derive(Debug)]
pub(super) struct Recorder<'a> {
    setup: &'a Setup,
    layout: &'a Layout,
    /// Depths of the lower ends of the layers [length].
    ends: Vec<f64>,
    totals: Vec<f64>,
}

impl<'a> Recorder<'a> {
    pub(super) fn new(setup: &'a Setup, layout: &'a Layout) -> Self {
        let ends = setup.layers.iter().scan(0.0, |depth, layer| {
            *depth += layer.thickness;
            Some(*depth)
        });
        Self { setup, layout, ends: ends.collect(), totals: vec![0.0; layout.quantities] }
    }

    fn add(&mut self, range: &Range<usize>, bin: Option<usize>, weight: f64) {
        if let Some(bin) = bin.filter(|bin| *bin < range.len()) {
            self.totals[range.start + bin] += weight;
        }
    }
}

impl Detector for Recorder<'_> {
    fn awaits(&self, order: u32) -> u32 {
        if self.layout.depth.is_empty() { u32::MAX } else { order }
    }

    fn collide(&mut self, c: &Collision) {
        let depth = -f64::from(c.p.z);
        let layer = self.ends.partition_point(|end| *end <= depth).min(self.ends.len() - 1);
        self.totals[self.layout.absorbed.start + layer] += c.absorbed;
        if !self.layout.depth.is_empty() {
            let sigma_t = self.setup.layers[layer].substance.sigma_t();
            self.add(&self.layout.depth, self.setup.bins.depths.find(depth), c.weight / sigma_t);
        }
    }

    fn totals(self) -> Vec<f64> {
        self.totals
    }

    fn leave(&mut self, photon: &Photon) {
        let (weight, dir, p) = (photon.weight(), photon.dir(), photon.at_surface.as_dvec3());
        let (bins, layout) = (&self.setup.bins, self.layout);
        let side = usize::from(dir.z < 0.0);
        // Light that got past the ends of the planes has left through neither face.
        let at_face = if side == 0 { p.z } else { p.z + self.setup.depth() };
        if at_face.abs() > self.setup.height() {
            return;
        }
        let scattered = photon.order() > 0;
        self.totals[3 * side] += weight;
        self.totals[3 * side + 1 + usize::from(scattered)] += weight;
        self.add(&layout.order[side], Some(photon.order() as usize), weight);
        if scattered || side == 1 {
            let angle = f64::from(dir.z.abs()).min(1.0).acos() / FRAC_PI_2 * bins.angles as f64;
            self.add(&layout.angle[side], Some(angle as usize), weight);
            self.add(&layout.radius[side], bins.radii.find(p.x.hypot(p.y)), weight);
            self.add(&layout.length[side], bins.lengths.find(photon.travelled - self.setup.height()), weight);
        }
    }
}
