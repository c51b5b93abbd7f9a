//! Sides of triangles: their mean, and the default tolerance that follows from it.

use super::Body;
use crate::mesh::Element;
use crate::query::Certified;

/// [`Certified::TOLERANCE`] of the mean side of the triangles at t = 0, rounded down to a power of
/// two. 0 if no side has a length. Cost: a square root for each side, on the host.
pub fn of_edges(bodies: &[Body]) -> f64 {
    of_mean_side(mean_side(bodies))
}

/// The same of a mean side that is known.
pub fn of_mean_side(mean: f64) -> f64 {
    power_below(Certified::TOLERANCE * mean)
}

/// Mean side of the triangles at t = 0, over each triangle's own three, and of edges of no face; 0 if
/// there are none.
pub fn mean_side(bodies: &[Body]) -> f64 {
    let (mut sum, mut count) = (0.0, 0u64);
    for body in bodies {
        let at = body.positions_t0().to_f64();
        for (element, face) in body.elements().iter().enumerate() {
            let sides = match body.element_kind(element) {
                Element::Face => 3,
                Element::Edge => 1,
                Element::Point => 0,
            };
            for k in 0..sides {
                let [p, q] = [face[k], face[(k + 1) % 3]].map(|v| at[v as usize]);
                let d = [0, 1, 2].map(|k| p[k] - q[k]);
                sum += (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
                count += 1;
            }
        }
    }
    sum / count.max(1) as f64
}

/// Largest power of two that is at most `x`; 0 if `x` is not a positive normal number.
fn power_below(x: f64) -> f64 {
    // Clears the mantissa.
    if x.is_normal() && x > 0.0 { f64::from_bits(x.to_bits() >> 52 << 52) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::right_triangle;

    fn triangle(size: f64) -> Body {
        Body::deformable(right_triangle(size))
    }

    #[test]
    fn it_is_a_power_of_two_near_a_part_of_the_mean_side() {
        // The mean side is 4.
        assert_eq!(of_edges(&[triangle(1.0)]), 2f64.powi(-12));
        assert_eq!(of_edges(&[triangle(1024.0)]), 2f64.powi(-2));
        assert_eq!(of_edges(&[triangle(1.0), triangle(3.0)]), 2f64.powi(-11));
        assert_eq!(of_edges(&[triangle(0.0)]), 0.0);
        assert_eq!(of_edges(&[]), 0.0);
        for (x, below) in
            [(1.0, 1.0), (1.999, 1.0), (0.49, 0.25), (f64::NAN, 0.0), (f64::INFINITY, 0.0), (-1.0, 0.0)]
        {
            assert_eq!(power_below(x), below);
        }
    }
}
