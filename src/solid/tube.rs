//! Tubes: chains of capsules.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::capsule::Capsule;
use super::table::{Build, Primitive};
use super::{Answer, Crossing, Scratch, Solid};
use crate::geom::{Aabb, Interval, Ray};
use crate::scene::{BuildError, Call, Decl, Group, Kind, Param, Value};

/// The line of the table.
pub const PRIMITIVE: Primitive = Primitive {
    decl: Decl {
        word: "tube",
        group: Group::Primitive,
        doc: "A chain of capsules: all points nearer than r to the line through the points.",
        params: &[
            Param {
                required: true,
                ..Param::placed("points", Kind::Points, "a list of points, one or more")
            },
            Param::required("r", Kind::Size, "radius"),
        ],
        example: "tube([[0, 0, 0], [2, 0, 0], [2, 2, 1]], r: 0.5)",
    },
    build: Build::Exact(build),
};

fn build(call: &Call) -> Result<Arc<dyn Solid>, BuildError> {
    match call.get("points") {
        Some(Value::Points(points)) if !points.is_empty() => {
            Ok(Arc::new(Tube::new(points, call.number("r").unwrap_or(0.0))))
        }
        _ => Err(BuildError {
            param: "points",
            message: "a tube needs at least one point".into(),
            help: "write `tube([[0, 0, 0], [1, 0, 0], [1, 1, 0]], r: 0.1)`".into(),
        }),
    }
}

/// The union of the capsules about the segments of a line through points.
#[derive(Clone, Debug)]
pub struct Tube {
    points: Vec<DVec3>,
    radius: f64,
    capsules: Vec<Capsule>,
    /// Boxes of a balanced binary tree over the segments in their order: node i has the children 2 i + 1 and 2 i + 2.
    boxes: Vec<Aabb>,
}

/// The node, and the segments below it.
type Branch = (usize, usize, usize);

impl Tube {
    /// Through the points in their order; a ball about a single point, nothing where there is none.
    pub fn new(points: &[DVec3], radius: f64) -> Tube {
        let segment = |w: &[DVec3]| Capsule::new(radius, w[0], w[w.len() - 1]);
        let capsules: Vec<Capsule> = points.windows(points.len().clamp(1, 2)).map(segment).collect();
        let mut tube = Tube { points: points.to_vec(), radius, capsules, boxes: Vec::new() };
        tube.boxes = vec![Aabb::EMPTY; 2 * tube.capsules.len().next_power_of_two()];
        let mut open: Vec<Branch> = vec![(0, 0, tube.capsules.len())];
        while let Some((node, lo, hi)) = open.pop() {
            let boxes = tube.capsules[lo..hi].iter().map(|c| c.extent(&DAffine3::IDENTITY));
            // A box only spares work: a margin well above rounding lets it decide nothing.
            tube.boxes[node] = boxes.fold(Aabb::EMPTY, Aabb::union).inflated(radius / 64.0);
            open.extend(children((node, lo, hi)).into_iter().flatten());
        }
        tube
    }
}

fn children((node, lo, hi): Branch) -> Option<[Branch; 2]> {
    let middle = lo + (hi - lo) / 2;
    (1 < hi - lo).then_some([(2 * node + 2, middle, hi), (2 * node + 1, lo, middle)])
}

/// Deep enough for 2^60 segments, as each level of the tree leaves at most one branch open.
const DEEPEST: usize = 64;

impl Solid for Tube {
    fn bounds(&self) -> Aabb {
        self.extent_under(&DAffine3::IDENTITY)
    }

    fn extent_under(&self, to_from: &DAffine3) -> Aabb {
        self.capsules.iter().map(|c| c.extent(to_from)).fold(Aabb::EMPTY, Aabb::union)
    }

    /// The spans of the segments that the ray's line may meet, those that overlap made one. Two segments share the ball
    /// about their joint, so their spans overlap there by the same numbers.
    fn crossings(&self, ray: &Ray, _: Interval, _: &mut Scratch, out: &mut Vec<Crossing>) -> Answer {
        let first = out.len();
        let mut open: [Branch; DEEPEST] = [(0, 0, 0); DEEPEST];
        open[0] = (0, 0, self.capsules.len());
        let mut count = usize::from(!self.capsules.is_empty());
        while 0 < count {
            count -= 1;
            let branch = open[count];
            if self.boxes[branch.0].clip(ray).is_empty() {
                continue;
            }
            if let Some(pair) = children(branch) {
                open[count..count + 2].copy_from_slice(&pair);
                count += 2;
            } else if let Some([lo, hi]) = self.capsules[branch.1].span(ray) {
                out.push(Crossing::exact(lo, true, branch.1 as u32));
                out.push(Crossing::exact(hi, false, branch.1 as u32));
            }
        }
        merge(out, first);
        Answer::whole_line(false)
    }

    fn moved(&self, by: f64) -> Result<Option<Arc<dyn Solid>>, &'static str> {
        let radius = self.radius + by;
        if by < 0.0 && 1 < self.capsules.len() {
            return Err("what lies inside the bends of a tube is no thinner tube");
        }
        let left = 0.0 < self.radius && 0.0 < radius;
        Ok(left.then(|| Arc::new(Tube::new(&self.points, radius)) as Arc<dyn Solid>))
    }

    fn normal(&self, ray: &Ray, crossing: &Crossing, _: &mut Scratch) -> DVec3 {
        self.capsules[crossing.part as usize].normal_at(ray.at(crossing.t))
    }
}

/// Makes one of spans that overlap or touch, in `out` from `first` on, where each is an entry and an exit.
fn merge(out: &mut Vec<Crossing>, first: usize) {
    let (pairs, _) = out[first..].as_chunks_mut::<2>();
    // Of spans that begin together the first segment's comes first: no order of the walk shows.
    pairs.sort_unstable_by(|a, b| a[0].t.total_cmp(&b[0].t).then(a[0].part.cmp(&b[0].part)));
    let mut kept = 0;
    for i in 0..pairs.len() {
        if 0 < kept && pairs[i][0].t <= pairs[kept - 1][1].t {
            if pairs[kept - 1][1].t < pairs[i][1].t {
                pairs[kept - 1][1] = pairs[i][1];
            }
        } else {
            pairs[kept] = pairs[i];
            kept += 1;
        }
    }
    out.truncate(first + 2 * kept);
}
