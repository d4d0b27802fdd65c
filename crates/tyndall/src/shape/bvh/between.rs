//! All surfaces on a short way: in no order, and those at one distance too.

use super::{Child, Content, Node, Primitive, Tree, triangle::Shear};
use crate::math::{Bounds, Ray, Vec2};

/// A triangle on the way: distance, object, triangle, weights.
pub(in crate::shape) type OnTheWay = (f32, u32, u32, Vec2);

/// Calls `triangle` for each triangle of a tree with `0 < t < t_max`, and `other` for each other primitive whose box
/// touches the way. A triangle can be told twice.
pub(in crate::shape) fn between(
    tree: &Tree,
    ray: &Ray,
    t_max: f32,
    triangle: &mut impl FnMut(OnTheWay),
    other: &mut impl FnMut(&Primitive),
) {
    let way = Bounds::of([ray.origin, ray.at(t_max)]);
    let mut open: Vec<Child> = tree.root.into_iter().collect();
    while let Some(child) = open.pop() {
        match child.content() {
            Content::Node(index) => {
                let node = &tree.nodes[index];
                open.extend((0..8).filter(|&slot| touches(node, slot, &way)).map(|slot| node.child[slot]));
            }
            Content::Packets { first, count } => {
                let shear = Shear::new(ray);
                for packet in &tree.packets[first..first + count] {
                    for lane in packet.filled() {
                        let (id, Some(hit)) = (packet.ids[lane], shear.resolve(packet, lane)) else { continue };
                        if hit.t > 0.0 && hit.t < f64::from(t_max) {
                            triangle((hit.t as f32, id.object, id.prim, hit.uv));
                        }
                    }
                }
            }
            Content::Bundles { first, count } => {
                for bundle in &tree.bundles[first..first + count] {
                    bundle.filled().for_each(|lane| other(&bundle.primitive(lane)));
                }
            }
            Content::Others { first, count } => tree.others[first..first + count].iter().for_each(&mut *other),
        }
    }
}

/// Whether a child's box and the way's have a point in common. (Boxes of no child are empty.)
fn touches(node: &Node, slot: usize, way: &Bounds) -> bool {
    (0..3).all(|axis| {
        let (low, high) = (node.planes[2 * axis][slot], node.planes[2 * axis + 1][slot]);
        low <= high && low <= way.max[axis] && high >= way.min[axis]
    })
}
