//! What normals are computed from: the directions and the angles of triangles, and which positions are one.

use std::cmp::Ordering;

use glam::DVec3;
use rayon::prelude::*;

use crate::base::maths;

/// A normal of a file with length 1; zero if it has no length.
pub fn unit(normal: DVec3) -> DVec3 {
    normal.try_normalize().unwrap_or_default()
}

/// The direction that a triangle faces; `None` if it has no area.
pub fn facing([a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    scaled(edge(a, b).cross(edge(a, c))).try_normalize()
}

/// The way from one point to another, but for a factor. Halves do not overflow.
fn edge(from: DVec3, to: DVec3) -> DVec3 {
    scaled(to * 0.5 - from * 0.5)
}

/// The same direction with its greatest coordinate near 1, so that squares of it neither overflow nor vanish. The factor
/// is a power of 2, which changes no digit.
fn scaled(way: DVec3) -> DVec3 {
    const MOST_SHRUNK: u64 = 2045;
    let exponent = way.abs().max_element().to_bits() >> 52;
    way * f64::from_bits((MOST_SHRUNK + 1 - exponent.min(MOST_SHRUNK)) << 52)
}

/// The angles of a triangle that has an area, at its corners.
pub fn angles([a, b, c]: [DVec3; 3]) -> [f64; 3] {
    let [ab, bc, ca] = [edge(a, b), edge(b, c), edge(c, a)].map(unit);
    [(ca, ab), (ab, bc), (bc, ca)].map(|(to, from)| maths::acos((-to.dot(from)).clamp(-1.0, 1.0)))
}

/// For each position the number of its group, and how many groups there are: positions that are equal as numbers, 0 and
/// -0 too, are one group.
pub fn groups(positions: &[DVec3]) -> (Vec<u32>, usize) {
    // Most differ in x, which stands beside the index for that; which of several equal ones comes first does not matter.
    let mut order: Vec<(f64, u32)> = positions.iter().zip(0..).map(|(position, at)| (position.x + 0.0, at)).collect();
    order.par_sort_unstable_by(|(x, a), (y, b)| {
        x.total_cmp(y).then_with(|| compare(positions[*a as usize], positions[*b as usize]))
    });
    let mut groups = vec![0; positions.len()];
    let mut count = 0;
    for (at, &(_, position)) in order.iter().enumerate() {
        let equal = at > 0 && positions[order[at - 1].1 as usize] == positions[position as usize];
        count += usize::from(!equal);
        groups[position as usize] = (count - 1) as u32;
    }
    (groups, count)
}

fn compare(a: DVec3, b: DVec3) -> Ordering {
    // With 0 added, -0 is 0.
    let [a, b] = [a, b].map(|p| (p + DVec3::ZERO).to_array());
    a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(a[2].total_cmp(&b[2]))
}
