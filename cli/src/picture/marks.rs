//! Contacts as lines between the nearest points of both features.

use crate::paint::starts;
use nearmiss::contacts::{ContactGeometry, Contacts, Rows};
use nearmiss::mesh::Body;

/// More than this are not drawn: they would hide what they mark.
const MOST: usize = 400;

/// The nearest points of each contact, on the bodies as they are drawn. Near pairs and distances also
/// have the line between them. Triangle pairs have no points, and more than 400 contacts have no marks.
pub fn of(
    bodies: &[Body],
    points: &[[f64; 3]],
    found: &Contacts,
    geometry: &[ContactGeometry],
) -> Vec<[[f64; 3]; 2]> {
    if let Rows::Distance(nearest) = &found.rows {
        return nearest.iter().map(|nearest| nearest.points).collect();
    }
    if let Rows::BodyDistances(all) = &found.rows {
        return all.iter().take(MOST).map(|nearest| nearest.points).collect();
    }
    if geometry.len() > MOST {
        return Vec::new();
    }
    let starts = starts(bodies);
    let mark = |of: &ContactGeometry| {
        let [mut first, mut second] = [[0.0; 3]; 2];
        for (at, (vertex, weight)) in of.vertices.iter().zip(of.weights).enumerate() {
            let is_first = at < of.kind.vertices_of_a();
            let body = of.owner[at].index();
            let point = points[(starts[body].0 + *vertex) as usize];
            let sum = if is_first { &mut first } else { &mut second };
            (0..3).for_each(|k| sum[k] += weight * point[k]);
        }
        [first, second]
    };
    geometry.iter().map(mark).collect()
}
