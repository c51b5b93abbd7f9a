//! The light on a surface, and the colours of bodies.

use super::camera::Camera;
use super::raster::Colour;
use super::{cross, dot, unit};
use nearmiss::mesh::Body;
use std::collections::HashMap;

/// The paper, almost white: white is left for a page around.
pub const PAPER: Colour = [0.965, 0.97, 0.975];
/// Points and lines of contacts.
pub const INK: Colour = [0.08, 0.09, 0.13];

/// Colours that are neither red nor orange, and differ in lightness too.
const BODIES: [[u8; 3]; 6] =
    [[132, 164, 204], [226, 212, 182], [150, 192, 164], [182, 168, 208], [118, 176, 186], [196, 200, 206]];

/// Neighbours whose normals are within this cosine of a triangle's (about 50 degrees) are one surface with it.
const SMOOTH: f64 = 0.64;
/// More triangles than this at a vertex are not looked through: their corners are flat.
const MOST: usize = 64;

/// The colour of each triangle that meets nothing, as bytes: a colour a body, of a body alone one a connected part of it.
pub fn colours(bodies: &[Body], faces: &[[u32; 3]], vertices: usize) -> Vec<[u8; 3]> {
    let part = |number: usize| BODIES[number % BODIES.len()];
    if let [_] = bodies {
        return parts(faces, vertices).into_iter().map(part).collect();
    }
    let of = |(number, body): (usize, &Body)| std::iter::repeat_n(part(number), body.element_count());
    bodies.iter().enumerate().flat_map(of).collect()
}

/// The connected part that each triangle is of, counted from 0 as they come.
fn parts(faces: &[[u32; 3]], vertices: usize) -> Vec<usize> {
    let mut above: Vec<u32> = (0..vertices as u32).collect();
    for &[a, b, c] in faces {
        for (one, other) in [(a, b), (a, c)] {
            let tops = [top(&mut above, one), top(&mut above, other)];
            above[tops[0].max(tops[1]) as usize] = tops[0].min(tops[1]);
        }
    }
    let mut numbers = HashMap::new();
    let number = |face: &[u32; 3]| {
        let count = numbers.len();
        *numbers.entry(top(&mut above, face[0])).or_insert(count)
    };
    faces.iter().map(number).collect()
}

/// The smallest vertex known to be connected with one; shortens the way to it.
fn top(above: &mut [u32], mut vertex: u32) -> u32 {
    while above[vertex as usize] != vertex {
        above[vertex as usize] = above[above[vertex as usize] as usize];
        vertex = above[vertex as usize];
    }
    vertex
}

/// The normal of each triangle's corners: the mean of those of its neighbours that go on smoothly, weighted by area. Zeros of a triangle
/// without area.
pub fn normals(points: &[[f64; 3]], faces: &[[u32; 3]]) -> Vec<[[f64; 3]; 3]> {
    let used = faces.iter().flatten().flat_map(|vertex| points[*vertex as usize]);
    let longest = used.fold(0.0f64, |most, x| most.max(x.abs())).max(f64::MIN_POSITIVE);
    let flat: Vec<[f64; 3]> = faces
        .iter()
        .map(|face| {
            let [a, b, c] = face.map(|vertex| points[vertex as usize].map(|x| x / longest));
            let side = |to: [f64; 3]| [0, 1, 2].map(|k| to[k] - a[k]);
            cross(side(b), side(c))
        })
        .collect();
    // The triangles of each vertex, one behind the other.
    let mut starts = vec![0u32; points.len() + 1];
    faces.iter().flatten().for_each(|vertex| starts[*vertex as usize + 1] += 1);
    (0..points.len()).for_each(|vertex| starts[vertex + 1] += starts[vertex]);
    let (mut next, mut around) = (starts.clone(), vec![0u32; 3 * faces.len()]);
    for (triangle, vertex) in faces.iter().enumerate().flat_map(|(at, face)| face.map(|vertex| (at, vertex)))
    {
        around[next[vertex as usize] as usize] = triangle as u32;
        next[vertex as usize] += 1;
    }
    let corner = |own: [f64; 3], vertex: u32| {
        let all = &around[starts[vertex as usize] as usize..starts[vertex as usize + 1] as usize];
        if all.len() > MOST {
            return unit(own);
        }
        // A triangle is a neighbour of its own.
        let mut sum = [0.0; 3];
        for &other in all {
            let normal = flat[other as usize];
            if dot(unit(own), unit(normal)) > SMOOTH {
                sum = [0, 1, 2].map(|k| sum[k] + normal[k]);
            }
        }
        unit(sum)
    };
    flat.iter().zip(faces).map(|(own, face)| face.map(|vertex| corner(*own, vertex))).collect()
}

/// Colour of a surface with that normal, seen from either side. Light comes from the upper left in
/// front, and from all around.
pub fn lit(colour: [u8; 3], normal: [f64; 3], camera: &Camera) -> Colour {
    let [x, y, z] = camera.turned(normal);
    let [x, y, z] = if z < 0.0 { [-x, -y, -z] } else { [x, y, z] };
    let lamp = unit([-0.45, 0.75, 0.65]);
    let direct = dot([x, y, z], lamp).max(0.0);
    // From above there is more light than from below.
    let light = 0.47 + 0.09 * y + 0.08 * z + 0.46 * direct;
    colour.map(|part| f32::from(part) / 255.0 * light.min(1.0) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paint;

    #[test]
    fn parts_are_told_apart() {
        let faces = [[0, 1, 2], [3, 4, 5], [2, 1, 6], [7, 6, 8], [5, 9, 3]];
        assert_eq!(parts(&faces, 10), [0, 1, 0, 0, 1]);
    }

    #[test]
    fn bodies_have_colours_of_their_own() {
        for (k, one) in BODIES.iter().enumerate() {
            let others = BODIES[k + 1..].iter().chain([&paint::RED, &paint::ORANGE]);
            for other in others {
                let apart: i32 = (0..3).map(|c| (i32::from(one[c]) - i32::from(other[c])).abs()).sum();
                assert!(apart > 40, "{one:?} and {other:?}");
            }
        }
    }

    #[test]
    fn a_smooth_corner_has_its_neighbours_mean_and_a_sharp_one_its_own() {
        // Two triangles with a common side, bent by a little, and a third at right angles to the first.
        let points = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.2], [0.0, 0.0, -1.0]];
        let faces = [[0, 2, 1], [0, 1, 3], [0, 1, 4]];
        let all = normals(&points, &faces);
        assert_eq!(all[0][1], [0.0, 0.0, 1.0]);
        assert!(all[0][0][0] > 0.05 && all[0][0] == all[1][0], "{all:?}");
        assert_eq!(all[2], [[-1.0, 0.0, 0.0]; 3]);
        assert_eq!(normals(&points, &[[0, 0, 0]]), [[[0.0; 3]; 3]]);
    }
}
