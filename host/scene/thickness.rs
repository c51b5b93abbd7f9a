//! Thickness of a body: a radius at each vertex.

use crate::error::Error;

/// Thickness of a body: the radius around its surface that belongs to it, half of the whole
/// thickness of a sheet. In scene units; 0 by default.
///
/// Near queries, and queries in motion, add the radii of both features to their distance. The radius
/// of a feature is that of its nearest point, interpolated linearly between its vertices. Discrete
/// queries, distances and pairs of bodies ignore it.
///
/// ```
/// use nearmiss::Thickness;
///
/// let (same, each) = (Thickness::from(0.01), Thickness::from(vec![0.01, 0.02, 0.0]));
/// assert!(same.largest() == 0.01 && each.largest() == 0.02);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Thickness {
    /// One radius: a length from 0.
    Same(f64),
    /// A radius for each vertex, in their order.
    Each(Vec<f64>),
}

impl Default for Thickness {
    fn default() -> Thickness {
        Thickness::Same(0.0)
    }
}

impl From<f64> for Thickness {
    fn from(radius: f64) -> Thickness {
        Thickness::Same(radius)
    }
}

impl From<Vec<f64>> for Thickness {
    fn from(radii: Vec<f64>) -> Thickness {
        Thickness::Each(radii)
    }
}

impl Thickness {
    /// Largest radius, in scene units: 2^60, as of coordinates in f32.
    pub const MOST: f64 = (1u64 << 60) as f64;

    /// The largest radius.
    pub fn largest(&self) -> f64 {
        self.radii().copied().fold(0.0, f64::max)
    }

    /// The radius of all vertices; `None` if they differ.
    pub fn same(&self) -> Option<f64> {
        match self {
            Thickness::Same(radius) => Some(*radius),
            Thickness::Each(radii) => {
                let first = radii.first().copied().unwrap_or(0.0);
                radii.iter().all(|&radius| radius == first).then_some(first)
            }
        }
    }

    /// Returns whether a vertex has no radius.
    pub(crate) fn is_thin(&self) -> bool {
        self.radii().any(|&radius| radius == 0.0)
    }

    /// Returns whether some vertices have a radius, and others none.
    pub(crate) fn is_partial(&self) -> bool {
        self.is_thin() && self.largest() > 0.0
    }

    fn radii(&self) -> impl Iterator<Item = &f64> {
        match self {
            Thickness::Same(radius) => std::slice::from_ref(radius),
            Thickness::Each(radii) => radii,
        }
        .iter()
    }

    /// Returns the radius of each of so many vertices.
    pub(crate) fn of_vertices(&self, vertices: usize) -> impl Iterator<Item = f64> {
        let repeats = matches!(self, Thickness::Same(_));
        let each = self.radii().copied();
        let last = self.radii().next().copied().unwrap_or(0.0);
        each.chain(std::iter::repeat(if repeats { last } else { 0.0 })).take(vertices)
    }

    /// Checks it for a body of this name with so many vertices.
    pub(crate) fn check(&self, body: &str, vertices: usize) -> Result<(), Error> {
        if let Thickness::Each(radii) = self
            && radii.len() != vertices
        {
            return Err(Error::InvalidArgument {
                what: format!("thickness of {body} has {} radii for {vertices} vertices", radii.len()),
                advice: "give one radius, or one for each vertex".into(),
            });
        }
        match self.radii().position(|radius| !(0.0..=Thickness::MOST).contains(radius)) {
            None => Ok(()),
            Some(vertex) => {
                let radius = self.radii().nth(vertex).copied().unwrap_or(f64::NAN);
                let of = if matches!(self, Thickness::Each(_)) {
                    format!(", vertex {vertex},")
                } else {
                    String::new()
                };
                Err(Error::InvalidArgument {
                    what: format!("thickness of {body}{of} must be from 0 to 2^60, got {radius}"),
                    advice: "give a radius in the unit of the scene".into(),
                })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_checked_by_name_and_number() {
        let message = |thickness: Thickness| thickness.check("sheet", 3).map_err(|error| error.to_string());
        assert_eq!(message(Thickness::from(0.0)), Ok(()));
        assert_eq!(message(Thickness::from(vec![0.0, 1.0, Thickness::MOST])), Ok(()));
        for (thickness, part) in [
            (Thickness::from(-1.0), "sheet must be from 0 to 2^60, got -1"),
            (Thickness::from(f64::NAN), "got NaN"),
            (Thickness::from(f64::INFINITY), "got inf"),
            (Thickness::from(vec![0.0, 1.0, -0.5]), "sheet, vertex 2, must be from 0 to 2^60, got -0.5"),
            (Thickness::from(vec![0.0, 1.0]), "2 radii for 3 vertices"),
        ] {
            let found = message(thickness);
            assert!(found.as_ref().is_err_and(|text| text.contains(part)), "{found:?}");
        }
    }

    #[test]
    fn every_vertex_has_one() {
        let of = |thickness: Thickness| thickness.of_vertices(3).collect::<Vec<_>>();
        assert_eq!(of(Thickness::from(0.5)), [0.5; 3]);
        assert_eq!(of(Thickness::from(vec![0.0, 0.25, 1.0])), [0.0, 0.25, 1.0]);
        assert_eq!(Thickness::from(vec![0.25; 2]).same(), Some(0.25));
        assert_eq!(Thickness::from(vec![0.25, 0.0]).same(), None);
        let thin = |thickness: Thickness| [thickness.is_thin(), thickness.is_partial()];
        assert_eq!(thin(Thickness::from(vec![0.25, 0.0])), [true, true]);
        assert_eq!([thin(0.0.into()), thin(0.5.into())], [[true, false], [false, false]]);
    }
}
